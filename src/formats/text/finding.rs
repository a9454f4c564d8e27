//! What a reader objects to in a file: where it stands and which rule it breaks.

use thiserror::Error;

/// How bad a broken rule is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Severity {
    /// The content cannot be trusted: a reader refuses the file.
    Error,
    /// The standard forbids it, but the meaning is clear: readers continue; lint reports it.
    Warning,
}

/// A broken rule of a format.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("line {line}, column {column}: {message} [{rule}]")]
pub struct Finding {
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1, counted in bytes.
    pub column: usize,
    /// Short name of the rule, stable across versions.
    pub rule: &'static str,
    /// The violation and the requirement.
    pub message: String,
    /// Whether a reader can continue.
    pub severity: Severity,
}

/// A list of findings that stops growing at a limit, so that a hostile file costs no memory.
#[derive(Debug)]
pub struct FindingList {
    limit: usize,
    keeps_warnings: bool,
    found: Vec<Finding>,
}

impl FindingList {
    /// For a linter: errors and warnings, up to `limit` of them.
    #[must_use]
    pub fn of_linter(limit: usize) -> Self {
        Self {
            limit,
            keeps_warnings: true,
            found: Vec::new(),
        }
    }

    /// For a reader: the first error.
    pub(crate) fn of_reader() -> Self {
        Self {
            limit: 1,
            keeps_warnings: false,
            found: Vec::new(),
        }
    }

    /// Whether the list takes no more: a parser may stop.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.found.len() >= self.limit
    }

    /// Whether there is an error among them.
    pub(crate) fn has_errors(&self) -> bool {
        let mut found = self.found.iter();
        found.any(|finding| finding.severity == Severity::Error)
    }

    /// Adds an error, unless the list is full.
    pub(crate) fn error(
        &mut self,
        place: (usize, usize),
        rule: &'static str,
        message: impl Into<String>,
    ) {
        self.add(place, rule, message.into(), Severity::Error);
    }

    /// Adds a warning, if the list keeps them and is not full.
    pub(crate) fn warning(
        &mut self,
        place: (usize, usize),
        rule: &'static str,
        message: impl Into<String>,
    ) {
        if self.keeps_warnings {
            self.add(place, rule, message.into(), Severity::Warning);
        }
    }

    fn add(
        &mut self,
        (line, column): (usize, usize),
        rule: &'static str,
        message: String,
        severity: Severity,
    ) {
        if !self.is_full() {
            self.found.push(Finding {
                line,
                column,
                rule,
                message,
                severity,
            });
        }
    }

    /// The findings, in the order of the file.
    #[must_use]
    pub fn into_vec(self) -> Vec<Finding> {
        self.found
    }

    /// `value` if a reader can continue with it.
    pub(crate) fn unless_error<T>(self, value: T) -> Result<T, crate::formats::ReadError> {
        let mut errors = self
            .found
            .into_iter()
            .filter(|f| f.severity == Severity::Error);
        match errors.next() {
            None => Ok(value),
            Some(first) => Err(first.into()),
        }
    }
}
