//! Products of an export, read back and evaluated again: what the scenario makes of each file.
//!
//! Gates follow from the digits of a format and from the theory that its readers fly. A satellite
//! that is d km from its place moves the circle that sees it by as much; at 400 km the circle's
//! radius is 1600 km and its area changes by less than d/500 km of itself, which bounds the mean
//! number in view, and the geometry changes by d over the distance, 400 km or more.

use super::fleet::{Fleet, FleetError};
use super::lint::Format;
use crate::constellation::Design;
use crate::earth::RADIUS_KM;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::evaluate::{Evaluator, Metrics};
use crate::orbit::Model;
use crate::units::SECONDS_PER_DAY;
use std::f64::consts::TAU;
use thiserror::Error;

/// Nine decimals of a kilometre, stamps to a nanosecond, and rotations forth and back, km.
const STATES_KM: f64 = 1e-8;

/// Six decimals of a kilometre in three components, and epochs to 1e-8 s, km.
const SP3_KM: f64 = 1e-6;

/// The metre between samples for which their spacing is chosen on one satellite, twice for the others,
/// and a decimetre of digits, km.
const CZML_KM: f64 = 2.0 * super::czml::TARGET_KM + 2e-4;

/// SGP4 against a theory of J2 alone, km: the frozen eccentricity of J3 (8.1 km up and down, 16.2
/// along the track at most), and the short-period terms and shift of the radius (1.75 J2 Re²/a,
/// 10.6 km at most); M-30 to M-33.
const SGP4_KM: f64 = 30.0;

/// Second-order secular terms along the track, km/day: 14 J2² (Re/a)⁴ n a at most (M-34).
const SGP4_KM_PER_DAY: f64 = 8.0;

/// Kilometres off that change the mean in view, or a PDOP, by less than the whole of itself.
const SCALE_KM: f64 = 500.0;

/// Satellites that may cross the mask at a sample by rounding alone.
const FLIPS: f64 = 5.0;

/// Why a product cannot be checked.
#[derive(Debug, Error)]
pub enum RecheckError {
    /// The satellites of the file do not fly the study.
    #[error(transparent)]
    Fleet(#[from] FleetError),
    /// A satellite has no state.
    #[error(transparent)]
    Ephemeris(#[from] EphemerisError),
    /// Other satellites than the design has.
    #[error("{found} satellites were read back; the design has {expected}")]
    Satellites {
        /// In the file.
        found: usize,
        /// In the design.
        expected: usize,
    },
}

/// A difference and the bound on its size; without a bound it is only reported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// File less design.
    pub value: f64,
    /// Bound on its size.
    pub gate: Option<f64>,
}

impl Difference {
    /// Whether the bound is kept.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.gate.is_none_or(|gate| self.value.abs() <= gate)
    }
}

/// What a product says of the design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recheck {
    /// Largest distance of a satellite from its place, km.
    pub position_km: Difference,
    /// Mean number of visible satellites.
    pub mean_visible: Difference,
    /// Mean PDOP; none where one side has no solved sample.
    pub mean_pdop: Option<Difference>,
}

impl Recheck {
    /// Whether every bound is kept, and both sides have a PDOP or none has.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.position_km.passed()
            && self.mean_visible.passed()
            && self.mean_pdop.is_none_or(|pdop| pdop.passed())
    }
}

/// The design that products are checked against.
pub struct Original<'a> {
    evaluator: &'a Evaluator,
    ephemeris: Ephemeris,
    metrics: Metrics,
    semi_major_axis_km: f64,
    eccentricity: f64,
}

impl<'a> Original<'a> {
    /// Evaluates the design.
    ///
    /// # Errors
    /// When a satellite cannot be flown.
    pub fn new(evaluator: &'a Evaluator, design: &Design) -> Result<Self, EphemerisError> {
        let setup = evaluator.setup();
        Ok(Self {
            evaluator,
            ephemeris: Ephemeris::of_design(design, setup.model, setup.grid)?,
            metrics: evaluator.design(design)?,
            semi_major_axis_km: RADIUS_KM + design.altitude_km(),
            eccentricity: design.eccentricity(),
        })
    }

