//! The paper's Table II as checks with gates: the numbers and verdicts of `reproduce`.

use super::{Check, CheckedQuantity, Findings};
use crate::evaluate::Setup;
use crate::study::Statement;
use crate::study::paper::{self, JudgedRow, PaperError, Scheme};

/// Table II compared with the paper, each row as printed.
///
/// Gates apply to what is known to be reproduced: N̄ of the rows whose inclination is not misprinted,
/// and mean PDOP of the paper's own designs. The rest is reported with the verdict of the study.
///
/// # Errors
/// If a design cannot be propagated under the given setup.
pub fn against_paper(setup: &Setup) -> Result<Findings, PaperError> {
    let rows = paper::judged_table2(setup)?;
    let checks = rows.iter().flat_map(|judged| {
        let visible = Some(visible_check(judged));
        visible.into_iter().chain(pdop_check(judged))
    });
    Ok(Findings {
        checks: checks.collect(),
        ..Findings::default()
    })
}

fn visible_check(judged: &JudgedRow) -> Check {
    let row = &judged.row;
    let as_printed = row.fitting_inclination_deg.is_none();
    let reason = if as_printed {
        "half a digit of Table II, plus the effect of the epoch and time step, which the paper does not state; one mask, fitted to this column, reproduces six of its rows".to_owned()
    } else {
        reported(&judged.mean_visible)
    };
    Check::new(
        &format!("paper/{}/mean-visible", row.name()),
        CheckedQuantity {
            quantity: "mean visible satellites as printed, minus the paper's",
            unit: "1",
            statistic: "difference",
        },
        judged.mean_visible.ours.unwrap_or(f64::NAN) - row.mean_visible,
        as_printed.then_some(paper::VISIBLE_TOLERANCE),
        &reason,
    )
}

fn pdop_check(judged: &JudgedRow) -> Option<Check> {
    let row = &judged.row;
    let mean_pdop = judged.mean_pdop.ours?;
    let own = row.scheme == Scheme::Proposed;
    let reason = if own {
        "effect of the GNSS slots and the epoch, which the paper does not state".to_owned()
    } else {
        reported(&judged.mean_pdop)
    };
    Some(Check::new(
        &format!("paper/{}/mean-pdop", row.name()),
        CheckedQuantity {
            quantity: "mean PDOP as printed, over the paper's, minus 1",
            unit: "%",
            statistic: "relative difference",
        },
        100.0 * (mean_pdop / row.mean_pdop - 1.0),
        own.then_some(paper::PDOP_TOLERANCE_PERCENT),
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
        let setup = scenario
            .setup(&|_| unreachable!("the paper's scenario names no file"))
            .unwrap();
        against_paper(&setup).unwrap()
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
