//! SP3-c and SP3-d orbit files, written and read.
//!
//! Sources: S. Hilla, *The Extended Standard Product 3 Orbit Format (SP3-c)*, 17 August 2010, and
//! *(SP3-d)*, 21 February 2016, National Geodetic Survey. Earth-fixed positions in km, velocities
//! in dm/s, epochs in the time system of the header, here GPS time. An id is a letter and two
//! digits; the letter `L` means a low orbit, and some readers know other letters only.

mod read;
mod track;

pub use read::{Sp3Choice, parse, parse_kept, read};

use crate::constellation::gnss::Preset;
use crate::ephemeris::EphemerisSatellite;
use crate::ephemeris::derivative::GAP;
use crate::ephemeris::sampled::Sampled;
use crate::formats::WriteError;
use crate::formats::metadata::{Metadata, Object};
use crate::formats::text::timestamp::TimeSystem;
use crate::frames::{EarthFixed, Frame, Position, State};
use crate::keyword::keywords;
use crate::time::Epoch;
use chrono::{Datelike, NaiveDate, NaiveDateTime, TimeDelta, Timelike};
use std::io::{self, Write};
use thiserror::Error;

keywords! {
    /// A version of the format.
    Sp3Version {
        /// SP3-d, 2016: up to 999 satellites and any number of comments.
        D = "d",
        /// SP3-c, 2010: up to 85 satellites, four comments of 57 characters.
        C = "c",
    }
}

impl Sp3Version {
    /// Maximum number of satellites in a file: what a letter and two digits can distinguish, and 85 in SP3-c.
    #[must_use]
    pub fn most_satellites(self) -> usize {
        match self {
            Self::C => 85,
            Self::D => 99,
        }
    }

    /// Longest line.
    fn columns(self) -> usize {
        match self {
            Self::C => 60,
            Self::D => 80,
        }
    }
}

/// What SP3 cannot hold.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum Sp3Error {
    /// More satellites than a file holds, or none.
    #[error("SP3-{version} holds 1 to {most} satellites, not {found}", most = version.most_satellites())]
    Satellites {
        /// Their number.
        found: usize,
        /// The version.
        version: Sp3Version,
    },
    /// More epochs than seven digits tell.
    #[error("SP3 holds at most 9999999 epochs, not {0}")]
    Epochs(usize),
    /// An instant outside the weeks that a file can count.
    #[error("SP3 covers 9999 weeks from 1980-01-06; {0} in GPS time is outside them")]
    Instant(NaiveDateTime),
    /// An invalid letter.
    #[error("'{0}' is not a capital letter, as SP3 identifiers need")]
    Letter(char),
    /// A coordinate or a velocity that is too large.
    #[error("{letter}{number:02}: {value} km or dm/s exceeds the 14 columns of an SP3 number")]
    Columns {
        /// Letter of the satellite.
        letter: char,
        /// Its number.
        number: usize,
        /// The value.
        value: f64,
    },
    /// The letter of an exported GNSS, chosen for the satellites of the design.
    #[error("'{letter}' is the SP3 letter of {preset}; choose another for the design")]
    LetterOfGnss {
        /// The letter.
        letter: char,
        /// The system that has it.
        preset: Preset,
    },
}

/// The letter of a system's ids (SP3-d, "satellite id").
#[must_use]
pub fn letter_of(preset: Preset) -> char {
    match preset {
        Preset::Beidou3 => 'C',
        Preset::Gps => 'G',
        Preset::Galileo => 'E',
        Preset::Glonass => 'R',
        Preset::Qzss => 'J',
        Preset::Navic => 'I',
    }
}

/// The accuracy code of an unknown accuracy.
const UNKNOWN_ACCURACY: &str = "  0";

/// A clock value that is not known, microseconds.
const NO_CLOCK: &str = " 999999.999999";

/// Ids on one line of the header.
const IDS: usize = 17;

/// Fewest lines of ids in the header of either version.
const ID_LINES: usize = 5;

/// Writes one file of satellites that propagate on one grid, epoch by epoch.
///
/// `satellites` are named `letter` 01, 02 … in their order.
///
/// # Errors
/// If a file cannot hold them, a satellite has no state, or writing fails.
pub fn write(
    out: &mut impl Write,
    version: Sp3Version,
    letter: char,
    metadata: &Metadata,
    sampled: &Sampled<'_, EarthFixed>,
    satellites: &[(&EphemerisSatellite, &Object)],
) -> Result<(), WriteError> {
    let grid = sampled.grid();
    if satellites.is_empty() || satellites.len() > version.most_satellites() {
        let found = satellites.len();
        return Err(Sp3Error::Satellites { found, version }.into());
    }
    if grid.len() > 9_999_999 {
        return Err(Sp3Error::Epochs(grid.len()).into());
    }
    if !letter.is_ascii_uppercase() {
        return Err(Sp3Error::Letter(letter).into());
    }
    let ids: Vec<String> = (1..=satellites.len())
        .map(|number| format!("{letter}{number:02}"))
        .collect();
    let start = TimeSystem::Gps.stamp(grid.epoch());
    let last = TimeSystem::Gps.stamp(grid.epoch().plus_seconds(grid.elapsed_s(grid.len() - 1)));
    if let Some(outside) = [start, last].into_iter().find(|at| !has_a_week(*at)) {
        return Err(Sp3Error::Instant(outside).into());
    }
    write_first_lines(out, version, start, grid.len(), grid.step_s())?;
    write_ids(out, version, &ids)?;
    write_fixed_lines(out, letter)?;
    write_comments(out, version, metadata, &ids, satellites)?;
    for k in 0..grid.len() {
        let elapsed_s = grid.elapsed_s(k);
        let at = grid.epoch().plus_seconds(elapsed_s);
        writeln!(out, "*  {}", epoch_fields(TimeSystem::Gps.stamp(at)))?;
        for (number, (satellite, _)) in (1..).zip(satellites) {
            write_state(out, letter, number, &sampled.state_at(satellite, k)?)?;
        }
    }
    writeln!(out, "EOF")?;
    Ok(())
}

