//! A reader of SEM almanacs for GPS.
//!
//! Source: U.S. Coast Guard Navigation Center, *GPS NANUS, Almanacs*: "Definition of a SEM Almanac", and ICD-GPS-870,
//! table 30-II. A line with the number of records and a title, one with the week and the time of applicability, and then
//! fourteen numbers per satellite in nine lines. Angles are in semicircles, the inclination as its offset from 0.30.

use crate::formats::ReadError;
use crate::formats::ccsds::kvn::words;
use crate::formats::text::finding::FindingList;
use crate::formats::text::lines::Lines;
use crate::formats::text::number;
use crate::formats::yuma::Almanac;
use crate::units::counted;
use std::f64::consts::PI;
use std::io::{self, BufRead};

/// Maximum number of absent records that are counted: a first line may announce anything.
const MOST_ABSENT: usize = 1000;

/// Reference inclination of the offsets, semicircles.
const INCLINATION: f64 = 0.30;

/// Numbers of a record: number, vehicle, accuracy, eccentricity, offset of the inclination, rate of the node, root of the
/// axis, node, perigee, mean anomaly, clock offset and drift, health, configuration.
const FIELDS: usize = 14;

/// Reads the satellites, including unhealthy ones; stops at the first error.
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
    let mut announced = None;
    let mut week: Option<[f64; 2]> = None;
    let mut record: Vec<f64> = Vec::with_capacity(FIELDS);
    let mut first = 0;
    let mut almanacs: Vec<Almanac> = Vec::new();
    while let Some(line) = lines.next(findings)? {
        let mut fields = words(&line.text);
        let Some(announced) = announced else {
            // The rest of the line is a title.
            let Some((column, count)) = fields.next() else {
                continue;
            };
            match count.parse::<usize>() {
                Ok(count) => announced = Some(count),
                Err(_) => {
                    let message = "the first line must be the number of records and a title";
                    findings.error((line.number, column), "sem-first-line", message);
                    return Ok(almanacs);
                }
            }
            continue;
        };
        for (column, text) in fields {
            if record.is_empty() {
                first = line.number;
            }
            if almanacs.len() >= announced {
                let message =
                    format!("the first line announces {announced} records; there are more");
                findings.error((line.number, column), "sem-count", message);
                return Ok(almanacs);
            }
            record.extend(number::read(
                text,
                (line.number, column),
                "sem-number",
                findings,
            ));
            match (week, record.len()) {
                (None, 2) => {
                    week = Some([record[0], record[1]]);
                    record.clear();
                }
                (Some(week), FIELDS) => {
                    if let Some(almanac) = almanac(week, &record, (first, 1), findings) {
                        almanac.check((first, 1), &almanacs, findings);
                        almanacs.push(almanac);
                    }
                    record.clear();
                }
                _ => {}
            }
        }
    }
    let place = (lines.number().max(1), 1);
    if !record.is_empty() {
        let message = format!(
            "the record at line {first} has {} numbers; expected {FIELDS}",
            record.len()
        );
        findings.error(place, "sem-truncated", message);
    }
    match announced {
        None => findings.error(place, "sem-first-line", "the file is empty"),
        Some(count) if almanacs.is_empty() => {
            let message = format!("the first line announces {count} records; there are none");
            findings.error(place, "sem-count", message);
        }
        // Records stand by themselves: taking one out by hand leaves the count.
        Some(count) if count > almanacs.len() => {
            let given = almanacs.len();
            let records = counted(given, "record");
            let message =
                format!("the first line announces {count} records; the file has {records}");
            findings.warning(place, "sem-count", message);
            for number in (given + 1..=count).take(MOST_ABSENT) {
                findings.pass_over("announced record that is not there", &number.to_string());
            }
        }
        Some(_) => {}
    }
    Ok(almanacs)
}

fn almanac(
    [week, toa_s]: [f64; 2],
    record: &[f64],
    place: (usize, usize),
    findings: &mut FindingList,
) -> Option<Almanac> {
    let mut whole = |value| number::whole(value, place, "sem-number", findings);
    let (prn, health, week) = (whole(record[0])?, whole(record[12])?, whole(week)?);
    Some(Almanac {
        prn,
        health,
        eccentricity: record[3],
        toa_s,
        inclination_rad: (INCLINATION + record[4]) * PI,
        raan_rate_rad_s: record[5] * PI,
        sqrt_a: record[6],
        raan_at_week_rad: record[7] * PI,
        arg_perigee_rad: record[8] * PI,
        mean_anomaly_rad: record[9] * PI,
        week,
    })
}

#[cfg(test)]
mod tests;
