//! Velocities for files that have positions alone.

use crate::frames::Position;
use crate::time::Epoch;
use nalgebra::Vector3;

/// Positions from which a velocity is derived.
const NEIGHBOURS: usize = 9;

/// Velocities of positions at distinct instants, km/s: at each the derivative of the polynomial
/// through the nine nearest. None for fewer than two.
pub(crate) fn velocities<F>(positions: &[(Epoch, Position<F>)]) -> Option<Vec<Vector3<f64>>> {
    if positions.len() < 2 {
        return None;
    }
    let count = positions.len().min(NEIGHBOURS);
    let derivative = |at: usize| {
        let from = at.saturating_sub(count / 2).min(positions.len() - count);
        let window = &positions[from..from + count];
        derivative_at(window, at - from)
    };
    let found: Vec<_> = (0..positions.len()).map(derivative).collect();
    let all_finite = found.iter().flat_map(Vector3::iter).all(|x| x.is_finite());
    all_finite.then_some(found)
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
