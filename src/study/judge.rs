//! The rule that decides whether a statement of the paper is met.

use crate::keyword::{Keyword, keywords};
use serde::{Serialize, Serializer};

keywords! {
    /// Verdict on a statement.
    Verdict {
        /// True under the assumptions of the scenario, none of which was derived from it.
        Met = "met",
        /// True with one assumption changed, which was not derived from it.
        MetUnderAssumption = "met-under-assumption",
        /// True, but used to find the assumption under which it is: no evidence.
        Fitted = "fitted",
        /// A parameter copied from the paper: no evidence either.
        Input = "input",
        /// True under no assumption tried.
        NotMet = "not-met",
        /// No number could be computed to compare it with.
        Unconfirmed = "unconfirmed",
    }
}

/// How the study came by what a statement is judged with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::study) enum Provenance {
    /// Copied from the paper.
    Input,
    /// Assumptions were fitted to the quantity, or to what it follows from.
    Fitted,
    /// Computed, without a look at the paper's number.
    Computed,
}

impl Serialize for Verdict {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.keyword())
    }
}

/// What the paper says about a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Expected {
    /// A number and the tolerance around it.
    Value {
        /// The number.
        value: f64,
        /// The largest difference.
        tolerance: f64,
    },
    /// At least this value.
    AtLeast(f64),
    /// More than this value.
    MoreThan(f64),
}

impl Expected {
    /// Whether `found` agrees with the paper; never true for NaN.
    pub(in crate::study) fn holds(self, found: f64) -> bool {
        match self {
            Self::Value { value, tolerance } => (found - value).abs() <= tolerance,
            Self::AtLeast(bound) => found >= bound,
            Self::MoreThan(bound) => found > bound,
        }
    }
}

/// One statement of the paper with its verdict.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Statement {
    /// Where the paper says it.
    pub place: String,
    /// What is stated.
    pub statement: String,
    /// Unit of the numbers.
    pub unit: String,
    /// What the paper says.
    pub expected: Expected,
    /// Our value under the assumptions of the scenario.
    pub ours: Option<f64>,
    /// The verdict.
    pub verdict: Verdict,
    /// The changed assumption under which it is met, if it is not met with the scenario unchanged.
    pub assumption: Option<String>,
    /// Our value under that assumption.
    pub ours_there: Option<f64>,
}

/// A number under a named assumption.
pub(in crate::study) struct OtherAssumption<'a> {
    pub(in crate::study) assumption: &'a str,
    pub(in crate::study) found: Option<f64>,
}

/// Judges a statement. It holds if true under the scenario, or else under any of `others`, of which
/// the one with the smallest difference is named (the first of equals). A statement that holds is
/// met, unless its provenance makes it no evidence; one without any number is unconfirmed.
pub(in crate::study) fn judge(
    [place, statement, unit]: [&str; 3],
    provenance: Provenance,
    expected: Expected,
    ours: Option<f64>,
    others: &[OtherAssumption<'_>],
) -> Statement {
    let right = |found: Option<f64>| found.is_some_and(|found| expected.holds(found));
    let away = |other: &&OtherAssumption<'_>| match (expected, other.found) {
        (Expected::Value { value, .. }, Some(found)) => (found - value).abs(),
        // All values past the bound count equally.
        _ => 0.0,
    };
    let there = if right(ours) {
        None
    } else {
        let holds = others.iter().filter(|other| right(other.found));
        holds.min_by(|a, b| away(a).total_cmp(&away(b)))
    };
    let is_number = |found: Option<f64>| found.is_some_and(f64::is_finite);
    let verdict = match (right(ours), there, provenance) {
        (false, None, _) if !is_number(ours) && !others.iter().any(|o| is_number(o.found)) => {
            Verdict::Unconfirmed
        }
        (false, None, _) => Verdict::NotMet,
        (_, _, Provenance::Input) => Verdict::Input,
        (_, _, Provenance::Fitted) => Verdict::Fitted,
        (true, _, Provenance::Computed) => Verdict::Met,
        (false, Some(_), Provenance::Computed) => Verdict::MetUnderAssumption,
    };
    Statement {
        place: place.to_owned(),
        statement: statement.to_owned(),
        unit: unit.to_owned(),
        expected,
        ours,
        verdict,
        assumption: there.map(|other| other.assumption.to_owned()),
        ours_there: there.and_then(|other| other.found),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ABOUT_TWO: Expected = Expected::Value {
        value: 2.0,
        tolerance: 0.1,
    };

    fn judged_as(
        provenance: Provenance,
        expected: Expected,
        ours: Option<f64>,
        others: &[Option<f64>],
    ) -> Statement {
        let names = ["a", "b", "c"];
        let others: Vec<_> = (names.iter().zip(others))
            .map(|(assumption, &found)| OtherAssumption { assumption, found })
            .collect();
        judge(["", "", ""], provenance, expected, ours, &others)
    }

    fn judged(expected: Expected, ours: Option<f64>, others: &[Option<f64>]) -> Statement {
        judged_as(Provenance::Computed, expected, ours, others)
    }

    #[test]
    fn verdicts_follow_the_numbers() {
        assert_eq!(judged(ABOUT_TWO, Some(2.05), &[]).verdict, Verdict::Met);
        let line = judged(ABOUT_TWO, Some(2.2), &[None, Some(2.09), Some(2.01)]);
        assert_eq!(line.verdict, Verdict::MetUnderAssumption);
        assert_eq!(
            (line.assumption.as_deref(), line.ours_there),
            (Some("c"), Some(2.01))
        );
        let line = judged(ABOUT_TWO, None, &[Some(2.2), Some(f64::NAN)]);
        assert_eq!((line.verdict, line.assumption), (Verdict::NotMet, None));
    }

    /// Numbers that were copied or fitted are distinguished from those computed, and from those not met.
    #[test]
    fn verdicts_follow_the_provenance() {
        let verdict = |provenance, ours, others: &[Option<f64>]| {
            judged_as(provenance, ABOUT_TWO, ours, others).verdict
        };
        for (provenance, verdict_if_it_holds) in [
            (Provenance::Input, Verdict::Input),
            (Provenance::Fitted, Verdict::Fitted),
            (Provenance::Computed, Verdict::Met),
        ] {
            assert_eq!(verdict(provenance, Some(2.05), &[]), verdict_if_it_holds);
            assert_eq!(verdict(provenance, Some(2.2), &[]), Verdict::NotMet);
            assert_eq!(verdict(provenance, None, &[None]), Verdict::Unconfirmed);
        }
        let elsewhere = verdict(Provenance::Fitted, Some(2.2), &[Some(2.0)]);
        assert_eq!(elsewhere, Verdict::Fitted);
        let nowhere = verdict(Provenance::Computed, Some(f64::NAN), &[]);
        assert_eq!(nowhere, Verdict::Unconfirmed);
    }

    #[test]
    fn bounds_include_or_exclude_themselves() {
        let verdict = |expected, ours| judged(expected, Some(ours), &[]).verdict;
        assert_eq!(verdict(Expected::AtLeast(0.0), 0.0), Verdict::Met);
        assert_eq!(verdict(Expected::MoreThan(0.0), 0.0), Verdict::NotMet);
        assert_eq!(verdict(Expected::MoreThan(0.0), 1e-9), Verdict::Met);
        assert_eq!(verdict(Expected::AtLeast(95.0), 94.0), Verdict::NotMet);
    }
}
