//! Kepler's equation in lanes.
//!
//! With δ = E - M the equation is δ = e sin(M + δ). When e is small so is δ, and its sine and
//! cosine are short polynomials: only products, sums and divisions of available numbers, which the
//! compiler turns into vector instructions.

/// Largest eccentricity for which [`eccentric`] has the stated accuracy.
pub(super) const LARGEST_ECCENTRICITY: f64 = 0.25;

/// Newton steps. The start is within e³/6 = 0.003 of the solution at the largest eccentricity;
/// each step squares that and multiplies it by e / (2 (1 - e)) = 1/6 at most: 1.5e-6, 4e-13, 3e-26.
const STEPS: usize = 3;

/// Cosine and sine of the eccentric anomaly from those of the mean anomaly, to 1e-15.
#[inline(always)]
pub(super) fn eccentric(cos_mean: f64, sin_mean: f64, e: f64) -> (f64, f64) {
    let mut delta = e * sin_mean / (1.0 - 2.0 * e * cos_mean + e * e).sqrt();
    for _ in 0..STEPS {
        let (cos, sin) = turned((cos_mean, sin_mean), delta);
        delta -= (delta - e * sin) / (1.0 - e * cos);
    }
    turned((cos_mean, sin_mean), delta)
}

/// Cosine and sine of an angle plus a small one.
#[inline(always)]
fn turned((cos_mean, sin_mean): (f64, f64), delta: f64) -> (f64, f64) {
    let (sin, cos) = small_sine_cosine(delta);
    (
        cos_mean * cos - sin_mean * sin,
        sin_mean * cos + cos_mean * sin,
    )
}

/// Sine and cosine up to [`LARGEST_ECCENTRICITY`] in size, by their Taylor series: the first terms
/// left out are 0.25¹³/13! = 2e-18 and 0.25¹²/12! = 1e-16.
#[inline(always)]
fn small_sine_cosine(x: f64) -> (f64, f64) {
    let x2 = x * x;
    let sine = 1.0 - x2 * (1.0 / 110.0);
    let sine = 1.0 - x2 * (1.0 / 72.0) * sine;
    let sine = 1.0 - x2 * (1.0 / 42.0) * sine;
    let sine = 1.0 - x2 * (1.0 / 20.0) * sine;
    let sine = 1.0 - x2 * (1.0 / 6.0) * sine;
    let cosine = 1.0 - x2 * (1.0 / 90.0);
    let cosine = 1.0 - x2 * (1.0 / 56.0) * cosine;
    let cosine = 1.0 - x2 * (1.0 / 30.0) * cosine;
    let cosine = 1.0 - x2 * (1.0 / 12.0) * cosine;
    let cosine = 1.0 - x2 * (1.0 / 2.0) * cosine;
    (x * sine, cosine)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Kepler's equation itself is the judge. Rounding of a few operations of numbers up to 1:
    /// 1e-15.
    #[test]
    fn the_solution_satisfies_keplers_equation() {
        for e in [1e-9, 0.001, 0.02, 0.1, LARGEST_ECCENTRICITY] {
            for degree in 0..360 {
                let anomaly = f64::from(degree).to_radians();
                let mean = anomaly - e * anomaly.sin();
                let (cos, sin) = eccentric(mean.cos(), mean.sin(), e);
                let off = (cos - anomaly.cos()).hypot(sin - anomaly.sin());
                assert!(off < 1e-15, "e = {e}, E = {degree}°: {off:e}");
            }
        }
    }
}
