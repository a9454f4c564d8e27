//! Velocities for files that have positions alone.

use crate::frames::Position;
use crate::time::Epoch;
use nalgebra::Vector3;

/// Positions from which a velocity is derived.
const NEIGHBOURS: usize = 9;

/// An interval is a gap if it is longer than this times each of the intervals around it: records are missing.
pub(crate) const GAP: f64 = 1.5;

/// Velocities of positions at distinct instants, km/s: at each the derivative of the polynomial
/// through the nine nearest on the same side of every gap. None for fewer than two.
pub(crate) fn velocities<F>(positions: &[(Epoch, Position<F>)]) -> Option<Vec<Vector3<f64>>> {
    if positions.len() < 2 {
        return None;
    }
    let mut found = Vec::with_capacity(positions.len());
    for run in runs(positions) {
        let count = run.len().min(NEIGHBOURS);
        found.extend((0..run.len()).map(|at| {
            let from = at.saturating_sub(count / 2).min(run.len() - count);
            derivative_at(&run[from..from + count], at - from)
        }));
    }
    let all_finite = found.iter().flat_map(Vector3::iter).all(|x| x.is_finite());
    all_finite.then_some(found)
}

/// The positions between gaps, at least two each.
///
/// The spacing may change along the file, so an interval is compared with those that share a polynomial with it. The
/// first and the last are no gaps: they would leave a position alone.
fn runs<F>(positions: &[(Epoch, Position<F>)]) -> Vec<&[(Epoch, Position<F>)]> {
    let intervals_s: Vec<f64> = positions
        .windows(2)
        .map(|pair| pair[1].0.seconds_since(pair[0].0))
        .collect();
    let reach = NEIGHBOURS / 2;
    let is_gap = |k: usize| {
        let before = &intervals_s[k.saturating_sub(reach)..k];
        let after = &intervals_s[k + 1..(k + 1 + reach).min(intervals_s.len())];
        let longest_s = before.iter().chain(after).copied().fold(0.0, f64::max);
        intervals_s[k] > GAP * longest_s
    };
    let mut found = Vec::new();
    let mut rest_from = 0;
    for k in 1..intervals_s.len().saturating_sub(1) {
        if is_gap(k) {
            found.push(&positions[rest_from..=k]);
            rest_from = k + 1;
        }
    }
    found.push(&positions[rest_from..]);
    found
}

/// Smallest difference of a velocity from the derivative of the positions that is reported, km/s: above the
/// rounding of any format, and below the effect of any wrong unit or of a rotating frame taken as inertial.
const LEAST_FAULT_KM_S: f64 = 1e-3;

/// Additional tolerance, as a fraction of the speed.
const SHARE: f64 = 0.01;

/// Number of samples of a satellite whose velocities are compared.
const COMPARED: usize = 50;

/// Says how velocities differ from the derivative of the positions, if they do wherever the positions are
/// dense enough to judge; by the median, so that a manoeuvre does not count.
pub(crate) fn velocity_fault<F>(samples: &[(Epoch, Position<F>, Vector3<f64>)]) -> Option<String> {
    let positions: Vec<_> = samples
        .iter()
        .map(|(at, r, _)| (*at, Position::new(r.km())))
        .collect();
    let increase = positions.windows(2).all(|pair| pair[0].0 < pair[1].0);
    if positions.len() < NEIGHBOURS || !increase {
        return None;
    }
    let half = NEIGHBOURS / 2;
    let inner = positions.len() - 2 * half;
    let mut faults = Vec::new();
    for place in (half..half + inner).step_by(inner.div_ceil(COMPARED)) {
        let wide: &[(Epoch, Position<F>)] = &positions[place - half..=place + half];
        let derived = derivative_at(wide, half);
        // Two nodes fewer show how far the derivative can be trusted.
        let narrow = derivative_at(&wide[1..NEIGHBOURS - 1], half - 1);
        let allowed = LEAST_FAULT_KM_S + SHARE * derived.norm();
        if (derived - narrow).norm() < 0.1 * allowed {
            let given = samples[place].2;
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
