//! Findings in a file: what is wrong, where, and which rule it breaks.

use std::fmt;
use thiserror::Error;

/// The severity of a broken rule.
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

/// Maximum number of names listed for each kind of part that is left out.
const MOST_NAMES: usize = 5;

/// Parts of a file that a reader skips, counted so that none is skipped silently.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct LeftOut {
    kinds: Vec<LeftOutKind>,
}

/// Parts of one kind.
#[derive(Debug, Clone, PartialEq, Eq)]
struct LeftOutKind {
    what: &'static str,
    count: usize,
    /// Names of the first few.
    names: Vec<String>,
}

impl LeftOut {
    /// Whether everything has been read.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// Number of parts.
    #[must_use]
    pub fn count(&self) -> usize {
        self.kinds.iter().map(|kind| kind.count).sum()
    }

    /// Adds a part of the kind `what`.
    pub(crate) fn add(&mut self, what: &'static str, name: &str) {
        let kind = match self.kinds.iter_mut().position(|kind| kind.what == what) {
            Some(at) => &mut self.kinds[at],
            None => {
                let (count, names) = (0, Vec::new());
                self.kinds.push(LeftOutKind { what, count, names });
                let last = self.kinds.len() - 1;
                &mut self.kinds[last]
            }
        };
        kind.count += 1;
        if kind.names.len() < MOST_NAMES {
            kind.names.push(name.to_owned());
        }
    }
}

impl fmt::Display for LeftOut {
    /// `left out: 3 (message: opm, tdm; packet without position: SAT-C)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "left out: {} (", self.count())?;
        for (n, kind) in self.kinds.iter().enumerate() {
            let separator = if n == 0 { "" } else { "; " };
            write!(f, "{separator}{}: {}", kind.what, kind.names.join(", "))?;
            let more = kind.count - kind.names.len();
            if more > 0 {
                write!(f, " and {more} more")?;
            }
        }
        write!(f, ")")
    }
}

/// A list of findings that stops growing at a limit, so that a hostile file cannot exhaust memory.
#[derive(Debug)]
pub struct FindingList {
    limit: usize,
    keeps_warnings: bool,
    found: Vec<Finding>,
    left_out: LeftOut,
}

impl FindingList {
    /// For a linter: errors and warnings, up to `limit` of them.
    #[must_use]
    pub fn of_linter(limit: usize) -> Self {
        Self {
            limit,
            keeps_warnings: true,
            found: Vec::new(),
            left_out: LeftOut::default(),
        }
    }

    /// For a reader: the first error.
    pub(crate) fn of_reader() -> Self {
        Self {
            limit: 1,
            keeps_warnings: false,
            found: Vec::new(),
            left_out: LeftOut::default(),
        }
    }

    /// Whether the list is full, so that a parser may stop.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.found.len() >= self.limit
    }

    /// Whether any finding is an error.
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

    /// Records that a part of the file is skipped although it breaks no rule: a linter warns of it, and a reader
    /// reports it at the end. `what` is its kind, as in `message` or `packet without position`.
    pub(crate) fn leave_out(&mut self, place: (usize, usize), what: &'static str, name: &str) {
        let message = format!("{what} {name} is not read");
        self.warning(place, "left-out", message);
        self.left_out.add(what, name);
    }

    /// Records that the file breaks no rule but cannot be read here: a linter warns of it, and a reader refuses
    /// the file.
    pub(crate) fn unsupported(&mut self, place: (usize, usize), message: impl Into<String>) {
        self.warning(place, "unsupported", message);
    }

    /// Records that a part of the file is skipped because it is not a satellite: a linter does not warn of it,
    /// but a reader reports it at the end.
    pub(crate) fn pass_over(&mut self, what: &'static str, name: &str) {
        self.left_out.add(what, name);
    }

    /// The parts left out so far.
    #[must_use]
    pub fn left_out(&self) -> &LeftOut {
        &self.left_out
    }

    /// The first error.
    pub(crate) fn first_error(&self) -> Option<&Finding> {
        let mut found = self.found.iter();
        found.find(|finding| finding.severity == Severity::Error)
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

    /// `value`, or the first error.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_out_is_counted_and_named() {
        let mut findings = FindingList::of_reader();
        assert!(findings.left_out().is_empty());
        findings.leave_out((3, 1), "message", "opm");
        for n in 1..=7 {
            findings.leave_out((4 + n, 1), "packet without position", &format!("S{n}"));
        }
        let told = findings.left_out().to_string();
        let expected =
            "left out: 8 (message: opm; packet without position: S1, S2, S3, S4, S5 and 2 more)";
        assert_eq!(told, expected);
        assert!(findings.into_vec().is_empty());
        let mut findings = FindingList::of_linter(10);
        findings.leave_out((3, 1), "message", "opm");
        let found = findings.into_vec();
        assert_eq!((found[0].line, found[0].rule), (3, "left-out"));
        assert_eq!(found[0].severity, Severity::Warning);
    }
}
