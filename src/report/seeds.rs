//! The same search with several seeds.

use super::front_table::front_table;
use super::{Align, Table, seed_spread, shown};
use crate::optimize::{best, dominates, fuzzy};
use crate::run::columns::{cells, fields};
use crate::run::tables::text;
use crate::run::{
    Certificate, Diagnostic, FrontMember, Hypervolume, OptimizeResult, VolumeAt, front_csv,
};
use crate::search::Quantity;
use crate::units::counted;
use ::csv::Writer;
use serde::{Deserialize, Serialize};
use std::io;

/// One of the searches.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SeedRun {
    /// Its seed.
    pub seed: u64,
    /// Hypervolume of its front, at the reference point common to all seeds.
    pub hypervolume: Option<f64>,
    /// The best value of a single objective; `None` with several.
    pub best: Option<f64>,
    /// Designs evaluated.
    pub evaluations: u64,
    /// Members of its front.
    pub front_size: usize,
    /// The fuzzy pick.
    pub pick: Option<String>,
}

impl From<&OptimizeResult> for SeedRun {
    fn from(result: &OptimizeResult) -> Self {
        Self {
            seed: result.search.seed,
            hypervolume: result.search.hypervolume.value,
            best: single_best(result),
            evaluations: result.search.evaluations,
            front_size: result.front.len(),
            pick: result.chosen().map(FrontMember::made_of),
        }
    }
}

/// The best value of a single objective; `None` with several.
fn single_best(result: &OptimizeResult) -> Option<f64> {
    match result.front.first()?.objectives.as_slice() {
        // The front is sorted, the best first.
        [(_, value)] => Some(*value),
        _ => None,
    }
}

/// A member of the joint front of all seeds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointMember {
    /// The seed that found it.
    pub seed: u64,
    /// The member, with its index in the front of that seed; memberships and choice are those in
    /// the joint front.
    #[serde(flatten)]
    pub member: FrontMember,
}

/// A number over the seeds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Spread {
    /// Arithmetic mean.
    pub mean: f64,
    /// Minimum.
    pub min: f64,
    /// Maximum.
    pub max: f64,
    /// Sample standard deviation (n - 1); 0 for one seed.
    pub std_dev: f64,
}

impl Spread {
    fn of(values: &[f64]) -> Option<Self> {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
        Some(Self {
            mean,
            min: values.iter().copied().min_by(f64::total_cmp)?,
            max: values.iter().copied().max_by(f64::total_cmp)?,
            std_dev: (squares / (count - 1.0).max(1.0)).sqrt(),
        })
    }
}

/// The output of `optimize --seeds`: the result of the first seed, which is not selected for being
/// the best, and the summary of all.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SeedsResult {
    /// The result of the first seed.
    #[serde(flatten)]
    pub first: OptimizeResult,
    /// Seed by seed.
    pub seeds: Vec<SeedRun>,
    /// The hypervolume over the seeds; `None` if a seed has none.
    pub hypervolume_spread: Option<Spread>,
    /// The best value of a single objective over the seeds; `None` with several.
    pub best_spread: Option<Spread>,
    /// What no member of any seed's front dominates, each design once.
    pub joint_front: Vec<JointMember>,
}

impl SeedsResult {
    /// The result of searches that differ only in their seed; `None` without any. A sweep certifies
    /// the first of them.
    ///
    /// All hypervolumes are at one reference point: that of the scenario if a member of every seed's
    /// front dominates it, otherwise the worst, in each objective, of the points chosen by the seeds.
    #[must_use]
    pub fn new(
        mut results: Vec<OptimizeResult>,
        sweep: Option<&OptimizeResult>,
        objectives: &[Quantity],
    ) -> Option<Self> {
        share_reference(&mut results, objectives);
        let mut seeds: Vec<SeedRun> = results.iter().map(SeedRun::from).collect();
        for (run, result) in seeds.iter_mut().zip(&results) {
            let measured = result.search.hypervolume.measured();
            run.hypervolume = measured.map(|volume| volume.value);
        }
        let spread = |value: fn(&SeedRun) -> Option<f64>| {
            let values: Option<Vec<f64>> = seeds.iter().map(value).collect();
            values.and_then(|values| Spread::of(&values))
        };
        let hypervolume_spread = spread(|run| run.hypervolume);
        let best_spread = spread(|run| run.best);
        let joint_front = joint_front(&results);
        let mut first = results.into_iter().next()?;
        if let Some(sweep) = sweep {
            first.search.certificate = Some(Certificate::new(&first, sweep, objectives));
        }
        let (what, judged) = match (best_spread, objectives) {
            (Some(best), [objective]) => (format!("best value of {objective}"), Some(best)),
            _ => ("hypervolume".to_owned(), hypervolume_spread),
        };
        let told = judged.and_then(|s| seed_spread(&what, s.mean, s.std_dev, seeds.len()));
        first.search.diagnostics.extend(told);
        Some(Self {
            first,
            seeds,
            hypervolume_spread,
            best_spread,
            joint_front,
        })
    }

