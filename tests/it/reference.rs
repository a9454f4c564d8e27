//! The evaluator against an independent one: `validation/cases/evaluate-reference.json`.

use navwalker::constellation::gnss::Preset;
use navwalker::constellation::{Design, Pattern, Shell, ShellParameters};
use navwalker::dop::Clocks;
use navwalker::earth::Surface;
use navwalker::evaluate::{Evaluator, Setup};
use navwalker::ground::{Grid, PointWeights};
use navwalker::time::{Epoch, TimeGrid};
use navwalker::visibility::Mask;
use serde::Deserialize;

/// Two f64 evaluators that follow the same conventions agree to 1e-9; 1e-7 leaves room for
/// another order of summation and still catches a single flipped visibility decision in 1.6
/// million (6e-7).
const RELATIVE_GATE: f64 = 1e-7;

/// The maximum is one sample, in which the worst geometry magnifies rounding.
const MAXIMUM_GATE: f64 = 1e-5;

#[derive(Deserialize)]
struct Case {
    name: String,
    epoch: String,
    eccentricity: f64,
    arg_perigee_deg: f64,
    lattice_nc: Option<usize>,
    planes: usize,
    sats_per_plane: usize,
    inclination_deg: f64,
    altitude_km: f64,
    phasing: usize,
    raan_span_deg: f64,
    mask_deg: f64,
    gnss_mask_deg: f64,
    lat: [f64; 3],
    lon: [f64; 3],
    clock: String,
    hours: f64,
    step_s: f64,
    gnss: String,
    surface: String,
    mean_visible: f64,
    mean_pdop: f64,
    cvar95_pdop: f64,
    max_pdop: f64,
    solved_fraction: f64,
    j_cost: f64,
    j_pos: f64,
}

impl Case {
    fn design(&self) -> Design {
        let (pattern, phasing) = match (self.lattice_nc, self.raan_span_deg) {
            (Some(n_c), _) => (Pattern::Lattice, n_c),
            (None, 180.0) => (Pattern::Star, self.phasing),
            _ => (Pattern::Delta, self.phasing),
        };
        let shell = Shell::new(ShellParameters {
            pattern,
            planes: self.planes,
            satellites_per_plane: self.sats_per_plane,
            phasing,
            inclination_deg: self.inclination_deg,
            altitude_km: self.altitude_km,
        })
        .unwrap()
        .with_ellipse(self.eccentricity, self.arg_perigee_deg);
        shell.unwrap().into()
    }

    fn setup(&self) -> Setup {
        let epoch = Epoch::from_utc(self.epoch.parse().unwrap());
        let grid = Grid {
            latitude_deg: [self.lat[0], self.lat[1]],
            longitude_deg: [self.lon[0], self.lon[1]],
            step_deg: [self.lat[2], self.lon[2]],
            weights: PointWeights::Equal,
        };
        let surface = match self.surface.as_str() {
            "sphere" => Surface::Sphere,
            "wgs84" => Surface::Wgs84,
            other => panic!("surface {other}"),
        };
        let gnss = match self.gnss.as_str() {
            "all" => vec![Preset::Beidou3.into()],
            _ => vec![],
        };
        let clocks = match self.clock.as_str() {
            "shared" => Clocks::Shared,
            _ => Clocks::PerSystem,
        };
        let time = TimeGrid::new(epoch, self.hours * 3600.0, self.step_s).unwrap();
        Setup::new(time, grid.sites(surface).unwrap())
            .with_mask(Mask::from_degrees(self.mask_deg).unwrap())
            .with_gnss_mask(Mask::from_degrees(self.gnss_mask_deg).unwrap())
            .with_gnss(gnss)
            .with_clocks(clocks)
    }
}

#[test]
fn validate_metrics_against_an_independent_evaluator() {
    let text = include_str!("../../validation/cases/evaluate-reference.json");
    let cases: Vec<Case> = serde_json::from_str(text).unwrap();
    assert_eq!(cases.len(), 9);
    for case in &cases {
        let metrics = Evaluator::new(case.setup())
            .unwrap()
            .evaluate(&case.design())
            .unwrap();
        let compared = [
            (
                "mean_visible",
                Some(metrics.mean_visible),
                case.mean_visible,
                RELATIVE_GATE,
            ),
            (
                "mean_pdop",
                metrics.mean_pdop,
                case.mean_pdop,
                RELATIVE_GATE,
            ),
            (
                "cvar_pdop",
                metrics.cvar_pdop,
                case.cvar95_pdop,
                RELATIVE_GATE,
            ),
            ("max_pdop", metrics.max_pdop, case.max_pdop, MAXIMUM_GATE),
            (
                "solved_fraction",
                Some(metrics.solved_fraction),
                case.solved_fraction,
                RELATIVE_GATE,
            ),
            ("j_cost", metrics.j_cost, case.j_cost, RELATIVE_GATE),
            ("j_pos", metrics.j_pos, case.j_pos, RELATIVE_GATE),
        ];
        for (quantity, ours, theirs, gate) in compared {
            let ours = ours.unwrap();
            let apart = (ours / theirs - 1.0).abs();
            assert!(
                apart <= gate,
                "{}: {quantity} {ours} against {theirs}, {apart:e}",
                case.name
            );
        }
    }
}
