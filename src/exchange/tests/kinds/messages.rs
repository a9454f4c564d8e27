//! Element sets and messages, and what is common to all: units, theories, XML, identifiers, numbers, text.

use super::*;
use crate::orbit::Model;
use nalgebra::Vector3;

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
        (Format::OpmXml, "X_DOT", "km/s", "m/s"),
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
    let stale = falling.stale("files", grid()).unwrap().to_string();
    assert!(stale.contains("FALLING is 69.5 days"), "{stale}");
    assert_eq!(fleet(&sample(Format::Tle)).stale("files", grid()), None);
}

/// Long comments before the root, prefixes of namespaces.
#[test]
fn xml_is_recognised_by_its_root() {
    for (format, root) in [
        (Format::OemXml, "oem"),
        (Format::OmmXml, "omm"),
        (Format::OpmXml, "opm"),
    ] {
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

/// A combined instantiation of an OEM, an OMM and two OPMs: those that can be propagated are read, the fourth is named,
/// and so is a message of another kind.
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
    let opm = message_of(Format::OpmXml, "opm").replace("NW-P01-S01", "WITH");
    let begin = opm.find("<userDefinedParameters>").unwrap();
    let end = opm.find("</data>").unwrap();
    let state = format!("{}{}", &opm[..begin], &opm[end..]).replace("WITH", "WITHOUT");
    let tdm = "<tdm id=\"CCSDS_TDM_VERS\" version=\"2.0\"><header><ORIGINATOR>X</ORIGINATOR></header></tdm>";
    let others = format!("{opm}\n{state}\n{tdm}");
    let mixed = format!("<?xml version=\"1.0\"?>\n<ndm>\n{oem}\n{omm}\n{others}\n</ndm>\n");
    let report = lint(mixed.as_bytes(), None, None, 10).unwrap();
    let found: Vec<_> = report
        .findings
        .iter()
        .map(|one| (one.rule, one.severity))
        .collect();
    assert_eq!(
        (report.format, found),
        (
            Some(Format::OemXml),
            vec![("left-out", Severity::Warning); 2]
        )
    );
    let read = Fleet::read(mixed.as_bytes(), None, None).unwrap();
    assert_eq!(
        read.left_out.to_string(),
        "left out: 2 (message: opm of WITHOUT that cannot be propagated, tdm)"
    );
    assert_eq!(read.fleet.labels(), ["NW-P01-S01", "OTHER", "WITH"]);
    assert_eq!(
        read.fleet.content(),
        "sampled states, SGP4 element sets, mean elements"
    );
    let propagated = read.fleet.propagate(grid(), Model::J2).unwrap();
    assert_eq!(propagated.satellites().len(), 3);
    // No supported message.
    let alone = format!("<ndm>\n{state}\n</ndm>\n");
    let error = Fleet::read(alone.as_bytes(), None, None)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("supported message (oem, omm, opm)"),
        "{error}"
    );
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

/// Names of people and agencies in comments do not cause a file to be refused.
#[test]
fn comments_may_hold_any_text() {
    for format in [Format::Oem, Format::Omm, Format::Opm] {
        let text = sample(format);
        let other = changed(&text, "COMMENT ", "COMMENT M\u{fc}ller: ");
        assert_eq!(warned(&other, &["character"]), fleet(&text), "{format}");
    }
}