    /// Flies what was read back and compares it; satellites stand in the order of the design.
    /// `format` is the one whose digits and theory the file has.
    ///
    /// # Errors
    /// When the satellites do not fly the study, or are not those of the design.
    pub fn check(&self, format: Format, fleet: &Fleet) -> Result<Recheck, RecheckError> {
        let setup = self.evaluator.setup();
        let (found, expected) = (fleet.len(), self.ephemeris.satellites().len());
        if found != expected {
            return Err(RecheckError::Satellites { found, expected });
        }
        let flown = fleet.fly(setup.grid, setup.model)?;
        let metrics = self.evaluator.ephemeris(&flown)?;
        let gate_km = self.position_gate_km(format);
        let relative = gate_km.map(|km| km / SCALE_KM);
        let flips = FLIPS / setup.sample_count() as f64;
        let of = |value: f64| relative.map(|relative| value * relative + flips);
        let pdop = self.metrics.mean_pdop.zip(metrics.mean_pdop);
        let visible = self.metrics.mean_visible;
        Ok(Recheck {
            position_km: Difference {
                value: self.apart_km(&flown)?,
                gate: gate_km,
            },
            mean_visible: Difference {
                value: metrics.mean_visible - visible,
                gate: of(visible),
            },
            // A satellite more or less at a sample changes its PDOP by less than the whole.
            mean_pdop: pdop.map(|(ours, theirs)| Difference {
                value: theirs - ours,
                gate: of(ours),
            }),
        })
    }

    fn apart_km(&self, flown: &Ephemeris) -> Result<f64, EphemerisError> {
        let pairs = flown.satellites().iter().zip(self.ephemeris.satellites());
        let mut worst_km = 0.0_f64;
        for (theirs, ours) in pairs {
            for elapsed_s in self.ephemeris.grid().iter() {
                let theirs = flown.state(theirs, elapsed_s)?.position_km;
                let ours = self.ephemeris.state(ours, elapsed_s)?.position_km;
                worst_km = worst_km.max((theirs - ours).norm());
            }
        }
        Ok(worst_km)
    }

    /// How far the satellites of a file may be from their places, km; none for a theory that
    /// SGP4 does not approximate.
    fn position_gate_km(&self, format: Format) -> Option<f64> {
        let setup = self.evaluator.setup();
        let a = self.semi_major_axis_km;
        let span_s = setup.grid.elapsed_s(setup.grid.len() - 1);
        let days = span_s / SECONDS_PER_DAY;
        // A low orbit turns by 16 revolutions a day at most.
        let turned_rad = 16.0 * TAU * days;
        let theory = match setup.model {
            Model::Sgp4 => Some(0.0),
            Model::J2 | Model::J2Osculating => {
                Some((1.0 + 8.0 * self.eccentricity) * (SGP4_KM + SGP4_KM_PER_DAY * days))
            }
            Model::TwoBody => None,
        };
        match format {
            // Four angles to 1e-4°, e to 1e-7, the mean motion to 1e-8 rev/day.
            Format::Tle => {
                let angles = 4.0 * 0.5e-4_f64.to_radians();
                let digits = a * (angles + 1e-7 + TAU * 0.5e-8 * days);
                theory.map(|km| km + digits)
            }
            // Twelve decimals of a degree, fifteen of e, thirteen of the mean motion.
            Format::Omm | Format::OmmXml | Format::OmmJson | Format::OmmCsv => {
                theory.map(|km| km + 1e-8 * (1.0 + days))
            }
            Format::Sp3 => Some(SP3_KM),
            Format::Czml => Some(CZML_KM),
            // Nine decimals of a kilometre of a: 3/2 da n t along the track.
            Format::Opm => Some(STATES_KM + 1.5 * 0.5e-9 * turned_rad),
            Format::Oem
            | Format::OemXml
            | Format::Stk
            | Format::ElementsCsv
            | Format::StatesCsv => Some(STATES_KM),
        }
    }
}
