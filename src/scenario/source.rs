//! The source texts of a scenario, and positions in them.

use crate::printable::is_obeyed;
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::rc::Rc;

/// Characters of a source line shown around a problem; longer lines are cut.
const EXCERPT_WIDTH: usize = 96;
/// Characters shown before the problem if a line is cut.
const EXCERPT_LEAD: usize = 32;
/// Characters of an offending value repeated in a message.
const FOUND_WIDTH: usize = 60;

/// A scenario file, or the value of one `--set` argument.
#[derive(Debug)]
pub(super) struct Source<'a> {
    kind: Kind<'a>,
    text: &'a str,
}

/// The sources of values within the table of a key, by dotted path, where they are not the source of the table.
pub(super) type TableSources<'a> = BTreeMap<String, Rc<Source<'a>>>;

#[derive(Debug)]
enum Kind<'a> {
    File {
        label: &'a str,
        line_starts: Vec<usize>,
    },
    Argument {
        whole: &'a str,
        index: usize,
    },
}

/// Where a problem is.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// In a file.
    File {
        /// The file as named by the caller.
        label: String,
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// The line itself.
        excerpt: Excerpt,
    },
    /// In a `--set` argument.
    Argument {
        /// Which one, from 0.
        index: usize,
        /// The argument, `key.path=value`.
        text: String,
    },
}

/// A source line, cut to a readable width, and the relevant part of it.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Excerpt {
    /// The text of the line without control characters.
    pub text: String,
    /// Characters before the relevant part.
    pub offset: usize,
    /// Length of that part in characters, at least 1.
    pub length: usize,
}

impl<'a> Source<'a> {
    pub(super) fn file(label: &'a str, text: &'a str) -> Self {
        let after_breaks = text.match_indices('\n').map(|(at, _)| at + 1);
        let line_starts = std::iter::once(0).chain(after_breaks).collect();
        Self {
            kind: Kind::File { label, line_starts },
            text,
        }
    }

    /// The part `text` of the `index`-th `--set` argument `whole`.
    pub(super) fn argument(index: usize, whole: &'a str, text: &'a str) -> Self {
        Self {
            kind: Kind::Argument { whole, index },
            text,
        }
    }

    pub(super) fn is_file(&self) -> bool {
        matches!(self.kind, Kind::File { .. })
    }

    pub(super) fn place(&self, span: Range<usize>) -> Place {
        match &self.kind {
            Kind::Argument { whole, index } => Place::Argument {
                index: *index,
                text: (*whole).to_owned(),
            },
            Kind::File { label, line_starts } => {
                let line = line_starts
                    .partition_point(|start| *start <= span.start)
                    .max(1);
                let start = line_starts[line - 1];
                let rest = self.text.get(start..).unwrap_or_default();
                let (column, excerpt) = excerpt(rest, span.start - start, span.len());
                Place::File {
                    label: (*label).to_owned(),
                    line,
                    column,
                    excerpt,
                }
            }
        }
    }

    /// The text at `span` on one line, shortened if long.
    pub(super) fn written(&self, span: Range<usize>) -> String {
        let text = self.text.get(span).unwrap_or_default().trim();
        let mut shown: String = blanked(text).take(FOUND_WIDTH).collect();
        if text.chars().nth(FOUND_WIDTH).is_some() {
            shown.push('…');
        }
        shown
    }
}

/// The characters of a text, with spaces for those that a terminal would obey: unlike escapes they leave each column
/// where it is.
pub(super) fn blanked(text: &str) -> impl Iterator<Item = char> {
    text.chars().map(|c| if is_obeyed(c) { ' ' } else { c })
}

/// The column and the excerpt for `length` bytes at byte `at` of the first line of `text`.
fn excerpt(text: &str, at: usize, length: usize) -> (usize, Excerpt) {
    let line = text.lines().next().unwrap_or_default();
    let characters = |range: Range<usize>| {
        let starts = line.char_indices().map(|(start, _)| start);
        starts.filter(|start| range.contains(start)).count()
    };
    let before = characters(0..at);
    let cut = if line.chars().count() > EXCERPT_WIDTH {
        before.saturating_sub(EXCERPT_LEAD)
    } else {
        0
    };
    let shown: String = blanked(line).skip(cut).take(EXCERPT_WIDTH).collect();
    let offset = before - cut;
    let visible = shown.chars().count().saturating_sub(offset);
    let length = characters(at..at.saturating_add(length))
        .min(visible)
        .max(1);
    let excerpt = Excerpt {
        text: shown.trim_end().to_owned(),
        offset,
        length,
    };
    (before + 1, excerpt)
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File { label, line, .. } => write!(f, "{label}:{line}"),
            Self::Argument { text, .. } => write!(f, "--set {text}"),
        }
    }
}
