//! The least PDOP that any geometry of some satellites can have ([M-60](crate::models#m-60)).

use crate::evaluate::Setup;

/// Steps of the search for the minimum over p; the bracket shrinks by 0.618 in each, to below the rounding of p².
const STEPS: usize = 60;

/// What the minimum that is found may be above the true one, relative: the function is flat there, so the error of p
/// enters squared.
const ROUNDING: f64 = 1e-9;

/// c(ε) of PDOP >= c/√N, for N satellites at elevations of at least ε, 0 <= sin ε < 1.
pub(super) fn constant(sine_of_mask: f64) -> f64 {
    let s = sine_of_mask;
    let squared = |p: f64| {
        let horizontal = (1.0 - p) * (1.0 - s * s);
        let vertical = p * (1.0 - p) * (1.0 - s).powi(2);
        4.0 / horizontal + 1.0 / vertical
    };
    // Convex: both terms are reciprocals of positive concave functions.
    let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..STEPS {
        let (left, right) = (high - golden * (high - low), low + golden * (high - low));
        if squared(left) < squared(right) {
            high = right;
        } else {
            low = left;
        }
    }
    (squared((low + high) / 2.0) * (1.0 - ROUNDING)).sqrt()
}

/// The constant of a setup: that of its lower mask.
pub(super) fn of_setup(setup: &Setup) -> f64 {
    let mask_deg = match setup.gnss.is_empty() {
        true => setup.mask.degrees(),
        false => setup.mask.degrees().min(setup.gnss_mask.degrees()),
    };
    constant(mask_deg.max(0.0).to_radians().sin())
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, Vector3};
    use proptest::prelude::*;

    /// With the mask at the horizon (4 p + 1)/(p (1 - p)) has its minimum (1 + √5)² at p = (√5 - 1)/4.
    #[test]
    fn validate_constant_at_the_horizon() {
        let expected = 1.0 + 5.0_f64.sqrt();
        assert!((constant(0.0) / expected - 1.0).abs() < 2e-9);
        assert!(constant(0.2) > constant(0.0) && constant(0.5) > constant(0.2));
    }

    /// Four satellites at the zenith for nine at the mask, evenly around, come within 1e-5 of the bound of the
    /// horizon: p = 0.3077 in place of 0.3090.
    #[test]
    fn validate_the_bound_is_attained() {
        let around = (0..9).map(|n| {
            let angle = std::f64::consts::TAU / 9.0 * f64::from(n);
            Vector3::new(angle.cos(), angle.sin(), 0.0)
        });
        let zenith = std::iter::repeat_n(Vector3::z(), 4);
        let units: Vec<_> = around.chain(zenith).collect();
        let ratio = pdop(&units).unwrap() / (constant(0.0) / 13.0_f64.sqrt());
        assert!(ratio > 1.0 && ratio < 1.0 + 1e-5, "{ratio}");
    }

    /// PDOP with one clock, by inverting the whole normal matrix; `None` where rounding decides whether it has an inverse.
    fn pdop(units: &[Vector3<f64>]) -> Option<f64> {
        let rows = DMatrix::from_fn(units.len(), 4, |n, axis| match axis {
            3 => 1.0,
            _ => units[n][axis],
        });
        let normal = rows.transpose() * rows;
        let eigenvalues = normal.clone().symmetric_eigenvalues();
        if eigenvalues.min() < 1e-12 * eigenvalues.max() {
            return None;
        }
        let inverse = normal.try_inverse()?;
        Some((inverse[(0, 0)] + inverse[(1, 1)] + inverse[(2, 2)]).sqrt())
    }

    proptest! {
        /// No sky is better than the bound, however it is chosen.
        #[test]
        fn validate_no_sky_is_better(
            mask_deg in 0.0..40.0_f64,
            sky in prop::collection::vec((0.0..1.0_f64, 0.0..360.0_f64), 4..14),
        ) {
            let s = mask_deg.to_radians().sin();
            let units: Vec<_> = sky
                .iter()
                .map(|(height, azimuth_deg)| {
                    // Crowded at the mask and at the zenith, where the best skies are.
                    let height = if *height < 0.4 { 0.0 } else if *height > 0.8 { 1.0 } else { *height };
                    let z = s + (1.0 - s) * height;
                    let (sin, cos) = azimuth_deg.to_radians().sin_cos();
                    let level = (1.0 - z * z).sqrt();
                    Vector3::new(level * cos, level * sin, z)
                })
                .collect();
            if let Some(pdop) = pdop(&units).filter(|pdop| pdop.is_finite()) {
                let bound = constant(s) / (units.len() as f64).sqrt();
                prop_assert!(pdop >= bound, "{pdop} < {bound}");
            }
        }
    }
}
