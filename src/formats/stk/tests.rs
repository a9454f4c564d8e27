use super::*;
use crate::constellation::Design;
use crate::ephemeris::Ephemeris;
use crate::formats::kept_states::KeptStates;
use crate::formats::metadata::Theory;
use crate::formats::text::finding::{Finding, FindingList};
use crate::formats::text::timestamp::TimeSystem;
use crate::keyword::Keyword;
use crate::orbit::Model;
use crate::time::{Epoch, TimeGrid};
use nalgebra::Vector3;
use proptest::prelude::*;

/// In the layout of the help page: metres by default, keywords in another order and case.
const METRES: &str = "\
stk.v.11.0
# WrittenBy somebody
BEGIN Ephemeris
numberofephemerispoints 2
ScenarioEpoch \"1 Jul 2007 12:00:00.50\"
CoordinateSystem Fixed
CentralBody Earth
InterpolationMethod Lagrange
InterpolationSamplesM1 5
EphemerisTimePosVel
0.0e+000 7.0e+006 0.0 0.0 0.0 7.5e+003 0.0
60 6.9e+006 4.0e+005 0.0 -1.0 7.4e+003 0.0
END Ephemeris
";

/// The findings, which do not depend on what is kept.
fn findings(text: impl AsRef<[u8]>) -> Vec<Finding> {
    let [all, none] = [KeptStates::All, KeptStates::None].map(|kept| {
        let mut findings = FindingList::of_linter(20);
        parse_kept(text.as_ref(), &mut findings, kept).unwrap();
        findings.into_vec()
    });
    assert_eq!(all, none);
    all
}

fn written(frame: Frame, step_s: f64) -> String {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00.25Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 7_200.0, step_s).unwrap();
    let design: Design = "delta:55:6/3/1@925".parse().unwrap();
    let ephemeris = Ephemeris::of_design(&design, Model::J2, grid).unwrap();
    let metadata = Metadata {
        originator: "NAVWALKER".to_owned(),
        creation: epoch,
        frame,
        time_system: TimeSystem::Utc,
        theory: Theory::Propagated(Model::J2),
        subject: vec!["Design: delta:55:6/3/1@925".to_owned()],
        frame_note: None,
        from_files: false,
    };
    let sampled = Sampled::new(&ephemeris, frame);
    let satellite = &ephemeris.satellites()[1];
    let hermite = Hermite::measured(&sampled, satellite).unwrap();
    let mut out = Vec::new();
    write(
        &mut out,
        "NW-P01-S02",
        &metadata,
        &sampled,
        satellite,
        hermite,
    )
    .unwrap();
    String::from_utf8(out).unwrap()
}

#[test]
fn validate_units_and_epoch_of_the_documented_layout() {
    assert_eq!(findings(METRES), []);
    let file = read(METRES.as_bytes()).unwrap();
    assert_eq!(file.frame, Frame::EarthFixed);
    assert_eq!(file.scenario_epoch.to_string(), "2007-07-01 12:00:00.500");
    assert_eq!(file.interpolation_samples_m1, Some(5));
    assert_eq!(file.states[1].0, 60.0);
    assert_eq!(
        file.states[0].1.position_km.km(),
        Vector3::new(7000.0, 0.0, 0.0)
    );
    assert_eq!(file.states[0].1.velocity_km_s.y, 7.5);
}

#[test]
fn what_is_written_reads_back_and_writes_the_same() {
    for (frame, step_s) in Frame::ALL.iter().zip([60.0, 0.1 + 299.7, 97.0, 3_600.0]) {
        let text = written(*frame, step_s);
        assert_eq!(findings(&text), [], "{frame}");
        let file = read(text.as_bytes()).unwrap();
        assert_eq!(file.frame, *frame);
        let mut again = Vec::new();
        file.write(&mut again).unwrap();
        assert_eq!(String::from_utf8(again).unwrap(), text);
    }
    let text = written(Frame::Eme2000, 60.0);
    assert!(text.contains("\nScenarioEpoch 01 Jan 2025 00:00:00.250000000\n"));
    assert!(text.contains("\nInterpolationSamplesM1 3\n") && !text.contains("Order"));
}

