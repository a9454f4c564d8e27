//! Ground points from a CSV table.

use super::{GroundError, MAX_POINTS, Site};
use crate::earth::Surface;
use crate::printable::printable;
use csv::{Reader, ReaderBuilder, StringRecord, Trim};
use std::io::Read;

/// Required columns of a table of points.
const NEEDED: [&str; 2] = ["latitude_deg", "longitude_deg"];
/// Optional columns.
const OPTIONAL: [&str; 2] = ["weight", "name"];

/// The mark that spreadsheets write in front of UTF-8 text.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The positions of the columns in a row.
struct Columns {
    latitude: usize,
    longitude: usize,
    weight: Option<usize>,
    name: Option<usize>,
}

/// Points from CSV with the columns `latitude_deg` and `longitude_deg` and optionally `weight` (1
/// if empty) and `name`, in any order; others are ignored.
///
/// # Errors
/// If a column is missing, a line cannot be read (the error has its number), or there are no points.
pub fn sites_from_csv(mut source: impl Read, surface: Surface) -> Result<Vec<Site>, GroundError> {
    let mut text = Vec::new();
    source.read_to_end(&mut text).map_err(|error| {
        let reason = error.to_string();
        GroundError::Line { line: 1, reason }
    })?;
    let text = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(&text);
    let mut reader = reader(text);
    let header = reader.headers().map_err(unreadable)?.clone();
    let columns = Columns::of(&header)?;
    let mut sites = Vec::new();
    for row in reader.records() {
        let row = row.map_err(unreadable)?;
        let line = row.position().map_or(1, |position| line_of(position, text));
        let at_line = |reason: String| GroundError::Line { line, reason };
        if row.len() != header.len() {
            let (found, expected) = (row.len(), header.len());
            return Err(at_line(format!(
                "found {found} fields, expected {expected}"
            )));
        }
        if sites.len() == MAX_POINTS {
            let points = MAX_POINTS as f64 + 1.0;
            return Err(GroundError::TooMany { points });
        }
        sites.push(columns.site(&row, surface).map_err(at_line)?);
    }
    if sites.is_empty() {
        Err(GroundError::Empty)
    } else {
        Ok(sites)
    }
}

/// The columns of a table of points that are ignored.
#[must_use]
pub fn ignored_columns(source: impl Read) -> Vec<String> {
    let known = |name: &str| NEEDED.contains(&name) || OPTIONAL.contains(&name);
    match reader(source).headers() {
        Ok(header) => {
            let ignored = header.iter().filter(|name| !known(name));
            ignored.map(str::to_owned).collect()
        }
        Err(_) => Vec::new(),
    }
}

/// The line of a record. The reader reports the position of any blank lines before it, so they are added.
fn line_of(position: &csv::Position, text: &[u8]) -> u64 {
    let from = usize::try_from(position.byte()).unwrap_or(usize::MAX);
    let rest = text.get(from..).unwrap_or_default();
    let blank = rest.iter().take_while(|byte| byte.is_ascii_whitespace());
    position.line() + blank.filter(|byte| **byte == b'\n').count() as u64
}

fn reader<R: Read>(source: R) -> Reader<R> {
    ReaderBuilder::new()
        .trim(Trim::All)
        .flexible(true)
        .from_reader(source)
}

fn unreadable(error: csv::Error) -> GroundError {
    GroundError::Line {
        line: error.position().map_or(1, csv::Position::line),
        reason: error.to_string(),
    }
}

impl Columns {
    fn of(header: &StringRecord) -> Result<Self, GroundError> {
        if header.is_empty() {
            return Err(GroundError::Empty);
        }
        let optional = |column: &str| {
            let mut found = (0..header.len()).filter(|at| header.get(*at) == Some(column));
            match (found.next(), found.next()) {
                (_, Some(_)) => Err(GroundError::Line {
                    line: 1,
                    reason: format!("column {column} appears more than once"),
                }),
                (first, None) => Ok(first),
            }
        };
        let needed = |column: &'static str| {
            optional(column)?.ok_or_else(|| GroundError::Line {
                line: 1,
                reason: missing(column, header),
            })
        };
        Ok(Self {
            latitude: needed(NEEDED[0])?,
            longitude: needed(NEEDED[1])?,
            weight: optional(OPTIONAL[0])?,
            name: optional(OPTIONAL[1])?,
        })
    }

    fn site(&self, row: &StringRecord, surface: Surface) -> Result<Site, String> {
        let field = |at: usize| row.get(at).unwrap_or_default();
        let number = |at: usize, column: &str| {
            let text = field(at);
            let number = text.parse::<f64>();
            number.map_err(|_| {
                let text = printable(text);
                format!("{column}: found \"{text}\", expected a number")
            })
        };
        let weight = match self.weight.filter(|at| !field(*at).is_empty()) {
            Some(at) => number(at, OPTIONAL[0])?,
            None => 1.0,
        };
        let latitude_deg = number(self.latitude, NEEDED[0])?;
        let longitude_deg = number(self.longitude, NEEDED[1])?;
        let site = Site::new(surface, latitude_deg, longitude_deg, weight);
        let mut site = site.map_err(|error| error.to_string())?;
        let name = self.name.map(field).filter(|name| !name.is_empty());
        if name.is_some_and(|name| name.contains(char::is_control)) {
            return Err("name: found a control character, expected printable text".to_owned());
        }
        site.name = name.map(|name| printable(name).into());
        Ok(site)
    }
}

