//! Reads SP3-a to SP3-d by columns.

use super::track::SatelliteTrack;
use super::{DM_IN_KM, Sp3, Sp3Sample};
use crate::formats::ReadError;
use crate::formats::kept_states::KeptStates;
use crate::formats::text::finding::FindingList;
use crate::formats::text::lines::{Line, Lines, keep_comment};
use crate::formats::text::timestamp::{TimeSystem, stamp};
use crate::formats::trajectory::{frame_of_sp3_name, time_system_of_name};
use crate::frames::Position;
use crate::orbit::earth_orbit::check_position;
use crate::time::Epoch;
use chrono::{NaiveDate, NaiveDateTime};
use nalgebra::Vector3;
use std::io::{self, BufRead};

/// Reads a file; the first broken rule ends it.
///
/// # Errors
/// The first finding, or a failure of the input.
pub fn read(input: impl BufRead) -> Result<Sp3, ReadError> {
    let mut findings = FindingList::of_reader();
    let file = parse(input, &mut findings)?;
    findings.unless_error(file)
}

/// Reads a file; violations go to the list of findings.
///
/// # Errors
/// A failure of the input.
pub fn parse(input: impl BufRead, findings: &mut FindingList) -> io::Result<Sp3> {
    parse_kept(input, findings, &|_| KeptStates::All)
}

/// The same, with the states that `choice` keeps of the satellite of a name.
///
/// # Errors
/// A failure of the input.
pub fn parse_kept(
    input: impl BufRead,
    findings: &mut FindingList,
    choice: Sp3Choice<'_>,
) -> io::Result<Sp3> {
    let mut lines = Lines::new(input).with_comments(is_comment);
    let mut parser = Sp3Parser::new(choice);
    while let Some(line) = lines.next(findings)? {
        parser.line(&line, findings);
    }
    Ok(parser.end(lines.number().max(1), findings))
}

/// Comments begin with `/*`; those of the laser ranging service with `%/*`.
fn is_comment(line: &[u8]) -> bool {
    line.starts_with(b"/*") || line.starts_with(b"%/*")
}

/// Says which states of the satellite of a name are kept.
pub type Sp3Choice<'a> = &'a dyn Fn(&str) -> KeptStates<Epoch>;

struct Sp3Parser<'a> {
    choice: Sp3Choice<'a>,
    file: Sp3,
    /// The positions of each satellite.
    tracks: Vec<SatelliteTrack>,
    /// Number of satellites and of epochs that the header announces.
    announced: (usize, usize),
    /// Lines that begin with `%c`.
    type_lines: usize,
    epochs: usize,
    at: Option<Epoch>,
    /// Satellites whose position at this epoch is marked as missing.
    missing: Vec<usize>,
    /// Number of positions at this epoch, including missing ones.
    records: usize,
    ended: bool,
    any: bool,
}

impl<'a> Sp3Parser<'a> {
    fn new(choice: Sp3Choice<'a>) -> Self {
        Self {
            choice,
            tracks: Vec::new(),
            file: Sp3 {
                version: ' ',
                time_system: TimeSystem::Gps,
                frame: String::new(),
                ids: Vec::new(),
                comments: Vec::new(),
                states: Vec::new(),
                spans: Vec::new(),
                step_s: None,
            },
            announced: (0, 0),
            type_lines: 0,
            epochs: 0,
            at: None,
            missing: Vec::new(),
            records: 0,
            ended: false,
            any: false,
        }
    }

    fn line(&mut self, line: &Line, findings: &mut FindingList) {
        let text = line.text.trim_end();
        let place = (line.number, 1);
        if !std::mem::replace(&mut self.any, true) {
            self.first_line(line, findings);
            return;
        }
        if self.ended {
            if !text.is_empty() {
                findings.error(place, "sp3-line", "nothing may follow EOF");
            }
            return;
        }
        match text.as_bytes() {
            [b'#', b'#', ..]
            | [b'+', b'+', ..]
            | [b'%', b'f' | b'i', ..]
            | [b'E', b'P' | b'V', ..] => {}
            [b'+', b' ', ..] => self.ids(line, findings),
            [b'%', b'c', ..] => self.file_type(line, findings),
            bytes if is_comment(bytes) => {
                let comment = text.trim_start_matches(['%', '/', '*']);
                keep_comment(&mut self.file.comments, comment.trim());
            }
            [b'*', b' ', ..] => self.epoch(line, findings),
            [b'P', ..] => self.position(line, findings),
            [b'V', ..] => self.velocity(line, findings),
            _ if text == "EOF" => self.ended = true,
            _ => findings.error(place, "sp3-line", "not a line of SP3"),
        }
    }

