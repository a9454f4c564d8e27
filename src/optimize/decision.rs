//! Picking one design of a front: fuzzy membership, TOPSIS and the knee.
//!
//! Each method scores every point of a set from the set's objectives only, larger
//! being better; [`best`] turns scores into a pick. All of them judge a point
//! relative to the others in the set, so adding or removing points can change the
//! pick.

use thiserror::Error;

/// Why a set of points cannot be judged.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum DecisionError {
    /// There is nothing to choose from.
    #[error("no point to choose from")]
    NoPoint,
    /// Points must have the same number of objectives, at least one.
    #[error("point {index} has {found} objectives instead of {expected}")]
    ObjectiveCount {
        /// The point's index, from 0.
        index: usize,
        /// Its number of objectives.
        found: usize,
        /// The number of the first point, at least 1.
        expected: usize,
    },
    /// An objective whose values are not finite, or too far apart for an `f64`,
    /// cannot be scaled.
    #[error("objective {objective} ranges from {least} to {greatest}, which is not finite")]
    Range {
        /// The objective's index, from 0.
        objective: usize,
        /// Its least value.
        least: f64,
        /// Its greatest value.
        greatest: f64,
    },
    /// TOPSIS needs one weight per objective.
    #[error("there are {found} weights for {expected} objectives")]
    WeightCount {
        /// Weights given.
        found: usize,
        /// Objectives.
        expected: usize,
    },
    /// A weight is not finite or not positive.
    #[error("a weight must be finite and greater than 0, found {value}")]
    Weight {
        /// The offending weight.
        value: f64,
    },
}

/// Fuzzy memberships of a set of points.
#[derive(Debug, Clone, PartialEq)]
pub struct Memberships {
    /// μ_m of each point and objective: 1 at the set's least value, 0 at its
    /// greatest, linear in between.
    pub by_objective: Vec<Vec<f64>>,
    /// min over m of μ_m: the membership in the decision, which requires every goal
    /// at once.
    pub minimum: Vec<f64>,
    /// Σ_m μ_m divided by its total over the set, so that the set's shares sum
    /// to 1.
    pub share: Vec<f64>,
}

/// Scores points by fuzzy membership, μ_m = (max - J_m)/(max - min).
///
/// An objective that is the same for every point has μ = 1: all of them attain its
/// best value. With 1 the minimum of the memberships is decided by the others, while
/// 0 would make every point equally unacceptable.
///
/// Source: the decision as the intersection (minimum) of fuzzy goals, R. E.
/// Bellman, L. A. Zadeh, "Decision-making in a fuzzy environment", Management
/// Science 17(4), 1970; the normalised sum, M. A. Abido, "Environmental/economic
/// power dispatch using multiobjective evolutionary algorithms", IEEE Transactions
/// on Power Systems 18(4), 2003.
///
/// # Errors
///
/// No points, points that differ in their number of objectives, or values without
/// a finite range.
pub fn fuzzy<P: AsRef<[f64]>>(points: &[P]) -> Result<Memberships, DecisionError> {
    let ranges = ranges(points)?;
    let membership = |(value, range): (&f64, &Range)| match range.width() {
        0.0 => 1.0,
        width => (range.greatest - value) / width,
    };
    let by_objective: Vec<Vec<f64>> = points
        .iter()
        .map(|point| point.as_ref().iter().zip(&ranges).map(membership).collect())
        .collect();
    let least = |of: &Vec<f64>| of.iter().copied().fold(1.0, f64::min);
    let sums: Vec<f64> = by_objective.iter().map(|of| of.iter().sum()).collect();
    // Never 0: the point with an objective's least value has μ = 1 there.
    let total: f64 = sums.iter().sum();
    Ok(Memberships {
        minimum: by_objective.iter().map(least).collect(),
        share: sums.iter().map(|sum| sum / total).collect(),
        by_objective,
    })
}

/// Scores points by TOPSIS: the distance from the anti-ideal point over the sum of
/// the distances from the anti-ideal and the ideal point, 1 if every objective is best.
///
/// Each objective is divided by the root of its sum of squares and multiplied by
/// its weight; only the ratios of the weights matter. Unlike the other methods
/// this one changes if a constant is added to an objective. If all points are equal,
/// all score 1.
///
/// Source: C.-L. Hwang, K. Yoon, "Multiple Attribute Decision Making", Springer
/// 1981.
///
/// # Errors
///
/// As for [`fuzzy`]; a wrong number of weights, or one that is not positive.
pub fn topsis<P: AsRef<[f64]>>(points: &[P], weights: &[f64]) -> Result<Vec<f64>, DecisionError> {
    let ranges = ranges(points)?;
    check_weights(weights, ranges.len())?;
    let scale = |objective: usize| {
        let values = points.iter().map(|point| point.as_ref()[objective]);
        match values.fold(0.0, f64::hypot) {
            0.0 => 0.0,
            norm => weights[objective] / norm,
        }
    };
    let scales: Vec<f64> = (0..ranges.len()).map(scale).collect();
    let distance = |point: &[f64], end: fn(&Range) -> f64| {
        let terms = point.iter().zip(&ranges).zip(&scales);
        terms
            .map(|((value, range), scale)| (value - end(range)) * scale)
            .fold(0.0, f64::hypot)
    };
    let closeness = |point: &P| {
        let from_best = distance(point.as_ref(), |range| range.least);
        let from_worst = distance(point.as_ref(), |range| range.greatest);
        match from_best + from_worst {
            0.0 => 1.0,
            both => from_worst / both,
        }
    };
    Ok(points.iter().map(closeness).collect())
}

