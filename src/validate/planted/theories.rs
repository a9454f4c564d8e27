//! Errors in the models of a study, in its satellites and in its element sets.

use super::PlantedError;
use crate::constellation::{Pattern, Shell, ShellParameters};
use crate::formats::tle;
use crate::orbit::j2::{SecularOrbit, SecularRates};
use crate::orbit::sgp4::{MeanMotionSlot, Sgp4Orbit, Sgp4Theory, ZonalHarmonics};
use crate::orbit::{MeanElements, Model};
use crate::validate::{Parts, Target};

/// What an error of the secular theory touches.
const SECULAR: &[&str] = &[
    "sgp4/mean-j2",
    "sgp4/rates",
    "sgp4/kepler-slot",
    // Far ahead on its circle a satellite is lower, seen from the other.
    "sgp4/radius-shift",
    "decisions",
    "numerical/",
    "analytic/rates",
    "analytic/mean-visible",
];

/// What an error of the element sets or of the judge touches.
const SGP4: &[&str] = &["sgp4/"];

/// The targets that propagate the design by the model of the study.
const MODEL: &[Target] = &[Target::Sgp4, Target::Numerical, Target::Analytic];

/// The errors.
pub(super) const ERRORS: &[PlantedError] = &[
    PlantedError {
        error: "two bodies, where J2 acts",
        model: Model::TwoBody,
        parts: Parts::default,
        reaches: MODEL,
        related: &["two-body", "decisions"],
    },
    PlantedError {
        error: "dM/dt = n, without its J2 term",
        model: Model::J2,
        parts: || Parts {
            mean_j2: |elements| {
                let rates = SecularRates {
                    mean_anomaly_rad_s: elements.kepler_mean_motion_rad_s(),
                    ..SecularRates::j2(elements)
                };
                SecularOrbit::new(elements, rates)
            },
            ..Parts::default()
        },
        reaches: MODEL,
        related: SECULAR,
    },
    PlantedError {
        error: "sqrt(μ/a³) in the mean motion slot of element sets",
        model: Model::J2,
        parts: || Parts {
            slot: MeanMotionSlot::Kepler,
            ..Parts::default()
        },
        reaches: &[Target::Sgp4],
        related: SGP4,
    },
    PlantedError {
        error: "sqrt(μ/a³) in the mean motion slot of the model",
        model: Model::Sgp4,
        parts: || Parts {
            propagator: |_, elements, epoch| {
                let (slot, zonals) = (MeanMotionSlot::Kepler, ZonalHarmonics::Full);
                let orbit = Sgp4Orbit::from_mean_elements(elements, epoch, slot, zonals)?;
                Ok(Box::new(orbit))
            },
            ..Parts::default()
        },
        reaches: MODEL,
        related: &["sgp4/sgp4/", "analytic/mean-visible"],
    },
    PlantedError {
        error: "short-period terms left out of `j2-osculating`",
        model: Model::J2Osculating,
        parts: || Parts {
            propagator: |_, elements, _| Ok(Box::new(SecularOrbit::j2(elements))),
            ..Parts::default()
        },
        reaches: MODEL,
        related: &["j2-osculating", "numerical/", "analytic/mean-visible"],
    },
    PlantedError {
        error: "sign of J2",
        model: Model::J2,
        parts: || Parts {
            mean_j2: |elements| {
                let right = SecularRates::j2(elements);
                let n = elements.kepler_mean_motion_rad_s();
                let rates = SecularRates {
                    raan_rad_s: -right.raan_rad_s,
                    arg_perigee_rad_s: -right.arg_perigee_rad_s,
                    mean_anomaly_rad_s: 2.0 * n - right.mean_anomaly_rad_s,
                };
                SecularOrbit::new(elements, rates)
            },
            ..Parts::default()
        },
        reaches: MODEL,
        related: SECULAR,
    },
    PlantedError {
        error: "sign of dΩ/dt",
        model: Model::J2,
        parts: || Parts {
            mean_j2: |elements| {
                let right = SecularRates::j2(elements);
                let rates = SecularRates {
                    raan_rad_s: -right.raan_rad_s,
                    ..right
                };
                SecularOrbit::new(elements, rates)
            },
            ..Parts::default()
        },
        reaches: MODEL,
        related: SECULAR,
    },
    PlantedError {
        error: "altitude over another radius (6371 km)",
        model: Model::J2,
        parts: || Parts {
            mean_j2: |elements| {
                SecularOrbit::j2(&MeanElements {
                    semi_major_axis_km: elements.semi_major_axis_km - 7.137,
                    ..*elements
                })
            },
            ..Parts::default()
        },
        reaches: MODEL,
        related: SECULAR,
    },
    PlantedError {
        error: "satellites at the inclination 180° - i",
        model: Model::J2,
        parts: || Parts {
            satellites: |design| {
                let mut satellites = design.satellites();
                for satellite in &mut satellites {
                    let elements = &mut satellite.elements;
                    elements.inclination_rad = std::f64::consts::PI - elements.inclination_rad;
                }
                satellites
            },
            ..Parts::default()
        },
        reaches: MODEL,
        related: &["sgp4/", "numerical/", "analytic/"],
    },
    PlantedError {
        error: "star for delta",
        model: Model::J2,
        parts: || Parts {
            satellites: |design| {
                Shell::new(ShellParameters {
                    pattern: Pattern::Star,
                    ..design.parameters()
                })
                .unwrap()
                .satellites()
            },
            ..Parts::default()
        },
        reaches: MODEL,
        related: &["analytic/symmetry/turn", "analytic/mean-visible"],
    },
    PlantedError {
        error: "constants of WGS 84 in SGP4",
        model: Model::J2,
        parts: || Parts {
            sgp4: Sgp4Theory {
                geopotential: ::sgp4::WGS84,
                ..Sgp4Theory::STANDARD
            },
            ..Parts::default()
        },
        reaches: &[Target::Sgp4],
        related: SGP4,
    },
    PlantedError {
        error: "J3 left out of SGP4",
        model: Model::J2,
        parts: || Parts {
            sgp4: Sgp4Theory {
                geopotential: ZonalHarmonics::WithoutJ3.wgs72(),
                ..Sgp4Theory::STANDARD
            },
            ..Parts::default()
        },
        reaches: &[Target::Sgp4],
        related: SGP4,
    },
    PlantedError {
        error: "frozen eccentricity at ω = 90°",
        model: Model::J2,
        parts: || Parts {
            cancelling_perigee_deg: 90.0,
            ..Parts::default()
        },
        reaches: &[Target::Sgp4],
        related: &["sgp4/frozen-eccentricity/cancelled"],
    },
    PlantedError {
        error: "mean motion of a TLE cut to four decimals",
        model: Model::J2,
        parts: || Parts {
            written: |set| {
                let mut written = tle::as_written(set)?;
                written.mean_motion = (1e4 * written.mean_motion).trunc() / 1e4;
                Ok(written)
            },
            ..Parts::default()
        },
        reaches: &[Target::Sgp4],
        related: &["sgp4/tle/digits"],
    },
    PlantedError {
        error: "elements not carried to the rounded epoch of a TLE",
        model: Model::J2,
        parts: || Parts {
            carried: |elements, _| *elements,
            ..Parts::default()
        },
        reaches: &[Target::Sgp4],
        related: &["sgp4/tle/epoch"],
    },
    PlantedError {
        error: "sidereal time off by a second",
        model: Model::J2,
        parts: || Parts {
            gmst_rad: |epoch, elapsed_s| epoch.gmst_rad(elapsed_s + 1.0),
            ..Parts::default()
        },
        reaches: &[Target::Sgp4, Target::Analytic],
        related: &["sgp4/sidereal-time", "analytic/geometry"],
    },
];
