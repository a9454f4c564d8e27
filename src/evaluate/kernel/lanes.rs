//! The arithmetic of the kernel: sixteen ground points side by side, in f32 or in f64.
//!
//! Each function is one loop over the lanes without a branch, which the compiler turns into
//! vector instructions of whatever width the caller is compiled for. There is no fused
//! multiply-add and no approximate reciprocal: every operation is one that IEEE 754 rounds in
//! one way, so that all instruction sets give the same bits.

use crate::visibility::Mask;
use std::ops::{Add, AddAssign, Div, Mul, Sub};

/// Ground points that are worked on side by side.
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
    /// Stands for a position block that is not positive definite.
    const NO_SOLUTION: Self;

    fn of(value: f64) -> Self;
    /// A number of satellites.
    fn count(count: u32) -> Self;
    /// A number from its f32 nearest and what that leaves over.
    fn joined(high: f32, low: f32) -> Self;
    fn root(self) -> Self;
    fn magnitude(self) -> Self;
    /// Whether a satellite at this height over the horizon plane and this squared range is at or
    /// above the mask; `sine` is height over range.
    fn above(mask: &MaskTerms<Self>, height: Self, range2: Self, sine: Self) -> bool;
}

impl Real for f32 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const NO_SOLUTION: Self = Self::INFINITY;

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
    fn magnitude(self) -> Self {
        self.abs()
    }

    /// Good enough, because decisions close to the mask are taken again.
    #[inline(always)]
    fn above(mask: &MaskTerms<Self>, _height: Self, _range2: Self, sine: Self) -> bool {
        sine >= mask.sine
    }
}

impl Real for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const NO_SOLUTION: Self = Self::INFINITY;

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
    fn magnitude(self) -> Self {
        self.abs()
    }

    /// The comparison of [`Mask::line_of_sight`], operation by operation.
    #[inline(always)]
    fn above(mask: &MaskTerms<Self>, height: Self, range2: Self, _sine: Self) -> bool {
        (height >= 0.0) & (height * height >= mask.sine2 * range2) & (range2 > 0.0)
    }
}

/// An elevation mask as the lanes compare with it.
#[derive(Debug, Clone, Copy)]
pub(super) struct MaskTerms<R> {
    sine: R,
    sine2: R,
}

impl<R: Real> MaskTerms<R> {
    pub(super) fn new(mask: Mask) -> Self {
        Self {
            sine: R::of(mask.degrees().to_radians().sin()),
            sine2: R::of(mask.sine_squared()),
        }
    }
}

/// Positions and verticals of the points of a tile, Earth-fixed, km.
///
/// A lane without a point holds NaN, which no comparison passes: it never sees anything.
#[derive(Debug, Clone)]
pub(super) struct SiteLanes<R> {
    pub(super) origin: [Lanes<R>; 3],
    pub(super) up: [Lanes<R>; 3],
}

/// What the visible satellites of one clock group leave at each point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sums<R> {
    /// Σ v vᵀ without (z, z), which is the count less the other two: v is a unit vector.
    pub(super) xx: Lanes<R>,
    pub(super) yy: Lanes<R>,
    pub(super) xy: Lanes<R>,
    pub(super) xz: Lanes<R>,
    pub(super) yz: Lanes<R>,
    /// Σ v.
    pub(super) x: Lanes<R>,
    pub(super) y: Lanes<R>,
    pub(super) z: Lanes<R>,
    /// Visible satellites.
    pub(super) count: Lanes<u32>,
    /// How close the sine of the nearest decision came to the mask.
    pub(super) margin: Lanes<R>,
}

impl<R: Real> Sums<R> {
    #[inline(always)]
    pub(super) fn zero() -> Self {
        let zero = Lanes([R::ZERO; LANES]);
        Self {
            xx: zero,
            yy: zero,
            xy: zero,
            xz: zero,
            yz: zero,
            x: zero,
            y: zero,
            z: zero,
            count: Lanes([0; LANES]),
            margin: Lanes([R::ONE; LANES]),
        }
    }

    /// Adds a satellite where it is visible. This loop is where the time goes.
    #[inline(always)]
    pub(super) fn add(&mut self, sites: &SiteLanes<R>, satellite: [R; 3], mask: &MaskTerms<R>) {
        let [origin_x, origin_y, origin_z] = &sites.origin;
        let [up_x, up_y, up_z] = &sites.up;
        for l in 0..LANES {
            let dx = satellite[0] - origin_x.0[l];
            let dy = satellite[1] - origin_y.0[l];
            let dz = satellite[2] - origin_z.0[l];
            let height = up_x.0[l] * dx + up_y.0[l] * dy + up_z.0[l] * dz;
            let range2 = dx * dx + dy * dy + dz * dz;
            let inverse = R::ONE / range2.root();
            let sine = height * inverse;
            let seen = R::above(mask, height, range2, sine);
            let margin = (sine - mask.sine).magnitude();
            let nearest = self.margin.0[l];
            self.margin.0[l] = if margin < nearest { margin } else { nearest };
            let scale = if seen { inverse } else { R::ZERO };
            self.count.0[l] += u32::from(seen);
            let (vx, vy, vz) = (dx * scale, dy * scale, dz * scale);
            self.x.0[l] += vx;
            self.y.0[l] += vy;
            self.z.0[l] += vz;
            self.xx.0[l] += vx * vx;
            self.yy.0[l] += vy * vy;
            self.xy.0[l] += vx * vy;
            self.xz.0[l] += vx * vz;
            self.yz.0[l] += vy * vz;
        }
    }
}

