//! Reads `.e` files: keywords in any order and case, then one table.
//!
//! Accelerations and covariances are skipped. Segment boundaries are kept, since nothing may be
//! interpolated across them, and each may have two rows with the same time.

use super::rows::{StkRows, StkSegment};
use super::{MONTHS, StkEphemeris, StkInterpolation, segments};
use crate::ephemeris::derivative::velocities;
use crate::formats::ReadError;
use crate::formats::ccsds::kvn::words;
use crate::formats::kept_states::KeptStates;
use crate::formats::text::finding::FindingList;
use crate::formats::text::lines::{Line, Lines, keep_comment};
use crate::formats::text::number;
use crate::frames::{Frame, State};
use crate::orbit::earth_orbit::{ImplausibleState, check_position, check_state};
use crate::time::Epoch;
use chrono::{NaiveDate, NaiveDateTime};
use nalgebra::Vector3;
use std::io::{self, BufRead};

/// Keywords that do not change what the states mean here.
const PASSED_OVER: [&str; 9] = [
    "CovarianceFormat",
    "CovarianceInterpolationMethod",
    "CovInterpolationMethod",
    "CovInterpolationSamplesM1",
    "MessageLevel",
    "ScenarioName",
    "BlockingFactor",
    "AllowSuperSampling",
    "AllowEphemerisExtrapolation",
];

/// Reads a file; the first broken rule ends it.
///
/// # Errors
/// The first finding, or a failure of the input.
pub fn read(input: impl BufRead) -> Result<StkEphemeris, ReadError> {
    let mut findings = FindingList::of_reader();
    let file = parse(input, &mut findings)?;
    let read = findings.unless_error(file)?;
    read.ok_or_else(|| io::Error::from(io::ErrorKind::UnexpectedEof).into())
}

/// Reads a file; violations go to the list of findings.
///
/// # Errors
/// A failure of the input.
pub fn parse(input: impl BufRead, findings: &mut FindingList) -> io::Result<Option<StkEphemeris>> {
    parse_kept(input, findings, KeptStates::All)
}

/// The same, with the states that are to be kept.
///
/// # Errors
/// A failure of the input.
pub fn parse_kept(
    input: impl BufRead,
    findings: &mut FindingList,
    kept: KeptStates<Epoch>,
) -> io::Result<Option<StkEphemeris>> {
    let is_comment = |line: &[u8]| line.trim_ascii_start().starts_with(b"#");
    let mut lines = Lines::with_tabs(input).with_comments(is_comment);
    let mut parser = StkParser {
        kept,
        ..StkParser::default()
    };
    while let Some(line) = lines.next(findings)? {
        parser.line(&line, findings);
    }
    Ok(parser.end(lines.number().max(1), findings))
}

/// What the next line belongs to.
#[derive(Clone, Copy, PartialEq, Default)]
enum StkSection {
    #[default]
    Version,
    Before,
    Keywords,
    Boundaries,
    Table,
    Covariances,
    After,
}

/// The fields of a row after the time.
#[derive(Clone, Copy, PartialEq, Default)]
enum StkColumns {
    #[default]
    PosVel,
    Pos,
    PosVelAcc,
}

impl StkColumns {
    fn of_keyword(key: &str) -> Option<Self> {
        match key.to_ascii_lowercase().as_str() {
            "ephemeristimepos" => Some(Self::Pos),
            "ephemeristimeposvel" => Some(Self::PosVel),
            "ephemeristimeposvelacc" => Some(Self::PosVelAcc),
            _ => None,
        }
    }

    /// Numbers of a row, the time among them.
    fn count(self) -> usize {
        match self {
            Self::Pos => 4,
            Self::PosVel => 7,
            Self::PosVelAcc => 10,
        }
    }
}

