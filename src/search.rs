//! The adapter between the optimisers, which work on vectors, and the evaluator, which works on
//! designs.

mod constraint;
mod quantity;

pub use constraint::{Constraint, ConstraintError, Relation};
pub use quantity::{LaunchCost, Quantity};

use crate::constellation::{Design, DesignError, Pattern, Shell, ShellParameters};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::evaluate::{Evaluator, Metrics};
use crate::optimize::{Evaluation, OptimizeError, Problem, Space, Variable, VariableKind};
use crate::units::round_decimal;
use rayon::prelude::*;

/// Decimals of a degree to which a search resolves inclination: the last digit of a TLE.
const INCLINATION_DECIMALS: usize = 4;

/// Decimals of a kilometre to which a search resolves altitude: one metre.
const ALTITUDE_DECIMALS: usize = 3;

/// Decimals to which a search resolves eccentricity: 7 m in low orbit.
const ECCENTRICITY_DECIMALS: usize = 6;

/// Positions of the variables in a genome.
const PLANES: usize = 0;
const PER_PLANE: usize = 1;
const INCLINATION: usize = 2;
const ALTITUDE: usize = 3;
const PHASING: usize = 4;

/// The search space; every interval includes its limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DesignSpace {
    /// The pattern of all designs.
    pub pattern: Pattern,
    /// Planes.
    pub planes: [u32; 2],
    /// Satellites in a plane.
    pub satellites_per_plane: [u32; 2],
    /// Inclination, degrees.
    pub inclination_deg: [f64; 2],
    /// Altitude over the equatorial radius, km.
    pub altitude_km: [f64; 2],
    /// Phasing F, or `N_c` of a lattice; capped at P - 1.
    pub phasing: [u32; 2],
    /// Eccentricity; a variable if the limits differ.
    pub eccentricity: [f64; 2],
    /// Argument of perigee, degrees; a variable if the limits differ.
    pub arg_perigee_deg: [f64; 2],
}

/// The steps of a grid sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SweepSteps {
    /// Step of the inclination, degrees.
    pub inclination_deg: f64,
    /// Step of the altitude, km.
    pub altitude_km: f64,
    /// Step of the eccentricity.
    pub eccentricity: f64,
    /// Step of the argument of perigee, degrees.
    pub arg_perigee_deg: f64,
}

impl DesignSpace {
    /// The space of the vectors (P, S, i, h, F[, e][, ω]); e and ω only if they vary, so that
    /// circular searches draw the same random numbers with and without them.
    ///
    /// # Errors
    /// If an interval is reversed.
    pub fn vectors(&self) -> Result<Space, OptimizeError> {
        let integer = |name: &str, [lo, hi]: [u32; 2]| Variable {
            name: name.to_owned(),
            kind: VariableKind::Integer {
                lo: lo.into(),
                hi: hi.into(),
            },
        };
        let real = |name: &str, [lo, hi]: [f64; 2]| Variable {
            name: name.to_owned(),
            kind: VariableKind::Real { lo, hi },
        };
        let mut variables = vec![
            integer("planes", self.planes),
            integer("satellites-per-plane", self.satellites_per_plane),
            real("inclination-deg", self.inclination_deg),
            real("altitude-km", self.altitude_km),
            integer("phasing", self.cut_phasing()),
        ];
        let ellipse = [
            ("eccentricity", self.eccentricity),
            ("arg-perigee-deg", self.arg_perigee_deg),
        ];
        let varied = ellipse.into_iter().filter(|(_, limits)| varies(*limits));
        variables.extend(varied.map(|(name, limits)| real(name, limits)));
        Space::new(variables)
    }

    /// The steps of a sweep, in the order of the vectors: inclination and altitude, eccentricity and
    /// argument of perigee as given, 1 for counts.
    #[must_use]
    pub fn steps(&self, sweep: SweepSteps) -> Vec<f64> {
        let mut steps = vec![1.0, 1.0, sweep.inclination_deg, sweep.altitude_km, 1.0];
        steps.extend(varies(self.eccentricity).then_some(sweep.eccentricity));
        steps.extend(varies(self.arg_perigee_deg).then_some(sweep.arg_perigee_deg));
        steps
    }