/// Lines 1 and 2: epoch, number and spacing of the samples, GPS week, modified Julian day.
fn write_first_lines(
    out: &mut impl Write,
    version: Sp3Version,
    start: NaiveDateTime,
    epochs: usize,
    step_s: f64,
) -> io::Result<()> {
    writeln!(
        out,
        "#{version}V{} {epochs:>7} ORBIT ITRF  EXT  NWK",
        epoch_fields(start)
    )?;
    let since_gps = start - gps_zero();
    let week = since_gps.num_days().div_euclid(7);
    let of_week = since_gps - TimeDelta::days(7 * week);
    let seconds = of_week.num_seconds() as f64 + f64::from(of_week.subsec_nanos()) * 1e-9;
    let of_day =
        f64::from(start.num_seconds_from_midnight()) + f64::from(start.nanosecond()) * 1e-9;
    // 44244 is the modified Julian day of 6 January 1980.
    let day = since_gps.num_seconds().div_euclid(86_400) + 44_244;
    writeln!(
        out,
        "## {week:>4} {seconds:15.8} {step_s:14.8} {day:>5} {:15.13}",
        of_day / 86_400.0
    )
}

/// Whether four digits are enough for the week of an instant.
fn has_a_week(at: NaiveDateTime) -> bool {
    (0..=9999).contains(&(at - gps_zero()).num_days().div_euclid(7))
}

/// Beginning of GPS time, 6 January 1980.
fn gps_zero() -> NaiveDateTime {
    NaiveDate::from_ymd_opt(1980, 1, 6)
        .unwrap_or_default()
        .into()
}

/// `2025  1  1  0  0  0.00000000`.
fn epoch_fields(stamp: NaiveDateTime) -> String {
    let seconds = f64::from(stamp.second()) + f64::from(stamp.nanosecond()) * 1e-9;
    format!(
        "{:4} {:>2} {:>2} {:>2} {:>2} {seconds:11.8}",
        stamp.year(),
        stamp.month(),
        stamp.day(),
        stamp.hour(),
        stamp.minute()
    )
}

/// The lines of ids and those of accuracies, at least five each.
fn write_ids(out: &mut impl Write, version: Sp3Version, ids: &[String]) -> io::Result<()> {
    let lines = ids.len().div_ceil(IDS).max(ID_LINES);
    for line in 0..lines {
        let count = match (line, version) {
            (0, _) => format!("{:>3}", ids.len()),
            _ => "   ".to_owned(),
        };
        let fields: String = (0..IDS)
            .map(|column| ids.get(line * IDS + column).map_or("  0", String::as_str))
            .collect();
        writeln!(out, "+  {count}   {fields}")?;
    }
    for _ in 0..lines {
        writeln!(out, "++       {}", UNKNOWN_ACCURACY.repeat(IDS))?;
    }
    Ok(())
}

/// File type, time system, and what the format keeps for later.
fn write_fixed_lines(out: &mut impl Write, letter: char) -> io::Result<()> {
    let rest = "ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc";
    writeln!(out, "%c {letter}  cc GPS {rest}")?;
    writeln!(out, "%c cc cc ccc {rest}")?;
    writeln!(
        out,
        "%f  1.2500000  1.025000000  0.00000000000  0.000000000000000"
    )?;
    writeln!(
        out,
        "%f  0.0000000  0.000000000  0.00000000000  0.000000000000000"
    )?;
    for _ in 0..2 {
        writeln!(
            out,
            "%i    0    0    0    0      0      0      0      0         0"
        )?;
    }
    Ok(())
}