#[test]
fn broken_rules_are_named_with_their_place() {
    let cases = [
        ("stk.v.11.0", "stk", (1, 1, "stk-version")),
        ("BEGIN Ephemeris\n", "", (3, 1, "stk-begin")),
        ("points 2", "points 3", (4, 1, "stk-count")),
        ("1 Jul 2007", "1 Jux 2007", (5, 16, "stk-value")),
        ("System Fixed", "System Moon", (6, 18, "stk-value")),
        ("Body Earth", "Body Mars", (7, 13, "stk-value")),
        ("CoordinateSystem Fixed\n", "", (9, 1, "stk-missing")),
        ("TimePosVel\n", "LLATimePos\n", (10, 1, "stk-keyword")),
        (
            "CentralBody",
            "TimeFormat JDate\nCentralBody",
            (7, 12, "stk-time-format"),
        ),
        ("Method Lagrange", "Method Spline", (8, 21, "stk-value")),
        ("TimePosVel\n", "TimePosVelAcc\n", (11, 1, "stk-fields")),
        (" 7.0e+006", " 7.0e+003", (11, 1, "implausible-state")),
        (
            "CentralBody",
            "DistanceUnit Kilometers\nCentralBody",
            (12, 1, "implausible-state"),
        ),
        ("\n60 ", "\n0 ", (12, 1, "stk-time-order")),
        // Nearer than two instants can be.
        ("\n60 ", "\n1e-320 ", (12, 1, "stk-time-order")),
        // Instants end before, so that two rows would be at one.
        (
            "\n60 ",
            "\n1e14 6.9e6 0 0 0 7.4e3 0\n2e14 ",
            (13, 1, "stk-time-order"),
        ),
        ("\n60 ", "\nNaN ", (12, 1, "stk-number")),
        ("\n60 ", "\n", (12, 1, "stk-fields")),
        ("END Ephemeris\n", "", (12, 1, "stk-truncated")),
        (
            "END Ephemeris\n",
            "END Ephemeris\nmore\n",
            (14, 1, "stk-line"),
        ),
    ];
    for (from, to, expected) in cases {
        let text = METRES.replacen(from, to, 1);
        assert_ne!(text, METRES, "{from}");
        let found = findings(&text);
        let places: Vec<_> = found.iter().map(|f| (f.line, f.column, f.rule)).collect();
        assert!(places.contains(&expected), "{from:?}: {places:?}");
        assert!(read(text.as_bytes()).is_err());
    }
    for text in ["", "\n", "\0", "stk.v.4.3\n"] {
        assert!(read(text.as_bytes()).is_err(), "{text:?}");
    }
}

/// The rows of `METRES`, with other keywords before them and other lines among and after them.
fn changed(before: &str, rows: &str, behind: &str) -> String {
    let head =
        "stk.v.11.0\nBEGIN Ephemeris\nScenarioEpoch 1 Jul 2007 12:00:00\nCoordinateSystem Fixed\n";
    format!("{head}{before}\n{rows}\n{behind}END Ephemeris\n")
}

/// Accelerations and covariances are skipped; a comment may contain any characters.
#[test]
fn further_columns_and_blocks_are_passed_over() {
    let rows = "0 7.0e6 0 0 0 7.5e3 0 0 0 0\n60 6.9E6 4.0e5 0 -1 7.4e3 0 0 0 0";
    let behind = "\nCovarianceTimePosVel\n0 1 0 0 1 0 0\n1 0 0 0\n60 1 0 0 1 0 0\n1 0 0 0\n";
    let before =
        "CovarianceFormat LowerTriangular\nTimeFormat EpSec\n# caf\u{e9}\nEphemerisTimePosVelAcc";
    let text = changed(before, rows, behind);
    let file = read(text.as_bytes()).unwrap();
    assert_eq!(file.states.len(), 2);
    assert_eq!(file.states[1].1.position_km.km().x, 6900.0);
    assert_eq!(file.states[1].1.velocity_km_s.y, 7.4);
    assert_eq!(file.comments, ["caf\u{e9}"]);
    let latin = [&b"stk.v.11.0\n# caf\xe9\n"[..], &text.as_bytes()[11..]].concat();
    assert_eq!(read(latin.as_slice()).unwrap().states, file.states);
    let found = findings(&latin);
    assert!(found.iter().all(|f| f.rule == "character"), "{found:?}");
}

