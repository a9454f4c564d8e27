//! The normal matrix of the position in lanes, and its dilution of precision.

use super::lanes::{LANES, Lanes, Real, Sums};
use super::weighting::Weighting;
use crate::dop::{Factor, Geometry, Symmetric3, pivot_floor};
use std::ops::AddAssign;

/// The GNSS part of the normal matrix at the points of a tile: (x, x), (y, y), (z, z), (x, y),
/// (x, z), (y, z).
pub(super) type Normal = [Lanes<f32>; 6];

/// The GNSS part at the points of a tile, one sample. Each number is an f32 and a remainder, together
/// 48 bits; f32 lanes read only the first.
#[derive(Debug, Clone, Copy)]
pub(super) struct FixedTile<'a> {
    pub(super) normal: &'a Normal,
    pub(super) remainder: &'a Normal,
    /// Satellites minus clocks of the systems with their own clocks.
    pub(super) surplus: &'a [u16; LANES],
    /// Visible satellites of all systems.
    pub(super) visible: &'a [u16; LANES],
    /// The GNSS satellites that share their clock with the design, if any do.
    pub(super) shared: Option<&'a SharedClock>,
}

/// GNSS satellites that share a clock, perhaps with the design; their own contribution is already part of
/// the normal matrix.
#[derive(Debug, Clone)]
pub(super) struct SharedClock {
    /// Σ w v / Σ w, and its remainder.
    pub(super) mean: [Lanes<f32>; 3],
    pub(super) remainder: [Lanes<f32>; 3],
    pub(super) count: Lanes<u32>,
    /// Σ w, and its remainder: the count for unit weights.
    pub(super) weight: [Lanes<f32>; 2],
}

pub(super) const ZERO: Lanes<f32> = Lanes([0.0; LANES]);

impl SharedClock {
    /// No satellite.
    pub(super) const NONE: Self = Self {
        mean: [ZERO; 3],
        remainder: [ZERO; 3],
        count: Lanes([0; LANES]),
        weight: [ZERO; 2],
    };

    /// Takes a lane of another.
    #[inline(always)]
    pub(super) fn set(&mut self, place: usize, from: &Self, lane: usize) {
        for axis in 0..3 {
            self.mean[axis].0[place] = from.mean[axis].0[lane];
            self.remainder[axis].0[place] = from.remainder[axis].0[lane];
        }
        for part in 0..2 {
            self.weight[part].0[place] = from.weight[part].0[lane];
        }
        self.count.0[place] = from.count.0[lane];
    }

    #[inline(always)]
    pub(super) fn mean<R: Real>(&self, axis: usize, lane: usize) -> R {
        R::joined(self.mean[axis].0[lane], self.remainder[axis].0[lane])
    }

    #[inline(always)]
    pub(super) fn weight<R: Real>(&self, lane: usize) -> R {
        R::joined(self.weight[0].0[lane], self.weight[1].0[lane])
    }
}

impl FixedTile<'_> {
    /// No GNSS.
    pub(super) const NONE: Self = FixedTile {
        normal: &[ZERO; 6],
        remainder: &[ZERO; 6],
        surplus: &[0; LANES],
        visible: &[0; LANES],
        shared: None,
    };

    #[inline(always)]
    pub(super) fn normal<R: Real>(&self, element: usize, lane: usize) -> R {
        R::joined(
            self.normal[element].0[lane],
            self.remainder[element].0[lane],
        )
    }
}

/// The f32 nearest to each number.
#[inline(always)]
pub(super) fn nearest(values: &Lanes<f64>) -> Lanes<f32> {
    let mut nearest = ZERO;
    for l in 0..LANES {
        nearest.0[l] = values.0[l] as f32;
    }
    nearest
}

/// The remainder after the nearest f32.
#[inline(always)]
pub(super) fn remainder(values: &Lanes<f64>) -> Lanes<f32> {
    let mut remainder = ZERO;
    for l in 0..LANES {
        remainder.0[l] = (values.0[l] - f64::from(values.0[l] as f32)) as f32;
    }
    remainder
}

/// The six elements of a symmetric matrix at one point.
#[inline(always)]
pub(super) fn at<R: Copy>(matrix: &[Lanes<R>; 6], lane: usize) -> [R; 6] {
    let [xx, yy, zz, xy, xz, yz] = matrix;
    [
        xx.0[lane], yy.0[lane], zz.0[lane], xy.0[lane], xz.0[lane], yz.0[lane],
    ]
}

/// The normal matrix of the position at the points of a tile.
#[derive(Debug, Clone)]
pub(super) struct NormalLanes<R> {
    /// (x, x), (y, y), (z, z), (x, y), (x, z), (y, z).
    pub(super) matrix: [Lanes<R>; 6],
    /// Satellites minus clock states.
    pub(super) surplus: Lanes<u32>,
}

