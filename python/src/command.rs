//! The commands of the program, from Python.

use crate::interruptible::{Shared, in_thread};
use crate::pools::pool;
use navwalker::cli::embedded::{self, CommandHost, MessageKind, ScenarioText};
use navwalker::scenario::describe_keys;
use pyo3::prelude::*;
use std::ffi::OsString;
use std::path::PathBuf;

/// Status, result and messages of a command, each message with its kind.
type Outcome = (u8, String, Vec<(&'static str, String)>);

/// Runs a command in this process: its status, its result and its messages. `scenario` is the text of the scenario that it
/// works on, with the directory of its files; `tick` is told how far its search is.
#[pyfunction]
#[pyo3(signature = (args, scenario = None, tick = None))]
pub(crate) fn run_command(
    py: Python<'_>,
    args: Vec<OsString>,
    scenario: Option<(String, PathBuf)>,
    tick: Option<Bound<'_, PyAny>>,
) -> PyResult<Outcome> {
    let args = std::iter::once(OsString::from("navwalker")).chain(args);
    let args: Vec<OsString> = args.collect();
    let pool = pool(None)?;
    let scenario = scenario.map(|(text, directory)| ScenarioText {
        label: "scenario".to_owned(),
        text,
        directory,
    });
    let work = move |shared: &Shared| {
        let host = CommandHost {
            pool: &pool,
            progress: &shared.progress,
            scenario,
        };
        embedded::run(args, host)
    };
    let outcome = in_thread(py, tick.as_ref(), embedded::ask_to_stop, work)?;
    Ok((
        outcome.status,
        outcome.printed.result,
        told(outcome.printed.messages),
    ))
}

/// Messages as pairs of kind and text.
fn told(messages: Vec<embedded::Message>) -> Vec<(&'static str, String)> {
    let pair = |one: embedded::Message| {
        let kind = match one.kind {
            MessageKind::Hint => "hint",
            MessageKind::Warning => "warning",
            MessageKind::Error => "error",
        };
        (kind, one.text)
    };
    messages.into_iter().map(pair).collect()
}

/// Runs the program as from a terminal, with its name first; its exit status.
#[pyfunction]
pub(crate) fn main(py: Python<'_>, args: Vec<OsString>) -> u8 {
    py.detach(|| navwalker::cli::exit_status(args))
}

/// The keys of a scenario, as `section.name`.
#[pyfunction]
pub(crate) fn keys() -> Vec<String> {
    let dotted = |one: navwalker::scenario::KeyDescription| match one.section {
        "" => one.name.to_owned(),
        section => format!("{section}.{}", one.name),
    };
    describe_keys().into_iter().map(dotted).collect()
}
