//! STK ephemeris files (`.e`), written and read.
//!
//! Source: AGI/Ansys, *STK Help*, "Ephemeris File Format (*.e)" and "Ephemeris Formats":
//! `EphemerisTimePosVel`, seconds from the scenario epoch, UTC. `InterpolationSamplesM1` is one
//! less than the number of samples that an interpolation takes; the file never names
//! `InterpolationOrder`, which other readers refuse.

pub mod connect;
mod read;
mod rows;

pub(in crate::formats) use read::calendar_date as parse_calendar_date;
pub use read::{parse, parse_kept, read};

use crate::ephemeris::EphemerisSatellite;
use crate::ephemeris::arc::{Arc, Interpolation, SAME_INSTANT_S};
use crate::ephemeris::hermite::Hermite;
use crate::ephemeris::sampled::Sampled;
use crate::formats::WriteError;
use crate::formats::metadata::Metadata;
use crate::formats::text::fixed::FixedDecimals;
use crate::frames::{Frame, State};
use crate::time::Epoch;
use chrono::{Datelike, NaiveDateTime, Timelike};
use std::io::{self, Write};
use std::ops::Range;

/// Version of the format that is written.
pub const FORMAT_VERSION: &str = "12.0";

/// Names of months in STK's calendar dates.
pub(super) const MONTHS: [&str; 12] = [
    "Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec",
];

/// The interpolations that a file names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StkInterpolation {
    /// Through positions.
    Lagrange,
    /// Through positions and velocities.
    Hermite,
}

/// Samples of an interpolation minus one where the file names none (STK Help, keyword
/// `InterpolationSamplesM1`).
const SAMPLES_M1: usize = 5;

/// A whole file.
#[derive(Debug, Clone, PartialEq)]
pub struct StkEphemeris {
    /// Comment lines, without the hash sign.
    pub comments: Vec<String>,
    /// Origin of the times, UTC.
    pub scenario_epoch: NaiveDateTime,
    /// How states follow between the samples.
    pub interpolation: Option<StkInterpolation>,
    /// Number of samples of the interpolation minus one.
    pub interpolation_samples_m1: Option<usize>,
    /// Seconds since the scenario epoch at which segments meet, in order: nothing is interpolated across them.
    pub boundaries_s: Vec<f64>,
    /// Frame of the states.
    pub frame: Frame,
    /// Seconds since the scenario epoch, and the states; those that are kept of a file that is read.
    pub states: Vec<(f64, State<Frame>)>,
    /// Seconds since the scenario epoch of the first and the last row of each segment, whether kept or not.
    pub spans_s: Vec<(f64, f64)>,
}

impl StkEphemeris {
    /// Writes the file.
    ///
    /// # Errors
    /// If writing fails.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let samples_m1 = self.interpolation_samples_m1;
        let interpolation = self.interpolation.zip(samples_m1);
        let lengths = (self.states.len(), self.boundaries_s.as_slice());
        write_head(
            out,
            &self.comments,
            self.scenario_epoch,
            lengths,
            interpolation,
            self.frame,
        )?;
        for (elapsed_s, state) in &self.states {
            write_state(out, *elapsed_s, state)?;
        }
        write_tail(out)
    }

    /// The states, one arc for each segment; if none are kept, arcs without states.
    #[must_use]
    pub fn into_arcs(mut self) -> Vec<Arc> {
        let samples_m1 = self.interpolation_samples_m1.unwrap_or(SAMPLES_M1);
        let interpolation = match self.interpolation {
            Some(StkInterpolation::Hermite) => Interpolation::Hermite(2 * samples_m1 + 1),
            _ => Interpolation::Lagrange(samples_m1),
        };
        if self.states.is_empty() {
            let at =
                |elapsed_s| Epoch::from_utc(self.scenario_epoch.and_utc()).plus_seconds(elapsed_s);
            let spans = self
                .spans_s
                .iter()
                .map(|(first_s, last_s)| (at(*first_s), at(*last_s)));
            let arc = |span| Arc::without_states(self.frame, interpolation, span);
            return spans.map(arc).collect();
        }
        let mut arcs = Vec::new();
        for rows in segments(&self.states, &self.boundaries_s).into_iter().rev() {
            let nodes = self.take_nodes(rows);
            arcs.extend(Arc::new(self.frame, interpolation, nodes));
        }
        arcs.reverse();
        arcs
    }

    /// The nodes of the last rows, from the end on: the memory of rows is given back while nodes fill theirs.
    fn take_nodes(&mut self, rows: Range<usize>) -> Vec<(Epoch, State<Frame>)> {
        let epoch = Epoch::from_utc(self.scenario_epoch.and_utc());
        let node =
            |(elapsed_s, state): &(f64, State<Frame>)| (epoch.plus_seconds(*elapsed_s), *state);
        let mut nodes = Vec::with_capacity(rows.len());
        let mut end = rows.end;
        while end > rows.start {
            let from = end.saturating_sub(ROWS_AT_ONCE).max(rows.start);
            nodes.extend(self.states[from..end].iter().rev().map(node));
            // The first row may be the last one of the segment before.
            self.states.truncate(from + 1);
            self.states.shrink_to_fit();
            end = from;
        }
        nodes.reverse();
        nodes
    }
}

/// Rows whose memory is given back at once.
const ROWS_AT_ONCE: usize = 1 << 16;

