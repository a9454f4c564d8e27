//! Matching the objects of a file to the slots of a design.

use super::reference::ReferenceConstellation;
use super::tracks::Track;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::{State, Teme};
use std::collections::BTreeMap;

/// Pairs of slots and objects.
pub(super) struct Matching {
    /// For each slot, its object.
    object_of_slot: Vec<Option<usize>>,
    by_name: bool,
    objects: usize,
}

impl Matching {
    /// By name if every object has the name of a slot, otherwise by position.
    pub(super) fn of(reach_km: &[f64], ours: &Ephemeris, tracks: &[Track]) -> Self {
        Self::by_name(ours, tracks).unwrap_or_else(|| Self::by_place(reach_km, ours, tracks))
    }

    fn by_name(ours: &Ephemeris, tracks: &[Track]) -> Option<Self> {
        let slots: BTreeMap<String, usize> = ours
            .satellites()
            .iter()
            .enumerate()
            .map(|(n, satellite)| (satellite.name.to_ascii_uppercase(), n))
            .collect();
        let mut object_of_slot = vec![None; slots.len()];
        for (object, track) in tracks.iter().enumerate() {
            let slot = *slots.get(&track.name.trim().to_ascii_uppercase())?;
            // Two objects with the same name are matched by position.
            if object_of_slot[slot].replace(object).is_some() {
                return None;
            }
        }
        Some(Self {
            object_of_slot,
            by_name: true,
            objects: tracks.len(),
        })
    }

    /// Nearest pairs first, as long as they are within reach of each other in position and velocity.
    fn by_place(reach_km: &[f64], ours: &Ephemeris, tracks: &[Track]) -> Self {
        let mut pairs = Vec::new();
        for (object, track) in tracks.iter().enumerate() {
            // Compared at the first sample of the object: differences grow with time.
            let Some((elapsed_s, state)) = track.at(0.0) else {
                continue;
            };
            for ((slot, satellite), reach_km) in ours.satellites().iter().enumerate().zip(reach_km)
            {
                if let Ok(own) = ours.state(satellite, elapsed_s) {
                    // A satellite that lags on its circle lags in velocity by the same angle.
                    let distance_km = apart_km(&state, &own);
                    if distance_km <= reach_km * std::f64::consts::SQRT_2 {
                        pairs.push((distance_km, slot, object));
                    }
                }
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut object_of_slot = vec![None; ours.satellites().len()];
        let mut taken = vec![false; tracks.len()];
        for (_, slot, object) in pairs {
            if object_of_slot[slot].is_none() && !taken[object] {
                object_of_slot[slot] = Some(object);
                taken[object] = true;
            }
        }
        Self {
            object_of_slot,
            by_name: false,
            objects: tracks.len(),
        }
    }

    /// How many pairs matched by name are too far apart at their first sample to be matched by
    /// position.
    pub(super) fn misplaced(
        &self,
        reference: &ReferenceConstellation<'_>,
        tracks: &[Track],
    ) -> Result<usize, EphemerisError> {
        let ours = &reference.ephemeris;
        let mut misplaced = 0;
        for (slot, track) in self.pairs(tracks) {
            if let Some((elapsed_s, state)) = track.at(0.0) {
                let Some(own) = ours.state_or_gap(&ours.satellites()[slot], elapsed_s)? else {
                    continue;
                };
                let apart_km = (state.position_km - own.position_km).norm();
                misplaced += usize::from(apart_km > reference.reach_km[slot]);
            }
        }
        Ok(misplaced)
    }

    /// `name` or `place`.
    pub(super) fn how(&self) -> &'static str {
        if self.by_name { "name" } else { "place" }
    }

    /// Pairs found.
    pub(super) fn count(&self) -> usize {
        self.object_of_slot.iter().flatten().count()
    }

    /// Whether every slot has an object and every object a slot.
    pub(super) fn is_complete(&self) -> bool {
        self.count() == self.object_of_slot.len() && self.count() == self.objects
    }

    /// The pairs whose object has states in the span, in the order of the slots.
    pub(super) fn pairs<'t>(&self, tracks: &'t [Track]) -> Vec<(usize, &'t Track)> {
        let pair = |(slot, object): (usize, &Option<usize>)| {
            let track = &tracks[(*object)?];
            (!track.states.is_empty()).then_some((slot, track))
        };
        self.object_of_slot
            .iter()
            .enumerate()
            .filter_map(pair)
            .collect()
    }

    pub(super) fn unmatched_slots(&self, ours: &Ephemeris) -> Vec<String> {
        let slots = ours.satellites().iter().zip(&self.object_of_slot);
        slots
            .filter(|(_, object)| object.is_none())
            .map(|(satellite, _)| satellite.name.clone())
            .collect()
    }

    pub(super) fn unmatched_objects(&self, tracks: &[Track]) -> Vec<String> {
        let is_free = |object: &usize| !self.object_of_slot.contains(&Some(*object));
        let free = (0..tracks.len()).filter(is_free);
        free.map(|object| tracks[object].name.clone()).collect()
    }
}

/// Distance between two states, km, with velocities scaled by the time of one radian along the
/// orbit: satellites of two crossing planes may share a position but not a direction.
pub(super) fn apart_km(theirs: &State<Teme>, own: &State<Teme>) -> f64 {
    let apart_km = (theirs.position_km - own.position_km).norm();
    if theirs.velocity_km_s.norm() == 0.0 {
        return apart_km;
    }
    let momentum = own.position_km.km().cross(&own.velocity_km_s).norm();
    let rate_rad_s = momentum / own.position_km.km().norm_squared();
    apart_km.hypot((theirs.velocity_km_s - own.velocity_km_s).norm() / rate_rad_s)
}
