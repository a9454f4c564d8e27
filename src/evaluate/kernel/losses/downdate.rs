//! The geometry of a tile, from which satellites are taken away.

use super::super::lanes::{LANES, Lanes, Sums};
use super::super::normal::{FixedTile, NormalLanes, at};
use super::super::sample::POSITION_STATES;
use super::super::weighting::Weighting;
use super::sky::LaneSight;

/// A geometry is good where the determinant of its normal matrix exceeds this share of its cubed trace (1/27 is the most
/// that there can be): then no eigenvalue is below a sixtieth of the largest, and few digits are lost.
const GOOD_DETERMINANT: f64 = 1.0 / 256.0;

/// PDOP above which the plain path decides.
const UP_TO: f64 = 5.0;

/// Relative distance of PDOP² from that of a threshold within which the plain path decides.
const NEAR: f64 = 2e-9;

/// Where the lanes decide, in PDOP².
#[derive(Debug, Clone, Copy)]
pub(super) struct LossLimits {
    up_to: f64,
    available: f64,
}

impl LossLimits {
    pub(super) fn new(cap: f64, available: f64) -> Self {
        let up_to = UP_TO.min(cap * (1.0 - NEAR));
        Self {
            up_to: up_to * up_to,
            available: available * available,
        }
    }

    /// Whether a sample whose square the lanes decide is available.
    #[inline(always)]
    pub(super) fn is_available(&self, square: f64) -> bool {
        square <= self.available
    }

    #[inline(always)]
    fn decide(&self, square: f64) -> bool {
        (square <= self.up_to) & ((square - self.available).abs() > self.available * NEAR)
    }
}

/// The geometry at the points of a tile.
#[derive(Debug, Clone)]
pub(super) struct TileGeometry {
    /// A⁻¹: (x, x), (y, y), (z, z), (x, y), (x, z), (y, z).
    inverse: [Lanes<f64>; 6],
    /// tr A⁻¹, the square of PDOP.
    square: Lanes<f64>,
    /// The share of the determinant that must be left for the geometry to be good.
    least_share: Lanes<f64>,
    /// Satellites minus clock states.
    surplus: Lanes<f64>,
    /// Of the satellites that share their clock with the design, the GNSS included: mean unit vector, weight and number.
    mean: [Lanes<f64>; 3],
    weight: Lanes<f64>,
    count: Lanes<f64>,
}

/// What a satellite takes off the geometry at one point.
struct Removal {
    /// A⁻¹ δ.
    along: [f64; 3],
    delta: [f64; 3],
    /// w G and G - w.
    gain: f64,
    rest: f64,
    /// (G - w) times the share of the determinant that is left.
    left: f64,
    /// Whether it determines only its clock, or nothing.
    is_idle: bool,
    used: f64,
}

impl TileGeometry {
    #[inline(always)]
    pub(super) fn new<W: Weighting>(sums: &Sums<f64>, fixed: &FixedTile<'_>) -> Self {
        let normal = NormalLanes::new::<W>(sums, fixed);
        let zero = Lanes([0.0; LANES]);
        let mut geometry = Self {
            inverse: [zero; 6],
            square: zero,
            least_share: zero,
            surplus: zero,
            mean: [zero; 3],
            weight: zero,
            count: zero,
        };
        for l in 0..LANES {
            let [xx, yy, zz, xy, xz, yz] = normal.at(l);
            let (of_xx, of_yy, of_zz) = (yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy);
            let (of_xy, of_xz, of_yz) = (xz * yz - xy * zz, xy * yz - yy * xz, xy * xz - xx * yz);
            let determinant = xx * of_xx + xy * of_xy + xz * of_xz;
            let trace = xx + yy + zz;
            let needed = GOOD_DETERMINANT * trace * trace * trace;
            let scale = 1.0 / determinant;
            for (lanes, cofactor) in geometry
                .inverse
                .iter_mut()
                .zip([of_xx, of_yy, of_zz, of_xy, of_xz, of_yz])
            {
                lanes.0[l] = cofactor * scale;
            }
            geometry.square.0[l] = (of_xx + of_yy + of_zz) * scale;
            let is_good = determinant > needed;
            geometry.least_share.0[l] = if is_good {
                needed * scale
            } else {
                f64::INFINITY
            };
            geometry.surplus.0[l] = f64::from(normal.surplus.0[l]);
            let (mine, used) = (sums.weight::<W>(l), f64::from(sums.used::<W>(l)));
            let (theirs, mean, count) = match fixed.shared {
                Some(shared) => (
                    shared.weight::<f64>(l),
                    [shared.mean(0, l), shared.mean(1, l), shared.mean(2, l)],
                    f64::from(shared.count.0[l]),
                ),
                None => (0.0, [0.0; 3], 0.0),
            };
            let weight = mine + theirs;
            let scale = 1.0 / if weight > 0.0 { weight } else { 1.0 };
            for (axis, sum) in [&sums.x, &sums.y, &sums.z].into_iter().enumerate() {
                geometry.mean[axis].0[l] = (sum.0[l] + mean[axis] * theirs) * scale;
            }
            geometry.weight.0[l] = weight;
            geometry.count.0[l] = used + count;
        }
        geometry
    }

