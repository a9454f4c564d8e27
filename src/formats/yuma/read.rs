//! Reads YUMA almanacs: blocks of `key: value`, one a satellite.

use super::Almanac;
use crate::formats::ReadError;
use crate::formats::text::finding::FindingList;
use crate::formats::text::lines::{Line, Lines};
use crate::formats::text::number;
use std::io::{self, BufRead};

/// The fields by the beginnings of their keys, in the order of a block.
const KEYS: [&str; 13] = [
    "ID",
    "Health",
    "Eccentricity",
    "Time of Applicability",
    "Orbital Inclination",
    "Rate of Right Ascen",
    "SQRT(A)",
    "Right Ascen at ",
    "Argument of Perigee",
    "Mean Anom",
    "Af0",
    "Af1",
    "week",
];

/// Reads the satellites, those that are unhealthy among them; the first broken rule ends it.
///
/// # Errors
/// The first finding, or a failure of the input.
pub fn read(input: impl BufRead) -> Result<Vec<Almanac>, ReadError> {
    let mut findings = FindingList::of_reader();
    let almanacs = parse(input, &mut findings)?;
    findings.unless_error(almanacs)
}

/// Reads the satellites; errors are added to the list of findings.
///
/// # Errors
/// A failure of the input.
pub fn parse(input: impl BufRead, findings: &mut FindingList) -> io::Result<Vec<Almanac>> {
    let mut lines = Lines::with_tabs(input);
    let mut block = AlmanacBlock::default();
    let mut almanacs: Vec<Almanac> = Vec::new();
    loop {
        let line = lines.next(findings)?;
        let begins = line
            .as_ref()
            .is_none_or(|line| line.text.starts_with("***"));
        if begins && !block.is_empty() {
            let place = (block.first, 1);
            if let Some(almanac) = std::mem::take(&mut block).almanac(findings) {
                almanac.check(place, &almanacs, findings);
                almanacs.push(almanac);
            }
        }
        let Some(line) = line else { break };
        if !begins && !line.text.trim().is_empty() {
            block.add(&line, findings);
        }
    }
    if almanacs.is_empty() && !findings.is_full() {
        let place = (lines.number().max(1), 1);
        findings.error(place, "almanac-empty", "there is no satellite");
    }
    Ok(almanacs)
}

#[derive(Default)]
struct AlmanacBlock {
    /// Line of the first field.
    first: usize,
    last: usize,
    values: [Option<f64>; KEYS.len()],
}

impl AlmanacBlock {
    fn is_empty(&self) -> bool {
        self.first == 0
    }

    fn add(&mut self, line: &Line, findings: &mut FindingList) {
        self.last = line.number;
        if self.is_empty() {
            self.first = line.number;
        }
        let place = (line.number, 1);
        let known = line.text.split_once(':').and_then(|(key, value)| {
            let key = key.trim_start();
            let is_key = |known: &str| {
                let start = key.get(..known.len());
                start.is_some_and(|start| start.eq_ignore_ascii_case(known))
            };
            Some((KEYS.iter().position(|known| is_key(known))?, value))
        });
        let Some((at, value)) = known else {
            findings.error(place, "yuma-line", "this is not a field of a YUMA almanac");
            return;
        };
        if self.values[at].is_some() {
            let message = format!("{} is given twice in one block", KEYS[at]);
            findings.error(place, "yuma-repeated", message);
            return;
        }
        let column = line.text.len() - value.trim_start().len() + 1;
        let place = (line.number, column);
        self.values[at] = number::read(value.trim(), place, "yuma-number", findings);
    }

    fn almanac(self, findings: &mut FindingList) -> Option<Almanac> {
        let place = (self.last, 1);
        let missing = (0..KEYS.len()).find(|at| self.values[*at].is_none());
        if let Some(at) = missing {
            let message = format!("the block that ends here has no '{}'", KEYS[at].trim());
            findings.error(place, "yuma-missing", message);
            return None;
        }
        let value = |at: usize| self.values[at].unwrap_or_default();
        let mut whole = |at| number::whole(value(at), place, "yuma-number", findings);
        let (prn, health, week) = (whole(0)?, whole(1)?, whole(12)?);
        Some(Almanac {
            prn,
            health,
            eccentricity: value(2),
            toa_s: value(3),
            inclination_rad: value(4),
            raan_rate_rad_s: value(5),
            sqrt_a: value(6),
            raan_at_week_rad: value(7),
            arg_perigee_rad: value(8),
            mean_anomaly_rad: value(9),
            week,
        })
    }
}
