//! The model of a study against a numerical integration of the field that it is a theory of: a point
//! mass for two bodies, point mass and J2 for the J2 theories, and J2 to J4 of WGS-72 for SGP4.
//!
//! The integration starts from the osculating state of the mean elements. First-order theory gives
//! that state to O(J2²), a few metres of semi-major axis, which by itself drifts by kilometres a
//! day. This is not an error in the secular rates, so the drift is fitted and reported as a
//! correction to the mean semi-major axis of each satellite, and the gates apply to the remainder
//! over 1, 7 and 30 days.

pub mod integrator;

mod bounds;

use super::eccentricity::eccentricity_vector;
use super::sgp4::rates::{angles, closed_form};
use super::{Check, CheckedQuantity, Findings, Subject, ValidateError};
use crate::constellation::Satellite;
use crate::ephemeris::{EphemerisError, object_name};
use crate::frames::{State, Teme, ric_basis};
use crate::orbit::osculating::{OsculatingOrbit, frozen_eccentricity};
use crate::orbit::{MeanElements, Model, PropagationError};
use crate::stats::line_fit;
use crate::units::{SECONDS_PER_DAY, wrap_pi};
use bounds::IntegrationBounds;
use integrator::ZonalField;
use nalgebra::Vector3;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Spans over which the theory is compared with the integration, days.
const SPANS_DAYS: [f64; 3] = [1.0, 7.0, 30.0];

/// Satellites that are integrated, evenly spaced over the constellation.
const SATELLITES: usize = 8;

/// Samples per revolution, over which periodic terms average out.
const PER_REVOLUTION: usize = 24;

/// Largest relative change of a conserved quantity over 30 days of integration: 60 000 steps with a
/// relative tolerance of 1e-13 add up to 6e-9 if all errors have the same sign, and to 2e-11 if they
/// are random; an eccentric orbit takes longer steps at apogee.
const CONSERVED: f64 = 1e-10;

/// Fraction of its size by which the frozen eccentricity vector may move in a week.
const FROZEN_SHARE: f64 = 0.04;

/// Days after which the frozen eccentricity is measured again.
const FROZEN_DAYS: f64 = 7.0;

/// Means over each revolution of one satellite.
struct RevolutionMeans {
    /// Middle of each revolution, days.
    days: Vec<f64>,
    /// In-track difference, integration minus model, km.
    in_track_km: Vec<f64>,
    /// Node, integration minus model, degrees.
    node_deg: Vec<f64>,
    /// Difference of the integration from the model at every sample, km, in RIC axes.
    residual_km: Vec<Vector3<f64>>,
    /// Days of the samples.
    sample_days: Vec<f64>,
    /// Largest relative change of the energy and of the polar angular momentum.
    conserved: [f64; 2],
}

/// The osculating state that the integration starts from: that of the model, and of secular J2 with
/// its short-period terms added.
fn start(subject: &Subject<'_>, elements: &MeanElements) -> Result<State<Teme>, PropagationError> {
    match subject.model() {
        Model::J2 => Ok(OsculatingOrbit::new(elements).state(0.0)),
        _ => subject.model_propagator(elements)?.state_at(0.0),
    }
}

fn track(subject: &Subject<'_>, satellite: &Satellite) -> Result<RevolutionMeans, ValidateError> {
    let elements = &satellite.elements;
    let failed = |source| EphemerisError {
        name: object_name(satellite.slot),
        source,
    };
    let period_s = TAU / elements.kepler_mean_motion_rad_s();
    let step_s = period_s / PER_REVOLUTION as f64;
    let revolutions = (SPANS_DAYS[2] * SECONDS_PER_DAY / period_s).floor() as usize;
    let times: Vec<f64> = (0..revolutions * PER_REVOLUTION)
        .map(|k| k as f64 * step_s)
        .collect();
    let field = ZonalField::of(subject.model());
    let start = start(subject, elements).map_err(failed)?;
    let states = field.integrate(subject.parts.acceleration, &start, &times)?;
    let model = subject.model_propagator(elements).map_err(failed)?;
    let mut track = RevolutionMeans {
        days: Vec::new(),
        in_track_km: Vec::new(),
        node_deg: Vec::new(),
        residual_km: Vec::new(),
        sample_days: times.iter().map(|t| t / SECONDS_PER_DAY).collect(),
        conserved: conserved(field, &states),
    };
    for (times, states) in times
        .chunks_exact(PER_REVOLUTION)
        .zip(states.chunks_exact(PER_REVOLUTION))
    {
        let (mut in_track, mut node) = (0.0, 0.0);
        for (&t, state) in times.iter().zip(states) {
            let from = model.state_at(t).map_err(failed)?;
            let apart = ric_basis(&from).map_or_else(Vector3::zeros, |basis| {
                basis * (state.position_km - from.position_km)
            });
            in_track += apart.y / PER_REVOLUTION as f64;
            node += wrap_pi(angles(state)[0] - angles(&from)[0]) / PER_REVOLUTION as f64;
            track.residual_km.push(apart);
        }
        let middle_s = times[0] + 0.5 * (period_s - step_s);
        track.days.push(middle_s / SECONDS_PER_DAY);
        track.in_track_km.push(in_track);
        track.node_deg.push(node.to_degrees());
    }
    Ok(track)
}

