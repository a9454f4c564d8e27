//! Numbers as people read them: one function for each kind, so that a number has the same digits
//! in a table, in prose and on the page, rounded once and from its full value.

use crate::run::{Diagnostic, FrontMember, Hypervolume};
use crate::search::Quantity;

/// Text for a missing value.
pub(crate) const NONE: &str = "none";

/// Code of the diagnostic for a reference point that no member dominates.
pub(crate) const UNUSED_REFERENCE: &str = "reference-not-dominated";

/// Significant digits of values without a natural number of decimals.
const SIGNIFICANT: i32 = 5;

/// Decimals of a quantity: four for PDOP values and mean counts, five for fractions, none for
/// counts.
#[must_use]
pub(crate) fn quantity(quantity: Quantity, value: Option<f64>) -> String {
    match quantity {
        Quantity::Satellites
        | Quantity::Planes
        | Quantity::NewSatellites
        | Quantity::NewPlanes
        | Quantity::LeastVisible
        | Quantity::LongestOutageS => decimals(value, 0),
        Quantity::GainLongestOutageS => decimals(value, 0),
        coverage if coverage.coverage_levels().is_some() => share(value),
        Quantity::Availability | Quantity::N1Availability | Quantity::ExpectedAvailability => {
            share(value)
        }
        Quantity::LaunchCost => value.map_or_else(|| NONE.to_owned(), significant),
        _ => decimals(value, 4),
    }
}

/// A quantity by its name; an unknown one, from another version, is shown like a PDOP.
#[must_use]
pub(crate) fn named(name: &str, value: Option<f64>) -> String {
    use crate::keyword::Keyword;
    match Quantity::from_keyword(name) {
        Ok(known) => quantity(known, value),
        Err(_) => pdop(value),
    }
}

/// A dilution of precision.
#[must_use]
pub(crate) fn pdop(value: Option<f64>) -> String {
    decimals(value, 4)
}

/// A fraction from 0 to 1, such as availability.
#[must_use]
pub(crate) fn share(value: Option<f64>) -> String {
    decimals(value, 5)
}

/// A fuzzy membership.
#[must_use]
pub(crate) fn membership(value: f64) -> String {
    decimals(Some(value), 3)
}

fn decimals(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| NONE.to_owned(), |value| rounded(value, digits))
}

/// With so many decimals; what rounds to zero has no sign.
fn rounded(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    match text.strip_prefix('-') {
        Some(zero) if zero.chars().all(|c| c == '0' || c == '.') => zero.to_owned(),
        _ => text,
    }
}

/// Five significant digits, and all digits of the integer part: `0.61097`, `12.346`, `146`, `123457`.
#[must_use]
pub(crate) fn significant(value: f64) -> String {
    // Of the rounded number: 9.999996 has one digit more than it seems.
    let rounded = format!("{value:.*e}", SIGNIFICANT as usize - 1);
    let exponent = rounded
        .split_once('e')
        .and_then(|(_, exponent)| exponent.parse().ok());
    let magnitude: i32 = exponent.unwrap_or_default();
    if value == 0.0 || magnitude < -12 {
        return "0".to_owned();
    }
    let digits = (SIGNIFICANT - 1 - magnitude).clamp(0, 12) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') && value.fract() == 0.0 {
        return format!("{value:.0}");
    }
    text
}

/// The name of an algorithm as written in the literature.
#[cfg(any(feature = "cli", feature = "figures"))]
#[must_use]
pub(crate) fn algorithm(word: &str) -> &str {
    use crate::keyword::Keyword;
    use crate::scenario::Algorithm;
    match Algorithm::from_keyword(word) {
        Ok(Algorithm::Nsga2) => "NSGA-II",
        Ok(Algorithm::Mopso) => "MOPSO",
        Ok(Algorithm::Random) => "Random search",
        Ok(Algorithm::Exhaustive) => "Exhaustive search",
        Err(_) => word,
    }
}

/// A reference point: `(2, 22)`.
#[must_use]
pub(crate) fn point(coordinates: &[f64]) -> String {
    let short = |x: &f64| {
        let text = significant(*x);
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text
        }
    };
    let cells: Vec<String> = coordinates.iter().map(short).collect();
    format!("({})", cells.join(", "))
}

