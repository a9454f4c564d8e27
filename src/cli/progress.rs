//! The progress of a search and of an export, on a terminal only.

use crate::cli::output;
use crate::optimize::Strategy;
use crate::report::shown;
use crate::search::size::{SizeProblem, SizeSearch};
use indicatif::{ProgressBar, ProgressStyle};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

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

/// A progress bar, or nothing if stderr is not a terminal; and what follows the search.
pub(crate) struct SearchBar {
    bar: Option<ProgressBar>,
    followed_by: Option<SharedProgress>,
}

impl SearchBar {
    /// A bar for a search that may have been resumed.
    pub(crate) fn new(search: &impl Strategy) -> Self {
        let followed_by = FOLLOWED_BY.lock().unwrap_or_else(PoisonError::into_inner);
        let new = Self {
            bar: output::shows_progress().then(|| search_bar(Reached::of(search))),
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
        let Some(bar) = &self.bar else { return };
        let hypervolume = reached.hypervolume.map_or(String::new(), |value| {
            format!(", hypervolume {}", shown::significant(value))
        });
        bar.set_message(format!("{} evaluations{hypervolume}", reached.evaluations));
        bar.set_position(reached.step);
    }

    /// Removes the bar.
    pub(crate) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

fn search_bar(reached: Reached) -> ProgressBar {
    let bar = ProgressBar::new(reached.steps).with_position(reached.step);
    let template = "generation {pos}/{len} {wide_bar} {msg} ETA {eta}";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar.tick();
    bar
}

/// The progress of a search for the fewest satellites, or nothing if stderr is not a terminal.
pub(crate) struct SizeBar(Option<ProgressBar>);

impl SizeBar {
    pub(crate) fn new() -> Self {
        if !output::shows_progress() {
            return Self(None);
        }
        let bar = ProgressBar::new(0);
        let template = "{msg} {wide_bar} {pos}/{len} designs, {per_sec}, ETA {eta} of this number";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        Self(Some(bar))
    }

    /// Shows the number of satellites, and the designs of it that are done.
    pub(crate) fn show(&self, problem: &SizeProblem<'_>, search: &SizeSearch) {
        let Some(bar) = &self.0 else { return };
        let Some((satellites, left, all)) = search.next_level(problem) else {
            return;
        };
        if bar.length() != Some(all) {
            bar.reset_eta();
            bar.set_length(all);
        }
        bar.set_message(format!("{satellites} satellites, {} tried", search.tried()));
        bar.set_position(all - left);
    }

    /// Removes the bar.
    pub(crate) fn finish(&self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
    }
}

/// The progress of designs that several threads evaluate.
pub(crate) struct DesignBar {
    bar: Option<ProgressBar>,
    followed_by: Option<SharedProgress>,
}

impl DesignBar {
    pub(crate) fn new(designs: u64) -> Self {
        let followed_by = FOLLOWED_BY.lock().unwrap_or_else(PoisonError::into_inner);
        let new = Self {
            bar: output::shows_progress().then(|| ProgressBar::new(designs)),
            followed_by: followed_by.clone(),
        };
        let template = "{wide_bar} {pos}/{len} designs, {per_sec}, ETA {eta}";
        if let (Some(bar), Ok(style)) = (&new.bar, ProgressStyle::with_template(template)) {
            bar.set_style(style);
        }
        new
    }

    /// Counts designs that are done.
    pub(crate) fn add(&self, designs: u64) {
        if let Some(bar) = &self.bar {
            bar.inc(designs);
        }
        if let Some(follower) = &self.followed_by {
            follower.add(designs);
        }
    }

    /// Removes the bar.
    pub(crate) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Counts the files of an export, which several threads write.
pub(crate) struct FileCount(Option<ProgressBar>);

impl FileCount {
    pub(crate) fn new() -> Self {
        if !output::shows_progress() {
            return Self(None);
        }
        let bar = ProgressBar::new_spinner();
        if let Ok(style) = ProgressStyle::with_template("{spinner} {pos} files, {elapsed}") {
            bar.set_style(style);
        }
        Self(Some(bar))
    }

    /// Counts a file that has been started.
    pub(crate) fn one_more(&self) {
        if let Some(bar) = &self.0 {
            bar.inc(1);
        }
    }

    /// Removes the count.
    pub(crate) fn finish(&self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
    }
}