    /// The name of a single objective.
    fn single(&self) -> Option<&str> {
        match self.first.front.first()?.objectives.as_slice() {
            [(name, _)] => Some(name),
            _ => None,
        }
    }

    /// The seeds, their spread and their joint front, for a terminal.
    #[must_use]
    pub fn to_text(&self) -> String {
        let right = Align::Right;
        let single = self.single();
        let best_heading = single.map(|name| format!("best {name}"));
        let mut columns = vec![("seed", right)];
        columns.extend(best_heading.iter().map(|heading| (heading.as_str(), right)));
        columns.extend([
            ("hypervolume", right),
            ("evaluations", right),
            ("front", right),
            ("pick", Align::Left),
        ]);
        let mut table = Table::new(&columns);
        let volume =
            |value: Option<f64>| value.map_or_else(|| shown::NONE.to_owned(), shown::significant);
        for run in &self.seeds {
            let mut row = vec![run.seed.to_string()];
            row.extend(single.map(|name| shown::named(name, run.best)));
            row.extend([
                volume(run.hypervolume),
                run.evaluations.to_string(),
                run.front_size.to_string(),
                run.pick.clone().unwrap_or_else(|| shown::NONE.to_owned()),
            ]);
            table.row(row);
        }
        let mut text = table.to_text();
        if let (Some(name), Some(spread)) = (single, self.best_spread) {
            text += &self.spread_line(&format!("best {name}"), spread);
        }
        if let (Some(spread), Some(at)) = (
            self.hypervolume_spread,
            self.first.search.hypervolume.measured(),
        ) {
            let what = format!("hypervolume at {}", shown::point(&at.reference));
            text += &self.spread_line(&what, spread);
        }
        if !self.joint_front.is_empty() {
            let members = self.joint_front.iter();
            let members = members.map(|m| (format!("{}/{}", m.seed, m.member.index), &m.member));
            text += &format!(
                "\njoint front of {} seeds: {}\n\n{}",
                self.seeds.len(),
                counted(self.joint_front.len(), "design"),
                front_table("seed/#", members).to_text()
            );
        }
        text
    }

    fn spread_line(&self, what: &str, spread: Spread) -> String {
        let Spread {
            mean,
            min,
            max,
            std_dev,
        } = spread;
        let [mean, min, max, std_dev] = [mean, min, max, std_dev].map(shown::significant);
        format!(
            "{what} over {} seeds: mean {mean}, minimum {min}, maximum {max}, standard deviation \
             {std_dev}\n",
            self.seeds.len()
        )
    }

    /// The joint front, one member per row: the seed, then the columns of a front.
    ///
    /// # Errors
    /// Never for a table in memory.
    pub fn joint_csv(&self) -> io::Result<String> {
        let members = self.joint_front.iter().map(|m| m.member.clone());
        let table = front_csv(&members.collect::<Vec<_>>())?;
        let seeds = self.joint_front.iter().map(|m| m.seed.to_string());
        let first_column = std::iter::once("seed".to_owned()).chain(seeds);
        let lines = first_column.zip(table.lines());
        Ok(lines
            .map(|(cell, line)| format!("{cell},{line}\n"))
            .collect())
    }

    /// The seeds, one per row.
    ///
    /// # Errors
    /// Never for a table in memory.
    pub fn to_csv(&self) -> io::Result<String> {
        let mut writer = Writer::from_writer(Vec::new());
        writer.write_record(fields::<SeedRun>())?;
        for run in &self.seeds {
            writer.write_record(cells(run, fields::<SeedRun>())?)?;
        }
        text(writer)
    }
}

