//! Reference frames and the rotations between them.
//!
//! A [`Position`] and a [`State`] carry their frame in their type, and only this module turns one
//! frame into another. The kernel of the evaluator works on plain numbers: it writes the rotation
//! of a whole pattern out in its lanes, and is tested against the one here.
//!
//! Elements and propagation live in TEME, the true equator and mean equinox of date of
//! SGP4 (Vallado et al., AIAA 2006-6753, appendix C). What is called Earth-fixed here is
//! the pseudo-Earth-fixed frame: TEME rotated by mean sidereal time (IAU 1982), UT1 = UTC at the
//! epoch of the scenario, without polar motion. It differs from an ITRF by |UT1 - UTC| at the epoch
//! and by polar motion: 360 m in low orbit on 2015-06-30, at most 0.5 km ([M-18](crate::models#m-18)).

use crate::earth::{GMST_RATE_RAD_S, Surface};
use crate::keyword::keywords;
use crate::time::Epoch;
use nalgebra::{Matrix3, Vector3};
use std::marker::PhantomData;

mod state;

pub use state::{EarthFixed, Eme2000, Gcrf, Position, ReferenceFrame, State, Teme};

keywords! {
    /// The frames in which trajectories are written.
    Frame {
        /// Mean equator and equinox of J2000.0 (IAU 1976/1980, no corrections).
        Eme2000 = "EME2000",
        /// Geocentric celestial reference frame: EME2000 minus the frame bias.
        Gcrf = "GCRF",
        /// Pseudo-Earth-fixed, named ITRF in files.
        EarthFixed = "ITRF",
        /// True equator, mean equinox of date.
        Teme = "TEME",
    }
}

