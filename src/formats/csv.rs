//! Comma-separated tables with units in their headers: elements and states.
//!
//! A state has a row for each satellite and sample, in TEME and Earth-fixed, so that it serves
//! as the neutral truth for every other file. Syntax: RFC 4180, with a bare line feed.

mod read;
mod table;

pub use read::{ElementsRow, parse_elements, parse_states, read_elements, read_states};
pub(super) use table::CsvTable;

use crate::constellation::{Slot, shell_letters};
use crate::ephemeris::Ephemeris;
use crate::ephemeris::sampled::Sampled;
use crate::formats::WriteError;
use crate::formats::metadata::Object;
use crate::formats::text::fixed::FixedDecimals;
use crate::formats::text::timestamp::{SecondDigits, calendar};
use crate::frames::{EarthFixed, State};
use crate::orbit::MeanElements;
use crate::orbit::sgp4::MeanMotionSlot;
use crate::time::Epoch;
use serde::Serialize;
use std::io::{self, Write};

/// Writes records whose fields are the columns, one a row: points or instants of a series.
///
/// # Errors
/// If the table cannot be written.
pub fn write_records(out: &mut impl Write, rows: &[impl Serialize]) -> io::Result<()> {
    let mut writer = ::csv::Writer::from_writer(out);
    for row in rows {
        writer.serialize(row)?;
    }
    writer.flush()
}

/// Columns of the table of elements before the place of a satellite.
const OBJECT: [&str; 3] = ["object", "object_id", "catalog_number"];

/// Columns of the place of a satellite in a design; without the first if the design has one shell.
const PLACE: [&str; 3] = ["shell", "plane", "slot"];

/// Columns of the table of elements: mean elements at the epoch, in TEME.
const ELEMENTS: [&str; 9] = [
    "epoch_utc",
    "semi_major_axis_km",
    "eccentricity",
    "inclination_deg",
    "raan_deg",
    "arg_perigee_deg",
    "mean_anomaly_deg",
    "kozai_mean_motion_rev_day",
    "kepler_mean_motion_rev_day",
];

/// Columns of the table of states.
const STATES: [&str; 15] = [
    "object",
    "utc",
    "elapsed_s",
    "teme_x_km",
    "teme_y_km",
    "teme_z_km",
    "teme_vx_km_s",
    "teme_vy_km_s",
    "teme_vz_km_s",
    "itrf_x_km",
    "itrf_y_km",
    "itrf_z_km",
    "itrf_vx_km_s",
    "itrf_vy_km_s",
    "itrf_vz_km_s",
];

/// A row of the table of elements.
#[derive(Debug, Clone, Copy)]
pub struct ElementsOf<'a> {
    /// Place in a design.
    pub slot: Option<Slot>,
    /// Mean elements, TEME.
    pub elements: MeanElements,
    /// Identity.
    pub object: &'a Object,
}

/// Writes mean elements at an epoch, all digits; with the letters of shells if there are several.
///
/// # Errors
/// If writing fails.
pub fn write_elements(
    out: &mut impl Write,
    satellites: &[ElementsOf<'_>],
    epoch: Epoch,
) -> Result<(), WriteError> {
    let has_shells = |one: &ElementsOf<'_>| one.slot.is_some_and(|slot| slot.shell.is_some());
    let place = usize::from(!satellites.iter().any(has_shells));
    let mut table = ::csv::Writer::from_writer(out);
    let header = OBJECT.iter().chain(&PLACE[place..]).chain(&ELEMENTS);
    table.write_record(header).map_err(io_error)?;
    let stamp = epoch.utc().naive_utc();
    let stamp = calendar(stamp, SecondDigits::of_stamp(stamp));
    for ElementsOf {
        slot,
        elements,
        object,
    } in satellites
    {
        let numbers = [
            elements.semi_major_axis_km,
            elements.eccentricity,
            elements.inclination_rad.to_degrees(),
            elements.raan_rad.to_degrees(),
            elements.arg_perigee_rad.to_degrees(),
            elements.mean_anomaly_rad.to_degrees(),
            MeanMotionSlot::Kozai.mean_motion_rev_day(elements),
            MeanMotionSlot::Kepler.mean_motion_rev_day(elements),
        ];
        let mut row = vec![
            object.name.clone(),
            object.id.clone(),
            object.catalog_number.number().to_string(),
        ];
        row.extend(place_of(*slot).into_iter().skip(place));
        row.push(stamp.clone());
        row.extend(numbers.map(|number| number.to_string()));
        table.write_record(&row).map_err(io_error)?;
    }
    table.flush()?;
    Ok(())
}

/// Shell, plane and place in it, from 1; empty outside a design.
fn place_of(slot: Option<Slot>) -> [String; 3] {
    let shell = slot.and_then(|slot| slot.shell).map(shell_letters);
    let plane = slot.map(|slot| (slot.plane + 1).to_string());
    let index = slot.map(|slot| (slot.index + 1).to_string());
    [shell, plane, index].map(Option::unwrap_or_default)
}

/// Writes the states of an ephemeris, satellite by satellite.
///
/// # Errors
/// If a satellite has no state, or the output fails.
pub fn write_states(out: &mut impl Write, ephemeris: &Ephemeris) -> Result<(), WriteError> {
    let mut table = ::csv::Writer::from_writer(out);
    table.write_record(STATES).map_err(io_error)?;
    let grid = ephemeris.grid();
    let digits = SecondDigits::of_grid(&grid);
    let fixed = Sampled::new(ephemeris, EarthFixed);
    for satellite in ephemeris.satellites() {
        for (k, sample) in ephemeris.states(satellite).enumerate() {
            let (elapsed_s, teme) = sample?;
            let stamp = grid.epoch().plus_seconds(elapsed_s).utc().naive_utc();
            let mut row = vec![
                satellite.name.clone(),
                calendar(stamp, digits),
                elapsed_s.to_string(),
            ];
            row.extend(fields(&teme));
            row.extend(fields(&fixed.rotated(k, teme)));
            table.write_record(&row).map_err(io_error)?;
        }
    }
    table.flush()?;
    Ok(())
}

/// Position to 1e-9 km and velocity to 1e-12 km/s.
fn fields<F>(state: &State<F>) -> impl Iterator<Item = String> {
    let (r, v) = (state.position_km.km(), state.velocity_km_s);
    let position = [r.x, r.y, r.z].map(|x| FixedDecimals::<9>(x).to_string());
    let velocity = [v.x, v.y, v.z].map(|x| FixedDecimals::<12>(x).to_string());
    position.into_iter().chain(velocity)
}

/// The writer gives rows of equal length, so that only the output can fail.
pub(super) fn io_error(error: ::csv::Error) -> io::Error {
    match error.into_kind() {
        ::csv::ErrorKind::Io(error) => error,
        kind => io::Error::other(format!("{kind:?}")),
    }
}
