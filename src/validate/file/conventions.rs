//! Conventions of other tools, tried one by one on the contents of a file.

mod propagators;

use super::matching::Matching;
use super::reference::ReferenceConstellation;
use super::tracks::Track;
use crate::constellation::{Pattern, Satellite, Shell, Slot};
use crate::earth::RADIUS_KM;
use crate::ephemeris::{Ephemeris, EphemerisSatellite, object_name};
use crate::frames::Frame;
use crate::orbit::j2::{SecularOrbit, SecularRates};
use crate::orbit::osculating::OsculatingOrbit;
use crate::orbit::sgp4::{MeanMotionSlot, Sgp4Orbit, ZonalHarmonics};
use crate::orbit::{MeanElements, Propagator};
use crate::units::wrap_two_pi;
use crate::validate::{Subject, ValidateError};
use propagators::{about_j2000, gps_minus_utc_s, mislabelled, taken_as_osculating};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// A convention explains a difference if less than this fraction of it remains...
const EXPLAINED: f64 = 0.1;

/// ... and less than this, km: the remainder must be due to the force model, not the pattern.
const MOST_LEFT_KM: f64 = 50.0;

/// Samples at which conventions are tried, over all objects.
const SAMPLES: usize = 600;

/// Resolution to which a fitted radius is rounded, km: a decimetre.
const RADIUS_DIGIT_KM: f64 = 1e-4;

/// The convention that explains a difference.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Explanation {
    /// Its name.
    pub convention: String,
    /// What it means.
    pub meaning: String,
    /// Root mean square distance before, km; `None` if some object was not near a slot.
    pub before_km: Option<f64>,
    /// Root mean square distance with it, km.
    pub after_km: f64,
}

/// A satellite as another convention propagates it.
type OtherPropagator = Box<dyn Propagator>;

/// A way in which a tool may have propagated the design.
struct Convention {
    name: &'static str,
    meaning: &'static str,
    propagate: fn(&Subject<'_>, Fitted) -> Vec<(String, OtherPropagator)>,
}

/// What the conventions use from the files.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Fitted {
    /// Excess of the files' orbit radii at their first samples, km.
    pub(super) radius_offset_km: f64,
}

impl Fitted {
    /// The mean excess of the radii at the first samples, before anything has drifted, each taken as an
    /// excess of the semi-major axis of its own shell; zero if no object is near a slot.
    fn to(reference: &ReferenceConstellation<'_>, tracks: &[Track]) -> Result<Self, ValidateError> {
        let ours = &reference.ephemeris;
        let matching = Matching::of(&reference.reach_km, ours, tracks);
        let pairs = matching.pairs(tracks);
        let axes_km: Vec<f64> = reference
            .shells
            .iter()
            .flat_map(|one| {
                let a_km = one.orbit().semi_major_axis_km;
                std::iter::repeat_n(a_km, one.shell.satellite_count())
            })
            .collect();
        let mut sum_km = 0.0;
        for (slot, track) in &pairs {
            if let Some((elapsed_s, theirs)) = track.at(0.0) {
                let own = ours.state(&ours.satellites()[*slot], elapsed_s)?;
                let excess = theirs.position_km.norm() / own.position_km.norm() - 1.0;
                sum_km += excess * axes_km[*slot];
            }
        }
        let offset_km = sum_km / pairs.len().max(1) as f64;
        let radius_offset_km = (offset_km / RADIUS_DIGIT_KM).round() * RADIUS_DIGIT_KM;
        Ok(Self { radius_offset_km })
    }
}

/// Secular J2 on other satellites.
fn j2_of(satellites: Vec<Satellite>) -> Vec<(String, OtherPropagator)> {
    propagate_each(&satellites, |elements| Some(SecularOrbit::j2(elements)))
}

fn propagate_each<P: Propagator + 'static>(
    satellites: &[Satellite],
    theory: impl Fn(&MeanElements) -> Option<P>,
) -> Vec<(String, OtherPropagator)> {
    let propagate = |satellite: &Satellite| {
        let propagated: OtherPropagator = Box::new(theory(&satellite.elements)?);
        Some((object_name(satellite.slot), propagated))
    };
    satellites.iter().filter_map(propagate).collect()
}

fn with_elements(
    subject: &Subject<'_>,
    change: impl Fn(&Satellite) -> MeanElements,
) -> Vec<(String, OtherPropagator)> {
    let changed = subject.nominal_satellites().into_iter();
    j2_of(
        changed
            .map(|satellite| Satellite {
                elements: change(&satellite),
                ..satellite
            })
            .collect(),
    )
}

fn with_altitude(subject: &Subject<'_>, extra_km: f64) -> Vec<(String, OtherPropagator)> {
    with_elements(subject, |satellite| MeanElements {
        semi_major_axis_km: satellite.elements.semi_major_axis_km + extra_km,
        ..satellite.elements
    })
}

