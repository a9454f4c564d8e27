//! Position dilution of precision with one clock state per clock group.
//!
//! Least squares with three position states and one clock state for each group of systems that
//! share a clock. The clock is eliminated by the Schur complement: a group of n visible satellites
//! with unit vectors v contributes A = Σ v vᵀ - (Σ v)(Σ v)ᵀ / n to the normal matrix of the position,
//! and PDOP² = tr(A⁻¹) of the sum over groups ([M-24](crate::models#m-24) to
//! [M-26](crate::models#m-26); with weights [M-27](crate::models#m-27)). The full geometry matrix is
//! never built.
//!
//! If the directions leave a component of the position undetermined, A is singular up to rounding.
//! [`Geometry`] alone decides whether a sample is solved, from the pivots of A.

mod downdate;
mod factor;
mod family;
mod sky;

pub(crate) use factor::{Factor, pivot_floor};
pub use family::{DopFamily, ObservationWeights};
pub use sky::{SkyClock, SkyDops, SkyRule, SkySatellite, SkyView};

use crate::keyword::keywords;
use nalgebra::Vector3;
use std::ops::AddAssign;

keywords! {
    /// Which systems share a clock state.
    Clocks {
        /// One for each system in view.
        PerSystem = "per-system",
        /// One for all systems.
        Shared = "shared",
    }
}

keywords! {
    /// Which LEO satellites share a clock state, where each system has its own.
    LeoClocks {
        /// All of a constellation.
        Shared = "shared",
        /// Those of each shell, and those of each file.
        PerPart = "per-part",
    }
}

/// A symmetric 3x3 matrix: the upper triangle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Symmetric3 {
    /// Element (x, x).
    pub xx: f64,
    /// Element (y, y).
    pub yy: f64,
    /// Element (z, z).
    pub zz: f64,
    /// Element (x, y).
    pub xy: f64,
    /// Element (x, z).
    pub xz: f64,
    /// Element (y, z).
    pub yz: f64,
}

impl Symmetric3 {
    /// `scale` v vᵀ.
    #[must_use]
    pub fn outer(v: Vector3<f64>, scale: f64) -> Self {
        let s = v * scale;
        Self {
            xx: s.x * v.x,
            yy: s.y * v.y,
            zz: s.z * v.z,
            xy: s.x * v.y,
            xz: s.x * v.z,
            yz: s.y * v.z,
        }
    }
}

/// In the order of the fields.
impl From<[f64; 6]> for Symmetric3 {
    #[inline(always)]
    fn from([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> Self {
        Self {
            xx,
            yy,
            zz,
            xy,
            xz,
            yz,
        }
    }
}

impl AddAssign for Symmetric3 {
    fn add_assign(&mut self, other: Self) {
        self.xx += other.xx;
        self.yy += other.yy;
        self.zz += other.zz;
        self.xy += other.xy;
        self.xz += other.xz;
        self.yz += other.yz;
    }
}

/// The observations that share one clock, each with its least-squares weight.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ClockGroup {
    /// Σ w v vᵀ.
    squares: Symmetric3,
    /// Σ w v.
    sum: Vector3<f64>,
    /// Σ w.
    weight: f64,
    /// Number of satellites.
    count: u32,
}

impl ClockGroup {
    /// Adds a visible satellite by its unit vector; a weight of zero or less adds nothing.
    pub fn add(&mut self, unit: Vector3<f64>, weight: f64) {
        if weight > 0.0 {
            self.squares += Symmetric3::outer(unit, weight);
            self.sum += unit * weight;
            self.weight += weight;
            self.count += 1;
        }
    }
}

impl AddAssign for ClockGroup {
    fn add_assign(&mut self, other: Self) {
        self.squares += other.squares;
        self.sum += other.sum;
        self.weight += other.weight;
        self.count += other.count;
    }
}

/// Maximum cap on PDOP: above it, rounding would influence whether a sample is solved.
pub const MOST_PDOP_CAP: f64 = 1e6;

/// The normal matrix of the position, accumulated group by group.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Geometry {
    normal: Symmetric3,
    /// Σ w over all satellites, including those that determine only their clock.
    weight: f64,
    satellites: u32,
    clocks: u32,
}

impl AddAssign<&Self> for Geometry {
    /// Adds the observations of another geometry, with clocks of their own.
    fn add_assign(&mut self, other: &Self) {
        self.normal += other.normal;
        self.weight += other.weight;
        self.satellites += other.satellites;
        self.clocks += other.clocks;
    }
}

/// The solution of a geometry.
pub(crate) struct Solution {
    pub(crate) pdop: f64,
    pub(crate) factor: Factor,
}

impl Geometry {
    /// Adds the satellites of one clock. An empty group adds nothing, not even a clock state; a lone
    /// satellite determines only its clock and leaves the normal matrix unchanged to the bit.
    pub fn add(&mut self, group: &ClockGroup) {
        if group.count == 0 {
            return;
        }
        if group.count > 1 {
            self.normal += group.squares;
            self.normal += Symmetric3::outer(group.sum, -1.0 / group.weight);
        }
        self.weight += group.weight;
        self.satellites += group.count;
        self.clocks += 1;
    }

    /// The normal matrix of the position.
    pub(crate) fn normal(&self) -> Symmetric3 {
        self.normal
    }

    /// Satellites minus clock states.
    pub(crate) fn surplus(&self) -> u32 {
        self.satellites - self.clocks
    }

    /// PDOP; `None` if unsolved: fewer satellites than states, a pivot of the normal matrix at or
    /// below the rounding floor ([M-26](crate::models#m-26)), or a value above `cap`.
    #[must_use]
    pub fn pdop(&self, cap: f64) -> Option<f64> {
        self.solve(cap).map(|solution| solution.pdop)
    }

    /// The solution, by the rule of [`Geometry::pdop`].
    pub(crate) fn solve(&self, cap: f64) -> Option<Solution> {
        if self.satellites < 3 + self.clocks {
            return None;
        }
        let factor = Factor::new(&self.normal);
        if !factor.exceeds(pivot_floor(self.weight)) {
            return None;
        }
        let pdop = factor.trace_of_inverse().sqrt();
        (pdop <= cap).then_some(Solution { pdop, factor })
    }
}

#[cfg(test)]
mod tests;