    /// Eccentricity and argument of perigee (degrees) of a vector.
    fn ellipse(&self, genome: &[f64]) -> (f64, f64) {
        let mut further = genome[PHASING + 1..].iter().copied();
        let mut next = |limits: [f64; 2]| {
            let varied = if varies(limits) { further.next() } else { None };
            varied.unwrap_or(limits[0])
        };
        (next(self.eccentricity), next(self.arg_perigee_deg))
    }

    /// The phasings that can occur: the limits, capped at P - 1 for the fewest and the most planes.
    fn cut_phasing(&self) -> [u32; 2] {
        let cut = |n: usize| self.phasing[n].min(self.planes[n].saturating_sub(1));
        [cut(0), cut(1)]
    }

    /// Clamps the phasing to its limits, both capped at P - 1, and rounds the continuous variables to
    /// their resolution, so that designs have few digits and equal designs are equal vectors.
    fn repair(&self, genome: &mut [f64]) {
        let lowest = f64::from(self.phasing[0]);
        genome[PHASING] = genome[PHASING].max(lowest).min(genome[PLANES] - 1.0);
        let [south, north] = self.inclination_deg;
        genome[INCLINATION] =
            round_decimal(genome[INCLINATION], INCLINATION_DECIMALS).clamp(south, north);
        let [low, high] = self.altitude_km;
        genome[ALTITUDE] = round_decimal(genome[ALTITUDE], ALTITUDE_DECIMALS).clamp(low, high);
        let resolutions = [
            (self.eccentricity, ECCENTRICITY_DECIMALS),
            (self.arg_perigee_deg, INCLINATION_DECIMALS),
        ];
        let varied = resolutions
            .into_iter()
            .filter(|(limits, _)| varies(*limits));
        for (value, ([low, high], decimals)) in genome[PHASING + 1..].iter_mut().zip(varied) {
            *value = round_decimal(*value, decimals).clamp(low, high);
        }
    }

    /// The design of a vector.
    ///
    /// # Errors
    /// If the vector is not a valid design, for example because its perigee is below ground.
    pub fn design(&self, genome: &[f64]) -> Result<Design, DesignError> {
        let count = |n: usize| genome[n] as usize;
        let shell = Shell::new(ShellParameters {
            pattern: self.pattern,
            planes: count(PLANES),
            satellites_per_plane: count(PER_PLANE),
            phasing: count(PHASING),
            inclination_deg: genome[INCLINATION],
            altitude_km: genome[ALTITUDE],
        })?;
        let (eccentricity, arg_perigee_deg) = self.ellipse(genome);
        Ok(shell.with_ellipse(eccentricity, arg_perigee_deg)?.into())
    }
}

/// Whether an interval has more than one value.
fn varies([lo, hi]: [f64; 2]) -> bool {
    lo < hi
}

/// The goals of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct Goals {
    /// Quantities to optimise, each in its own direction.
    pub objectives: Vec<Quantity>,
    /// Bounds that a feasible design must meet.
    pub constraints: Vec<Constraint>,
    /// Parameters of the launch cost.
    pub launch_cost: LaunchCost,
}

impl Goals {
    /// The constrained quantities that are not objectives, each once.
    #[must_use]
    pub fn constrained(&self) -> Vec<Quantity> {
        let mut found: Vec<Quantity> = Vec::new();
        for Constraint { quantity, .. } in &self.constraints {
            if !self.objectives.contains(quantity) && !found.contains(quantity) {
                found.push(*quantity);
            }
        }
        found
    }
}

/// A design problem as the optimisers see it.
pub struct DesignProblem<'a> {
    evaluator: &'a Evaluator,
    designs: DesignSpace,
    space: Space,
    goals: Goals,
    names: Vec<String>,
}

impl<'a> DesignProblem<'a> {
    /// The search for `goals` among `designs`.
    ///
    /// # Errors
    /// If an interval of the space is reversed.
    pub fn new(
        evaluator: &'a Evaluator,
        designs: DesignSpace,
        goals: Goals,
    ) -> Result<Self, OptimizeError> {
        let space = designs.vectors()?;
        let names = goals.objectives.iter().map(ToString::to_string).collect();
        Ok(Self {
            evaluator,
            designs,
            space,
            goals,
            names,
        })
    }

