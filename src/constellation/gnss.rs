//! Nominal GNSS constellations.

use super::{Design, Pattern};
use crate::earth::{GEOSYNCHRONOUS_RADIUS_KM, GMST_RATE_RAD_S};
use crate::frames::{EarthRotation, OrbitPlane, State};
use crate::orbit::j2::SecularOrbit;
use crate::orbit::{PropagationError, Propagator};
use crate::time::Epoch;
use crate::words::words;
use nalgebra::Vector3;
use std::f64::consts::TAU;

words! {
    /// A named GNSS constellation that is part of the library.
    Preset {
        /// BeiDou-3: 24 MEO, 3 IGSO, 3 GEO.
        Beidou3 = "beidou-3",
    }
}

impl Preset {
    /// The satellites of the constellation, for a study that starts at `epoch`.
    #[must_use]
    pub fn satellites(self, epoch: Epoch) -> Vec<GnssSatellite> {
        match self {
            Self::Beidou3 => beidou3(epoch),
        }
    }
}

/// One satellite of a GNSS constellation.
#[derive(Debug, Clone, PartialEq)]
pub struct GnssSatellite {
    /// Name, unique in the constellation.
    pub name: String,
    /// How it flies.
    pub orbit: GnssOrbit,
}

/// The ways in which nominal GNSS satellites fly.
#[derive(Debug, Clone, PartialEq)]
pub enum GnssOrbit {
    /// Mean elements under secular J2.
    Secular(SecularOrbit),
    /// Circular, inclined, in step with the sidereal rotation: no J2.
    Geosynchronous(GeosynchronousOrbit),
    /// Held over a longitude of the equator.
    Geostationary {
        /// East longitude, radians.
        longitude_rad: f64,
        /// Start of the study, for sidereal time.
        epoch: Epoch,
    },
}

/// A circular geosynchronous orbit whose argument of latitude advances at the rate of GMST.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GeosynchronousOrbit {
    /// Inclination, radians.
    pub inclination_rad: f64,
    /// Right ascension of the ascending node in TEME, radians.
    pub raan_rad: f64,
    /// Argument of latitude at the epoch, radians.
    pub argument_of_latitude_rad: f64,
}

impl GeosynchronousOrbit {
    fn state(&self, elapsed_s: f64) -> State {
        let (sin, cos) = (self.argument_of_latitude_rad + GMST_RATE_RAD_S * elapsed_s).sin_cos();
        let plane = OrbitPlane::new(self.raan_rad, self.inclination_rad);
        let speed_km_s = GEOSYNCHRONOUS_RADIUS_KM * GMST_RATE_RAD_S;
        State {
            position_km: plane.vector(cos, sin) * GEOSYNCHRONOUS_RADIUS_KM,
            velocity_km_s: plane.vector(-sin, cos) * speed_km_s,
        }
    }
}

impl Propagator for GnssOrbit {
    fn state_at(&self, elapsed_s: f64) -> Result<State, PropagationError> {
        Ok(match self {
            Self::Secular(orbit) => orbit.state(elapsed_s),
            Self::Geosynchronous(orbit) => orbit.state(elapsed_s),
            Self::Geostationary {
                longitude_rad,
                epoch,
            } => {
                let (sin, cos) = longitude_rad.sin_cos();
                let fixed = State {
                    position_km: Vector3::new(cos, sin, 0.0) * GEOSYNCHRONOUS_RADIUS_KM,
                    velocity_km_s: Vector3::zeros(),
                };
                EarthRotation::from_gmst(epoch.gmst_rad(elapsed_s)).state_to_teme(fixed)
            }
        })
    }
}