/// R₃(θ): coordinates in axes rotated by `angle_rad` about z.
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

    /// A TEME position in Earth-fixed coordinates.
    #[must_use]
    pub fn to_earth_fixed(self, teme: Position<Teme>) -> Position<EarthFixed> {
        Position::new(self.direction_to_earth_fixed(teme.km()))
    }

    /// An Earth-fixed position in TEME coordinates.
    #[must_use]
    pub fn to_teme(self, fixed: Position<EarthFixed>) -> Position<Teme> {
        Position::new(self.direction_to_teme(fixed.km()))
    }

    /// A TEME state in Earth-fixed coordinates; the velocity is relative to the rotating Earth.
    #[must_use]
    pub fn state_to_earth_fixed(self, teme: State<Teme>) -> State<EarthFixed> {
        let position_km = self.to_earth_fixed(teme.position_km);
        let turned = self.direction_to_earth_fixed(teme.velocity_km_s);
        // v' = R v - ω × r'
        let velocity_km_s = turned - earth_rate().cross(&position_km.km());
        State {
            position_km,
            velocity_km_s,
        }
    }

    /// An Earth-fixed state in TEME coordinates.
    #[must_use]
    pub fn state_to_teme(self, fixed: State<EarthFixed>) -> State<Teme> {
        let inertial = fixed.velocity_km_s + earth_rate().cross(&fixed.position_km.km());
        State {
            position_km: self.to_teme(fixed.position_km),
            velocity_km_s: self.direction_to_teme(inertial),
        }
    }

    /// A vector of TEME axes in Earth-fixed axes.
    pub(crate) fn direction_to_earth_fixed(self, teme: Vector3<f64>) -> Vector3<f64> {
        Vector3::new(
            self.cos * teme.x + self.sin * teme.y,
            self.cos * teme.y - self.sin * teme.x,
            teme.z,
        )
    }

    /// A vector of Earth-fixed axes in TEME axes.
    pub(crate) fn direction_to_teme(self, fixed: Vector3<f64>) -> Vector3<f64> {
        Vector3::new(
            self.cos * fixed.x - self.sin * fixed.y,
            self.cos * fixed.y + self.sin * fixed.x,
            fixed.z,
        )
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

/// The way from TEME to the frame `F` at one instant, for many states.
#[derive(Debug, Clone, Copy)]
pub struct FromTeme<F> {
    way: Way,
    frame: PhantomData<F>,
}

#[derive(Debug, Clone, Copy)]
enum Way {
    /// TEME itself.
    Stay,
    /// To the rotating Earth.
    EarthFixed(EarthRotation),
    /// To a frame whose own rate is negligible.
    Turn(Matrix3<f64>),
}

impl<F: ReferenceFrame> FromTeme<F> {
    /// The way to `frame`, at an instant `elapsed_s` after `epoch`.
    #[must_use]
    pub fn to(frame: F, epoch: Epoch, elapsed_s: f64) -> Self {
        let to_eme2000 = || teme_to_eme2000(epoch.plus_seconds(elapsed_s));
        let way = match frame.name() {
            Frame::Teme => Way::Stay,
            Frame::EarthFixed => {
                Way::EarthFixed(EarthRotation::from_gmst(epoch.gmst_rad(elapsed_s)))
            }
            Frame::Eme2000 => Way::Turn(to_eme2000()),
            Frame::Gcrf => Way::Turn(eme2000_to_gcrf() * to_eme2000()),
        };
        Self {
            way,
            frame: PhantomData,
        }
    }

    /// A TEME state in the frame.
    #[must_use]
    pub fn apply(&self, teme: State<Teme>) -> State<F> {
        match self.way {
            Way::Stay => relabelled(teme),
            Way::EarthFixed(rotation) => relabelled(rotation.state_to_earth_fixed(teme)),
            Way::Turn(matrix) => turned(teme, matrix),
        }
    }

    /// A state of the frame in TEME: the way back of [`FromTeme::apply`].
    #[must_use]
    pub fn undo(&self, state: State<F>) -> State<Teme> {
        match self.way {
            Way::Stay => relabelled(state),
            Way::EarthFixed(rotation) => rotation.state_to_teme(relabelled(state)),
            Way::Turn(matrix) => turned(state, matrix.transpose()),
        }
    }
}

/// The TEME state in `frame`, at an instant `elapsed_s` after `epoch`.
#[must_use]
pub fn from_teme<F: ReferenceFrame>(
    teme: State<Teme>,
    frame: F,
    epoch: Epoch,
    elapsed_s: f64,
) -> State<F> {
    FromTeme::to(frame, epoch, elapsed_s).apply(teme)
}

/// A state of `frame` in TEME, at an instant `elapsed_s` after `epoch`; undoes [`from_teme`].
#[must_use]
pub fn to_teme<F: ReferenceFrame>(
    state: State<F>,
    frame: F,
    epoch: Epoch,
    elapsed_s: f64,
) -> State<Teme> {
    FromTeme::to(frame, epoch, elapsed_s).undo(state)
}

/// The same numbers under the name that the type of a conversion has for their frame.
fn relabelled<F, G>(state: State<F>) -> State<G> {
    State::new(state.position_km.km(), state.velocity_km_s)
}

/// Both parts of a state under a rotation whose own rate is negligible (precession, 7e-12 rad/s).
fn turned<F, G>(state: State<F>, matrix: Matrix3<f64>) -> State<G> {
    State::new(
        matrix * state.position_km.km(),
        matrix * state.velocity_km_s,
    )
}

/// The rotation within an orbit plane from perifocal axes (x towards the perigee) to node axes
/// (x towards the ascending node).
#[derive(Debug, Clone, Copy)]
pub(crate) struct PerifocalAxes {
    sin: f64,
    cos: f64,
}

impl PerifocalAxes {
    /// The perifocal axes of an argument of perigee, radians.
    pub(crate) fn new(arg_perigee_rad: f64) -> Self {
        let (sin, cos) = arg_perigee_rad.sin_cos();
        Self { sin, cos }
    }

    /// The components of a perifocal vector in node axes.
    pub(crate) fn to_node_axes(self, x: f64, y: f64) -> (f64, f64) {
        (self.cos * x - self.sin * y, self.sin * x + self.cos * y)
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
pub fn ric_basis<F>(state: &State<F>) -> Option<Matrix3<f64>> {
    let position_km = state.position_km.km();
    let radial = position_km.try_normalize(0.0)?;
    let cross = position_km
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
    /// Position of the point.
    pub origin_km: Position<EarthFixed>,
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
            origin_km: Position::new(surface.position_km(latitude_rad, longitude_rad)),
            east,
            north: up.cross(&east),
            up,
        }
    }

    /// Elevation and azimuth (from north through east, [0, 2π)) of a position, radians.
    #[must_use]
    pub fn look_angles(&self, target_km: Position<EarthFixed>) -> (f64, f64) {
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
