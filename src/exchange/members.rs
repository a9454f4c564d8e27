//! What describes each satellite of a constellation: the slot of a shell, or what a file has of it.

use crate::constellation::Slot;
use crate::constellation::identity::ObjectIdentity;
use crate::earth::MU_KM3_S2;
use crate::exchange::constellation::Constellation;
use crate::exchange::import::Fleet;
use crate::formats::metadata::Theory;
use crate::orbit::j2::SecularOrbit;
use crate::orbit::{MeanElements, Model};
use crate::time::Epoch;
use crate::units::SECONDS_PER_DAY;
use std::f64::consts::TAU;

/// What the states of a satellite are made from.
#[derive(Debug, Clone, Copy)]
pub(super) enum Origin<'a> {
    /// Mean elements that the model of the study propagates.
    Mean {
        /// The elements, TEME.
        elements: MeanElements,
        /// Their instant.
        epoch: Epoch,
    },
    /// An element set of a file.
    Set(&'a sgp4::Elements),
    /// States of a file.
    Sampled,
    /// An almanac of a file.
    Almanac,
}

/// A satellite of a constellation.
#[derive(Debug, Clone)]
pub(super) struct ConstellationMember<'a> {
    /// Its place in the shells.
    pub(super) slot: Option<Slot>,
    /// What its states are made from.
    pub(super) origin: Origin<'a>,
    /// Its identity in its file; nothing for a slot.
    pub(super) identity: ObjectIdentity,
}

impl Origin<'_> {
    /// The theory of its states in a study whose model is `model`.
    pub(super) fn theory(&self, model: Model) -> Theory {
        match self {
            Self::Mean { .. } => Theory::Propagated(model),
            Self::Set(_) => Theory::Sgp4OfSource,
            Self::Sampled => Theory::Interpolated,
            Self::Almanac => Theory::Almanac,
        }
    }

    /// Its mean elements at an instant under `model`; SGP4 keeps those of their own epoch alone.
    pub(super) fn mean_elements(&self, at: Epoch, model: Model) -> Option<MeanElements> {
        let Self::Mean { elements, epoch } = self else {
            return None;
        };
        let since_s = at.seconds_since(*epoch);
        if since_s == 0.0 {
            return Some(*elements);
        }
        match model {
            Model::TwoBody => Some(SecularOrbit::two_body(elements).elements_at(since_s)),
            Model::J2 | Model::J2Osculating => {
                Some(SecularOrbit::j2(elements).elements_at(since_s))
            }
            Model::Sgp4 => None,
        }
    }

    /// Its semi-major axis, km, where it has elements.
    pub(super) fn semi_major_axis_km(&self) -> Option<f64> {
        match self {
            Self::Mean { elements, .. } => Some(elements.semi_major_axis_km),
            Self::Set(set) => {
                let mean_motion_rad_s = set.mean_motion * TAU / SECONDS_PER_DAY;
                Some((MU_KM3_S2 / mean_motion_rad_s.powi(2)).cbrt())
            }
            Self::Almanac | Self::Sampled => None,
        }
    }
}

impl Constellation {
    /// The satellites in the order of the ephemeris, `epoch` being that of the study.
    pub(super) fn members(&self, epoch: Epoch) -> Vec<ConstellationMember<'_>> {
        let satellites = self
            .design
            .iter()
            .flat_map(crate::constellation::Design::satellites);
        let of_shell = |satellite: crate::constellation::Satellite| ConstellationMember {
            slot: Some(satellite.slot),
            origin: Origin::Mean {
                elements: satellite.elements,
                epoch,
            },
            identity: ObjectIdentity::default(),
        };
        let mut members: Vec<ConstellationMember<'_>> = satellites.map(of_shell).collect();
        if let Some(files) = &self.files {
            let mut origins = Vec::with_capacity(files.fleet.len());
            collect(&files.fleet, &mut origins);
            let identities = files.fleet.identities();
            let of_file = |(origin, identity)| ConstellationMember {
                slot: None,
                origin,
                identity,
            };
            members.extend(origins.into_iter().zip(identities).map(of_file));
        }
        members
    }
}

fn collect<'a>(fleet: &'a Fleet, origins: &mut Vec<Origin<'a>>) {
    match fleet {
        Fleet::Sets(sets) => origins.extend(sets.iter().map(Origin::Set)),
        Fleet::Elements(rows) => origins.extend(rows.iter().map(|row| Origin::Mean {
            elements: row.elements,
            epoch: row.epoch,
        })),
        Fleet::Sampled(trajectories) => {
            origins.extend(trajectories.iter().map(|_| Origin::Sampled))
        }
        Fleet::Almanacs(almanacs) => origins.extend(almanacs.iter().map(|_| Origin::Almanac)),
        Fleet::Mixed(parts) => parts.iter().for_each(|part| collect(part, origins)),
    }
}
