//! A search for the fewest satellites: its grid, its rules, and what becomes of one design.

use super::counts::{CountGrid, ShellCounts};
use super::order::{BadTile, SampleOrder};
use super::parts::PART_POINTS;
use super::rules::RuleSet;
use super::trial::{Rejection, Trial};
use super::witness::{PointWitness, RejectionBasis, Witness};
use crate::constellation::Design;
use crate::ephemeris::Ephemeris;
use crate::evaluate::{Metrics, SampleTiles};
use crate::optimize::{OptimizeError, Problem, SweepGrid};
use crate::search::{Constraint, DesignProblem};
use std::ops::ControlFlow;

/// What a point of the grid violates that cannot be evaluated.
const UNFIT: &str = "a design that can be propagated";

/// The designs of a search by the number of their satellites, and its constraints.
pub struct SizeProblem<'a> {
    problem: &'a DesignProblem<'a>,
    grid: SweepGrid,
    counts: CountGrid,
    /// Where the variables of each shell begin.
    first_variables: Vec<usize>,
    /// `None` where the plain path evaluates all designs, in full.
    rules: Option<RuleSet>,
    /// Points of the grid in a part of the walk.
    pub(super) part_points: u64,
}

/// What became of a design.
pub(super) struct Tried {
    pub(super) outcome: TriedVerdict,
    /// Tiles evaluated one by one.
    pub(super) tiles: usize,
    /// Whether all samples were evaluated at last.
    pub(super) is_evaluated: bool,
    /// Those with bad samples, by place in the order.
    pub(super) bad_tiles: Vec<BadTile>,
}

/// Whether a design keeps the constraints.
pub(super) enum TriedVerdict {
    Kept(Design, Box<Metrics>),
    Rejected(Box<Witness>),
}

impl<'a> SizeProblem<'a> {
    /// The fewest satellites of the designs of a search that keep its constraints, on the grid of a sweep. What the
    /// search optimises does not matter. Fixed satellites from files alone, beside shells that are all empty, are no design
    /// of it.
    #[must_use]
    pub fn new(problem: &'a DesignProblem<'a>) -> Self {
        let designs = problem.designs();
        let evaluator = problem.evaluator;
        let gnss = evaluator.gnss_satellites();
        let constraints = &problem.goals().constraints;
        let rules = evaluator
            .sample_tiles()
            .map(|shape| RuleSet::new(constraints, evaluator.setup(), shape, gnss));
        let mut next = 0;
        let first = |shell: &crate::search::ShellSpace| {
            let first = next;
            next += shell.variables().count();
            first
        };
        Self {
            problem,
            grid: SweepGrid::new(problem.space(), &designs.steps()),
            counts: CountGrid::new(designs),
            first_variables: designs.shells.iter().map(first).collect(),
            rules,
            part_points: PART_POINTS,
        }
    }

    /// The same in parts of another size.
    #[cfg(test)]
    pub(super) fn in_parts_of(mut self, points: u64) -> Self {
        self.part_points = points;
        self
    }

