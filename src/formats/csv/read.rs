//! Reads tables of elements and of states. Columns are found by their names, in any order; others
//! are ignored.

use super::CsvTable;
use crate::formats::ReadError;
use crate::formats::text::finding::FindingList;
use crate::formats::text::timestamp;
use crate::formats::trajectory::Trajectory;
use crate::frames::{Frame, State};
use crate::orbit::MeanElements;
use crate::orbit::earth_orbit::check_state;
use crate::time::Epoch;
use nalgebra::Vector3;
use std::collections::HashMap;
use std::io::{self, BufRead};

/// A state and its instant.
type TimedState = (Epoch, State<Frame>);

/// A row of a table of elements.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementsRow {
    /// Name of the satellite.
    pub name: String,
    /// Instant of the elements.
    pub epoch: Epoch,
    /// Mean elements, TEME.
    pub elements: MeanElements,
}

/// The columns of elements that are read.
const ELEMENTS: [&str; 8] = [
    "object",
    "epoch_utc",
    "semi_major_axis_km",
    "eccentricity",
    "inclination_deg",
    "raan_deg",
    "arg_perigee_deg",
    "mean_anomaly_deg",
];

/// The columns of states that are read: in TEME, or else Earth-fixed.
const STATES: [(Frame, [&str; 8]); 2] = [
    (
        Frame::Teme,
        [
            "object",
            "utc",
            "teme_x_km",
            "teme_y_km",
            "teme_z_km",
            "teme_vx_km_s",
            "teme_vy_km_s",
            "teme_vz_km_s",
        ],
    ),
    (
        Frame::EarthFixed,
        [
            "object",
            "utc",
            "itrf_x_km",
            "itrf_y_km",
            "itrf_z_km",
            "itrf_vx_km_s",
            "itrf_vy_km_s",
            "itrf_vz_km_s",
        ],
    ),
];

/// Reads mean elements; the first broken rule ends it.
///
/// # Errors
/// The first finding, or a failure of the input.
pub fn read_elements(input: impl BufRead) -> Result<Vec<ElementsRow>, ReadError> {
    let mut findings = FindingList::of_reader();
    let mut rows = Vec::new();
    parse_elements(input, &mut findings, |row| rows.push(row))?;
    findings.unless_error(rows)
}

/// Passes every valid row to `take`.
///
/// # Errors
/// A failure of the input.
pub fn parse_elements(
    input: impl BufRead,
    findings: &mut FindingList,
    mut take: impl FnMut(ElementsRow),
) -> io::Result<()> {
    let tables = [((), ELEMENTS)];
    rows(input, &tables, findings, |(), row, findings| {
        let epoch = row.stamp(1, findings);
        let [a, e, i, raan, perigee, anomaly] =
            std::array::from_fn(|at| row.number(2 + at, findings));
        let (Some(epoch), Some(a), Some(e), Some(i), Some(raan), Some(perigee), Some(anomaly)) =
            (epoch, a, e, i, raan, perigee, anomaly)
        else {
            return;
        };
        let elements = MeanElements {
            semi_major_axis_km: a,
            eccentricity: e,
            inclination_rad: i.to_radians(),
            raan_rad: raan.to_radians(),
            arg_perigee_rad: perigee.to_radians(),
            mean_anomaly_rad: anomaly.to_radians(),
        };
        match elements.checked() {
            Ok(elements) => take(ElementsRow {
                name: row.text(0).to_owned(),
                epoch,
                elements,
            }),
            Err(error) => findings.error(row.place(2), "csv-range", error.to_string()),
        }
    })
}

/// Reads states, satellite by satellite in the order of their first rows; the first broken rule
/// ends it.
///
/// # Errors
/// The first finding, or a failure of the input.
pub fn read_states(input: impl BufRead) -> Result<Vec<Trajectory>, ReadError> {
    let mut findings = FindingList::of_reader();
    let trajectories = parse_states(input, &mut findings)?;
    findings.unless_error(trajectories)
}

