//! Rates of the node and the argument of latitude, from states, against their closed forms.

use super::GateScale;
use crate::earth::{J2, MU_KM3_S2, RADIUS_KM};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::{State, Teme};
use crate::orbit::Model;
use crate::orbit::sgp4::{Sgp4Orbit, ZonalHarmonics};
use crate::stats::line_fit;
use crate::units::{SECONDS_PER_DAY, wrap_pi};
use crate::validate::{Check, CheckedQuantity, Subject};

/// Below this sine of the inclination the node is ill-defined.
const LEAST_SIN_I: f64 = 0.02;

/// Node and argument of latitude of a state, rad.
pub(in crate::validate) fn angles(state: &State<Teme>) -> [f64; 2] {
    let normal = state.position_km.km().cross(&state.velocity_km_s);
    let node = normal.x.atan2(-normal.y);
    let towards = nalgebra::Vector3::new(node.cos(), node.sin(), 0.0);
    let ahead = normal.cross(&towards) / normal.norm();
    let r = state.position_km.km();
    [node, r.dot(&ahead).atan2(r.dot(&towards))]
}

/// Closed forms of the rates for a circular orbit or nearly so, rad/s: the node, and ω + M.
pub(in crate::validate) fn closed_form(subject: &Subject<'_>) -> [f64; 2] {
    let orbit = subject.orbit();
    let a = orbit.semi_major_axis_km;
    let eta2 = 1.0 - orbit.eccentricity * orbit.eccentricity;
    let n = (MU_KM3_S2 / (a * a * a)).sqrt();
    let g = 1.5 * n * J2 * (RADIUS_KM / (a * eta2)).powi(2);
    let cos_i = orbit.inclination_rad.cos();
    let c2 = cos_i * cos_i;
    [
        -g * cos_i,
        n + g * (0.5 * (5.0 * c2 - 1.0) + 0.5 * eta2.sqrt() * (3.0 * c2 - 1.0)),
    ]
}

/// Slopes of the angles minus their closed forms, deg/day: the mean over the constellation.
fn excess_deg_per_day(
    subject: &Subject<'_>,
    propagated: &Ephemeris,
) -> Result<[f64; 2], EphemerisError> {
    let rates = closed_form(subject);
    let satellites = subject.satellites();
    let times: Vec<f64> = propagated.grid().iter().collect();
    let mut means = [vec![0.0; times.len()], vec![0.0; times.len()]];
    for (satellite, place) in propagated.satellites().iter().zip(&satellites) {
        let elements = &place.elements;
        let start = [elements.raan_rad, elements.mean_argument_of_latitude_rad()];
        for (k, &elapsed_s) in times.iter().enumerate() {
            let found = angles(&propagated.state(satellite, elapsed_s)?);
            for angle in 0..2 {
                let expected = start[angle] + rates[angle] * elapsed_s;
                means[angle][k] += wrap_pi(found[angle] - expected) / satellites.len() as f64;
            }
        }
    }
    let days: Vec<f64> = times.iter().map(|t| t / SECONDS_PER_DAY).collect();
    Ok(means.map(|mean| line_fit(&days, &mean).map_or(0.0, |(_, slope)| slope.to_degrees())))
}