/// Largest relative change of the energy and of the polar angular momentum.
fn conserved(field: ZonalField, states: &[State<Teme>]) -> [f64; 2] {
    let energy = |state: &State<Teme>| field.energy(state);
    let momentum = |state: &State<Teme>| state.position_km.km().cross(&state.velocity_km_s).z;
    let whole = |state: &State<Teme>| state.position_km.km().cross(&state.velocity_km_s).norm();
    let Some(first) = states.first() else {
        return [0.0; 2];
    };
    let change = |value: &dyn Fn(&State<Teme>) -> f64, scale: f64| {
        let changes = states.iter().map(|s| (value(s) - value(first)).abs());
        changes.fold(0.0, f64::max) / scale
    };
    // Relative to the total angular momentum, since a polar orbit has none about the pole.
    [
        change(&energy, energy(first).abs()),
        change(&momentum, whole(first)),
    ]
}

/// All checks of a design by integration.
///
/// # Errors
/// If a satellite cannot be propagated or the integration fails.
pub fn against_integration(subject: &Subject<'_>) -> Result<Findings, ValidateError> {
    let satellites = subject.satellites();
    let stride = satellites.len().div_ceil(SATELLITES);
    let tracks: Vec<RevolutionMeans> = satellites
        .par_iter()
        .step_by(stride)
        .map(|satellite| track(subject, satellite))
        .collect::<Result<_, _>>()?;
    let mut findings = Findings::default();
    findings.checks.extend(conservation_checks(&tracks));
    let bounds = IntegrationBounds::of(subject);
    for days in SPANS_DAYS {
        findings.checks.extend(span_checks(&bounds, &tracks, days));
    }
    findings.notes.extend(note(subject));
    findings.checks.extend(frozen_check(subject)?);
    Ok(findings)
}

/// Which field judges the model, where that is not J2.
fn note(subject: &Subject<'_>) -> Option<String> {
    let text = match subject.model() {
        Model::J2 | Model::J2Osculating => return None,
        Model::TwoBody => {
            "numerical: two-body is judged in the field of a point mass; what J2 does to it is in --against sgp4"
        }
        Model::Sgp4 => {
            "numerical: sgp4 is judged in the field of J2, J3 and J4 of WGS-72, started from its own state; its periodic terms of second order have no closed form here and no gate"
        }
    };
    Some(text.to_owned())
}

fn conservation_checks(tracks: &[RevolutionMeans]) -> Vec<Check> {
    let largest = |n: usize| tracks.iter().map(|t| t.conserved[n]).fold(0.0, f64::max);
    [("energy", 0), ("polar-momentum", 1)]
        .map(|(name, n)| {
            Check::new(
                &format!("numerical/conserved/{name}"),
                CheckedQuantity {
                    quantity: &format!("relative change in {name} over 30 days"),
                    unit: "1",
                    statistic: "max",
                },
                largest(n),
                Some(CONSERVED),
                "a zonal field conserves both: 1e-10 of the energy is 1e-6 km of semi-major axis",
            )
        })
        .to_vec()
}

/// Slope of the means over the first days, per day.
fn slope(track: &RevolutionMeans, values: &[f64], days: f64) -> f64 {
    let within = track.days.iter().take_while(|&&day| day <= days).count();
    line_fit(&track.days[..within], &values[..within]).map_or(0.0, |(_, slope)| slope)
}

