//! The arithmetic of the kernel: sixteen ground points side by side, in f32 or in f64.
//!
//! Each function is one loop over the lanes without a branch, which the compiler turns into
//! vector instructions of whatever width the caller is compiled for. There is no fused
//! multiply-add and no approximate reciprocal: IEEE 754 defines the rounding of every operation, so
//! all instruction sets give the same bits.

use crate::dop::{Factor, Symmetric3, pivot_floor};
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

    fn of(value: f64) -> Self;
    /// A number of satellites.
    fn count(count: u32) -> Self;
    /// A number from the nearest f32 and the remainder.
    fn joined(high: f32, low: f32) -> Self;
    fn root(self) -> Self;
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

/// Sums over the visible satellites of one clock group at each point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sums<R> {
    /// Σ v vᵀ.
    pub(super) xx: Lanes<R>,
    pub(super) yy: Lanes<R>,
    /// Zero where [`Real::SUMS_ZZ`] says so.
    zz: Lanes<R>,
    pub(super) xy: Lanes<R>,
    pub(super) xz: Lanes<R>,
    pub(super) yz: Lanes<R>,
    /// Σ v.
    pub(super) x: Lanes<R>,
    pub(super) y: Lanes<R>,
    pub(super) z: Lanes<R>,
    /// Visible satellites.
    pub(super) count: Lanes<u32>,
    /// Satellites that may be visible.
    pub(super) possible: Lanes<u32>,
}

impl<R: Real> Sums<R> {
    #[inline(always)]
    pub(super) fn zero() -> Self {
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
        }
    }

    #[inline(always)]
    pub(super) fn merge(&mut self, other: &Self) {
        for l in 0..LANES {
            self.xx.0[l] += other.xx.0[l];
            self.yy.0[l] += other.yy.0[l];
            if R::SUMS_ZZ {
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
        }
    }

    /// Element (z, z) of Σ v vᵀ.
    #[inline(always)]
    pub(super) fn zz(&self, lane: usize) -> R {
        if R::SUMS_ZZ {
            self.zz.0[lane]
        } else {
            R::count(self.count.0[lane]) - self.xx.0[lane] - self.yy.0[lane]
        }
    }

    /// Adds a satellite where it is visible. Most of the time is spent in this loop.
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
            let inverse = range2.inverse_root();
            let sine = height * inverse;
            let (seen, possible) = R::above(mask, height, range2, sine);
            let scale = if seen { inverse } else { R::ZERO };
            self.possible.0[l] += u32::from(possible);
            self.count.0[l] += u32::from(seen);
            let (vx, vy, vz) = (dx * scale, dy * scale, dz * scale);
            self.x.0[l] += vx;
            self.y.0[l] += vy;
            self.z.0[l] += vz;
            self.xx.0[l] += vx * vx;
            self.yy.0[l] += vy * vy;
            if R::SUMS_ZZ {
                self.zz.0[l] += vz * vz;
            }
            self.xy.0[l] += vx * vy;
            self.xz.0[l] += vx * vz;
            self.yz.0[l] += vy * vz;
        }
    }
}

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

/// GNSS satellites that share their clock with the design; their own contribution is already part of
/// the normal matrix.
#[derive(Debug, Clone)]
pub(super) struct SharedClock {
    /// Σ v / n, and its remainder.
    pub(super) mean: [Lanes<f32>; 3],
    pub(super) remainder: [Lanes<f32>; 3],
    pub(super) count: Lanes<u32>,
}

pub(super) const ZERO: Lanes<f32> = Lanes([0.0; LANES]);

impl SharedClock {
    #[inline(always)]
    pub(super) fn mean<R: Real>(&self, axis: usize, lane: usize) -> R {
        R::joined(self.mean[axis].0[lane], self.remainder[axis].0[lane])
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
    Lanes(std::array::from_fn(|l| values.0[l] as f32))
}

/// The remainder after the nearest f32.
#[inline(always)]
pub(super) fn remainder(values: &Lanes<f64>) -> Lanes<f32> {
    Lanes(std::array::from_fn(|l| {
        (values.0[l] - f64::from(values.0[l] as f32)) as f32
    }))
}

/// The normal matrix of the position at the points of a tile.
pub(super) struct NormalLanes<R> {
    /// (x, x), (y, y), (z, z), (x, y), (x, z), (y, z).
    matrix: [Lanes<R>; 6],
    /// Satellites minus clock states.
    pub(super) surplus: Lanes<u32>,
}

impl<R: Real> NormalLanes<R> {
    /// From the sums over the design and the GNSS part.
    #[inline(always)]
    pub(super) fn new(sums: &Sums<R>, fixed: &FixedTile<'_>) -> Self {
        let mut system = Self::of_two_clocks(sums, fixed);
        if let Some(shared) = fixed.shared {
            system.join_clocks(sums, shared);
        }
        system
    }

