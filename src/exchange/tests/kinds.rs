//! Files of kinds that went wrong once: everything legal is read, nothing is lost without a word, and lint finds
//! what the reader refuses, at the same place. The files are changed ones of our own.

mod ephemerides;
mod messages;

use super::samples;
use crate::exchange::import::Fleet;
use crate::exchange::lint::{Format, lint};
use crate::formats::ccsds::oem::{self, Oem};
use crate::formats::text::finding::{Finding, Severity};
use crate::time::{Epoch, TimeGrid};

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

/// Lint reports only these rules, as warnings, and the reader accepts the file.
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

/// Files that break no rule and are not read: lint says so at the keyword that is the reason.
#[test]
fn what_is_valid_and_not_read_is_found_by_lint() {
    let opm = sample(Format::Opm);
    let foreign: String = opm
        .split_inclusive('\n')
        .filter(|line| !line.starts_with("USER_DEFINED"))
        .collect();
    let opm_xml = sample(Format::OpmXml);
    let [begin, end] = ["<userDefinedParameters>", "</data>"].map(|tag| opm_xml.find(tag).unwrap());
    let foreign_xml = format!("{}{}", &opm_xml[..begin], &opm_xml[end..]);
    for (format, text, at) in [
        (
            Format::Oem,
            changed(
                &sample(Format::Oem),
                "CENTER_NAME = EARTH",
                "CENTER_NAME = MARS",
            ),
            "CENTER_NAME",
        ),
        (
            Format::OemXml,
            changed(
                &sample(Format::OemXml),
                "<CENTER_NAME>EARTH",
                "<CENTER_NAME>MARS",
            ),
            "<CENTER_NAME",
        ),
        (Format::Opm, foreign, "EPOCH"),
        (Format::OpmXml, foreign_xml, "<EPOCH"),
        (
            Format::Opm,
            changed(
                &opm,
                "MEAN_SEMI_MAJOR_AXIS_KM = 7",
                "MEAN_SEMI_MAJOR_AXIS_KM = x",
            ),
            "EPOCH",
        ),
        (
            Format::Opm,
            changed(&opm, "CENTER_NAME = EARTH", "CENTER_NAME = MARS"),
            "CENTER_NAME",
        ),
        (
            Format::Opm,
            changed(&opm, "TIME_SYSTEM = UTC", "TIME_SYSTEM = MET"),
            "TIME_SYSTEM",
        ),
    ] {
        let line = 1 + text[..text.find(&format!("\n{at}")).unwrap() + 1]
            .matches('\n')
            .count();
        let line = line - usize::from(text.starts_with(at));
        let found = findings(&text);
        let [finding] = found.as_slice() else {
            panic!("{format} {at}: {found:?}")
        };
        assert_eq!(
            (finding.rule, finding.line, finding.severity),
            ("unsupported", line, Severity::Warning),
            "{format}: {finding}"
        );
        let keyword = at.trim_start_matches('<');
        assert!(finding.message.starts_with(keyword), "{format}: {finding}");
        assert!(
            Fleet::read(text.as_bytes(), None, None).is_err(),
            "{format} {at}"
        );
    }
}
