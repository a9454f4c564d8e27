//! Mean visible without stepping through time.
//!
//! Over a long time the node of a satellite drifts evenly past every meridian, independently of its
//! position in the orbit. For each position, the longitudes from which it is visible form an arc
//! about its own meridian, whose ends follow from the definition of elevation; the fraction of time
//! in view is the mean of the arcs over the mean anomaly.

use crate::earth::RADIUS_KM;
use crate::evaluate::Setup;
use crate::ground::Site;
use crate::orbit::kepler::eccentric_anomaly;
use crate::orbit::osculating::{frozen_eccentricity, radius_shift_km};
use crate::orbit::{MeanElements, Model};
use crate::validate::{Check, CheckedQuantity, Subject, ValidateError};
use std::f64::consts::{PI, TAU};

/// Nodes over the mean anomaly. Arcs vanish like a square root, so the error is N^-3/2, 1e-6.
const NODES: usize = 20_000;

/// Fraction of time for which a site sees a satellite of this orbit.
pub(super) fn visible_share(orbit: &MeanElements, site: &Site, mask_deg: f64) -> f64 {
    let (up, origin) = (site.local.up, site.local.origin_km.km());
    // Everything is symmetric about the site's meridian: distance from the axis, and height over the
    // equator.
    let (up_out, up_pole) = (up.x.hypot(up.y), up.z);
    let (origin_out, origin_pole) = (origin.x.hypot(origin.y), origin.z);
    let sin_mask = mask_deg.to_radians().sin();
    let sum: f64 = (0..NODES)
        .map(|k| {
            let [out, pole] = place(orbit, TAU * (k as f64 + 0.5) / NODES as f64);
            // Height over the horizon is a + b C and distance² is d - 2 q C, C = cos(longitude).
            let height = |c: f64| up_out * (out * c - origin_out) + up_pole * (pole - origin_pole);
            let seen = |c: f64| {
                let distance2 = out * out + pole * pole + origin_out.powi(2) + origin_pole.powi(2)
                    - 2.0 * (out * origin_out * c + pole * origin_pole);
                height(c) - sin_mask * distance2.max(0.0).sqrt()
            };
            arc(seen)
        })
        .sum();
    sum / NODES as f64 / PI
}

/// Distance from the axis and height over the equator at a mean anomaly, km.
fn place(orbit: &MeanElements, mean_anomaly: f64) -> [f64; 2] {
    let e = orbit.eccentricity;
    let (sin_e, cos_e) = eccentric_anomaly(mean_anomaly, e).sin_cos();
    let a = orbit.semi_major_axis_km;
    let (x, y) = (a * (cos_e - e), a * (1.0 - e * e).sqrt() * sin_e);
    let (sin_w, cos_w) = orbit.arg_perigee_rad.sin_cos();
    let ahead = sin_w * x + cos_w * y;
    let pole = ahead * orbit.inclination_rad.sin();
    [(x * x + y * y - pole * pole).max(0.0).sqrt(), pole]
}

/// Half the arc of longitudes, rad, for which a function of their cosine that increases is positive.
fn arc(seen: impl Fn(f64) -> f64) -> f64 {
    if seen(1.0) < 0.0 {
        return 0.0;
    }
    if seen(-1.0) >= 0.0 {
        return PI;
    }
    let (mut below, mut above) = (-1.0, 1.0);
    // 40 halvings: 2e-12 of the cosine, 2e-6 rad at the worst, where the arc closes.
    for _ in 0..40 {
        let middle = 0.5 * (below + above);
        if seen(middle) < 0.0 {
            below = middle;
        } else {
            above = middle;
        }
    }
    (0.5_f64 * (below + above)).acos()
}

/// Sites with weights, one per latitude, since the fraction does not depend on longitude.
fn rows(setup: &Setup) -> Vec<(Site, f64)> {
    let mut rows: Vec<(Site, f64)> = Vec::new();
    for site in &setup.sites {
        match rows
            .iter_mut()
            .find(|(row, _)| row.latitude_deg == site.latitude_deg)
        {
            Some((_, weight)) => *weight += site.weight,
            None => rows.push((site.clone(), site.weight)),
        }
    }
    rows
}

