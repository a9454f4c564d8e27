//! A table of skies: satellites by azimuth and elevation, in CSV.

use crate::dop::{SkySatellite, SkyView};
use crate::ground::line_of;
use crate::keyword::nearest;
use crate::printable::printable;
use csv::{ReaderBuilder, StringRecord, Trim};
use std::fmt;
use std::ops::RangeInclusive;

/// Columns that a table has.
const ANGLES: [(&str, RangeInclusive<f64>); 2] = [
    ("azimuth_deg", -360.0..=360.0),
    ("elevation_deg", -90.0..=90.0),
];
/// Columns that it may have.
const SYSTEM: &str = "system";
const SKY: &str = "sky";

/// The system of all satellites where a table has no such column.
const ONE_SYSTEM: &str = "gnss";

/// The problems of a table that are told; one wrong column has as many as lines.
const MOST_PROBLEMS: usize = 20;

/// What is wrong with a table of skies.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SkyTableError {
    /// Line, from 1, and what is wrong there.
    problems: Vec<(u64, String)>,
    /// The table as named by the caller.
    label: String,
}

impl fmt::Display for SkyTableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let label = printable(&self.label);
        for (n, (line, what)) in self.problems.iter().take(MOST_PROBLEMS).enumerate() {
            let gap = if n > 0 { "\n" } else { "" };
            write!(f, "{gap}{label}:{line}: {what}")?;
        }
        match self.problems.len().saturating_sub(MOST_PROBLEMS) {
            0 => Ok(()),
            more => write!(f, "\n{label}: and {more} more problems"),
        }
    }
}

impl std::error::Error for SkyTableError {}

/// The skies of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct SkyTable {
    /// The skies, in the order in which they begin.
    pub skies: Vec<SkyView>,
    /// Columns that are not used.
    pub ignored: Vec<String>,
}

/// The positions of the columns in a row.
struct SkyColumns {
    angles: [usize; 2],
    system: Option<usize>,
    sky: Option<usize>,
}

/// Reads a table with the columns `azimuth_deg` and `elevation_deg`, and perhaps `system` (whose satellites share a
/// clock) and `sky` (a name; rows of one name are one sky), in any order; `label` names it in errors.
///
/// # Errors
/// If a column is missing, a cell is no angle in its range, or there are no rows: every problem with its line.
pub fn read_skies(label: &str, text: &[u8]) -> Result<SkyTable, SkyTableError> {
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
    let failed = |problems| SkyTableError {
        problems,
        label: label.to_owned(),
    };
    let mut reader = ReaderBuilder::new()
        .trim(Trim::All)
        .flexible(true)
        .from_reader(text);
    let header = reader.headers().cloned();
    let header = header.map_err(|error| failed(vec![unreadable(&error, 1)]))?;
    let columns = columns(&header).map_err(|what| failed(vec![(1, what)]))?;
    let mut problems = Vec::new();
    let mut skies: Vec<SkyView> = Vec::new();
    let mut row = StringRecord::new();
    loop {
        match reader.read_record(&mut row) {
            Ok(false) => break,
            Ok(true) => {}
            Err(error) => {
                problems.push(unreadable(&error, reader.position().line()));
                continue;
            }
        }
        let (name, satellite) = match cells(&row, header.len(), &columns) {
            Ok(cells) => cells,
            Err(found) => {
                let line = row.position().map_or(1, |position| line_of(position, text));
                problems.extend(found.into_iter().map(|what| (line, what)));
                continue;
            }
        };
        match skies.iter_mut().find(|sky| sky.name == name) {
            Some(sky) => sky.satellites.push(satellite),
            None => skies.push(SkyView {
                name,
                satellites: vec![satellite],
            }),
        }
    }
    if problems.is_empty() && skies.is_empty() {
        problems.push((1, "found no rows, expected a satellite in each".to_owned()));
    }
    if !problems.is_empty() {
        return Err(failed(problems));
    }
    let known =
        |name: &&str| ANGLES.iter().any(|(angle, _)| angle == name) || [SYSTEM, SKY].contains(name);
    let ignored = header.iter().filter(|name| !known(name));
    Ok(SkyTable {
        ignored: ignored.map(|name| printable(name).into_owned()).collect(),
        skies,
    })
}

fn unreadable(error: &csv::Error, line: u64) -> (u64, String) {
    let line = error.position().map_or(line, csv::Position::line);
    let what = match error.kind() {
        csv::ErrorKind::Utf8 { .. } => "not UTF-8".to_owned(),
        _ => error.to_string(),
    };
    (line, what)
}

fn columns(header: &StringRecord) -> Result<SkyColumns, String> {
    let place = |column: &str| {
        let mut found = (0..header.len()).filter(|at| header.get(*at) == Some(column));
        match (found.next(), found.next()) {
            (_, Some(_)) => Err(format!("column {column} appears more than once")),
            (first, None) => Ok(first),
        }
    };
    let needed = |column: &str| place(column)?.ok_or_else(|| missing(column, header));
    Ok(SkyColumns {
        angles: [needed(ANGLES[0].0)?, needed(ANGLES[1].0)?],
        system: place(SYSTEM)?,
        sky: place(SKY)?,
    })
}

fn missing(column: &str, header: &StringRecord) -> String {
    let found: Vec<&str> = header.iter().collect();
    let hint = nearest(column, &found).map_or_else(String::new, |name| {
        format!("; rename {} if it holds degrees", printable(name))
    });
    format!(
        "there is no column {column} (found: {}){hint}",
        printable(&found.join(", "))
    )
}

