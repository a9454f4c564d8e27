//! The arithmetic of the kernel: sixteen ground points side by side, in f32 or in f64.
//!
//! Each function is one loop over the lanes without a branch, which the compiler turns into
//! vector instructions of whatever width the caller is compiled for. There is no fused
//! multiply-add and no approximate reciprocal: IEEE 754 defines the rounding of every operation, so
//! all instruction sets give the same bits. Nor does it map arrays: a closure that is not inlined is compiled for the
//! baseline, and called lane by lane.

use super::weighting::Weighting;
use crate::visibility::Mask;
use std::ops::{Add, AddAssign, Div, Mul, Sub};

/// Ground points that are processed side by side.
pub(super) const LANES: usize = 16;

/// One number for each of the points.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(super) struct Lanes<R>(pub(super) [R; LANES]);

/// The two precisions.
pub(super) trait Real:
    Copy
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + AddAssign
{
    const ZERO: Self;
    const ONE: Self;
    /// Whether Σ v_z² is summed; otherwise it is the count minus the other two, which costs nothing
    /// but holds only as far as v is a unit vector.
    const SUMS_ZZ: bool;
    /// Whether weighted sums are taken about a place in the middle of the sky ([`Sums::about`]).
    const IS_CENTRED: bool;

    fn of(value: f64) -> Self;
    /// A number of satellites.
    fn count(count: u32) -> Self;
    /// A number from the nearest f32 and the remainder.
    fn joined(high: f32, low: f32) -> Self;
    fn root(self) -> Self;
    /// The nearest f32.
    fn single(self) -> f32;
    /// One over the root of a squared range.
    fn inverse_root(self) -> Self;
    /// Whether a satellite at this height over the horizon plane and this squared range is at or
    /// above the mask, and whether it may be; `sine` is height over range.
    fn above(mask: &MaskTerms<Self>, height: Self, range2: Self, sine: Self) -> (bool, bool);
}

impl Real for f32 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const SUMS_ZZ: bool = false;
    const IS_CENTRED: bool = true;

    #[inline(always)]
    fn of(value: f64) -> Self {
        value as Self
    }

    #[inline(always)]
    fn count(count: u32) -> Self {
        // Signed conversion is one instruction everywhere; there are fewer than 2^24.
        count as i32 as Self
    }

    #[inline(always)]
    fn joined(high: f32, _low: f32) -> Self {
        high
    }

    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn single(self) -> f32 {
        self
    }

    #[inline(always)]
    fn inverse_root(self) -> Self {
        1.0 / self.sqrt()
    }

    /// Satellites within rounding of the mask are checked again.
    #[inline(always)]
    fn above(mask: &MaskTerms<Self>, _height: Self, _range2: Self, sine: Self) -> (bool, bool) {
        (
            sine >= mask.sine + mask.slack,
            sine >= mask.sine - mask.slack,
        )
    }
}

impl Real for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const SUMS_ZZ: bool = true;
    const IS_CENTRED: bool = false;

    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn count(count: u32) -> Self {
        Self::from(count)
    }

    #[inline(always)]
    fn joined(high: f32, low: f32) -> Self {
        Self::from(high) + Self::from(low)
    }

    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn single(self) -> f32 {
        self as f32
    }

    /// That of f32 with one Newton step, which squares its error of 1e-7: 2e-14, in a third of the
    /// time of a root and a division in f64. The error stretches a line of sight but does not rotate
    /// it, so the pivots of a singular geometry stay at zero: exactly for coplanar directions, and to the
    /// square of the error for those on a cone.
    #[inline(always)]
    fn inverse_root(self) -> Self {
        let seed = f64::from((self as f32).inverse_root());
        seed * (1.5 - 0.5 * self * seed * seed)
    }

    /// The comparison of [`Mask::line_of_sight`], operation by operation.
    #[inline(always)]
    fn above(mask: &MaskTerms<Self>, height: Self, range2: Self, _sine: Self) -> (bool, bool) {
        let seen = (height >= 0.0) & (height * height >= mask.sine2 * range2) & (range2 > 0.0);
        (seen, seen)
    }
}

