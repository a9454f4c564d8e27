//! The intervals of one shell of a search.

use crate::constellation::{DesignError, Orientation, Pattern, Shell, ShellParameters};
use crate::optimize::VariableKind;
use crate::orbit::relations::{
    NumberOr, RelationError, RepeatRatio, SunSynchronous, inclination_and_altitude,
};
use crate::units::round_decimal;

/// Decimals of a degree to which a search resolves angles: the last digit of a TLE.
const ANGLE_DECIMALS: usize = 4;

/// Decimals of a kilometre to which a search resolves altitude: one metre.
const ALTITUDE_DECIMALS: usize = 3;

/// Decimals to which a search resolves eccentricity: 7 m in low orbit.
const ECCENTRICITY_DECIMALS: usize = 6;

/// Positions of the variables that every shell has.
pub(super) const PLANES: usize = 0;
pub(super) const PER_PLANE: usize = 1;

/// What a search varies, or what follows from the other variables.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum IntervalOr<F> {
    /// The limits.
    Between([f64; 2]),
    /// What it follows from.
    Following(F),
}

impl<F> From<[f64; 2]> for IntervalOr<F> {
    fn from(limits: [f64; 2]) -> Self {
        Self::Between(limits)
    }
}

impl<F: Copy> IntervalOr<F> {
    /// The limits, if it has any.
    #[must_use]
    pub fn limits(self) -> Option<[f64; 2]> {
        match self {
            Self::Between(limits) => Some(limits),
            Self::Following(_) => None,
        }
    }

    /// At a value of the variable, if it is one.
    fn at(self, value: Option<f64>) -> NumberOr<F> {
        match self {
            Self::Between([low, _]) => NumberOr::Number(value.unwrap_or(low)),
            Self::Following(of) => NumberOr::Following(of),
        }
    }
}

/// The intervals of a shell, each with its limits, and its steps in a sweep.
#[derive(Debug, Clone, PartialEq)]
pub struct ShellSpace {
    /// Patterns to choose from, at least one.
    pub pattern: Vec<Pattern>,
    /// Planes.
    pub planes: [u32; 2],
    /// Satellites in a plane; the shell may be empty if they start at 0.
    pub satellites_per_plane: [u32; 2],
    /// Inclination, degrees.
    pub inclination_deg: IntervalOr<SunSynchronous>,
    /// Altitude over the equatorial radius, km.
    pub altitude_km: IntervalOr<RepeatRatio>,
    /// Phasing F, or `N_c` of a lattice; capped at P - 1.
    pub phasing: [u32; 2],
    /// Eccentricity; a variable if the limits differ.
    pub eccentricity: [f64; 2],
    /// Argument of perigee, degrees; a variable if the limits differ.
    pub arg_perigee_deg: [f64; 2],
    /// Right ascension of the first node, degrees; `None` for 0.
    pub raan_deg: Option<[f64; 2]>,
    /// Argument of latitude of the first satellite, degrees; `None` for M = 0.
    pub arg_latitude_deg: Option<[f64; 2]>,
    /// From node to node, degrees; `None` for that of the pattern.
    pub node_step_deg: Option<[f64; 2]>,
    /// Steps of a sweep.
    pub steps: SweepSteps,
}

/// The steps of a grid sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SweepSteps {
    /// Step of the inclination, degrees.
    pub inclination_step_deg: f64,
    /// Step of the altitude, km.
    pub altitude_step_km: f64,
    /// Step of the eccentricity.
    pub eccentricity_step: f64,
    /// Step of the argument of perigee, degrees.
    pub arg_perigee_step_deg: f64,
    /// Step of the first node, degrees; `None` for [`SweepSteps::ORIENTATION_DEG`].
    pub raan_step_deg: Option<f64>,
    /// Step of the argument of latitude, degrees; `None` for [`SweepSteps::ORIENTATION_DEG`].
    pub arg_latitude_step_deg: Option<f64>,
    /// Step of the distance between nodes, degrees; `None` for [`SweepSteps::NODE_STEP_DEG`].
    pub node_step_step_deg: Option<f64>,
}

impl SweepSteps {
    /// Step of the angles of orientation unless another is given, degrees.
    pub const ORIENTATION_DEG: f64 = 30.0;
    /// Step of the distance between nodes unless another is given, degrees.
    pub const NODE_STEP_DEG: f64 = 1.0;
}

/// A variable that a shell has only where its limits differ.
struct OptionalVariable {
    name: &'static str,
    limits: [f64; 2],
    decimals: usize,
    step: f64,
}

