//! Reference frames and the rotations between them; no other module writes a rotation.
//!
//! Elements and propagation live in TEME, the true equator and mean equinox of date of
//! SGP4 (Vallado et al., AIAA 2006-6753, appendix C). What is called Earth-fixed here is
//! the pseudo-Earth-fixed frame: TEME turned by mean sidereal time (IAU 1982), UT1 = UTC,
//! without polar motion. In low orbit it lies within 30 m of an ITRF.

use crate::earth::{GMST_RATE_RAD_S, Surface};
use crate::keyword::words;
use crate::time::Epoch;
use nalgebra::{Matrix3, Vector3};

/// Position and velocity in one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// Position, km.
    pub position_km: Vector3<f64>,
    /// Velocity, km/s.
    pub velocity_km_s: Vector3<f64>,
}

words! {
    /// The frames in which trajectories are written.
    Frame {
        /// Mean equator and equinox of J2000.0 (IAU 1976/1980, no corrections).
        Eme2000 = "EME2000",
        /// Geocentric celestial reference frame: EME2000 less the frame bias.
        Gcrf = "GCRF",
        /// Pseudo-Earth-fixed, named ITRF in files.
        EarthFixed = "ITRF",
        /// True equator, mean equinox of date.
        Teme = "TEME",
    }
}

/// R₃(θ): coordinates in axes that are turned by `angle_rad` about z.
fn axes_turned_about_z(angle_rad: f64) -> Matrix3<f64> {
    let (s, c) = angle_rad.sin_cos();
    Matrix3::new(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0)
}

/// The bridge between TEME and the Earth-fixed frame at one instant ([M-17](crate::models#m-17),
/// [M-18](crate::models#m-18)).
#[derive(Debug, Clone, Copy)]
pub struct EarthRotation {
    sin: f64,
    cos: f64,
}

impl EarthRotation {
    /// The rotation at a Greenwich mean sidereal time, radians.
    #[must_use]
    pub fn from_gmst(gmst_rad: f64) -> Self {
        let (sin, cos) = gmst_rad.sin_cos();
        Self { sin, cos }
    }

    /// A TEME position in Earth-fixed coordinates, km.
    #[must_use]
    pub fn to_earth_fixed(self, teme_km: Vector3<f64>) -> Vector3<f64> {
        Vector3::new(
            self.cos * teme_km.x + self.sin * teme_km.y,
            self.cos * teme_km.y - self.sin * teme_km.x,
            teme_km.z,
        )
    }

    /// An Earth-fixed position in TEME coordinates, km.
    #[must_use]
    pub fn to_teme(self, fixed_km: Vector3<f64>) -> Vector3<f64> {
        Vector3::new(
            self.cos * fixed_km.x - self.sin * fixed_km.y,
            self.cos * fixed_km.y + self.sin * fixed_km.x,
            fixed_km.z,
        )
    }

    /// A TEME state in Earth-fixed coordinates; the velocity is relative to the rotating Earth.
    #[must_use]
    pub fn state_to_earth_fixed(self, teme: State) -> State {
        let position_km = self.to_earth_fixed(teme.position_km);
        let turned = self.to_earth_fixed(teme.velocity_km_s);
        // v' = R v - ω × r'
        let velocity_km_s = turned - earth_rate().cross(&position_km);
        State {
            position_km,
            velocity_km_s,
        }
    }

    /// An Earth-fixed state in TEME coordinates.
    #[must_use]
    pub fn state_to_teme(self, fixed: State) -> State {
        let inertial = fixed.velocity_km_s + earth_rate().cross(&fixed.position_km);
        State {
            position_km: self.to_teme(fixed.position_km),
            velocity_km_s: self.to_teme(inertial),
        }
    }
}

/// Angular velocity of the Earth-fixed frame, rad/s.
fn earth_rate() -> Vector3<f64> {
    Vector3::new(0.0, 0.0, GMST_RATE_RAD_S)
}

/// Matrix from TEME to EME2000 at an epoch ([M-19](crate::models#m-19)): TEME → true of date by the
/// equation of the equinoxes (IAU 1994), then the transpose of the IAU 1976/1980
/// precession-nutation matrix.
#[must_use]
pub fn teme_to_eme2000(epoch: Epoch) -> Matrix3<f64> {
    let (tt1, tt2) = epoch.terrestrial_julian_date();
    let true_of_date = axes_turned_about_z(-sofars::erst::eqeq94(tt1, tt2));
    let precession_nutation = from_rows(sofars::pnp::pnm80(tt1, tt2));
    precession_nutation.transpose() * true_of_date
}

/// Matrix from EME2000 to GCRF: the transpose of the frame bias (IAU 2000;
/// [M-20](crate::models#m-20)).
#[must_use]
pub fn eme2000_to_gcrf() -> Matrix3<f64> {
    let (bias, _, _) = sofars::pnp::bp00(2_451_545.0, 0.0);
    from_rows(bias).transpose()
}

