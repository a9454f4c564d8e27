//! Invariants: a pattern that is rotated, satellites that are reordered, a mask that is raised.

use crate::constellation::{Pattern, Satellite};
use crate::ephemeris::{Ephemeris, EphemerisError, object_name};
use crate::evaluate::{Evaluator, Setup};
use crate::frames::EarthRotation;
use crate::orbit::{MeanElements, Model};
use crate::units::wrap_two_pi;
use crate::validate::sgp4::causes::is_deep_space;
use crate::validate::{Check, CheckedQuantity, Subject, ValidateError};
use crate::visibility::Mask;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Steps by which the mask is raised, degrees.
const MASK_STEPS_DEG: [f64; 4] = [2.0, 5.0, 10.0, 20.0];

/// Largest design whose positions are matched one by one.
const MOST_MATCHED: usize = 2_000;

pub(super) fn checks(subject: &Subject<'_>) -> Result<Vec<Check>, ValidateError> {
    let mut checks = Vec::new();
    checks.extend(turn_check(subject)?);
    checks.push(order_check(subject)?);
    checks.extend(mask_check(subject)?);
    Ok(checks)
}

/// What maps a pattern onto itself: the rotation of the nodes and the shift of M, rad.
fn symmetry(subject: &Subject<'_>) -> (f64, f64) {
    let shell = &subject.shell;
    let phase = TAU * shell.phasing() as f64 / shell.satellite_count() as f64;
    let shift = match shell.pattern() {
        Pattern::Delta | Pattern::Star => phase,
        Pattern::Lattice => -phase,
    };
    (shell.node_step_deg().to_radians(), shift)
}

/// Largest distance of a rotated position from the nearest position of the pattern, km.
fn turn_check(subject: &Subject<'_>) -> Result<Option<Check>, EphemerisError> {
    let satellites = subject.satellites();
    if satellites.len() > MOST_MATCHED {
        return Ok(None);
    }
    let (turn, shift) = symmetry(subject);
    let at_s = 0.37 * subject.days() * crate::units::SECONDS_PER_DAY;
    let position = |satellite: &Satellite, elements: &MeanElements| {
        let state = subject.model_propagator(elements);
        match state.and_then(|propagator| propagator.state_at(at_s)) {
            Ok(state) => Ok(state.position_km.km()),
            Err(source) => Err(EphemerisError {
                name: object_name(satellite.slot),
                source,
            }),
        }
    };
    let places: Vec<Vector3<f64>> = satellites
        .iter()
        .map(|satellite| position(satellite, &satellite.elements))
        .collect::<Result<_, _>>()?;
    let rotation = EarthRotation::from_gmst(turn);
    // Where the nodes do not go round once, no plane follows the last.
    let turns = subject.shell.node_step_deg() * subject.shell.planes() as f64 / 360.0;
    let is_open = (turns - 1.0).abs() > 1e-9;
    let is_last = |satellite: &Satellite| satellite.slot.plane + 1 == subject.shell.planes();
    let mut largest = 0.0_f64;
    for satellite in &satellites {
        if is_open && is_last(satellite) {
            continue;
        }
        let elements = &satellite.elements;
        let shifted = MeanElements {
            mean_anomaly_rad: wrap_two_pi(elements.mean_anomaly_rad + shift),
            ..*elements
        };
        // Rotated forwards about the pole by the angle.
        let place: Vector3<f64> = rotation.direction_to_teme(position(satellite, &shifted)?);
        let distances = places.iter().map(|other| (other - place).norm());
        largest = largest.max(distances.fold(f64::INFINITY, f64::min));
    }
    // The Sun and Moon, which SGP4 includes for deep-space orbits, do not rotate with the pattern.
    let orbit = subject.orbit();
    let turns = subject.model() != Model::Sgp4 || !is_deep_space(&orbit);
    // Angles of whole revolutions are rounded several times over.
    let angle_rad = TAU + orbit.kepler_mean_motion_rad_s() * at_s;
    let gate_km = 16.0 * f64::EPSILON * angle_rad * orbit.semi_major_axis_km;
    Ok(Some(Check::new(
        "analytic/symmetry/turn",
        CheckedQuantity {
            quantity: "distance between the pattern and its rotated and shifted copy",
            unit: "km",
            statistic: "max",
        },
        largest,
        turns.then_some(gate_km),
        "delta: 360/P and 360 F/T; lattice: 360/N_o and -360 N_c/T; star: 180/P except at the seam; rounding only",
    )))
}

fn order_check(subject: &Subject<'_>) -> Result<Check, ValidateError> {
    let evaluate = subject.parts.evaluate;
    let forwards = evaluate(subject.evaluator, &subject.propagate_model()?)?;
    let mut satellites = subject.propagate_model()?.into_satellites();
    satellites.reverse();
    let backwards = evaluate(
        subject.evaluator,
        &Ephemeris::new(subject.grid(), satellites),
    )?;
    let pairs = [
        (Some(forwards.mean_visible), Some(backwards.mean_visible)),
        (forwards.mean_pdop, backwards.mean_pdop),
        (forwards.cvar_pdop, backwards.cvar_pdop),
    ];
    let change = |(a, b): (Option<f64>, Option<f64>)| match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() / a.abs().max(1.0),
        (None, None) => 0.0,
        _ => f64::INFINITY,
    };
    Ok(Check::new(
        "analytic/symmetry/order",
        CheckedQuantity {
            quantity: "change in the metrics when satellites are reordered",
            unit: "1",
            statistic: "max",
        },
        pairs.into_iter().map(change).fold(0.0, f64::max),
        Some(1e-6),
        "sums in another order: rounding only, in single precision where the fast path uses it",
    ))
}

/// The largest gain in mean visible when the mask is raised; there must be none.
fn mask_check(subject: &Subject<'_>) -> Result<Option<Check>, EphemerisError> {
    let setup = subject.setup();
    let propagated = subject.propagate_model()?;
    let mut before = None;
    let mut largest_gain = f64::NEG_INFINITY;
    let raised = MASK_STEPS_DEG.map(|step| setup.mask.degrees() + step);
    let masks = std::iter::once(setup.mask.degrees()).chain(raised);
    for mask in masks.filter_map(|degrees| Mask::from_degrees(degrees).ok()) {
        let evaluator = Evaluator::new(without_gnss(setup, mask))?;
        let visible = (subject.parts.evaluate)(&evaluator, &propagated)?.mean_visible;
        if let Some(before) = before {
            largest_gain = largest_gain.max(visible - before);
        }
        before = Some(visible);
    }
    Ok(largest_gain.is_finite().then(|| {
        Check::new(
            "analytic/mask",
            CheckedQuantity {
                quantity: "gain in mean visible when the mask is raised",
                unit: "1",
                statistic: "max",
            },
            largest_gain.max(0.0),
            Some(0.0),
            "a satellite above the higher mask is also above the lower one",
        )
    }))
}

fn without_gnss(setup: &Setup, mask: Mask) -> Setup {
    Setup {
        mask,
        gnss: Vec::new(),
        ..setup.clone()
    }
}