/// Scores points by how far they bulge from the line between the ends of the
/// front: (1 - Σ_m f_m)/√M, with each of M objectives scaled to f = 0 at its least
/// and 1 at its greatest value, 0 for one that is the same everywhere.
///
/// For two objectives that is the distance from the straight line through both
/// ends of a front; for more, from the plane Σ f_m = 1 through each objective's
/// unit point, which the front need not touch. Where no objective is the same
/// everywhere it ranks points as the fuzzy sum does, since Σ μ_m = M - Σ f_m.
///
/// Source: I. Das, "On characterizing the 'knee' of the Pareto curve based on
/// normal-boundary intersection", Structural Optimization 18, 1999.
///
/// # Errors
///
/// As for [`fuzzy`].
pub fn knee<P: AsRef<[f64]>>(points: &[P]) -> Result<Vec<f64>, DecisionError> {
    let ranges = ranges(points)?;
    let scaled = |(value, range): (&f64, &Range)| match range.width() {
        0.0 => 0.0,
        width => (value - range.least) / width,
    };
    let bulge = |point: &P| {
        let sum: f64 = point.as_ref().iter().zip(&ranges).map(scaled).sum();
        (1.0 - sum) / (ranges.len() as f64).sqrt()
    };
    Ok(points.iter().map(bulge).collect())
}

/// The index of the greatest score, the first of equals; none without scores.
#[must_use]
pub fn best(scores: &[f64]) -> Option<usize> {
    (0..scores.len())
        .rev()
        .max_by(|&a, &b| scores[a].total_cmp(&scores[b]))
}

/// The least and greatest value of one objective.
struct Range {
    least: f64,
    greatest: f64,
}

impl Range {
    fn width(&self) -> f64 {
        self.greatest - self.least
    }
}

fn ranges<P: AsRef<[f64]>>(points: &[P]) -> Result<Vec<Range>, DecisionError> {
    let first = points.first().ok_or(DecisionError::NoPoint)?;
    let expected = first.as_ref().len().max(1);
    for (index, point) in points.iter().enumerate() {
        let found = point.as_ref().len();
        if found != expected {
            return Err(DecisionError::ObjectiveCount {
                index,
                found,
                expected,
            });
        }
    }
    let range = |objective: usize| {
        let values = || points.iter().map(|point| point.as_ref()[objective]);
        // By total order, a NaN is the greatest or the least of all.
        let least = values().min_by(f64::total_cmp).unwrap_or(f64::NAN);
        let greatest = values().max_by(f64::total_cmp).unwrap_or(f64::NAN);
        if (greatest - least).is_finite() {
            return Ok(Range { least, greatest });
        }
        Err(DecisionError::Range {
            objective,
            least,
            greatest,
        })
    };
    (0..expected).map(range).collect()
}