    /// The goals of the search.
    #[must_use]
    pub fn goals(&self) -> &Goals {
        &self.goals
    }

    /// The search space.
    #[must_use]
    pub fn designs(&self) -> &DesignSpace {
        &self.designs
    }

    /// A design and its metrics, for a vector of the space; `None` if it cannot be propagated.
    #[must_use]
    pub fn evaluated(&self, genome: &[f64]) -> Option<(Design, Metrics)> {
        let design = self.designs.design(genome).ok()?;
        let metrics = self.evaluator.evaluate(&design).ok()?;
        Some((design, metrics))
    }

    fn answer(&self, genome: &[f64]) -> Evaluation {
        let Some((design, metrics)) = self.evaluated(genome) else {
            let objectives = vec![f64::INFINITY; self.goals.objectives.len()];
            return Evaluation {
                objectives,
                violation: 2.0,
            };
        };
        self.judge(design.satellite_count(), Some(&design), &metrics)
    }

    /// The metrics of a design, which need not be in the space, and their evaluation for an
    /// optimiser; `None` if it cannot be propagated.
    #[must_use]
    pub fn judged(&self, design: &Design) -> Option<(Metrics, Evaluation)> {
        let metrics = self.evaluator.evaluate(design).ok()?;
        let evaluation = self.judge(design.satellite_count(), Some(design), &metrics);
        Some((metrics, evaluation))
    }

    /// The metrics of any satellites, which are those of a design if there is one, and their evaluation as for
    /// an optimiser.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn judged_ephemeris(
        &self,
        ephemeris: &Ephemeris,
        design: Option<&Design>,
    ) -> Result<(Metrics, Evaluation), EphemerisError> {
        let metrics = self.evaluator.evaluate_ephemeris(ephemeris)?;
        let satellites = ephemeris.satellites().len();
        let evaluation = self.judge(satellites, design, &metrics);
        Ok((metrics, evaluation))
    }

    fn judge(&self, satellites: usize, design: Option<&Design>, metrics: &Metrics) -> Evaluation {
        let cost = &self.goals.launch_cost;
        let value = |quantity: Quantity| quantity.value_of(satellites, design, metrics, cost);
        let mut violation: f64 = self
            .goals
            .constraints
            .iter()
            .map(|c| c.violation(value(c.quantity), metrics.solved_fraction))
            .sum();
        // A design is infeasible if unsolved samples make an objective infinite.
        let unsolved = |quantity: &Quantity| quantity.unsolved_share(metrics.solved_fraction);
        violation += self
            .goals
            .objectives
            .iter()
            .map(unsolved)
            .fold(0.0, f64::max);
        let minimised = |objective: &Quantity| match value(*objective) {
            Some(value) => objective.minimised(value),
            None => f64::INFINITY,
        };
        let objectives: Vec<f64> = self.goals.objectives.iter().map(minimised).collect();
        if objectives.iter().any(|objective| objective.is_infinite()) {
            violation = violation.max(1.0);
        }
        Evaluation {
            objectives,
            violation,
        }
    }
}

