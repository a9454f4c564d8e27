//! LEO clocks: one for all, or one for each part.

use super::*;
use crate::ephemeris::EphemerisSatellite;
use testing::{design_matrix, observed};

fn study() -> Setup {
    let base = setup([3.0, 54.0], Surface::Wgs84);
    let site = |latitude, weight| Site::new(Surface::Wgs84, latitude, 100.0, weight).unwrap();
    Setup {
        sites: vec![site(-40.0, 1.0), site(30.0, 2.0), site(60.0, 1.0)],
        grid: TimeGrid::new(base.grid.epoch(), 3600.0, 400.0).unwrap(),
        ..base
    }
}

const HYBRID: &str = "delta:53:60/6/1@1000+star:87:30/5/1@1100";

/// Mean and maximum PDOP by inverting the full matrix, with a clock for each system and each part.
#[test]
fn validate_clocks_of_parts_against_inversion() {
    let setup = study().with_leo_clocks(LeoClocks::PerPart);
    let design: Design = HYBRID.parse().unwrap();
    let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
    let (mut sum, mut total, mut max) = (0.0, 0.0, 0.0_f64);
    for elapsed_s in setup.grid.iter() {
        for site in &setup.sites {
            let found = observed(&setup, &ephemeris, site, elapsed_s);
            let found: Vec<_> = found.iter().collect();
            let clocks: Vec<usize> = found.iter().map(|one| 10 * one.system + one.part).collect();
            let rows = design_matrix(&found, &clocks);
            let cofactors = (rows.transpose() * rows).try_inverse().unwrap();
            let pdop = (cofactors[(0, 0)] + cofactors[(1, 1)] + cofactors[(2, 2)]).sqrt();
            sum += site.weight * pdop;
            total += site.weight;
            max = max.max(pdop);
        }
    }
    let evaluator = Evaluator::new(setup.clone()).unwrap();
    let metrics = evaluator.evaluate(&design).unwrap();
    let plain = evaluator.evaluate_plain(&ephemeris).unwrap();
    let dops = evaluator.dops(&ephemeris).unwrap();
    // The lanes keep values in f32, 6e-8.
    for (ours, expected, tolerance) in [
        (plain.mean_pdop, sum / total, 1e-10),
        (plain.max_pdop, max, 1e-10),
        (metrics.mean_pdop, sum / total, 1e-7),
        (metrics.max_pdop, max, 1e-7),
        (dops.pdop.map(|of| of.mean), sum / total, 1e-7),
    ] {
        let ours = ours.unwrap();
        let apart = (ours / expected - 1.0).abs();
        assert!(apart < tolerance, "{ours} {expected}");
    }
    let shared = Evaluator::new(study()).unwrap().evaluate(&design).unwrap();
    assert!(shared.mean_pdop.unwrap() < metrics.mean_pdop.unwrap() - 0.005);
    assert_eq!(shared.mean_visible, metrics.mean_visible);
    // The clocks of both shells are one entry.
    let names: Vec<&str> = dops
        .tdop
        .iter()
        .map(|clock| clock.system.as_str())
        .collect();
    assert_eq!(names, ["leo", "beidou-3"]);
}

/// A clock more or less cannot matter to one part, nor where all systems share a clock.
#[test]
fn one_part_has_one_clock() {
    let evaluate = |setup: Setup, text: &str| {
        let design: Design = text.parse().unwrap();
        Evaluator::new(setup).unwrap().evaluate(&design).unwrap()
    };
    let single = "delta:53:60/6/1@1000";
    let parts = || study().with_leo_clocks(LeoClocks::PerPart);
    assert_eq!(evaluate(parts(), single), evaluate(study(), single));
    let shared = |setup: Setup| evaluate(setup.with_clocks(Clocks::Shared), HYBRID);
    assert_eq!(shared(parts()), shared(study()));
}

/// Parts of an ephemeris follow those of another, and satellites of files are divided by file.
#[test]
fn parts_are_numbered_on() {
    let setup = study();
    let of = |text: &str| {
        let design: Design = text.parse().unwrap();
        Ephemeris::of_design(&design, setup.model, setup.grid).unwrap()
    };
    let satellites: Vec<EphemerisSatellite> = of("delta:53:3/1/0@900").into_satellites();
    let files = Ephemeris::new(setup.grid, satellites).with_parts(vec![1, 0, 1]);
    let all = of("delta:53:2/1/0@1000+star:87:1/1/0@1100").joined(files);
    assert_eq!(all.parts(), [0, 0, 1, 3, 2, 3]);
    assert_eq!(all.part_count(), 4);
    assert_eq!(Ephemeris::new(setup.grid, Vec::new()).part_count(), 0);
}
