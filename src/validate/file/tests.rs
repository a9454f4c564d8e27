use super::*;
use crate::constellation::{Design, Shell};
use crate::ephemeris::EphemerisSatellite;
use crate::evaluate::Evaluator;
use crate::exchange::export::testing::{in_memory, subject};
use crate::exchange::export::{Choices, Product};
use crate::formats::trajectory::Trajectory;
use crate::frames::{Frame, Position, State, Teme, from_teme};
use crate::orbit::{Model, PropagationError};
use crate::time::{Epoch, TimeGrid};
use crate::validate::{Outcome, Subject, testing};

const DESIGN: &str = "delta:40:20/5/1@925";

fn epoch() -> Epoch {
    Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap())
}

fn grid() -> TimeGrid {
    TimeGrid::new(epoch(), 43_200.0, 300.0).unwrap()
}

fn evaluator() -> Evaluator {
    testing::evaluator(grid())
}

fn design() -> Shell {
    DESIGN.parse().unwrap()
}

/// The design as another program might have propagated it, sampled in TEME.
fn propagated(convention: &str) -> Vec<Comparand> {
    let evaluator = evaluator();
    let subject = Subject::new(design(), &evaluator);
    // 6371 km, from which other tools measure altitudes.
    let fitted = conventions::Fitted {
        radius_offset_km: -7.137,
    };
    conventions::propagated(&subject, convention, fitted)
        .into_iter()
        .map(|(name, propagation)| {
            let states = grid()
                .iter()
                .map(|t| (t, propagation.state_at(t).unwrap()))
                .map(|(t, state)| {
                    let declared = from_teme(state, Frame::Teme, epoch(), t);
                    (epoch().plus_seconds(t), declared)
                });
            let states = states.collect();
            Comparand::States(Trajectory::of_states(&name, &name, Frame::Teme, states))
        })
        .collect()
}

/// Satellites as a file of TEME states has them.
fn sampled(ephemeris: &Ephemeris) -> Vec<Comparand> {
    let one = |satellite: &EphemerisSatellite| {
        let states = ephemeris.states(satellite).map(|sample| {
            let (t, state) = sample.unwrap();
            (
                epoch().plus_seconds(t),
                from_teme(state, Frame::Teme, epoch(), t),
            )
        });
        let (name, states) = (&satellite.name, states.collect());
        Comparand::States(Trajectory::of_states(name, name, Frame::Teme, states))
    };
    ephemeris.satellites().iter().map(one).collect()
}

fn renamed(mut comparands: Vec<Comparand>) -> Vec<Comparand> {
    for (n, comparand) in comparands.iter_mut().enumerate() {
        if let Comparand::States(trajectory) = comparand {
            trajectory.name = format!("SAT{n}");
        }
    }
    comparands
}

fn compared(comparands: &[Comparand]) -> Result<Findings, ValidateError> {
    let evaluator = evaluator();
    let expected = ReferenceConstellation::of_design(&design().into(), &evaluator)?;
    against_file(&expected, "test", comparands)
}

/// Conventions that move satellites already at the first sample.
fn is_another_place(convention: &str) -> bool {
    let elsewhere = ["star-for-delta", "phasing-", "earth-fixed"];
    elsewhere.iter().any(|part| convention.contains(part))
}

/// Every convention of the list is recognised in an ephemeris made with it, whether objects have
/// the names of the slots or other names.
#[test]
fn each_convention_explains_its_own_ephemeris() {
    for name in conventions::names().filter(|name| *name != "mean-j2") {
        // This mistake cannot be made with a delta pattern.
        if name == "delta-for-star" {
            continue;
        }
        for (how, comparands) in [
            ("name", propagated(name)),
            ("place", renamed(propagated(name))),
        ] {
            let findings = compared(&comparands).unwrap();
            let comparison = &findings.files[0];
            let found = comparison
                .explanation
                .as_ref()
                .map(|e| e.convention.as_str());
            assert_eq!(found, Some(name), "{how} {:?}", comparison.explanation);
            assert_eq!(comparison.matched_by, how);
            assert!(!comparison.agrees);
            // Displaced objects are reported, and no others.
            let failed = findings.failures();
            let failed: Vec<_> = failed.map(|check| check.name.as_str()).collect();
            let expected: &[&str] = match (is_another_place(name), how) {
                (false, _) => &[],
                (true, "name") => &["file/test/misplaced-objects"],
                (true, _) => &["file/test/unmatched-slots", "file/test/unmatched-objects"],
            };
            assert_eq!(failed, expected, "{name} by {how}");
        }
    }
}