/// The shell with another pattern or phase step, in revolutions between planes.
fn with_layout(
    subject: &Subject<'_>,
    node_turns: f64,
    phase_turns: f64,
) -> Vec<(String, OtherPropagator)> {
    let per_plane = subject.shell.satellites_per_plane() as f64;
    let first = subject.shell.elements(Slot::FIRST);
    with_elements(subject, |satellite| {
        let (plane, index) = (satellite.slot.plane as f64, satellite.slot.index as f64);
        MeanElements {
            raan_rad: first.raan_rad + TAU * node_turns * plane,
            mean_anomaly_rad: wrap_two_pi(
                first.mean_anomaly_rad + TAU * (index / per_plane + phase_turns * plane),
            ),
            ..satellite.elements
        }
    })
}

/// The shell's steps of node and phase between planes, revolutions.
fn layout(shell: &Shell) -> (f64, f64) {
    let phase = shell.phasing() as f64 / shell.satellite_count() as f64;
    let phase = match shell.pattern() {
        Pattern::Delta | Pattern::Star => phase,
        Pattern::Lattice => -phase,
    };
    (shell.node_step_deg() / 360.0, phase)
}

fn sgp4(subject: &Subject<'_>, slot: MeanMotionSlot) -> Vec<(String, OtherPropagator)> {
    let epoch = subject.epoch();
    propagate_each(&subject.nominal_satellites(), |elements| {
        Sgp4Orbit::from_mean_elements(elements, epoch, slot, ZonalHarmonics::Full).ok()
    })
}

/// The convention whose radius is fitted.
const ANOTHER_RADIUS: &str = "altitude-over-another-radius";

/// The conventions, the cheapest first.
const CONVENTIONS: &[Convention] = &[
    Convention {
        name: "mean-j2",
        meaning: "secular J2 on the mean elements, as the model j2 propagates it",
        propagate: |subject, _| j2_of(subject.nominal_satellites()),
    },
    Convention {
        name: "two-body",
        meaning: "two-body motion, without J2",
        propagate: |subject, _| {
            propagate_each(&subject.nominal_satellites(), |e| {
                Some(SecularOrbit::two_body(e))
            })
        },
    },
    Convention {
        name: "j2-without-mean-anomaly",
        meaning: "secular J2 on node and perigee, but dM/dt = n",
        propagate: |subject, _| {
            propagate_each(&subject.nominal_satellites(), |elements| {
                let rates = SecularRates {
                    mean_anomaly_rad_s: elements.kepler_mean_motion_rad_s(),
                    ..SecularRates::j2(elements)
                };
                Some(SecularOrbit::new(elements, rates))
            })
        },
    },
    Convention {
        name: "osculating-j2",
        meaning: "mean elements propagated with first-order short-period terms",
        propagate: |subject, _| {
            propagate_each(&subject.nominal_satellites(), |e| {
                Some(OsculatingOrbit::new(e))
            })
        },
    },
    Convention {
        name: "elements-taken-as-osculating",
        meaning: "the elements are osculating at the epoch and J2 is integrated",
        propagate: |subject, _| taken_as_osculating(subject),
    },
    Convention {
        name: "sgp4",
        meaning: "SGP4 with dM/dt of secular J2 in the mean motion field",
        propagate: |subject, _| sgp4(subject, MeanMotionSlot::Kozai),
    },
    Convention {
        name: "sgp4-kepler-slot",
        meaning: "SGP4 with sqrt(mu/a^3) in the mean motion field",
        propagate: |subject, _| sgp4(subject, MeanMotionSlot::Kepler),
    },
    Convention {
        name: ANOTHER_RADIUS,
        meaning: "altitudes measured from another Earth radius",
        propagate: |subject, fitted| with_altitude(subject, fitted.radius_offset_km),
    },
    Convention {
        name: "star-for-delta",
        meaning: "nodes over 180 degrees instead of 360",
        propagate: |subject, _| {
            let (node, phase) = layout(&subject.shell);
            with_layout(subject, 0.5 * node, phase)
        },
    },
    Convention {
        name: "delta-for-star",
        meaning: "nodes over 360 degrees instead of 180",
        propagate: |subject, _| {
            let (node, phase) = layout(&subject.shell);
            with_layout(subject, 2.0 * node, phase)
        },
    },
    Convention {
        name: "phasing-in-slots",
        meaning: "phase step F 360/P instead of F 360/T",
        propagate: |subject, _| {
            let (node, phase) = layout(&subject.shell);
            with_layout(
                subject,
                node,
                phase * subject.shell.satellites_per_plane() as f64,
            )
        },
    },
    Convention {
        name: "phasing-in-degrees",
        meaning: "phase step of F degrees",
        propagate: |subject, _| {
            let (node, _) = layout(&subject.shell);
            with_layout(subject, node, subject.shell.phasing() as f64 / 360.0)
        },
    },
    Convention {
        name: "phasing-backwards",
        meaning: "phase step -F 360/T",
        propagate: |subject, _| {
            let (node, phase) = layout(&subject.shell);
            with_layout(subject, node, -phase)
        },
    },
    Convention {
        name: "phasing-halved",
        meaning: "phase step F 180/T, as lox has for stars",
        propagate: |subject, _| {
            let (node, phase) = layout(&subject.shell);
            with_layout(subject, node, 0.5 * phase)
        },
    },
    Convention {
        name: "phasing-ignored",
        meaning: "no phase step between planes: F = 0",
        propagate: |subject, _| {
            let (node, _) = layout(&subject.shell);
            with_layout(subject, node, 0.0)
        },
    },
    Convention {
        name: "teme-taken-for-eme2000",
        meaning: "TEME states labelled EME2000, or equivalently elements and J2 pole referred to the J2000 equator",
        propagate: |subject, _| mislabelled(subject, 0.0, Frame::Eme2000, true),
    },
    Convention {
        name: "eme2000-taken-for-teme",
        meaning: "EME2000 states labelled TEME",
        propagate: |subject, _| mislabelled(subject, 0.0, Frame::Eme2000, false),
    },
    Convention {
        name: "teme-taken-for-earth-fixed",
        meaning: "TEME states labelled Earth-fixed",
        propagate: |subject, _| mislabelled(subject, 0.0, Frame::EarthFixed, true),
    },
    Convention {
        name: "earth-fixed-taken-for-teme",
        meaning: "Earth-fixed states labelled TEME",
        propagate: |subject, _| mislabelled(subject, 0.0, Frame::EarthFixed, false),
    },
    Convention {
        name: "utc-taken-for-gps",
        meaning: "UTC instants labelled GPS time",
        propagate: |subject, _| mislabelled(subject, gps_minus_utc_s(subject), Frame::Teme, false),
    },
    Convention {
        name: "gps-taken-for-utc",
        meaning: "GPS instants labelled UTC",
        propagate: |subject, _| mislabelled(subject, -gps_minus_utc_s(subject), Frame::Teme, false),
    },
    Convention {
        name: "j2-about-the-j2000-pole",
        meaning: "secular J2 about the pole of J2000 instead of the true pole of date",
        propagate: |subject, _| about_j2000(subject),
    },
];

