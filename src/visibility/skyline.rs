//! Skylines as users write them: a table of azimuths and elevations, or pairs in one cell.

use super::MaskTable;
use crate::printable::printable;
use csv::{ReaderBuilder, Trim};
use std::fmt::Write as _;
use thiserror::Error;

/// Widest step between two azimuths of a skyline, degrees; a wider one is a gap.
const MAX_GAP_DEG: f64 = 30.0;

/// Largest number of azimuths of a skyline: one every hundredth of a degree.
const MAX_AZIMUTHS: usize = 36_000;

/// The columns of a skyline.
const COLUMNS: [&str; 2] = ["azimuth_deg", "elevation_deg"];

/// The mark that spreadsheets write in front of UTF-8 text.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// Why a table is not a skyline.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SkylineError {
    /// A column that is missing or appears twice.
    #[error(
        "line 1: found {found} columns {column}, expected one (a skyline has azimuth_deg and elevation_deg)"
    )]
    Column {
        /// The column.
        column: &'static str,
        /// How many there are.
        found: usize,
    },
    /// A line that cannot be read, or an azimuth out of order.
    #[error("line {line}: {reason}")]
    Line {
        /// Line, from 1.
        line: u64,
        /// What is wrong with it.
        reason: String,
    },
    /// A pair of a cell that cannot be read, or an azimuth out of order.
    #[error("pair {number}: {reason}")]
    Pair {
        /// Which pair, from 1.
        number: usize,
        /// What is wrong with it.
        reason: String,
    },
    /// No azimuth.
    #[error("there are no azimuths; a skyline covers the whole horizon")]
    Empty,
    /// More azimuths than `MAX_AZIMUTHS`.
    #[error("more than {MAX_AZIMUTHS} azimuths")]
    TooMany,
    /// Azimuths too far apart.
    #[error(
        "there is a gap from azimuth {from_deg} to {to_deg} degrees; azimuths are at most {MAX_GAP_DEG} degrees apart, all around"
    )]
    Gap {
        /// Where it begins, degrees.
        from_deg: f64,
        /// Where it ends, degrees.
        to_deg: f64,
    },
    /// North twice, with different elevations.
    #[error(
        "the elevation is {at_0_deg} degrees at azimuth 0 but {at_360_deg} at 360; both are north"
    )]
    Seam {
        /// Elevation at azimuth 0, degrees.
        at_0_deg: f64,
        /// Elevation at azimuth 360, degrees.
        at_360_deg: f64,
    },
}

impl MaskTable {
    /// The skyline of a CSV table with the columns `azimuth_deg`, from north through east, increasing from 0 to 360, and
    /// `elevation_deg`. It is linear between azimuths, and from the last one across north to the first. Elevations below
    /// the horizon count as 0.
    ///
    /// # Errors
    /// If a column is missing, a line cannot be read, azimuths do not increase, or they leave a gap.
    pub fn from_csv(bytes: &[u8]) -> Result<Self, SkylineError> {
        let bytes = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
        let mut reader = ReaderBuilder::new()
            .trim(Trim::All)
            .flexible(true)
            .from_reader(bytes);
        let unreadable = |error: csv::Error| SkylineError::Line {
            line: error.position().map_or(1, csv::Position::line),
            reason: error.to_string(),
        };
        let header = reader.headers().map_err(unreadable)?.clone();
        let column = |column: &'static str| {
            let mut found = (0..header.len()).filter(|at| header.get(*at) == Some(column));
            match (found.next(), found.count()) {
                (Some(at), 0) => Ok(at),
                (first, more) => Err(SkylineError::Column {
                    column,
                    found: usize::from(first.is_some()) + more,
                }),
            }
        };
        let columns = [column(COLUMNS[0])?, column(COLUMNS[1])?];
        let mut horizon = DrawnSkyline::default();
        let mut row = csv::StringRecord::new();
        while reader.read_record(&mut row).map_err(unreadable)? {
            // The reader is behind the row, which has no line break in it.
            let line = reader.position().line().saturating_sub(1).max(2);
            let [azimuth, elevation] = columns.map(|at| row.get(at).unwrap_or_default());
            horizon
                .add(azimuth, elevation)
                .map_err(|reason| SkylineError::Line { line, reason })?;
        }
        horizon.close()
    }

    /// The skyline of pairs `azimuth:elevation`, degrees, separated by spaces, under the rules of [`MaskTable::from_csv`].
    ///
    /// # Errors
    /// If a pair cannot be read, azimuths do not increase, or they leave a gap.
    pub fn from_pairs(text: &str) -> Result<Self, SkylineError> {
        let mut horizon = DrawnSkyline::default();
        for (number, pair) in (1..).zip(text.split_whitespace()) {
            let (azimuth, elevation) = pair.split_once(':').unwrap_or((pair, ""));
            horizon
                .add(azimuth, elevation)
                .map_err(|reason| SkylineError::Pair { number, reason })?;
        }
        horizon.close()
    }

    /// The pairs that [`MaskTable::from_pairs`] reads back as the same skyline.
    #[must_use]
    pub fn to_pairs(&self) -> String {
        let mut text = String::new();
        for (azimuth_deg, elevation_deg) in self.vertices() {
            let gap = if text.is_empty() { "" } else { " " };
            // Writing to a String does not fail.
            let _ = write!(text, "{gap}{azimuth_deg}:{elevation_deg}");
        }
        text
    }

    /// Its highest elevation, degrees.
    #[must_use]
    pub fn highest_deg(&self) -> f64 {
        let elevations = self.vertices().iter().map(|vertex| vertex.1);
        elevations.fold(0.0, f64::max)
    }
}

