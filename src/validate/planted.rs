//! Proof that each check can fail: parts of the library are replaced by faulty ones, and the checks
//! meant for the mistake, and only related ones, must notice.

use super::analytic::against_closed_forms;
use super::geodesic::against_geodesics;
use super::numerical::against_integration;
use super::sgp4::against_sgp4;
use super::{Findings, Parts, Subject, testing};
use crate::constellation::{Design, DesignParameters, Pattern};
use crate::dop::Clocks;
use crate::earth::Surface;
use crate::frames::LocalFrame;
use crate::orbit::MeanElements;
use crate::orbit::j2::{SecularOrbit, SecularRates};
use crate::orbit::sgp4::MeanMotionSlot;
use crate::time::{Epoch, TimeGrid};

/// All targets except files, on a design at 40°, where no mistake cancels out.
fn failures(parts: Parts) -> Vec<String> {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let evaluator = testing::evaluator(TimeGrid::new(epoch, 86_400.0, 600.0).unwrap());
    let subject = Subject {
        design: "delta:40:30/6/1@925".parse().unwrap(),
        evaluator: &evaluator,
        parts,
    };
    let mut findings = Findings::default();
    findings.append(against_sgp4(&subject).unwrap());
    findings.append(against_geodesics(&subject).unwrap());
    findings.append(against_integration(&subject).unwrap());
    findings.append(against_closed_forms(&subject).unwrap());
    let failed = findings.checks.into_iter().filter(|check| !check.passed);
    failed.map(|check| check.name).collect()
}

/// Every failure is of one of these kinds, and each of these checks fails.
fn assert_fails(parts: Parts, checks: &[&str], kinds: &[&str]) {
    let failed = failures(parts);
    for check in checks {
        assert!(
            failed.iter().any(|name| name == check),
            "{check} did not fail: {failed:?}"
        );
    }
    for name in &failed {
        assert!(
            kinds.iter().any(|kind| name.contains(kind)),
            "unrelated {name} failed: {failed:?}"
        );
    }
}

#[test]
fn nothing_fails_without_a_mistake() {
    assert_eq!(failures(Parts::default()), Vec::<String>::new());
}

/// Checks affected by a mistake in the secular theory.
const SECULAR: [&str; 7] = [
    "sgp4/mean-j2",
    "sgp4/rates",
    "sgp4/kepler-slot",
    // A satellite far ahead on the same circle appears lower from the other one.
    "sgp4/radius-shift",
    "decisions",
    "numerical/",
    "analytic/rates",
];

#[test]
fn a_missing_mean_anomaly_rate() {
    let parts = Parts {
        mean_j2: |elements| {
            let rates = SecularRates {
                mean_anomaly_rad_s: elements.kepler_mean_motion_rad_s(),
                ..SecularRates::j2(elements)
            };
            SecularOrbit::new(elements, rates)
        },
        ..Parts::default()
    };
    let checks = [
        "sgp4/mean-j2/sgp4/in-track-growth",
        "sgp4/rates/argument-of-latitude/mean-j2",
        "numerical/1-days/in-track-drift",
        "analytic/rates/argument-of-latitude",
    ];
    assert_fails(parts, &checks, &SECULAR);
}

/// Kepler's mean motion in the written element sets; the theory itself is right.
#[test]
fn kepler_in_the_mean_motion_slot() {
    let parts = Parts {
        slot: MeanMotionSlot::Kepler,
        ..Parts::default()
    };
    let checks = [
        "sgp4/mean-j2/sgp4/in-track-growth",
        "sgp4/rates/argument-of-latitude/sgp4",
    ];
    // Every comparison in which SGP4 uses that field.
    assert_fails(parts, &checks, &["sgp4/"]);
}

