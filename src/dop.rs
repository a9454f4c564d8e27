//! Position dilution of precision with one clock state per clock group.
//!
//! Least squares with three position states and one clock state for each group of systems that
//! share a clock. The clock is eliminated by the Schur complement: a group of n visible satellites
//! with unit vectors v contributes A = Σ v vᵀ - (Σ v)(Σ v)ᵀ / n to the normal matrix of the position,
//! and PDOP² = tr(A⁻¹) of the sum over groups ([M-24](crate::models#m-24) to
//! [M-26](crate::models#m-26); with weights [M-27](crate::models#m-27)). The full geometry matrix is
//! never built.

mod family;

pub use family::{DopFamily, ObservationWeights};

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

    /// The trace of the inverse: sum of the principal 2x2 minors over the determinant
    /// ([M-26](crate::models#m-26)).
    ///
    /// `None` when the matrix is not positive definite (Sylvester's criterion).
    #[must_use]
    pub fn trace_of_inverse(&self) -> Option<f64> {
        let minor_zz = self.xx * self.yy - self.xy * self.xy;
        let minor_yy = self.xx * self.zz - self.xz * self.xz;
        let minor_xx = self.yy * self.zz - self.yz * self.yz;
        let determinant = self.xx * minor_xx - self.xy * (self.xy * self.zz - self.yz * self.xz)
            + self.xz * (self.xy * self.yz - self.yy * self.xz);
        let definite = self.xx > 0.0 && minor_zz > 0.0 && determinant > 0.0;
        definite.then(|| (minor_xx + minor_yy + minor_zz) / determinant)
    }

    /// The inverse, by cofactors; `None` if the matrix is not positive definite.
    #[must_use]
    pub fn inverse(&self) -> Option<Self> {
        let cofactor_xx = self.yy * self.zz - self.yz * self.yz;
        let cofactor_xy = self.xz * self.yz - self.xy * self.zz;
        let cofactor_xz = self.xy * self.yz - self.xz * self.yy;
        let minor_zz = self.xx * self.yy - self.xy * self.xy;
        let determinant = self.xx * cofactor_xx + self.xy * cofactor_xy + self.xz * cofactor_xz;
        let definite = self.xx > 0.0 && minor_zz > 0.0 && determinant > 0.0;
        definite.then(|| Self {
            xx: cofactor_xx / determinant,
            yy: (self.xx * self.zz - self.xz * self.xz) / determinant,
            zz: minor_zz / determinant,
            xy: cofactor_xy / determinant,
            xz: cofactor_xz / determinant,
            yz: (self.xy * self.xz - self.xx * self.yz) / determinant,
        })
    }

    /// vᵀ A v.
    #[must_use]
    pub fn quadratic(&self, v: Vector3<f64>) -> f64 {
        let squares = self.xx * v.x * v.x + self.yy * v.y * v.y + self.zz * v.z * v.z;
        squares + 2.0 * (self.xy * v.x * v.y + self.xz * v.x * v.z + self.yz * v.y * v.z)
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

/// The normal matrix of the position, accumulated group by group.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Geometry {
    normal: Symmetric3,
    satellites: u32,
    clocks: u32,
}

impl Geometry {
    /// Adds the satellites of one clock; an empty group adds nothing, not even a clock state.
    pub fn add(&mut self, group: &ClockGroup) {
        if group.count == 0 {
            return;
        }
        self.normal += group.squares;
        self.normal += Symmetric3::outer(group.sum, -1.0 / group.weight);
        self.satellites += group.count;
        self.clocks += 1;
    }

    /// PDOP; `None` if unsolved: fewer satellites than states, a position block that is not
    /// positive definite, or a value above `cap`.
    #[must_use]
    pub fn pdop(&self, cap: f64) -> Option<f64> {
        if self.satellites < 3 + self.clocks {
            return None;
        }
        let pdop = self.normal.trace_of_inverse()?.sqrt();
        (pdop <= cap).then_some(pdop)
    }
}

#[cfg(test)]
mod tests;