/// BeiDou-3 as in Table I of the paper: MEO Walker 24/3/1 at 56° and 21 528 km; 3 IGSO at 55°.
///
/// The paper gives no slots. The GEO longitudes are the nominal ones of BeiDou-3 (China Satellite
/// Navigation Office, *BeiDou Open Service Performance Standard* 3.0, 2021); the IGSO share one
/// ground track that crosses the equator at 118°E.
fn beidou3(epoch: Epoch) -> Vec<GnssSatellite> {
    let mut satellites = walker("MEO", (24, 3, 1), 56.0, 21_528.0);
    let gmst = epoch.gmst_rad(0.0);
    for member in 0..3 {
        let offset = TAU * f64::from(member) / 3.0;
        satellites.push(GnssSatellite {
            name: format!("IGSO-{}", member + 1),
            orbit: GnssOrbit::Geosynchronous(GeosynchronousOrbit {
                inclination_rad: 55_f64.to_radians(),
                raan_rad: 118_f64.to_radians() + gmst + offset,
                argument_of_latitude_rad: -offset,
            }),
        });
    }
    for (member, longitude_deg) in [80.0_f64, 110.5, 140.0].into_iter().enumerate() {
        satellites.push(GnssSatellite {
            name: format!("GEO-{}", member + 1),
            orbit: GnssOrbit::Geostationary {
                longitude_rad: longitude_deg.to_radians(),
                epoch,
            },
        });
    }
    satellites
}

/// A circular Walker delta constellation under secular J2; the first satellite has Ω = M = 0.
fn walker(
    prefix: &str,
    (total, planes, phasing): (usize, usize, usize),
    inclination_deg: f64,
    altitude_km: f64,
) -> Vec<GnssSatellite> {
    let design = Design::new(
        Pattern::Delta,
        (total, planes, phasing),
        inclination_deg,
        altitude_km,
    );
    // The presets are constants of this module, which its tests build.
    let satellites = design.map(|design| design.satellites()).unwrap_or_default();
    (1..)
        .zip(satellites)
        .map(|(number, satellite)| GnssSatellite {
            name: format!("{prefix}-{number}"),
            orbit: GnssOrbit::Secular(SecularOrbit::j2(&satellite.elements)),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn epoch() -> Epoch {
        Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap())
    }

    fn earth_fixed(orbit: &GnssOrbit, elapsed_s: f64) -> Vector3<f64> {
        let state = orbit.state_at(elapsed_s).unwrap();
        EarthRotation::from_gmst(epoch().gmst_rad(elapsed_s)).to_earth_fixed(state.position_km)
    }

    #[test]
    fn validate_geostationary_satellites_stand_still() {
        let satellites = Preset::Beidou3.satellites(epoch());
        assert_eq!(satellites.len(), 30);
        for (satellite, longitude_deg) in satellites[27..].iter().zip([80.0, 110.5, 140.0_f64]) {
            for t in [0.0, 40_000.0, 86_340.0] {
                let p = earth_fixed(&satellite.orbit, t);
                assert!((p.y.atan2(p.x).to_degrees() - longitude_deg).abs() < 1e-10);
                assert!(p.z == 0.0 && (p.norm() - 42_164.17).abs() < 1e-9);
            }
        }
    }

    /// The three IGSO satellites cross the equator northwards at 118°E, a third of a sidereal
    /// day after each other.
    #[test]
    fn validate_igso_share_one_ground_track() {
        let satellites = Preset::Beidou3.satellites(epoch());
        for (k, satellite) in satellites[24..27].iter().enumerate() {
            let crossing = TAU * k as f64 / 3.0 / GMST_RATE_RAD_S;
            let p = earth_fixed(&satellite.orbit, crossing);
            // 1e-8° is 7 m at this radius: the rate constant and gmst82 differ by that in a day.
            assert!((p.y.atan2(p.x).to_degrees() - 118.0).abs() < 1e-8, "{k}");
            assert!(p.z.abs() < 1e-6 && earth_fixed(&satellite.orbit, crossing + 60.0).z > 0.0);
        }
    }

    #[test]
    fn velocities_are_derivatives() {
        for satellite in Preset::Beidou3.satellites(epoch()).iter().step_by(5) {
            let at = |t: f64| satellite.orbit.state_at(t).unwrap();
            let slope = (at(1001.0).position_km - at(999.0).position_km) / 2.0;
            // Central difference over 2 s: r n³/6 = 2e-8 km/s for the MEO.
            assert!(
                (slope - at(1000.0).velocity_km_s).norm() < 5e-8,
                "{}",
                satellite.name
            );
        }
    }
}