#[test]
fn a_radius_is_fitted() {
    let findings = compared(&propagated("altitude-over-another-radius")).unwrap();
    let explanation = findings.files[0].explanation.as_ref().unwrap();
    assert_eq!(
        explanation.meaning,
        "altitudes measured from a radius of 6371.0000 km (fitted)"
    );
}

/// A difference that no convention causes is not attributed to one, however large it is.
#[test]
fn an_unknown_difference_is_not_explained() {
    let mut comparands = renamed(propagated("mean-j2"));
    for (n, comparand) in comparands.iter_mut().enumerate() {
        let Comparand::States(trajectory) = comparand else {
            continue;
        };
        for (_, state) in &mut trajectory.arcs[0].nodes {
            // A tilt by 0.05 rad for every second satellite.
            if n % 2 == 0 {
                let axis = nalgebra::Rotation3::from_axis_angle(&Vector3::x_axis(), 0.05);
                state.position_km = Position::new(axis * state.position_km.km());
                state.velocity_km_s = axis * state.velocity_km_s;
            }
        }
    }
    let findings = compared(&comparands).unwrap();
    let comparison = &findings.files[0];
    assert_eq!(comparison.explanation, None);
    assert!(!comparison.agrees && comparison.satellites.len() == 20);
}

/// Planes of this pattern cross where satellites of both are at the epoch.
#[test]
fn satellites_that_meet_are_told_apart_by_their_course() {
    let evaluator = evaluator();
    let design: Design = "delta:54.6:24/4/2@925".parse().unwrap();
    let expected = ReferenceConstellation::of_design(&design, &evaluator).unwrap();
    let ours = &expected.ephemeris;
    let objects = ours.satellites().iter().enumerate().map(|(n, satellite)| {
        let states = grid().iter().map(|t| {
            let state = ours.state(satellite, t + 18.0).unwrap();
            let declared = from_teme(state, Frame::Teme, epoch(), t);
            (epoch().plus_seconds(t), declared)
        });
        let (name, id) = (format!("SAT{n}"), n.to_string());
        Comparand::States(Trajectory::of_states(
            &name,
            &id,
            Frame::Teme,
            states.collect(),
        ))
    });
    let objects: Vec<_> = objects.collect();
    let findings = against_file(&expected, "test", &objects).unwrap();
    for (n, one) in findings.files[0].satellites.iter().enumerate() {
        assert_eq!(one.object, format!("SAT{n}"));
        // 18 s at 7.4 km/s.
        assert!((one.offset_km.in_track - 133.0).abs() < 2.0, "{one:?}");
    }
}