    /// The search.
    #[must_use]
    pub fn problem(&self) -> &DesignProblem<'a> {
        self.problem
    }

    /// The constraints.
    #[must_use]
    pub fn constraints(&self) -> &[Constraint] {
        &self.problem.goals().constraints
    }

    /// The constraints that have no rule, so that every design that no other rejects is evaluated in full.
    #[must_use]
    pub fn without_rule(&self) -> Vec<Constraint> {
        let has_rule = |place: usize| {
            let rules = self.rules.iter().flat_map(|set| &set.rules);
            rules.into_iter().any(|rule| rule.constraint == place)
        };
        let constraints = self.constraints().iter().enumerate();
        constraints
            .filter(|(place, one)| !one.quantity.is_of_shells() && !has_rule(*place))
            .map(|(_, one)| *one)
            .collect()
    }

    /// Upper bound of the number of designs, which only repeats of one design by rounding stay below.
    #[must_use]
    pub fn design_count(&self) -> f64 {
        let shells = self.problem.designs().shells.iter();
        shells
            .map(crate::search::ShellSpace::distinct_points)
            .product()
    }

    /// Satellites that every design has beside those of its own shells.
    pub(super) fn fixed_satellites(&self) -> usize {
        let in_design = self.problem.designs().fixed.as_ref();
        self.problem.satellites_beside() + in_design.map_or(0, Design::satellite_count)
    }

    /// The numbers of satellites of all designs, ascending.
    pub(super) fn totals(&self) -> Vec<usize> {
        let fixed = self.fixed_satellites();
        let own = self.counts.totals().into_iter();
        own.map(|total| total + fixed).collect()
    }

    /// The counts of the shells that make so many satellites in all.
    pub(super) fn with_total(&self, satellites: usize) -> Vec<ShellCounts> {
        let own = satellites.saturating_sub(self.fixed_satellites());
        self.counts.with_total(own)
    }

    /// The part of the grid with these counts.
    pub(super) fn part(&self, counts: &ShellCounts) -> SweepGrid {
        let shells = self.first_variables.iter().zip(counts);
        shells.fold(self.grid.clone(), |grid, (first, [planes, per_plane])| {
            grid.pinned(*first, f64::from(*planes))
                .pinned(first + 1, f64::from(*per_plane))
        })
    }

    /// The genome of a design at a point of a part of the grid; `None` if it is that of another point.
    pub(super) fn genome(
        &self,
        part: &SweepGrid,
        index: u64,
    ) -> Result<Option<Vec<f64>>, OptimizeError> {
        part.admitted(self.problem, part.genome(index))
    }

    pub(super) fn sample_tiles(&self) -> Option<&SampleTiles> {
        self.rules.as_ref().map(|set| &set.shape)
    }

    /// Tries one design: by its shells, by samples in an order, and at last by all of them. A scout goes on through
    /// all samples when it is rejected, so that something is learnt about each.
    pub(super) fn tried(
        &self,
        genome: &[f64],
        order: Option<&SampleOrder>,
        is_scout: bool,
    ) -> Tried {
        let mut tried = Tried {
            outcome: TriedVerdict::Rejected(Box::new(unfit(genome))),
            tiles: 0,
            is_evaluated: false,
            bad_tiles: Vec::new(),
        };
        let Ok(Some(design)) = self.problem.designs().design(genome) else {
            return tried;
        };
        tried.outcome = TriedVerdict::Rejected(Box::new(Witness {
            constraint: UNFIT.to_owned(),
            ..named(&design, RejectionBasis::Shells)
        }));
        if let Some(witness) = self.by_shells(&design) {
            tried.outcome = TriedVerdict::Rejected(Box::new(witness));
            return tried;
        }
        let Some(ephemeris) = self.problem.with_fixed(Some(&design)) else {
            return tried;
        };
        if let (Some(rules), Some(order)) = (&self.rules, order) {
            let mut trial = Trial::new(rules, ephemeris.satellites().len());
            if trial.rejection().is_none() {
                self.probe(&ephemeris, order, is_scout, &mut trial);
            }
            tried.tiles = trial.tiles();
            tried.bad_tiles = std::mem::take(&mut trial.bad_tiles);
            if let Some(rejection) = trial.rejection() {
                let of_all = self.samples_share(trial.tiles_at_rejection());
                let witness = self.by_samples(&design, rejection, of_all);
                tried.outcome = TriedVerdict::Rejected(Box::new(witness));
                return tried;
            }
        }
        tried.is_evaluated = true;
        if let Some(metrics) = self.problem.metrics_of(&ephemeris) {
            tried.outcome = self.by_evaluation(design, metrics);
        }
        tried
    }

    /// Share of the samples that so many tiles are.
    #[must_use]
    pub fn samples_share(&self, tiles: usize) -> f64 {
        let all = self
            .sample_tiles()
            .map_or(1, |shape| shape.tiles * shape.instants);
        tiles as f64 / all.max(1) as f64
    }

    pub(super) fn probe(
        &self,
        ephemeris: &Ephemeris,
        order: &SampleOrder,
        is_scout: bool,
        trial: &mut Trial<'_>,
    ) {
        let see = |tile: crate::evaluate::SampleTile<'_>| {
            trial.see(&tile);
            if trial.rejection().is_some() && !is_scout {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        // What cannot be propagated is found again by the evaluation of all samples.
        let _ = self
            .problem
            .evaluator
            .probe(ephemeris, order.instants(), see);
    }

    /// The constraints about the shells, each with its value and violation.
    fn of_shells(&self, design: &Design) -> impl Iterator<Item = (&Constraint, Option<f64>, f64)> {
        let of_shells = self.constraints().iter();
        let of_shells = of_shells.filter(|constraint| constraint.quantity.is_of_shells());
        of_shells.map(|constraint| {
            let value = self.problem.value_of_shells(constraint.quantity, design);
            (constraint, value, constraint.violation(value, 1.0))
        })
    }

    /// The violation of the constraints about the shells.
    pub(super) fn violation_by_shells(&self, design: &Design) -> f64 {
        self.of_shells(design)
            .map(|(.., violation)| violation)
            .sum()
    }

    /// The rules that prove a violation beyond `most`; `None` where the plain path evaluates all designs.
    pub(super) fn rules_beyond(&self, most: f64) -> Option<RuleSet> {
        let evaluator = self.problem.evaluator;
        let (shape, gnss) = (evaluator.sample_tiles()?, evaluator.gnss_satellites());
        let constraints = match most.is_finite() {
            true => self.constraints(),
            false => &[],
        };
        let setup = evaluator.setup();
        Some(RuleSet::beyond(constraints, most, setup, shape, gnss))
    }

    /// A constraint about the shells that they violate.
    fn by_shells(&self, design: &Design) -> Option<Witness> {
        let mut all = self.of_shells(design);
        let (constraint, value, _) = all.find(|(.., violation)| *violation > 0.0)?;
        Some(Witness {
            constraint: constraint.to_string(),
            value_at_rejection: value,
            ..named(design, RejectionBasis::Shells)
        })
    }

    fn by_samples(&self, design: &Design, rejection: Rejection, samples_share: f64) -> Witness {
        let setup = self.problem.evaluator.setup();
        let basis = match samples_share > 0.0 {
            true => RejectionBasis::Samples,
            false => RejectionBasis::Geometry,
        };
        let point = |(site, _): (usize, usize)| PointWitness {
            number: site + 1,
            latitude_deg: setup.sites[site].latitude_deg,
            longitude_deg: setup.sites[site].longitude_deg,
        };
        let sample = rejection.sample;
        Witness {
            constraint: self.constraints()[rejection.constraint].to_string(),
            point: sample.map(point),
            elapsed_s: sample.map(|(_, instant)| setup.grid.elapsed_s(instant)),
            share_at_rejection: rejection.bad_share,
            value_at_rejection: rejection.value,
            samples_share,
            ..named(design, basis)
        }
    }

    /// The verdict of an evaluation of all samples.
    fn by_evaluation(&self, design: Design, metrics: Metrics) -> TriedVerdict {
        let mut sum = 0.0;
        let mut worst: Option<(f64, &Constraint, Option<f64>)> = None;
        for (constraint, value, violation) in self.violations(&design, &metrics) {
            sum += violation;
            if violation > worst.map_or(0.0, |(most, ..)| most) {
                worst = Some((violation, constraint, value));
            }
        }
        match worst {
            None => TriedVerdict::Kept(design, Box::new(metrics)),
            Some((_, constraint, value)) => TriedVerdict::Rejected(Box::new(Witness {
                constraint: constraint.to_string(),
                value_at_rejection: value,
                samples_share: 1.0,
                violation: Some(sum),
                ..named(&design, RejectionBasis::Evaluation)
            })),
        }
    }

    /// Satellites from files that every design has beside its shells.
    #[must_use]
    pub fn satellites_beside(&self) -> usize {
        self.problem.satellites_beside()
    }

    /// Whether a design keeps the constraints, by an evaluation of all samples; `None` if it cannot be propagated.
    #[must_use]
    pub fn keeps(&self, design: &Design) -> Option<bool> {
        let metrics = self.assessed(design)?;
        let mut violations = self.violations(design, &metrics);
        Some(violations.all(|(.., violation)| violation == 0.0))
    }

    /// The vectors of all points of the grid with so many satellites, in the order of the search.
    pub(super) fn genomes(
        &self,
        satellites: usize,
    ) -> impl Iterator<Item = Result<Vec<f64>, OptimizeError>> {
        self.with_total(satellites)
            .into_iter()
            .flat_map(move |counts| {
                let part = self.part(&counts);
                let (last, error) = match part.count() {
                    Ok(points) => (points, None),
                    Err(error) => (0, Some(Err(error))),
                };
                let genomes = (0..last).filter_map(move |n| self.genome(&part, n).transpose());
                error.into_iter().chain(genomes)
            })
    }

    /// The numbers of satellites that occur in the grid, ascending.
    #[must_use]
    pub fn numbers(&self) -> Vec<usize> {
        self.totals()
    }

    /// The designs of the grid with so many satellites, in the order of the search. Points that are not designs are left
    /// out.
    pub fn designs_of(
        &self,
        satellites: usize,
    ) -> impl Iterator<Item = Result<Design, OptimizeError>> {
        self.genomes(satellites).filter_map(|genome| match genome {
            Ok(genome) => self
                .problem
                .designs()
                .design(&genome)
                .ok()
                .flatten()
                .map(Ok),
            Err(error) => Some(Err(error)),
        })
    }

    /// The metrics of a design of the search with what is fixed; `None` if it cannot be propagated.
    #[must_use]
    pub fn assessed(&self, design: &Design) -> Option<Metrics> {
        let ephemeris = self.problem.with_fixed(Some(design))?;
        self.problem.metrics_of(&ephemeris)
    }

    /// Each constraint with the value of its quantity, and how far the value is from keeping it.
    pub fn violations<'s>(
        &'s self,
        design: &'s Design,
        metrics: &'s Metrics,
    ) -> impl Iterator<Item = (&'s Constraint, Option<f64>, f64)> {
        self.constraints().iter().map(move |constraint| {
            let quantity = constraint.quantity;
            let value = self.problem.value(quantity, Some(design), metrics);
            let violation = constraint.violation(value, quantity.solved_fraction(metrics));
            (constraint, value, violation)
        })
    }
}

/// A witness about a design, of which only the basis is known.
fn named(design: &Design, basis: RejectionBasis) -> Witness {
    of_text(design.to_string(), basis)
}

fn of_text(design: String, basis: RejectionBasis) -> Witness {
    Witness {
        design,
        constraint: String::new(),
        basis,
        point: None,
        elapsed_s: None,
        share_at_rejection: None,
        value_at_rejection: None,
        samples_share: 0.0,
        violation: None,
    }
}

/// About a point of the grid that is not a design.
fn unfit(genome: &[f64]) -> Witness {
    let values: Vec<String> = genome.iter().map(ToString::to_string).collect();
    Witness {
        constraint: UNFIT.to_owned(),
        ..of_text(values.join(" "), RejectionBasis::Shells)
    }
}
