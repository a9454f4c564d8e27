use super::*;
use crate::constellation::Design;
use crate::earth::Surface;
use crate::ephemeris::Ephemeris;
use crate::evaluate::Evaluator;
use crate::evaluate::testing::setup;
use crate::exchange::export::testing::{in_memory, subject};
use crate::exchange::export::{Choices, Product};
use crate::ground::Site;
use crate::orbit::Model;

fn grid(from_s: f64, duration_s: f64, step_s: f64) -> TimeGrid {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    TimeGrid::new(epoch.plus_seconds(from_s), duration_s, step_s).unwrap()
}

fn design() -> Design {
    "delta:55:12/3/1@925".parse().unwrap()
}

fn text(product: Product) -> String {
    let files = in_memory(
        &subject(design(), grid(0.0, 7_200.0, 60.0)),
        &[product],
        Choices::default(),
    )
    .1;
    let (_, bytes) = files
        .into_iter()
        .find(|(path, _)| !path.ends_with("json"))
        .unwrap();
    String::from_utf8(bytes).unwrap()
}

fn fleet(text: &str) -> Fleet {
    Fleet::read(text.as_bytes(), None, Some("a.e"))
        .unwrap()
        .fleet
}

/// Off the step of the file, states are where the design is: within the truncation of each interpolation, and the note
/// says so.
#[test]
fn states_are_interpolated_off_the_step_of_the_file() {
    let between = grid(627.0, 3_000.0, 40.0);
    let truth = Ephemeris::of_design(&design(), Model::J2, grid(0.0, 7_200.0, 60.0)).unwrap();
    for (product, most_km) in [
        (Product::Oem, 1e-5),
        (Product::Sp3, 1e-5),
        (Product::Stk, 1e-5),
        (Product::Czml, 2.2e-3),
    ] {
        let fleet = fleet(&text(product));
        let found = fleet.propagate(between, Model::J2).unwrap();
        for (satellite, expected) in found.satellites().iter().zip(truth.satellites()) {
            for t in between.iter() {
                let found = found.state(satellite, t).unwrap();
                let expected = truth.state(expected, 627.0 + t).unwrap();
                let apart_km = (found.position_km - expected.position_km).norm();
                assert!(apart_km < most_km, "{product}: {apart_km}");
                assert!((found.velocity_km_s - expected.velocity_km_s).norm() < 1e-4);
            }
        }
        let notes = fleet.sampling_notes(between);
        let [
            SamplingNote::Interpolated {
                left_out_error_km: Some(km),
                ..
            },
        ] = notes[..]
        else {
            panic!("{product}: {notes:?}")
        };
        // CZML has its samples as far apart as a metre of error allows: 2^8 times that, and more at the ends.
        let most_km = if product == Product::Czml { 5.0 } else { 1e-3 };
        assert!(km < most_km, "{product}: {km}");
        assert!(notes[0].to_string().contains("are interpolated"));
        // At the samples of the file nothing is, except in CZML, whose samples lie wider.
        let at_samples = fleet.sampling_notes(grid(600.0, 3_000.0, 60.0));
        assert_eq!(at_samples.is_empty(), product != Product::Czml, "{product}");
    }
}

/// A record of zeros: both paths of the evaluator leave the satellite invisible there, and it is reported once.
#[test]
fn a_gap_is_no_view_and_is_told_once() {
    let sp3 = text(Product::Sp3);
    let lost = |line: &str| {
        let number: String = format!("{:14.6}", 0.0).repeat(3);
        match line.starts_with("PL03") || line.starts_with("VL03") {
            true => format!("{}{number} 999999.999999\n", &line[..4]),
            false => format!("{line}\n"),
        }
    };
    // The records of L03 at the tenth epoch alone, and at all.
    let mut epochs = 0;
    let mut gap = String::new();
    for line in sp3.lines() {
        epochs += usize::from(line.starts_with("* "));
        gap += &if epochs == 10 {
            lost(line)
        } else {
            format!("{line}\n")
        };
    }
    let grid = grid(0.0, 3_600.0, 60.0);
    let fleet_with_gap = fleet(&gap);
    let notes: Vec<String> = fleet_with_gap
        .sampling_notes(grid)
        .iter()
        .map(ToString::to_string)
        .collect();
    assert_eq!(notes.len(), 1, "{notes:?}");
    assert!(
        notes[0].ends_with("has no state at 1 of 60 instants, from 2025-01-01T00:09:00Z to 2025-01-01T00:09:00Z: it counts as not visible then"),
        "{notes:?}"
    );
    let site = |n: u32| {
        let (latitude_deg, longitude_deg) = (
            f64::from(n % 7) * 20.0 - 60.0,
            f64::from(n / 7) * 20.0 - 180.0,
        );
        Site::new(Surface::Wgs84, latitude_deg, longitude_deg, 1.0).unwrap()
    };
    let sites: Vec<Site> = (0..126).map(site).collect();
    let evaluator = Evaluator::new(setup(grid, sites, 5.0)).unwrap();
    let series = |fleet: &Fleet| {
        let ephemeris = fleet.propagate(grid, Model::J2).unwrap();
        let plain = evaluator.evaluate_plain(&ephemeris).unwrap();
        let kernel = evaluator.evaluate_ephemeris(&ephemeris).unwrap();
        assert!((plain.mean_visible - kernel.mean_visible).abs() < 1e-12);
        evaluator.series(&ephemeris).unwrap().epochs
    };
    let whole = series(&fleet(&sp3));
    let with_gap = series(&fleet_with_gap);
    let without: Vec<String> = sp3.lines().map(lost).collect();
    let mut without = fleet(&without.concat());
    assert_eq!(without.len(), 11);
    without.append(Fleet::Sampled(Vec::new()));
    let without = series(&without);
    for k in 0..60 {
        let expected = if k == 9 { &without[k] } else { &whole[k] };
        assert_eq!(with_gap[k].mean_visible, expected.mean_visible, "{k}");
    }
    assert!(whole[9].mean_visible > without[9].mean_visible);
}