/// Two shells whose satellites another program propagated, under its own names: matched by place, and the
/// convention is tried on both. A satellite of the second shell in the place of another is seen.
#[test]
fn a_design_of_two_shells_is_compared_as_a_whole() {
    let evaluator = evaluator();
    let design: Design = "delta:54.6:24/4/1@925+star:87:12/3/1@1100".parse().unwrap();
    let expected = ReferenceConstellation::of_design(&design, &evaluator).unwrap();
    let sampled = |convention: &str| -> Vec<Comparand> {
        let shells = expected.shells.iter();
        let fitted = conventions::Fitted::default();
        let all = shells.flat_map(|shell| conventions::propagated(shell, convention, fitted));
        let one = |(name, propagation): (String, Box<dyn Propagator>)| {
            let states = grid().iter().map(|t| {
                let state = propagation.state_at(t).unwrap();
                (
                    epoch().plus_seconds(t),
                    from_teme(state, Frame::Teme, epoch(), t),
                )
            });
            let states = states.collect();
            Comparand::States(Trajectory::of_states(&name, &name, Frame::Teme, states))
        };
        all.map(one).collect()
    };
    let found = against_file(&expected, "test", &sampled("mean-j2")).unwrap();
    let comparison = &found.files[0];
    assert_eq!(
        (comparison.matched_by.as_str(), comparison.satellites.len()),
        ("name", 36)
    );
    assert_eq!(comparison.satellites[24].slot, "NW-B-P01-S01");
    assert!(comparison.agrees && found.passed());
    let other = against_file(&expected, "test", &renamed(sampled("two-body"))).unwrap();
    let comparison = &other.files[0];
    assert_eq!(comparison.matched_by, "place");
    assert_eq!(
        comparison.explanation.as_ref().unwrap().convention,
        "two-body"
    );
    let missing = sampled("mean-j2").split_off(1);
    let missing = against_file(&expected, "test", &missing).unwrap();
    assert_eq!(missing.files[0].unmatched_slots, ["NW-A-P01-S01"]);
}

/// Altitudes of both shells measured from 6371 km: the offset is that of each shell, not scaled by the higher orbit.
#[test]
fn a_radius_is_fitted_to_shells_of_different_heights() {
    let evaluator = evaluator();
    let design: Design = "delta:54.6:24/4/1@500+star:87:12/3/1@2000".parse().unwrap();
    let expected = ReferenceConstellation::of_design(&design, &evaluator).unwrap();
    let lower = "delta:54.6:24/4/1@492.863+star:87:12/3/1@1992.863";
    let lower = Ephemeris::of_design(&lower.parse().unwrap(), Model::J2, grid()).unwrap();
    let found = against_file(&expected, "test", &sampled(&lower)).unwrap();
    let explanation = found.files[0].explanation.as_ref().unwrap();
    assert_eq!(
        explanation.meaning,
        "altitudes measured from a radius of 6371.0000 km (fitted)"
    );
}

/// Metrics are not compared across a gap of the constellation, and a note says so.
#[test]
fn a_gap_of_the_constellation_is_noted() {
    struct Gap(Box<dyn Propagator>);
    impl Propagator for Gap {
        fn state_at(&self, elapsed_s: f64) -> Result<State<Teme>, PropagationError> {
            match elapsed_s {
                600.0 | 900.0 => Err(PropagationError::NotSampled { elapsed_s }),
                _ => self.0.state_at(elapsed_s),
            }
        }
    }
    let evaluator = evaluator();
    let satellites = || Ephemeris::of_design(&design().into(), Model::J2, grid()).unwrap();
    let objects = renamed(sampled(&satellites()));
    let found = |with_gap: bool| {
        let mut satellites = satellites().into_satellites();
        if with_gap {
            let last = satellites.pop().unwrap();
            satellites.push(EphemerisSatellite {
                propagator: Box::new(Gap(last.propagator)),
                ..last
            });
        }
        let ours = Ephemeris::new(grid(), satellites);
        let expected = ReferenceConstellation::of_satellites(ours, &evaluator).unwrap();
        let found = against_file(&expected, "test", &objects).unwrap();
        let is_metric = |check: &Check| check.name.ends_with("mean-visible");
        (found.checks.iter().any(is_metric), found.notes)
    };
    assert_eq!(found(false), (true, Vec::new()));
    let note = "file/test: metrics are not compared: NW-P05-S04 of the constellation has no state at 2025-01-01T00:10:00Z";
    assert_eq!(found(true), (false, vec![note.to_owned()]));
}