impl Problem for DesignProblem<'_> {
    fn space(&self) -> &Space {
        &self.space
    }

    fn objective_names(&self) -> &[String] {
        &self.names
    }

    fn repair(&self, genome: &mut [f64]) {
        self.designs.repair(genome);
    }

    /// Parallel over the designs; results are in the order of the batch.
    fn evaluate(&self, batch: &[Vec<f64>]) -> Vec<Evaluation> {
        batch.par_iter().map(|genome| self.answer(genome)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::Coverage;

    fn space() -> DesignSpace {
        DesignSpace {
            pattern: Pattern::Delta,
            planes: [3, 15],
            satellites_per_plane: [11, 15],
            inclination_deg: [40.0, 60.0],
            altitude_km: [400.0, 1000.0],
            phasing: [0, 14],
            eccentricity: [0.0, 0.0],
            arg_perigee_deg: [0.0, 0.0],
        }
    }

    #[test]
    fn vectors_become_short_designs() {
        let mut genome = vec![3.0, 11.0, 43.827_364_651, 999.999_96, 14.0];
        space().repair(&mut genome);
        let design = space().design(&genome).unwrap();
        assert_eq!(design.to_string(), "delta:43.8274:33/3/2@1000");
        let before = genome.clone();
        space().repair(&mut genome);
        assert_eq!(genome, before);
    }

    #[test]
    fn phasing_stays_between_limits_that_are_cut() {
        let narrow = DesignSpace {
            phasing: [3, 20],
            planes: [2, 8],
            ..space()
        };
        let vectors = narrow.vectors().unwrap();
        assert_eq!(vectors.variables()[PHASING].kind.bounds(), (1.0, 7.0));
        for (planes, phasing, repaired) in [(2.0, 5.0, 1.0), (8.0, 1.0, 3.0), (8.0, 7.0, 7.0)] {
            let mut genome = vec![planes, 11.0, 50.0, 925.0, phasing];
            narrow.repair(&mut genome);
            assert_eq!(genome[PHASING], repaired);
            assert_eq!(vectors.check(&genome), Ok(()));
        }
    }

    #[test]
    fn validate_launch_cost_by_hand() {
        let design: Design = "delta:50:100/5/1@500".parse().unwrap();
        let cost = LaunchCost {
            per_satellite: 2.0,
            per_plane: 7.0,
            per_1000_km: 0.3,
        };
        let metrics = Metrics {
            mean_visible: 0.0,
            mean_pdop: None,
            cvar_pdop: None,
            cvar_level: 0.95,
            p50_pdop: None,
            p95_pdop: None,
            p99_pdop: None,
            max_pdop: None,
            solved_fraction: 0.0,
            availability: 0.0,
            j_pos: None,
            j_cost: None,
            least_visible: 0,
            coverage: Coverage::default(),
            mean_gnss_visible: 0.0,
            mean_total_visible: 0.0,
            coverage_total: Coverage::default(),
            longest_outage_s: 0.0,
            longest_outage_cut: false,
            p95_hdop: None,
            p95_vdop: None,
        };
        // 2 * 100 * (1 + 0.3 * 0.5) + 7 * 5.
        let value = Quantity::LaunchCost.value(&design, &metrics, &cost);
        assert!((value.unwrap() - 265.0).abs() < 1e-12);
    }

    #[test]
    fn constraints_measure_how_far() {
        let at_most = Constraint {
            quantity: Quantity::MaxPdop,
            relation: Relation::AtMost,
            bound: 2.0,
        };
        assert_eq!(at_most.violation(Some(1.0), 1.0), 0.0);
        assert_eq!(at_most.violation(Some(2.0), 1.0), 0.0);
        assert!(at_most.violation(Some(2.0_f64.next_up()), 1.0) > 0.0);
        assert_eq!(at_most.violation(Some(3.0), 1.0), 0.5);
        assert_eq!(at_most.violation(None, 0.0), 1.0);
        let at_least = Constraint {
            quantity: Quantity::Availability,
            relation: Relation::AtLeast,
            bound: 0.75,
        };
        assert_eq!(at_least.violation(Some(0.75), 1.0), 0.0);
        assert!(at_least.violation(Some(0.75_f64.next_down()), 1.0) > 0.0);
        // A fraction of all samples, which already includes the unsolved ones.
        assert_eq!(at_least.violation(Some(0.5), 0.5), 0.25);
        let cost: Constraint = "j-cost <= 10".parse().unwrap();
        assert_eq!(cost.violation(None, 1.0), 1.0);
    }

    /// PDOP counts as infinite in an unsolved sample: one is too many for a mean, a tail or a maximum, and
    /// a fraction above 1 - q for a quantile of level q.
    #[test]
    fn unsolved_samples_violate_what_they_would_make_infinite() {
        let violation = |text: &str, value, solved| {
            let constraint: Constraint = text.parse().unwrap();
            constraint.violation(Some(value), solved)
        };
        let one_of_a_million = 1.0 - 1e-6;
        for quantity in ["mean-pdop", "cvar-pdop", "max-pdop", "j-pos"] {
            let text = format!("{quantity} <= 20");
            assert_eq!(violation(&text, 2.0, 1.0), 0.0);
            assert_eq!(
                violation(&text, 2.0, one_of_a_million),
                1.0 - one_of_a_million
            );
            // The excess of the solved samples is added.
            assert_eq!(violation(&text, 30.0, 0.75), 0.5 + 0.25);
        }
        for (quantity, level) in [("p95-pdop", 0.95), ("p99-pdop", 0.99), ("p95-hdop", 0.95)] {
            let text = format!("{quantity} <= 20");
            assert_eq!(violation(&text, 2.0, level), 0.0);
            assert_eq!(violation(&text, 30.0, level), 0.5);
            let fewer = level - 1e-6;
            assert_eq!(violation(&text, 2.0, fewer), 1.0 - fewer);
        }
        for quantity in [
            "satellites",
            "mean-visible",
            "availability",
            "j-cost",
            "least-visible",
            "coverage-4",
            "longest-outage-s",
        ] {
            assert_eq!(violation(&format!("{quantity} <= 20"), 2.0, 0.1), 0.0);
        }
    }

    /// With LEO alone many samples are unsolved, so no bound on PDOP is met, whatever the
    /// objectives.
    #[test]
    fn what_is_not_solved_is_not_feasible() {
        use crate::constellation::gnss::Preset;
        use crate::earth::Surface;
        use crate::evaluate::Setup;
        use crate::ground::Site;
        use crate::time::{Epoch, TimeGrid};
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let grid = TimeGrid::new(epoch, 14_400.0, 300.0).unwrap();
        let site = |latitude| Site::new(Surface::Sphere, latitude, 100.0, 1.0).unwrap();
        let answer = |gnss, constraint: &str| {
            let setup = Setup::new(grid, vec![site(10.0), site(30.0), site(50.0)]).with_gnss(gnss);
            let evaluator = Evaluator::new(setup).unwrap();
            let goals = Goals {
                objectives: vec![Quantity::Satellites],
                constraints: vec![constraint.parse().unwrap()],
                launch_cost: LaunchCost {
                    per_satellite: 1.0,
                    per_plane: 5.0,
                    per_1000_km: 0.2,
                },
            };
            let problem = DesignProblem::new(&evaluator, space(), goals).unwrap();
            let genome = vec![5.0, 16.0, 42.8, 933.0, 1.0];
            let (_, metrics) = problem.evaluated(&genome).unwrap();
            (problem.answer(&genome).violation, metrics)
        };
        for constraint in ["mean-pdop <= 20", "p95-pdop <= 20"] {
            let (violation, metrics) = answer(vec![], constraint);
            assert!(metrics.mean_pdop.unwrap() < 20.0, "{metrics:?}");
            assert!(metrics.solved_fraction < 0.9, "{metrics:?}");
            assert!(violation >= 1.0 - metrics.solved_fraction, "{violation}");
        }
        let (violation, metrics) = answer(vec![Preset::Beidou3.into()], "mean-pdop <= 20");
        assert_eq!((violation, metrics.solved_fraction), (0.0, 1.0));
    }

    #[test]
    fn ellipses_are_variables_where_they_vary() {
        let free = DesignSpace {
            pattern: Pattern::Lattice,
            arg_perigee_deg: [0.0, 360.0],
            eccentricity: [0.01, 0.01],
            ..space()
        };
        assert_eq!(space().vectors().unwrap().variables().len(), 5);
        assert_eq!(free.vectors().unwrap().variables().len(), 6);
        assert_eq!(
            free.steps(SweepSteps {
                inclination_deg: 0.5,
                altitude_km: 50.0,
                eccentricity: 0.1,
                arg_perigee_deg: 30.0,
            }),
            [1.0, 1.0, 0.5, 50.0, 1.0, 30.0]
        );
        let mut genome = vec![13.0, 14.0, 55.0, 925.0, 5.0, 270.000_04];
        free.repair(&mut genome);
        let design = free.design(&genome).unwrap();
        assert_eq!(design.to_string(), "lattice:55:182/13/5@925,e=0.01,w=270");
    }
}
