//! stdout carries results; stderr carries everything else.

use crate::printable::{printable, printable_lines};
use anyhow::Result;
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether hints and warnings are printed; set once, from the command line.
static QUIET: AtomicBool = AtomicBool::new(false);

pub(crate) fn set_quiet(quiet: bool) {
    QUIET.store(quiet, Ordering::Relaxed);
}

/// Turns colours off if `--no-color` is on the command line, before parsing, so that parse errors
/// respect it too. `NO_COLOR` and a stream that is not a terminal have the same effect.
pub(crate) fn choose_colors() {
    let mut options = std::env::args_os().take_while(|argument| argument != "--");
    if options.any(|argument| argument == "--no-color") {
        anstream::ColorChoice::Never.write_global();
    }
}

/// Terminal codes for the words `error` and `warning`; stripped if colours are off.
const RED: &str = "\x1b[1;31m";
const YELLOW: &str = "\x1b[1;33m";
const PLAIN: &str = "\x1b[0m";

/// Whether progress may be drawn: not quiet, and on a terminal.
pub(crate) fn shows_progress() -> bool {
    !QUIET.load(Ordering::Relaxed) && io::stderr().is_terminal()
}

/// A path on one line: a directory may come from elsewhere, with names of any characters.
pub(crate) fn shown_path(path: &Path) -> String {
    printable(&path.to_string_lossy()).into_owned()
}

/// Prints a result: text without what a terminal would obey ([`crate::printable`]).
pub(crate) fn result(text: &str) -> Result<()> {
    let end = if text.ends_with('\n') { "" } else { "\n" };
    part(&format!("{text}{end}"))
}

/// Prints a part of a result as it is, at once.
pub(crate) fn part(text: &str) -> Result<()> {
    let mut stdout = io::stdout().lock();
    stdout.write_all(printable_lines(text).as_bytes())?;
    Ok(stdout.flush()?)
}

/// Prints a hint, which is not part of the result.
pub(crate) fn hint(text: &str) {
    if !QUIET.load(Ordering::Relaxed) {
        to_stderr("", text);
    }
}

/// Prints a warning.
pub(crate) fn warning(text: &str) {
    if !QUIET.load(Ordering::Relaxed) {
        to_stderr(&format!("{YELLOW}warning:{PLAIN} "), text);
    }
}

/// Prints why the command could not run, one cause per line.
pub(crate) fn error(error: &anyhow::Error) {
    let mut text = error.to_string();
    for cause in error.chain().skip(1) {
        let cause = cause.to_string();
        // Some errors already include the text of their cause.
        if !text.contains(&cause) {
            text += &format!("\n  cause: {cause}");
        }
    }
    to_stderr(&format!("{RED}error:{PLAIN} "), &text);
}

fn to_stderr(label: &str, text: &str) {
    // If stderr is closed, nothing can be reported.
    let _ = writeln!(
        anstream::stderr().lock(),
        "{label}{}",
        printable_lines(text)
    );
}

/// Whether the reader of stdout has closed the pipe, as `head` does.
pub(crate) fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error.chain().any(|cause| {
        cause
            .downcast_ref::<io::Error>()
            .is_some_and(|e| e.kind() == io::ErrorKind::BrokenPipe)
    })
}