/// Satellites of a file against those of another: the same ones agree, and one moved to another place does not.
#[test]
fn satellites_from_files_are_compared_with_other_files() {
    let evaluator = evaluator();
    let satellites = || Ephemeris::of_design(&design().into(), Model::J2, grid()).unwrap();
    let expected = ReferenceConstellation::of_satellites(satellites(), &evaluator).unwrap();
    assert!(expected.shells.is_empty());
    let found = against_file(&expected, "test", &renamed(propagated("mean-j2"))).unwrap();
    assert!(
        found.files[0].agrees && found.passed(),
        "{:#?}",
        found.checks
    );
    let other = against_file(&expected, "test", &propagated("two-body")).unwrap();
    assert!(!other.files[0].agrees && other.files[0].explanation.is_none());
}

/// Satellites that cross in one place at the epoch are in their own places, a few metres off.
#[test]
fn crossing_satellites_of_a_file_are_not_misplaced() {
    let evaluator = evaluator();
    let crossing = |altitude_km: f64| {
        let design = format!("delta:54.6:24/4/2@{altitude_km}").parse().unwrap();
        Ephemeris::of_design(&design, Model::J2, grid()).unwrap()
    };
    let expected = ReferenceConstellation::of_satellites(crossing(925.0), &evaluator).unwrap();
    let others = crossing(925.003);
    let found = against_file(&expected, "test", &sampled(&others)).unwrap();
    assert!(found.passed(), "{:#?}", found.checks);
}

#[test]
fn the_design_itself_needs_no_explanation() {
    let findings = compared(&renamed(propagated("mean-j2"))).unwrap();
    let comparison = &findings.files[0];
    assert_eq!(comparison.matched_by, "place");
    assert!(comparison.agrees && comparison.explanation.is_none());
    // Instants are kept to the nanosecond: 1e-5 m at 7.5 km/s.
    assert!(comparison.satellites.iter().all(|one| one.max_km < 1e-7));
    assert!(findings.passed());
    let flips = findings
        .checks
        .iter()
        .find(|c| c.name == "file/test/flipped-decisions");
    assert_eq!(flips.unwrap().value, 0.0);
}

/// Every export is read back by the reader of its format, in its own frame.
#[test]
fn exported_files_are_the_design() {
    let subject = subject(design().into(), grid());
    for (product, most_km) in [
        // Nine decimals of a km; EME2000 there and back.
        (Product::Oem, 1e-6),
        // Six decimals of a km.
        (Product::Sp3, 2e-6),
        (Product::Stk, 1e-6),
        // SGP4 is another theory; its error budget applies.
        (Product::Tle, 25.0),
        (Product::Omm, 25.0),
    ] {
        let (_, files) = in_memory(&subject, &[product], Choices::default());
        let mut comparands = Vec::new();
        for (path, bytes) in &files {
            if path != "manifest.json" {
                comparands.extend(read(path, bytes.as_slice(), None).unwrap().0);
            }
        }
        let findings = compared(&comparands).unwrap();
        let comparison = &findings.files[0];
        assert!(findings.passed(), "{product:?}: {:#?}", findings.checks);
        let worst = comparison
            .satellites
            .iter()
            .map(|one| one.max_km)
            .fold(0.0, f64::max);
        assert!(worst < most_km, "{product:?}: {worst}");
    }
}

#[test]
fn missing_and_surplus_objects_fail_by_name() {
    let mut comparands = propagated("mean-j2");
    comparands.remove(3);
    let findings = compared(&comparands).unwrap();
    assert_eq!(findings.files[0].unmatched_slots, ["NW-P01-S04"]);
    let failed: Vec<_> = findings
        .checks
        .iter()
        .filter(|c| c.outcome() == Outcome::Fail)
        .map(|c| c.name.as_str())
        .collect();
    assert_eq!(failed, ["file/test/unmatched-slots"]);
    let comparison = &findings.files[0];
    assert!(!comparison.agrees && comparison.matched_agree());
    // No metrics from part of a constellation.
    assert!(
        findings
            .checks
            .iter()
            .all(|c| !c.name.ends_with("mean-visible"))
    );
}