    /// The GNSS part and Σ v vᵀ - (Σ v)(Σ v)ᵀ / n of the design.
    #[inline(always)]
    fn of_two_clocks(sums: &Sums<R>, fixed: &FixedTile<'_>) -> Self {
        let mut system = Self {
            matrix: [Lanes([R::ZERO; LANES]); 6],
            surplus: Lanes([0; LANES]),
        };
        for l in 0..LANES {
            let count = sums.count.0[l];
            let clocks = u32::from(count > 0);
            system.surplus.0[l] = u32::from(fixed.surplus[l]) + count - clocks;
            let scale = R::ONE / R::count(count + 1 - clocks);
            let (x, y, z) = (sums.x.0[l], sums.y.0[l], sums.z.0[l]);
            let (xx, yy, zz) = (sums.xx.0[l], sums.yy.0[l], sums.zz(l));
            let matrix = &mut system.matrix;
            matrix[0].0[l] = fixed.normal::<R>(0, l) + (xx - x * x * scale);
            matrix[1].0[l] = fixed.normal::<R>(1, l) + (yy - y * y * scale);
            matrix[2].0[l] = fixed.normal::<R>(2, l) + (zz - z * z * scale);
            matrix[3].0[l] = fixed.normal::<R>(3, l) + (sums.xy.0[l] - x * y * scale);
            matrix[4].0[l] = fixed.normal::<R>(4, l) + (sums.xz.0[l] - x * z * scale);
            matrix[5].0[l] = fixed.normal::<R>(5, l) + (sums.yz.0[l] - y * z * scale);
        }
        system
    }

    /// Merges the clock of the design with that of the GNSS: two groups of n and m satellites that
    /// become one gain n m / (n + m) δ δᵀ, where δ is the difference of their mean unit vectors (Chan,
    /// Golub and LeVeque, *Amer. Statist.* 37 (1983) 242). This avoids the cancellation in the sums of
    /// both groups together.
    #[inline(always)]
    fn join_clocks(&mut self, sums: &Sums<R>, shared: &SharedClock) {
        for l in 0..LANES {
            let (n, m) = (sums.count.0[l], shared.count.0[l]);
            let both = u32::from((n > 0) & (m > 0));
            self.surplus.0[l] += m - u32::from(m > 0) + both;
            let gain = R::count(n * m) / R::count((n + m).max(1));
            let scale = R::ONE / R::count(n.max(1));
            let x = sums.x.0[l] * scale - shared.mean::<R>(0, l);
            let y = sums.y.0[l] * scale - shared.mean::<R>(1, l);
            let z = sums.z.0[l] * scale - shared.mean::<R>(2, l);
            self.matrix[0].0[l] += gain * x * x;
            self.matrix[1].0[l] += gain * y * y;
            self.matrix[2].0[l] += gain * z * z;
            self.matrix[3].0[l] += gain * x * y;
            self.matrix[4].0[l] += gain * x * z;
            self.matrix[5].0[l] += gain * y * z;
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
    /// PDOP by the factor of the plain path; infinite where a pivot is not clearly above rounding
    /// for satellites of unit weight, `clocks` of them beyond the surplus at most.
    #[inline(always)]
    pub(super) fn pdop(&self, clocks: u32) -> Lanes<f64> {
        let mut lanes = Lanes([f64::INFINITY; LANES]);
        for l in 0..LANES {
            let [xx, yy, zz, xy, xz, yz] = std::array::from_fn(|element| self.matrix[element].0[l]);
            let factor = Factor::new(&Symmetric3 {
                xx,
                yy,
                zz,
                xy,
                xz,
                yz,
            });
            let clear = factor.exceeds(clear_pivot(self.surplus.0[l] + clocks));
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
pub(super) fn clear_pivot(satellites: u32) -> f64 {
    4.0 * pivot_floor(f64::from(satellites))
}