/// The GNSS part of the normal matrix at the points of a tile: (x, x), (y, y), (z, z), (x, y),
/// (x, z), (y, z).
pub(super) type Normal = [Lanes<f32>; 6];

/// The GNSS part at the points of a tile, one sample. Each number is an f32 and a remainder,
/// which together hold 48 bits; f32 lanes read the first alone.
#[derive(Debug, Clone, Copy)]
pub(super) struct FixedTile<'a> {
    pub(super) normal: &'a Normal,
    pub(super) remainder: &'a Normal,
    /// Satellites less clocks of the systems with clocks of their own.
    pub(super) surplus: &'a [u8; LANES],
    pub(super) shared: &'a SharedClock,
}

/// The GNSS satellites that share their clock with the design.
#[derive(Debug, Clone)]
pub(super) struct SharedClock {
    /// Σ v, and its remainder.
    pub(super) sum: [Lanes<f32>; 3],
    pub(super) remainder: [Lanes<f32>; 3],
    pub(super) count: Lanes<u32>,
}

pub(super) const ZERO: Lanes<f32> = Lanes([0.0; LANES]);

impl SharedClock {
    pub(super) const NONE: Self = Self {
        sum: [ZERO; 3],
        remainder: [ZERO; 3],
        count: Lanes([0; LANES]),
    };

    #[inline(always)]
    pub(super) fn sum<R: Real>(&self, axis: usize, lane: usize) -> R {
        R::joined(self.sum[axis].0[lane], self.remainder[axis].0[lane])
    }
}

impl FixedTile<'_> {
    /// No GNSS.
    pub(super) const NONE: Self = FixedTile {
        normal: &[ZERO; 6],
        remainder: &[ZERO; 6],
        surplus: &[0; LANES],
        shared: &SharedClock::NONE,
    };

    #[inline(always)]
    pub(super) fn normal<R: Real>(&self, element: usize, lane: usize) -> R {
        R::joined(
            self.normal[element].0[lane],
            self.remainder[element].0[lane],
        )
    }
}

/// Numbers as the f32 nearest to each and what that leaves over.
pub(super) fn split(values: &Lanes<f64>) -> (Lanes<f32>, Lanes<f32>) {
    let nearest = values.0.map(|value| value as f32);
    let remainder = std::array::from_fn(|l| (values.0[l] - f64::from(nearest[l])) as f32);
    (Lanes(nearest), Lanes(remainder))
}

/// PDOP at the points of a tile, and satellites less clock states.
pub(super) struct Solution<R> {
    /// [`Real::NO_SOLUTION`] where the position block is not positive definite.
    pub(super) pdop: Lanes<R>,
    pub(super) surplus: Lanes<u32>,
}

impl<R: Real> Solution<R> {
    /// From the sums over the design and the GNSS part.
    #[inline(always)]
    pub(super) fn new(sums: &Sums<R>, fixed: &FixedTile<'_>) -> Self {
        let mut solution = Self {
            pdop: Lanes([R::ZERO; LANES]),
            surplus: Lanes([0; LANES]),
        };
        for l in 0..LANES {
            let design = sums.count.0[l];
            let count = design + fixed.shared.count.0[l];
            let clocks = u32::from(count > 0);
            solution.surplus.0[l] = u32::from(fixed.surplus[l]) + count - clocks;
            let scale = R::ONE / R::count(count + 1 - clocks);
            let x = sums.x.0[l] + fixed.shared.sum::<R>(0, l);
            let y = sums.y.0[l] + fixed.shared.sum::<R>(1, l);
            let z = sums.z.0[l] + fixed.shared.sum::<R>(2, l);
            let squares_zz = R::count(design) - sums.xx.0[l] - sums.yy.0[l];
            let xx = fixed.normal::<R>(0, l) + (sums.xx.0[l] - x * x * scale);
            let yy = fixed.normal::<R>(1, l) + (sums.yy.0[l] - y * y * scale);
            let zz = fixed.normal::<R>(2, l) + (squares_zz - z * z * scale);
            let xy = fixed.normal::<R>(3, l) + (sums.xy.0[l] - x * y * scale);
            let xz = fixed.normal::<R>(4, l) + (sums.xz.0[l] - x * z * scale);
            let yz = fixed.normal::<R>(5, l) + (sums.yz.0[l] - y * z * scale);
            let minor_zz = xx * yy - xy * xy;
            let minor_yy = xx * zz - xz * xz;
            let minor_xx = yy * zz - yz * yz;
            let determinant = xx * minor_xx - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
            let definite = (xx > R::ZERO) & (minor_zz > R::ZERO) & (determinant > R::ZERO);
            let pdop = ((minor_xx + minor_yy + minor_zz) / determinant).root();
            solution.pdop.0[l] = if definite { pdop } else { R::NO_SOLUTION };
        }
        solution
    }
}