#[test]
fn another_epoch_is_an_error_that_says_so() {
    let mut comparands = propagated("mean-j2");
    for comparand in &mut comparands {
        if let Comparand::States(trajectory) = comparand {
            let arc = &mut trajectory.arcs[0];
            let later = |at: Epoch| at.plus_seconds(10.0 * 86_400.0);
            arc.nodes.iter_mut().for_each(|(at, _)| *at = later(*at));
            arc.useable = (later(arc.useable.0), later(arc.useable.1));
        }
    }
    let error = compared(&comparands).unwrap_err().to_string();
    assert!(error.contains("2025-01-11T00:00:00Z"), "{error}");
}

#[test]
fn a_short_span_fails_and_is_measured() {
    let mut comparands = propagated("mean-j2");
    if let Comparand::States(trajectory) = &mut comparands[0] {
        trajectory.arcs[0].nodes.truncate(73);
    }
    let findings = compared(&comparands).unwrap();
    let check = findings
        .checks
        .iter()
        .find(|c| c.name == "file/test/uncovered-span")
        .unwrap();
    // 72 of 143 steps are covered.
    assert!(check.passed == Some(false) && (check.value - 71.0 / 143.0).abs() < 1e-12);
}

/// A gap is not interpolated, and no metrics are computed across it.
#[test]
fn a_gap_is_no_coverage() {
    let mut comparands = propagated("mean-j2");
    if let Comparand::States(trajectory) = &mut comparands[5] {
        // Samples 11 to 20 of 144: eleven steps, 55 min, are missing.
        trajectory.arcs[0].nodes.drain(11..21);
    }
    let findings = compared(&comparands).unwrap();
    let check = findings
        .checks
        .iter()
        .find(|c| c.name == "file/test/uncovered-span")
        .unwrap();
    assert!(check.passed == Some(false) && (check.value - 11.0 / 143.0).abs() < 1e-12);
    let is_metric = |c: &Check| c.name.ends_with("mean-visible");
    assert!(!findings.checks.iter().any(is_metric));
}

#[test]
fn a_file_that_breaks_its_format_is_named() {
    let error = read("x.oem", "CCSDS_OEM_VERS = 9.0\n".as_bytes(), None)
        .unwrap_err()
        .to_string();
    assert!(error.starts_with("x.oem: line 1"), "{error}");
}

/// The segments of a file, each read as a message of its own: Orekit wrote one segment per satellite,
/// and an OEM is for a single object (502.0-B-3, 5.1.3).
fn one_message_each(file: &[u8]) -> Vec<Comparand> {
    let text = std::str::from_utf8(file).unwrap();
    let (header, segments) = text.split_once("META_START").unwrap();
    let segments = segments.split("META_START").enumerate();
    segments
        .flat_map(|(n, segment)| {
            let message = format!("{header}META_START{segment}");
            let name = format!("orekit-{n}.oem");
            read(&name, message.as_bytes(), None).unwrap().0
        })
        .collect()
}

/// Orekit integrates J2 from the design's elements, which it takes as osculating: the comparison
/// says so, and what remains is the difference between two integrators.
#[test]
fn validate_an_ephemeris_of_orekit() {
    const OREKIT: &[u8] = include_bytes!("../../../validation/cases/orekit/j2-from-osculating.oem");
    let evaluator = testing::evaluator(TimeGrid::new(epoch(), 21_600.0, 600.0).unwrap());
    let design = "delta:40:8/4/1@925".parse().unwrap();
    let expected = ReferenceConstellation::of_design(&design, &evaluator).unwrap();
    let findings = against_file(&expected, "orekit", &one_message_each(OREKIT)).unwrap();
    assert!(findings.passed(), "{:#?}", findings.checks);
    let comparison = &findings.files[0];
    assert_eq!(
        (comparison.matched_by.as_str(), comparison.satellites.len()),
        ("place", 8)
    );
    let explanation = comparison.explanation.as_ref().unwrap();
    assert_eq!(explanation.convention, "elements-taken-as-osculating");
    // Both integrate to well below a metre in six hours; the file has 1e-9 km.
    assert!(explanation.after_km < 1e-6, "{explanation:?}");
    assert!(explanation.before_km.unwrap() > 10.0, "{explanation:?}");
}