/// The hypervolume as a sentence without its full stop; `None` if there is none.
#[cfg(any(feature = "cli", feature = "figures"))]
#[must_use]
pub(crate) fn hypervolume(hypervolume: &Hypervolume) -> Option<String> {
    let at = |volume: &crate::run::VolumeAt| {
        let (value, at) = (significant(volume.value), point(&volume.reference));
        format!("hypervolume {value} at {at}")
    };
    let measured = hypervolume.measured()?;
    Some(match (&hypervolume.at_chosen, hypervolume.chosen) {
        (Some(_), _) => {
            let written = hypervolume.reference.as_deref().unwrap_or_default();
            format!(
                "{}, chosen from the run instead of the scenario's reference point {}",
                at(&measured),
                point(written)
            )
        }
        (None, true) => format!("{}, a reference point chosen from the run", at(&measured)),
        (None, false) => at(&measured),
    })
}

/// The diagnostic of a reference point that no member dominates.
#[must_use]
pub(crate) fn unused_reference(hypervolume: &Hypervolume) -> Option<Diagnostic> {
    let chosen = hypervolume.at_chosen.as_ref()?;
    let written = hypervolume.reference.as_deref().unwrap_or_default();
    Some(Diagnostic::new(
        UNUSED_REFERENCE,
        format!(
            "no front member dominates the hypervolume reference {}: it measures nothing, and {} is \
             used instead, the worst of the first feasible generation plus 10 % of its range",
            point(written),
            point(&chosen.reference)
        ),
    ))
}

/// A front member's objectives: `j-pos 1.7166, j-cost 20.5261`.
#[must_use]
pub(crate) fn objectives(member: &FrontMember) -> String {
    pairs(
        member
            .objectives
            .iter()
            .map(|(n, v)| (n.as_str(), Some(*v))),
    )
}

/// Names and values in a sentence.
#[must_use]
pub(crate) fn pairs<'a>(values: impl Iterator<Item = (&'a str, Option<f64>)>) -> String {
    let texts: Vec<String> = values
        .map(|(name, value)| format!("{name} {}", named(name, value)))
        .collect();
    texts.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_suit_the_kind() {
        for (value, text) in [
            (0.610_974_4, "0.61097"),
            (9.999_996, "10.000"),
            (9.999_94, "9.9999"),
            (1e-16, "0"),
            (12.345_67, "12.346"),
            (146.0, "146"),
            (146.212_3, "146.21"),
            (123_456.7, "123457"),
            (-0.000_123_456_7, "-0.00012346"),
            (2.0, "2"),
            (0.0, "0"),
        ] {
            assert_eq!(significant(value), text);
        }
        assert_eq!(named("satellites", Some(182.0)), "182");
        assert_eq!(named("availability", Some(0.999_96)), "0.99996");
        assert_eq!(named("max-pdop", Some(2.201_449_9)), "2.2014");
        assert_eq!(named("max-pdop", None), "none");
        assert_eq!(point(&[2.0, 22.5, 220.0]), "(2, 22.5, 220)");
    }

    #[test]
    fn a_reference_of_no_use_is_told() {
        let mut volume = Hypervolume {
            value: None,
            reference: Some(vec![1.0, 10.0]),
            chosen: false,
            at_chosen: Some(crate::run::VolumeAt {
                value: 0.5,
                reference: vec![2.0, 30.0],
            }),
        };
        let text = unused_reference(&volume).unwrap().message;
        assert!(
            text.contains("(1, 10)") && text.contains("(2, 30)"),
            "{text}"
        );
        #[cfg(any(feature = "cli", feature = "figures"))]
        assert!(
            super::hypervolume(&volume)
                .unwrap()
                .contains("0.50000 at (2, 30)")
        );
        volume.at_chosen = None;
        #[cfg(any(feature = "cli", feature = "figures"))]
        assert_eq!(super::hypervolume(&volume), None);
        assert!(unused_reference(&volume).is_none());
    }
}
