//! Where satellites are over the ground: tracks and footprints for maps.

use crate::ephemeris::sampled::Sampled;
use crate::ephemeris::{Ephemeris, EphemerisError, EphemerisSatellite};
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
    /// Its plane and its place in it, from 1.
    pub(crate) slot: Option<[usize; 2]>,
    /// The first revolution, cut at the antimeridian.
    pub(crate) track: Vec<Vec<LonLat>>,
    /// Where it is above the mask at the epoch.
    pub(crate) footprint: Vec<Vec<LonLat>>,
    /// The place below it at the epoch.
    pub(crate) below: LonLat,
}

impl Ground {
    /// Every satellite of an ephemeris, over one revolution of `period_s`.
    ///
    /// # Errors
    /// If a satellite has no state.
    pub fn of(
        scene: &Scene<'_>,
        ephemeris: &Ephemeris,
        period_s: f64,
    ) -> Result<Vec<Self>, EphemerisError> {
        let sampled = Sampled::new(ephemeris, EarthFixed);
        let mask_rad = scene.setup().mask.degrees().to_radians();
        let one = |propagated: &EphemerisSatellite| {
            let position = |t: f64| Ok(sampled.state(propagated, t)?.position_km);
            let place = |t: f64| Ok(place_below(scene.surface(), position(t)?));
            let times = (0..=STEPS).map(|k| period_s * k as f64 / STEPS as f64);
            let track: Vec<LonLat> = times.map(place).collect::<Result<_, EphemerisError>>()?;
            let start = position(0.0)?;
            Ok(Self {
                name: propagated.name.clone(),
                slot: propagated.slot.map(|slot| [slot.plane + 1, slot.index + 1]),
                below: track[0],
                track: lines(&track),
                footprint: rings(&footprint(scene.surface(), start, mask_rad)),
            })
        };
        ephemeris.satellites().par_iter().map(one).collect()
    }

    pub(crate) fn properties(&self) -> Value {
        let [longitude, latitude] = self.below;
        json!({
            "name": self.name,
            "plane": self.slot.map(|[plane, _]| plane),
            "slot": self.slot.map(|[_, index]| index),
            "epoch_latitude_deg": crate::units::round_decimal(latitude, 6),
            "epoch_longitude_deg": crate::units::round_decimal(longitude, 6),
        })
    }
}
