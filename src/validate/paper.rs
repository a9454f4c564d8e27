//! The paper's tables as checks with gates: the numbers and verdicts of `reproduce`.

use super::{Check, CheckedQuantity, Findings};
use crate::scenario::Scenario;
use crate::study::Statement;
use crate::study::published::{
    JudgedRow, PublishedStudy, StudyFileError, StudyRunError, builtin_study,
};
use std::io;
use thiserror::Error;

/// The study with the tables.
const STUDY: &str = "paper";

/// Why the tables cannot be compared.
#[derive(Debug, Error)]
pub enum PaperError {
    /// The built-in study is not there.
    #[error(transparent)]
    Unknown(#[from] crate::keyword::UnknownKeyword),
    /// The built-in study cannot be read.
    #[error(transparent)]
    File(#[from] StudyFileError),
    /// It cannot be computed under the scenario.
    #[error(transparent)]
    Run(#[from] StudyRunError),
}

/// The paper's table of designs compared with ours under a scenario, each row as printed; `read` gives the bytes of a
/// file that the scenario names.
///
/// Gates apply to what the study says is known to be reproduced. The rest is reported with its verdict.
///
/// # Errors
/// If a design cannot be propagated under the scenario.
pub fn against_paper(
    scenario: &Scenario,
    read: &dyn Fn(&str) -> io::Result<Vec<u8>>,
) -> Result<Findings, PaperError> {
    let study = PublishedStudy::parse(STUDY, builtin_study(STUDY)?)?;
    let rows = study.judged_rows(scenario, read)?;
    Ok(Findings {
        checks: rows.iter().filter_map(check).collect(),
        ..Findings::default()
    })
}

/// The check of a number; `None` if we have none, and none is gated.
fn check(judged: &JudgedRow) -> Option<Check> {
    let ours = judged.statement.ours;
    if ours.is_none() && !judged.is_gated {
        return None;
    }
    let ours = ours.unwrap_or(f64::NAN);
    let column = &judged.column;
    let (quantity, value, gate, unit, statistic) = match judged.tolerance_percent {
        Some(percent) => (
            format!("{column} as printed, over the paper's, minus 1"),
            100.0 * (ours / judged.published - 1.0),
            percent,
            "%",
            "relative difference",
        ),
        None => (
            format!("{column} as printed, minus the paper's"),
            ours - judged.published,
            judged.tolerance,
            "1",
            "difference",
        ),
    };
    let reason = match (&judged.reason, judged.is_gated) {
        (Some(reason), true) => reason.clone(),
        (None, true) => "the tolerance of the study".to_owned(),
        _ => reported(&judged.statement),
    };
    Some(Check::new(
        &format!("{STUDY}/{}/{}", judged.row, judged.metric),
        CheckedQuantity {
            quantity: &quantity,
            unit,
            statistic,
        },
        value,
        judged.is_gated.then_some(gate),
        &reason,
    ))
}

/// Why a line has no gate: the verdict of the study, with its assumption.
fn reported(statement: &Statement) -> String {
    let under = match (&statement.assumption, statement.ours_there) {
        (Some(assumption), Some(there)) => format!(" with {assumption}: {there:.4}"),
        _ => String::new(),
    };
    format!("reported only: {}{under}", statement.verdict)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{Scenario, builtin};
    use crate::validate::Outcome;

    fn findings(overrides: &[&str]) -> Findings {
        let text = builtin("paper").unwrap();
        // Ten-minute samples give N̄ within 0.003 of one-minute samples.
        let overrides = [&["time.step-s=600"], overrides].concat();
        let scenario = Scenario::parse("paper", text.as_bytes(), &overrides).unwrap();
        against_paper(&scenario, &|_| {
            unreachable!("the paper's scenario names no file")
        })
        .unwrap()
    }

    fn of_quantity<'a>(
        findings: &'a Findings,
        quantity: &'a str,
    ) -> impl Iterator<Item = &'a Check> {
        let gated = findings.checks.iter().filter(|check| check.gate.is_some());
        gated.filter(move |check| check.name.ends_with(quantity))
    }

    #[test]
    fn validate_the_tables_of_the_paper() {
        let findings = findings(&[]);
        let failed: Vec<_> = findings.failures().collect();
        assert!(failed.is_empty(), "{failed:?}");
        assert_eq!(findings.checks.len(), 22);
        assert_eq!(of_quantity(&findings, "mean-visible").count(), 6);
        assert_eq!(of_quantity(&findings, "mean-pdop").count(), 3);
        let baseline = |check: &&Check| check.name == "paper/polar-3/mean-pdop";
        let baseline = findings.checks.iter().find(baseline).unwrap();
        assert_eq!(baseline.outcome(), Outcome::Info);
        assert!(
            baseline.reason.contains("met-under-assumption"),
            "{baseline:?}"
        );
    }

    /// Every gate can be missed: another mask misses all N̄, shared clocks all mean PDOP.
    #[test]
    fn other_assumptions_miss_the_gates() {
        for (assumption, quantity) in [
            ("visibility.mask-deg=8", "mean-visible"),
            ("gnss.clocks=\"shared\"", "mean-pdop"),
        ] {
            let findings = findings(&[assumption]);
            for check in of_quantity(&findings, quantity) {
                assert_eq!(check.outcome(), Outcome::Fail, "{assumption}: {check:?}");
            }
        }
    }
}
