//! Velocities for files that have positions alone.

use crate::frames::Position;
use crate::time::Epoch;
use nalgebra::Vector3;
use std::ops::Range;

/// Positions from which a velocity is derived.
const NEIGHBOURS: usize = 9;

/// An interval is a gap if it is longer than this times each of the intervals around it: records are missing.
pub(crate) const GAP: f64 = 1.5;

/// Velocities of positions at distinct instants, given by their places, km/s: at each the derivative of the polynomial
/// through the nine nearest on the same side of every gap. None for fewer than two.
pub(crate) fn velocities<F>(
    count: usize,
    position: impl Fn(usize) -> (Epoch, Position<F>),
) -> Option<Vec<Vector3<f64>>> {
    if count < 2 {
        return None;
    }
    let mut found = Vec::with_capacity(count);
    for run in runs(count, |place| position(place).0) {
        let nodes = run.len().min(NEIGHBOURS);
        for at in run.clone() {
            let from = at
                .saturating_sub(nodes / 2)
                .clamp(run.start, run.end - nodes);
            let window: Vec<_> = (from..from + nodes).map(&position).collect();
            found.push(derivative_at(&window, at - from));
        }
    }
    let all_finite = found.iter().flat_map(Vector3::iter).all(|x| x.is_finite());
    all_finite.then_some(found)
}

/// The places between gaps, at least two each.
///
/// The spacing may change along the file, so an interval is compared with those that share a polynomial with it. The
/// first and the last are no gaps: they would leave a position alone.
fn runs(count: usize, instant: impl Fn(usize) -> Epoch) -> Vec<Range<usize>> {
    let interval_s = |k: usize| instant(k + 1).seconds_since(instant(k));
    let intervals = count - 1;
    let reach = NEIGHBOURS / 2;
    let is_gap = |k: usize| {
        let around = k.saturating_sub(reach)..(k + 1 + reach).min(intervals);
        let others_s = around.filter(|other| *other != k).map(interval_s);
        interval_s(k) > GAP * others_s.fold(0.0, f64::max)
    };
    let mut found = Vec::new();
    let mut rest_from = 0;
    for k in 1..intervals.saturating_sub(1) {
        if is_gap(k) {
            found.push(rest_from..k + 1);
            rest_from = k + 1;
        }
    }
    found.push(rest_from..count);
    found
}

/// Smallest difference of a velocity from the derivative of the positions that is reported, km/s: above the
/// rounding of any format, and below the effect of any wrong unit or of a rotating frame taken as inertial.
const LEAST_FAULT_KM_S: f64 = 1e-3;

/// Additional tolerance, as a fraction of the speed.
const SHARE: f64 = 0.01;

/// Number of samples of a satellite whose velocities are compared.
const COMPARED: usize = 50;

/// Says how velocities, of samples given by their places, differ from the derivative of the positions, if they do wherever
/// the positions are dense enough to judge; by the median, so that a manoeuvre does not count.
pub(crate) fn velocity_fault<F>(
    count: usize,
    sample: impl Fn(usize) -> (Epoch, Position<F>, Vector3<f64>),
) -> Option<String> {
    let increase = (1..count).all(|place| sample(place - 1).0 < sample(place).0);
    if count < NEIGHBOURS || !increase {
        return None;
    }
    let half = NEIGHBOURS / 2;
    let inner = count - 2 * half;
    let mut faults = Vec::new();
    for place in (half..half + inner).step_by(inner.div_ceil(COMPARED)) {
        let position = |place| {
            let (at, position_km, _) = sample(place);
            (at, position_km)
        };
        let wide: Vec<_> = (place - half..=place + half).map(position).collect();
        let derived = derivative_at(&wide, half);
        // Two nodes fewer show how far the derivative can be trusted.
        let narrow = derivative_at(&wide[1..NEIGHBOURS - 1], half - 1);
        let allowed = LEAST_FAULT_KM_S + SHARE * derived.norm();
        if (derived - narrow).norm() < 0.1 * allowed {
            let given = sample(place).2;
            faults.push((
                (given - derived).norm() / allowed,
                given.norm(),
                derived.norm(),
            ));
        }
    }
    faults.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (fault, given, derived) = *faults.get(faults.len() / 2)?;
    (fault > 1.0).then(|| {
        format!(
            "the velocities are not the derivative of the positions: {given:.4} km/s where they move at {derived:.4} km/s"
        )
    })
}

/// Derivative at node `j` of the Lagrange polynomial: the sum of f_i l_i'(t_j).
fn derivative_at<F>(window: &[(Epoch, Position<F>)], j: usize) -> Vector3<f64> {
    let t: Vec<f64> = window
        .iter()
        .map(|(at, _)| at.seconds_since(window[j].0))
        .collect();
    let mut sum = Vector3::zeros();
    for (i, (_, position)) in window.iter().enumerate() {
        let others = || (0..t.len()).filter(move |m| *m != i && *m != j);
        let weight: f64 = if i == j {
            others().map(|m| 1.0 / (t[j] - t[m])).sum()
        } else {
            others()
                .map(|m| (t[j] - t[m]) / (t[i] - t[m]))
                .product::<f64>()
                / (t[i] - t[j])
        };
        sum += position.km() * weight;
    }
    sum
}
