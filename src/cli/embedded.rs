//! The program inside another one, such as the Python module: its commands and the way it reads scenarios and
//! constellations, with what they print kept instead of printed.

pub use super::args::ScenarioText;
pub use super::commands::evaluate::tiles::{design_tile, merged_design};
pub use super::output::{Message, MessageKind, Transcript};
pub use super::progress::{Reached, SharedProgress};
pub use super::study::{PackedStudy, Study};
pub use super::sweep_store::{ChunkState, SweepStore, sweep_chunk};

use super::args::{Cli, Command, StudyArgs};
use super::{
    Status, coincidence, constellations, interrupt, limits, output, progress, provenance,
    read_constellation,
};
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

/// What a command has beside its arguments.
#[derive(Debug)]
pub struct CommandHost<'a> {
    /// The threads of its parallel work, unless it has `--threads`.
    pub pool: &'a rayon::ThreadPool,
    /// Where its search says how far it is.
    pub progress: &'a SharedProgress,
    /// The scenario that it works on, in place of one that is named.
    pub scenario: Option<ScenarioText>,
}

/// Runs a command line, which begins with the program name, and keeps what it prints. One runs at a time.
pub fn run(args: impl IntoIterator<Item = OsString>, host: CommandHost<'_>) -> CommandOutcome {
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    let _guard = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let (status, printed) = output::kept(|| parsed(args, host));
    CommandOutcome { status, printed }
}

fn parsed(args: impl IntoIterator<Item = OsString>, host: CommandHost<'_>) -> u8 {
    let args: Vec<OsString> = args.into_iter().collect();
    let mut cli = match Cli::try_parse_from(&args) {
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
    if let Some(study) = study_of(&mut cli.command) {
        study.text = host.scenario;
    }
    match on_threads(cli, &args, host.pool, host.progress) {
        Ok(status) => status as u8,
        Err(error) => {
            output::error(&error);
            Status::CouldNotRun as u8
        }
    }
}

/// The arguments of a command that name its scenario.
fn study_of(command: &mut Command) -> Option<&mut StudyArgs> {
    match command {
        Command::Optimize(args) => Some(&mut args.study),
        Command::Evaluate(args) => Some(&mut args.study),
        Command::Export(args) => Some(&mut args.study),
        Command::Validate(args) => Some(&mut args.study),
        _ => None,
    }
}

/// Runs a command on the threads of its host, or on as many others as it asks for.
fn on_threads(
    cli: Cli,
    args: &[OsString],
    pool: &rayon::ThreadPool,
    progress: &SharedProgress,
) -> Result<Status> {
    let own = match cli.threads {
        Some(threads) => {
            limits::check_threads(threads)?;
            let own = rayon::ThreadPoolBuilder::new().num_threads(threads.get());
            Some(own.build()?)
        }
        None => None,
    };
    let command = || {
        provenance::set_command(args);
        progress::followed(progress, || output::kept(|| super::command(cli)))
    };
    let (status, printed) = own.as_ref().unwrap_or(pool).install(command);
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

/// Refuses a whole evaluation that is very large or does not fit into memory; one in tiles may be as large.
///
/// # Errors
/// If it is.
pub fn require_whole(setup: &Setup) -> Result<()> {
    limits::check_whole(setup)
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