/// A satellite whose own span ends early is without a state from then on; what none reaches is refused.
#[test]
fn a_satellite_that_ends_early_has_no_state_beyond() {
    let mut fleet = fleet(&text(Product::Sp3));
    if let Fleet::Sampled(trajectories) = &mut fleet {
        let arc = &mut trajectories[1].arcs[0];
        arc.useable.1 = arc.nodes[29].0;
    }
    let found = fleet
        .propagate(grid(0.0, 3_600.0, 90.0), Model::J2)
        .unwrap();
    let states = |t: f64| found.state_or_gap(&found.satellites()[1], t).unwrap();
    assert!(states(1_710.0).is_some() && states(1_800.0).is_none());
    assert!(
        fleet
            .propagate(grid(0.0, 10_800.0, 90.0), Model::J2)
            .is_err()
    );
}

/// Two days that share midnight: one arc if they have the same position then, and otherwise two with a note.
#[test]
fn days_that_differ_at_midnight_are_told() {
    let sp3 = text(Product::Sp3);
    let (head, records) = sp3.split_at(sp3.find("*  2025").unwrap());
    let records: Vec<&str> = records
        .trim_end()
        .strip_suffix("EOF")
        .unwrap()
        .split_inclusive("\n*")
        .collect();
    assert_eq!(records.len(), 120);
    let part = |from: usize, to: usize| {
        let body = records[from..to].concat();
        let body = body.strip_suffix('*').unwrap_or(&body);
        let star = if from == 0 { "" } else { "*" };
        let head = head.replacen("    120 ORBIT", &format!("{:>7} ORBIT", to - from), 1);
        fleet(&format!("{head}{star}{body}EOF\n"))
    };
    let joined = |km: f64| {
        let (mut first, mut next) = (part(0, 61), part(60, 120));
        if let Fleet::Sampled(trajectories) = &mut next {
            for arc in &mut trajectories[2].arcs {
                let (_, state) = &mut arc.nodes[0];
                state.position_km = state.position_km + nalgebra::Vector3::x() * km;
            }
        }
        first.append(next);
        first
    };
    let between = grid(630.0, 6_000.0, 60.0);
    let whole = fleet(&sp3);
    let arcs = |fleet: &Fleet| match fleet {
        Fleet::Sampled(trajectories) => trajectories.iter().map(|one| one.arcs.len()).collect(),
        other => vec![other.len()],
    };
    assert_eq!(arcs(&joined(0.0)), [1; 12]);
    assert_eq!(joined(0.0), whole);
    let apart = joined(2.3e-5);
    assert_eq!(arcs(&apart).iter().sum::<usize>(), 13);
    let notes: Vec<String> = apart
        .sampling_notes(between)
        .iter()
        .map(ToString::to_string)
        .collect();
    let expected = "the positions of 1 satellite differ at the instant that two files share, most by 23 mm (L03 at 2025-01-01T01:00:00Z): states are not interpolated across it";
    assert_eq!(notes.len(), 2, "{notes:?}");
    assert_eq!(notes[0].replace("NW-P01-S03", "L03"), expected);
    // Beyond the instants of the study nothing depends on it.
    assert_eq!(apart.sampling_notes(grid(600.0, 1_200.0, 60.0)), []);
}
