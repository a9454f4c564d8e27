//! Prints the states of the satellites in a file of any format that the library reads, as CSV.
//!
//! `cargo run --release --example print_states -- gps.alm 2025-06-01T00:00:00Z 86400 900 ITRF`
//!
//! After the file come the first instant in UTC, the duration and the step in seconds, and the frame of the states: TEME
//! (if none is given), ITRF, EME2000 or GCRF. ITRF is the library's Earth-fixed frame, in which UT1 is UTC at the first instant.
//! An instant without a state, in a gap of the file or beyond its end, has no row. With `--gnss` before all, the file is
//! read as a scenario reads `gnss.files`.

use navwalker::constellation::gnss::System;
use navwalker::ephemeris::Ephemeris;
use navwalker::exchange::import::Fleet;
use navwalker::frames::{Frame, FromTeme};
use navwalker::keyword::Keyword;
use navwalker::orbit::Model;
use navwalker::scenario::Scenario;
use navwalker::time::{Epoch, TimeGrid};
use std::error::Error;
use std::fs::{self, File};
use std::io::{self, BufReader, Write};
use std::path::Path;

const COLUMNS: [&str; 8] = [
    "object",
    "elapsed_s",
    "x_km",
    "y_km",
    "z_km",
    "vx_km_s",
    "vy_km_s",
    "vz_km_s",
];
/// What is printed if nothing is asked for.
const EXAMPLE: [&str; 4] = [
    "validation/exports/oem-kvn/oem/NW-P01-S01.oem",
    "2025-01-01T00:00:00Z",
    "3600",
    "360",
];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = match arguments.as_slice() {
        [] => EXAMPLE.to_vec(),
        given => given.iter().map(String::as_str).collect(),
    };
    let (is_gnss, arguments) = match arguments.as_slice() {
        ["--gnss", rest @ ..] => (true, rest),
        all => (false, all),
    };
    let (path, epoch, duration_s, step_s, frame) = match *arguments {
        [path, epoch, duration_s, step_s] => (path, epoch, duration_s, step_s, "TEME"),
        [path, epoch, duration_s, step_s, frame] => (path, epoch, duration_s, step_s, frame),
        _ => {
            return Err("usage: print_states [--gnss] FILE EPOCH DURATION_S STEP_S [FRAME]".into());
        }
    };
    let epoch = Epoch::from_utc(epoch.parse()?);
    let grid = TimeGrid::new(epoch, duration_s.parse()?, step_s.parse()?)?;
    let frame = Frame::from_keyword(frame)?;
    let ephemerides = match is_gnss {
        true => as_gnss(path, grid)?,
        false => vec![as_constellation(path, grid)?],
    };

    let mut table = csv::Writer::from_writer(io::stdout().lock());
    table.write_record(COLUMNS)?;
    for ephemeris in &ephemerides {
        for satellite in ephemeris.satellites() {
            for elapsed_s in grid.iter() {
                let Some(teme) = ephemeris.state_or_gap(satellite, elapsed_s)? else {
                    continue;
                };
                let state = FromTeme::to(frame, epoch, elapsed_s).apply(teme);
                let (r, v) = (state.position_km.km(), state.velocity_km_s);
                let numbers = [elapsed_s, r.x, r.y, r.z, v.x, v.y, v.z];
                table.write_field(&satellite.name)?;
                table.write_record(numbers.map(|number| number.to_string()))?;
            }
        }
    }
    table.flush()?;
    Ok(())
}

/// The satellites of a file on a grid.
fn as_constellation(path: &str, grid: TimeGrid) -> Result<Ephemeris, Box<dyn Error>> {
    let name = Path::new(path).file_name().and_then(|name| name.to_str());
    let imported = Fleet::read(BufReader::new(File::open(path)?), None, name)?;
    if !imported.left_out.is_empty() {
        writeln!(io::stderr(), "{path}: {}", imported.left_out)?;
    }
    // The model is for mean elements; other files have a theory of their own.
    Ok(imported.fleet.propagate(grid, Model::J2)?)
}

/// The navigation systems of a file, as a scenario reads them.
fn as_gnss(path: &str, grid: TimeGrid) -> Result<Vec<Ephemeris>, Box<dyn Error>> {
    let mut scenario = Scenario::parse("print_states", b"", &[] as &[&str])?;
    scenario.time.epoch = grid.epoch().utc();
    // Half a step less, so that rounding adds no sample.
    scenario.time.duration_h = (grid.len() as f64 - 0.5) * grid.step_s() / 3600.0;
    scenario.time.step_s = grid.step_s();
    scenario.gnss.constellations.clear();
    scenario.gnss.files = vec![path.to_owned()];
    let (setup, notes) = scenario.setup_with_notes(&|file| fs::read(file))?;
    for note in notes {
        writeln!(io::stderr(), "{note}")?;
    }
    let satellites = |system: &System| system.satellites(grid.epoch());
    let systems = setup.gnss.iter().map(satellites);
    Ok(systems.map(|one| Ephemeris::of_gnss(one, grid)).collect())
}
