//! Where satellites are over the ground: tracks and footprints for maps.

use crate::constellation::{Slot, shell_letters};
use crate::ephemeris::sampled::Sampled;
use crate::ephemeris::{EphemerisError, EphemerisSatellite};
use crate::formats::maps::palette::period_s;
use crate::formats::maps::scene::Scene;
use crate::frames::EarthFixed;
use crate::ground::shapes::{LonLat, footprint, lines, place_below, rings};
use rayon::prelude::*;
use serde_json::{Value, json};

/// Places of a track: a revolution in steps of 3°.
const STEPS: usize = 120;

/// A satellite over the ground.
pub struct Ground {
    /// Its name.
    pub(crate) name: String,
    /// Its place in a design.
    pub(crate) slot: Option<Slot>,
    /// The first revolution, cut at the antimeridian; less where its states end before.
    pub(crate) track: Vec<Vec<LonLat>>,
    /// Where it is above the mask at the epoch.
    pub(crate) footprint: Vec<Vec<LonLat>>,
    /// The place below it at the epoch.
    pub(crate) below: LonLat,
}

impl Ground {
    /// Every satellite of a scene, over one revolution of its own.
    ///
    /// # Errors
    /// If a satellite has no state.
    pub fn of(scene: &Scene<'_>) -> Result<Vec<Self>, EphemerisError> {
        let ephemeris = scene.ephemeris();
        let sampled = Sampled::new(ephemeris, EarthFixed);
        let mask_rad = scene.setup().mask.degrees().to_radians();
        let one = |propagated: &EphemerisSatellite| {
            let period_s = period_s(ephemeris, propagated)?.unwrap_or(0.0);
            let times = (0..=STEPS).map(|k| period_s * k as f64 / STEPS as f64);
            let mut track: Vec<LonLat> = Vec::new();
            for t in times {
                if let Some(state) = sampled.state_or_gap(propagated, t)? {
                    track.push(place_below(scene.surface(), state.position_km));
                }
            }
            let start = sampled.state(propagated, 0.0)?.position_km;
            Ok(Self {
                name: propagated.name.clone(),
                slot: propagated.slot,
                below: place_below(scene.surface(), start),
                track: lines(&track),
                footprint: rings(&footprint(scene.surface(), start, mask_rad)),
            })
        };
        ephemeris.satellites().par_iter().map(one).collect()
    }

    pub(crate) fn properties(&self) -> Value {
        let [longitude, latitude] = self.below;
        let mut properties = json!({
            "name": self.name,
            "plane": self.slot.map(|slot| slot.plane + 1),
            "slot": self.slot.map(|slot| slot.index + 1),
            "epoch_latitude_deg": crate::units::round_decimal(latitude, 6),
            "epoch_longitude_deg": crate::units::round_decimal(longitude, 6),
        });
        if let Some(shell) = self.slot.and_then(|slot| slot.shell) {
            properties["shell"] = Value::from(shell_letters(shell));
        }
        properties
    }
}
