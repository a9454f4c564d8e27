//! The normal matrices of positions by range errors, in f64 lanes, for the accuracy in metres.
//!
//! Which samples are solved is decided by the metrics. Where the lanes are in doubt, the sample is left to the sums of the
//! plain path.

use super::super::accuracy::{Accuracy, RangeError};
use super::Kernel;
use super::fixed::FixedSystem;
use super::instructions::Work;
use super::lanes::{LANES, Lanes, MaskTerms, SightLine};
use super::normal::{at, clear_pivot};
use super::sample::{POSITION_STATES, SampleContext, SampleOutcome, TileCandidates, UNSOLVED};
use super::workspace::Workspace;
use crate::dop::{Clocks, Factor, Symmetric3};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::EarthRotation;

/// The normal matrix of one sample by range errors.
pub(in super::super) enum RangeNormal {
    /// The PDOP is not solved.
    Unsolved,
    /// The factor of the matrix.
    Solved(Factor),
    /// To be decided by the sums of the plain path.
    Open,
}

/// One instant.
pub(in super::super) struct RangeInstant {
    pub(in super::super) elapsed_s: f64,
    pub(in super::super) rotation: EarthRotation,
    /// Of each point.
    pub(in super::super) points: Vec<RangeNormal>,
}

impl Kernel {
    /// Passes the normal matrices of all instants to `see`, one instant after the other.
    pub(in super::super) fn range_normals(
        &self,
        ephemeris: &Ephemeris,
        accuracy: &Accuracy,
        mut see: impl FnMut(&RangeInstant) -> Result<(), EphemerisError>,
    ) -> Result<(), EphemerisError> {
        let propagation = &self.propagation(ephemeris);
        let tiles = &self.scene.tiles;
        let mut lanes = vec![RangeLanes::NONE; tiles.tiles.len()];
        let samples = 0..self.setup.grid.len();
        self.run(propagation, samples, self.scene.limits, |evaluating| {
            let systems = self.fixed.systems_at(tiles, evaluating.instant)?;
            self.instructions.run(Weigh {
                scene: &self.scene,
                clocks: self.setup.clocks,
                fixed_mask: &self.fixed.mask,
                systems: &systems,
                accuracy,
                work: evaluating.work,
                to: &mut lanes,
            });
            let points = self.range_points(evaluating.outcome, &lanes);
            see(&RangeInstant {
                elapsed_s: evaluating.instant.elapsed_s,
                rotation: evaluating.instant.rotation,
                points,
            })
        })?;
        Ok(())
    }

    fn range_points(&self, outcome: &SampleOutcome, lanes: &[RangeLanes]) -> Vec<RangeNormal> {
        let open = |_| RangeNormal::Open;
        let mut points: Vec<_> = (0..self.setup.sites.len()).map(open).collect();
        let tiles = self.scene.tiles.tiles.iter().zip(&outcome.pdop);
        for ((tile, pdop), lanes) in tiles.clone().zip(lanes) {
            for (lane, &site) in tile.members.iter().enumerate() {
                points[site as usize] = lanes.normal(lane, pdop.0[lane] < UNSOLVED);
            }
        }
        for doubt in &outcome.doubts {
            let site = self.scene.tiles.tiles[doubt.tile].members[doubt.lane];
            points[site as usize] = RangeNormal::Open;
        }
        points
    }
}

/// The weight 1/σ² of a range by the sine of the elevation.
#[derive(Clone, Copy)]
struct RangeWeight {
    /// sigma² a² and sigma² b².
    constant: f64,
    by_elevation: f64,
}

impl RangeWeight {
    fn new(error: &RangeError) -> Self {
        let sigma2 = error.sigma_m * error.sigma_m;
        Self {
            constant: sigma2 * error.constant * error.constant,
            by_elevation: sigma2 * error.by_elevation * error.by_elevation,
        }
    }

    #[inline(always)]
    fn of(self, sine: f64) -> f64 {
        if self.by_elevation > 0.0 {
            let sine2 = sine * sine;
            sine2 / (self.constant * sine2 + self.by_elevation)
        } else {
            1.0 / self.constant
        }
    }
}

const ZERO: Lanes<f64> = Lanes([0.0; LANES]);

/// The sums over the satellites of one clock at the points of a tile.
struct RangeSums {
    /// Σ w v vᵀ: (x, x), (y, y), (z, z), (x, y), (x, z), (y, z).
    squares: [Lanes<f64>; 6],
    /// Σ w v.
    sum: [Lanes<f64>; 3],
    /// Σ w.
    weight: Lanes<f64>,
    /// Satellites with a weight.
    used: Lanes<u32>,
}

