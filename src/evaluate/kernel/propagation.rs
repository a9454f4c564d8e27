//! Earth-fixed positions of all satellites at one sample.
//!
//! The satellites of a pattern under a secular model share a, e, i, the perigee and all rates. Their
//! angles are those of the epoch plus an angle that is common to the sample, so a few sines and cosines
//! per sample rotate the entire pattern by the angle addition formulas; node and Earth rotate about the
//! same axis and are combined into one angle. Kepler's equation is solved in lanes, without a sine
//! ([`anomaly`]). All other satellites are computed one by one by their propagators.

mod anomaly;

use super::clocks::ClockBlock;
use crate::constellation::Satellite;
use crate::ephemeris::{Ephemeris, EphemerisError, ShellSpan};
use crate::frames::EarthRotation;
use crate::orbit::Model;
use crate::orbit::j2::SecularRates;
use nalgebra::Vector3;
use rayon::prelude::*;
use std::ops::Range;

/// Satellites that are processed together.
pub(super) const BLOCK: usize = 64;

/// So many satellites of an instant are propagated by all threads: a block takes some 20 µs by SGP4, a fork of threads a few.
const CONCURRENT: usize = 8 * BLOCK;

/// Positions of satellites, Earth-fixed, km; NaN in a slot without a satellite.
#[derive(Debug, Clone)]
#[repr(align(64))]
pub(super) struct PositionBlock {
    pub(super) x: [f64; BLOCK],
    pub(super) y: [f64; BLOCK],
    pub(super) z: [f64; BLOCK],
}

/// Positions of all satellites at one sample.
#[derive(Debug, Clone)]
pub(super) struct Positions {
    pub(super) blocks: Vec<PositionBlock>,
    pub(super) count: usize,
    /// Smallest and largest distance from the centre of the Earth, km.
    pub(super) nearest_km: f64,
    pub(super) farthest_km: f64,
}

impl PositionBlock {
    pub(super) const NOWHERE: Self = Self {
        x: [f64::NAN; BLOCK],
        y: [f64::NAN; BLOCK],
        z: [f64::NAN; BLOCK],
    };

    /// Positions of the satellites at these places of an ephemeris, all of one block, by their propagators; returns the smallest
    /// and the largest distance from the centre of the Earth, km.
    fn propagate(
        &mut self,
        ephemeris: &Ephemeris,
        places: Range<usize>,
        elapsed_s: f64,
        rotation: EarthRotation,
    ) -> Result<[f64; 2], EphemerisError> {
        let [mut nearest_km, mut farthest_km] = [f64::INFINITY, 0.0_f64];
        for n in places {
            let satellite = &ephemeris.satellites()[n];
            let place = n % BLOCK;
            let Some(state) = ephemeris.state_or_gap(satellite, elapsed_s)? else {
                let nowhere = f64::NAN;
                (self.x[place], self.y[place], self.z[place]) = (nowhere, nowhere, nowhere);
                continue;
            };
            let position = rotation.to_earth_fixed(state.position_km).km();
            (self.x[place], self.y[place], self.z[place]) = (position.x, position.y, position.z);
            let radius_km = position.norm();
            (nearest_km, farthest_km) = (nearest_km.min(radius_km), farthest_km.max(radius_km));
        }
        Ok([nearest_km, farthest_km])
    }
}

impl Positions {
    pub(super) fn new(count: usize) -> Self {
        Self {
            blocks: vec![PositionBlock::NOWHERE; count.div_ceil(BLOCK)],
            count,
            nearest_km: 0.0,
            farthest_km: 0.0,
        }
    }

    #[inline(always)]
    pub(super) fn at(&self, n: usize) -> [f64; 3] {
        let block = &self.blocks[n / BLOCK];
        let place = n % BLOCK;
        [block.x[place], block.y[place], block.z[place]]
    }

    /// Forgets the distances of the last sample.
    fn restart(&mut self) {
        (self.nearest_km, self.farthest_km) = (f64::INFINITY, 0.0);
    }

    #[inline(always)]
    fn widen(&mut self, nearest_km: f64, farthest_km: f64) {
        self.nearest_km = self.nearest_km.min(nearest_km);
        self.farthest_km = self.farthest_km.max(farthest_km);
    }

