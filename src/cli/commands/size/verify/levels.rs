//! The rows of a certificate against the designs of the grid, one number of satellites at a time, so that what is wrong
//! with one says nothing about the next.

use crate::constellation::Design;
use crate::run::size::SizeResult;
use crate::search::size::SizeProblem;
use crate::units::counted;
use anyhow::Result;
use std::collections::BTreeSet;

/// The comparison on its way through the certificate.
pub(super) struct CertificateLevels<'a> {
    problem: &'a SizeProblem<'a>,
    result: &'a SizeResult,
    /// Rows to be evaluated, from 0, ascending.
    drawn: std::vec::IntoIter<usize>,
    next_drawn: Option<usize>,
    row: usize,
    /// The number of satellites of the rows that are read.
    satellites: Option<usize>,
    /// Their designs.
    notations: Vec<String>,
    /// Those that were compared.
    compared: BTreeSet<usize>,
    checked: CheckedCertificate,
}

/// What the comparison gives.
#[derive(Default)]
pub(super) struct CheckedCertificate {
    /// What is wrong.
    pub(super) findings: Vec<String>,
    /// The designs of the rows that were drawn.
    pub(super) drawn: Vec<Design>,
    /// Designs of the grid that the result neither rejects nor names: so they must keep the constraints.
    pub(super) unlisted: Vec<Design>,
}

impl<'a> CertificateLevels<'a> {
    pub(super) fn new(
        problem: &'a SizeProblem<'a>,
        result: &'a SizeResult,
        drawn: Vec<usize>,
    ) -> Self {
        let mut drawn = drawn.into_iter();
        Self {
            problem,
            result,
            next_drawn: drawn.next(),
            drawn,
            row: 0,
            satellites: None,
            notations: Vec::new(),
            compared: BTreeSet::new(),
            checked: CheckedCertificate::default(),
        }
    }

    /// Takes a row.
    pub(super) fn see(&mut self, line: &str) -> Result<()> {
        let row = self.row;
        self.row += 1;
        let Some((satellites, notation)) = certified(line) else {
            let finding = format!("not a row of a certificate: {line}");
            self.checked.findings.push(finding);
            return Ok(());
        };
        if self.satellites != Some(satellites) {
            self.compare()?;
            self.satellites = Some(satellites);
        }
        // Points that are not designs have rows too.
        if let Ok(design) = notation.parse::<Design>() {
            if self.next_drawn == Some(row) {
                self.checked.drawn.push(design);
            }
            self.notations.push(notation);
        }
        if self.next_drawn == Some(row) {
            self.next_drawn = self.drawn.next();
        }
        Ok(())
    }

    /// The comparison of all numbers of satellites that the search completed.
    pub(super) fn finish(mut self) -> Result<CheckedCertificate> {
        self.compare()?;
        let last = self.result.above.iter().map(|level| level.satellites).max();
        let last = last.or(self.result.fewest).unwrap_or(usize::MAX);
        for satellites in self.problem.numbers() {
            if satellites <= last && !self.compared.contains(&satellites) {
                self.satellites = Some(satellites);
                self.compare()?;
            }
        }
        Ok(self.checked)
    }

    /// Compares the rows since the number of satellites changed with the designs of the grid.
    fn compare(&mut self) -> Result<()> {
        let found = std::mem::take(&mut self.notations);
        let Some(satellites) = self.satellites.take() else {
            return Ok(());
        };
        if !self.compared.insert(satellites) {
            let finding = format!("rows of {satellites} satellites are in two places");
            self.checked.findings.push(finding);
            return Ok(());
        }
        let designs = self
            .problem
            .designs_of(satellites)
            .collect::<Result<Vec<_>, _>>()?;
        let expected: Vec<String> = designs.iter().map(ToString::to_string).collect();
        let rows: BTreeSet<&str> = found.iter().map(String::as_str).collect();
        let grid: BTreeSet<&str> = expected.iter().map(String::as_str).collect();
        let of_level = format!("with {satellites} satellites");
        let foreign = found.iter().filter(|one| !grid.contains(one.as_str()));
        self.tell(foreign, &format!("no design of the grid {of_level}"));
        let kept = self
            .result
            .designs
            .iter()
            .map(|one| one.design.notation.as_str());
        let kept: BTreeSet<&str> = match self.result.fewest == Some(satellites) {
            true => kept.collect(),
            false => BTreeSet::new(),
        };
        let both = found.iter().filter(|one| kept.contains(one.as_str()));
        self.tell(both, &format!("both rejected and in the result {of_level}"));
        let is_unlisted = |one: &str| !rows.contains(one) && !kept.contains(one);
        let unlisted = expected.iter().filter(|one| is_unlisted(one));
        let above = self
            .result
            .above
            .iter()
            .find(|level| level.satellites == satellites);
        match above {
            None => self.tell(unlisted, &format!("without a proof {of_level}")),
            Some(level) => {
                let unlisted: BTreeSet<&str> = unlisted.map(String::as_str).collect();
                if unlisted.len() as u64 != level.kept {
                    self.checked.findings.push(format!(
                        "{} {of_level} {} without a proof, but the result says that {} keep the constraints",
                        counted(unlisted.len(), "design"),
                        if unlisted.len() == 1 { "is" } else { "are" },
                        level.kept
                    ));
                }
                let of_grid = designs.into_iter().zip(&expected);
                let unlisted = of_grid.filter(|(_, name)| unlisted.contains(name.as_str()));
                self.checked
                    .unlisted
                    .extend(unlisted.map(|(design, _)| design));
            }
        }
        let in_order = expected.iter().filter(|one| rows.contains(one.as_str()));
        let of_grid = found.iter().filter(|one| grid.contains(one.as_str()));
        if !in_order.eq(of_grid) {
            let finding =
                format!("the rows {of_level} are repeated or not in the order of the grid");
            self.checked.findings.push(finding);
        }
        Ok(())
    }

    /// Tells what some designs are, and the first of them.
    fn tell<'n>(&mut self, designs: impl Iterator<Item = &'n String>, what: &str) {
        let mut designs = designs.peekable();
        let Some(first) = designs.peek().copied() else {
            return;
        };
        let count = counted(designs.count(), "design");
        let finding = format!("{count} {what}, the first is {first}");
        self.checked.findings.push(finding);
    }
}

/// Satellites and notation of a row.
fn certified(line: &str) -> Option<(usize, String)> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(line.as_bytes());
    let record = reader.records().next()?.ok()?;
    Some((record.get(0)?.parse().ok()?, record.get(1)?.to_owned()))
}