/// The sky and the satellite of a row, or everything that is wrong with it.
fn cells(
    row: &StringRecord,
    width: usize,
    columns: &SkyColumns,
) -> Result<(Option<String>, SkySatellite), Vec<String>> {
    if row.len() != width {
        let told = format!("found {} fields, expected {width}", row.len());
        return Err(vec![told]);
    }
    let mut problems = Vec::new();
    let field = |at: usize| row.get(at).unwrap_or_default();
    let mut angle = |n: usize| {
        let (name, range) = &ANGLES[n];
        let text = field(columns.angles[n]);
        match text.parse::<f64>() {
            Ok(value) if range.contains(&value) => value,
            _ => {
                let (from, to) = (range.start(), range.end());
                let text = printable(text);
                problems.push(format!(
                    "{name}: found \"{text}\", expected a number from {from} to {to} degrees"
                ));
                0.0
            }
        }
    };
    let (azimuth_deg, elevation_deg) = (angle(0), angle(1));
    let mut word = |column: &str, at: Option<usize>| {
        let text = at.map(field)?;
        if text.is_empty() || text.contains(char::is_control) {
            let text = printable(text);
            problems.push(format!("{column}: found \"{text}\", expected a name"));
        }
        Some(text.to_owned())
    };
    let system = word(SYSTEM, columns.system);
    let sky = word(SKY, columns.sky);
    if !problems.is_empty() {
        return Err(problems);
    }
    let satellite = SkySatellite {
        azimuth_deg,
        elevation_deg,
        system: system.unwrap_or_else(|| ONE_SYSTEM.to_owned()),
    };
    Ok((sky, satellite))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn skies_are_read_in_their_order() {
        let text = "\u{feff}sky,elevation_deg, azimuth_deg ,prn,system\n\nb,5,0,1,gps\na,90,-10.5,2,gps\n b ,6,359,3,galileo\n";
        let table = read_skies("skies.csv", text.as_bytes()).unwrap();
        let names: Vec<_> = table.skies.iter().map(|sky| sky.name.as_deref()).collect();
        assert_eq!(names, [Some("b"), Some("a")]);
        assert_eq!(table.skies[0].satellites[1].system, "galileo");
        assert_eq!(table.skies[1].satellites[0].azimuth_deg, -10.5);
        assert_eq!(table.ignored, ["prn"]);
        let one = read_skies("one.csv", b"azimuth_deg,elevation_deg\n1,2").unwrap();
        assert_eq!(one.skies[0].name, None);
        assert_eq!(one.skies[0].satellites[0].system, ONE_SYSTEM);
    }

    proptest! {
        /// No bytes make it panic, and what it takes is in range.
        #[test]
        fn any_bytes_are_read_or_refused(
            bytes in prop::collection::vec(any::<u8>(), 0..60),
            angles in prop::collection::vec((-400.0..400.0_f64, -100.0..100.0_f64), 1..5),
        ) {
            let _ = read_skies("any.csv", &bytes);
            let mut text = b"azimuth_deg,elevation_deg\n".to_vec();
            let _ = read_skies("any.csv", &[&text[..], &bytes].concat());
            for (azimuth_deg, elevation_deg) in &angles {
                text.extend(format!("{azimuth_deg},{elevation_deg}\n").bytes());
            }
            let is_fine = angles.iter().all(|(azimuth_deg, elevation_deg)| {
                azimuth_deg.abs() <= 360.0 && elevation_deg.abs() <= 90.0
            });
            prop_assert_eq!(read_skies("any.csv", &text).is_ok(), is_fine);
        }
    }

    #[test]
    fn every_problem_has_its_line() {
        for (text, told) in [
            (
                "azimuth,elevation_deg\n1,2\n",
                "sky.csv:1: there is no column azimuth_deg (found: azimuth, elevation_deg); rename azimuth if it holds degrees",
            ),
            (
                "azimuth_deg,elevation_deg\n1,95\nx,10\n",
                "sky.csv:2: elevation_deg: found \"95\", expected a number from -90 to 90 degrees\nsky.csv:3: azimuth_deg: found \"x\", expected a number from -360 to 360 degrees",
            ),
            (
                "azimuth_deg,elevation_deg\n\n1,2\n\n1\n",
                "sky.csv:5: found 1 fields, expected 2",
            ),
            (
                "azimuth_deg,elevation_deg\n1,2\nnan,inf",
                "sky.csv:3: azimuth_deg: found \"nan\", expected a number from -360 to 360 degrees\nsky.csv:3: elevation_deg: found \"inf\", expected a number from -90 to 90 degrees",
            ),
            (
                "azimuth_deg,elevation_deg,system\n1,2,\n",
                "sky.csv:2: system: found \"\", expected a name",
            ),
            (
                "azimuth_deg,azimuth_deg,elevation_deg\n1,2,3\n",
                "sky.csv:1: column azimuth_deg appears more than once",
            ),
            (
                "azimuth_deg,elevation_deg\n",
                "sky.csv:1: found no rows, expected a satellite in each",
            ),
            ("", "sky.csv:1: there is no column azimuth_deg (found: )"),
        ] {
            let error = read_skies("sky.csv", text.as_bytes()).unwrap_err();
            assert_eq!(error.to_string(), told);
        }
        let error = read_skies("sky.csv", b"azimuth_deg,elevation_deg\n1,2\n\xff,3\n").unwrap_err();
        assert_eq!(error.to_string(), "sky.csv:3: not UTF-8");
        let many = format!("azimuth_deg,elevation_deg\n{}", "x,1\n".repeat(30));
        let error = read_skies("sky.csv", many.as_bytes())
            .unwrap_err()
            .to_string();
        assert!(error.ends_with("sky.csv:21: azimuth_deg: found \"x\", expected a number from -360 to 360 degrees\nsky.csv: and 10 more problems"), "{error}");
    }
}