#[derive(Default)]
struct StkParser {
    part: StkSection,
    comments: Vec<String>,
    points: Option<(usize, (usize, usize))>,
    epoch: Option<NaiveDateTime>,
    method: Option<StkInterpolation>,
    samples_m1: Option<usize>,
    /// The name that `InterpolationSamplesM1` had before.
    order: Option<usize>,
    frame: Option<Frame>,
    /// Kilometres in the unit of length; metres if none is named.
    unit_km: Option<f64>,
    columns: StkColumns,
    boundaries_s: Vec<f64>,
    kept: KeptStates<Epoch>,
    /// The rows of the table, once it has begun.
    rows: Option<StkRows>,
}

impl StkParser {
    fn line(&mut self, line: &Line, findings: &mut FindingList) {
        let text = line.text.trim();
        let place = (line.number, 1);
        if text.is_empty() {
            return;
        }
        if let Some(comment) = text.strip_prefix('#') {
            keep_comment(&mut self.comments, comment.trim_start());
            return;
        }
        let (key, value) = text.split_once(' ').unwrap_or((text, ""));
        let value = value.trim().trim_matches('"');
        match self.part {
            StkSection::Version => {
                if !text.to_ascii_lowercase().starts_with("stk.v.") {
                    let message = "the first line must be stk.v. and a version";
                    findings.error(place, "stk-version", message);
                }
                self.part = StkSection::Before;
            }
            StkSection::Before if is(key, "BEGIN") && is(value, "Ephemeris") => {
                self.part = StkSection::Keywords
            }
            StkSection::Before => findings.error(place, "stk-begin", "expected BEGIN Ephemeris"),
            StkSection::Keywords if is(key, "BEGIN") && is(value, "SegmentBoundaryTimes") => {
                self.part = StkSection::Boundaries
            }
            StkSection::Keywords => self.keyword(place, (key, value), line, findings),
            StkSection::Boundaries if is(key, "END") => {
                self.boundaries_s.sort_by(f64::total_cmp);
                self.part = StkSection::Keywords;
            }
            StkSection::Boundaries => self.boundaries(line, findings),
            StkSection::Table | StkSection::Covariances
                if is(key, "END") && is(value, "Ephemeris") =>
            {
                self.part = StkSection::After
            }
            StkSection::Table if is_covariance(key) => self.part = StkSection::Covariances,
            StkSection::Table => self.row(line, findings),
            StkSection::Covariances => {}
            StkSection::After => {
                findings.error(place, "stk-line", "nothing may follow END Ephemeris")
            }
        }
    }

    fn keyword(
        &mut self,
        place: (usize, usize),
        (key, value): (&str, &str),
        line: &Line,
        findings: &mut FindingList,
    ) {
        let value_place = (line.number, line.text.find(value).unwrap_or(0) + 1);
        let known = |known: bool, findings: &mut FindingList| {
            if !known {
                let message = format!("{key} '{value}' is not supported");
                findings.error(value_place, "stk-value", message);
            }
        };
        if let Some(columns) = StkColumns::of_keyword(key) {
            self.columns = columns;
            self.begin_table(place, findings);
            return;
        }
        match key.to_ascii_lowercase().as_str() {
            "numberofephemerispoints" => {
                let points = value.parse().ok();
                known(points.is_some(), findings);
                self.points = points.map(|points| (points, place));
            }
            "scenarioepoch" => {
                self.epoch = calendar_date(value);
                known(self.epoch.is_some(), findings);
            }
            "interpolationmethod" => {
                self.method = method(value);
                known(self.method.is_some(), findings);
            }
            "interpolationsamplesm1" => {
                self.samples_m1 = value.parse().ok();
                known(self.samples_m1.is_some(), findings);
            }
            "interpolationorder" => {
                self.order = value.parse().ok();
                known(self.order.is_some(), findings);
            }
            "timeformat" if !is(value, "EpSec") => {
                let message = format!(
                    "TimeFormat {value} is not read, only EpSec, seconds from ScenarioEpoch"
                );
                findings.error(value_place, "stk-time-format", message);
            }
            "timeformat" => {}
            "centralbody" => known(is(value, "Earth"), findings),
            "coordinatesystem" => {
                self.frame = frame(value);
                known(self.frame.is_some(), findings);
            }
            "distanceunit" => {
                self.unit_km = match value.to_ascii_lowercase().as_str() {
                    "kilometers" | "kilometer" | "km" => Some(1.0),
                    "meters" | "meter" | "m" => Some(1e-3),
                    _ => None,
                };
                known(self.unit_km.is_some(), findings);
            }
            _ if PASSED_OVER.iter().any(|passed| is(key, passed)) => {}
            _ => {
                let message = format!("keyword {key} is not supported");
                findings.error(place, "stk-keyword", message);
            }
        }
    }

