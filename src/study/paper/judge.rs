//! The rule by which a statement of the paper is met.

use crate::keyword::{Keyword, keywords};
use serde::{Serialize, Serializer};

keywords! {
    /// Verdict on a statement.
    Verdict {
        /// It holds under the assumptions of the scenario, none of which was found from it.
        Met = "met",
        /// It holds with one assumption changed, which was not found from it.
        MetUnderAssumption = "met-under-assumption",
        /// It holds, but it was used to find an assumption under which it does: no evidence.
        Fitted = "fitted",
        /// It is a parameter that was copied from the paper: no evidence either.
        Input = "input",
        /// It holds under no assumption that was tried.
        NotMet = "not-met",
        /// Nothing could be computed to hold it against.
        Unconfirmed = "unconfirmed",
    }
}

/// How the study came by what a statement is judged with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Provenance {
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

/// What the paper says of a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Expected {
    /// A number, and by how much another may differ from it and still be the same.
    Value {
        /// The number.
        value: f64,
        /// The largest difference.
        tolerance: f64,
    },
    /// At least so much.
    AtLeast(f64),
    /// More than so much.
    MoreThan(f64),
}

impl Expected {
    /// Whether `found` is what the paper says; what is not a number never is.
    pub(super) fn holds(self, found: f64) -> bool {
        match self {
            Self::Value { value, tolerance } => (found - value).abs() <= tolerance,
            Self::AtLeast(bound) => found >= bound,
            Self::MoreThan(bound) => found > bound,
        }
    }
}

/// One statement of the paper, judged.
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
    /// What comes out under the assumptions of the scenario.
    pub ours: Option<f64>,
    /// The verdict.
    pub verdict: Verdict,
    /// The one assumption under which it holds, where it does not hold as it is.
    pub assumption: Option<String>,
    /// What comes out under that assumption.
    pub ours_there: Option<f64>,
}

/// A number under a named assumption.
pub(super) struct OtherAssumption<'a> {
    pub(super) assumption: &'a str,
    pub(super) found: Option<f64>,
}

/// Judges a statement. It holds if it does as the scenario stands, else under any of `others`, of
/// which the one with the smallest difference is named (the first of equals). What holds is met,
/// unless its provenance makes it no evidence; what has no number at all is unconfirmed.
pub(super) fn judge(
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

    /// What was copied or fitted is told from what was computed, and from what does not hold.
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
