//! The SGP4 element sets of a constellation's satellites: made from mean elements, or as their file has them.

use super::identities::{own_designator, own_name, own_number};
use super::members::{ConstellationMember, Origin};
use crate::constellation::identity::{NUMBERED, ObjectIdentity};
use crate::formats::element_set;
use crate::formats::metadata::Object;
use crate::orbit::Model;
use crate::orbit::sgp4::MeanMotionSlot;
use crate::time::Epoch;
use crate::units::{SECONDS_PER_DAY, wrap_360};

/// How element sets are made.
#[derive(Clone, Copy)]
pub(super) struct ElementSetRule {
    /// The model of the study, which moves mean elements to the epoch.
    pub(super) model: Model,
    /// Epoch of the study.
    pub(super) epoch: Epoch,
    /// The mean motion of sets that are made from mean elements.
    pub(super) slot: MeanMotionSlot,
    /// To the nearest epoch that the format can write.
    pub(super) rounding: fn(Epoch) -> Epoch,
}

impl ElementSetRule {
    /// The unrounded element set of a satellite; none for states and almanacs, which have no such elements.
    pub(super) fn set(
        &self,
        member: &ConstellationMember<'_>,
        object: &Object,
    ) -> Option<sgp4::Elements> {
        match member.origin {
            Origin::Mean { epoch, .. } => {
                // Mean elements that SGP4 propagates stay at their own epoch.
                let at = match self.model {
                    Model::Sgp4 => epoch,
                    _ => self.epoch,
                };
                let at = (self.rounding)(at);
                let moved_by = match self.model {
                    Model::Sgp4 => Model::J2,
                    model => model,
                };
                let elements = member.origin.mean_elements(at, moved_by)?;
                Some(element_set(&elements, object, at, self.slot))
            }
            Origin::Set(set) => Some(self.at_writable_epoch(named(set, object))),
            Origin::Sampled | Origin::Almanac => None,
        }
    }

    /// The same set at an epoch that the format can write, half a millisecond away at most: only the mean
    /// anomaly moves by more than its digits.
    fn at_writable_epoch(&self, set: sgp4::Elements) -> sgp4::Elements {
        let epoch = Epoch::from_utc(set.datetime.and_utc());
        let at = (self.rounding)(epoch);
        let moved_s = at.seconds_since(epoch);
        if moved_s == 0.0 {
            return set;
        }
        let turned_deg = 360.0 * set.mean_motion * moved_s / SECONDS_PER_DAY;
        sgp4::Elements {
            datetime: at.utc().naive_utc(),
            mean_anomaly: wrap_360(set.mean_anomaly + turned_deg),
            ..set
        }
    }
}

/// A set of a file under the identity that it has there, as far as every format can hold it; the rest is from `object`.
fn named(set: &sgp4::Elements, object: &Object) -> sgp4::Elements {
    let identity = ObjectIdentity::of_set(set);
    let or = |own: Option<&str>, other: &str| Some(own.unwrap_or(other).to_owned());
    // A name that another satellite of the constellation has too has a number behind it.
    let own = own_name(&identity).filter(|own| {
        let behind = object.name.strip_prefix(own);
        behind.is_none_or(|behind| !behind.starts_with(NUMBERED))
    });
    let number = own_number(&identity).unwrap_or(object.catalog_number);
    sgp4::Elements {
        object_name: or(own, &object.name),
        international_designator: or(own_designator(&identity), &object.id),
        norad_id: u64::from(number.number()),
        ..set.clone()
    }
}