/// The states of a table; violations go to the list of findings.
///
/// # Errors
/// A failure of the input.
pub fn parse_states(
    input: impl BufRead,
    findings: &mut FindingList,
) -> io::Result<Vec<Trajectory>> {
    let mut satellites: Vec<(String, Frame, Vec<TimedState>)> = Vec::new();
    let mut places: HashMap<String, usize> = HashMap::new();
    rows(input, &STATES, findings, |frame, row, findings| {
        let at = row.stamp(1, findings);
        let values: [Option<f64>; 6] = std::array::from_fn(|at| row.number(2 + at, findings));
        let vector = |from: usize| {
            Some(Vector3::new(
                values[from]?,
                values[from + 1]?,
                values[from + 2]?,
            ))
        };
        let (Some(at), Some(position_km), Some(velocity_km_s)) = (at, vector(0), vector(3)) else {
            return;
        };
        let name = row.text(0);
        let index = places.get(name).copied().unwrap_or_else(|| {
            places.insert(name.to_owned(), satellites.len());
            satellites.push((name.to_owned(), frame, Vec::new()));
            satellites.len() - 1
        });
        let states = &mut satellites[index].2;
        if states.last().is_some_and(|(last, _)| *last >= at) {
            let message = format!("the time is not after that of the row of {name} before");
            findings.error(row.place(1), "csv-time-order", message);
            return;
        }
        let state = State::new(position_km, velocity_km_s);
        if let Err(fault) = check_state(frame, &state) {
            let message = format!("{name}: {fault}");
            findings.error(row.place(2), "implausible-state", message);
            return;
        }
        states.push((at, state));
    })?;
    let trajectory = |(name, frame, states): (String, Frame, Vec<_>)| {
        Trajectory::of_states(&name, &name, frame, states)
    };
    Ok(satellites.into_iter().map(trajectory).collect())
}

/// A row whose fields are numbered as the columns that are read.
struct CsvRow<'a> {
    line: usize,
    record: &'a ::csv::StringRecord,
    columns: &'a [usize],
}

impl CsvRow<'_> {
    fn text(&self, index: usize) -> &str {
        self.record.get(self.columns[index]).unwrap_or_default()
    }

    /// The line, and the number of the field.
    fn place(&self, index: usize) -> (usize, usize) {
        (self.line, self.columns[index] + 1)
    }

    fn number(&self, index: usize, findings: &mut FindingList) -> Option<f64> {
        let value = self.text(index).parse::<f64>().ok();
        let value = value.filter(|value| value.is_finite());
        if value.is_none() {
            let message = format!("'{}' is not a number", self.text(index));
            findings.error(self.place(index), "csv-number", message);
        }
        value
    }

    fn stamp(&self, index: usize, findings: &mut FindingList) -> Option<Epoch> {
        let stamp = timestamp::parse(self.text(index));
        if stamp.is_none() {
            let text = self.text(index);
            let message = format!("'{text}' is not a time such as 2025-01-01T00:00:00.000");
            findings.error(self.place(index), "csv-time", message);
        }
        stamp.map(|stamp| Epoch::from_utc(stamp.and_utc()))
    }
}