    /// PDOP; infinite where there are too few satellites, NaN where the plain path decides.
    #[inline(always)]
    pub(super) fn pdop(&self, limits: &LossLimits) -> Lanes<f64> {
        let mut pdop = Lanes([0.0; LANES]);
        for l in 0..LANES {
            let is_good = self.least_share.0[l] < 1.0;
            let enough = self.surplus.0[l] >= f64::from(POSITION_STATES);
            pdop.0[l] = verdict(self.square.0[l], is_good, enough, limits);
        }
        pdop
    }

    /// The same without a satellite, where it is seen.
    #[inline(always)]
    pub(super) fn pdop_without(&self, one: &LaneSight, limits: &LossLimits) -> Lanes<f64> {
        let mut pdop = Lanes([0.0; LANES]);
        for l in 0..LANES {
            let (square, is_good, enough) = self.without(one, l);
            pdop.0[l] = verdict(square, is_good, enough, limits);
        }
        pdop
    }

    /// The square of that where the lanes decide and the sample is solved; elsewhere 0.
    #[inline(always)]
    pub(super) fn square_without(&self, one: &LaneSight, limits: &LossLimits) -> Lanes<f64> {
        let mut squares = Lanes([0.0; LANES]);
        for l in 0..LANES {
            let (square, is_good, enough) = self.without(one, l);
            let is_decided = is_good & enough & limits.decide(square);
            squares.0[l] = if is_decided { square } else { 0.0 };
        }
        squares
    }

    /// The square of PDOP without a satellite, whether the geometry is still good, and whether there are enough satellites.
    #[inline(always)]
    fn without(&self, one: &LaneSight, l: usize) -> (f64, bool, bool) {
        let removal = self.removal(one, l);
        let [x, y, z] = removal.along;
        let rise = removal.gain * (x * x + y * y + z * z) / removal.left;
        let rise = if removal.is_idle { 0.0 } else { rise };
        let least = self.least_share.0[l];
        let (left, whole) = if removal.is_idle {
            (1.0, 1.0)
        } else {
            (removal.left, removal.rest)
        };
        let gone = if removal.is_idle { 0.0 } else { removal.used };
        let enough = self.surplus.0[l] - gone >= f64::from(POSITION_STATES);
        (self.square.0[l] + rise, left > least * whole, enough)
    }

    /// Takes a satellite away.
    #[inline(always)]
    pub(super) fn remove(&mut self, one: &LaneSight) {
        for l in 0..LANES {
            let removal = self.removal(one, l);
            let [x, y, z] = removal.along;
            let moved = if removal.is_idle { 0.0 } else { 1.0 };
            let scale = if removal.is_idle {
                0.0
            } else {
                removal.gain / removal.left
            };
            for (lanes, square) in
                self.inverse
                    .iter_mut()
                    .zip([x * x, y * y, z * z, x * y, x * z, y * z])
            {
                lanes.0[l] += scale * square;
            }
            self.square.0[l] += scale * (x * x + y * y + z * z);
            let share = if removal.is_idle {
                1.0
            } else {
                removal.rest / removal.left
            };
            let share = if share > 0.0 { share } else { f64::INFINITY };
            self.least_share.0[l] *= share;
            let pull = if removal.is_idle {
                0.0
            } else {
                one.weight.0[l] / removal.rest
            };
            for (lanes, delta) in self.mean.iter_mut().zip(removal.delta) {
                lanes.0[l] -= pull * delta;
            }
            self.surplus.0[l] -= moved * removal.used;
            self.weight.0[l] -= one.weight.0[l];
            self.count.0[l] -= removal.used;
        }
    }

    #[inline(always)]
    fn removal(&self, one: &LaneSight, l: usize) -> Removal {
        let [xx, yy, zz, xy, xz, yz] = at(&self.inverse, l);
        let [unit, mean] = [&one.unit, &self.mean];
        let x = unit[0].0[l] - mean[0].0[l];
        let y = unit[1].0[l] - mean[1].0[l];
        let z = unit[2].0[l] - mean[2].0[l];
        let delta = [x, y, z];
        let along = [
            xx * x + xy * y + xz * z,
            xy * x + yy * y + yz * z,
            xz * x + yz * y + zz * z,
        ];
        let (weight, all) = (one.weight.0[l], self.weight.0[l]);
        let (gain, rest) = (weight * all, all - weight);
        let used = if weight > 0.0 { 1.0 } else { 0.0 };
        Removal {
            left: rest - gain * (x * along[0] + y * along[1] + z * along[2]),
            along,
            delta,
            gain,
            rest,
            is_idle: (weight <= 0.0) | (self.count.0[l] <= 1.0),
            used,
        }
    }
}

/// PDOP of its square; infinite where there are too few satellites, NaN where the plain path decides.
#[inline(always)]
fn verdict(square: f64, is_good: bool, enough: bool, limits: &LossLimits) -> f64 {
    let pdop = if is_good & limits.decide(square) {
        square.sqrt()
    } else {
        f64::NAN
    };
    if enough { pdop } else { f64::INFINITY }
}
