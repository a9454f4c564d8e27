//! Tables of the phases of a build-up or a drawdown: which satellites are put into service and taken out, phase by phase.
//!
//! CSV with the columns `phase` (a date or any other name) and `add` or `remove` or both, whose cells hold names separated by
//! spaces. Rows are in the order of time; lines that begin with `#` are comments.

use crate::printable::printable;
use std::collections::BTreeSet;
use thiserror::Error;

/// A phase, from the one before it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeploymentStep {
    /// Its name.
    pub phase: String,
    /// What is put into service.
    pub added: Vec<String>,
    /// What is taken out of service.
    pub removed: Vec<String>,
    /// The line, from 1.
    pub line: u64,
}

/// What is wrong with a table of phases.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("line {line}: {reason}")]
pub struct DeploymentFileError {
    /// The line, from 1.
    pub line: u64,
    /// What was found, and what is expected.
    pub reason: String,
}

fn at(line: u64, reason: impl Into<String>) -> DeploymentFileError {
    DeploymentFileError {
        line,
        reason: reason.into(),
    }
}

/// Reads a table.
///
/// # Errors
/// If a column is missing or unknown, a phase has no name or that of another, or the table has no phase.
pub fn read(bytes: &[u8]) -> Result<Vec<DeploymentStep>, DeploymentFileError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let text = std::str::from_utf8(bytes).map_err(|_| at(1, "not UTF-8"))?;
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let unreadable = |error: csv::Error| {
        let line = error.position().map_or(1, csv::Position::line);
        at(line, error.to_string())
    };
    let [phase, add, remove] = columns(reader.headers().map_err(unreadable)?)?;
    let mut steps: Vec<DeploymentStep> = Vec::new();
    let mut known = BTreeSet::new();
    for row in reader.records() {
        let row = row.map_err(unreadable)?;
        let line = row
            .position()
            .map_or(1, |position| super::outages::line_of(position, text));
        let cell = |column: Option<usize>| column.and_then(|n| row.get(n)).unwrap_or_default();
        let names = |column| cell(column).split_whitespace().map(str::to_owned).collect();
        let step = DeploymentStep {
            phase: cell(phase).to_owned(),
            added: names(add),
            removed: names(remove),
            line,
        };
        if step.phase.is_empty() {
            return Err(at(line, "no name of the phase"));
        }
        if !known.insert(step.phase.clone()) {
            let name = printable(&step.phase);
            return Err(at(line, format!("a second phase '{name}'")));
        }
        steps.push(step);
    }
    if steps.is_empty() {
        return Err(at(1, "the table has no phase"));
    }
    Ok(steps)
}

/// The places of the columns `phase`, `add` and `remove`.
fn columns(header: &csv::StringRecord) -> Result<[Option<usize>; 3], DeploymentFileError> {
    const COLUMNS: [&str; 3] = ["phase", "add", "remove"];
    let expected = "expected phase, and add or remove or both";
    if let Some(other) = header.iter().find(|one| !COLUMNS.contains(one)) {
        return Err(at(
            1,
            format!("found the column '{}', {expected}", printable(other)),
        ));
    }
    let places = COLUMNS.map(|name| header.iter().position(|one| one == name));
    match places {
        [Some(_), Some(_), _] | [Some(_), _, Some(_)] => Ok(places),
        [None, ..] => Err(at(1, format!("no column phase; {expected}"))),
        _ => Err(at(1, format!("no column add or remove; {expected}"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_are_read_in_their_order() {
        let text = "\u{feff}phase,add,remove\n# the first launch\n2026-03-01,NW-P01 NW-P02,\n\n2026-06-01,NW-P03,NW-P01-S02\n";
        let steps = read(text.as_bytes()).unwrap();
        assert_eq!(steps[0].added, ["NW-P01", "NW-P02"]);
        assert_eq!((steps[0].line, steps[1].line), (3, 5));
        assert_eq!(
            (steps[1].phase.as_str(), &steps[1].removed[..]),
            ("2026-06-01", &["NW-P01-S02".to_owned()][..])
        );
        assert_eq!(
            read(b"remove,phase\nNW-P01,end\n").unwrap()[0].removed,
            ["NW-P01"]
        );
    }

    #[test]
    fn bad_tables_are_told_with_the_line() {
        for (text, expected) in [
            ("phase,add\n", "line 1: the table has no phase"),
            (
                "phase\na\n",
                "line 1: no column add or remove; expected phase, and add or remove or both",
            ),
            (
                "add\na\n",
                "line 1: no column phase; expected phase, and add or remove or both",
            ),
            (
                "phase,ad\na,b\n",
                "line 1: found the column 'ad', expected phase, and add or remove or both",
            ),
            ("phase,add\na,b\n\n,c\n", "line 4: no name of the phase"),
            ("phase,add\na,b\na,c\n", "line 3: a second phase 'a'"),
        ] {
            assert_eq!(read(text.as_bytes()).unwrap_err().to_string(), expected);
        }
        assert!(
            read(b"phase,add\na,b,c\n")
                .unwrap_err()
                .to_string()
                .starts_with("line 2: ")
        );
        assert_eq!(read(b"\xff").unwrap_err().to_string(), "line 1: not UTF-8");
    }
}
