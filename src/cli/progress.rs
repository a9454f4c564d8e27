//! The progress of a search and of an export, on a terminal only.

use crate::cli::output;
use crate::optimize::Strategy;
use crate::report::shown;
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