/// Passes every row of a table to `see`: that of the first of `tables` whose columns are all there.
fn rows<T: Copy, const N: usize>(
    input: impl BufRead,
    tables: &[(T, [&str; N])],
    findings: &mut FindingList,
    mut see: impl FnMut(T, &CsvRow<'_>, &mut FindingList),
) -> io::Result<()> {
    let mut table = CsvTable::new(input);
    let Some(header) = table.header(findings)? else {
        return Ok(());
    };
    let column = |name: &&str| {
        let mut cells = header.iter();
        cells.position(|cell| cell.eq_ignore_ascii_case(name))
    };
    let known = tables.iter().find_map(|(kind, names)| {
        let columns: Option<Vec<usize>> = names.iter().map(column).collect();
        Some((*kind, columns?))
    });
    let Some((kind, columns)) = known else {
        let missing = tables[0].1.iter().find(|name| column(name).is_none());
        let message = format!("column {} is missing", missing.unwrap_or(&""));
        findings.error((1, 1), "csv-header", message);
        return Ok(());
    };
    let mut any = false;
    let mut record = ::csv::StringRecord::new();
    while let Some(line) = table.next(&mut record, findings)? {
        any = true;
        let row = CsvRow {
            line,
            record: &record,
            columns: &columns,
        };
        see(kind, &row, findings);
        if findings.is_full() {
            return Ok(());
        }
    }
    if !any && !findings.has_errors() {
        findings.error((2, 1), "csv-empty", "the table has no rows");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constellation::Design;
    use crate::ephemeris::Ephemeris;
    use crate::formats::metadata::Object;
    use crate::orbit::Model;
    use crate::time::TimeGrid;

    fn ephemeris() -> (Design, Ephemeris) {
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let grid = TimeGrid::new(epoch, 600.0, 60.0).unwrap();
        let design: Design = "lattice:55:6/3/1@925,e=0.02,w=30".parse().unwrap();
        let ephemeris = Ephemeris::of_design(&design, Model::J2, grid).unwrap();
        (design, ephemeris)
    }

    fn tables() -> [String; 2] {
        let (design, ephemeris) = ephemeris();
        let epoch = ephemeris.grid().epoch();
        let objects = Object::all(ephemeris.satellites(), epoch).unwrap();
        let (mut elements, mut states) = (Vec::new(), Vec::new());
        let row = |(satellite, object)| {
            let satellite: crate::constellation::Satellite = satellite;
            super::super::ElementsOf {
                slot: Some(satellite.slot),
                elements: satellite.elements,
                object,
            }
        };
        let rows: Vec<_> = design
            .satellites()
            .into_iter()
            .zip(&objects)
            .map(row)
            .collect();
        super::super::write_elements(&mut elements, &rows, epoch).unwrap();
        super::super::write_states(&mut states, &ephemeris).unwrap();
        [elements, states].map(|bytes| String::from_utf8(bytes).unwrap())
    }

    #[test]
    fn what_is_written_reads_back() {
        let (design, ephemeris) = ephemeris();
        let [elements, states] = tables();
        let rows = read_elements(elements.as_bytes()).unwrap();
        assert_eq!(rows.len(), 6);
        for (row, satellite) in rows.iter().zip(design.satellites()) {
            let apart = row.elements.mean_anomaly_rad - satellite.elements.mean_anomaly_rad;
            // Degrees and back: a few roundings of up to 6 rad.
            assert!(apart.abs() < 5e-15, "{apart}");
            assert_eq!(row.elements.eccentricity, 0.02);
            assert_eq!(row.epoch, ephemeris.grid().epoch());
        }
        let windows = format!("\u{feff}{}", states.replace('\n', "\r\n"));
        for text in [states.clone(), windows] {
            let trajectories = read_states(text.as_bytes()).unwrap();
            assert_eq!(trajectories.len(), 6);
            for (trajectory, satellite) in trajectories.iter().zip(ephemeris.satellites()) {
                assert_eq!(trajectory.name, satellite.name);
                let (_, frame, last) = trajectory.samples()[9];
                assert_eq!(frame, Frame::Teme);
                let expected = ephemeris.state(satellite, 540.0).unwrap();
                // Nine decimals of a kilometre.
                assert!((last.position_km.km() - expected.position_km.km()).norm() < 1e-9);
            }
        }
        let fixed = states.replace("teme_x_km", "other");
        assert_eq!(
            read_states(fixed.as_bytes()).unwrap()[0].arcs[0].frame,
            Frame::EarthFixed
        );
    }

    #[test]
    fn broken_rules_are_named_with_their_place() {
        let [elements, states] = tables();
        let error = |text: &str, is_elements: bool| {
            let read = match is_elements {
                true => read_elements(text.as_bytes()).map(drop),
                false => read_states(text.as_bytes()).map(drop),
            };
            read.unwrap_err().to_string()
        };
        let second = states.lines().nth(1).unwrap();
        for (text, is_elements, expected) in [
            (
                elements.replace("raan_deg", "node"),
                true,
                "line 1, column 1: column raan_deg is missing",
            ),
            (
                elements.replacen("0.02", "NaN", 1),
                true,
                "line 2, column 8: 'NaN' is not a number",
            ),
            (
                elements.replacen("0.02", "1.5", 1),
                true,
                "line 2, column 7: eccentricity",
            ),
            (
                elements.replacen("2025-01-01T", "2025-01-01 ", 1),
                true,
                "line 2, column 6: '2025",
            ),
            (
                elements.lines().next().unwrap().to_owned(),
                true,
                "line 2, column 1: the table has no rows",
            ),
            (
                format!("{states}{second}\n"),
                false,
                "line 62, column 2: the time is not after",
            ),
            (
                states.replacen(",60,", ",60", 1),
                false,
                "line 3, column 1: the row has 14 fields",
            ),
            (
                String::new(),
                true,
                "line 1, column 1: column object is missing",
            ),
        ] {
            let found = error(&text, is_elements);
            assert!(found.starts_with(expected), "{found} instead of {expected}");
        }
    }
}