    /// The first `count` positions of a block become those from place `first` on.
    #[inline(always)]
    fn copy(&mut self, first: usize, count: usize, from: &PositionBlock) {
        for n in 0..count {
            let block = &mut self.blocks[(first + n) / BLOCK];
            let place = (first + n) % BLOCK;
            block.x[place] = from.x[n];
            block.y[place] = from.y[n];
            block.z[place] = from.z[n];
        }
    }

    /// Positions of all satellites from their propagators, one by one.
    pub(super) fn propagate(
        &mut self,
        ephemeris: &Ephemeris,
        elapsed_s: f64,
        rotation: EarthRotation,
    ) -> Result<(), EphemerisError> {
        self.restart();
        let all = 0..ephemeris.satellites().len();
        self.propagate_some(ephemeris, all, elapsed_s, rotation)
    }

    /// Places outside the range keep their positions. Many satellites are computed by all threads; a distance does not depend
    /// on the order.
    fn propagate_some(
        &mut self,
        ephemeris: &Ephemeris,
        places: Range<usize>,
        elapsed_s: f64,
        rotation: EarthRotation,
    ) -> Result<(), EphemerisError> {
        let first = places.start / BLOCK;
        let end = places.end.div_ceil(BLOCK);
        let one = |(n, block): (usize, &mut PositionBlock)| {
            let from = (first + n) * BLOCK;
            let inside = places.start.max(from)..places.end.min(from + BLOCK);
            block.propagate(ephemeris, inside, elapsed_s, rotation)
        };
        let blocks = &mut self.blocks[first..end];
        let widest = |all: [f64; 2], one: Result<[f64; 2], EphemerisError>| {
            one.map(|one| [all[0].min(one[0]), all[1].max(one[1])])
        };
        let none = [f64::INFINITY, 0.0];
        let [nearest_km, farthest_km] = if places.len() < CONCURRENT {
            blocks
                .iter_mut()
                .enumerate()
                .map(one)
                .try_fold(none, widest)
        } else {
            // Collected, so that of several errors the first is told.
            let found: Vec<_> = blocks.par_iter_mut().enumerate().map(one).collect();
            found.into_iter().try_fold(none, widest)
        }?;
        self.widen(nearest_km, farthest_km);
        Ok(())
    }
}

/// How the satellites of an ephemeris are propagated: shells under a secular model at once, all others one by
/// one.
pub(super) struct Propagation<'a> {
    pub(super) ephemeris: &'a Ephemeris,
    pub(super) patterns: Vec<PatternPropagator>,
    others: Vec<Range<usize>>,
    /// The satellites by their clocks; empty if they share one.
    pub(super) clocks: Vec<ClockBlock>,
}

impl<'a> Propagation<'a> {
    pub(super) fn new(ephemeris: &'a Ephemeris) -> Self {
        let spans = ephemeris.shells();
        let patterns: Vec<_> = spans.iter().filter_map(PatternPropagator::new).collect();
        let (mut others, mut next) = (Vec::new(), 0);
        for pattern in &patterns {
            others.push(next..pattern.places.start);
            next = pattern.places.end;
        }
        others.push(next..ephemeris.satellites().len());
        others.retain(|range| !range.is_empty());
        Self {
            ephemeris,
            patterns,
            others,
            clocks: Vec::new(),
        }
    }

    /// The same satellites with several clocks.
    pub(super) fn with_clocks(self, clocks: Vec<ClockBlock>) -> Self {
        Self { clocks, ..self }
    }

    /// Starts a sample: the positions of the satellites without a pattern, and the rotation of each pattern.
    pub(super) fn start(
        &self,
        elapsed_s: f64,
        rotation: EarthRotation,
        positions: &mut Positions,
        turns: &mut Vec<Turn>,
    ) -> Result<(), EphemerisError> {
        positions.restart();
        for places in &self.others {
            positions.propagate_some(self.ephemeris, places.clone(), elapsed_s, rotation)?;
        }
        turns.clear();
        let turn = |pattern: &PatternPropagator| pattern.turn(elapsed_s, rotation);
        turns.extend(self.patterns.iter().map(turn));
        Ok(())
    }
}