impl ShellSpace {
    /// The variables (P, S[, i][, h], F[, e][, ω][, Ω][, u][, node step][, pattern]) with their names; those in brackets
    /// only if they vary, so that simpler searches draw the same random numbers with and without them.
    pub(super) fn variables(&self) -> impl Iterator<Item = (&'static str, VariableKind)> + use<> {
        let integer = |[lo, hi]: [u32; 2]| VariableKind::Integer {
            lo: lo.into(),
            hi: hi.into(),
        };
        let real = |[lo, hi]: [f64; 2]| VariableKind::Real { lo, hi };
        let mut variables = vec![
            ("planes", integer(self.planes)),
            ("satellites-per-plane", integer(self.satellites_per_plane)),
        ];
        let inclination = self.inclination_deg.limits();
        variables.extend(inclination.map(|of| ("inclination-deg", real(of))));
        let altitude = self.altitude_km.limits();
        variables.extend(altitude.map(|of| ("altitude-km", real(of))));
        variables.push(("phasing", integer(self.cut_phasing())));
        let varied = self.varied().into_iter();
        variables.extend(varied.map(|one| (one.name, real(one.limits))));
        if self.pattern.len() > 1 {
            let count = self.pattern.len() as u32;
            variables.push(("pattern", VariableKind::Category { count }));
        }
        variables.into_iter()
    }

    /// The steps of a sweep, in the order of the variables.
    pub(super) fn steps(&self) -> Vec<f64> {
        let SweepSteps {
            inclination_step_deg,
            altitude_step_km,
            ..
        } = self.steps;
        let mut steps = vec![1.0, 1.0];
        steps.extend(self.inclination_deg.limits().map(|_| inclination_step_deg));
        steps.extend(self.altitude_km.limits().map(|_| altitude_step_km));
        steps.push(1.0);
        steps.extend(self.varied().iter().map(|one| one.step));
        if self.pattern.len() > 1 {
            steps.push(1.0);
        }
        steps
    }

    /// The real variables after the first five.
    fn varied(&self) -> Vec<OptionalVariable> {
        let steps = &self.steps;
        let (orientation, node_step) = (SweepSteps::ORIENTATION_DEG, SweepSteps::NODE_STEP_DEG);
        let one = |name, limits: Option<[f64; 2]>, decimals, step| {
            let limits = limits.filter(|limits| varies(*limits))?;
            Some(OptionalVariable {
                name,
                limits,
                decimals,
                step,
            })
        };
        let all = [
            one(
                "eccentricity",
                Some(self.eccentricity),
                ECCENTRICITY_DECIMALS,
                steps.eccentricity_step,
            ),
            one(
                "arg-perigee-deg",
                Some(self.arg_perigee_deg),
                ANGLE_DECIMALS,
                steps.arg_perigee_step_deg,
            ),
            one(
                "raan-deg",
                self.raan_deg,
                ANGLE_DECIMALS,
                steps.raan_step_deg.unwrap_or(orientation),
            ),
            one(
                "arg-latitude-deg",
                self.arg_latitude_deg,
                ANGLE_DECIMALS,
                steps.arg_latitude_step_deg.unwrap_or(orientation),
            ),
            one(
                "node-step-deg",
                self.node_step_deg,
                ANGLE_DECIMALS,
                steps.node_step_step_deg.unwrap_or(node_step),
            ),
        ];
        all.into_iter().flatten().collect()
    }

    /// The place of the phasing, after an inclination and an altitude that are variables.
    fn phasing_place(&self) -> usize {
        let orbit = [self.inclination_deg.limits(), self.altitude_km.limits()];
        PER_PLANE + 1 + orbit.iter().flatten().count()
    }

    /// The phasings that can occur: the limits, capped at P - 1 for the fewest and the most planes.
    fn cut_phasing(&self) -> [u32; 2] {
        let cut = |n: usize| self.phasing[n].min(self.planes[n].saturating_sub(1));
        [cut(0), cut(1)]
    }

    /// Clamps the phasing to its limits, both capped at P - 1, and rounds the continuous variables to
    /// their resolution, so that designs have few digits and equal designs are equal vectors.
    pub(super) fn repair(&self, genome: &mut [f64]) {
        let lowest = f64::from(self.phasing[0]);
        let phasing = self.phasing_place();
        genome[phasing] = genome[phasing].max(lowest).min(genome[PLANES] - 1.0);
        let orbit = [
            (self.inclination_deg.limits(), ANGLE_DECIMALS),
            (self.altitude_km.limits(), ALTITUDE_DECIMALS),
        ];
        let orbit = orbit
            .iter()
            .filter_map(|(limits, decimals)| Some(((*limits)?, *decimals)));
        for (value, ([low, high], decimals)) in genome[PER_PLANE + 1..].iter_mut().zip(orbit) {
            *value = round_decimal(*value, decimals).clamp(low, high);
        }
        for (value, one) in genome[phasing + 1..].iter_mut().zip(self.varied()) {
            let [low, high] = one.limits;
            *value = round_decimal(*value, one.decimals).clamp(low, high);
        }
    }

    /// Moves all variables of an empty shell to their lower limits.
    pub(super) fn unify(&self, genome: &mut [f64]) {
        if is_empty(genome) {
            for (value, (_, kind)) in genome.iter_mut().zip(self.variables()) {
                *value = kind.bounds().0;
            }
        }
    }

