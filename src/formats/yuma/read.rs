//! Reads YUMA almanacs: blocks of `key: value`, one a satellite.

use super::Almanac;
use std::io::{self, BufRead};
use thiserror::Error;

/// Longest line, in bytes.
const MAX_LINE: u64 = 1 << 12;

/// Why an almanac is not read.
#[derive(Debug, Error)]
pub enum ReadAlmanacError {
    /// Reading failed.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// A line without a value, or with one that is not a number.
    #[error("line {line}: expected a key and a number of an almanac, found {text:?}")]
    Line {
        /// Line, from 1.
        line: usize,
        /// Its text.
        text: String,
    },
    /// A block that lacks a field.
    #[error("the block ending at line {line} has no '{key}'")]
    Lacks {
        /// Line, from 1.
        line: usize,
        /// The field.
        key: &'static str,
    },
}

/// The fields by the beginnings of their keys, in the order of a block.
const KEYS: [&str; 13] = [
    "ID",
    "Health",
    "Eccentricity",
    "Time of Applicability",
    "Orbital Inclination",
    "Rate of Right Ascen",
    "SQRT(A)",
    "Right Ascen at Week",
    "Argument of Perigee",
    "Mean Anom",
    "Af0",
    "Af1",
    "week",
];

/// Reads the satellites.
///
/// # Errors
/// Names the line that is not a field, or the field that is missing.
pub fn read(mut input: impl BufRead) -> Result<Vec<Almanac>, ReadAlmanacError> {
    let mut almanacs = Vec::new();
    let mut values: [Option<f64>; 13] = [None; 13];
    let mut number = 0;
    loop {
        let mut bytes = Vec::new();
        let taken = io::Read::take(&mut input, MAX_LINE).read_until(b'\n', &mut bytes)?;
        let text = String::from_utf8_lossy(&bytes).trim().to_owned();
        let ends = taken == 0 || text.starts_with("***");
        number += usize::from(taken > 0);
        if ends && values.iter().any(Option::is_some) {
            almanacs.push(almanac(&values, number)?);
            values = [None; 13];
        }
        if taken == 0 {
            return Ok(almanacs);
        }
        if text.is_empty() || ends {
            continue;
        }
        match field(&text) {
            Some((at, value)) => values[at] = Some(value),
            None => return Err(ReadAlmanacError::Line { line: number, text }),
        }
    }
}

fn field(text: &str) -> Option<(usize, f64)> {
    let (key, value) = text.split_once(':')?;
    let at = KEYS
        .iter()
        .position(|known| key.trim().starts_with(known))?;
    let value: f64 = value.trim().parse().ok()?;
    value.is_finite().then_some((at, value))
}

fn almanac(values: &[Option<f64>; 13], line: usize) -> Result<Almanac, ReadAlmanacError> {
    let value = |at: usize| {
        values[at].ok_or(ReadAlmanacError::Lacks {
            line,
            key: KEYS[at],
        })
    };
    Ok(Almanac {
        prn: value(0)? as u32,
        health: value(1)? as u32,
        eccentricity: value(2)?,
        toa_s: value(3)?,
        inclination_rad: value(4)?,
        raan_rate_rad_s: value(5)?,
        sqrt_a: value(6)?,
        raan_at_week_rad: value(7)?,
        arg_perigee_rad: value(8)?,
        mean_anomaly_rad: value(9)?,
        week: value(12)? as u32,
    })
}