/// The rates of the model of the study and of SGP4 compared with the closed forms.
pub(super) fn checks(
    subject: &Subject<'_>,
    scale: &GateScale,
) -> Result<Vec<Check>, EphemerisError> {
    let orbit = subject.orbit();
    if orbit.inclination_rad.sin() < LEAST_SIN_I {
        return Ok(Vec::new());
    }
    let closed = closed_form(subject).map(deg_per_day);
    let model = match subject.model() {
        // The line of SGP4 is that of the model.
        Model::Sgp4 => None,
        _ => Some(excess_deg_per_day(subject, &subject.propagate_model()?)?),
    };
    let sgp4 = subject.propagate_on(subject.grid(), |elements| {
        let theory = subject.sgp4_theory(ZonalHarmonics::Full);
        let (epoch, slot) = (subject.epoch(), subject.parts.slot);
        let orbit = Sgp4Orbit::from_mean_elements_with(elements, epoch, slot, theory)?;
        Ok(Box::new(orbit))
    })?;
    let theirs = excess_deg_per_day(subject, &sgp4)?;
    let known = scale.causes.excess_rad_s(ZonalHarmonics::Full);
    // On an eccentric orbit the true argument of latitude oscillates about the mean by 2e.
    let swing_deg = (2.0 * orbit.eccentricity).to_degrees();
    let in_track_km = scale.causes.higher_order_km_per_day();
    let in_track_deg = (in_track_km / orbit.semi_major_axis_km).to_degrees();
    let periodic = scale.causes.periodic_rates_rad_per_day(scale.leftover);
    // An error in position moves the node by a factor 1/sin i.
    let lever = 1.0 / orbit.inclination_rad.sin();
    let leftover_deg = 0.02 * swing_deg / scale.days.min(1.0);
    // The velocity turns with the node: r × v swings about the normal of the plane by dΩ/dt / n, twice
    // around, and so does the node of short-period terms.
    let swing_rad = (closed[0] / closed[1]).abs()
        + match subject.model() {
            Model::J2Osculating => {
                let km = scale.causes.short_period_km.iter().sum::<f64>();
                km * lever / orbit.semi_major_axis_km
            }
            _ => 0.0,
        };
    // The square of the swing has four periods per revolution.
    let [_, twice, four_times] = scale.leftover.slope_per_day;
    let swing_rad_per_day = swing_rad * twice + swing_rad * swing_rad * four_times;
    let rounding_deg = ROUNDING_DEG_PER_DAY + swing_rad_per_day.to_degrees();
    let mut checks = Vec::new();
    for (n, name) in ["node", "argument-of-latitude"].into_iter().enumerate() {
        let unit = "deg/day";
        checks.push(Check::new(
            &format!("sgp4/rates/{name}"),
            CheckedQuantity {
                quantity: &format!("rate of the {name}, closed form"),
                unit,
                statistic: "rate",
            },
            closed[n],
            None,
            "secular J2: -g cos i; n + g (2 - 5/2 sin^2 i + sqrt(1 - e^2) (1 - 3/2 sin^2 i))",
        ));
        if let Some(ours) = model {
            checks.push(Check::new(
                &format!("sgp4/rates/{name}/{}", subject.model_label()),
                CheckedQuantity {
                    quantity: &format!("rate of the {name} minus closed form"),
                    unit,
                    statistic: "slope",
                },
                ours[n],
                Some(rounding_deg + if n == 1 { leftover_deg } else { 0.0 }),
                "states of the model compared with the secular rates of J2 in closed form: rounding, plus the swing of r x v with the node, and its square, over an incomplete revolution",
            ));
        }
        checks.push(Check::new(
            &format!("sgp4/rates/{name}/sgp4"),
            CheckedQuantity {
                quantity: &format!("rate of the {name} minus closed form with J2^2 and J4"),
                unit,
                statistic: "slope",
            },
            theirs[n] - deg_per_day(known[n]),
            scale.gate(lever * in_track_deg + periodic[n].to_degrees() + leftover_deg),
            scale.reason("SGP4's own secular rates: third-order terms and the constants of WGS-72, divided by sin i because the node is sensitive at low inclination, plus what the samples leave of the periodic terms of J2 and of the frozen eccentricity"),
        ));
    }
    Ok(checks)
}

/// What the slope of an angle over a day is good to, degrees a day: a millimetre along the orbit, for
/// rounding and for what an eccentricity leaves of the periodic terms in the mean over a constellation.
const ROUNDING_DEG_PER_DAY: f64 = 1e-8;

fn deg_per_day(rate_rad_s: f64) -> f64 {
    (rate_rad_s * SECONDS_PER_DAY).to_degrees()
}
