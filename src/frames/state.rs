//! Positions and states that carry their frame in their type.
//!
//! A position of one frame is neither compared with nor taken for one of another:
//!
//! ```compile_fail,E0308
//! use navwalker::frames::{EarthFixed, EarthRotation, Position, Teme};
//! use nalgebra::Vector3;
//!
//! let teme = Position::<Teme>::new(Vector3::new(7303.0, 0.0, 0.0));
//! let fixed: Position<EarthFixed> = EarthRotation::from_gmst(1.0).to_earth_fixed(teme);
//! let apart_km = (fixed - teme).norm();
//! ```
//!
//! Only a rotation of [`crate::frames`] leads from one to the other:
//!
//! ```
//! use navwalker::frames::{EarthFixed, EarthRotation, Position, Teme};
//! use nalgebra::Vector3;
//!
//! let teme = Position::<Teme>::new(Vector3::new(7303.0, 0.0, 0.0));
//! let rotation = EarthRotation::from_gmst(1.0);
//! let fixed: Position<EarthFixed> = rotation.to_earth_fixed(teme);
//! let apart_km = (rotation.to_teme(fixed) - teme).norm();
//! assert!(apart_km < 1e-12);
//! ```

use super::Frame;
use nalgebra::Vector3;
use std::fmt::Debug;
use std::marker::PhantomData;
use std::ops::{Add, Sub};

/// A frame in the type of a position or a state.
///
/// Four types name one frame each. [`Frame`] itself stands for a frame that is known only at run
/// time, because a file or a user names it.
pub trait ReferenceFrame: Copy + PartialEq + Debug + Send + Sync + 'static {
    /// The frame it represents.
    fn name(self) -> Frame;
}

/// True equator, mean equinox of date: the frame of elements and propagation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Teme;

/// Pseudo-Earth-fixed: TEME rotated by mean sidereal time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EarthFixed;

/// Mean equator and equinox of J2000.0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Eme2000;

/// Geocentric celestial reference frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gcrf;

impl ReferenceFrame for Teme {
    fn name(self) -> Frame {
        Frame::Teme
    }
}

impl ReferenceFrame for EarthFixed {
    fn name(self) -> Frame {
        Frame::EarthFixed
    }
}

impl ReferenceFrame for Eme2000 {
    fn name(self) -> Frame {
        Frame::Eme2000
    }
}

impl ReferenceFrame for Gcrf {
    fn name(self) -> Frame {
        Frame::Gcrf
    }
}

impl ReferenceFrame for Frame {
    fn name(self) -> Frame {
        self
    }
}

/// A position in coordinates of the frame `F`, km from the centre of the Earth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Position<F> {
    km: Vector3<f64>,
    frame: PhantomData<F>,
}

impl<F> Position<F> {
    /// The position with these coordinates, km.
    #[must_use]
    pub const fn new(km: Vector3<f64>) -> Self {
        Self {
            km,
            frame: PhantomData,
        }
    }

    /// Its coordinates without their frame, km.
    #[must_use]
    pub const fn km(&self) -> Vector3<f64> {
        self.km
    }

    /// Distance from the centre of the Earth, km.
    #[must_use]
    pub fn norm(&self) -> f64 {
        self.km.norm()
    }
}

/// From the second position to the first, km in the axes of their frame.
impl<F> Sub for Position<F> {
    type Output = Vector3<f64>;

    fn sub(self, other: Self) -> Vector3<f64> {
        self.km - other.km
    }
}

/// The position moved by some kilometres in the axes of its frame.
impl<F> Add<Vector3<f64>> for Position<F> {
    type Output = Self;

    fn add(self, displacement_km: Vector3<f64>) -> Self {
        Self::new(self.km + displacement_km)
    }
}

/// Position and velocity in the frame `F`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State<F> {
    /// Position.
    pub position_km: Position<F>,
    /// Velocity relative to the frame and in its axes, km/s.
    pub velocity_km_s: Vector3<f64>,
}

impl<F> State<F> {
    /// The state with these coordinates, km and km/s.
    #[must_use]
    pub const fn new(position_km: Vector3<f64>, velocity_km_s: Vector3<f64>) -> Self {
        Self {
            position_km: Position::new(position_km),
            velocity_km_s,
        }
    }
}
