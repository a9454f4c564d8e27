//! What all strategies have in common: one batch per step, a budget, a front and a
//! history, so one loop runs any of them.

use serde::{Deserialize, Serialize};

use super::error::OptimizeError;
use super::hypervolume::hypervolume;
use super::problem::{Individual, Problem};

/// A search that advances one batch at a time.
///
/// A strategy is its own checkpoint: serialise it after any step, read it back,
/// and the steps that follow give the same bits as an unbroken run, provided that
/// the form it is written in keeps every `f64` exactly.
pub trait Strategy {
    /// Sends the problem one batch and learns from the answers. Does nothing when
    /// the search is done.
    ///
    /// # Errors
    ///
    /// An answer that cannot be compared, a repair that leaves the space, or a
    /// state that does not match the problem. The search is then unchanged.
    fn step(&mut self, problem: &dyn Problem) -> Result<(), OptimizeError>;

    /// The progress of the search.
    fn progress(&self) -> Progress;

    /// The best designs known: feasible, none dominated by another, sorted by
    /// their objectives from the first to the last. Empty if none is feasible.
    fn front(&self) -> Vec<Individual>;

    /// One record per step so far.
    fn history(&self) -> &[Record];

    /// The hypervolume reference chosen from the first step that evaluated anything feasible: per
    /// objective the worst feasible value plus 10 % of the range.
    fn chosen_reference(&self) -> Option<&[f64]>;

    /// Whether no step is left.
    fn is_done(&self) -> bool {
        let progress = self.progress();
        progress.step >= progress.steps
    }
}

/// The progress of a search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// Steps taken.
    pub step: u64,
    /// Total steps.
    pub steps: u64,
    /// Designs evaluated.
    pub evaluations: u64,
}

/// The record of one step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// The step, from 1: a generation, an iteration or a batch.
    pub generation: u64,
    /// Designs evaluated so far.
    pub evaluations: u64,
    /// Hypervolume of the feasible front at the given reference or, without one, at the chosen
    /// reference once there is one.
    pub hypervolume: Option<f64>,
    /// Hypervolume at the chosen reference, as long as no member dominates the given one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hypervolume_at_chosen: Option<f64>,
    /// The smallest feasible value of each objective, if anything is feasible.
    pub ideal: Option<Vec<f64>>,
    /// Members of the feasible front.
    pub front_size: usize,
    /// Feasible individuals among those that the strategy holds.
    pub feasible: usize,
    /// Objectives of the feasible front, to show its development: at most [`Record::MAX_POINTS`] of
    /// them, evenly over the front, and only for some steps (all of the first hundred, every tenth
    /// up to a thousand, and so on); otherwise empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub front: Vec<Vec<f64>>,
}

/// Whether step `step` keeps the points of its front: about ninety in each power of ten.
fn keeps_points(step: u64) -> bool {
    let mut stride = 1;
    while stride * 100 < step {
        stride *= 10;
    }
    step.is_multiple_of(stride)
}

/// At most [`Record::MAX_POINTS`] of `points`, the first and the last among them.
fn thinned(points: &[&[f64]]) -> Vec<Vec<f64>> {
    let kept = points.len().min(Record::MAX_POINTS);
    let at = |n: usize| n * (points.len() - 1) / (kept - 1).max(1);
    (0..kept).map(|n| points[at(n)].to_vec()).collect()
}

impl Record {
    /// Maximum number of front points in a record.
    pub const MAX_POINTS: usize = 64;

    /// Describes the state of a strategy after a step: its feasible front, and how
    /// many feasible individuals.
    pub(super) fn new(
        progress: Progress,
        front: &[Individual],
        feasible: usize,
        reference: Option<&[f64]>,
    ) -> Self {
        let points: Vec<&[f64]> = front.iter().map(|a| a.objectives.as_slice()).collect();
        let least = |a: Vec<f64>, b: &[f64]| a.iter().zip(b).map(|(a, b)| a.min(*b)).collect();
        Self {
            generation: progress.step,
            evaluations: progress.evaluations,
            hypervolume: reference.map(|reference| hypervolume(&points, reference)),
            hypervolume_at_chosen: None,
            ideal: points
                .split_first()
                .map(|(first, rest)| rest.iter().fold(first.to_vec(), |a, b| least(a, b))),
            front_size: front.len(),
            feasible,
            front: if keeps_points(progress.step) {
                thinned(&points)
            } else {
                Vec::new()
            },
        }
    }

