//! The `navwalker` program: arguments in, results out. The science is in the rest of the library.
//!
//! This is the one module that opens paths, reads the clock and the environment, and prints.

#![allow(
    clippy::disallowed_methods,
    clippy::disallowed_types,
    reason = "the program is where the outside is met"
)]

mod args;
mod chart;
mod coincidence;
mod commands;
mod constellations;
pub mod embedded;
mod evaluations;
mod files;
mod interrupt;
mod limits;
mod output;
mod progress;
mod provenance;
mod read_constellation;
mod run;
mod run_view;
mod study;
mod sweep_store;

use crate::printable::printable_lines;
use args::{Cli, Command};
use clap::Parser;
use std::borrow::Cow;
use std::ffi::OsString;
use std::io::{self, Write};
use std::process::ExitCode;

/// The exit status of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Status {
    /// Done.
    Done = 0,
    /// Done, but a gate failed, lint found something or no feasible design was found.
    Failed = 1,
    /// Could not run.
    CouldNotRun = 2,
    /// Stopped by Ctrl-C.
    Interrupted = 130,
}

/// Runs the command line `args`, which begins with the program name, and returns its exit status.
pub fn main(args: impl IntoIterator<Item = OsString>) -> ExitCode {
    ExitCode::from(exit_status(args))
}

/// The same as a number.
pub fn exit_status(args: impl IntoIterator<Item = OsString>) -> u8 {
    output::choose_colors();
    let args: Vec<OsString> = args.into_iter().collect();
    provenance::set_command(&args);
    let cli = match Cli::try_parse_from(args) {
        Ok(cli) => cli,
        Err(error) => return said(&error),
    };
    let status = match run(cli) {
        Ok(status) => status,
        Err(error) if output::is_broken_pipe(&error) => Status::Done,
        Err(error) => {
            output::error(&error);
            Status::CouldNotRun
        }
    };
    status as u8
}

/// Prints what parsing came to: help to stdout with status 0, errors to stderr with status 2.
fn said(message: &clap::Error) -> u8 {
    let status = u8::try_from(message.exit_code()).unwrap_or(Status::CouldNotRun as u8);
    // What was typed is repeated: with colours only if it holds nothing that a terminal would obey.
    let plain = message.render().to_string();
    if let Cow::Owned(safe) = printable_lines(&plain) {
        output::hint(safe.trim_end());
        return status;
    }
    match message.print().and_then(|()| io::stdout().flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            output::error(&anyhow::Error::new(error).context("cannot print"));
            Status::CouldNotRun as u8
        }
        _ => status,
    }
}

fn run(cli: Cli) -> anyhow::Result<Status> {
    interrupt::install();
    if let Some(threads) = cli.threads {
        limits::check_threads(threads)?;
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads.get())
            .build_global()?;
    }
    command(cli)
}

fn command(cli: Cli) -> anyhow::Result<Status> {
    output::set_quiet(cli.quiet);
    limits::set_allow_large(cli.allow_large);
    match cli.command {
        Command::Optimize(args) => commands::optimize::run(&args),
        Command::Size(args) => commands::size::run(&args),
        Command::Sweep(args) => commands::sweep::run(&args),
        Command::Evaluate(args) => commands::evaluate::run(&args),
        Command::Reproduce(args) => commands::reproduce::run(&args),
        Command::Dop(args) => commands::dop::run(&args),
        Command::Lifetime(args) => commands::lifetime::run(&args),
        Command::Orbit(args) => commands::orbit::run(&args),
        Command::Separation(args) => commands::separation::run(&args),
        Command::Export(args) => commands::export::run(&args),
        Command::Diff(args) => commands::diff::run(&args),
        Command::Lint(args) => commands::lint::run(&args),
        Command::Validate(args) => commands::validate::run(&args),
        Command::Report(args) => commands::report::run(&args),
        Command::Plot(args) => commands::plot::run(&args),
        Command::Scenario(args) => commands::scenario::run(&args),
        Command::Completions { shell } => commands::help::completions(shell),
        Command::Man { command, out } => commands::help::man(command.as_deref(), out.as_deref()),
    }
}