impl<R: Real> NormalLanes<R> {
    /// From the sums over the design and the GNSS part.
    #[inline(always)]
    pub(super) fn new<W: Weighting>(sums: &Sums<R>, fixed: &FixedTile<'_>) -> Self {
        let mut system = Self::of_two_clocks::<W>(sums, fixed);
        if let Some(shared) = fixed.shared {
            system.join_clocks::<W>(sums, shared);
        }
        system
    }

    /// No satellite.
    #[inline(always)]
    pub(super) fn nothing() -> Self {
        Self {
            matrix: [Lanes([R::ZERO; LANES]); 6],
            surplus: Lanes([0; LANES]),
        }
    }

    /// The GNSS part alone.
    #[inline(always)]
    pub(super) fn of_fixed(fixed: &FixedTile<'_>) -> Self {
        let mut system = Self::nothing();
        for l in 0..LANES {
            for (element, matrix) in system.matrix.iter_mut().enumerate() {
                matrix.0[l] = fixed.normal::<R>(element, l);
            }
            system.surplus.0[l] = u32::from(fixed.surplus[l]);
        }
        system
    }

    /// Adds the satellites of a clock of the design.
    #[inline(always)]
    pub(super) fn add_clock<W: Weighting>(&mut self, sums: &Sums<R>) {
        for l in 0..LANES {
            self.add_clock_at::<W>(sums, l);
        }
    }

    /// The same at one point.
    #[inline(always)]
    pub(super) fn add_clock_at<W: Weighting>(&mut self, sums: &Sums<R>, l: usize) {
        let (own, surplus) = of_clock::<W, R>(sums, l);
        for (matrix, own) in self.matrix.iter_mut().zip(own) {
            matrix.0[l] += own;
        }
        self.surplus.0[l] += surplus;
    }

    /// The matrix at one point: (x, x), (y, y), (z, z), (x, y), (x, z), (y, z).
    #[inline(always)]
    pub(super) fn at(&self, lane: usize) -> [R; 6] {
        at(&self.matrix, lane)
    }

    #[inline(always)]
    pub(super) fn trace(&self, lane: usize) -> R {
        let [xx, yy, zz, ..] = &self.matrix;
        xx.0[lane] + yy.0[lane] + zz.0[lane]
    }

    /// The GNSS part and Σ w v vᵀ - (Σ w v)(Σ w v)ᵀ / Σ w of the design.
    #[inline(always)]
    fn of_two_clocks<W: Weighting>(sums: &Sums<R>, fixed: &FixedTile<'_>) -> Self {
        let mut system = Self::nothing();
        for l in 0..LANES {
            let (own, surplus) = of_clock::<W, R>(sums, l);
            system.surplus.0[l] = u32::from(fixed.surplus[l]) + surplus;
            let matrix = &mut system.matrix;
            matrix[0].0[l] = fixed.normal::<R>(0, l) + own[0];
            matrix[1].0[l] = fixed.normal::<R>(1, l) + own[1];
            matrix[2].0[l] = fixed.normal::<R>(2, l) + own[2];
            matrix[3].0[l] = fixed.normal::<R>(3, l) + own[3];
            matrix[4].0[l] = fixed.normal::<R>(4, l) + own[4];
            matrix[5].0[l] = fixed.normal::<R>(5, l) + own[5];
        }
        system
    }

    /// Merges the clock of the design with that of the GNSS: two groups of weights n and m that
    /// become one gain n m / (n + m) δ δᵀ, where δ is the difference of their mean unit vectors (Chan,
    /// Golub and LeVeque, *Amer. Statist.* 37 (1983) 242). This avoids the cancellation in the sums of
    /// both groups together.
    #[inline(always)]
    fn join_clocks<W: Weighting>(&mut self, sums: &Sums<R>, shared: &SharedClock) {
        for l in 0..LANES {
            let (n, m) = (sums.used::<W>(l), shared.count.0[l]);
            let both = u32::from((n > 0) & (m > 0));
            self.surplus.0[l] += m - u32::from(m > 0) + both;
            let (mine, theirs) = (sums.weight::<W>(l), shared.weight::<R>(l));
            let gain = mine * theirs / if n + m > 0 { mine + theirs } else { R::ONE };
            let scale = R::ONE / if mine > R::ZERO { mine } else { R::ONE };
            let centre = [
                sums.centre::<W>(0),
                sums.centre::<W>(1),
                sums.centre::<W>(2),
            ];
            let x = sums.x.0[l] * scale + (centre[0] - shared.mean::<R>(0, l));
            let y = sums.y.0[l] * scale + (centre[1] - shared.mean::<R>(1, l));
            let z = sums.z.0[l] * scale + (centre[2] - shared.mean::<R>(2, l));
            self.matrix[0].0[l] += gain * x * x;
            self.matrix[1].0[l] += gain * y * y;
            self.matrix[2].0[l] += gain * z * z;
            self.matrix[3].0[l] += gain * x * y;
            self.matrix[4].0[l] += gain * x * z;
            self.matrix[5].0[l] += gain * y * z;
        }
    }
}

