//! The progress of a search and of an export, on a terminal only.

use crate::cli::output;
use crate::optimize::Strategy;
use crate::report::shown;
use crate::search::size::{SizeProblem, SizeSearch};
use indicatif::{ProgressBar, ProgressStyle};

/// A progress bar, or nothing if stderr is not a terminal.
pub(crate) struct SearchBar(Option<ProgressBar>);

impl SearchBar {
    /// A bar for a search that may have been resumed.
    pub(crate) fn new(search: &impl Strategy) -> Self {
        if !output::shows_progress() {
            return Self(None);
        }
        let progress = search.progress();
        let bar = ProgressBar::new(progress.steps).with_position(progress.step);
        let template = "generation {pos}/{len} {wide_bar} {msg} ETA {eta}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.tick();
        Self(Some(bar))
    }

    /// Shows the progress of the search.
    pub(crate) fn show(&self, search: &impl Strategy) {
        let Some(bar) = &self.0 else { return };
        let progress = search.progress();
        let hypervolume = search
            .history()
            .last()
            .and_then(|record| record.hypervolume_at_chosen.or(record.hypervolume));
        let hypervolume = hypervolume.map_or(String::new(), |value| {
            format!(", hypervolume {}", shown::significant(value))
        });
        bar.set_message(format!("{} evaluations{hypervolume}", progress.evaluations));
        bar.set_position(progress.step);
    }

    /// Removes the bar.
    pub(crate) fn finish(&self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
    }
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