    fn first_line(&mut self, line: &Line, findings: &mut FindingList) {
        let bytes = line.text.as_bytes();
        let ([b'#', version @ b'a'..=b'd', b'P' | b'V', ..], true) = (bytes, bytes.len() >= 51)
        else {
            let message = "the first line must be # with a version a to d, P or V, and 60 columns";
            findings.error((line.number, 1), "sp3-first-line", message);
            return;
        };
        self.file.version = char::from(*version);
        self.file.frame = line.text[46..51].trim().to_owned();
        if let Err(unknown) = frame_of_sp3_name(&self.file.frame) {
            let message = format!("coordinate system: {unknown}");
            findings.error((line.number, 47), "sp3-frame", message);
        }
        match line.text[32..39].trim().parse() {
            Ok(epochs) => self.announced.1 = epochs,
            Err(_) => {
                let message = "the number of epochs is not a number";
                findings.error((line.number, 33), "sp3-number", message);
            }
        }
        if calendar(&line.text[3..31]).is_none() {
            findings.error(
                (line.number, 4),
                "sp3-time",
                "the first epoch is not a time",
            );
        }
    }

    fn ids(&mut self, line: &Line, findings: &mut FindingList) {
        let text = &line.text;
        if let Some(Ok(count)) = text.get(3..6).map(|count| count.trim().parse()) {
            self.announced.0 = count;
        }
        for column in (9..60).step_by(3) {
            let Some(id) = text.get(column..column + 3) else {
                return;
            };
            if self.file.ids.len() == self.announced.0 || id.trim() == "0" {
                continue;
            }
            let place = (line.number, column + 1);
            if !is_id(id) {
                let message = format!("'{id}' is not an id: a letter and two digits");
                findings.error(place, "sp3-id", message);
            } else if self.file.ids.iter().any(|known| known == id) {
                findings.error(place, "sp3-id", format!("{id} is named twice"));
            } else {
                self.file.ids.push(id.to_owned());
                self.tracks.push(SatelliteTrack::default());
            }
        }
    }

    fn file_type(&mut self, line: &Line, findings: &mut FindingList) {
        self.type_lines += 1;
        if self.type_lines > 1 || !matches!(self.file.version, 'c' | 'd') {
            return;
        }
        let name = line.text.get(9..12).unwrap_or_default().trim();
        let name = match name.to_ascii_uppercase().as_str() {
            // Times of other systems that are steered to GPS time within some tens of ns: 1 mm.
            "GAL" | "QZS" | "IRN" => "GPS",
            // The UTC of GLONASS, without Moscow's three hours.
            "GLO" => "UTC",
            "CCC" | "" => {
                let message = "no time system is named; GPS time is assumed";
                findings.warning((line.number, 10), "sp3-time-system", message);
                "GPS"
            }
            _ => name,
        };
        match time_system_of_name(name) {
            Ok(time_system) => self.file.time_system = time_system,
            Err(_) => {
                let message = format!(
                    "time system '{name}' is not GPS, UTC, TAI, TT, GAL, GLO, BDT, QZS or IRN"
                );
                findings.error((line.number, 10), "sp3-time-system", message);
            }
        }
    }

    fn epoch(&mut self, line: &Line, findings: &mut FindingList) {
        let stamp = line.text.get(3..31).and_then(calendar);
        let Some(stamp) = stamp else {
            findings.error((line.number, 4), "sp3-time", "the epoch is not a time");
            self.at = None;
            return;
        };
        let system = self.file.time_system;
        if !system.has(stamp) {
            let message = format!("{system} has no second 60; only UTC has");
            findings.error((line.number, 4), "sp3-time", message);
            self.at = None;
            return;
        }
        let at = system.epoch(stamp);
        self.missing.clear();
        self.records = 0;
        if let Some(before) = self.at {
            let step_s = at.seconds_since(before);
            if step_s <= 0.0 {
                let message = "the epoch is not after the one before";
                findings.error((line.number, 4), "sp3-time-order", message);
            }
            let least_s = self.file.step_s.get_or_insert(step_s);
            *least_s = least_s.min(step_s);
        }
        self.epochs += 1;
        self.at = Some(at);
    }

    /// The satellite of a record, and its three numbers.
    fn record(&self, line: &Line, findings: &mut FindingList) -> Option<(usize, Vector3<f64>)> {
        let text = &line.text;
        let id = text.get(1..4).unwrap_or_default();
        let Some(index) = self.file.ids.iter().position(|known| known == id) else {
            let message = format!("satellite '{id}' is not in the header");
            findings.error((line.number, 2), "sp3-id", message);
            return None;
        };
        let mut values = [0.0; 3];
        for (value, column) in values.iter_mut().zip([4, 18, 32]) {
            let field = text.get(column..column + 14).unwrap_or_default();
            match field.trim().parse::<f64>() {
                Ok(number) if number.is_finite() => *value = number,
                _ => {
                    let message = format!("'{field}' is not a number of 14 columns");
                    findings.error((line.number, column + 1), "sp3-number", message);
                    return None;
                }
            }
        }
        Some((index, Vector3::from(values)))
    }

    fn position(&mut self, line: &Line, findings: &mut FindingList) {
        let (Some((index, position_km)), Some(at)) = (self.record(line, findings), self.at) else {
            return;
        };
        self.records += 1;
        // A position of zeros means a missing one.
        if position_km.norm_squared() == 0.0 {
            self.missing.push(index);
            return;
        }
        if let Err(fault) = check_position(&position_km) {
            let message = format!("{}: {fault}", self.file.ids[index]);
            findings.error((line.number, 5), "implausible-state", message);
            return;
        }
        let sample = Sp3Sample {
            at,
            position_km: Position::new(position_km),
            velocity_km_s: None,
        };
        let id = &self.file.ids[index];
        let choice = || (self.choice)(self.file.name_of(id).unwrap_or(id));
        if !self.tracks[index].add(sample, choice) {
            let message = "the satellite has two positions at one epoch";
            findings.error((line.number, 2), "sp3-repeated", message);
        }
    }