/// A pattern under a secular model.
#[derive(Debug, Clone)]
pub(super) struct PatternPropagator {
    /// Places of its satellites in the ephemeris.
    places: Range<usize>,
    semi_major_axis_km: f64,
    eccentricity: f64,
    sin_i: f64,
    cos_i: f64,
    raan_rate_rad_s: f64,
    /// Of the phase, as defined by `PatternBlock`.
    phase_rate_rad_s: f64,
    arg_perigee_rad: f64,
    arg_perigee_rate_rad_s: f64,
    blocks: Vec<PatternBlock>,
}

/// Cosines and sines of node and phase at the epoch. The phase is the mean anomaly, and in a
/// circular pattern, which has no perigee, the argument of latitude.
#[derive(Debug, Clone)]
#[repr(align(64))]
struct PatternBlock {
    cos_node: [f64; BLOCK],
    sin_node: [f64; BLOCK],
    cos_phase: [f64; BLOCK],
    sin_phase: [f64; BLOCK],
}

impl PatternBlock {
    fn new(satellites: &[Satellite]) -> Self {
        let angle = |of: fn(&Satellite) -> f64, function: fn(f64) -> f64| {
            std::array::from_fn(|n| satellites.get(n).map_or(f64::NAN, |s| function(of(s))))
        };
        let node = |s: &Satellite| s.elements.raan_rad;
        let phase: fn(&Satellite) -> f64 = |s| match s.elements.eccentricity {
            0.0 => s.elements.arg_perigee_rad + s.elements.mean_anomaly_rad,
            _ => s.elements.mean_anomaly_rad,
        };
        Self {
            cos_node: angle(node, f64::cos),
            sin_node: angle(node, f64::sin),
            cos_phase: angle(phase, f64::cos),
            sin_phase: angle(phase, f64::sin),
        }
    }

    /// Positions of the satellites on an orbit of some shape.
    #[inline(always)]
    fn place_at(
        &self,
        orbit: &PatternPropagator,
        turn: &Turn,
        shape: &impl Shape,
        to: &mut PositionBlock,
    ) {
        let (sin_i, cos_i) = (orbit.sin_i, orbit.cos_i);
        for n in 0..BLOCK {
            let (cos_o, sin_o) = (self.cos_node[n], self.sin_node[n]);
            let (cos_p, sin_p) = (self.cos_phase[n], self.sin_phase[n]);
            let cos_node = cos_o * turn.cos_node - sin_o * turn.sin_node;
            let sin_node = sin_o * turn.cos_node + cos_o * turn.sin_node;
            let (along, ahead) = shape.place(
                cos_p * turn.cos_phase - sin_p * turn.sin_phase,
                sin_p * turn.cos_phase + cos_p * turn.sin_phase,
            );
            let level = ahead * cos_i;
            to.x[n] = cos_node * along - sin_node * level;
            to.y[n] = sin_node * along + cos_node * level;
            to.z[n] = ahead * sin_i;
        }
    }
}

impl PatternPropagator {
    /// The propagation of a shell; `None` if its model is not secular or its eccentricity too large for
    /// the lanes.
    pub(super) fn new(span: &ShellSpan) -> Option<Self> {
        let satellites = span.shell.satellites();
        let first = satellites.first()?.elements;
        let rates = match span.model {
            Model::J2 => SecularRates::j2(&first),
            Model::TwoBody => SecularRates::two_body(&first),
            _ => return None,
        };
        let eccentricity = span.shell.eccentricity();
        if eccentricity > anomaly::LARGEST_ECCENTRICITY {
            return None;
        }
        let (sin_i, cos_i) = first.inclination_rad.sin_cos();
        let phase_rate_rad_s = match eccentricity {
            0.0 => rates.arg_latitude_rad_s(),
            _ => rates.mean_anomaly_rad_s,
        };
        Some(Self {
            places: span.places(),
            semi_major_axis_km: first.semi_major_axis_km,
            eccentricity,
            sin_i,
            cos_i,
            raan_rate_rad_s: rates.raan_rad_s,
            phase_rate_rad_s,
            arg_perigee_rad: first.arg_perigee_rad,
            arg_perigee_rate_rad_s: rates.arg_perigee_rad_s,
            blocks: satellites.chunks(BLOCK).map(PatternBlock::new).collect(),
        })
    }

