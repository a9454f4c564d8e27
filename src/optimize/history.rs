//! The records of a search, and the hypervolume reference point that it chooses.

use serde::{Deserialize, Serialize};

use super::error::OptimizeError;
use super::problem::{Individual, Problem};
use super::strategy::{Progress, Record, check_equal, check_objectives, check_setting};

/// Margin of a chosen reference point beyond the worst values, as a fraction of their range.
const MARGIN: f64 = 0.1;

/// The step records common to all strategies.
///
/// The reference point is chosen once, from the first step that evaluates anything feasible: per
/// objective the worst feasible value plus 10 % of the range of the feasible values. Later steps do
/// not move it, so that the volumes of a history can be compared.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct History {
    chosen_reference: Option<Vec<f64>>,
    records: Vec<Record>,
}

impl History {
    pub(super) fn records(&self) -> &[Record] {
        &self.records
    }

    pub(super) fn records_mut(&mut self) -> &mut Vec<Record> {
        &mut self.records
    }

    pub(super) fn chosen_reference(&self) -> Option<&[f64]> {
        self.chosen_reference.as_deref()
    }

    /// Checks a history read from a file: one record for each step, in order, with a finite value for
    /// each objective, and a reference of as many.
    pub(super) fn check(&self, problem: &dyn Problem, steps: u64) -> Result<(), OptimizeError> {
        check_equal("history", self.records.len() as u64, steps)?;
        let objectives = problem.objective_names().len() as u64;
        for (step, record) in (1..).zip(&self.records) {
            check_equal("step of a record", record.generation, step)?;
            for point in record.ideal.iter().chain(&record.front) {
                check_equal("objectives of a record", point.len() as u64, objectives)?;
                for &value in point {
                    check_setting(value.is_finite(), "objective of a record", value, "finite")?;
                }
            }
        }
        check_objectives(problem, self.chosen_reference())
    }

    /// Chooses the reference point from the designs that a step evaluated, before the step is recorded.
    pub(super) fn learn(&mut self, evaluated: &[Individual]) {
        if self.chosen_reference.is_none() {
            self.chosen_reference = choose_reference(evaluated);
        }
    }

    /// Records the state of a strategy after a step: its feasible front and the number of feasible
    /// individuals.
    pub(super) fn record(
        &mut self,
        progress: Progress,
        front: &[Individual],
        feasible: usize,
        written: Option<&[f64]>,
    ) {
        let chosen = self.chosen_reference();
        let mut record = Record::new(progress, front, feasible, written.or(chosen));
        if written.is_some() && record.hypervolume == Some(0.0) {
            record.hypervolume_at_chosen =
                Record::new(progress, front, feasible, chosen).hypervolume;
        }
        self.records.push(record);
    }

    /// Records a strategy with an archive: the whole archive is the front, unless nothing feasible
    /// is known.
    pub(super) fn record_archive(
        &mut self,
        progress: Progress,
        archive: &[Individual],
        written: Option<&[f64]>,
    ) {
        let feasible = archive.iter().filter(|a| a.is_feasible()).count();
        let front = if feasible > 0 { archive } else { &[] };
        self.record(progress, front, feasible, written);
    }
}

/// Per objective the worst feasible value plus 10 % of the range of the feasible values; where all
/// are equal, plus 10 % of the magnitude, or 1 if it is 0. `None` if nothing is feasible.
fn choose_reference(evaluated: &[Individual]) -> Option<Vec<f64>> {
    let feasible = || evaluated.iter().filter(|a| a.is_feasible());
    let coordinate = |n: usize| {
        let values = || feasible().map(|a| a.objectives[n]);
        let worst = values().fold(f64::NEG_INFINITY, f64::max);
        let range = worst - values().fold(f64::INFINITY, f64::min);
        let scales = [range, worst.abs()].into_iter().find(|scale| *scale > 0.0);
        worst + scales.map_or(1.0, |scale| MARGIN * scale)
    };
    let objectives = feasible().next()?.objectives.len();
    Some((0..objectives).map(coordinate).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn individual(objectives: &[f64], violation: f64) -> Individual {
        Individual {
            genome: vec![0.0],
            objectives: objectives.to_vec(),
            violation,
        }
    }

    fn progress(step: u64) -> Progress {
        Progress {
            step,
            steps: 9,
            evaluations: step,
        }
    }

    /// By hand: the worst are 4, -2, 5 and 0, the ranges 2, 8, 0 and 0; the infeasible one is not
    /// looked at.
    #[test]
    fn the_reference_lies_beyond_the_first_feasible_designs() {
        let first = [
            individual(&[2.0, -2.0, 5.0, 0.0], 0.0),
            individual(&[4.0, -10.0, 5.0, 0.0], 0.0),
            individual(&[9.0, 9.0, 9.0, 9.0], 0.1),
        ];
        let mut history = History::default();
        history.learn(&first[2..]);
        assert_eq!(history.chosen_reference(), None);
        history.learn(&first);
        let expected = [4.2, -1.2, 5.5, 1.0];
        // Two roundings of numbers below 10.
        for (found, expected) in history.chosen_reference().unwrap().iter().zip(expected) {
            assert!((found - expected).abs() < 4e-15, "{found} {expected}");
        }
        let chosen = history.clone();
        history.learn(&[individual(&[99.0; 4], 0.0)]);
        assert_eq!(history, chosen);
    }

    #[test]
    fn the_chosen_reference_stands_in_for_one_that_is_missing_or_of_no_use() {
        let front = [individual(&[1.0, 3.0], 0.0), individual(&[2.0, 2.0], 0.0)];
        let mut history = History::default();
        history.learn(&front);
        // At (2.1, 3.1): 1.1 by 0.1 and 0.1 by 1.1, of which 0.1 by 0.1 is common.
        let volume = 0.11 + 0.11 - 0.01;
        for written in [None, Some([1.0, 1.0]), Some([3.0, 4.0])] {
            history.record(progress(1), &front, 2, written.as_ref().map(|x| &x[..]));
        }
        let near = |value: Option<f64>, expected: f64| (value.unwrap() - expected).abs() < 1e-14;
        let [none, useless, useful] = history.records() else {
            panic!("three records");
        };
        assert!(near(none.hypervolume, volume) && none.hypervolume_at_chosen.is_none());
        assert_eq!(useless.hypervolume, Some(0.0));
        assert!(near(useless.hypervolume_at_chosen, volume));
        assert!(near(useful.hypervolume, 3.0) && useful.hypervolume_at_chosen.is_none());
        let volumes = |n: usize| Record::volumes(&history.records()[..n]);
        assert_eq!(volumes(2)[0], None);
        assert!(near(volumes(2)[1], volume));
        assert_eq!(volumes(3)[1], Some(0.0));
    }
}