impl RangeSums {
    const NONE: Self = Self {
        squares: [ZERO; 6],
        sum: [ZERO; 3],
        weight: ZERO,
        used: Lanes([0; LANES]),
    };

    #[inline(always)]
    fn add_line(&mut self, line: &SightLine<f64>, is_seen: bool, error: RangeWeight, l: usize) {
        let weight = if is_seen { error.of(line.sine) } else { 0.0 };
        let [x, y, z] = line.unit();
        let (wx, wy, wz) = (weight * x, weight * y, weight * z);
        self.sum[0].0[l] += wx;
        self.sum[1].0[l] += wy;
        self.sum[2].0[l] += wz;
        self.squares[0].0[l] += wx * x;
        self.squares[1].0[l] += wy * y;
        self.squares[2].0[l] += wz * z;
        self.squares[3].0[l] += wx * y;
        self.squares[4].0[l] += wx * z;
        self.squares[5].0[l] += wy * z;
        self.weight.0[l] += weight;
        self.used.0[l] += u32::from(weight > 0.0);
    }
}

/// The normal matrices at the points of a tile.
#[derive(Clone)]
struct RangeLanes {
    normal: [Lanes<f64>; 6],
    /// Σ w of all satellites.
    weight: Lanes<f64>,
    /// Satellites minus clock states.
    surplus: Lanes<u32>,
}

impl RangeLanes {
    const NONE: Self = Self {
        normal: [ZERO; 6],
        weight: ZERO,
        surplus: Lanes([0; LANES]),
    };

    /// Adds Σ w v vᵀ - (Σ w v)(Σ w v)ᵀ / Σ w.
    #[inline(always)]
    fn add(&mut self, group: &RangeSums) {
        for l in 0..LANES {
            let (used, weight) = (group.used.0[l], group.weight.0[l]);
            let [x, y, z] = &group.sum;
            let (x, y, z) = (x.0[l], y.0[l], z.0[l]);
            let scale = 1.0 / if used > 0 { weight } else { 1.0 };
            let of_clock = [x * x, y * y, z * z, x * y, x * z, y * z];
            for (n, of_clock) in of_clock.into_iter().enumerate() {
                self.normal[n].0[l] += group.squares[n].0[l] - of_clock * scale;
            }
            self.weight.0[l] += weight;
            self.surplus.0[l] += used - u32::from(used > 0);
        }
    }

    fn normal(&self, lane: usize, is_solved: bool) -> RangeNormal {
        if !is_solved {
            return RangeNormal::Unsolved;
        }
        let factor = Factor::new(&Symmetric3::from(at(&self.normal, lane)));
        let is_clear = factor.exceeds(clear_pivot(self.weight.0[lane]));
        if is_clear && self.surplus.0[lane] >= POSITION_STATES {
            RangeNormal::Solved(factor)
        } else {
            RangeNormal::Open
        }
    }
}

/// Computes the normal matrices of all points at one instant, after its evaluation.
struct Weigh<'a> {
    scene: &'a SampleContext,
    clocks: Clocks,
    fixed_mask: &'a MaskTerms<f64>,
    systems: &'a [FixedSystem],
    accuracy: &'a Accuracy,
    work: &'a mut Workspace,
    to: &'a mut [RangeLanes],
}

impl Work for Weigh<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let tiles = &self.scene.tiles;
        let leo = RangeWeight::new(&self.accuracy.leo);
        for group in &tiles.groups {
            self.work.select(self.scene, group);
            for number in group.tiles.clone() {
                let to = &mut self.to[number];
                *to = RangeLanes::NONE;
                let mut sums = RangeSums::NONE;
                // A system without a range error has no part in the position.
                for (system, error) in self.systems.iter().zip(&self.accuracy.gnss) {
                    let error = RangeWeight::new(error);
                    let tile = &tiles.tiles[number];
                    system.look(tile, self.fixed_mask, |l, line, seen| {
                        sums.add_line(line, seen, error, l);
                    });
                    if self.clocks == Clocks::PerSystem {
                        to.add(&sums);
                        sums = RangeSums::NONE;
                    }
                }
                let candidates = self.work.candidates(number, group);
                let add = |satellites: TileCandidates<'_>, sums: &mut RangeSums| {
                    let mut add =
                        |l: usize, line: &_, seen: bool| sums.add_line(line, seen, leo, l);
                    satellites.look(self.scene, number, &self.work.positions, &mut add);
                };
                if !self.work.has_several_clocks() {
                    add(candidates, &mut sums);
                    to.add(&sums);
                    continue;
                }
                // Each system has its own clock then, so that no sums are left of the GNSS.
                for clock in candidates.by_clock() {
                    add(clock, &mut sums);
                    to.add(&sums);
                    sums = RangeSums::NONE;
                }
            }
        }
    }
}
