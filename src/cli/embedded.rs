//! The program inside another one, such as the Python module: its commands and the way it reads scenarios and
//! constellations, with what they print kept instead of printed.

pub use super::output::{Message, MessageKind, Transcript};
pub use super::study::Study;

use super::args::Cli;
use super::{Status, coincidence, constellations, interrupt, limits, output, read_constellation};
use crate::ephemeris::Ephemeris;
use crate::evaluate::Setup;
use crate::exchange::constellation::{Constellation, FileSatellites};
use crate::exchange::import::{SatelliteFilter, StateChoice};
use crate::exchange::lint::Format;
use anyhow::{Context, Result};
use clap::Parser;
use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

/// What a command came to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CommandOutcome {
    /// Its exit status.
    pub status: u8,
    /// What it printed.
    pub printed: Transcript,
}

/// Runs a command line, which begins with the program name, and keeps what it prints. One runs at a time.
///
/// `--threads` is taken for this command alone.
pub fn run(args: impl IntoIterator<Item = OsString>) -> CommandOutcome {
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    let _guard = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let (status, printed) = output::kept(|| parsed(args));
    CommandOutcome { status, printed }
}

fn parsed(args: impl IntoIterator<Item = OsString>) -> u8 {
    let cli = match Cli::try_parse_from(args) {
        Ok(cli) => cli,
        Err(message) if message.use_stderr() => {
            let text = message.render().to_string();
            let text = text.trim().trim_start_matches("error: ");
            output::error(&anyhow::anyhow!("{text}"));
            return Status::CouldNotRun as u8;
        }
        Err(message) => {
            // Keeping cannot fail.
            let _ = output::result(&message.render().to_string());
            return Status::Done as u8;
        }
    };
    match on_threads(cli) {
        Ok(status) => status as u8,
        Err(error) => {
            output::error(&error);
            Status::CouldNotRun as u8
        }
    }
}

/// Runs a command in this thread, and its parallel work on as many others as it asks for.
fn on_threads(cli: Cli) -> Result<Status> {
    let Some(threads) = cli.threads else {
        return super::command(cli);
    };
    limits::check_threads(threads)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.get());
    let pool = pool.build()?;
    let (status, printed) = pool.install(|| output::kept(|| super::command(cli)));
    output::say_again(printed);
    status
}

/// Asks a search that runs to stop after its current generation and to keep what it has.
pub fn ask_to_stop() {
    interrupt::ask_to_stop();
}

/// Does some work and gives what it printed beside what it found.
pub fn noting<T>(work: impl FnOnce() -> T) -> (T, Transcript) {
    output::kept(work)
}

/// The text of an error as the program prints it, one cause per line.
#[must_use]
pub fn error_text(error: &anyhow::Error) -> String {
    output::causes(error)
}

/// A constellation by its name in the scenario, or a design by its notation.
///
/// # Errors
/// If it is neither, or a file of it cannot be read.
pub fn constellation(study: &Study, text: &str) -> Result<Constellation> {
    match study.scenario.constellation(text) {
        Some(named) => study.constellation(named),
        None => Ok(Constellation::of_design(study.scenario.design(text)?)),
    }
}

/// The constellations that the scenario names, in its order.
///
/// # Errors
/// If a file of one cannot be read.
pub fn constellations(study: &Study) -> Result<Vec<Constellation>> {
    constellations::of_scenario(study)
}

/// The satellites of files and directories that a selection keeps, with warnings of what is not read; `format` names
/// the format of all files, or else their content does.
///
/// # Errors
/// If a file cannot be read, or nothing is selected.
pub fn read(
    paths: &[PathBuf],
    format: Option<Format>,
    filter: &SatelliteFilter,
) -> Result<Constellation> {
    let merged = read_constellation::read(paths, format, &StateChoice::default())?;
    let name = |path: &PathBuf| {
        let name = path.file_name().unwrap_or(path.as_os_str());
        output::shown_path(name.as_ref())
    };
    let names = paths.iter().map(name).collect();
    let files = FileSatellites::new(names, merged, filter)?;
    Ok(Constellation::of_files(files))
}

/// The satellites of a constellation on the grid of a setup, with warnings of satellites from files that are old or
/// interpolated, and of satellites in one place.
///
/// # Errors
/// If a satellite cannot be propagated, or an outage is of none.
pub fn propagate(one: &Constellation, setup: &Setup) -> Result<Ephemeris> {
    if one.files.is_none() {
        let found = constellations::propagate_member(one, setup)?;
        return Ok(found);
    }
    constellations::warn_of_files(one, setup.grid);
    let found = constellations::propagate_member(one, setup)?;
    coincidence::warn(&setup.gnss, setup.grid, Some(&found));
    Ok(found)
}

/// The format of a name, as `--input-format` takes it.
///
/// # Errors
/// If there is none of the name.
pub fn format(name: &str) -> Result<Format> {
    name.parse()
        .with_context(|| format!("'{name}' is not the name of a format that is read"))
}
