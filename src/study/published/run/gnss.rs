//! GNSS satellites in a study: changed by an assumption, or what statements say of them.

use crate::constellation::gnss::{GnssOrbit, GnssSatellite, System};
use crate::earth::RADIUS_KM;
use crate::evaluate::Setup;
use crate::orbit::j2::SecularOrbit;
use crate::orbit::{MeanElements, Propagator};
use crate::study::published::metric::PlaneQuantity;
use crate::study::published::steps::AssumedChange;
use crate::time::{TimeError, TimeGrid};
use crate::units::{SECONDS_PER_HOUR, wrap_two_pi};

fn begins(satellite: &GnssSatellite, beginnings: &[String]) -> bool {
    let name = satellite.name.as_str();
    beginnings
        .iter()
        .any(|beginning| name.starts_with(beginning))
}

impl AssumedChange {
    /// A setup with the change.
    pub(super) fn of_setup(&self, setup: Setup) -> Result<Setup, TimeError> {
        let mut setup = setup;
        if self.epoch_shift_h != 0.0 {
            let grid = setup.grid;
            setup.grid = TimeGrid::new(
                grid.epoch()
                    .plus_seconds(self.epoch_shift_h * SECONDS_PER_HOUR),
                grid.len() as f64 * grid.step_s(),
                grid.step_s(),
            )?;
        }
        if !self.without.is_empty() || !self.turned.is_empty() {
            let epoch = setup.grid.epoch();
            let changed = |system: &System| System::Listed {
                name: system.name().to_owned(),
                satellites: system
                    .satellites(epoch)
                    .into_iter()
                    .filter(|satellite| !begins(satellite, &self.without))
                    .map(|satellite| self.of_satellite(satellite))
                    .collect(),
            };
            setup.gnss = setup.gnss.iter().map(changed).collect();
        }
        Ok(setup)
    }

    fn of_satellite(&self, satellite: GnssSatellite) -> GnssSatellite {
        if !begins(&satellite, &self.turned) {
            return satellite;
        }
        let orbit = turned(satellite.orbit, self.turn_deg.to_radians());
        GnssSatellite { orbit, ..satellite }
    }
}

/// An orbit turned to the east about the axis of the Earth; element sets and states stay as they are.
fn turned(orbit: GnssOrbit, angle_rad: f64) -> GnssOrbit {
    match orbit {
        GnssOrbit::Secular(orbit) => {
            let elements = orbit.elements_at(0.0);
            GnssOrbit::Secular(SecularOrbit::j2(&MeanElements {
                raan_rad: wrap_two_pi(elements.raan_rad + angle_rad),
                ..elements
            }))
        }
        GnssOrbit::Geosynchronous(mut orbit) => {
            orbit.raan_rad += angle_rad;
            GnssOrbit::Geosynchronous(orbit)
        }
        GnssOrbit::Geostationary {
            longitude_rad,
            epoch,
        } => GnssOrbit::Geostationary {
            longitude_rad: longitude_rad + angle_rad,
            epoch,
        },
        other @ (GnssOrbit::Sgp4(_) | GnssOrbit::Given(_)) => other,
    }
}

/// The GNSS satellites of a setup whose names begin so.
fn named(setup: &Setup, beginning: &str) -> Vec<GnssSatellite> {
    let epoch = setup.grid.epoch();
    let all = setup
        .gnss
        .iter()
        .flat_map(|system| system.satellites(epoch));
    all.filter(|satellite| satellite.name.starts_with(beginning))
        .collect()
}

/// The number of GNSS satellites whose names begin so.
pub(super) fn count(setup: &Setup, beginning: &str) -> f64 {
    named(setup, beginning).len() as f64
}

/// A quantity of the first of them, by its state at the epoch.
pub(super) fn of_plane(setup: &Setup, beginning: &str, quantity: PlaneQuantity) -> Option<f64> {
    let first = named(setup, beginning).into_iter().next()?;
    let state = first.orbit.state_at(0.0).ok()?;
    Some(match quantity {
        PlaneQuantity::Inclination => {
            let normal = state.position_km.km().cross(&state.velocity_km_s);
            let cosine: f64 = normal.z / normal.norm();
            cosine.clamp(-1.0, 1.0).acos().to_degrees()
        }
        PlaneQuantity::Height => state.position_km.norm() - RADIUS_KM,
    })
}