/// Relative difference that a finite span may cause.
///
/// The discrepancy of one satellite over D days is that of a sequence of N = 15 D revolutions:
/// each passes the site at some longitude, and the count is off by at most one pass in N, or 0.6 of
/// one at random. For T satellites, twice the standard deviation is 1.2/(N √T).
fn finite_span(subject: &Subject<'_>) -> f64 {
    let revolutions = subject.days() * 86_400.0 * subject.orbit().kepler_mean_motion_rad_s() / TAU;
    let satellites = subject.shell.satellite_count() as f64;
    1.2 / revolutions.max(1.0) / satellites.sqrt()
}

/// About how long a pass over a site lasts, seconds: the mean chord of the cap that a satellite sees, which is
/// π/4 of its diameter, at the mean motion.
fn mean_pass_s(orbit: &MeanElements, mask_rad: f64) -> f64 {
    let cos = (RADIUS_KM / orbit.semi_major_axis_km * mask_rad.cos()).min(1.0);
    let radius_rad = (cos.acos() - mask_rad).max(0.0);
    0.5 * PI * radius_rad / orbit.kepler_mean_motion_rad_s()
}

/// The gate of a mean over samples, and its reason. Samples count a pass by its duration while they are no further
/// apart than it is long. Beyond, passes fall between them; what is then missed depends on how the step fits the
/// periods of the orbit and of the pattern, for which there is no bound.
fn sampling_gate(subject: &Subject<'_>) -> (Option<f64>, String) {
    let step_s = subject.grid().step_s();
    let pass_s = mean_pass_s(
        &subject.orbit(),
        subject.setup().mask.degrees().to_radians(),
    );
    if step_s <= pass_s {
        let reason = "a finite span cuts off at most a pass or two per satellite; the errors of evenly spread satellites average out";
        return (Some(finite_span(subject)), reason.to_owned());
    }
    let reason = format!(
        "reported only: a step of {step_s} s is longer than a pass, {pass_s:.0} s in the mean, so that passes fall between samples"
    );
    (None, reason)
}

/// The mean figure of the orbit that the model propagates: the ellipse of the elements, with the radius
/// that short-period terms shift, and with the frozen eccentricity that J3 forces on SGP4's circles.
fn figure(subject: &Subject<'_>) -> MeanElements {
    let orbit = subject.orbit();
    let shifted = MeanElements {
        semi_major_axis_km: orbit.semi_major_axis_km + radius_shift_km(&orbit),
        ..orbit
    };
    match subject.model() {
        Model::TwoBody | Model::J2 => orbit,
        Model::J2Osculating => shifted,
        Model::Sgp4 if orbit.eccentricity > 0.0 => shifted,
        Model::Sgp4 => MeanElements {
            eccentricity: frozen_eccentricity(&orbit),
            arg_perigee_rad: 0.25 * TAU,
            ..shifted
        },
    }
}

pub(super) fn checks(subject: &Subject<'_>) -> Result<Vec<Check>, ValidateError> {
    let setup = subject.setup();
    let orbit = figure(subject);
    let rows = rows(setup);
    // A list of points may have as many latitudes as points; a sample is enough.
    if rows.len() > 200 {
        return Ok(Vec::new());
    }
    let weight: f64 = rows.iter().map(|(_, weight)| weight).sum();
    let share: f64 = rows
        .iter()
        .map(|(site, weight)| weight * visible_share(&orbit, site, setup.mask.degrees()))
        .sum::<f64>()
        / weight;
    let expected = share * subject.shell.satellite_count() as f64;
    let propagated = subject.propagate_model()?;
    let found = (subject.parts.evaluate)(subject.evaluator, &propagated)?.mean_visible;
    let mut checks = vec![Check::new(
        "analytic/mean-visible/quadrature",
        CheckedQuantity {
            quantity: "mean visible, by quadrature",
            unit: "1",
            statistic: "mean",
        },
        expected,
        None,
        "reported only: the long-time limit, where node and position in the orbit are independent",
    )];
    // A constellation that no site ever sees has no relative difference.
    if expected > 0.0 {
        let (gate, reason) = sampling_gate(subject);
        checks.push(Check::new(
            "analytic/mean-visible",
            CheckedQuantity {
                quantity: "mean visible of the study relative to quadrature, minus 1",
                unit: "1",
                statistic: "mean",
            },
            found / expected - 1.0,
            gate,
            &reason,
        ));
    }
    Ok(checks)
}