    fn velocity(&mut self, line: &Line, findings: &mut FindingList) {
        let Some((index, velocity_dm_s)) = self.record(line, findings) else {
            return;
        };
        // Zeros stand for a missing velocity too.
        let given = velocity_dm_s.norm_squared() > 0.0;
        let velocity_km_s = given.then(|| velocity_dm_s / DM_IN_KM);
        let track = &mut self.tracks[index];
        let is_set = self
            .at
            .is_some_and(|at| track.set_velocity(at, velocity_km_s));
        if !is_set && !self.missing.contains(&index) {
            let message = "a velocity without a position before it";
            findings.error((line.number, 1), "sp3-velocity", message);
        }
    }

    fn end(mut self, number: usize, findings: &mut FindingList) -> Sp3 {
        let place = (number, 1);
        if !self.any {
            findings.error(place, "sp3-first-line", "the file is empty");
        }
        let (satellites, epochs) = self.announced;
        if self.any && !self.ended {
            // Products of laser ranging end without it; the counts show whether anything is lost.
            if self.epochs == epochs && self.records >= satellites {
                findings.warning(place, "sp3-eof", "EOF is missing");
            } else {
                findings.error(
                    place,
                    "sp3-truncated",
                    "the file ends early: EOF is missing",
                );
            }
        }
        if self.file.ids.len() != satellites {
            let message = format!(
                "the header gives {satellites} satellites but names {}",
                self.file.ids.len()
            );
            findings.error(place, "sp3-count", message);
        }
        if self.epochs != epochs {
            let message = format!(
                "the header gives {epochs} epochs, but there are {}",
                self.epochs
            );
            findings.error(place, "sp3-count", message);
        }
        self.tracks.iter_mut().for_each(SatelliteTrack::end);
        self.check_velocities(number, findings);
        self.leave_out_lone_positions(number, findings);
        self.file.spans = self.tracks.iter().map(SatelliteTrack::span).collect();
        let kept = self.tracks.into_iter().map(SatelliteTrack::into_kept);
        self.file.states = kept.collect();
        self.file.drop_lone_positions();
        self.file
    }

    /// A position between gaps has no neighbours to derive its velocity from.
    fn leave_out_lone_positions(&self, number: usize, findings: &mut FindingList) {
        let most_s = self.file.most_between_s();
        let (mut given, mut all_lone) = (0, 0);
        for (id, track) in self.file.ids.iter().zip(&self.tracks) {
            if track.count() == 0 {
                findings.pass_over("satellite without positions", id);
            }
            let (lone, instants) = track.lone(most_s);
            // The names of the many are never shown.
            for place in 0..lone {
                let name = match instants.get(place) {
                    Some(at) => format!("{id} at {at}"),
                    None => id.clone(),
                };
                findings.leave_out((number, 1), "lone position without velocity", &name);
            }
            given += track.count();
            all_lone += lone;
        }
        if given > 0 && given == all_lone {
            let message = "there are no velocities, and too few positions to derive them";
            findings.error((number, 1), "sp3-velocity", message);
        }
    }

    /// Velocities that are not the derivative of the positions: m/s in place of dm/s, or those of inertial
    /// axes.
    fn check_velocities(&self, number: usize, findings: &mut FindingList) {
        let mut tracks = self.file.ids.iter().zip(&self.tracks);
        let fault = tracks.find_map(|(id, track)| Some((id, track.velocity_fault()?)));
        if let Some((id, message)) = fault {
            let message = format!("{id}: {message}; SP3 has dm/s in the axes of the positions");
            findings.warning((number, 1), "sp3-velocity-unit", message);
        }
    }
}

fn is_id(id: &str) -> bool {
    let bytes = id.as_bytes();
    (bytes[0].is_ascii_uppercase() || bytes[0] == b' ')
        && (bytes[1].is_ascii_digit() || bytes[1] == b' ')
        && bytes[2].is_ascii_digit()
}

/// Reads `2025  1  1  0  0  0.00000000`.
fn calendar(text: &str) -> Option<NaiveDateTime> {
    let fields: Vec<&str> = text.split_whitespace().collect();
    let [year, month, day, hour, minute, second] = fields[..] else {
        return None;
    };
    let date = NaiveDate::from_ymd_opt(year.parse().ok()?, month.parse().ok()?, day.parse().ok()?)?;
    let second: f64 = second.parse().ok().filter(|s| (0.0..61.0).contains(s))?;
    let of_minute = (
        hour.parse().ok()?,
        minute.parse().ok()?,
        second.floor() as u32,
    );
    // The columns hold 1e-8 s.
    stamp(date, of_minute, (second.fract() * 1e9).round() as i64)
}