    /// The rotation of the pattern from the epoch to a sample.
    pub(super) fn turn(&self, elapsed_s: f64, rotation: EarthRotation) -> Turn {
        let (sin_phase, cos_phase) = (self.phase_rate_rad_s * elapsed_s).sin_cos();
        let (sin_raan, cos_raan) = (self.raan_rate_rad_s * elapsed_s).sin_cos();
        let arg_perigee_rad = self.arg_perigee_rad + self.arg_perigee_rate_rad_s * elapsed_s;
        let (sin_perigee, cos_perigee) = arg_perigee_rad.sin_cos();
        let node = rotation.direction_to_earth_fixed(Vector3::new(cos_raan, sin_raan, 0.0));
        Turn {
            cos_node: node.x,
            sin_node: node.y,
            cos_phase,
            sin_phase,
            cos_perigee,
            sin_perigee,
        }
    }

    #[inline(always)]
    fn place_all(&self, shape: &impl Shape, turn: &Turn, positions: &mut Positions) {
        let mut scratch = PositionBlock::NOWHERE;
        for (from, first) in self.blocks.iter().zip(self.places.clone().step_by(BLOCK)) {
            let count = BLOCK.min(self.places.end - first);
            // A block of another place or length would spill over its neighbours.
            if count == BLOCK && first.is_multiple_of(BLOCK) {
                from.place_at(self, turn, shape, &mut positions.blocks[first / BLOCK]);
            } else {
                from.place_at(self, turn, shape, &mut scratch);
                positions.copy(first, count, &scratch);
            }
        }
    }

    /// Positions at a sample.
    #[inline(always)]
    pub(super) fn place_at(&self, turn: &Turn, positions: &mut Positions) {
        let (a, e) = (self.semi_major_axis_km, self.eccentricity);
        if e > 0.0 {
            let ellipse = Ellipse {
                semi_major_axis_km: a,
                semi_minor_axis_km: a * (1.0 - e * e).sqrt(),
                eccentricity: e,
                cos_perigee: turn.cos_perigee,
                sin_perigee: turn.sin_perigee,
            };
            self.place_all(&ellipse, turn, positions);
        } else {
            self.place_all(&CircularShape { radius_km: a }, turn, positions);
        }
        positions.widen(a * (1.0 - e), a * (1.0 + e));
    }
}

/// The shape of an orbit in its plane.
trait Shape {
    /// The position at a phase with this cosine and sine: along the node, and 90° ahead of it, km.
    fn place(&self, cos_phase: f64, sin_phase: f64) -> (f64, f64);
}

struct CircularShape {
    radius_km: f64,
}

impl Shape for CircularShape {
    #[inline(always)]
    fn place(&self, cos_phase: f64, sin_phase: f64) -> (f64, f64) {
        (self.radius_km * cos_phase, self.radius_km * sin_phase)
    }
}

struct Ellipse {
    semi_major_axis_km: f64,
    semi_minor_axis_km: f64,
    eccentricity: f64,
    cos_perigee: f64,
    sin_perigee: f64,
}

impl Shape for Ellipse {
    #[inline(always)]
    fn place(&self, cos_phase: f64, sin_phase: f64) -> (f64, f64) {
        let e = self.eccentricity;
        let (cos_e, sin_e) = anomaly::eccentric(cos_phase, sin_phase, e);
        let (x, y) = (
            self.semi_major_axis_km * (cos_e - e),
            self.semi_minor_axis_km * sin_e,
        );
        (
            self.cos_perigee * x - self.sin_perigee * y,
            self.sin_perigee * x + self.cos_perigee * y,
        )
    }
}

/// The rotation of a pattern from its epoch to a sample, and its perigee then.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    cos_node: f64,
    sin_node: f64,
    cos_phase: f64,
    sin_phase: f64,
    cos_perigee: f64,
    sin_perigee: f64,
}
