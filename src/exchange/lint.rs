//! Checks a file against its format: what a reader rejects, and what it accepts although the standard
//! forbids it.

use crate::exchange::recognise::{recognise, unpacked};
use crate::formats::ccsds::omm::OmmSyntax;
use crate::formats::ccsds::{ndm, oem, omm, opm};
use crate::formats::csv;
use crate::formats::kept_states::KeptStates;
use crate::formats::maps::czml;
use crate::formats::text::finding::{Finding, FindingList};
use crate::formats::{sem, sp3, stk, tle, yuma};
use crate::keyword::keywords;
use std::collections::HashSet;
use std::io::{self, BufRead};

keywords! {
    /// A format that can be checked.
    Format {
        /// Two-line element sets.
        Tle = "tle",
        /// CCSDS Orbit Ephemeris Message, keyword = value.
        Oem = "oem",
        /// The same in XML.
        OemXml = "oem-xml",
        /// CCSDS Orbit Mean-Elements Message, keyword = value.
        Omm = "omm",
        /// The same in XML.
        OmmXml = "omm-xml",
        /// The same as JSON.
        OmmJson = "omm-json",
        /// The same as a table.
        OmmCsv = "omm-csv",
        /// CCSDS Orbit Parameter Message, keyword = value.
        Opm = "opm",
        /// The same in XML.
        OpmXml = "opm-xml",
        /// SP3-a to SP3-d.
        Sp3 = "sp3",
        /// CZML, the satellites of a document.
        Czml = "czml",
        /// STK ephemeris.
        Stk = "stk",
        /// YUMA almanac.
        Yuma = "yuma",
        /// SEM almanac.
        Sem = "sem",
        /// Table of mean elements.
        ElementsCsv = "elements-csv",
        /// Table of states.
        StatesCsv = "states-csv",
    }
}

impl Format {
    /// The format of a file by the extension of its name, compressed or not.
    pub(crate) fn of_name(file_name: &str) -> Option<Self> {
        let file_name = file_name.strip_suffix(".gz").unwrap_or(file_name);
        let (_, extension) = file_name.rsplit_once('.')?;
        match extension.to_ascii_lowercase().as_str() {
            "tle" | "3le" | "2le" => Some(Self::Tle),
            "alm" | "yuma" => Some(Self::Yuma),
            "al3" | "sem" => Some(Self::Sem),
            "oem" => Some(Self::Oem),
            "opm" => Some(Self::Opm),
            "omm" | "kvn" => Some(Self::Omm),
            "xml" => Some(Self::OmmXml),
            "json" => Some(Self::OmmJson),
            "csv" => Some(Self::OmmCsv),
            "sp3" => Some(Self::Sp3),
            "czml" => Some(Self::Czml),
            "e" => Some(Self::Stk),
            _ => None,
        }
    }
}

/// The result of checking a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LintReport {
    /// The format that it was checked against; none if the format is not supported.
    pub format: Option<Format>,
    /// The violations, mostly in the order of the file.
    pub findings: Vec<Finding>,
}

/// Checks a file against `format`, or against the format detected from its beginning and its name, for
/// up to `limit` findings.
///
/// # Errors
/// A failure of the input.
pub fn lint(
    input: impl BufRead,
    format: Option<Format>,
    file_name: Option<&str>,
    limit: usize,
) -> io::Result<LintReport> {
    let kinds = xml_kinds(format);
    let mut findings = FindingList::of_linter(limit);
    let (format, input) = match format {
        Some(format) => (Ok(format), unpacked(input)?),
        None => {
            let recognised = recognise(input, file_name)?;
            (recognised.content, recognised.input)
        }
    };
    let format = match format {
        Ok(format) => format,
        Err(unread) => {
            findings.error((1, 1), "unknown-format", unread.to_string());
            let findings = findings.into_vec();
            return Ok(LintReport {
                format: None,
                findings,
            });
        }
    };
    match format {
        Format::Tle => lint_tle(input, &mut findings)?,
        Format::Oem => {
            oem::parse_kept(input, &mut findings, &|_| KeptStates::None, |_| ()).map(drop)?;
        }
        Format::OemXml | Format::OmmXml | Format::OpmXml => {
            ndm::parse_kept(input, kinds, &mut findings, &|_| KeptStates::None, |_| ())?;
        }
        Format::Omm => omm::parse(input, OmmSyntax::Kvn, &mut findings, |_| ())?,
        Format::OmmJson => omm::parse(input, OmmSyntax::Json, &mut findings, |_| ())?,
        Format::OmmCsv => omm::parse(input, OmmSyntax::Csv, &mut findings, |_| ())?,
        Format::Sp3 => {
            sp3::parse_kept(input, &mut findings, &|_| KeptStates::None).map(drop)?;
        }
        Format::Czml => {
            czml::parse_kept(input, &mut findings, &|_| KeptStates::None).map(drop)?;
        }
        Format::Yuma => yuma::parse(input, &mut findings).map(drop)?,
        Format::Sem => sem::parse(input, &mut findings).map(drop)?,
        Format::Stk => stk::parse_kept(input, &mut findings, KeptStates::None).map(drop)?,
        Format::Opm => opm::parse(input, &mut findings).map(drop)?,
        Format::ElementsCsv => csv::parse_elements(input, &mut findings, |_| ())?,
        Format::StatesCsv => csv::parse_states(input, &mut findings).map(drop)?,
    }
    let findings = findings.into_vec();
    Ok(LintReport {
        format: Some(format),
        findings,
    })
}