/// An elevation mask in the form that the lanes compare with.
#[derive(Debug, Clone, Copy)]
pub(super) struct MaskTerms<R> {
    sine: R,
    sine2: R,
    /// Error bound of a sine; 0 in f64, which is exactly the plain path.
    slack: R,
}

impl<R: Real> MaskTerms<R> {
    pub(super) fn new(mask: Mask) -> Self {
        Self {
            sine: R::of(mask.degrees().to_radians().sin()),
            sine2: R::of(mask.sine_squared()),
            slack: R::ZERO,
        }
    }

    /// The sine of the mask.
    #[inline(always)]
    pub(super) fn sine(&self) -> R {
        self.sine
    }

    #[inline(always)]
    pub(super) fn with_slack(self, slack: R) -> Self {
        Self { slack, ..self }
    }
}

/// Positions and verticals of the points of a tile, Earth-fixed, km.
///
/// A lane without a point is NaN, which fails every comparison, so it never sees anything.
#[derive(Debug, Clone)]
pub(super) struct SiteLanes<R> {
    pub(super) origin: [Lanes<R>; 3],
    pub(super) up: [Lanes<R>; 3],
}

/// The line from a point to a satellite, km.
#[derive(Debug, Clone, Copy)]
pub(super) struct SightLine<R> {
    pub(super) to: [R; 3],
    /// One over the range.
    inverse: R,
    /// Of the elevation.
    pub(super) sine: R,
}

impl<R: Real> SightLine<R> {
    /// The unit vector to the satellite.
    #[inline(always)]
    pub(super) fn unit(&self) -> [R; 3] {
        let [x, y, z] = self.to;
        [x * self.inverse, y * self.inverse, z * self.inverse]
    }
}

/// The lines from the points of a tile.
#[derive(Debug, Clone)]
pub(super) struct LineLanes<R> {
    to: [Lanes<R>; 3],
    inverse: Lanes<R>,
    sine: Lanes<R>,
}

impl<R: Real> LineLanes<R> {
    #[inline(always)]
    pub(super) fn nowhere() -> Self {
        let zero = Lanes([R::ZERO; LANES]);
        Self {
            to: [zero; 3],
            inverse: zero,
            sine: zero,
        }
    }

    #[inline(always)]
    pub(super) fn set(&mut self, l: usize, line: &SightLine<R>) {
        for axis in 0..3 {
            self.to[axis].0[l] = line.to[axis];
        }
        (self.inverse.0[l], self.sine.0[l]) = (line.inverse, line.sine);
    }

    #[inline(always)]
    pub(super) fn get(&self, l: usize) -> SightLine<R> {
        SightLine {
            to: [self.to[0].0[l], self.to[1].0[l], self.to[2].0[l]],
            inverse: self.inverse.0[l],
            sine: self.sine.0[l],
        }
    }
}

/// Sums over the visible satellites of one clock group at each point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sums<R> {
    /// Σ w v vᵀ.
    pub(super) xx: Lanes<R>,
    pub(super) yy: Lanes<R>,
    /// Zero where [`Real::SUMS_ZZ`] says so.
    zz: Lanes<R>,
    pub(super) xy: Lanes<R>,
    pub(super) xz: Lanes<R>,
    pub(super) yz: Lanes<R>,
    /// Σ w v.
    pub(super) x: Lanes<R>,
    pub(super) y: Lanes<R>,
    pub(super) z: Lanes<R>,
    /// Visible satellites.
    pub(super) count: Lanes<u32>,
    /// Satellites that may be visible.
    pub(super) possible: Lanes<u32>,
    /// Σ w, and the satellites with a weight: zero for unit weights, whose sum is the count. In f32 a visible satellite
    /// is above the horizon by more than rounding, so that all are used.
    weight: Lanes<R>,
    used: Lanes<u32>,
    /// The place c, where [`Weighting::BY_SINE`] and [`Real::IS_CENTRED`]: v stands for v - c in all sums.
    centre: [R; 3],
}