    fn begin_table(&mut self, place: (usize, usize), findings: &mut FindingList) {
        for (missing, name) in [
            (self.epoch.is_none(), "ScenarioEpoch"),
            (self.frame.is_none(), "CoordinateSystem"),
        ] {
            if missing {
                let message = format!("{name} is missing before the table");
                findings.error(place, "stk-missing", message);
            }
        }
        let kept = match self.origin() {
            Some(origin) => self.kept.map(|at| at.seconds_since(origin)),
            // The file is refused.
            None => KeptStates::None,
        };
        self.rows = Some(StkRows::new(kept));
        self.part = StkSection::Table;
    }

    /// The instant from which the times count.
    fn origin(&self) -> Option<Epoch> {
        Some(Epoch::from_utc(self.epoch?.and_utc()))
    }

    fn row(&mut self, line: &Line, findings: &mut FindingList) {
        let needed = self.columns.count();
        let fields: Vec<_> = words(&line.text).take(needed + 1).collect();
        if fields.len() != needed {
            let message = format!("the row has {} fields; it needs {needed}", fields.len());
            findings.error((line.number, 1), "stk-fields", message);
            return;
        }
        let mut values = [0.0; 10];
        for (value, (column, text)) in values.iter_mut().zip(fields) {
            match number::read(text, (line.number, column), "stk-number", findings) {
                Some(number) => *value = number,
                None => return,
            }
        }
        let [elapsed_s, x, y, z, vx, vy, vz, ..] = values;
        let (origin, boundaries_s) = (self.origin(), self.boundaries_s.as_slice());
        let may_follow = |rows: &StkRows| rows.may_be_at(elapsed_s, origin, boundaries_s);
        if !self.rows.as_ref().is_some_and(may_follow) {
            let message = "the time is not after that of the row before";
            findings.error((line.number, 1), "stk-time-order", message);
            return;
        }
        let unit_km = self.unit_km.unwrap_or(1e-3);
        let [x, y, z, vx, vy, vz] = [x, y, z, vx, vy, vz].map(|number| number * unit_km);
        let state = State::new(Vector3::new(x, y, z), Vector3::new(vx, vy, vz));
        if let Some(fault) = self.implausible(&state) {
            let unit = match self.unit_km {
                None => "; lengths are metres unless DistanceUnit names another unit",
                Some(_) => "",
            };
            let message = format!("{fault}{unit}");
            findings.error((line.number, 1), "implausible-state", message);
            return;
        }
        if let Some(rows) = &mut self.rows {
            rows.push((elapsed_s, state), &self.boundaries_s);
        }
    }

    fn implausible(&self, state: &State<Frame>) -> Option<ImplausibleState> {
        match (self.columns, self.frame) {
            (StkColumns::Pos, _) | (_, None) => check_position(&state.position_km.km()).err(),
            (_, Some(frame)) => check_state(frame, state).err(),
        }
    }

    fn boundaries(&mut self, line: &Line, findings: &mut FindingList) {
        for (column, text) in words(&line.text) {
            self.boundaries_s.extend(number::read(
                text,
                (line.number, column),
                "stk-number",
                findings,
            ));
        }
    }

