//! Views, outages, weights and dilutions of whole studies against an evaluation in numpy.

use super::*;
use crate::stats::Summary;
use serde_json::Value;

/// Made by `validation/external/make_counts.py`.
const COUNTS: &str = include_str!("../../../validation/cases/counts.json");

fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap()
}

fn study(study: &Value) -> (Setup, Design) {
    let pair = |key: &str| [0, 1].map(|n| study[key][n].as_f64().unwrap());
    let step_deg = number(study, "step_deg");
    let region = Grid {
        latitude_deg: pair("latitude_deg"),
        longitude_deg: pair("longitude_deg"),
        step_deg: [step_deg; 2],
        weights: match study["weights"].as_str() {
            Some("cos-latitude") => PointWeights::CosLatitude,
            _ => PointWeights::Equal,
        },
    };
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, number(study, "duration_s"), number(study, "step_s")).unwrap();
    let gnss = match study["beidou_3"].as_bool() {
        Some(true) => vec![Preset::Beidou3.into()],
        _ => vec![],
    };
    let metrics = MetricOptions {
        availability_pdop: number(study, "availability_pdop"),
        ..MetricOptions::default()
    };
    let setup = Setup::new(grid, region.sites(Surface::Sphere).unwrap())
        .with_mask(Mask::from_degrees(number(study, "mask_deg")).unwrap())
        .with_gnss(gnss)
        .with_pdop_cap(number(study, "pdop_cap"))
        .with_metrics(metrics);
    let notation = format!(
        "delta:{}:{}/{}/{}@{}",
        study["inclination_deg"],
        study["satellites"],
        study["planes"],
        study["phasing"],
        study["altitude_km"]
    );
    (setup, notation.parse().unwrap())
}

/// Fractions and means of counts; decisions at the mask may differ by rounding, but none does here.
fn exact(ours: f64, theirs: f64, what: &str) {
    assert!(
        (ours - theirs).abs() <= 1e-9 * theirs.abs().max(1.0),
        "{what}: {ours} {theirs}"
    );
}

/// The project's gate for values in f32.
fn close(ours: f64, theirs: f64, what: &str) {
    assert!(
        (ours / theirs - 1.0).abs() < 1e-6,
        "{what}: {ours} {theirs}"
    );
}

fn check_metrics(metrics: &Metrics, expected: &Value) {
    for (name, ours) in [
        ("mean_visible", metrics.mean_visible),
        ("mean_gnss_visible", metrics.mean_gnss_visible),
        ("mean_total_visible", metrics.mean_total_visible),
        ("solved_fraction", metrics.solved_fraction),
        ("availability", metrics.availability),
        ("longest_outage_s", metrics.longest_outage_s),
        ("least_visible", metrics.least_visible.into()),
    ] {
        exact(ours, number(expected, name), name);
    }
    assert_eq!(expected["longest_outage_cut"], metrics.longest_outage_cut);
    check_coverage([metrics.coverage, metrics.coverage_total], expected);
}

fn check_coverage([leo, total]: [Coverage; 2], expected: &Value) {
    for (name, coverage) in [("coverage", leo), ("coverage_total", total)] {
        for (n, share) in coverage.shares().into_iter().enumerate() {
            exact(share, expected[name][n].as_f64().unwrap(), name);
        }
    }
}

/// Differences of values in f32; null and absent are the same.
fn check_gain(ours: Option<f64>, expected: &Value, what: &str) {
    match (ours, expected.as_f64()) {
        (Some(ours), Some(theirs)) => {
            assert!((ours - theirs).abs() < 5e-6, "{what}: {ours} {theirs}");
        }
        (None, None) => {}
        (ours, theirs) => panic!("{what}: {ours:?} {theirs:?}"),
    }
}

/// Histograms, gain, and the cuts by point and by instant.
fn check_further(evaluator: &Evaluator, ephemeris: &Ephemeris, case: &Value) {
    let expected = &case["metrics"];
    let (metrics, histograms) = evaluator.evaluate_views(ephemeris).unwrap();
    let series = evaluator.series(ephemeris).unwrap();
    assert_eq!(series.histograms, histograms);
    for (name, ours) in [
        ("histogram_leo", &histograms.leo),
        ("histogram_gnss", &histograms.gnss),
        ("histogram_all", &histograms.all),
    ] {
        let theirs = expected[name].as_array().unwrap();
        assert_eq!(theirs.len(), ours.len(), "{name}");
        for (ours, theirs) in ours.iter().zip(theirs) {
            exact(*ours, theirs.as_f64().unwrap(), name);
        }
    }
    let gain = evaluator.with_gain(metrics).unwrap().gain;
    assert_eq!(gain.is_some(), expected["gain"].is_object());
    for (name, ours) in gain.iter().flat_map(Gain::named) {
        if !name.ends_with("dop") || name.ends_with("_pdop") {
            check_gain(ours, &expected["gain"][name], name);
        }
    }
    for (ours, theirs) in series.points.iter().zip(case["points"].as_array().unwrap()) {
        exact(
            ours.availability,
            number(theirs, "availability"),
            "availability",
        );
        check_coverage([ours.coverage, ours.coverage_total], theirs);
        check_gain(ours.gain_mean_pdop, &theirs["gain_mean_pdop"], "of a point");
    }
    for theirs in case["instants"].as_array().unwrap() {
        let ours = &series.epochs[theirs["number"].as_u64().unwrap() as usize];
        exact(
            ours.availability,
            number(theirs, "availability"),
            "availability",
        );
        check_coverage([ours.coverage, ours.coverage_total], theirs);
        check_gain(
            ours.gain_mean_pdop,
            &theirs["gain_mean_pdop"],
            "of an instant",
        );
    }
}