    /// The shell of its part of a vector; `None` if it is empty.
    pub(super) fn shell(&self, genome: &[f64]) -> Result<Option<Shell>, DesignError> {
        if is_empty(genome) {
            return Ok(None);
        }
        let count = |n: usize| genome[n] as usize;
        let phasing = self.phasing_place();
        let mut orbit = genome[PER_PLANE + 1..phasing].iter().copied();
        let inclination_deg = self.inclination_deg.limits().and_then(|_| orbit.next());
        let altitude_km = self.altitude_km.limits().and_then(|_| orbit.next());
        let mut further = genome[phasing + 1..].iter().copied();
        let mut value = |limits: [f64; 2]| {
            let varied = if varies(limits) { further.next() } else { None };
            varied.unwrap_or(limits[0])
        };
        let eccentricity = value(self.eccentricity);
        let arg_perigee_deg = value(self.arg_perigee_deg);
        let orientation = Orientation {
            raan_deg: self.raan_deg.map_or(0.0, &mut value),
            arg_latitude_deg: self.arg_latitude_deg.map(&mut value),
            node_step_deg: self.node_step_deg.map(&mut value),
        };
        let choice = further.next().unwrap_or(0.0) as usize;
        let pattern = self.pattern.get(choice).or(self.pattern.first());
        let (inclination_deg, altitude_km) =
            self.orbit(inclination_deg, altitude_km, eccentricity)?;
        let shell = Shell::new(ShellParameters {
            pattern: pattern.copied().ok_or(DesignError::NoShell)?,
            planes: count(PLANES),
            satellites_per_plane: count(PER_PLANE),
            phasing: count(phasing),
            inclination_deg,
            altitude_km,
        })?;
        let shell = shell.with_ellipse(eccentricity, arg_perigee_deg)?;
        Ok(Some(shell.with_orientation(orientation)?))
    }

    /// Inclination (degrees) and altitude (km) at values of those that are variables.
    pub(crate) fn orbit(
        &self,
        inclination_deg: Option<f64>,
        altitude_km: Option<f64>,
        eccentricity: f64,
    ) -> Result<(f64, f64), RelationError> {
        let inclination = self.inclination_deg.at(inclination_deg);
        let altitude = self.altitude_km.at(altitude_km);
        inclination_and_altitude(inclination, altitude, eccentricity)
    }

    /// Whether a variable has no effect, since the shell is empty without it.
    pub(super) fn is_idle(&self, genome: &[f64], variable: usize) -> bool {
        is_empty(genome) && variable != PER_PLANE
    }

    /// Whether the shell may have no satellites.
    #[must_use]
    pub fn may_be_empty(&self) -> bool {
        self.satellites_per_plane[0] == 0
    }

    /// Whether two shells have the same designs.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        let same_patterns = self.pattern.len() == other.pattern.len()
            && self.pattern.iter().all(|one| other.pattern.contains(one));
        let other = Self {
            pattern: self.pattern.clone(),
            steps: self.steps,
            ..other.clone()
        };
        same_patterns && *self == other
    }

    /// Whether two of the patterns differ in nothing but the step between nodes, which is given.
    pub(super) fn has_equal_patterns(&self) -> bool {
        let both = [Pattern::Delta, Pattern::Star];
        self.node_step_deg.is_some() && both.iter().all(|one| self.pattern.contains(one))
    }

    /// Number of shells of a sweep, each once although phasings beyond P - 1 and empty shells repeat others.
    #[must_use]
    pub fn distinct_points(&self) -> f64 {
        let others = self.variables().zip(self.steps()).enumerate();
        let phasing = self.phasing_place();
        let others = others.filter(|(n, _)| ![PLANES, PER_PLANE, phasing].contains(n));
        let others: f64 = others.map(|(_, (of, step))| steps_of(of.1, step)).product();
        let [fewest, most] = self.planes;
        let phasings = |planes: u32| {
            let [low, high] = self.phasing.map(|f| f.min(planes.saturating_sub(1)));
            f64::from(high - low + 1)
        };
        let phasings: f64 = (fewest..=most).map(phasings).sum();
        let [low, high] = self.satellites_per_plane;
        let sizes = f64::from(high - low.max(1) + 1);
        let empty = if self.may_be_empty() { 1.0 } else { 0.0 };
        phasings * sizes * others + empty
    }

    /// Upper bound on the number of shells of a sweep.
    #[must_use]
    pub fn grid_points(&self) -> f64 {
        let variables = self.variables().zip(self.steps());
        variables.map(|(of, step)| steps_of(of.1, step)).product()
    }
}

/// Values of a variable with a step.
fn steps_of(kind: VariableKind, step: f64) -> f64 {
    let (lo, hi) = kind.bounds();
    ((hi - lo) / step + STEP_SLACK).floor() + 1.0
}

/// Lets an interval that is an integer number of steps, up to rounding, include its upper limit, in steps.
const STEP_SLACK: f64 = 1e-9;

/// Whether a part of a vector is that of an empty shell.
fn is_empty(genome: &[f64]) -> bool {
    genome[PER_PLANE] < 1.0
}

/// Whether an interval has more than one value.
fn varies([lo, hi]: [f64; 2]) -> bool {
    lo < hi
}
