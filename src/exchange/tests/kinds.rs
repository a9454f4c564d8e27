//! Files of kinds that went wrong once: everything legal is read, nothing is lost without a word, and lint finds
//! what the reader refuses, at the same place. The files are changed ones of our own.

use super::samples;
use crate::exchange::import::Fleet;
use crate::exchange::lint::{Format, lint};
use crate::formats::ccsds::oem::{self, Oem, Segment};
use crate::formats::text::finding::{Finding, Severity};
use crate::frames::Position;
use crate::orbit::Model;
use crate::time::{Epoch, TimeGrid};
use chrono::TimeDelta;
use nalgebra::Vector3;

fn sample(format: Format) -> String {
    let mut samples = samples().into_iter();
    samples.find(|(of, _)| *of == format).unwrap().1
}

fn findings(text: &str) -> Vec<Finding> {
    lint(text.as_bytes(), None, None, 100).unwrap().findings
}

fn fleet(text: &str) -> Fleet {
    Fleet::read(text.as_bytes(), None, Some("dir/file.x"))
        .unwrap()
        .fleet
}

/// The text with its first `from` replaced, which must be there.
fn changed(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from}");
    text.replacen(from, to, 1)
}

/// Lint and reader refuse the text alike, at the line that `at` begins; gives the message.
#[track_caller]
fn refused(text: &str, rule: &str, at: &str) -> String {
    let start = text.find(at).unwrap() + usize::from(at.starts_with('\n'));
    let line = 1 + text[..start].matches('\n').count();
    let found = findings(text);
    let mut errors = found.iter().filter(|one| one.severity == Severity::Error);
    let first = errors
        .next()
        .unwrap_or_else(|| panic!("no error: {found:?}"));
    assert_eq!((first.rule, first.line), (rule, line), "{found:?}");
    let error = Fleet::read(text.as_bytes(), None, None)
        .unwrap_err()
        .to_string();
    assert_eq!(error, first.to_string());
    error
}

/// Lint warns of these rules alone, and the reader goes on.
#[track_caller]
fn warned(text: &str, rules: &[&str]) -> Fleet {
    let found = findings(text);
    let found_rules: Vec<_> = found.iter().map(|one| one.rule).collect();
    assert_eq!(found_rules, rules, "{found:?}");
    assert!(found.iter().all(|one| one.severity == Severity::Warning));
    fleet(text)
}

fn message(text: &str) -> Oem {
    oem::read(text.as_bytes()).unwrap()
}

