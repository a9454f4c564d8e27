//! GNSS constellations: nominal ones that are part of the library, and element sets.

mod nominal;
mod sets;

pub use sets::{ElementSetError, ElementSets, StaleElements};

use crate::earth::{GEOSYNCHRONOUS_RADIUS_KM, GMST_RATE_RAD_S};
use crate::frames::{EarthRotation, OrbitPlane, State, Teme};
use crate::keyword::{Keyword, keywords};
use crate::orbit::j2::SecularOrbit;
use crate::orbit::kepler::eccentric_anomaly;
use crate::orbit::sgp4::Sgp4Orbit;
use crate::orbit::{MeanElements, PropagationError, Propagator};
use crate::time::Epoch;
use crate::units::wrap_two_pi;
use nalgebra::Vector3;
use std::f64::consts::TAU;
use std::fmt;
use std::sync::Arc;

keywords! {
    /// A named GNSS constellation that is part of the library.
    Preset {
        /// BeiDou-3: 24 MEO, 3 IGSO, 3 GEO.
        Beidou3 = "beidou-3",
        /// GPS: the 24 slots of the baseline constellation.
        Gps = "gps",
        /// Galileo: Walker 24/3/1.
        Galileo = "galileo",
        /// GLONASS: Walker 24/3/1.
        Glonass = "glonass",
        /// QZSS: three in quasi-zenith orbits, one GEO.
        Qzss = "qzss",
        /// NavIC: four in inclined geosynchronous orbits, three GEO.
        Navic = "navic",
    }
}

impl Preset {
    /// The satellites of the constellation, for a study that starts at `epoch`.
    #[must_use]
    pub fn satellites(self, epoch: Epoch) -> Vec<GnssSatellite> {
        match self {
            Self::Beidou3 => nominal::beidou3(epoch),
            Self::Gps => nominal::gps(),
            Self::Galileo => nominal::galileo(),
            Self::Glonass => nominal::glonass(),
            Self::Qzss => nominal::qzss(epoch),
            Self::Navic => nominal::navic(epoch),
        }
    }
}

impl Preset {
    /// The satellites for a study that starts at `epoch`, but over the Earth as for one that starts a share of a sidereal
    /// day later.
    #[must_use]
    pub fn satellites_at_phase(self, epoch: Epoch, share: f64) -> Vec<GnssSatellite> {
        let at_phase = |satellite: GnssSatellite| GnssSatellite {
            orbit: satellite.orbit.at_phase(share * TAU),
            ..satellite
        };
        self.satellites(epoch).into_iter().map(at_phase).collect()
    }
}

/// A satellite navigation system of a study: satellites with a common time scale.
#[derive(Debug, Clone)]
pub enum System {
    /// A nominal constellation.
    Preset(Preset),
    /// Satellites from element sets.
    Sets(ElementSets),
    /// Satellites as given, for any epoch.
    Listed {
        /// The name in results.
        name: String,
        /// The satellites.
        satellites: Vec<GnssSatellite>,
    },
}

impl System {
    /// The name in results.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Preset(preset) => preset.keyword(),
            Self::Sets(sets) => sets.name(),
            Self::Listed { name, .. } => name,
        }
    }

    /// The satellites, for a study that starts at `epoch`.
    #[must_use]
    pub fn satellites(&self, epoch: Epoch) -> Vec<GnssSatellite> {
        match self {
            Self::Preset(preset) => preset.satellites(epoch),
            Self::Sets(sets) => sets.satellites(epoch),
            Self::Listed { satellites, .. } => satellites.clone(),
        }
    }
}

impl From<Preset> for System {
    fn from(preset: Preset) -> Self {
        Self::Preset(preset)
    }
}

impl From<ElementSets> for System {
    fn from(sets: ElementSets) -> Self {
        Self::Sets(sets)
    }
}

/// One satellite of a GNSS constellation.
#[derive(Debug, Clone)]
pub struct GnssSatellite {
    /// Name, unique in the constellation.
    pub name: String,
    /// Its motion.
    pub orbit: GnssOrbit,
}

/// The ways in which GNSS satellites are propagated.
#[derive(Debug, Clone)]
pub enum GnssOrbit {
    /// Mean elements under secular J2.
    Secular(SecularOrbit),
    /// Circular, inclined, synchronous with sidereal time, without J2.
    Geosynchronous(GeosynchronousOrbit),
    /// Held over a longitude of the equator.
    Geostationary {
        /// East longitude, radians.
        longitude_rad: f64,
        /// Start of the study, for sidereal time.
        epoch: Epoch,
    },
    /// SGP4 from an element set.
    Sgp4(Box<Sgp4Orbit>),
    /// As a file gives it: sampled states, or an almanac.
    Given(GivenOrbit),
}

