//! From the mean elements of a design to an SGP4 element set.

use crate::formats::metadata::Object;
use crate::orbit::MeanElements;
use crate::orbit::sgp4::MeanMotionSlot;
use crate::time::Epoch;
use crate::units::wrap_360;

/// The unrounded element set of mean elements at `epoch`: what an OMM writes in full and a TLE
/// rounds. Without drag; `slot` selects its mean motion.
#[must_use]
pub fn element_set(
    elements: &MeanElements,
    object: &Object,
    epoch: Epoch,
    slot: MeanMotionSlot,
) -> sgp4::Elements {
    sgp4::Elements {
        object_name: Some(object.name.clone()),
        international_designator: Some(object.id.clone()),
        norad_id: u64::from(object.catalog_number.number()),
        classification: sgp4::Classification::Unclassified,
        datetime: epoch.utc().naive_utc(),
        mean_motion_dot: 0.0,
        mean_motion_ddot: 0.0,
        drag_term: 0.0,
        element_set_number: 1,
        inclination: elements.inclination_rad.to_degrees(),
        right_ascension: wrap_360(elements.raan_rad.to_degrees()),
        eccentricity: elements.eccentricity,
        argument_of_perigee: wrap_360(elements.arg_perigee_rad.to_degrees()),
        mean_anomaly: wrap_360(elements.mean_anomaly_rad.to_degrees()),
        mean_motion: slot.mean_motion_rev_day(elements),
        revolution_number: 0,
        ephemeris_type: 0,
    }
}