#[test]
fn the_sign_of_j2() {
    let parts = Parts {
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
    };
    let checks = [
        "sgp4/mean-j2/sgp4/in-track-growth",
        "sgp4/mean-j2/sgp4/cross-track-rms",
        "sgp4/rates/node/mean-j2",
        "numerical/1-days/in-track-drift",
        "analytic/rates/node",
        "analytic/rates/argument-of-latitude",
    ];
    assert_fails(parts, &checks, &SECULAR);
}

#[test]
fn the_sign_of_the_node_rate() {
    let parts = Parts {
        mean_j2: |elements| {
            let right = SecularRates::j2(elements);
            let rates = SecularRates {
                raan_rad_s: -right.raan_rad_s,
                ..right
            };
            SecularOrbit::new(elements, rates)
        },
        ..Parts::default()
    };
    let checks = [
        "sgp4/mean-j2/sgp4/cross-track-rms",
        "sgp4/rates/node/mean-j2",
        "analytic/rates/node",
    ];
    assert_fails(parts, &checks, &SECULAR);
}

#[test]
fn another_reference_radius() {
    let parts = Parts {
        mean_j2: |elements| {
            SecularOrbit::j2(&MeanElements {
                semi_major_axis_km: elements.semi_major_axis_km - 7.137,
                ..*elements
            })
        },
        ..Parts::default()
    };
    let checks = [
        "sgp4/mean-j2/sgp4/radial-rms",
        "sgp4/mean-j2/sgp4/in-track-growth",
    ];
    assert_fails(parts, &checks, &SECULAR);
}

#[test]
fn a_geocentric_vertical() {
    let parts = Parts {
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
    };
    assert_fails(parts, &["geographiclib/elevation"], &["geographiclib/"]);
}

#[test]
fn a_spherical_earth() {
    let parts = Parts {
        local_frame: |_, latitude, longitude| LocalFrame::new(Surface::Sphere, latitude, longitude),
        ..Parts::default()
    };
    assert_fails(parts, &["geographiclib/elevation"], &["geographiclib/"]);
}

#[test]
fn swapped_azimuth_axes() {
    let parts = Parts {
        look_angles: |local, target| {
            let swapped = LocalFrame {
                east: local.north,
                north: local.east,
                ..*local
            };
            swapped.look_angles(target)
        },
        ..Parts::default()
    };
    assert_fails(
        parts,
        &["geographiclib/azimuth"],
        &["geographiclib/azimuth"],
    );
}

#[test]
fn sidereal_time_off_by_a_minute() {
    let parts = Parts {
        gmst_rad: |epoch, elapsed_s| epoch.gmst_rad(elapsed_s + 60.0),
        ..Parts::default()
    };
    assert_fails(
        parts,
        &["sgp4/sidereal-time"],
        &["sgp4/sidereal-time", "analytic/geometry"],
    );
}

#[test]
fn star_for_delta() {
    let parts = Parts {
        satellites: |design| {
            Design::new(DesignParameters {
                pattern: Pattern::Star,
                ..design.parameters()
            })
            .unwrap()
            .satellites()
        },
        ..Parts::default()
    };
    assert_fails(
        parts,
        &["analytic/symmetry/turn"],
        &["analytic/symmetry/turn", "analytic/mean-visible"],
    );
}

#[test]
fn a_wrong_number_of_clocks() {
    let parts = Parts {
        clocks: |meant| match meant {
            Clocks::PerSystem => Clocks::Shared,
            Clocks::Shared => Clocks::PerSystem,
        },
        ..Parts::default()
    };
    assert_fails(
        parts,
        &["analytic/geometry/mean-pdop"],
        &["analytic/geometry/mean-pdop", "analytic/geometry/max-pdop"],
    );
}

/// The frozen eccentricity at ω = 90° is doubled, not cancelled.
#[test]
fn the_frozen_eccentricity_at_90_degrees() {
    let parts = Parts {
        cancelling_perigee_deg: 90.0,
        ..Parts::default()
    };
    let check = "sgp4/frozen-eccentricity/cancelled";
    assert_fails(parts, &[check], &[check]);
}
