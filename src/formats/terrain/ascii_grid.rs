//! ESRI ASCII grids (`.asc`).

use super::{RasterFileError, from_the_south};
use crate::ground::Raster;
use crate::printable::printable;

/// Most rows or columns.
const MOST: f64 = 1e6;

/// The header of a grid; each key at most once, in any order.
#[derive(Default)]
struct Header {
    columns: Option<f64>,
    rows: Option<f64>,
    /// The western edge of the grid, or the middle of its western cells.
    west: Option<(f64, bool)>,
    south: Option<(f64, bool)>,
    step: [Option<f64>; 2],
    nodata: Option<f64>,
}

/// Whether a text begins as an ESRI ASCII grid.
pub(super) fn is_ascii_grid(text: &str) -> bool {
    let word = text.split_whitespace().next().unwrap_or_default();
    ["ncols", "nrows"]
        .iter()
        .any(|key| word.eq_ignore_ascii_case(key))
}

/// Values at the middles of cells.
pub(super) fn read(text: &str) -> Result<Raster, RasterFileError> {
    let mut header = Header::default();
    let mut heights: Vec<f32> = Vec::new();
    let mut shape = None;
    for (number, line) in (1..).zip(text.lines()) {
        let at = |reason: String| RasterFileError::Line {
            line: number,
            reason,
        };
        let mut words = line.split_whitespace().peekable();
        let Some(first) = words.peek() else { continue };
        if first.starts_with(|c: char| c.is_ascii_alphabetic()) && shape.is_none() {
            header
                .take(first, words.nth(1).unwrap_or_default())
                .map_err(at)?;
            continue;
        }
        let (rows, columns) = match shape {
            Some(shape) => shape,
            None => *shape.insert(header.shape().map_err(at)?),
        };
        for word in words {
            if heights.len() == rows * columns {
                return Err(at(format!("more than {rows} x {columns} heights")));
            }
            let height = word
                .parse::<f64>()
                .map_err(|_| at(format!("found \"{}\", expected a number", printable(word))))?;
            let is_hole = !height.is_finite() || Some(height) == header.nodata;
            heights.push(if is_hole { f32::NAN } else { height as f32 });
        }
    }
    let end = |reason| RasterFileError::Line {
        line: text.lines().count().max(1),
        reason,
    };
    let (rows, columns) = header.shape().map_err(end)?;
    if heights.len() != rows * columns {
        return Err(end(format!(
            "the file ends after {} heights, expected {rows} x {columns}",
            heights.len()
        )));
    }
    let (corner, step) = header.lattice().map_err(end)?;
    Ok(Raster::new(
        corner,
        step,
        columns,
        from_the_south(&heights, columns),
    )?)
}

impl Header {
    fn take(&mut self, key: &str, value: &str) -> Result<(), String> {
        let lower = key.to_ascii_lowercase();
        let number = value.parse::<f64>().ok();
        let is_nodata = lower == "nodata_value";
        let number = number.filter(|number| number.is_finite() || is_nodata);
        let number = number.ok_or_else(|| {
            format!(
                "{}: found \"{}\", expected a number",
                printable(key),
                printable(value)
            )
        })?;
        match lower.as_str() {
            "ncols" => self.columns = Some(number),
            "nrows" => self.rows = Some(number),
            "xllcorner" => self.west = Some((number, true)),
            "xllcenter" => self.west = Some((number, false)),
            "yllcorner" => self.south = Some((number, true)),
            "yllcenter" => self.south = Some((number, false)),
            "cellsize" => self.step = [Some(number); 2],
            "dx" => self.step[1] = Some(number),
            "dy" => self.step[0] = Some(number),
            "nodata_value" => self.nodata = Some(number),
            _ => {
                let key = printable(key);
                return Err(format!(
                    "unknown key {key} (known: ncols, nrows, xllcorner, xllcenter, yllcorner, yllcenter, cellsize, dx, dy, NODATA_value)"
                ));
            }
        }
        Ok(())
    }

    /// Rows and columns.
    fn shape(&self) -> Result<(usize, usize), String> {
        let whole = |name: &str, number: Option<f64>| {
            let number = number.ok_or_else(|| format!("{name} is missing from the header"))?;
            if number.fract() == 0.0 && (2.0..=MOST).contains(&number) {
                Ok(number as usize)
            } else {
                Err(format!(
                    "{name}: {number} is not a whole number from 2 to {MOST}"
                ))
            }
        };
        Ok((whole("nrows", self.rows)?, whole("ncols", self.columns)?))
    }

    /// The middle of the south-western cell and the steps, northwards and eastwards.
    fn lattice(&self) -> Result<([f64; 2], [f64; 2]), String> {
        let missing = |name: &str| format!("{name} is missing from the header");
        let step = [
            self.step[0].ok_or_else(|| missing("cellsize"))?,
            self.step[1].ok_or_else(|| missing("cellsize"))?,
        ];
        let middle = |edge: Option<(f64, bool)>, name: &str, step: f64| {
            let (at, is_corner) = edge.ok_or_else(|| missing(name))?;
            Ok::<f64, String>(if is_corner { at + step / 2.0 } else { at })
        };
        let corner = [
            middle(self.south, "yllcorner", step[0])?,
            middle(self.west, "xllcorner", step[1])?,
        ];
        Ok((corner, step))
    }
}
