//! CZML: a scenario that CesiumJS shows in a browser.
//!
//! Source: *CZML Guide* (github.com/AnalyticalGraphicsInc/czml-writer/wiki): "CZML Structure",
//! "CZML Content" and "Packet". The first packet is the document; a sampled position is
//! `[seconds, x, y, z, …]` in metres, read between the samples by a Lagrange polynomial. Positions are
//! Earth-fixed, because a viewer turns INERTIAL ones without data on the Earth's orientation.
//!
//! Samples lie further apart than those of the study, as far as the polynomial stays within a metre, and
//! reach beyond both ends so that it has nodes on both sides everywhere.

mod read;
mod write;

pub use read::{CzmlTrack, parse, read};
pub use write::write;

use nalgebra::Vector3;

/// Version of the format.
pub const FORMAT_VERSION: &str = "1.0";

/// Degree of the polynomials that are written: eight samples.
const DEGREE: usize = 7;

/// Error that the spacing of the samples is chosen for, km.
pub const TARGET_KM: f64 = 1e-3;

/// Value and derivative by time of the Lagrange polynomial through the nodes.
fn lagrange(nodes: &[(f64, Vector3<f64>)], t: f64) -> (Vector3<f64>, Vector3<f64>) {
    let (mut value, mut slope) = (Vector3::zeros(), Vector3::zeros());
    for (j, (tj, y)) in nodes.iter().enumerate() {
        // The product of the factors and its derivative, one factor after the other.
        let (mut weight, mut change) = (1.0, 0.0);
        for (m, (tm, _)) in nodes.iter().enumerate() {
            if m != j {
                let scale = 1.0 / (tj - tm);
                change = change * (t - tm) * scale + weight * scale;
                weight *= (t - tm) * scale;
            }
        }
        value += y * weight;
        slope += y * change;
    }
    (value, slope)
}

/// The nodes that CesiumJS takes for an instant: as many on both sides, shifted at the ends
/// (`SampledProperty.getValue`).
fn window(nodes: &[(f64, Vector3<f64>)], t: f64, degree: usize) -> &[(f64, Vector3<f64>)] {
    let count = (degree + 1).min(nodes.len());
    let after = nodes.partition_point(|(node, _)| *node <= t);
    let first = after
        .saturating_sub(count.div_ceil(2))
        .min(nodes.len() - count);
    &nodes[first..first + count]
}

#[cfg(test)]
mod tests;