    /// The hypervolumes of a history, all at one reference: the given one if a member of the last
    /// front dominates it, otherwise the chosen one.
    #[must_use]
    pub fn volumes(history: &[Self]) -> Vec<Option<f64>> {
        let last = history.last();
        let at_chosen = last.is_some_and(|record| record.hypervolume_at_chosen.is_some());
        let volume = |record: &Self| {
            if at_chosen {
                record.hypervolume_at_chosen
            } else {
                record.hypervolume
            }
        };
        history.iter().map(volume).collect()
    }
}

/// Checks a setting that is a probability.
pub(super) fn check_probability(setting: &'static str, value: f64) -> Result<(), OptimizeError> {
    let expected = "between 0 and 1";
    check_setting((0.0..=1.0).contains(&value), setting, value, expected)
}

/// Checks a setting that is a count.
pub(super) fn check_count(setting: &'static str, value: usize) -> Result<(), OptimizeError> {
    check_setting(value > 0, setting, value as f64, "at least 1")
}

/// Reports a setting with an unexpected value.
pub(super) fn check_setting(
    valid: bool,
    setting: &'static str,
    value: f64,
    expected: &'static str,
) -> Result<(), OptimizeError> {
    if valid {
        return Ok(());
    }
    Err(OptimizeError::Setting {
        setting,
        value,
        expected,
    })
}

/// Checks that a problem has objectives and a reference, if any, one finite
/// coordinate for each.
pub(super) fn check_objectives(
    problem: &dyn Problem,
    reference: Option<&[f64]>,
) -> Result<(), OptimizeError> {
    let expected = problem.objective_names().len();
    if expected == 0 {
        return Err(OptimizeError::NoObjective);
    }
    let Some(reference) = reference else {
        return Ok(());
    };
    if reference.len() != expected {
        let found = reference.len();
        return Err(OptimizeError::ReferenceLength { found, expected });
    }
    let check =
        |value: &f64| check_setting(value.is_finite(), "hypervolume reference", *value, "finite");
    reference.iter().try_for_each(check)
}

/// Checks that a count read from a checkpoint does not exceed what fits.
pub(super) fn check_at_most(
    quantity: &'static str,
    found: u64,
    expected: u64,
) -> Result<(), OptimizeError> {
    if found <= expected {
        return Ok(());
    }
    Err(OptimizeError::Checkpoint {
        quantity,
        found,
        expected,
    })
}

/// Checks that a count read from a checkpoint agrees with the rest of it.
pub(super) fn check_equal(
    quantity: &'static str,
    found: u64,
    expected: u64,
) -> Result<(), OptimizeError> {
    if found == expected {
        return Ok(());
    }
    Err(OptimizeError::Checkpoint {
        quantity,
        found,
        expected,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn late_steps_keep_few_points() {
        assert!((1..=100).all(keeps_points));
        assert_eq!((101..=1000).filter(|&step| keeps_points(step)).count(), 90);
        assert_eq!(
            (1001..=10_000).filter(|&step| keeps_points(step)).count(),
            90
        );
    }

    #[test]
    fn thinning_keeps_the_ends() {
        let coordinates: Vec<Vec<f64>> = (0..1000).map(|n| vec![f64::from(n)]).collect();
        let points: Vec<&[f64]> = coordinates.iter().map(Vec::as_slice).collect();
        let kept = thinned(&points);
        assert_eq!(kept.len(), Record::MAX_POINTS);
        assert_eq!((kept[0][0], kept[63][0]), (0.0, 999.0));
        assert_eq!(thinned(&points[..1]), [[0.0]]);
        assert!(thinned(&[]).is_empty());
    }
}
