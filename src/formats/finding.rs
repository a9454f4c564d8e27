//! What a reader objects to in a file: where it stands and which rule it breaks.

use thiserror::Error;

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
    /// What is wrong, and what the rule asks for.
    pub message: String,
}

/// A list of findings that stops growing at a limit, so that a hostile file costs no memory.
#[derive(Debug)]
pub struct Findings {
    limit: usize,
    found: Vec<Finding>,
}

impl Findings {
    /// An empty list that takes up to `limit` findings.
    #[must_use]
    pub fn with_limit(limit: usize) -> Self {
        Self {
            limit,
            found: Vec::new(),
        }
    }

    /// Whether the list takes no more: a reader may stop.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.found.len() >= self.limit
    }

    /// Adds a finding, unless the list is full.
    pub(crate) fn add(
        &mut self,
        (line, column): (usize, usize),
        rule: &'static str,
        message: impl Into<String>,
    ) {
        if !self.is_full() {
            self.found.push(Finding {
                line,
                column,
                rule,
                message: message.into(),
            });
        }
    }

    /// The findings, in the order of the file.
    #[must_use]
    pub fn into_vec(self) -> Vec<Finding> {
        self.found
    }

    /// `value` if nothing was found.
    pub(crate) fn unless_any<T>(self, value: T) -> Result<T, super::ReadError> {
        match self.found.into_iter().next() {
            None => Ok(value),
            Some(first) => Err(first.into()),
        }
    }
}
