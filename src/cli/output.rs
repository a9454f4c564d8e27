//! stdout carries results; stderr carries everything else.

use crate::printable::{printable, printable_lines};
use anyhow::Result;
use std::cell::RefCell;
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether hints and warnings are printed; set once, from the command line.
static QUIET: AtomicBool = AtomicBool::new(false);

pub(crate) fn set_quiet(quiet: bool) {
    QUIET.store(quiet, Ordering::Relaxed);
}

/// What was printed, where another program runs a command.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Transcript {
    /// The result, as stdout would have it.
    pub result: String,
    /// Everything else, in its order.
    pub messages: Vec<Message>,
}

/// A message beside the result.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// What it is.
    pub kind: MessageKind,
    /// Its text, without what a terminal would obey.
    pub text: String,
}

/// What a message is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MessageKind {
    /// What a reader may do next.
    Hint,
    /// What may be wrong.
    Warning,
    /// Why the command could not run.
    Error,
}

thread_local! {
    /// Where this thread prints to, if not to stdout and stderr.
    static KEPT: RefCell<Option<Transcript>> = const { RefCell::new(None) };
}

/// Does some work of this thread and keeps what it prints.
pub(crate) fn kept<T>(work: impl FnOnce() -> T) -> (T, Transcript) {
    let outer = KEPT.replace(Some(Transcript::default()));
    let done = work();
    (done, KEPT.replace(outer).unwrap_or_default())
}

/// Adds to what is kept; `false` if nothing is.
fn keep(add: impl FnOnce(&mut Transcript)) -> bool {
    KEPT.with_borrow_mut(|kept| kept.as_mut().map(add).is_some())
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

/// Where the progress of long work is shown.
pub(crate) fn progress_place() -> ProgressPlace {
    if QUIET.load(Ordering::Relaxed) || keep(|_| {}) {
        ProgressPlace::Nowhere
    } else if io::stderr().is_terminal() {
        ProgressPlace::Terminal
    } else {
        ProgressPlace::Log
    }
}

/// Where progress goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ProgressPlace {
    /// A terminal, on which a bar may be drawn.
    Terminal,
    /// A file or a pipe, which takes lines.
    Log,
    /// Nobody reads it.
    Nowhere,
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
    let text = printable_lines(text);
    if keep(|kept| kept.result += &text) {
        return Ok(());
    }
    let mut stdout = io::stdout().lock();
    stdout.write_all(text.as_bytes())?;
    Ok(stdout.flush()?)
}

/// Prints a hint, which is not part of the result.
pub(crate) fn hint(text: &str) {
    if !QUIET.load(Ordering::Relaxed) {
        say(MessageKind::Hint, text);
    }
}

/// Prints a warning.
pub(crate) fn warning(text: &str) {
    if !QUIET.load(Ordering::Relaxed) {
        say(MessageKind::Warning, text);
    }
}

/// Prints why the command could not run, one cause per line.
pub(crate) fn error(error: &anyhow::Error) {
    say(MessageKind::Error, &causes(error));
}

/// The text of an error, one cause per line.
pub(crate) fn causes(error: &anyhow::Error) -> String {
    let mut text = error.to_string();
    for cause in error.chain().skip(1) {
        let cause = cause.to_string();
        // Some errors already include the text of their cause.
        if !text.contains(&cause) {
            text += &format!("\n  cause: {cause}");
        }
    }
    text
}

fn say(kind: MessageKind, text: &str) {
    let text = printable_lines(text);
    let message = || Message {
        kind,
        text: text.clone().into_owned(),
    };
    if keep(|kept| kept.messages.push(message())) {
        return;
    }
    let label = match kind {
        MessageKind::Hint => String::new(),
        MessageKind::Warning => format!("{YELLOW}warning:{PLAIN} "),
        MessageKind::Error => format!("{RED}error:{PLAIN} "),
    };
    // If stderr is closed, nothing can be reported.
    let _ = writeln!(anstream::stderr().lock(), "{label}{text}");
}

/// Keeps or prints what was kept.
pub(crate) fn say_again(printed: Transcript) {
    // Printing into what is kept cannot fail, and a result of this size is kept.
    let _ = part(&printed.result);
    for message in printed.messages {
        say(message.kind, &message.text);
    }
}

/// Whether the reader of stdout has closed the pipe, as `head` does.
pub(crate) fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error.chain().any(|cause| {
        cause
            .downcast_ref::<io::Error>()
            .is_some_and(|e| e.kind() == io::ErrorKind::BrokenPipe)
    })
}