/// The 95 % height error with ranges of 1 m, over all samples.
fn check_error95(setup: &Setup, ephemeris: &Ephemeris, expected: &Value) {
    let metre = RangeError::constant(1.0);
    let setup = setup.clone().with_accuracy(Accuracy {
        leo: metre,
        gnss: vec![metre; setup.gnss.len()],
    });
    let evaluator = Evaluator::new(setup).unwrap();
    let accuracy = evaluator.accuracy(ephemeris).unwrap().unwrap();
    exact(
        accuracy.solved_fraction,
        number(expected, "solved_fraction"),
        "solved",
    );
    match expected["error95_v_m"].as_f64() {
        Some(theirs) => close(accuracy.error95_v_m.unwrap(), theirs, "error95_v_m"),
        None => assert_eq!(accuracy.error95_v_m, None),
    }
}

fn check_summary(name: &str, ours: Summary, expected: &Value) {
    for (statistic, ours) in [
        ("mean", ours.mean),
        ("p50", ours.p50),
        ("p95", ours.p95),
        ("p99", ours.p99),
        ("max", ours.max),
        ("cvar", ours.cvar),
    ] {
        let key = format!("{statistic}_{name}");
        close(ours, number(expected, &key), &key);
    }
}

/// Weighted and unweighted, with outages that the ends of the span cut and that they do not.
#[test]
fn validate_whole_studies_against_numpy() {
    let cases: Vec<Value> = serde_json::from_str(COUNTS).unwrap();
    for case in cases {
        let (setup, design) = study(&case["study"]);
        let expected = &case["metrics"];
        let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
        let mut asking = setup.clone();
        asking.metrics.asks_for_hdop = true;
        let asked = Evaluator::new(asking).unwrap().evaluate(&design).unwrap();
        check_metrics(&asked, expected);
        close(
            asked.p95_hdop.unwrap(),
            number(expected, "p95_hdop"),
            "p95_hdop",
        );
        close(
            asked.p95_vdop.unwrap(),
            number(expected, "p95_vdop"),
            "p95_vdop",
        );
        let evaluator = Evaluator::new(setup).unwrap();
        assert_eq!(evaluator.evaluate(&design).unwrap().p95_hdop, None);
        check_metrics(&evaluator.evaluate_plain(&ephemeris).unwrap(), expected);
        check_further(&evaluator, &ephemeris, &case);
        check_error95(evaluator.setup(), &ephemeris, expected);
        let dops = evaluator.dops(&ephemeris).unwrap();
        check_summary("pdop", dops.pdop.unwrap(), expected);
        check_summary("hdop", dops.hdop.unwrap(), expected);
        check_summary("vdop", dops.vdop.unwrap(), expected);
        let series = evaluator.series(&ephemeris).unwrap();
        let points = &series.points;
        let theirs = case["points"].as_array().unwrap();
        assert_eq!(points.len(), theirs.len());
        for (n, (ours, theirs)) in points.iter().zip(theirs).enumerate() {
            let of_point: Vec<Outage> = series.outages(n).collect();
            assert_eq!(theirs["outages"], ours.outages);
            assert_eq!(of_point.len(), ours.outages as usize);
            let total: f64 = of_point.iter().map(|one| one.length_s).sum();
            exact(total, ours.total_outage_s, "outages");
            let is_cut = of_point.iter().any(|one| one.is_cut);
            assert_eq!(is_cut, ours.outage_cut);
            assert_eq!(theirs["outage_cut"], ours.outage_cut);
            assert_eq!(theirs["least_visible"], ours.least_visible);
            exact(
                ours.longest_outage_s,
                number(theirs, "longest_outage_s"),
                "longest",
            );
            exact(
                ours.total_outage_s,
                number(theirs, "total_outage_s"),
                "total",
            );
        }
    }
}
