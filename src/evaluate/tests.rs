mod clocks;
mod counted;
mod limits;
mod metres;
mod outages;
mod products;
mod skies;

use super::*;
use crate::constellation::Shell;
use crate::constellation::gnss::Preset;
use crate::earth::{RADIUS_KM, Surface};
use crate::ground::{Grid, PointWeights};
use crate::time::Epoch;

pub(super) fn setup(latitude_deg: [f64; 2], surface: Surface) -> Setup {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let region = Grid {
        latitude_deg,
        longitude_deg: [73.0, 136.0],
        step_deg: [5.0, 5.0],
        weights: PointWeights::Equal,
    };
    let grid = TimeGrid::new(epoch, 86_400.0, 60.0).unwrap();
    testing::setup(grid, region.sites(surface).unwrap(), 7.0)
}

/// Time-mean visible count of a circular constellation from one latitude of a sphere, by a
/// one-dimensional integral over the argument of latitude, without any time step: a satellite
/// at latitude δ is over the cap of half-angle ψ around a point at latitude φ for a fraction
/// H/π of all longitudes, with cos H = (cos ψ - sin φ sin δ) / (cos φ cos δ).
fn visible_by_quadrature(shell: &Shell, latitude_rad: f64, mask_rad: f64) -> f64 {
    let radius = RADIUS_KM + shell.altitude_km();
    let cap = (RADIUS_KM / radius * mask_rad.cos()).acos() - mask_rad;
    let sin_i = shell.inclination_deg().to_radians().sin();
    let steps = 20_000;
    let mut share = 0.0;
    for n in 0..steps {
        let u = (n as f64 + 0.5) / f64::from(steps) * std::f64::consts::TAU;
        let declination = (sin_i * u.sin()).asin();
        let cos_h = (cap.cos() - latitude_rad.sin() * declination.sin())
            / (latitude_rad.cos() * declination.cos());
        share += cos_h.clamp(-1.0, 1.0).acos() / std::f64::consts::PI;
    }
    shell.satellite_count() as f64 * share / f64::from(steps)
}

/// A day does not cover all longitudes evenly, which causes up to 0.02 of 8 satellites.
#[test]
fn validate_visible_count_by_quadrature() {
    for text in [
        "delta:55:182/13/1@925",
        "star:90:182/13/1@925",
        "delta:53:120/10/1@1000+star:87:77/7/1@1100",
    ] {
        let design: Design = text.parse().unwrap();
        let setup = Setup {
            gnss: vec![],
            ..setup([3.0, 54.0], Surface::Sphere)
        };
        let mask_rad = 7_f64.to_radians();
        let expected = setup
            .sites
            .iter()
            .flat_map(|site| design.shells().iter().map(move |shell| (site, shell)))
            .map(|(site, shell)| {
                visible_by_quadrature(shell, site.latitude_deg.to_radians(), mask_rad)
            })
            .sum::<f64>()
            / setup.sites.len() as f64;
        let metrics = Evaluator::new(setup).unwrap().evaluate(&design).unwrap();
        let apart = metrics.mean_visible - expected;
        assert!(
            apart.abs() < 0.02,
            "{text}: {} against {expected}",
            metrics.mean_visible
        );
    }
}

#[test]
fn what_is_never_seen_has_no_cost() {
    let design: Design = "delta:0:1/1/0@200".parse().unwrap();
    let evaluator = Evaluator::new(Setup {
        gnss: vec![],
        ..setup([80.0, 85.0], Surface::Wgs84)
    })
    .unwrap();
    let metrics = evaluator.evaluate(&design).unwrap();
    assert_eq!(metrics.mean_visible, 0.0);
    assert_eq!(
        (metrics.j_cost, metrics.j_pos, metrics.max_pdop),
        (None, None, None)
    );
    assert_eq!((metrics.solved_fraction, metrics.availability), (0.0, 0.0));
}

#[test]
fn a_higher_mask_sees_less() {
    let design: Design = "delta:55:24/6/1@925".parse().unwrap();
    let at = |mask_deg: f64| {
        let mask = Mask::from_degrees(mask_deg).unwrap();
        let evaluator = Evaluator::new(Setup {
            mask,
            ..setup([3.0, 54.0], Surface::Wgs84)
        })
        .unwrap();
        evaluator.evaluate(&design).unwrap().mean_visible
    };
    assert!(at(5.0) > at(10.0) && at(10.0) > at(40.0));
}

/// Without LEO satellites only the GNSS is in view, on both paths, whatever the clocks.
#[test]
fn no_satellites_leave_the_gnss_alone() {
    for clocks in [Clocks::PerSystem, Clocks::Shared] {
        let base = setup([3.0, 54.0], Surface::Sphere).with_clocks(clocks);
        let grid = TimeGrid::new(base.grid.epoch(), 86_400.0, 1200.0).unwrap();
        let evaluator = Evaluator::new(Setup { grid, ..base }).unwrap();
        let none = Ephemeris::new(grid, Vec::new());
        let lanes = evaluator.evaluate_ephemeris(&none).unwrap();
        let plain = evaluator.evaluate_plain(&none).unwrap();
        assert_eq!((lanes.mean_visible, lanes.j_cost), (0.0, None));
        assert_eq!(lanes.solved_fraction, plain.solved_fraction);
        assert_eq!(lanes.availability, plain.availability);
        // The project's gate for the lanes against the plain path.
        let apart = |a: Option<f64>, b: Option<f64>| (a.unwrap() / b.unwrap() - 1.0).abs();
        assert!(apart(lanes.mean_pdop, plain.mean_pdop) < 1e-7);
        assert!(apart(lanes.max_pdop, plain.max_pdop) < 1e-7);
        // BeiDou-3 over the region alone; with it a constellation is better.
        let design: Design = "delta:55:182/13/1@925".parse().unwrap();
        let both = evaluator.evaluate(&design).unwrap();
        assert!(lanes.mean_pdop > both.mean_pdop);
    }
}
