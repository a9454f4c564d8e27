//! Ephemerides: spans, objects, frames and states.

use super::*;
use crate::formats::ccsds::oem::Segment;
use crate::frames::Position;
use crate::orbit::Model;
use chrono::TimeDelta;
use nalgebra::Vector3;

/// Two segments around a manoeuvre at 90 s: each has nodes beyond it, where the satellite never was.
fn around_a_manoeuvre() -> (Oem, Oem) {
    let truth = message(&sample(Format::Oem));
    let whole = truth.segments[0].clone();
    let at = |k: usize| whole.states[k].epoch;
    let fictitious = |segment: &mut Segment, nodes: std::ops::Range<usize>| {
        for line in &mut segment.states[nodes] {
            line.state.position_km = line.state.position_km + Vector3::repeat(500.0);
        }
    };
    let mut before = whole.clone();
    // Three lines are too few for the one of the sample.
    before.metadata.interpolation = None;
    before.states.truncate(3);
    before.metadata.stop_time = at(2);
    before.metadata.useable_stop_time = Some(at(1));
    fictitious(&mut before, 2..3);
    let mut after = whole.clone();
    after.metadata.useable_start_time = Some(at(1));
    fictitious(&mut after, 0..1);
    let segments = vec![before, after];
    (truth.clone(), Oem { segments, ..truth })
}

/// 502.0-B-3, table 5-3: nodes outside the usable span are there to interpolate.
#[test]
fn states_come_from_the_usable_span() {
    let (truth, overlapping) = around_a_manoeuvre();
    let useable = |fleet: &Fleet| match fleet {
        Fleet::Sampled(trajectories) => trajectories[0].samples(),
        other => panic!("{}", other.content()),
    };
    let expected = useable(&fleet(&written(&truth)));
    assert_eq!(useable(&warned(&written(&overlapping), &[])), expected);
    let mut xml = Vec::new();
    overlapping.write_xml(&mut xml).unwrap();
    let read = warned(std::str::from_utf8(&xml).unwrap(), &[]);
    assert_eq!(useable(&read), expected);
    // Without usable spans it is unclear which of the two applies.
    let mut without = overlapping.clone();
    without.segments[0].metadata.useable_stop_time = None;
    without.segments[1].metadata.useable_start_time = None;
    let text = written(&without);
    let (_, second) = text.split_at(text.rfind("START_TIME").unwrap());
    refused(&text, "oem-span", second);
}

#[test]
fn usable_spans_that_are_none_are_refused() {
    let whole = message(&sample(Format::Oem));
    let at = |k: usize| Some(whole.segments[0].states[k].epoch);
    let with = |start, stop| {
        let mut other = whole.clone();
        other.segments[0].metadata.useable_start_time = start;
        other.segments[0].metadata.useable_stop_time = stop;
        written(&other)
    };
    refused(&with(at(2), at(1)), "oem-span", "USEABLE_STOP_TIME");
    let early = at(0).map(|at| at - TimeDelta::seconds(1));
    refused(&with(early, at(1)), "oem-span", "USEABLE_START_TIME");
    let late = at(3).map(|at| at + TimeDelta::seconds(1));
    refused(&with(None, late), "oem-span", "USEABLE_STOP_TIME");
}

/// 5.1.3: an OEM is for a single object, even if both carry the same placeholder as identifier.
#[test]
fn an_oem_of_two_objects_is_refused() {
    let mut two = message(&sample(Format::Oem));
    let id = "0000-000A";
    for (name, offset_s) in [("SAT A", 0), ("SAT B", 600)] {
        let mut segment = two.segments[0].clone();
        segment.metadata.object_name = name.to_owned();
        segment.metadata.object_id = id.to_owned();
        let later = TimeDelta::seconds(offset_s);
        segment.metadata.start_time += later;
        segment.metadata.stop_time += later;
        segment
            .states
            .iter_mut()
            .for_each(|line| line.epoch += later);
        two.segments.push(segment);
    }
    two.segments.remove(0);
    let error = refused(&written(&two), "oem-objects", "OBJECT_NAME = SAT B");
    assert!(
        error.contains("SAT A (0000-000A) in the first segment, SAT B (0000-000A) here"),
        "{error}"
    );
    let mut xml = Vec::new();
    two.write_xml(&mut xml).unwrap();
    refused(
        std::str::from_utf8(&xml).unwrap(),
        "oem-objects",
        "<OBJECT_NAME>SAT B",
    );
    // The name need not be given twice.
    two.segments[1].metadata.object_name = "UNKNOWN".to_owned();
    two.segments[0].metadata.object_id = "2025-900A".to_owned();
    two.segments[1].metadata.object_id = "2025-900A".to_owned();
    assert_eq!(warned(&written(&two), &[]).len(), 1);
}