/// The comments: SP3-d names every satellite, SP3-c has room for the first and the last.
fn write_comments(
    out: &mut impl Write,
    version: Sp3Version,
    metadata: &Metadata,
    ids: &[String],
    satellites: &[(&EphemerisSatellite, &Object)],
) -> io::Result<()> {
    let width = version.columns() - 3;
    let name = |(id, (_, object)): (&String, &(&EphemerisSatellite, &Object))| {
        format!("{id} = {}", object.name)
    };
    let names: Vec<String> = ids.iter().zip(satellites).map(name).collect();
    let lines = match version {
        Sp3Version::D => metadata.comments().into_iter().chain(names).collect(),
        Sp3Version::C => vec![
            metadata.subject.first().cloned().unwrap_or_default(),
            format!("Theory: {}; pseudo-Earth-fixed, UT1 = UTC", metadata.theory),
            names.first().cloned().unwrap_or_default(),
            names.last().cloned().unwrap_or_default(),
        ],
    };
    for line in lines {
        for part in wrapped(&line, width) {
            writeln!(out, "/* {part}")?;
            if version == Sp3Version::C {
                break;
            }
        }
    }
    Ok(())
}

/// Words of a text in lines of at most `width` characters.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let line = lines
            .last_mut()
            .filter(|line| line.len() + word.len() < width);
        match line {
            Some(line) if line.is_empty() => line.push_str(word),
            Some(line) => *line += &format!(" {word}"),
            None => lines.push(word.chars().take(width).collect()),
        }
    }
    lines
}

/// A position in km and a velocity in dm/s, to a millimetre and 1e-7 m/s.
fn write_state(
    out: &mut impl Write,
    letter: char,
    number: usize,
    state: &State<EarthFixed>,
) -> Result<(), WriteError> {
    let velocity_dm_s = state.velocity_km_s * DM_IN_KM;
    for (kind, vector) in [('P', state.position_km.km()), ('V', velocity_dm_s)] {
        write!(out, "{kind}{letter}{number:02}")?;
        for value in &vector {
            let field = format!("{value:14.6}");
            if field.len() > 14 {
                let value = *value;
                return Err(Sp3Error::Columns {
                    letter,
                    number,
                    value,
                }
                .into());
            }
            write!(out, "{field}")?;
        }
        writeln!(out, "{NO_CLOCK}")?;
    }
    Ok(())
}

/// Decimetres in a kilometre.
const DM_IN_KM: f64 = 1e4;

/// What a file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Sp3 {
    /// Version letter.
    pub version: char,
    /// Time system of the epochs.
    pub time_system: TimeSystem,
    /// Name of the frame.
    pub frame: String,
    /// Ids of the satellites, in the order of the header.
    pub ids: Vec<String>,
    /// Comments.
    pub comments: Vec<String>,
    /// The first and the last instant at which each satellite has a position.
    pub spans: Vec<Option<(Epoch, Epoch)>>,
    /// The states of each satellite in order of time, or those of them that are kept; a missing velocity is `None`.
    pub states: Vec<Vec<Sp3Sample>>,
    /// Smallest spacing of the epochs, s.
    pub step_s: Option<f64>,
}

impl Sp3 {
    /// The samples of a satellite between gaps: at the spacing of the epochs, which is the nominal step.
    pub(crate) fn runs<'a>(
        &self,
        samples: &'a [Sp3Sample],
    ) -> impl Iterator<Item = &'a [Sp3Sample]> + use<'a> {
        let most_s = self.most_between_s();
        samples.chunk_by(move |one, other| other.at.seconds_since(one.at) <= most_s)
    }

    /// The longest time between samples without a gap, s.
    fn most_between_s(&self) -> f64 {
        self.step_s.map_or(f64::INFINITY, |step_s| GAP * step_s)
    }

    /// Drops positions between gaps that have no velocity.
    fn drop_lone_positions(&mut self) {
        let is_lone = |run: &[Sp3Sample]| matches!(run, [lone] if lone.velocity_km_s.is_none());
        for place in 0..self.states.len() {
            let states = &self.states[place];
            if self.runs(states).any(is_lone) {
                let kept = self.runs(states).filter(|run| !is_lone(run));
                self.states[place] = kept.flatten().copied().collect();
            }
        }
    }

    /// The same of samples that are not needed otherwise: those without a gap stay where they are in memory.
    pub(crate) fn split_at_gaps(&self, samples: Vec<Sp3Sample>) -> Vec<Vec<Sp3Sample>> {
        let runs: Vec<usize> = self.runs(&samples).map(<[Sp3Sample]>::len).collect();
        if runs.len() == 1 {
            return vec![samples];
        }
        let mut samples = samples.into_iter();
        let run = |length: usize| samples.by_ref().take(length).collect();
        runs.into_iter().map(run).collect()
    }

    /// The name that a comment `L01 = NAME` gives to an id, as SP3-d files of this program have it for
    /// every satellite.
    #[must_use]
    pub fn name_of(&self, id: &str) -> Option<&str> {
        self.comments
            .iter()
            .find_map(|comment| comment.strip_prefix(id)?.strip_prefix(" = "))
            .filter(|name| !name.is_empty())
    }
}

/// A state of a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sp3Sample {
    /// Instant.
    pub at: Epoch,
    /// Position in the frame of the file.
    pub position_km: Position<Frame>,
    /// Velocity in the frame of the file, km/s.
    pub velocity_km_s: Option<nalgebra::Vector3<f64>>,
}

#[cfg(test)]
mod tests;