impl<R: Real> Sums<R> {
    #[inline(always)]
    pub(super) fn zero() -> Self {
        Self::about([R::ZERO; 3])
    }

    /// No satellite yet.
    ///
    /// The normal matrix without its clock is the same about any place c, and what f32 rounds is smaller: weights by
    /// elevation leave most of Σ w v vᵀ to the mean of v, which the clock takes away again.
    #[inline(always)]
    pub(super) fn about(centre: [R; 3]) -> Self {
        let zero = Lanes([R::ZERO; LANES]);
        Self {
            xx: zero,
            yy: zero,
            zz: zero,
            xy: zero,
            xz: zero,
            yz: zero,
            x: zero,
            y: zero,
            z: zero,
            count: Lanes([0; LANES]),
            possible: Lanes([0; LANES]),
            weight: zero,
            used: Lanes([0; LANES]),
            centre,
        }
    }

    /// Whether Σ w v vᵀ has an element (z, z) of its own.
    #[inline(always)]
    fn sums_zz<W: Weighting>() -> bool {
        R::SUMS_ZZ || W::BY_SINE
    }

    /// Whether the satellites with a weight are counted apart.
    #[inline(always)]
    fn counts_used<W: Weighting>() -> bool {
        W::BY_SINE && !R::IS_CENTRED
    }

    /// A component of the place that the sums are about.
    #[inline(always)]
    pub(super) fn centre<W: Weighting>(&self, axis: usize) -> R {
        if W::BY_SINE && R::IS_CENTRED {
            self.centre[axis]
        } else {
            R::ZERO
        }
    }

    /// Forgets the satellites of one point.
    #[inline(always)]
    pub(super) fn clear_at(&mut self, lane: usize) {
        self.xx.0[lane] = R::ZERO;
        self.yy.0[lane] = R::ZERO;
        self.zz.0[lane] = R::ZERO;
        self.xy.0[lane] = R::ZERO;
        self.xz.0[lane] = R::ZERO;
        self.yz.0[lane] = R::ZERO;
        self.x.0[lane] = R::ZERO;
        self.y.0[lane] = R::ZERO;
        self.z.0[lane] = R::ZERO;
        self.weight.0[lane] = R::ZERO;
        (self.count.0[lane], self.possible.0[lane]) = (0, 0);
        self.used.0[lane] = 0;
    }

    #[inline(always)]
    pub(super) fn merge<W: Weighting>(&mut self, other: &Self) {
        for l in 0..LANES {
            self.xx.0[l] += other.xx.0[l];
            self.yy.0[l] += other.yy.0[l];
            if Self::sums_zz::<W>() {
                self.zz.0[l] += other.zz.0[l];
            }
            self.xy.0[l] += other.xy.0[l];
            self.xz.0[l] += other.xz.0[l];
            self.yz.0[l] += other.yz.0[l];
            self.x.0[l] += other.x.0[l];
            self.y.0[l] += other.y.0[l];
            self.z.0[l] += other.z.0[l];
            self.count.0[l] += other.count.0[l];
            self.possible.0[l] += other.possible.0[l];
            if W::BY_SINE {
                self.weight.0[l] += other.weight.0[l];
            }
            if Self::counts_used::<W>() {
                self.used.0[l] += other.used.0[l];
            }
        }
    }

    /// Σ w.
    #[inline(always)]
    pub(super) fn weight<W: Weighting>(&self, lane: usize) -> R {
        if W::BY_SINE {
            self.weight.0[lane]
        } else {
            R::count(self.count.0[lane])
        }
    }

    /// Satellites with a weight.
    #[inline(always)]
    pub(super) fn used<W: Weighting>(&self, lane: usize) -> u32 {
        if Self::counts_used::<W>() {
            self.used.0[lane]
        } else {
            self.count.0[lane]
        }
    }