/// Measures the hypervolume of every result at one reference point.
fn share_reference(results: &mut [OptimizeResult], objectives: &[Quantity]) {
    let with_front = || results.iter().filter(|result| !result.front.is_empty());
    let count = with_front().count();
    let volumes = || with_front().map(|result| &result.search.hypervolume);
    let useless = volumes().filter(|v| v.chosen || v.value.is_none()).count();
    if useless == 0 {
        return;
    }
    let chosen = results.iter().filter_map(|r| r.chosen_reference.clone());
    let worst = |a: Vec<f64>, b: Vec<f64>| a.iter().zip(&b).map(|(a, b)| a.max(*b)).collect();
    let Some(common) = chosen.reduce(worst) else {
        return;
    };
    for result in results {
        let points: Vec<Vec<f64>> = result.front.iter().map(FrontMember::minimised).collect();
        let at_common = Hypervolume::of(&points, None, Some(&common), objectives);
        let volume = &mut result.search.hypervolume;
        if volume.chosen || volume.reference.is_none() {
            *volume = at_common;
            continue;
        }
        volume.at_chosen = at_common
            .value
            .zip(at_common.reference)
            .map(|(value, reference)| VolumeAt { value, reference });
        let told = volume.at_chosen.as_ref().zip(volume.reference.as_ref());
        let told = told.map(|(at, written)| {
            Diagnostic::new(
                shown::UNUSED_REFERENCE,
                format!(
                    "in {useless} of {count} seeds no front member dominates the hypervolume \
                     reference {}: all are measured at {} instead, per objective the worst of the \
                     points chosen from the first feasible generations",
                    shown::point(written),
                    shown::point(&at.reference)
                ),
            )
        });
        let diagnostics = &mut result.search.diagnostics;
        diagnostics.retain(|d| d.code != shown::UNUSED_REFERENCE);
        diagnostics.extend(told);
    }
}

