//! Errors in what sees the satellites, and in the integration that judges them.

use super::PlantedError;
use crate::dop::Clocks;
use crate::earth::Surface;
use crate::evaluate::{Evaluator, Setup};
use crate::frames::LocalFrame;
use crate::orbit::Model;
use crate::validate::numerical::integrator::ZonalField;
use crate::validate::{Parts, Target};
use crate::visibility::Mask;

/// The errors.
pub(super) const ERRORS: &[PlantedError] = &[
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
        related: &["analytic/"],
    },
    PlantedError {
        error: "first satellite of a list counted by its height over the equator",
        model: Model::J2,
        parts: || Parts {
            evaluate: |evaluator, ephemeris| {
                let mut metrics = evaluator.evaluate_ephemeris(ephemeris)?;
                let first = ephemeris.state(&ephemeris.satellites()[0], 0.0)?;
                metrics.mean_visible += 1e-6 * first.position_km.km().z;
                Ok(metrics)
            },
            ..Parts::default()
        },
        reaches: &[Target::Analytic],
        related: &["analytic/"],
    },
];