/// An orbit that a file gives.
#[derive(Clone)]
pub struct GivenOrbit(pub Arc<dyn Propagator>);

impl fmt::Debug for GivenOrbit {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("GivenOrbit")
    }
}

/// A geosynchronous orbit whose mean argument of latitude advances at the rate of GMST, with its node and perigee at rest:
/// its ground track closes after a sidereal day.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GeosynchronousOrbit {
    /// Eccentricity.
    pub eccentricity: f64,
    /// Argument of perigee, radians.
    pub arg_perigee_rad: f64,
    /// Inclination, radians.
    pub inclination_rad: f64,
    /// Right ascension of the ascending node in TEME, radians.
    pub raan_rad: f64,
    /// Mean argument of latitude at the epoch, perigee plus mean anomaly, radians.
    pub argument_of_latitude_rad: f64,
}

impl GeosynchronousOrbit {
    fn state(&self, elapsed_s: f64) -> State<Teme> {
        let mean_rad = self.argument_of_latitude_rad + GMST_RATE_RAD_S * elapsed_s;
        let plane = OrbitPlane::new(self.raan_rad, self.inclination_rad);
        let speed_km_s = GEOSYNCHRONOUS_RADIUS_KM * GMST_RATE_RAD_S;
        let e = self.eccentricity;
        if e == 0.0 {
            let (sin, cos) = mean_rad.sin_cos();
            return State::new(
                plane.vector(cos, sin) * GEOSYNCHRONOUS_RADIUS_KM,
                plane.vector(-sin, cos) * speed_km_s,
            );
        }
        let anomaly = eccentric_anomaly(mean_rad - self.arg_perigee_rad, e);
        let (sin, cos) = anomaly.sin_cos();
        let minor = (1.0 - e * e).sqrt();
        let (sin_perigee, cos_perigee) = self.arg_perigee_rad.sin_cos();
        // From the axes of the ellipse to those of the node.
        let in_plane = |along: f64, across: f64| {
            let (from_node, beyond) = (
                along * cos_perigee - across * sin_perigee,
                along * sin_perigee + across * cos_perigee,
            );
            plane.vector(from_node, beyond)
        };
        State::new(
            in_plane(cos - e, minor * sin) * GEOSYNCHRONOUS_RADIUS_KM,
            in_plane(-sin, minor * cos) * (speed_km_s / (1.0 - e * cos)),
        )
    }
}

impl GnssOrbit {
    /// The orbit for a study that starts when the Earth has turned by an angle. Elements hold at the start, so that medium
    /// orbits have their nodes over other longitudes; geosynchronous satellites are on their tracks where they are that much
    /// later. Orbits from files are left as they are.
    fn at_phase(self, turned_rad: f64) -> Self {
        match self {
            Self::Secular(orbit) => {
                let elements = orbit.elements_at(0.0);
                Self::Secular(SecularOrbit::j2(&MeanElements {
                    raan_rad: wrap_two_pi(elements.raan_rad - turned_rad),
                    ..elements
                }))
            }
            Self::Geosynchronous(orbit) => Self::Geosynchronous(GeosynchronousOrbit {
                raan_rad: orbit.raan_rad - turned_rad,
                argument_of_latitude_rad: orbit.argument_of_latitude_rad + turned_rad,
                ..orbit
            }),
            other @ (Self::Geostationary { .. } | Self::Sgp4(_) | Self::Given(_)) => other,
        }
    }
}

impl Propagator for GnssOrbit {
    fn state_at(&self, elapsed_s: f64) -> Result<State<Teme>, PropagationError> {
        Ok(match self {
            Self::Secular(orbit) => orbit.state(elapsed_s),
            Self::Geosynchronous(orbit) => orbit.state(elapsed_s),
            Self::Sgp4(orbit) => orbit.state_at(elapsed_s)?,
            Self::Given(orbit) => orbit.0.state_at(elapsed_s)?,
            Self::Geostationary {
                longitude_rad,
                epoch,
            } => {
                let (sin, cos) = longitude_rad.sin_cos();
                let position_km = Vector3::new(cos, sin, 0.0) * GEOSYNCHRONOUS_RADIUS_KM;
                let fixed = State::new(position_km, Vector3::zeros());
                EarthRotation::from_gmst(epoch.gmst_rad(elapsed_s)).state_to_teme(fixed)
            }
        })
    }
}

#[cfg(test)]
mod tests;