/// Table 5-3 asks for `UNKNOWN` where there is no name; the identifiers tell the satellites apart.
#[test]
fn unnamed_satellites_are_told_apart_by_their_identifiers() {
    let text = sample(Format::Oem);
    let message = message(&text);
    let with = |name: &str, id: &str| {
        let mut other = message.clone();
        other.segments[0].metadata.object_name = name.to_owned();
        other.segments[0].metadata.object_id = id.to_owned();
        written(&other)
    };
    let mut both = fleet(&with("UNKNOWN", "2025-900A"));
    both.append(fleet(&with("UNKNOWN", "2025-900B")));
    assert_eq!(both.labels(), ["2025-900A", "2025-900B"]);
    let propagated = both.propagate(grid(), Model::J2).unwrap();
    assert_eq!(propagated.satellites()[1].name, "2025-900B");
    // Without any identifier a satellite is called as its file.
    assert_eq!(fleet(&with("UNKNOWN", "UNKNOWN")).labels(), ["file"]);
    // One name for two identifiers, and two names for one.
    let mut same = fleet(&with("SAT", "2025-900A"));
    same.append(fleet(&with("SAT", "2025-900B")));
    assert_eq!(same.labels(), ["SAT (2025-900A)", "SAT (2025-900B)"]);
    let mut other = fleet(&with("SAT A", "2025-900A"));
    other.append(fleet(&with("SAT B", "2025-900A")));
    let error = other
        .propagate(grid(), Model::J2)
        .err()
        .unwrap()
        .to_string();
    assert!(
        error.starts_with("SAT A and SAT B are one object"),
        "{error}"
    );
}

/// States that no satellite of the Earth has: metres taken for kilometres, and the other way round.
#[test]
fn states_that_are_no_earth_orbit_are_refused_with_name_and_instant() {
    for factor in [1e-3, 1e3] {
        let mut other = message(&sample(Format::Oem));
        for line in &mut other.segments[0].states[1..] {
            line.state.position_km = Position::new(line.state.position_km.km() * factor);
            line.state.velocity_km_s *= factor;
        }
        let text = written(&other);
        let error = refused(&text, "implausible-state", "\n2025-01-01T00:01:30.000 ").to_owned();
        assert!(
            error.contains("NW-P01-S01 at 2025-01-01 00:01:30"),
            "{error}"
        );
    }
    // Whatever the format: the evaluation asks the same.
    let states = sample(Format::StatesCsv);
    let Fleet::Sampled(mut trajectories) = fleet(&states) else {
        panic!("states")
    };
    trajectories[1].arcs[0].nodes[2].1.velocity_km_s *= 2.0;
    let error = Fleet::Sampled(trajectories).propagate(grid(), Model::J2);
    let error = error.err().unwrap().to_string();
    assert!(
        error.starts_with("NW-P01-S02: at 2025-01-01T00:03:00"),
        "{error}"
    );
    assert!(error.contains("escape speed"), "{error}");
}

/// The usual names of Earth-fixed frames and of TEME are read; frames of date by another theory are refused.
#[test]
fn frames_are_read_by_their_usual_names_or_refused_with_their_place() {
    let (oem, sp3) = (sample(Format::Oem), sample(Format::Sp3));
    let frame = oem
        .lines()
        .find(|line| line.starts_with("REF_FRAME"))
        .unwrap();
    for name in [
        "ECEF",
        "ECF",
        "ITRF2020",
        "ITRF-97",
        "IGS20",
        "IGb14",
        "WGS84",
        "GTRF",
        "BTRF",
        "TEMEOFDATE",
    ] {
        warned(&changed(&oem, frame, &format!("REF_FRAME = {name}")), &[]);
    }
    for name in ["TOD", "TDR", "MOD", "TEMEOFEPOCH", "MEDS"] {
        let error = refused(
            &changed(&oem, frame, &format!("REF_FRAME = {name}")),
            "oem-frame",
            "REF_FRAME",
        );
        assert!(
            error.contains("REF_FRAME: ") && error.contains("choices: EME2000"),
            "{error}"
        );
    }
    let epoch = "REF_FRAME = TEME\nREF_FRAME_EPOCH = 2025-01-01T00:00:00";
    refused(&changed(&oem, frame, epoch), "oem-frame", "REF_FRAME_EPOCH");
    let system = "TIME_SYSTEM = UTC";
    refused(
        &changed(&oem, system, "TIME_SYSTEM = MET"),
        "oem-time-system",
        "TIME_SYSTEM",
    );
    let first = sp3.lines().next().unwrap();
    let with = |name: &str| {
        changed(
            &sp3,
            first,
            &format!("{}{name:<5}{}", &first[..46], &first[51..]),
        )
    };
    for name in [
        "ECEF", "ITR08", "IGS20", "IGb08", "SLR20", "WGS84", "GTRF", "BTRF", "",
    ] {
        warned(&with(name), &[]);
    }
    for name in ["TOD", "TDR", "MOD"] {
        let error = refused(&with(name), "sp3-frame", "#");
        assert!(error.starts_with("line 1, column 47: "), "{error}");
    }
}