fn from_rows(rows: [[f64; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from_fn(|row, column| rows[row][column])
}

/// The way from TEME to a frame at one instant, for many states.
#[derive(Debug, Clone, Copy)]
pub enum FromTeme {
    /// TEME itself.
    Stay,
    /// To the rotating Earth.
    EarthFixed(EarthRotation),
    /// To a frame whose own rate is negligible.
    Turn(Matrix3<f64>),
}

impl FromTeme {
    /// The way to `frame`, at an instant `elapsed_s` after `epoch`.
    #[must_use]
    pub fn to(frame: Frame, epoch: Epoch, elapsed_s: f64) -> Self {
        let to_eme2000 = || teme_to_eme2000(epoch.plus_seconds(elapsed_s));
        match frame {
            Frame::Teme => Self::Stay,
            Frame::EarthFixed => {
                Self::EarthFixed(EarthRotation::from_gmst(epoch.gmst_rad(elapsed_s)))
            }
            Frame::Eme2000 => Self::Turn(to_eme2000()),
            Frame::Gcrf => Self::Turn(eme2000_to_gcrf() * to_eme2000()),
        }
    }

    /// A TEME state in the frame.
    #[must_use]
    pub fn apply(&self, teme: State) -> State {
        match self {
            Self::Stay => teme,
            Self::EarthFixed(rotation) => rotation.state_to_earth_fixed(teme),
            Self::Turn(matrix) => turned(teme, *matrix),
        }
    }

    /// A state of the frame in TEME: the way back of [`FromTeme::apply`].
    #[must_use]
    pub fn undo(&self, state: State) -> State {
        match self {
            Self::Stay => state,
            Self::EarthFixed(rotation) => rotation.state_to_teme(state),
            Self::Turn(matrix) => turned(state, matrix.transpose()),
        }
    }
}

/// The TEME state in `frame`, at an instant `elapsed_s` after `epoch`.
#[must_use]
pub fn from_teme(teme: State, frame: Frame, epoch: Epoch, elapsed_s: f64) -> State {
    FromTeme::to(frame, epoch, elapsed_s).apply(teme)
}

/// A state of `frame` in TEME, at an instant `elapsed_s` after `epoch`; undoes [`from_teme`].
#[must_use]
pub fn to_teme(state: State, frame: Frame, epoch: Epoch, elapsed_s: f64) -> State {
    FromTeme::to(frame, epoch, elapsed_s).undo(state)
}

/// Both parts of a state under a rotation whose own rate is negligible (precession, 7e-12 rad/s).
fn turned(state: State, matrix: Matrix3<f64>) -> State {
    State {
        position_km: matrix * state.position_km,
        velocity_km_s: matrix * state.velocity_km_s,
    }
}

/// The axes of an orbit plane: towards the ascending node, and 90° ahead of it in the plane.
#[derive(Debug, Clone, Copy)]
pub struct OrbitPlane {
    /// Unit vector towards the ascending node.
    pub node: Vector3<f64>,
    /// Unit vector at argument of latitude 90°.
    pub ahead: Vector3<f64>,
}

impl OrbitPlane {
    /// The plane of a right ascension of the ascending node and an inclination, radians.
    #[must_use]
    pub fn new(raan_rad: f64, inclination_rad: f64) -> Self {
        let (sin_raan, cos_raan) = raan_rad.sin_cos();
        let (sin_i, cos_i) = inclination_rad.sin_cos();
        Self {
            node: Vector3::new(cos_raan, sin_raan, 0.0),
            ahead: Vector3::new(-sin_raan * cos_i, cos_raan * cos_i, sin_i),
        }
    }

    /// The vector with in-plane components (`x` towards the node, `y` ahead of it).
    #[must_use]
    pub fn vector(&self, x: f64, y: f64) -> Vector3<f64> {
        self.node * x + self.ahead * y
    }
}

/// Rows R, I, C of the basis of a state: R along r, C along r × v, I = C × R.
///
/// `None` when position and velocity are parallel.
#[must_use]
pub fn ric_basis(state: &State) -> Option<Matrix3<f64>> {
    let radial = state.position_km.try_normalize(0.0)?;
    let cross = state
        .position_km
        .cross(&state.velocity_km_s)
        .try_normalize(1e-12)?;
    let along = cross.cross(&radial);
    Some(Matrix3::from_rows(&[
        radial.transpose(),
        along.transpose(),
        cross.transpose(),
    ]))
}

/// East, north and up at a ground point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalFrame {
    /// Earth-fixed position of the point, km.
    pub origin_km: Vector3<f64>,
    /// Unit vector eastwards, Earth-fixed.
    pub east: Vector3<f64>,
    /// Unit vector northwards, Earth-fixed.
    pub north: Vector3<f64>,
    /// Unit vector along the vertical of the surface, Earth-fixed.
    pub up: Vector3<f64>,
}

impl LocalFrame {
    /// The local frame of a point of `surface` at height 0; latitude and longitude in radians.
    #[must_use]
    pub fn new(surface: Surface, latitude_rad: f64, longitude_rad: f64) -> Self {
        let up = surface.vertical(latitude_rad, longitude_rad);
        let (sin_lon, cos_lon) = longitude_rad.sin_cos();
        let east = Vector3::new(-sin_lon, cos_lon, 0.0);
        Self {
            origin_km: surface.position_km(latitude_rad, longitude_rad),
            east,
            north: up.cross(&east),
            up,
        }
    }

    /// Elevation and azimuth (from north through east, [0, 2π)) of an Earth-fixed position, radians.
    #[must_use]
    pub fn look_angles(&self, target_km: Vector3<f64>) -> (f64, f64) {
        let line = target_km - self.origin_km;
        let (e, n, u) = (
            line.dot(&self.east),
            line.dot(&self.north),
            line.dot(&self.up),
        );
        (u.atan2(e.hypot(n)), crate::units::wrap_two_pi(e.atan2(n)))
    }
}

#[cfg(test)]
mod tests;