fn check_weights(weights: &[f64], expected: usize) -> Result<(), DecisionError> {
    if weights.len() != expected {
        let found = weights.len();
        return Err(DecisionError::WeightCount { found, expected });
    }
    let unfit = |weight: &&f64| !weight.is_finite() || **weight <= 0.0;
    match weights.iter().find(unfit) {
        Some(&value) => Err(DecisionError::Weight { value }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const FRONT: [[f64; 2]; 4] = [[1.0, 50.0], [2.0, 20.0], [3.0, 15.0], [5.0, 10.0]];

    fn assert_close(found: &[f64], expected: &[f64]) {
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            // A few roundings of numbers of order 1.
            assert!(
                (found - expected).abs() < 1e-14,
                "{found} is not {expected}"
            );
        }
    }

    #[test]
    fn validate_fuzzy_memberships_by_hand() {
        let memberships = fuzzy(&FRONT).unwrap();
        // μ1 = (5 - J1)/4, μ2 = (50 - J2)/40.
        assert_close(&memberships.minimum, &[0.0, 0.75, 0.5, 0.0]);
        // Sums 1, 1.5, 1.375, 1; total 4.875.
        let total = 4.875;
        assert_close(
            &memberships.share,
            &[1.0 / total, 1.5 / total, 1.375 / total, 1.0 / total],
        );
        assert_eq!(memberships.by_objective[2], [0.5, 0.875]);
        assert_eq!(best(&memberships.minimum), Some(1));
        assert_eq!(best(&memberships.share), Some(1));
    }

    #[test]
    fn an_objective_without_a_range_does_not_decide() {
        let points = [[1.0, 7.0], [2.0, 7.0], [3.0, 7.0]];
        let memberships = fuzzy(&points).unwrap();
        assert_eq!(memberships.minimum, [1.0, 0.5, 0.0]);
        assert_eq!(best(&topsis(&points, &[1.0, 1.0]).unwrap()), Some(0));
        assert_eq!(best(&knee(&points).unwrap()), Some(0));
        let alone = [[3.0, 0.0]];
        assert_eq!(fuzzy(&alone).unwrap().minimum, [1.0]);
        assert_eq!(fuzzy(&alone).unwrap().share, [1.0]);
        assert_eq!(topsis(&alone, &[1.0, 1.0]), Ok(vec![1.0]));
        assert_close(&knee(&alone).unwrap(), &[0.5_f64.sqrt()]);
    }

    #[test]
    fn validate_topsis_by_hand() {
        // Columns of norm 5 and 13 give (0.6, 12/13) and (0.8, 5/13), weights 2 and 1:
        // the points differ by 0.4 in one objective and by 7/13 in the other.
        let scores = topsis(&[[3.0, 12.0], [4.0, 5.0]], &[2.0, 1.0]).unwrap();
        let (first, second) = (0.4, 7.0 / 13.0);
        assert_close(
            &scores,
            &[first / (first + second), second / (first + second)],
        );
        let ends = topsis(&[[1.0, 1.0], [2.0, 2.0]], &[1.0, 1.0]).unwrap();
        assert_close(&ends, &[1.0, 0.0]);
    }

    #[test]
    fn validate_knee_is_the_distance_from_the_line_between_the_ends() {
        let scores = knee(&FRONT).unwrap();
        // In the unit square the points are (0,1), (1/4,1/4), (1/2,1/8), (1,0): the
        // distances from x + y = 1 are 0, 1/2, 3/8 and 0 over the root of two.
        let root = 2.0_f64.sqrt();
        assert_close(&scores, &[0.0, 0.5 / root, 0.375 / root, 0.0]);
        assert_eq!(best(&scores), Some(1));
    }

    #[test]
    fn the_first_of_equal_scores_is_best() {
        assert_eq!(best(&[0.0, 2.0, 2.0]), Some(1));
        assert_eq!(best(&[]), None);
    }

    #[test]
    fn sets_that_cannot_be_judged_are_refused() {
        let empty: [[f64; 2]; 0] = [];
        assert_eq!(fuzzy(&empty), Err(DecisionError::NoPoint));
        let text = |points: &[Vec<f64>]| fuzzy(points).unwrap_err().to_string();
        assert_eq!(
            text(&[vec![1.0, 2.0], vec![1.0]]),
            "point 1 has 1 objectives instead of 2"
        );
        assert_eq!(text(&[Vec::new()]), "point 0 has 0 objectives instead of 1");
        assert_eq!(
            text(&[vec![1.0, f64::INFINITY], vec![1.0, 2.0]]),
            "objective 1 ranges from 2 to inf, which is not finite"
        );
        assert!(fuzzy(&[[f64::NAN], [1.0]]).is_err());
        assert!(fuzzy(&[[-f64::NAN], [1.0]]).is_err());
        assert!(knee(&[[f64::MAX], [-f64::MAX]]).is_err());
        let weighted = |weights: &[f64]| topsis(&FRONT, weights).unwrap_err().to_string();
        assert_eq!(weighted(&[1.0]), "there are 1 weights for 2 objectives");
        assert_eq!(
            weighted(&[1.0, 0.0]),
            "a weight must be finite and greater than 0, found 0"
        );
        assert!(topsis(&FRONT, &[1.0, f64::NAN]).is_err());
    }

    proptest! {
        #[test]
        fn shares_sum_to_one_and_rank_as_the_knee(
            points in prop::collection::vec([0.0..10.0_f64, 0.0..10.0, 0.0..10.0], 2..20)
        ) {
            let share = fuzzy(&points).unwrap().share;
            // Roundings of at most 20 terms.
            prop_assert!((share.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            let (by_share, by_knee) = (best(&share).unwrap(), knee(&points).unwrap());
            let greatest = by_knee.iter().copied().fold(f64::MIN, f64::max);
            prop_assert!(by_knee[by_share] > greatest - 1e-12);
        }
    }
}