/// Nothing is interpolated across a boundary, whether it has two rows, one, or none.
#[test]
fn segments_are_arcs_of_their_own() {
    let row = |t: f64, x: f64| format!("{t} {x} 0 0 0 7500 0\n");
    let block = "BEGIN SegmentBoundaryTimes\n0\n1.2e+002\n180\nEND SegmentBoundaryTimes\nEphemerisTimePosVel";
    let rows = |middle: &[(f64, f64)]| {
        let ends = [(0.0, 7e6), (60.0, 7.1e6)];
        let rows = ends.iter().chain(middle).chain(&[(180.0, 7.3e6)]);
        rows.map(|(t, x)| row(*t, *x)).collect::<String>()
    };
    for (middle, counts) in [
        (&[(120.0, 7.2e6), (120.0, 7.5e6)][..], [3, 2]),
        (&[(120.0, 7.2e6)], [3, 2]),
        (&[(130.0, 7.2e6)], [2, 2]),
    ] {
        let text = changed(block, &rows(middle), "");
        assert_eq!(findings(&text), [], "{middle:?}");
        let file = read(text.as_bytes()).unwrap();
        let arcs = file.clone().into_arcs();
        let arcs: Vec<usize> = arcs.iter().map(|arc| arc.nodes.len()).collect();
        assert_eq!(arcs, counts, "{middle:?}");
        let mut again = Vec::new();
        file.write(&mut again).unwrap();
        assert_eq!(
            read(again.as_slice()).unwrap().into_arcs(),
            file.into_arcs()
        );
    }
    // A boundary at the first row, which is there twice: a segment of one row, and the others.
    let twice = row(0.0, 7e6) + &rows(&[]);
    let arcs = read(changed(block, &twice, "").as_bytes())
        .unwrap()
        .into_arcs();
    let counts: Vec<usize> = arcs.iter().map(|arc| arc.nodes.len()).collect();
    assert_eq!(counts, [1, 2, 1]);
    // Without states, an arc tells when it is valid.
    let mut findings_of_none = FindingList::of_linter(20);
    let text = changed(block, &twice, "");
    let none = parse_kept(text.as_bytes(), &mut findings_of_none, KeptStates::None).unwrap();
    let spans = |arcs: &[Arc]| Vec::from_iter(arcs.iter().map(|arc| arc.useable));
    let none = none.unwrap().into_arcs();
    assert_eq!(spans(&none), spans(&arcs));
    assert!(none.iter().all(|arc| arc.nodes.is_empty()));
    let three = changed(
        block,
        &rows(&[(120.0, 7e6), (120.0, 7e6), (120.0, 7e6)]),
        "",
    );
    assert_eq!(findings(&three)[0].rule, "stk-time-order");
}

/// Positions alone: the velocities of a segment come from its own rows, on both sides of a manoeuvre.
#[test]
fn velocities_are_not_derived_across_a_boundary() {
    let block = "BEGIN SegmentBoundaryTimes\n120\nEND SegmentBoundaryTimes\nEphemerisTimePos";
    let row = |t: f64, x: f64| format!("{t} {x} 0 0\n");
    let before = [0.0, 60.0, 120.0].map(|t| row(t, 7e6 + 100.0 * t));
    let after = [180.0, 240.0].map(|t| row(t, 7e6 + 12_000.0 - 200.0 * (t - 120.0)));
    let shared = row(120.0, 7e6 + 12_000.0);
    for (boundary, count) in [("", 5), (shared.as_str(), 6)] {
        let rows = format!("{}{boundary}{}", before.concat(), after.concat());
        let file = read(changed(block, &rows, "").as_bytes()).unwrap();
        assert_eq!(file.states.len(), count);
        for (k, (_, state)) in file.states.iter().enumerate() {
            let expected = if k < 3 { 0.1 } else { -0.2 };
            // Both sides are straight lines: rounding of 7012 km over 60 s.
            let apart = (state.velocity_km_s.x - expected).abs();
            assert!(apart < 1e-13, "{boundary:?} {k}: {}", state.velocity_km_s.x);
        }
    }
}

#[test]
fn the_interpolation_is_that_of_the_file() {
    for (keywords, expected) in [
        ("", Interpolation::Lagrange(5)),
        (
            "InterpolationMethod Lagrange\nInterpolationSamplesM1 7\n",
            Interpolation::Lagrange(7),
        ),
        (
            "InterpolationMethod LagrangeVOP\nInterpolationOrder 7\n",
            Interpolation::Lagrange(7),
        ),
        (
            "InterpolationMethod Hermite\nInterpolationSamplesM1 3\n",
            Interpolation::Hermite(7),
        ),
    ] {
        let text = changed(
            &format!("{keywords}EphemerisTimePosVel"),
            "0 7e6 0 0 0 7500 0",
            "",
        );
        assert_eq!(
            read(text.as_bytes()).unwrap().into_arcs()[0].interpolation,
            expected,
            "{keywords}"
        );
    }
}

/// Velocities in km/s where the positions are in metres.
#[test]
fn velocities_in_another_unit_are_told() {
    let row = |k: u32, unit: f64| {
        let (t, u) = (60.0 * f64::from(k), 0.06 * f64::from(k));
        let (x, y) = (7e6 * u.cos(), 7e6 * u.sin());
        format!(
            "{t} {x} {y} 0 {} {} 0\n",
            -7000.0 * u.sin() * unit,
            7000.0 * u.cos() * unit
        )
    };
    let file = |unit: f64| {
        let rows: String = (0..20).map(|k| row(k, unit)).collect();
        changed("EphemerisTimePosVel", &rows, "")
    };
    assert_eq!(findings(file(1.0)), []);
    assert_eq!(findings(file(1e-3))[0].rule, "stk-velocity-unit");
}

proptest! {
    #[test]
    fn damaged_files_never_panic(at in 0..METRES.len(), byte in any::<u8>(), cut in 0_usize..40) {
        let mut bytes = METRES.as_bytes().to_vec();
        bytes[at] = byte;
        bytes.drain(at..(at + cut).min(METRES.len()));
        let _ = findings(&bytes);
    }
}