/// The rows of each segment.
fn segments(states: &[(f64, State<Frame>)], boundaries_s: &[f64]) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut from = 0;
    for (k, pair) in states.windows(2).enumerate() {
        let [(elapsed_s, _), (next_s, _)] = pair else {
            continue;
        };
        if let Some(is_shared) = segment_end(boundaries_s, *elapsed_s, *next_s, k == from) {
            found.push(from..k + 1);
            from = if is_shared { k } else { k + 1 };
        }
    }
    if from < states.len() {
        found.push(from..states.len());
    }
    found
}

/// Whether a segment ends at a row that another one follows, and whether the next segment begins with the same row. A
/// boundary of one row belongs to both sides; of two, each side has its own.
fn segment_end(boundaries_s: &[f64], elapsed_s: f64, next_s: f64, is_first: bool) -> Option<bool> {
    let is_repeated = next_s == elapsed_s;
    if is_boundary(boundaries_s, elapsed_s) && (!is_first || is_repeated) {
        return Some(!is_repeated);
    }
    let after = boundaries_s.partition_point(|at| *at <= elapsed_s + SAME_INSTANT_S);
    let is_between = |at: &f64| *at < next_s - SAME_INSTANT_S;
    boundaries_s
        .get(after)
        .is_some_and(is_between)
        .then_some(false)
}

/// Writes the states of one satellite on the grid of its ephemeris, line by line.
///
/// # Errors
/// If the satellite has no state, or the output fails.
pub fn write(
    out: &mut impl Write,
    name: &str,
    metadata: &Metadata,
    sampled: &Sampled<'_, Frame>,
    satellite: &EphemerisSatellite,
    hermite: Option<Hermite>,
) -> Result<(), WriteError> {
    let grid = sampled.grid();
    let mut comments = vec![format!("Satellite: {name}")];
    comments.extend(metadata.comments());
    write_head(
        out,
        &comments,
        grid.epoch().utc().naive_utc(),
        (grid.len(), &[]),
        hermite.map(|hermite| (StkInterpolation::Hermite, hermite.degree / 2)),
        sampled.frame(),
    )?;
    for (k, sample) in sampled.states(satellite).enumerate() {
        let (_, state) = sample?;
        write_state(out, grid.elapsed_s(k), &state)?;
    }
    write_tail(out)?;
    Ok(())
}

/// What STK calls a frame.
#[must_use]
pub fn coordinate_system(frame: Frame) -> &'static str {
    match frame {
        Frame::Eme2000 => "J2000",
        Frame::Gcrf => "ICRF",
        Frame::EarthFixed => "Fixed",
        Frame::Teme => "TEMEOfDate",
    }
}

/// Whether a time is one of the boundaries.
fn is_boundary(boundaries_s: &[f64], elapsed_s: f64) -> bool {
    let nearest = boundaries_s.partition_point(|at| elapsed_s - at > SAME_INSTANT_S);
    boundaries_s
        .get(nearest)
        .is_some_and(|at| at - elapsed_s <= SAME_INSTANT_S)
}

fn write_head(
    out: &mut impl Write,
    comments: &[String],
    epoch: NaiveDateTime,
    (points, boundaries_s): (usize, &[f64]),
    interpolation: Option<(StkInterpolation, usize)>,
    frame: Frame,
) -> io::Result<()> {
    writeln!(out, "stk.v.{FORMAT_VERSION}")?;
    for comment in comments {
        writeln!(out, "# {comment}")?;
    }
    writeln!(out, "BEGIN Ephemeris")?;
    writeln!(out, "NumberOfEphemerisPoints {points}")?;
    writeln!(out, "ScenarioEpoch {}", calendar_date(epoch))?;
    if let Some((method, samples_m1)) = interpolation {
        writeln!(out, "InterpolationMethod {method:?}")?;
        writeln!(out, "InterpolationSamplesM1 {samples_m1}")?;
    }
    writeln!(out, "CentralBody Earth")?;
    writeln!(out, "CoordinateSystem {}", coordinate_system(frame))?;
    writeln!(out, "DistanceUnit Kilometers")?;
    if !boundaries_s.is_empty() {
        writeln!(out, "BEGIN SegmentBoundaryTimes")?;
        for boundary_s in boundaries_s {
            writeln!(out, "{boundary_s}")?;
        }
        writeln!(out, "END SegmentBoundaryTimes")?;
    }
    writeln!(out, "EphemerisTimePosVel\n")
}

fn write_tail(out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "\nEND Ephemeris")
}

/// `01 Jan 2025 00:00:00.000000000`: STK itself writes no zero in front, but takes it, and Orekit
/// refuses a day of one digit.
fn calendar_date(stamp: NaiveDateTime) -> String {
    format!(
        "{:02} {} {} {}.{:09}",
        stamp.day(),
        MONTHS[stamp.month0() as usize],
        stamp.year(),
        stamp.format("%H:%M:%S"),
        stamp.nanosecond() % 1_000_000_000
    )
}

/// Seconds in full digits; positions to 1e-9 km and velocities to 1e-12 km/s.
fn write_state(out: &mut impl Write, elapsed_s: f64, state: &State<Frame>) -> io::Result<()> {
    let (r, v) = (state.position_km.km(), state.velocity_km_s);
    // The nanosecond to which stamps are kept everywhere else.
    let seconds = (elapsed_s * 1e9).round() / 1e9;
    write!(out, "{seconds}")?;
    for x in [r.x, r.y, r.z] {
        write!(out, " {}", FixedDecimals::<9>(x))?;
    }
    for x in [v.x, v.y, v.z] {
        write!(out, " {}", FixedDecimals::<12>(x))?;
    }
    writeln!(out)
}

#[cfg(test)]
mod tests;