/// The convention with the smallest remainder, if that is small enough.
///
/// # Errors
/// If the design itself cannot be propagated.
pub(super) fn explanation(
    reference: &ReferenceConstellation<'_>,
    tracks: &[Track],
) -> Result<Option<Explanation>, ValidateError> {
    if reference.shells.is_empty() {
        return Ok(None);
    }
    let before_km = rms_km(reference, &reference.ephemeris, tracks);
    let fitted = Fitted::to(reference, tracks)?;
    let tried = CONVENTIONS.iter().filter_map(|convention| {
        let shells = reference.shells.iter();
        let propagated = shells.flat_map(|shell| (convention.propagate)(shell, fitted));
        let satellites = propagated.map(|(name, propagator)| EphemerisSatellite {
            name,
            slot: None,
            propagator,
        });
        let ephemeris = Ephemeris::new(reference.grid(), satellites.collect());
        Some((convention, rms_km(reference, &ephemeris, tracks)?))
    });
    let best = tried.min_by(|a, b| a.1.total_cmp(&b.1));
    let enough_km = before_km.map_or(MOST_LEFT_KM, |before_km| {
        (EXPLAINED * before_km).min(MOST_LEFT_KM)
    });
    Ok(best
        .filter(|(_, after_km)| *after_km < enough_km)
        .map(|(convention, after_km)| Explanation {
            convention: convention.name.to_owned(),
            meaning: if convention.name == ANOTHER_RADIUS {
                let radius_km = RADIUS_KM + fitted.radius_offset_km;
                format!("altitudes measured from a radius of {radius_km:.4} km (fitted)")
            } else {
                convention.meaning.to_owned()
            },
            before_km,
            after_km,
        }))
}

/// Root mean square distance of all tracks from an ephemeris; `None` unless all of them match.
fn rms_km(
    reference: &ReferenceConstellation<'_>,
    propagated: &Ephemeris,
    tracks: &[Track],
) -> Option<f64> {
    let matching = Matching::of(&reference.reach_km, propagated, tracks);
    let pairs = matching.pairs(tracks);
    let with_states = tracks.iter().filter(|t| !t.states.is_empty()).count();
    if pairs.len() < with_states.min(propagated.satellites().len()) {
        return None;
    }
    let per_object = (SAMPLES / pairs.len().max(1)).max(3);
    let (mut squares, mut samples) = (0.0, 0.0);
    for (slot, track) in pairs {
        let stride = track.states.len().div_ceil(per_object).max(1);
        for (elapsed_s, theirs) in track.states.iter().step_by(stride) {
            let ours = propagated
                .state(&propagated.satellites()[slot], *elapsed_s)
                .ok()?;
            squares += (theirs.position_km - ours.position_km).norm_squared();
            samples += 1.0;
        }
    }
    (samples > 0.0).then(|| (squares / samples).sqrt())
}

#[cfg(test)]
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    CONVENTIONS.iter().map(|convention| convention.name)
}

/// The design as a convention propagates it.
#[cfg(test)]
pub(super) fn propagated(
    subject: &Subject<'_>,
    name: &str,
    fitted: Fitted,
) -> Vec<(String, OtherPropagator)> {
    let convention = CONVENTIONS
        .iter()
        .find(|convention| convention.name == name);
    (convention.unwrap().propagate)(subject, fitted)
}