/// Whether a cell holds pairs of azimuth and elevation, and not the path of a file.
pub(crate) fn is_pairs(cell: &str) -> bool {
    let is_number = |text: &str| text.parse::<f64>().is_ok();
    let is_pair = |pair: &str| {
        let halves = pair.split_once(':');
        halves.is_some_and(|(azimuth, elevation)| is_number(azimuth) && is_number(elevation))
    };
    let mut pairs = cell.split_whitespace();
    pairs.next().is_some_and(is_pair)
}

/// A skyline as it is read.
#[derive(Default)]
struct DrawnSkyline {
    /// (azimuth, elevation), degrees; azimuths increase.
    vertices: Vec<(f64, f64)>,
}

impl DrawnSkyline {
    fn add(&mut self, azimuth: &str, elevation: &str) -> Result<(), String> {
        let azimuth_deg = number(COLUMNS[0], azimuth)?;
        let elevation_deg = number(COLUMNS[1], elevation)?;
        if !(0.0..=360.0).contains(&azimuth_deg) {
            return Err(format!(
                "azimuth_deg: {azimuth_deg} is outside 0 to 360 degrees"
            ));
        }
        if !(-90.0..90.0).contains(&elevation_deg) {
            return Err(format!(
                "elevation_deg: {elevation_deg} is outside -90 to 90 (exclusive) degrees"
            ));
        }
        match self.vertices.last() {
            Some(&(before_deg, _)) if before_deg == azimuth_deg => {
                return Err(format!("azimuth {azimuth_deg} degrees is given twice"));
            }
            Some(&(before_deg, _)) if before_deg > azimuth_deg => {
                return Err(format!(
                    "azimuth {azimuth_deg} degrees follows {before_deg}; azimuths must increase"
                ));
            }
            _ => {}
        }
        self.vertices.push((azimuth_deg, elevation_deg.max(0.0)));
        Ok(())
    }

    /// The skyline, closed across north.
    fn close(self) -> Result<MaskTable, SkylineError> {
        let mut vertices = self.vertices;
        let (Some(&first), Some(&last)) = (vertices.first(), vertices.last()) else {
            return Err(SkylineError::Empty);
        };
        if vertices.len() > MAX_AZIMUTHS {
            return Err(SkylineError::TooMany);
        }
        let mut pairs = vertices
            .windows(2)
            .map(|pair| (pair[0].0, pair[1].0))
            .chain([(last.0, first.0 + 360.0)]);
        if let Some((from_deg, to_deg)) = pairs.find(|(from, to)| to - from > MAX_GAP_DEG) {
            let to_deg = if to_deg >= 360.0 {
                to_deg - 360.0
            } else {
                to_deg
            };
            return Err(SkylineError::Gap { from_deg, to_deg });
        }
        let (at_0_deg, at_360_deg) = (first.1, last.1);
        if (first.0, last.0) == (0.0, 360.0) && at_0_deg != at_360_deg {
            return Err(SkylineError::Seam {
                at_0_deg,
                at_360_deg,
            });
        }
        let north_deg = if first.0 == 0.0 {
            at_0_deg
        } else {
            let share = (360.0 - last.0) / (first.0 + 360.0 - last.0);
            at_360_deg + share * (at_0_deg - at_360_deg)
        };
        if first.0 > 0.0 {
            vertices.insert(0, (0.0, north_deg));
        }
        if last.0 < 360.0 {
            vertices.push((360.0, north_deg));
        } else if first.0 > 0.0 {
            vertices[0].1 = at_360_deg;
        }
        Ok(MaskTable { vertices })
    }
}