fn span_checks(bounds: &IntegrationBounds, tracks: &[RevolutionMeans], days: f64) -> Vec<Check> {
    let count = tracks.len() as f64;
    let mean_slope = |values: fn(&RevolutionMeans) -> &[f64]| {
        let slopes = tracks.iter().map(|track| slope(track, values(track), days));
        slopes.sum::<f64>() / count
    };
    let drift = mean_slope(|track| &track.in_track_km);
    let node = mean_slope(|track| &track.node_deg);
    let name = |quantity: &str| format!("numerical/{days}-days/{quantity}");
    let rms = rms_after_fit(tracks, days);
    let [in_track_gate, cross_track_gate] = bounds.after_fit_km(days);
    vec![
        Check::new(
            &name("in-track-drift"),
            CheckedQuantity {
                quantity: "in-track drift of the integrated orbit relative to the model",
                unit: "km/day",
                statistic: "mean slope",
            },
            drift,
            bounds.drift_km_per_day,
            bounds.drift_reason,
        ),
        Check::new(
            &name("fitted-mean-a"),
            CheckedQuantity {
                quantity: "mean semi-major axis, integrated orbit minus elements",
                unit: "m",
                statistic: "mean",
            },
            -drift / bounds.drift_per_a_per_day * 1e3,
            None,
            "reported only: the drift expressed as the error of the starting semi-major axis that causes it",
        ),
        Check::new(
            &name("node-rate"),
            CheckedQuantity {
                quantity: "node rate of the integrated orbit minus that of the model and its terms in J2^2",
                unit: "deg/day",
                statistic: "mean slope",
            },
            node - bounds.known_node_deg_per_day,
            Some(bounds.node_deg_per_day),
            bounds.node_reason,
        ),
        Check::new(
            &name("in-track-after-fit"),
            CheckedQuantity {
                quantity: "in-track difference of the integration from the model, mean a fitted",
                unit: "km",
                statistic: "rms",
            },
            rms[1],
            in_track_gate,
            bounds.after_fit_reason,
        ),
        Check::new(
            &name("cross-track-after-fit"),
            CheckedQuantity {
                quantity: "cross-track difference of the integration from the model",
                unit: "km",
                statistic: "rms",
            },
            rms[2],
            cross_track_gate,
            bounds.after_fit_reason,
        ),
    ]
}

/// RMS of the residuals over a span, after removing a straight line from each in-track residual.
fn rms_after_fit(tracks: &[RevolutionMeans], days: f64) -> [f64; 3] {
    let mut squares = Vector3::zeros();
    let mut samples = 0.0;
    for track in tracks {
        let within = track.sample_days.iter().take_while(|&&day| day <= days);
        let n = within.count().min(track.residual_km.len());
        let in_track: Vec<f64> = track.residual_km[..n].iter().map(|r| r.y).collect();
        let (offset, slope) = line_fit(&track.sample_days[..n], &in_track).unwrap_or((0.0, 0.0));
        for (residual, day) in track.residual_km[..n].iter().zip(&track.sample_days) {
            let left = residual - Vector3::y() * (offset + slope * day);
            squares += left.component_mul(&left);
            samples += 1.0;
        }
    }
    let rms = squares.map(|sum: f64| (sum / samples).sqrt());
    [rms.x, rms.y, rms.z]
}

/// With J3, the frozen eccentricity at ω = 90° stays where it is for a week. For circular designs.
fn frozen_check(subject: &Subject<'_>) -> Result<Option<Check>, ValidateError> {
    let orbit = subject.orbit();
    let sin2 = orbit.inclination_rad.sin().powi(2);
    let frozen = frozen_eccentricity(&orbit);
    // Near the critical inclination and the equator this equilibrium does not exist.
    if orbit.eccentricity > 0.0 || (sin2 - 0.8).abs() < 0.05 || frozen < 1e-4 {
        return Ok(None);
    }
    let start = MeanElements {
        eccentricity: frozen,
        arg_perigee_rad: TAU / 4.0,
        mean_anomaly_rad: orbit.mean_argument_of_latitude_rad() - TAU / 4.0,
        ..orbit
    };
    if start.checked().is_err() {
        return Ok(None);
    }
    let field = ZonalField::J2_J3;
    let period_s = TAU / closed_form(subject)[1];
    let week_s = (FROZEN_DAYS * SECONDS_PER_DAY / period_s).round() * period_s;
    let revolution = |from_s: f64| {
        (0..PER_REVOLUTION).map(move |k| from_s + period_s * k as f64 / PER_REVOLUTION as f64)
    };
    let times: Vec<f64> = revolution(0.0).chain(revolution(week_s)).collect();
    let states = field.integrate(
        subject.parts.acceleration,
        &OsculatingOrbit::new(&start).state(0.0),
        &times,
    )?;
    let circular = OsculatingOrbit::new(&orbit);
    let vector = |part: std::ops::Range<usize>| {
        let samples = part.map(|k| {
            let apart = states[k].position_km.norm() - circular.state(times[k]).position_km.norm();
            (angles(&states[k])[1], apart)
        });
        eccentricity_vector(samples, orbit.semi_major_axis_km)
    };
    let both = vector(0..PER_REVOLUTION).zip(vector(PER_REVOLUTION..2 * PER_REVOLUTION));
    Ok(both.map(|(first, last)| {
        Check::new(
            "numerical/j3/frozen-eccentricity",
            CheckedQuantity {
                quantity: "change of the frozen eccentricity vector in a week, relative to its size",
                unit: "1",
                statistic: "difference",
            },
            (first[0] - last[0]).hypot(first[1] - last[1]) / frozen,
            Some(FROZEN_SHARE),
            "under J2 and J3 the vector circles the frozen one; started there to first order, it stays within a few percent of its size at inclinations from 20 deg, and within a tenth of that at 55 deg",
        )
    }))
}

#[cfg(test)]
mod tests;