fn written(message: &Oem) -> String {
    let mut bytes = Vec::new();
    message.write(&mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

/// Instants of the sample: 0, 90, 180 and 270 s.
fn grid() -> TimeGrid {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    TimeGrid::new(epoch, 360.0, 90.0).unwrap()
}

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
    // Without usable spans nobody can tell which of the two holds.
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
        error.contains("SAT A (0000-000A) before, SAT B (0000-000A) here"),
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

/// 7.7.1.1: displayed units must be those of the table.
#[test]
fn units_are_those_of_the_table() {
    let omm = sample(Format::Omm);
    for (key, unit, wrong) in [
        ("INCLINATION", "deg", "rad"),
        ("MEAN_MOTION", "rev/day", "rad/s"),
        ("ECCENTRICITY", "", "deg"),
        ("BSTAR", "1/ER", "m**2/kg"),
        ("MEAN_MOTION_DDOT", "rev/day**3", "rev/day**2"),
    ] {
        let start = omm.find(&format!("\n{key} =")).unwrap() + 1;
        let line = omm[start..].lines().next().unwrap();
        refused(
            &changed(&omm, line, &format!("{line} [{wrong}]")),
            "ccsds-unit",
            line,
        );
        if !unit.is_empty() {
            let right = changed(&omm, line, &format!("{line} [{unit}]"));
            assert_eq!(warned(&right, &[]), fleet(&omm), "{key}");
        }
    }
    let capitals = changed(
        &omm,
        "\nRA_OF_ASC_NODE = 0.0\n",
        "\nRA_OF_ASC_NODE = 0.0 [DEG]\n",
    );
    warned(&capitals, &["ccsds-unit"]);
    let opm = sample(Format::Opm);
    let line = opm.lines().find(|line| line.starts_with("X_DOT")).unwrap();
    refused(
        &changed(&opm, line, &format!("{line} [m/s]")),
        "ccsds-unit",
        line,
    );
    warned_opm(&changed(&opm, line, &format!("{line} [km/s]")));
    for (format, key, unit, wrong) in [
        (Format::OemXml, "X", "km", "m"),
        (Format::OemXml, "X_DOT", "km/s", "m/s"),
        (Format::OmmXml, "INCLINATION", "deg", "rad"),
    ] {
        let text = sample(format);
        let tag = format!("<{key}>");
        let with = |unit: &str| changed(&text, &tag, &format!("<{key} units=\"{unit}\">"));
        refused(&with(wrong), "ccsds-unit", &format!("<{key} units"));
        assert_eq!(warned(&with(unit), &[]), fleet(&text), "{key}");
    }
}

fn warned_opm(text: &str) {
    assert_eq!(findings(text), []);
}

/// Replaces the ephemeris type of the first set of a TLE, and its checksum.
fn of_type(tle: &str, kind: u32) -> String {
    let line = tle.lines().find(|line| line.starts_with("1 ")).unwrap();
    let (before, after) = (&line[..62], &line[63..68]);
    let sum: u32 = line[68..].parse().unwrap();
    changed(
        tle,
        line,
        &format!("{before}{kind}{after}{}", (sum + kind) % 10),
    )
}

/// B* and the derivatives of SGP4-XP mean other things, and SGP4 does not propagate them.
#[test]
fn sgp4_xp_is_refused_in_every_syntax() {
    let tle = sample(Format::Tle);
    let error = refused(&of_type(&tle, 4), "tle-type", "1 90001");
    assert!(
        error.contains("column 63: ephemeris type 4, SGP4-XP,"),
        "{error}"
    );
    refused(&of_type(&tle, 6), "tle-type", "1 90001");
    assert_eq!(warned(&of_type(&tle, 2), &[]).len(), 4);
    for format in [Format::Omm, Format::OmmXml, Format::OmmJson, Format::OmmCsv] {
        let text = sample(format);
        let (from, to, more) = match format {
            Format::Omm => ("EPHEMERIS_TYPE = 0", "EPHEMERIS_TYPE = 4", "BTERM = 0.02"),
            Format::OmmXml => (
                "<EPHEMERIS_TYPE>0",
                "<EPHEMERIS_TYPE>4",
                "<BTERM>0.02</BTERM>",
            ),
            Format::OmmJson => (
                "\"EPHEMERIS_TYPE\":0",
                "\"EPHEMERIS_TYPE\":4",
                "\"BTERM\":0.02,",
            ),
            _ => (",0,U,", ",4,U,", ""),
        };
        refused(&changed(&text, from, to), "omm-theory", to);
        for more in [more.to_owned(), more.replace("BTERM", "AGOM")] {
            if more.is_empty() {
                continue;
            }
            // Beside BSTAR, before the derivative that follows both in the table, or at the end.
            let before = match format {
                Format::Omm => "MEAN_MOTION_DOT",
                Format::OmmXml => "<MEAN_MOTION_DOT>",
                _ => "\"MEAN_MOTION_DOT\"",
            };
            let line = match format {
                Format::OmmJson => more,
                _ => format!("{more}\n"),
            };
            let text = changed(&text, before, &format!("{line}{before}"));
            let error = refused(&text, "omm-theory", line.trim());
            assert!(error.contains("SGP4-XP"), "{error}");
        }
    }
    let table = sample(Format::OmmCsv);
    let rows: Vec<String> = table
        .lines()
        .enumerate()
        .map(|(n, row)| format!("{row},{}\n", if n == 0 { "BTERM" } else { "0.02" }))
        .collect();
    refused(&rows.concat(), "omm-theory", &rows[1]);
}

/// Catalogues of what re-enters: 70 days before its epoch SGP4 has it 10¹⁴ km away.
#[test]
fn a_theory_that_has_diverged_is_told_with_name_and_instant() {
    let tle = "FALLING\n\
        1 90002U 25900B   25070.50000000  .09000000  24000+0  45000-1 0    14\n\
        2 90002  98.5000 110.9000 0014000 269.2000  90.7000 15.92000000    14\n";
    let falling = warned(tle, &[]);
    let propagated = falling.propagate(grid(), Model::J2).unwrap();
    let first = &propagated.satellites()[0];
    let error = propagated.state(first, 90.0).unwrap_err().to_string();
    assert!(
        error.starts_with("FALLING: at 2025-01-01T00:01:30"),
        "{error}"
    );
    assert!(error.ends_with("not an Earth orbit"), "{error}");
    let stale = falling.stale(grid()).unwrap().to_string();
    assert!(stale.contains("FALLING is 69.5 days"), "{stale}");
    assert_eq!(fleet(&sample(Format::Tle)).stale(grid()), None);
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

/// Long comments before the root, prefixes of namespaces.
#[test]
fn xml_is_recognised_by_its_root() {
    for (format, root) in [(Format::OemXml, "oem"), (Format::OmmXml, "omm")] {
        let text = sample(format);
        let notice = format!(
            "?>\n<!-- {} <omm> <oem> -->\n",
            "operator notice ".repeat(100)
        );
        let long = changed(&text, "?>\n", &notice);
        let prefixed = text
            .replace("</", "</ndm:")
            .replace('<', "<ndm:")
            .replace("<ndm:/ndm:", "</ndm:")
            .replace("<ndm:?", "<?");
        for other in [long, prefixed] {
            let report = lint(other.as_bytes(), None, None, 10).unwrap();
            assert_eq!(
                (report.format, report.findings),
                (Some(format), Vec::new()),
                "{root}"
            );
            assert_eq!(fleet(&other), fleet(&text), "{root}");
        }
    }
}

/// A combined instantiation of an OEM, an OMM and an OPM: two are read, the third is named.
#[test]
fn messages_of_several_kinds_are_read_or_named() {
    let message_of = |format: Format, name: &str| {
        let text = sample(format);
        let end = format!("</{name}>");
        let begin = text.find(&format!("<{name} ")).unwrap();
        let end = text.find(&end).unwrap() + end.len();
        text[begin..end].to_owned()
    };
    let (oem, omm) = (
        message_of(Format::OemXml, "oem"),
        message_of(Format::OmmXml, "omm"),
    );
    let omm = omm
        .replace("NW-P01-S01", "OTHER")
        .replace("90001", "90009")
        .replace("2025-900A", "2025-900Z");
    let opm = "<opm id=\"CCSDS_OPM_VERS\" version=\"2.0\"><header><ORIGINATOR>X</ORIGINATOR></header></opm>";
    let mixed = format!("<?xml version=\"1.0\"?>\n<ndm>\n{oem}\n{omm}\n{opm}\n</ndm>\n");
    let report = lint(mixed.as_bytes(), None, None, 10).unwrap();
    let found: Vec<_> = report
        .findings
        .iter()
        .map(|one| (one.rule, one.severity))
        .collect();
    assert_eq!(
        (report.format, found),
        (Some(Format::OemXml), vec![("left-out", Severity::Warning)])
    );
    let read = Fleet::read(mixed.as_bytes(), None, None).unwrap();
    assert_eq!(read.left_out.to_string(), "left out: 1 (message: opm)");
    assert_eq!(read.fleet.labels(), ["NW-P01-S01", "OTHER"]);
    assert_eq!(read.fleet.content(), "sampled states, SGP4 element sets");
    let propagated = read.fleet.propagate(grid(), Model::J2).unwrap();
    assert_eq!(propagated.satellites().len(), 2);
    // Nothing of a kind that is read.
    let alone = format!("<ndm>\n{opm}\n</ndm>\n");
    let error = Fleet::read(alone.as_bytes(), None, None)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("no message of a kind that is read (oem, omm)"),
        "{error}"
    );
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

/// Catalogues give empty identifiers: a warning, alike in every syntax.
#[test]
fn an_empty_identifier_is_a_warning_in_every_syntax() {
    for format in [
        Format::Oem,
        Format::OemXml,
        Format::Omm,
        Format::OmmXml,
        Format::OmmJson,
        Format::OmmCsv,
    ] {
        let text = sample(format);
        let empty = changed(&text, "2025-900A", "");
        let read = warned(&empty, &["ccsds-empty"]);
        assert_eq!(read.labels(), fleet(&text).labels(), "{format}");
    }
}

#[test]
fn long_and_foreign_names_are_read() {
    let tle = sample(Format::Tle);
    let name = "GLOBALSTAR M097 [+] (PLANE 3, SLOT 12)";
    let read = warned(&changed(&tle, "NW-P01-S01", name), &["tle-name"]);
    assert_eq!(read.labels()[0], name);
    let read = warned(&changed(&tle, "NW-P01-S01", "\u{d6}BB-SAT"), &["character"]);
    assert_eq!(read.labels()[0], "\u{d6}BB-SAT");
}

#[test]
fn what_lint_missed_is_found() {
    let mut some = message(&sample(Format::Oem));
    some.segments[0].states[2].acceleration_km_s2 = Some(Vector3::zeros());
    refused(
        &written(&some),
        "oem-accelerations",
        "\n2025-01-01T00:03:00.000 ",
    );
    for (format, whole) in [
        (Format::Omm, "NORAD_CAT_ID = 90001\n"),
        (Format::OmmXml, "<NORAD_CAT_ID>90001</NORAD_CAT_ID>\n"),
        (Format::OmmJson, "\"NORAD_CAT_ID\":90001,"),
    ] {
        let text = changed(&sample(format), whole, "");
        let found = findings(&text);
        assert!(
            found.iter().any(|one| one.message.contains("NORAD_CAT_ID")),
            "{found:?}"
        );
        assert!(
            Fleet::read(text.as_bytes(), None, None).is_err(),
            "{format}"
        );
    }
    let omm = sample(Format::Omm);
    let line = omm.lines().find(|line| line.starts_with("BSTAR")).unwrap();
    warned(&changed(&omm, &format!("{line}\n"), ""), &["ccsds-missing"]);
}

/// The digits of 7.5.6 are a rule of CCSDS: other formats write as many as they like.
#[test]
fn number_rules_of_ccsds_are_not_applied_to_others() {
    let long = ".1234567890123456789";
    let oem = sample(Format::Oem);
    let column = oem.find("META_STOP\n\n2025-01-01T00:00:00.000 ").unwrap() + 35;
    let number: String = oem[column..].chars().take_while(|c| *c != ' ').collect();
    let whole = number.split('.').next().unwrap();
    warned(
        &changed(&oem, &number, &format!("{whole}{long}")),
        &["ccsds-digits"],
    );
    let stk = sample(Format::Stk);
    let row = stk.find("\n0 ").unwrap() + 3;
    let number: String = stk[row..].chars().take_while(|c| *c != ' ').collect();
    let whole = number.split('.').next().unwrap();
    warned(&changed(&stk, &number, &format!("{whole}{long}")), &[]);
    for format in [Format::OmmJson, Format::OmmCsv] {
        let text = sample(format);
        warned(
            &changed(&text, "0.01", &format!("0{long}").replace("0.12", "0.012")),
            &[],
        );
    }
    warned(&changed(&sample(Format::OmmCsv), "0.01,", ".01,"), &[]);
}

/// Names of people and agencies in comments are no reason to refuse a file.
#[test]
fn comments_may_hold_any_text() {
    for format in [Format::Oem, Format::Omm, Format::Opm] {
        let text = sample(format);
        let other = changed(&text, "COMMENT ", "COMMENT M\u{fc}ller: ");
        assert_eq!(warned(&other, &["character"]), fleet(&text), "{format}");
    }
}