fn number(column: &str, text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok();
    number.filter(|number| number.is_finite()).ok_or_else(|| {
        let text = printable(text);
        format!("{column}: found \"{text}\", expected a number")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A skyline every 30 degrees with one line replaced.
    fn table(replaced: usize, by: &str) -> String {
        let mut text = "azimuth_deg,elevation_deg\n".to_owned();
        for n in 0..12 {
            let line = format!("{},{}", 30 * n, 5 + n);
            text += if n == replaced { by } else { &line };
            text += "\n";
        }
        text
    }

    #[test]
    fn skylines_close_across_north() {
        let whole = MaskTable::from_csv(table(12, "").as_bytes()).unwrap();
        assert_eq!(whole.vertices().len(), 13);
        assert_eq!(whole.vertices()[12], (360.0, 5.0));
        assert_eq!(whole.degrees_at(345.0), 10.5);
        // Without a vertex in the north it lies on the line between its neighbours.
        let text = "elevation_deg,note,azimuth_deg\r\n".to_owned()
            + &(0..18)
                .map(|n| format!("{n},x,{}\r\n", 20 * n + 15))
                .collect::<String>();
        let turned = MaskTable::from_csv(text.as_bytes()).unwrap();
        assert_eq!(turned.vertices()[0], (0.0, 12.75));
        assert_eq!(turned.vertices()[19], (360.0, 12.75));
        assert_eq!(turned.degrees_at(355.0), 17.0);
        // Below the horizon is the horizon.
        let low = MaskTable::from_csv(table(3, "90,-2.5").as_bytes()).unwrap();
        assert_eq!((low.degrees_at(90.0), low.highest_deg()), (0.0, 16.0));
        for skyline in [whole, turned, low] {
            let pairs = skyline.to_pairs();
            assert!(is_pairs(&pairs));
            assert_eq!(MaskTable::from_pairs(&pairs), Ok(skyline));
        }
        assert!(!is_pairs("C:\\tokyo.csv") && !is_pairs("a:b") && !is_pairs("tokyo.csv"));
    }

    #[test]
    fn what_is_no_skyline_is_told_with_its_line() {
        let found = |replaced, by| {
            let table = table(replaced, by);
            MaskTable::from_csv(table.as_bytes())
                .unwrap_err()
                .to_string()
        };
        for (replaced, by, expected) in [
            (
                4,
                "",
                "there is a gap from azimuth 90 to 150 degrees; azimuths are at most 30 degrees apart, all around",
            ),
            (
                11,
                "",
                "there is a gap from azimuth 300 to 0 degrees; azimuths are at most 30 degrees apart, all around",
            ),
            (4, "90,3", "line 6: azimuth 90 degrees is given twice"),
            (
                4,
                "80,3",
                "line 6: azimuth 80 degrees follows 90; azimuths must increase",
            ),
            (
                11,
                "361,3",
                "line 13: azimuth_deg: 361 is outside 0 to 360 degrees",
            ),
            (
                2,
                "60,90",
                "line 4: elevation_deg: 90 is outside -90 to 90 (exclusive) degrees",
            ),
            (
                2,
                "60,NaN",
                "line 4: elevation_deg: found \"NaN\", expected a number",
            ),
            (
                2,
                "60",
                "line 4: elevation_deg: found \"\", expected a number",
            ),
            (
                2,
                "\u{1b}[2J,3",
                "line 4: azimuth_deg: found \"\\u{1b}[2J\", expected a number",
            ),
            (
                11,
                "330,9\n360,9",
                "the elevation is 5 degrees at azimuth 0 but 9 at 360; both are north",
            ),
        ] {
            assert_eq!(found(replaced, by), expected);
        }
        for (text, expected) in [
            (
                "azimuth_deg,elevation_deg\n",
                "there are no azimuths; a skyline covers the whole horizon",
            ),
            (
                "azimuth_deg,mask\n0,1\n",
                "line 1: found 0 columns elevation_deg, expected one (a skyline has azimuth_deg and elevation_deg)",
            ),
            (
                "azimuth_deg,azimuth_deg\n0,1\n",
                "line 1: found 2 columns azimuth_deg, expected one (a skyline has azimuth_deg and elevation_deg)",
            ),
        ] {
            let error = MaskTable::from_csv(text.as_bytes()).unwrap_err();
            assert_eq!(error.to_string(), expected);
        }
        let pair = MaskTable::from_pairs("0:1 x:2").unwrap_err().to_string();
        assert_eq!(pair, "pair 2: azimuth_deg: found \"x\", expected a number");
    }
}
