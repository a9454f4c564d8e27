//! Exported element sets: the loss from their digits and their epoch.

use crate::ephemeris::{Ephemeris, EphemerisError, EphemerisSatellite, object_name};
use crate::formats::metadata::Object;
use crate::formats::{element_set, tle};
use crate::orbit::sgp4::Sgp4Orbit;
use crate::validate::residuals::{BudgetLine, compare};
use crate::validate::{Check, CheckedQuantity, Findings, Subject, ValidateError};

/// Half of the last digit of an angle of a TLE, degrees.
const ANGLE_DEG: f64 = 0.5e-4;

/// Half of the last digit of the mean motion, revolutions a day.
const MEAN_MOTION_REV_DAY: f64 = 0.5e-8;

/// Half of the last digit of the eccentricity.
const ECCENTRICITY: f64 = 0.5e-7;

/// A design as element sets, propagated by SGP4.
pub(super) struct WrittenSets {
    /// As read back from the lines.
    pub(super) propagated: Ephemeris,
    /// With all digits, at the epoch as a TLE can represent it.
    unrounded: Ephemeris,
    /// From the epoch of the study to that which a TLE can write, s.
    since_s: f64,
}

impl WrittenSets {
    pub(super) fn new(subject: &Subject<'_>) -> Result<Self, ValidateError> {
        let epoch = subject.epoch();
        let rounded = tle::rounded_epoch(epoch);
        let since_s = rounded.seconds_since(epoch);
        let (mut propagated, mut unrounded) = (Vec::new(), Vec::new());
        for (index, satellite) in subject.satellites().iter().enumerate() {
            let name = object_name(satellite.slot);
            let object = Object::numbered(&name, index, epoch)?;
            let elements = (subject.parts.carried)(&satellite.elements, since_s);
            let set = element_set(&elements, &object, rounded, subject.parts.slot);
            let propagate = |set: &::sgp4::Elements| match Sgp4Orbit::from_element_set_with(
                set,
                epoch,
                subject.parts.sgp4,
            ) {
                Ok(orbit) => Ok(EphemerisSatellite {
                    name: name.clone(),
                    slot: Some(satellite.slot),
                    propagator: Box::new(orbit),
                }),
                Err(source) => Err(EphemerisError {
                    name: name.clone(),
                    source,
                }),
            };
            propagated.push(propagate(&(subject.parts.written)(&set)?)?);
            unrounded.push(propagate(&set)?);
        }
        Ok(Self {
            propagated: Ephemeris::new(subject.grid(), propagated),
            unrounded: Ephemeris::new(subject.grid(), unrounded),
            since_s,
        })
    }

    /// Digits and epoch against SGP4 from unrounded elements at the exact epoch, `exact`.
    pub(super) fn findings(
        &self,
        subject: &Subject<'_>,
        exact: &Ephemeris,
    ) -> Result<Findings, ValidateError> {
        let digits = compare(
            "sgp4-at-tle-epoch/sgp4-written-tle",
            "digits of a TLE: angles to 1e-4 deg, mean motion to 1e-8 rev/day",
            &self.unrounded,
            &self.propagated,
        )?;
        let epoch = compare(
            "sgp4/sgp4-at-tle-epoch",
            "epoch of a TLE, in steps of 1e-8 day, with the elements propagated there by J2",
            exact,
            &self.unrounded,
        )?;
        Ok(Findings {
            checks: vec![
                digits_check(subject, &digits),
                epoch_check(&epoch, self.since_s),
                sidereal_check(subject),
            ],
            budget: vec![digits, epoch],
            ..Findings::default()
        })
    }
}

fn digits_check(subject: &Subject<'_>, line: &BudgetLine) -> Check {
    let a = subject.orbit().semi_major_axis_km;
    // Ω, i, ω and M at half a digit each, e twice, and the mean motion over the span.
    let angles_km = 4.0 * ANGLE_DEG.to_radians() * a;
    let shape_km = 2.0 * ECCENTRICITY * a;
    let drift_km = std::f64::consts::TAU * MEAN_MOTION_REV_DAY * subject.days() * a;
    Check::new(
        "sgp4/tle/digits",
        CheckedQuantity {
            quantity: "distance due to the digits of a TLE",
            unit: "km",
            statistic: "max",
        },
        line.worst.distance_km,
        // Sets whose epoch is before the span drift a little longer; 10 % covers this.
        Some(1.1 * (angles_km + shape_km + drift_km)),
        "half a digit in each of the four angles, in e and in the mean motion, over the span",
    )
}

fn epoch_check(line: &BudgetLine, since_s: f64) -> Check {
    let (gate, reason) = if since_s == 0.0 {
        (
            None,
            "reported only: a TLE can represent this epoch, so the elements stay as they are",
        )
    } else {
        (
            // A double of years resolves an instant to 20 us.
            Some(2e-4),
            "elements are propagated to the rounded epoch, at most 0.43 ms away; the remainder is the resolution of dates in doubles, 20 us; without this step it would be 3.2 m",
        )
    };
    Check::new(
        "sgp4/tle/epoch",
        CheckedQuantity {
            quantity: "distance due to the epoch of a TLE",
            unit: "km",
            statistic: "max",
        },
        line.worst.distance_km,
        gate,
        reason,
    )
}

/// Our sidereal time compared with SGP4's in AFSPC mode, along the orbit.
fn sidereal_check(subject: &Subject<'_>) -> Check {
    let grid = subject.grid();
    let last_s = grid.elapsed_s(grid.len() - 1);
    let a = subject.orbit().semi_major_axis_km;
    let apart = [0.0, last_s].map(|elapsed_s| {
        let epoch = grid.epoch().plus_seconds(elapsed_s);
        let years =
            ::sgp4::julian_years_since_j2000_afspc_compatibility_mode(&epoch.utc().naive_utc());
        let theirs = ::sgp4::afspc_epoch_to_sidereal_time(years);
        let ours = (subject.parts.gmst_rad)(grid.epoch(), elapsed_s);
        a * crate::units::wrap_pi(ours - theirs).abs()
    });
    Check::new(
        "sgp4/sidereal-time",
        CheckedQuantity {
            quantity: "rotation of the Earth by SGP4's own sidereal time",
            unit: "km",
            statistic: "max",
        },
        apart[0].max(apart[1]),
        Some(1e-3),
        "the AFSPC expression (1970) and IAU 1982 differ by less than 1e-7 rad this century",
    )
}