/// Σ w v vᵀ - (Σ w v)(Σ w v)ᵀ / Σ w of the satellites of a clock at one point, and their number beyond the clock.
#[inline(always)]
fn of_clock<W: Weighting, R: Real>(sums: &Sums<R>, l: usize) -> ([R; 6], u32) {
    let used = sums.used::<W>(l);
    let weight = sums.weight::<W>(l);
    let scale = R::ONE / if weight > R::ZERO { weight } else { R::ONE };
    let (x, y, z) = (sums.x.0[l], sums.y.0[l], sums.z.0[l]);
    let own = [
        sums.xx.0[l] - x * x * scale,
        sums.yy.0[l] - y * y * scale,
        sums.zz::<W>(l) - z * z * scale,
        sums.xy.0[l] - x * y * scale,
        sums.xz.0[l] - x * z * scale,
        sums.yz.0[l] - y * z * scale,
    ];
    (own, used - u32::from(used > 0))
}

impl<R: Real> Default for NormalLanes<R> {
    #[inline(always)]
    fn default() -> Self {
        Self::nothing()
    }
}

impl<R: Real> AddAssign<&Self> for NormalLanes<R> {
    /// Adds satellites with clocks of their own.
    #[inline(always)]
    fn add_assign(&mut self, other: &Self) {
        for (mine, theirs) in self.matrix.iter_mut().zip(&other.matrix) {
            for l in 0..LANES {
                mine.0[l] += theirs.0[l];
            }
        }
        for l in 0..LANES {
            self.surplus.0[l] += other.surplus.0[l];
        }
    }
}

/// Minimum ratio of the determinant to the cube of the trace for which f32 is accurate enough. The
/// smallest eigenvalue is then at least 2⁻¹⁶ of the trace, and rounding 2⁻²² of it.
const LEAST_DETERMINANT: f32 = 1.0 / 65_536.0;

/// Minimum trace. PDOP² is at least 9 divided by it, so no PDOP for which f32 is trusted is lost;
/// below it, rounding may be all there is.
const LEAST_TRACE: f32 = 1.0;

impl NormalLanes<f32> {
    /// PDOP by the minors; infinite if the matrix is too close to singular for f32.
    #[inline(always)]
    pub(super) fn pdop(&self) -> Lanes<f32> {
        let mut lanes = Lanes([f32::INFINITY; LANES]);
        let matrix = &self.matrix;
        for l in 0..LANES {
            let (xx, yy, zz) = (matrix[0].0[l], matrix[1].0[l], matrix[2].0[l]);
            let (xy, xz, yz) = (matrix[3].0[l], matrix[4].0[l], matrix[5].0[l]);
            let minor_zz = xx * yy - xy * xy;
            let minor_yy = xx * zz - xz * xz;
            let minor_xx = yy * zz - yz * yz;
            let determinant = xx * minor_xx - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
            let trace = xx + yy + zz;
            let sound =
                (trace > LEAST_TRACE) & (determinant > LEAST_DETERMINANT * trace * trace * trace);
            let pdop = ((minor_xx + minor_yy + minor_zz) / determinant).root();
            lanes.0[l] = if sound { pdop } else { f32::INFINITY };
        }
        lanes
    }
}

impl NormalLanes<f64> {
    /// Takes the sums of the plain path at one point.
    pub(super) fn set(&mut self, lane: usize, geometry: &Geometry) {
        let Symmetric3 {
            xx,
            yy,
            zz,
            xy,
            xz,
            yz,
        } = geometry.normal();
        for (matrix, element) in self.matrix.iter_mut().zip([xx, yy, zz, xy, xz, yz]) {
            matrix.0[lane] = element;
        }
        self.surplus.0[lane] = geometry.surplus();
    }

    /// PDOP by the factor of the plain path; infinite where a pivot is not clearly above rounding
    /// for satellites of unit weight, `clocks` of them beyond the surplus at most.
    #[inline(always)]
    pub(super) fn pdop(&self, clocks: u32) -> Lanes<f64> {
        self.pdop_of_sum(clocks, 1)
    }

    /// The same of a sum over instants. The order in which they are added moves a pivot by at most two roundings of the weight
    /// for each, an eighth of a floor.
    #[inline(always)]
    pub(super) fn pdop_of_sum(&self, clocks: u32, instants: usize) -> Lanes<f64> {
        let floors = 1.0 + (instants - 1) as f64 / 32.0;
        let mut lanes = Lanes([f64::INFINITY; LANES]);
        for l in 0..LANES {
            let factor = Factor::new(&Symmetric3::from(self.at(l)));
            let weight = f64::from(self.surplus.0[l].saturating_add(clocks));
            let clear = factor.exceeds(floors * clear_pivot(weight));
            let pdop = factor.trace_of_inverse().root();
            lanes.0[l] = if clear { pdop } else { f64::INFINITY };
        }
        lanes
    }
}

/// A pivot above this is above the floor of the plain path too, whose sums are made in another
/// order: storing the GNSS part in 48 bits moves a pivot by at most two floors, and the order of the
/// sums by less than one.
#[inline(always)]
pub(super) fn clear_pivot(weight: f64) -> f64 {
    4.0 * pivot_floor(weight)
}