/// The messages that are read from XML: those of the format that is asked for, or else all kinds.
pub(super) fn xml_kinds(asked: Option<Format>) -> &'static [&'static str] {
    match asked {
        Some(Format::OemXml) => &["oem"],
        Some(Format::OmmXml) => &["omm"],
        Some(Format::OpmXml) => &["opm"],
        _ => ndm::READ,
    }
}

/// Element sets, none of which may appear twice.
fn lint_tle(input: impl BufRead, findings: &mut FindingList) -> io::Result<()> {
    let mut known = HashSet::new();
    let mut repeated = Vec::new();
    tle::parse(input, findings, |record| {
        if !known.insert((record.set.norad_id, record.set.datetime)) {
            repeated.push((record.line, record.set.norad_id));
        }
    })?;
    for (line, number) in repeated {
        let message = format!("satellite {number} has an earlier set with the same epoch");
        findings.warning((line, 3), "tle-repeated", message);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exchange::export::testing::{in_memory, is_read, subject};
    use crate::exchange::export::{Choices, Product};

    use crate::keyword::Keyword;
    use crate::time::{Epoch, TimeGrid};
    use std::collections::BTreeMap;

    /// The files of an export in every notation.
    fn exported() -> BTreeMap<String, Vec<u8>> {
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let subject = subject(
            "star:86.4:14/7/1@780".parse().unwrap(),
            TimeGrid::new(epoch, 1_200.0, 60.0).unwrap(),
        );
        let mut files = BTreeMap::new();
        for notation in OmmSyntax::ALL {
            let choices = Choices {
                omm: *notation,
                ..Choices::default()
            };
            files.extend(in_memory(&subject, Product::ALL, choices).1);
        }
        for oem_combined in [false, true] {
            let choices = Choices {
                oem: oem::OemSyntax::Xml,
                opm: opm::OpmSyntax::Xml,
                oem_combined,
                ..Choices::default()
            };
            files.extend(in_memory(&subject, &[Product::Oem, Product::Opm], choices).1);
        }
        files
    }

    /// Every file that the exporter writes is recognised by its content and has no finding.
    #[test]
    fn our_own_files_have_no_finding() {
        let mut formats = HashSet::new();
        for (path, bytes) in exported() {
            if !is_read(&path) {
                continue;
            }
            let report = lint(bytes.as_slice(), None, None, 20).unwrap();
            assert_eq!(report.findings, [], "{path}");
            formats.insert(report.format);
        }
        // SEM is read and not written.
        assert_eq!(formats.len(), Format::ALL.len() - 1);
    }

    /// Bytes of one format given to the reader of another, cut short, or of no format at all.
    #[test]
    fn what_is_no_file_of_its_format_is_reported_by_all() {
        let files = exported();
        for format in Format::ALL {
            for bytes in [
                &b""[..],
                b"\0\x01\x02",
                b"hello\nworld\n",
                &files["manifest.json"],
            ] {
                let report = lint(bytes, Some(*format), None, 5).unwrap();
                assert!(!report.findings.is_empty(), "{format}");
                assert!(report.findings.len() <= 5);
            }
        }
        for (path, bytes) in &files {
            let whole = [".csv", ".tle", ".alm"];
            if whole.iter().any(|end| path.ends_with(end)) || !is_read(path) {
                continue;
            }
            let cut = &bytes[..bytes.len() * 2 / 3];
            let report = lint(cut, None, None, 5).unwrap();
            assert!(!report.findings.is_empty(), "{path}");
        }
    }

    #[test]
    fn repeated_sets_are_reported() {
        let mut bytes = exported()["constellation.tle"].clone();
        bytes.extend_from_within(..);
        let report = lint(bytes.as_slice(), None, None, 100).unwrap();
        assert_eq!(report.format, Some(Format::Tle));
        assert_eq!(report.findings.len(), 14);
        assert_eq!(
            (report.findings[0].line, report.findings[0].rule),
            (44, "tle-repeated")
        );
    }

    /// An endless line costs hardly any memory or time: 64 MiB here.
    #[test]
    fn endless_lines_are_passed_over() {
        for format in Format::ALL {
            let endless = io::BufReader::new(io::Read::take(io::repeat(b'x'), 1 << 26));
            let report = lint(endless, Some(*format), None, 5).unwrap();
            assert!(!report.findings.is_empty(), "{format}");
        }
    }
}
