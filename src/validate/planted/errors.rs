//! The planted errors and the gates that they fail.

use super::PlantedError;
use crate::constellation::{Design, DesignParameters, Pattern};
use crate::dop::Clocks;
use crate::earth::Surface;
use crate::evaluate::{Evaluator, Setup};
use crate::formats::tle;
use crate::frames::LocalFrame;
use crate::orbit::j2::{SecularOrbit, SecularRates};
use crate::orbit::sgp4::{MeanMotionSlot, Sgp4Orbit, Sgp4Theory, ZonalHarmonics};
use crate::orbit::{MeanElements, Model};
use crate::validate::numerical::integrator::ZonalField;
use crate::validate::{Parts, Target};
use crate::visibility::Mask;

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

/// The table.
pub(super) const PLANTED: &[PlantedError] = &[
    PlantedError {
        error: "two bodies, where J2 acts",
        model: Model::TwoBody,
        parts: Parts::default,
        reaches: MODEL,
        fails: &[
            "sgp4/two-body/sgp4/in-track-rms",
            "sgp4/two-body/sgp4/cross-track-rms",
            "sgp4/two-body/sgp4/in-track-growth",
            "sgp4/two-body/sweep",
            "sgp4/rates/node/two-body",
            "sgp4/rates/argument-of-latitude/two-body",
            "sgp4/decisions/flipped-decisions",
        ],
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
        fails: &[
            "sgp4/mean-j2/sgp4/in-track-rms",
            "sgp4/mean-j2/sgp4/in-track-growth",
            "sgp4/mean-j2/sgp4-no-j3j4/in-track-rms",
            "sgp4/mean-j2/sgp4-no-j3j4/in-track-growth",
            "sgp4/mean-j2/sweep",
            "sgp4/kepler-slot/closed-form",
            "sgp4/rates/argument-of-latitude/mean-j2",
            "sgp4/decisions/flipped-decisions",
            "sgp4/tle/decisions/flipped-decisions",
            "numerical/1-days/in-track-drift",
            "analytic/rates/argument-of-latitude",
        ],
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
        fails: &[
            "sgp4/mean-j2/sgp4/in-track-growth",
            "sgp4/rates/argument-of-latitude/sgp4",
            "sgp4/tle/decisions/flipped-decisions",
        ],
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
        fails: &[
            "sgp4/sgp4/sgp4/in-track-rms",
            "sgp4/sgp4/sgp4/in-track-growth",
            "sgp4/sgp4/sweep",
        ],
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
        fails: &[
            "sgp4/j2-osculating/sgp4-no-j3j4/radial-rms",
            "sgp4/j2-osculating/sgp4-no-j3j4/cross-track-rms",
            "sgp4/j2-osculating/sweep",
            "numerical/1-days/in-track-drift",
        ],
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
        fails: &[
            "sgp4/mean-j2/sgp4/in-track-growth",
            "sgp4/mean-j2/sgp4/cross-track-rms",
            "sgp4/rates/node/mean-j2",
            "numerical/1-days/in-track-drift",
            "numerical/1-days/node-rate",
            "analytic/rates/node",
            "analytic/rates/argument-of-latitude",
        ],
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
        fails: &[
            "sgp4/mean-j2/sgp4/cross-track-rms",
            "sgp4/mean-j2/sgp4-no-j3j4/cross-track-rms",
            "sgp4/rates/node/mean-j2",
            "numerical/1-days/node-rate",
            "numerical/1-days/cross-track-after-fit",
            "analytic/rates/node",
        ],
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
        fails: &[
            "sgp4/mean-j2/sgp4/radial-rms",
            "sgp4/mean-j2/sgp4-no-j3j4/radial-rms",
            "sgp4/mean-j2/sgp4/in-track-growth",
            "sgp4/radius-shift/closed-form",
        ],
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
        fails: &["sgp4/rates/node/sgp4", "sgp4/rates/node/mean-j2"],
        related: &["sgp4/", "numerical/", "analytic/"],
    },
    PlantedError {
        error: "star for delta",
        model: Model::J2,
        parts: || Parts {
            satellites: |design| {
                Design::new(DesignParameters {
                    pattern: Pattern::Star,
                    ..design.parameters()
                })
                .unwrap()
                .satellites()
            },
            ..Parts::default()
        },
        reaches: MODEL,
        fails: &["analytic/symmetry/turn"],
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
        fails: &[
            "sgp4/verification/published",
            "sgp4/verification/afspc",
            "sgp4/verification/improved",
        ],
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
        fails: &[
            "sgp4/verification/afspc",
            "sgp4/frozen-eccentricity/closed-form",
            "sgp4/frozen-eccentricity/cancelled",
        ],
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
        fails: &["sgp4/frozen-eccentricity/cancelled"],
        related: &["sgp4/frozen-eccentricity/cancelled"],
    },
    PlantedError {
        error: "mean anomaly of a TLE cut to three decimals",
        model: Model::J2,
        parts: || Parts {
            written: |set| {
                let mut written = tle::as_written(set)?;
                written.mean_anomaly = (1e3 * written.mean_anomaly).trunc() / 1e3;
                Ok(written)
            },
            ..Parts::default()
        },
        reaches: &[Target::Sgp4],
        fails: &["sgp4/tle/digits"],
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
        fails: &["sgp4/tle/epoch"],
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
        fails: &["sgp4/sidereal-time"],
        related: &["sgp4/sidereal-time", "analytic/geometry"],
    },
    PlantedError {
        error: "geocentric vertical",
        model: Model::J2,
        parts: || Parts {
            local_frame: |surface, latitude, longitude| {
                let right = LocalFrame::new(surface, latitude, longitude);
                let up = right.origin_km.km().normalize();
                LocalFrame {
                    up,
                    north: up.cross(&right.east),
                    ..right
                }
            },
            ..Parts::default()
        },
        reaches: &[Target::GeographicLib],
        fails: &[
            "geographiclib/elevation",
            "geographiclib/curvature-method/low",
        ],
        related: &["geographiclib/"],
    },
    PlantedError {
        error: "sphere for ellipsoid",
        model: Model::J2,
        parts: || Parts {
            local_frame: |_, latitude, longitude| {
                LocalFrame::new(Surface::Sphere, latitude, longitude)
            },
            ..Parts::default()
        },
        reaches: &[Target::GeographicLib],
        fails: &["geographiclib/elevation"],
        related: &["geographiclib/"],
    },
    PlantedError {
        error: "elevation of the line of sight from the centre of the Earth",
        model: Model::J2,
        parts: || Parts {
            look_angles: |local, target| {
                let (_, azimuth) = local.look_angles(target);
                let sine = local.up.dot(&target.km().normalize());
                (sine.asin(), azimuth)
            },
            ..Parts::default()
        },
        reaches: &[Target::GeographicLib],
        fails: &[
            "geographiclib/elevation",
            "geographiclib/footprint/geodesic-polygon",
        ],
        related: &["geographiclib/"],
    },
    PlantedError {
        error: "swapped azimuth axes",
        model: Model::J2,
        parts: || Parts {
            look_angles: |local, target| {
                let swapped = LocalFrame {
                    east: local.north,
                    north: local.east,
                    ..*local
                };
                swapped.look_angles(target)
            },
            ..Parts::default()
        },
        reaches: &[Target::GeographicLib],
        fails: &["geographiclib/azimuth"],
        related: &["geographiclib/azimuth"],
    },
    PlantedError {
        error: "factor of x and y for z in the acceleration of J2",
        model: Model::J2,
        parts: || Parts {
            acceleration: |field, position| {
                let mut pull = field.acceleration(position);
                let r = position.norm();
                // 2 of 3 in the bracket of z: (5 s² - 1) for (5 s² - 3).
                pull.z += 3.0 * field.j2 * field.mu_km3_s2 * field.radius_km.powi(2) * position.z
                    / r.powi(5);
                pull
            },
            ..Parts::default()
        },
        reaches: &[Target::Numerical],
        fails: &[
            "numerical/conserved/energy",
            "numerical/1-days/in-track-drift",
            "numerical/1-days/node-rate",
        ],
        related: &["numerical/"],
    },
    PlantedError {
        error: "J2 about the x axis in the integration",
        model: Model::J2,
        parts: || Parts {
            acceleration: |field, position| {
                let turned = nalgebra::Vector3::new(position.z, position.y, -position.x);
                let pull = field.acceleration(turned);
                nalgebra::Vector3::new(-pull.z, pull.y, pull.x)
            },
            ..Parts::default()
        },
        reaches: &[Target::Numerical],
        fails: &[
            "numerical/conserved/polar-momentum",
            "numerical/1-days/in-track-after-fit",
            "numerical/1-days/cross-track-after-fit",
        ],
        related: &["numerical/"],
    },
    PlantedError {
        error: "sign of J3 in the integration",
        model: Model::J2,
        parts: || Parts {
            acceleration: |field, position| {
                let mirrored = ZonalField {
                    j3: -field.j3,
                    ..*field
                };
                mirrored.acceleration(position)
            },
            ..Parts::default()
        },
        reaches: &[Target::Numerical],
        fails: &["numerical/j3/frozen-eccentricity"],
        related: &["numerical/j3/frozen-eccentricity"],
    },
    PlantedError {
        error: "wrong number of clocks",
        model: Model::J2,
        parts: || Parts {
            clocks: |meant| match meant {
                Clocks::PerSystem => Clocks::Shared,
                Clocks::Shared => Clocks::PerSystem,
            },
            ..Parts::default()
        },
        reaches: &[Target::Analytic],
        fails: &["analytic/geometry/mean-pdop", "analytic/geometry/max-pdop"],
        related: &["analytic/geometry/mean-pdop", "analytic/geometry/max-pdop"],
    },
    PlantedError {
        error: "mask taken from the zenith",
        model: Model::J2,
        parts: || Parts {
            evaluate: |evaluator, ephemeris| {
                let setup = evaluator.setup();
                let mask = Mask::from_degrees(90.0 - setup.mask.degrees()).unwrap();
                let setup = Setup {
                    mask,
                    ..setup.clone()
                };
                Evaluator::new(setup)?.evaluate_ephemeris(ephemeris)
            },
            ..Parts::default()
        },
        reaches: &[Target::Analytic],
        fails: &[
            "analytic/mask",
            "analytic/mean-visible",
            "analytic/geometry/mean-visible",
        ],
        related: &["analytic/"],
    },
    PlantedError {
        error: "first satellite of a list counted by its height over the equator",
        model: Model::J2,
        parts: || Parts {
            evaluate: |evaluator, ephemeris| {
                let mut metrics = evaluator.evaluate_ephemeris(ephemeris)?;
                let first = ephemeris.state(&ephemeris.satellites()[0], 0.0)?;
                metrics.mean_visible += 1e-9 * first.position_km.km().z;
                Ok(metrics)
            },
            ..Parts::default()
        },
        reaches: &[Target::Analytic],
        fails: &["analytic/symmetry/order"],
        related: &["analytic/"],
    },
];
