//! Metres, windows, LEO clocks and the regional systems against `validation/external/make_accuracy_cases.py`.

use super::*;
use serde_json::Value;

const CASES: &str = include_str!("../../../validation/cases/accuracy.json");

fn study() -> Setup {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 14_400.0, 600.0).unwrap();
    let points = [
        (-20.0, 80.0, 1.0),
        (12.97, 77.59, 2.0),
        (35.68, 139.77, 3.0),
    ];
    let site = |(latitude, longitude, weight)| {
        Site::new(Surface::Wgs84, latitude, longitude, weight).unwrap()
    };
    let error = |sigma_m, constant, by_elevation| RangeError {
        sigma_m,
        constant,
        by_elevation,
    };
    let gnss = [Preset::Beidou3, Preset::Qzss, Preset::Navic];
    testing::setup(grid, points.map(site).to_vec(), 7.0)
        .with_gnss(gnss.map(Into::into).to_vec())
        .with_accuracy(Accuracy {
            leo: error(0.5, 0.6, 0.3),
            gnss: vec![
                error(1.5, 1.0, 0.0),
                error(2.0, 0.0, 0.5),
                error(3.0, 1.0, 1.0),
            ],
        })
        .with_window_s(1800.0)
}

/// Sidereal time from Julian dates in another order of operations moves satellites by some 1e-9 rad.
fn require_equal(name: &str, ours: Option<f64>, cases: &Value, at: &str) {
    let expected = cases.pointer(at).and_then(Value::as_f64).unwrap();
    let ours = ours.unwrap();
    assert!(
        (ours / expected - 1.0).abs() < 1e-8,
        "{name}{at}: {ours} {expected}"
    );
}

#[test]
fn validate_metres_and_windows_against_numpy() {
    let cases: Value = serde_json::from_str(CASES).unwrap();
    let design: Design = "delta:53:60/6/1@1000+star:87:30/5/1@1100".parse().unwrap();
    let setup = study();
    let evaluate = |setup: &Setup| {
        // The lanes have six digits.
        let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
        let evaluator = Evaluator::new(setup.clone()).unwrap();
        evaluator.evaluate_plain(&ephemeris).unwrap()
    };
    let shared = evaluate(&setup);
    for (clocks, metrics) in [
        ("/pdop_shared", shared),
        (
            "/pdop_per_part",
            evaluate(&setup.clone().with_leo_clocks(LeoClocks::PerPart)),
        ),
    ] {
        require_equal("", metrics.mean_pdop, &cases, &format!("{clocks}/mean"));
        require_equal("", metrics.p95_pdop, &cases, &format!("{clocks}/p95"));
        require_equal("", metrics.cvar_pdop, &cases, &format!("{clocks}/cvar"));
    }
    let sigmas = [
        ("3d", shared.sigma_3d_m, shared.error95_3d_m),
        ("h", shared.sigma_h_m, shared.error95_h_m),
        ("v", shared.sigma_v_m, shared.error95_v_m),
    ];
    for (name, sigma, error) in sigmas {
        let sigma = sigma.flatten();
        let at = |part: &str| format!("/sigma_{name}_m/{part}");
        require_equal(name, sigma.map(|of| of.mean), &cases, &at("mean"));
        require_equal(name, sigma.map(|of| of.p95), &cases, &at("p95"));
        require_equal(name, sigma.map(|of| of.cvar), &cases, &at("cvar"));
        require_equal(name, error.flatten(), &cases, &format!("/error95_{name}_m"));
    }
    let of_window = shared.information_pdop.unwrap();
    require_equal("", of_window.mean, &cases, "/information_pdop/mean");
    require_equal("", of_window.p95, &cases, "/information_pdop/p95");
    require_equal("", of_window.cvar, &cases, "/information_pdop/cvar");
    assert_eq!(of_window.solved_fraction, 1.0);
}

/// A phase of 0 is the study itself; the spread of others stays within the tenths that a phase can move.
#[test]
fn phases_begin_with_the_study() {
    let design: Design = "delta:55:88/11/1@925".parse().unwrap();
    let setup = Setup {
        accuracy: None,
        window_s: None,
        gnss: vec![Preset::Beidou3.into()],
        ..study()
    };
    let mean = |setup: Setup| {
        let metrics = Evaluator::new(setup).unwrap().evaluate(&design).unwrap();
        metrics.mean_pdop.unwrap()
    };
    let base = mean(setup.clone());
    // Angles are wrapped once more: a few ulp.
    assert!((mean(setup.at_gnss_phase(0.0).unwrap()) - base).abs() < 1e-9);
    let moved = mean(setup.at_gnss_phase(0.3).unwrap()) - base;
    assert!(moved.abs() > 1e-3 && moved.abs() < 0.3, "{moved}");
    let none = Setup {
        gnss: Vec::new(),
        ..setup.clone()
    };
    assert_eq!(none.at_gnss_phase(0.5).unwrap_err(), PhaseError::NoGnss);
    let listed = crate::constellation::gnss::System::Listed {
        name: "mine".to_owned(),
        satellites: Vec::new(),
    };
    let given = Setup {
        gnss: vec![listed],
        ..setup
    };
    let error = given.at_gnss_phase(0.5).unwrap_err();
    assert_eq!(error, PhaseError::Given("mine".to_owned()));
}
