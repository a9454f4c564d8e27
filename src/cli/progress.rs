//! The progress of long work: a bar on a terminal, and a line now and then where there is none.

use crate::cli::output::{self, ProgressPlace};
use crate::optimize::Strategy;
use crate::printable::printable;
use crate::report::shown;
use crate::search::size::{SizeProblem, SizeSearch};
use indicatif::{ProgressBar, ProgressStyle};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// The time between two lines of progress where there is no terminal.
const BETWEEN_LINES: Duration = Duration::from_secs(10);

/// How far some work is.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Reached {
    /// Steps done: generations, iterations, batches or designs.
    pub step: u64,
    /// All steps.
    pub steps: u64,
    /// Designs evaluated.
    pub evaluations: u64,
    /// Hypervolume of the front, if it has one.
    pub hypervolume: Option<f64>,
}

impl Reached {
    /// How far a search is.
    pub fn of(search: &impl Strategy) -> Self {
        let progress = search.progress();
        let last = search.history().last();
        Self {
            step: progress.step,
            steps: progress.steps,
            evaluations: progress.evaluations,
            hypervolume: last
                .and_then(|record| record.hypervolume_at_chosen.or(record.hypervolume)),
        }
    }
}

/// Where work says how far it is, for another thread to look at.
#[derive(Debug, Clone, Default)]
pub struct SharedProgress(Arc<Mutex<Reached>>);

impl SharedProgress {
    fn lock(&self) -> MutexGuard<'_, Reached> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// How far the work is.
    #[must_use]
    pub fn reached(&self) -> Reached {
        *self.lock()
    }

    /// Says how far the work is.
    pub fn set(&self, reached: Reached) {
        *self.lock() = reached;
    }

    /// Counts one more design, which is a step by itself.
    pub fn one_more(&self) {
        self.add(1);
    }

    /// Counts more designs, each a step by itself.
    pub fn add(&self, designs: u64) {
        let mut reached = self.lock();
        reached.step += designs;
        reached.evaluations += designs;
    }
}

/// What follows the searches of the command that runs, if another program runs it.
static FOLLOWED_BY: Mutex<Option<SharedProgress>> = Mutex::new(None);

/// Does some work, whose searches say in `progress` how far they are. One at a time.
pub(crate) fn followed<T>(progress: &SharedProgress, work: impl FnOnce() -> T) -> T {
    let follow = |by| *FOLLOWED_BY.lock().unwrap_or_else(PoisonError::into_inner) = by;
    follow(Some(progress.clone()));
    let done = work();
    follow(None);
    done
}

/// What shows the progress of some work.
enum Display {
    Bar(ProgressBar),
    Lines(Mutex<LogLines>),
    Nothing,
}

/// Progress as lines of a log.
struct LogLines {
    /// What is counted, such as `designs`.
    counted: &'static str,
    started: Instant,
    /// When the next line is due, from the start.
    due: Duration,
    position: u64,
    length: Option<u64>,
    message: String,
}

impl LogLines {
    /// The line to print now, if it is time for one.
    fn line(&mut self, elapsed: Duration) -> Option<String> {
        if elapsed < self.due {
            return None;
        }
        self.due = elapsed + BETWEEN_LINES;
        let count = match self.length {
            Some(length) => format!("{}/{length} {}", self.position, self.counted),
            None if self.counted.is_empty() => String::new(),
            None => format!("{} {}", self.position, self.counted),
        };
        let parts = [count, self.message.clone()];
        let parts: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        Some(format!("{} s: {}", elapsed.as_secs(), parts.join(", ")))
    }

    fn print_if_due(&mut self) {
        if let Some(line) = self.line(self.started.elapsed()) {
            output::hint(&line);
        }
    }
}

impl Display {
    /// A bar by a template of `indicatif`, or lines that count `counted`.
    fn new(template: &str, counted: &'static str, length: Option<u64>) -> Self {
        match output::progress_place() {
            ProgressPlace::Terminal => {
                let bar = match length {
                    Some(length) => ProgressBar::new(length),
                    None => ProgressBar::new_spinner(),
                };
                if let Ok(style) = ProgressStyle::with_template(template) {
                    bar.set_style(style);
                }
                Self::Bar(bar)
            }
            ProgressPlace::Log => Self::Lines(Mutex::new(LogLines {
                counted,
                started: Instant::now(),
                due: BETWEEN_LINES,
                position: 0,
                length,
                message: String::new(),
            })),
            ProgressPlace::Nowhere => Self::Nothing,
        }
    }

    fn change(&self, in_bar: impl FnOnce(&ProgressBar), in_lines: impl FnOnce(&mut LogLines)) {
        match self {
            Self::Bar(bar) => in_bar(bar),
            Self::Lines(lines) => {
                let mut lines = lines.lock().unwrap_or_else(PoisonError::into_inner);
                in_lines(&mut lines);
                lines.print_if_due();
            }
            Self::Nothing => {}
        }
    }

    fn add(&self, count: u64) {
        self.change(|bar| bar.inc(count), |lines| lines.position += count);
    }