/// The error for a missing column, suggesting a column that may have been meant.
fn missing(column: &str, header: &StringRecord) -> String {
    let found: Vec<&str> = header.iter().collect();
    let alike = |name: &&&str| name.to_lowercase().starts_with(&column[..3]);
    let hint = found.iter().find(alike).map_or_else(String::new, |name| {
        format!("; rename {name} if it holds degrees")
    });
    format!(
        "there is no column {column} (found: {}){hint}",
        found.join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sites(text: &str) -> Result<Vec<Site>, GroundError> {
        sites_from_csv(text.as_bytes(), Surface::Wgs84)
    }

    #[track_caller]
    fn refused(text: &str, message: &str) {
        let error = sites(text).unwrap_err().to_string();
        assert!(error.contains(message), "{error}");
    }

    #[test]
    fn points_come_from_csv() {
        let sites = sites("latitude_deg,longitude_deg,weight\n 40.1, 116.6, 2\n-33.9,151.2,\n");
        let sites = sites.unwrap();
        assert_eq!(sites.len(), 2);
        assert_eq!((sites[0].weight, sites[1].weight), (2.0, 1.0));
        assert_eq!(sites[0].name, None);
    }

    /// As spreadsheets write them: a byte order mark, columns in any order, extra columns,
    /// names that are not English.
    #[test]
    fn columns_are_found_by_their_names() {
        let text = "\u{feff}name,country,longitude_deg,latitude_deg,opened\r\n\
                    \"Wettzell, Bavaria\",DE,12.9,49.1,1991\r\n\r\n北京,CN,476.4,39.9,\r\n,,0,0,\r\n";
        let sites = sites(text).unwrap();
        let names: Vec<Option<&str>> = sites.iter().map(|site| site.name.as_deref()).collect();
        assert_eq!(names, [Some("Wettzell, Bavaria"), Some("北京"), None]);
        let place = |n: usize| (sites[n].latitude_deg, sites[n].longitude_deg);
        assert_eq!((place(0), place(1)), ((49.1, 12.9), (39.9, 476.4)));
        assert_eq!(ignored_columns(text.as_bytes()), ["country", "opened"]);
        assert!(ignored_columns("latitude_deg,longitude_deg,weight,name\n".as_bytes()).is_empty());
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let header = "latitude_deg,longitude_deg\n";
        refused(&format!("{header}40,116\n95,0\n"), "line 3: latitude 95");
        // Blank lines count.
        refused(
            &format!("{header}\n\n40,721\n"),
            "line 4: latitude 40, longitude 721",
        );
        refused(
            &format!("{header}40,x\n"),
            "line 2: longitude_deg: found \"x\"",
        );
        refused(
            &format!("{header}40,nan\n"),
            "line 2: latitude 40, longitude NaN",
        );
        refused(
            &format!("{header}40,116,1\n"),
            "line 2: found 3 fields, expected 2",
        );
        refused(
            "latitude_deg,longitude_deg,weight\n1,1,-1\n",
            "line 2: weight -1",
        );
        refused(
            "lat,lon\n1,1\n",
            "line 1: there is no column latitude_deg (found: lat, lon); rename lat",
        );
        refused(
            "latitude_deg,longitude_deg,latitude_deg\n1,1,1\n",
            "latitude_deg appears more than once",
        );
        refused(
            "latitude_deg,longitude_deg,name\n1,1,\"a\nb\"\n",
            "control character",
        );
        refused("", "the list is empty");
        refused(header, "the list is empty");
    }
}