    fn end(mut self, number: usize, findings: &mut FindingList) -> Option<StkEphemeris> {
        if self.part != StkSection::After {
            findings.error((number, 1), "stk-truncated", "END Ephemeris is missing");
        }
        let count = self.rows.as_ref().map_or(0, StkRows::count);
        if let Some((points, place)) = self.points.filter(|(points, _)| *points != count) {
            let message = format!("NumberOfEphemerisPoints is {points}, but there are {count}");
            findings.error(place, "stk-count", message);
        } else if count == 0 {
            findings.error((number, 1), "stk-empty", "the table has no points");
        }
        let (epoch, rows) = (self.epoch?, self.rows.take()?);
        let origin = Epoch::from_utc(epoch.and_utc());
        let has_velocities = self.columns != StkColumns::Pos;
        // Velocities that are not the derivative of the positions: another unit, or other axes.
        if let Some(message) = rows.velocity_fault(origin).filter(|_| has_velocities) {
            findings.warning((number, 1), "stk-velocity-unit", message);
        }
        let (segments, mut states) = rows.finish();
        if !has_velocities {
            check_rows(&segments, number, findings);
            derive_velocities(origin, &mut states, &self.boundaries_s);
        }
        Some(StkEphemeris {
            comments: self.comments,
            scenario_epoch: epoch,
            interpolation: self.method,
            interpolation_samples_m1: self.samples_m1.or(self.order),
            boundaries_s: self.boundaries_s,
            frame: self.frame?,
            states,
            spans_s: segments.iter().map(|segment| segment.span_s).collect(),
        })
    }
}

/// Velocities follow from two positions at least.
fn check_rows(segments: &[StkSegment], number: usize, findings: &mut FindingList) {
    if segments.iter().any(|segment| segment.rows < 2) {
        let message = "the positions have no velocities and are too few to derive them";
        findings.error((number, 1), "stk-velocity", message);
    }
}

/// Each segment has its own velocities; the row that two share has those of the earlier one.
fn derive_velocities(origin: Epoch, states: &mut [(f64, State<Frame>)], boundaries_s: &[f64]) {
    let mut done = 0;
    for rows in segments(states, boundaries_s) {
        let of_segment = &states[rows.clone()];
        let position = |place: usize| {
            let (elapsed_s, state) = of_segment[place];
            (origin.plus_seconds(elapsed_s), state.position_km)
        };
        // A single row that is kept of a segment is far from the interval.
        let velocities = velocities(of_segment.len(), position).unwrap_or_default();
        let skipped = done - rows.start;
        let derived = states[rows.clone()].iter_mut().zip(velocities);
        for ((_, state), velocity_km_s) in derived.skip(skipped) {
            state.velocity_km_s = velocity_km_s;
        }
        done = rows.end;
    }
}

fn is(word: &str, name: &str) -> bool {
    word.eq_ignore_ascii_case(name)
}

/// `LagrangeVOP` takes the same samples, as variations of a two-body orbit.
fn method(name: &str) -> Option<StkInterpolation> {
    match name.to_ascii_lowercase().as_str() {
        "lagrange" | "lagrangevop" => Some(StkInterpolation::Lagrange),
        "hermite" => Some(StkInterpolation::Hermite),
        _ => None,
    }
}

fn is_covariance(key: &str) -> bool {
    key.to_ascii_lowercase().starts_with("covariancetime")
}

fn frame(name: &str) -> Option<Frame> {
    match name.to_ascii_lowercase().as_str() {
        "j2000" => Some(Frame::Eme2000),
        // The inertial axes of STK's Earth are those of the ICRF.
        "icrf" | "inertial" => Some(Frame::Gcrf),
        "fixed" => Some(Frame::EarthFixed),
        name if name.starts_with("itrf") => Some(Frame::EarthFixed),
        "temeofdate" => Some(Frame::Teme),
        _ => None,
    }
}

/// Reads `1 Jan 2025 00:00:00.000`.
pub(in crate::formats) fn calendar_date(text: &str) -> Option<NaiveDateTime> {
    let [day, month, year, time] = text.split_whitespace().collect::<Vec<_>>()[..] else {
        return None;
    };
    let month = MONTHS.iter().position(|name| is(name, month))? as u32 + 1;
    let date = NaiveDate::from_ymd_opt(year.parse().ok()?, month, day.parse().ok()?)?;
    // The time of day is that of CCSDS.
    crate::formats::text::timestamp::parse(&format!("{}T{time}", date.format("%Y-%m-%d")))
}
