//! The eccentricity vector that corresponds to a radial difference.

use nalgebra::{Matrix3, Vector3};

/// e cos ω and e sin ω of the pairs (argument of latitude in rad, radial difference in km) over
/// whole revolutions, by least squares; `None` when the pairs do not determine them.
///
/// To first order r - r₀ = c - a (e cos ω cos u + e sin ω sin u).
pub(super) fn eccentricity_vector(
    samples: impl Iterator<Item = (f64, f64)>,
    semi_major_axis_km: f64,
) -> Option<[f64; 2]> {
    let mut normal = Matrix3::zeros();
    let mut right = Vector3::zeros();
    for (u, apart_km) in samples {
        let row = Vector3::new(1.0, u.cos(), u.sin());
        normal += row * row.transpose();
        right += row * apart_km;
    }
    let solved = normal.try_inverse()? * right;
    Some([-solved.y, -solved.z].map(|e_km| e_km / semi_major_axis_km))
}