    fn show(&self, position: u64, length: u64, message: String) {
        let in_bar = |bar: &ProgressBar| {
            if bar.length() != Some(length) {
                bar.reset_eta();
                bar.set_length(length);
            }
            bar.set_message(message.clone());
            bar.set_position(position);
        };
        self.change(in_bar, |lines| {
            lines.position = position;
            lines.length = Some(length);
            lines.message.clone_from(&message);
        });
    }

    fn say(&self, message: &str) {
        let in_bar = |bar: &ProgressBar| {
            bar.set_message(message.to_owned());
            bar.tick();
        };
        self.change(in_bar, |lines| message.clone_into(&mut lines.message));
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

/// The progress of a search, for the user and for what follows it.
pub(crate) struct SearchBar {
    display: Display,
    followed_by: Option<SharedProgress>,
}

impl SearchBar {
    /// That of a search that may have been resumed.
    pub(crate) fn new(search: &impl Strategy) -> Self {
        let followed_by = FOLLOWED_BY.lock().unwrap_or_else(PoisonError::into_inner);
        let template = "generation {pos}/{len} {wide_bar} {msg} ETA {eta}";
        let steps = Some(Reached::of(search).steps);
        let new = Self {
            display: Display::new(template, "generations", steps),
            followed_by: followed_by.clone(),
        };
        new.show(search);
        new
    }

    /// Shows the progress of the search.
    pub(crate) fn show(&self, search: &impl Strategy) {
        let reached = Reached::of(search);
        if let Some(follower) = &self.followed_by {
            follower.set(reached);
        }
        let hypervolume = reached.hypervolume.map_or(String::new(), |value| {
            format!(", hypervolume {}", shown::significant(value))
        });
        let message = format!("{} evaluations{hypervolume}", reached.evaluations);
        self.display.show(reached.step, reached.steps, message);
    }
}

/// The progress of a search for the fewest satellites.
pub(crate) struct SizeBar(Display);

impl SizeBar {
    pub(crate) fn new() -> Self {
        let template = "{msg} {wide_bar} {pos}/{len} designs, {per_sec}, ETA {eta} of this number";
        Self(Display::new(template, "designs", Some(0)))
    }

    /// Shows the number of satellites, and the designs of it that are done.
    pub(crate) fn show(&self, problem: &SizeProblem<'_>, search: &SizeSearch) {
        let Some((satellites, left, all)) = search.next_level(problem) else {
            return;
        };
        let message = format!("{satellites} satellites, {} tried", search.tried());
        self.0.show(all - left, all, message);
    }
}

/// The progress of designs that several threads evaluate.
pub(crate) struct DesignBar {
    display: Display,
    followed_by: Option<SharedProgress>,
}

impl DesignBar {
    pub(crate) fn new(designs: u64) -> Self {
        let followed_by = FOLLOWED_BY.lock().unwrap_or_else(PoisonError::into_inner);
        let template = "{wide_bar} {pos}/{len} designs, {per_sec}, ETA {eta}";
        Self {
            display: Display::new(template, "designs", Some(designs)),
            followed_by: followed_by.clone(),
        }
    }

    /// Counts designs that are done.
    pub(crate) fn add(&self, designs: u64) {
        self.display.add(designs);
        if let Some(follower) = &self.followed_by {
            follower.add(designs);
        }
    }
}

/// Counts the files of an export, which several threads write.
pub(crate) struct FileCount(Display);

impl FileCount {
    pub(crate) fn new() -> Self {
        Self(Display::new(
            "{spinner} {pos} files, {elapsed}",
            "files",
            None,
        ))
    }

    /// Counts a file that has been started.
    pub(crate) fn one_more(&self) {
        self.0.add(1);
    }
}

/// The progress of work in a few stages of unlike length.
pub(crate) struct Stages(Display);

impl Stages {
    pub(crate) fn new() -> Self {
        Self(Display::new("{spinner} {msg}, {elapsed}", "", None))
    }

    /// Says what is done now.
    pub(crate) fn begin(&self, stage: &str) {
        self.0.say(&printable(stage));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_has_a_line_every_ten_seconds_and_none_of_short_work() {
        let mut lines = LogLines {
            counted: "designs",
            started: Instant::now(),
            due: BETWEEN_LINES,
            position: 7,
            length: Some(20),
            message: String::new(),
        };
        let mut at = |seconds| lines.line(Duration::from_millis(seconds));
        assert_eq!(at(9_999), None);
        assert_eq!(at(12_300).as_deref(), Some("12 s: 7/20 designs"));
        assert_eq!(at(22_299), None);
        lines.message = "182 satellites".to_owned();
        let line = lines.line(Duration::from_secs(40));
        assert_eq!(line.as_deref(), Some("40 s: 7/20 designs, 182 satellites"));
        (lines.counted, lines.length) = ("", None);
        assert_eq!(
            lines.line(Duration::from_secs(60)).as_deref(),
            Some("60 s: 182 satellites")
        );
    }
}
