//! Ground points from a CSV table.

use super::skylines::{SKYLINE, skyline};
use super::{GroundError, MAX_POINTS, Site};
use crate::earth::Surface;
use crate::printable::printable;
use csv::{Reader, ReaderBuilder, StringRecord, Trim};
use std::collections::HashMap;
use std::io::Read;
use std::sync::Arc;

/// Required columns of a table of points.
const NEEDED: [&str; 2] = ["latitude_deg", "longitude_deg"];
/// Optional columns.
const OPTIONAL: [&str; 4] = ["weight", "name", "height_m", SKYLINE];

/// The mark that spreadsheets write in front of UTF-8 text.
pub(super) const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The positions of the columns in a row.
struct Columns {
    latitude: usize,
    longitude: usize,
    weight: Option<usize>,
    name: Option<usize>,
    height: Option<usize>,
    skyline: Option<usize>,
}

/// Points from CSV with the columns `latitude_deg` and `longitude_deg` and optionally `weight` (1
/// if empty), `name`, `height_m` (over the surface, 0 if empty) and `skyline` (pairs `azimuth:elevation`, as
/// [`with_inline_skylines`](crate::ground::with_inline_skylines) writes them), in any order; others are ignored.
///
/// # Errors
/// If a column is missing, a line cannot be read (the error has its number), two lines are the same site, or there are no
/// points.
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
    let mut known = Known::default();
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
        let site = columns.site(&row, surface).map_err(at_line)?;
        known.add(&site, line).map_err(at_line)?;
        sites.push(site);
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
pub(crate) fn line_of(position: &csv::Position, text: &[u8]) -> u64 {
    let from = usize::try_from(position.byte()).unwrap_or(usize::MAX);
    let rest = text.get(from..).unwrap_or_default();
    let blank = rest.iter().take_while(|byte| byte.is_ascii_whitespace());
    position.line() + blank.filter(|byte| **byte == b'\n').count() as u64
}

pub(super) fn reader<R: Read>(source: R) -> Reader<R> {
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
            height: optional(OPTIONAL[2])?,
            skyline: optional(SKYLINE)?,
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
        let height_m = match self.height.filter(|at| !field(*at).is_empty()) {
            Some(at) => Some(number(at, OPTIONAL[2])?),
            None => None,
        };
        let site = site.and_then(|site| match height_m {
            Some(height_m) => site.at_height_m(height_m),
            None => Ok(site),
        });
        let mut site = site.map_err(|error| error.to_string())?;
        let name = self.name.map(field).filter(|name| !name.is_empty());
        if name.is_some_and(|name| name.contains(char::is_control)) {
            return Err("name: found a control character, expected printable text".to_owned());
        }
        site.name = name.map(|name| printable(name).into());
        site.skyline = match self.skyline.map(field).filter(|cell| !cell.is_empty()) {
            Some(cell) => Some(Arc::new(skyline(cell)?)),
            None => None,
        };
        Ok(site)
    }
}

/// The names and places of the lines before.
#[derive(Default)]
struct Known {
    names: HashMap<Arc<str>, u64>,
    places: HashMap<[i64; 3], u64>,
}

impl Known {
    /// Adds a site, or says which line has the same name or place.
    fn add(&mut self, site: &Site, line: u64) -> Result<(), String> {
        if let Some(name) = &site.name
            && let Some(before) = self.names.insert(Arc::clone(name), line)
        {
            return Err(format!("the site {name} is in line {before} already"));
        }
        // To a tenth of a millimetre; longitudes a turn apart are one place, and at a pole all are.
        let whole = |x: f64| (1e9 * x).round() as i64;
        let longitude = match site.latitude_deg.abs() == 90.0 {
            true => 0,
            false => whole(site.longitude_deg).rem_euclid(whole(360.0)),
        };
        let place = [whole(site.latitude_deg), longitude, whole(site.height_m)];
        match self.places.insert(place, line) {
            None => Ok(()),
            Some(before) => Err(format!(
                "latitude {}, longitude {} is the place of line {before}; give one site with the sum of the weights",
                site.latitude_deg, site.longitude_deg
            )),
        }
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

    /// A height moves the point along its vertical: 1 km over the pole of the ellipsoid, and over the equator of the sphere.
    #[test]
    fn heights_are_over_the_surface() {
        let text = "latitude_deg,longitude_deg,height_m\n90,0,1000\n0,0,\n";
        let sites = sites(text).unwrap();
        let polar_km = sites[0].local.origin_km.km().z;
        assert!(
            (polar_km - (6_356.752_314_245 + 1.0)).abs() < 1e-8,
            "{polar_km}"
        );
        assert_eq!((sites[0].height_m, sites[1].height_m), (1000.0, 0.0));
        let text = "latitude_deg,longitude_deg,height_m\n0,0,-250\n";
        let sphere = sites_from_csv(text.as_bytes(), Surface::Sphere).unwrap();
        assert!((sphere[0].local.origin_km.km().x - 6377.887).abs() < 1e-9);
        let header = "latitude_deg,longitude_deg,height_m\n";
        refused(
            &format!("{header}0,0,20001\n"),
            "line 2: height 20001 m is outside -500 to 20000 m",
        );
        refused(&format!("{header}0,0,NaN\n"), "line 2: height NaN m");
        refused(
            &format!("{header}0,0,high\n"),
            "line 2: height_m: found \"high\", expected a number",
        );
    }

    #[test]
    fn a_site_given_twice_is_refused() {
        let header = "name,latitude_deg,longitude_deg,height_m\n";
        refused(
            &format!("{header}Bern,46.9,7.4,0\nThun,46.7,7.6,0\nBern,46.8,7.5,0\n"),
            "line 4: the site Bern is in line 2 already",
        );
        refused(
            &format!("{header},46.9,7.4,0\n,46.9,367.4,0\n"),
            "line 3: latitude 46.9, longitude 367.4 is the place of line 2; give one site with the sum of the weights",
        );
        refused(
            &format!("{header},90,7,0\n,90,8,0\n"),
            "line 3: latitude 90, longitude 8 is the place of line 2",
        );
        // One above the other are two sites.
        assert_eq!(
            sites(&format!("{header}a,46.9,7.4,0\nb,46.9,7.4,300\n"))
                .unwrap()
                .len(),
            2
        );
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