/// What no member of any front dominates, each design once, by its objectives.
fn joint_front(results: &[OptimizeResult]) -> Vec<JointMember> {
    let all = || {
        results.iter().flat_map(|result| {
            let seed = result.search.seed;
            result.front.iter().map(move |member| (seed, member))
        })
    };
    let mut joint: Vec<JointMember> = Vec::new();
    for (seed, member) in all() {
        let point = member.minimised();
        let is_known = |m: &JointMember| m.member.design == member.design;
        if joint.iter().any(is_known) || all().any(|(_, m)| dominates(&m.minimised(), &point)) {
            continue;
        }
        joint.push(JointMember {
            seed,
            member: member.clone(),
        });
    }
    joint.sort_by(|a, b| {
        let pairs = a.member.minimised().into_iter().zip(b.member.minimised());
        pairs
            .map(|(a, b)| a.total_cmp(&b))
            .find(|order| order.is_ne())
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    let points: Vec<Vec<f64>> = joint.iter().map(|m| m.member.minimised()).collect();
    if let Ok(memberships) = fuzzy(&points) {
        let chosen = best(&memberships.minimum);
        for (n, JointMember { member, .. }) in joint.iter_mut().enumerate() {
            member.membership = memberships.minimum[n];
            member.membership_sum = memberships.share[n];
            member.chosen = chosen == Some(n);
        }
    }
    joint
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::{SearchSummary, testing};

    #[test]
    fn validate_spread_by_hand() {
        let spread = Spread::of(&[1.0, 2.0, 3.0, 6.0]).unwrap();
        assert_eq!((spread.mean, spread.min, spread.max), (3.0, 1.0, 6.0));
        // Squares 4, 1, 0, 9 over 3.
        assert!((spread.std_dev - (14.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert_eq!(Spread::of(&[2.0]).unwrap().std_dev, 0.0);
        assert_eq!(Spread::of(&[]), None);
    }

    fn result(
        seed: u64,
        front: &[(&str, [f64; 2])],
        written: Option<[f64; 2]>,
        chosen: [f64; 2],
    ) -> OptimizeResult {
        let objectives = [Quantity::MeanPdop, Quantity::MeanVisible];
        let members = (1..)
            .zip(front)
            .map(|(index, (notation, [a, b]))| FrontMember {
                objectives: vec![
                    ("mean-pdop".to_owned(), *a),
                    ("mean-visible".to_owned(), *b),
                ],
                ..testing::member(index, notation)
            });
        let front: Vec<FrontMember> = members.collect();
        let points: Vec<Vec<f64>> = front.iter().map(FrontMember::minimised).collect();
        let written = written.as_ref().map(<[f64; 2]>::as_slice);
        OptimizeResult {
            search: SearchSummary {
                seed,
                diagnostics: Vec::new(),
                hypervolume: Hypervolume::of(&points, written, Some(&chosen), &objectives),
                ..testing::summary()
            },
            front,
            history: Vec::new(),
            chosen_reference: Some(chosen.to_vec()),
        }
    }

    const A: &str = "delta:45:225/15/1@1000";
    const B: &str = "delta:46:225/15/1@1000";
    const C: &str = "delta:47:225/15/1@1000";

    fn both(written: Option<[f64; 2]>) -> SeedsResult {
        // More in view is better, so that the reference has -1 and -2 there.
        let results = vec![
            result(4, &[(A, [1.0, 3.0]), (B, [2.0, 4.0])], written, [3.0, -1.0]),
            result(5, &[(A, [1.0, 3.0]), (C, [1.5, 5.0])], written, [4.0, -2.0]),
        ];
        let objectives = [Quantity::MeanPdop, Quantity::MeanVisible];
        SeedsResult::new(results, None, &objectives).unwrap()
    }

    /// By hand at the shared point (4, 1): 3 by 2 and 2 by 3 with 2 by 2 in common; and 3 by 2 and
    /// 2.5 by 4 with 2.5 by 2 in common.
    #[test]
    fn all_seeds_are_measured_at_one_reference() {
        let seeds = both(None);
        let at = seeds.first.search.hypervolume.measured().unwrap();
        assert_eq!(at.reference, [4.0, 1.0]);
        let volumes: Vec<_> = seeds
            .seeds
            .iter()
            .map(|run| run.hypervolume.unwrap())
            .collect();
        assert_eq!(volumes, [8.0, 11.0]);
        assert_eq!(at.value, volumes[0]);
        // Nothing dominates (1.2, 4) in the first front, C does not either: the points of the seeds
        // take its place for both.
        let useless = both(Some([1.2, -4.0]));
        let volume = &useless.first.search.hypervolume;
        assert_eq!((volume.value, volume.measured()), (None, Some(at)));
        let codes: Vec<_> = useless
            .first
            .search
            .diagnostics
            .iter()
            .map(|d| &d.code)
            .collect();
        assert_eq!(codes[0], shown::UNUSED_REFERENCE);
        let written = both(Some([5.0, 0.0]));
        let volume = written.first.search.hypervolume;
        assert_eq!(
            (volume.reference, volume.at_chosen),
            (Some(vec![5.0, 0.0]), None)
        );
    }

    #[test]
    fn the_joint_front_is_that_of_all_seeds() {
        let seeds = both(None);
        let joint: Vec<_> = seeds
            .joint_front
            .iter()
            .map(|m| (m.seed, m.member.index, m.member.made_of()))
            .collect();
        // A is in both, C dominates B.
        assert_eq!(joint, [(4, 1, A.to_owned()), (5, 2, C.to_owned())]);
        assert_eq!(
            seeds.joint_front.iter().filter(|m| m.member.chosen).count(),
            1
        );
        let csv = seeds.joint_csv().unwrap();
        assert!(csv.starts_with("seed,index,notation"), "{csv}");
        assert!(csv.contains("\n5,2,delta:47"), "{csv}");
        assert!(
            seeds
                .to_text()
                .contains("joint front of 2 seeds: 2 designs")
        );
    }

    #[test]
    fn one_objective_has_a_best_of_each_seed() {
        let one = |seed, values: &[f64]| {
            let mut of = result(seed, &[(A, [1.0, 3.0])], None, [3.0, -1.0]);
            of.chosen_reference = Some(vec![9.0]);
            let member = |value: &f64| FrontMember {
                objectives: vec![("max-pdop".to_owned(), *value)],
                ..testing::member(1, A)
            };
            of.front = values.iter().map(member).collect();
            of
        };
        let results = vec![one(1, &[2.0, 2.0]), one(2, &[2.5])];
        let seeds = SeedsResult::new(results, None, &[Quantity::MaxPdop]).unwrap();
        let best: Vec<_> = seeds.seeds.iter().map(|run| run.best).collect();
        assert_eq!(best, [Some(2.0), Some(2.5)]);
        assert_eq!(seeds.best_spread.unwrap().mean, 2.25);
        let told = &seeds.first.search.diagnostics.last().unwrap().message;
        assert!(
            told.contains("the standard deviation of the best value of max-pdop is 15.71 %"),
            "{told}"
        );
        assert!(
            seeds
                .to_text()
                .contains("best max-pdop over 2 seeds: mean 2.2500")
        );
    }
}