    /// Element (z, z) of Σ w v vᵀ.
    #[inline(always)]
    pub(super) fn zz<W: Weighting>(&self, lane: usize) -> R {
        if Self::sums_zz::<W>() {
            self.zz.0[lane]
        } else {
            self.weight::<W>(lane) - self.xx.0[lane] - self.yy.0[lane]
        }
    }

    /// What rounding takes its share of: the root of n tr Σ w v vᵀ, which for unit weights is n.
    #[inline(always)]
    pub(super) fn rounded<W: Weighting>(&self, lane: usize) -> R {
        let number = R::count(self.count.0[lane]);
        if W::BY_SINE {
            (number * (self.xx.0[lane] + self.yy.0[lane] + self.zz.0[lane])).root()
        } else {
            number
        }
    }

    /// Adds a satellite where it is visible. Most of the time is spent in this loop.
    #[inline(always)]
    pub(super) fn add<W: Weighting>(
        &mut self,
        sites: &SiteLanes<R>,
        satellite: [R; 3],
        mask: &MaskTerms<R>,
    ) {
        for l in 0..LANES {
            let (line, seen, possible) = sites.line(satellite, mask, l);
            self.add_line::<W>(&line, seen, possible, l);
        }
    }

    #[inline(always)]
    pub(super) fn add_line<W: Weighting>(
        &mut self,
        line: &SightLine<R>,
        seen: bool,
        possible: bool,
        l: usize,
    ) {
        let [dx, dy, dz] = line.to;
        let scale = if seen { line.inverse } else { R::ZERO };
        self.possible.0[l] += u32::from(possible);
        self.count.0[l] += u32::from(seen);
        let (mut vx, mut vy, mut vz) = (dx * scale, dy * scale, dz * scale);
        let mut each = R::ONE;
        if W::BY_SINE {
            each = if seen { line.sine } else { R::ZERO };
            let weight = each * each;
            self.weight.0[l] += weight;
            if Self::counts_used::<W>() {
                self.used.0[l] += u32::from(weight > R::ZERO);
            }
            // w v vᵀ is the square of sin(elevation) v.
            vx = (vx - self.centre::<W>(0)) * each;
            vy = (vy - self.centre::<W>(1)) * each;
            vz = (vz - self.centre::<W>(2)) * each;
        }
        self.x.0[l] += vx * each;
        self.y.0[l] += vy * each;
        self.z.0[l] += vz * each;
        self.xx.0[l] += vx * vx;
        self.yy.0[l] += vy * vy;
        if Self::sums_zz::<W>() {
            self.zz.0[l] += vz * vz;
        }
        self.xy.0[l] += vx * vy;
        self.xz.0[l] += vx * vz;
        self.yz.0[l] += vy * vz;
    }
}

impl<R: Real> SiteLanes<R> {
    /// The line from a point to a satellite, whether this is at or above the mask, and whether it may be.
    #[inline(always)]
    pub(super) fn line(
        &self,
        satellite: [R; 3],
        mask: &MaskTerms<R>,
        l: usize,
    ) -> (SightLine<R>, bool, bool) {
        let [origin_x, origin_y, origin_z] = &self.origin;
        let [up_x, up_y, up_z] = &self.up;
        let dx = satellite[0] - origin_x.0[l];
        let dy = satellite[1] - origin_y.0[l];
        let dz = satellite[2] - origin_z.0[l];
        let height = up_x.0[l] * dx + up_y.0[l] * dy + up_z.0[l] * dz;
        let range2 = dx * dx + dy * dy + dz * dz;
        let inverse = range2.inverse_root();
        let sine = height * inverse;
        let (seen, possible) = R::above(mask, height, range2, sine);
        let line = SightLine {
            to: [dx, dy, dz],
            inverse,
            sine,
        };
        (line, seen, possible)
    }
}
