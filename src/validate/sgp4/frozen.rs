//! The eccentricity forced by J3, and how an element set cancels it.

use super::GateScale;
use super::causes::Causes;
use crate::earth::RADIUS_KM;
use crate::ephemeris::EphemerisError;
use crate::frames::{State, Teme};
use crate::orbit::sgp4::{Sgp4Orbit, ZonalHarmonics};
use crate::orbit::{MeanElements, PropagationError, Propagator};
use crate::validate::eccentricity::eccentricity_vector;
use crate::validate::{Check, CheckedQuantity, Subject};
use std::f64::consts::TAU;

/// Samples over the first revolution.
const SAMPLES: usize = 72;

/// The eccentricity vector of one propagation minus that of another over the first revolution.
fn vector(
    orbit: &MeanElements,
    with: &impl Propagator,
    without: &impl Propagator,
) -> Result<Option<[f64; 2]>, PropagationError> {
    let period_s = TAU / orbit.kepler_mean_motion_rad_s();
    let radius = |state: State<Teme>| state.position_km.norm();
    let mut samples = Vec::with_capacity(SAMPLES);
    for k in 0..SAMPLES {
        let turn = k as f64 / SAMPLES as f64;
        let at_s = period_s * turn;
        let u = orbit.mean_argument_of_latitude_rad() + TAU * turn;
        samples.push((
            u,
            radius(with.state_at(at_s)?) - radius(without.state_at(at_s)?),
        ));
    }
    Ok(eccentricity_vector(
        samples.into_iter(),
        orbit.semi_major_axis_km,
    ))
}

/// The frozen eccentricity compared with its closed form, and the remainder when an element set has
/// it at the perigee that cancels it. For circular designs.
pub(super) fn checks(
    subject: &Subject<'_>,
    scale: &GateScale,
) -> Result<Vec<Check>, EphemerisError> {
    let orbit = subject.orbit();
    if orbit.eccentricity > 0.0 || scale.deep_space {
        return Ok(Vec::new());
    }
    let found = eccentricities(subject, &orbit, &scale.causes);
    let found = found.map_err(|source| EphemerisError {
        name: crate::ephemeris::object_name(crate::constellation::Slot::FIRST),
        source,
    })?;
    let Some([forced, left]) = found else {
        return Ok(Vec::new());
    };
    let frozen = scale.causes.frozen_km / orbit.semi_major_axis_km;
    // SGP4's minimum eccentricity, 1e-6, in either propagation, and terms of order J2 of the forced
    // one, with coefficients of a few.
    let gate = 0.005 * frozen + 2e-6;
    Ok(vec![
        Check::new(
            "sgp4/frozen-eccentricity",
            CheckedQuantity {
                quantity: "e sin w forced by J3",
                unit: "1",
                statistic: "fit",
            },
            forced[1],
            None,
            "SGP4 gives an element set with e = 0 this eccentricity at w = 90 deg",
        ),
        Check::new(
            "sgp4/frozen-eccentricity/closed-form",
            CheckedQuantity {
                quantity: "forced e sin w minus |J3/(2 J2)| R/a sin i",
                unit: "1",
                statistic: "fit",
            },
            forced[1] - frozen,
            Some(gate),
            "first order in J3/J2, accurate to a few J2 of its size; SGP4 keeps the eccentricity at 1e-6 or more",
        ),
        Check::new(
            "sgp4/frozen-eccentricity/cancelled",
            CheckedQuantity {
                quantity: "e that remains when the set has the frozen e at the cancelling w",
                unit: "1",
                statistic: "fit",
            },
            left[0].hypot(left[1]),
            Some(gate),
            "a frozen eccentricity written at w = 270 deg cancels the forced one at the epoch; at 90 deg it would double it",
        ),
    ])
}

/// The eccentricity vector of SGP4 minus that of J2 alone, and the remainder with the frozen
/// eccentricity in the set.
fn eccentricities(
    subject: &Subject<'_>,
    orbit: &MeanElements,
    causes: &Causes,
) -> Result<Option<[[f64; 2]; 2]>, PropagationError> {
    let slot = subject.parts.slot;
    let propagate = |elements: &MeanElements, zonals| {
        let theory = subject.sgp4_theory(zonals);
        Sgp4Orbit::from_mean_elements_with(elements, subject.epoch(), slot, theory)
    };
    let plain = propagate(orbit, ZonalHarmonics::J2Only)?;
    let perigee_rad = subject.parts.cancelling_perigee_deg.to_radians();
    let carrying = MeanElements {
        eccentricity: causes.frozen_km / orbit.semi_major_axis_km,
        arg_perigee_rad: perigee_rad,
        mean_anomaly_rad: orbit.mean_argument_of_latitude_rad() - perigee_rad,
        ..*orbit
    };
    let can_propagate = carrying.semi_major_axis_km * (1.0 - carrying.eccentricity) > RADIUS_KM;
    if !can_propagate {
        return Ok(None);
    }
    let forced = vector(orbit, &propagate(orbit, ZonalHarmonics::Full)?, &plain)?;
    let left = vector(orbit, &propagate(&carrying, ZonalHarmonics::Full)?, &plain)?;
    Ok(forced.zip(left).map(|(forced, left)| [forced, left]))
}
