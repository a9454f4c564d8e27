//! The length of a zero-mean Gaussian error in one, two or three dimensions, and its quantile in a mixture.
//!
//! With the principal variances λ of its covariance, |e|² = Σ λ z² is a quadratic form of standard normal
//! numbers z. Its characteristic function is a product, and the distribution follows by inverting the
//! Laplace transform ([M-50](crate::models#m-50)), for any ratio of the variances, zero included.

use nalgebra::Complex;
use rayon::prelude::*;
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Points of the contour. The error of a probability is below 1e-10: e^(-1.36 · 20) = 1.5e-12, and rounding.
const POINTS: usize = 20;

/// The points in the upper half plane, for unit time, each with its weight; those below are conjugate.
type Contour = [(Complex<f64>, Complex<f64>); POINTS / 2];

/// The modified Talbot contour z(θ) = N (-σ + μ θ cot(α θ) + i ν θ) with the parameters of Dingfelder and Weideman,
/// *Numer. Algorithms* 68 (2015) 167, for the midpoint rule in θ from -π to π.
static CONTOUR: LazyLock<Contour> = LazyLock::new(|| {
    let (sigma, mu, nu, alpha) = (0.6122, 0.5017, 0.2645, 0.6407);
    let count = POINTS as f64;
    std::array::from_fn(|k| {
        let theta = PI * (2 * k + 1) as f64 / count;
        let (sin, cos) = (alpha * theta).sin_cos();
        let point = Complex::new(-sigma + mu * theta * cos / sin, nu * theta) * count;
        let slope = mu * cos / sin - mu * alpha * theta / (sin * sin);
        let slope = Complex::new(slope, nu) * count;
        (point, point.exp() * slope / point * (2.0 / count))
    })
});

/// The probability that the length of an error with these principal variances exceeds `length` > 0, both in one unit.
#[must_use]
pub fn exceedance<const D: usize>(variances: &[f64; D], length: f64) -> f64 {
    let scale = 2.0 / (length * length);
    let term = |(point, weight): &(Complex<f64>, Complex<f64>)| {
        let mut roots = Complex::from(1.0);
        for variance in variances {
            // Each root apart: on the contour no factor crosses the cut of the root, but their product does.
            let share = variance * scale;
            roots *= root_above(1.0 + point.re * share, point.im * share);
        }
        (weight.im * roots.re - weight.re * roots.im) / roots.norm_sqr()
    };
    let within: f64 = CONTOUR.iter().map(term).sum();
    (1.0 - within).clamp(0.0, 1.0)
}

/// The principal square root of a number in the upper half plane that is neither so large nor so small that its square is
/// lost, without a trigonometric function.
fn root_above(re: f64, im: f64) -> Complex<f64> {
    let long = (0.5 * ((re * re + im * im).sqrt() + re.abs())).sqrt();
    let short = 0.5 * im / long;
    if re >= 0.0 {
        Complex::new(long, short)
    } else {
        Complex::new(short, long)
    }
}

/// Errors that are summed in one piece, so that the sum does not depend on the number of threads.
const PIECE: usize = 4096;

/// Relative error of a length at which the search ends.
const TOLERANCE: f64 = 1e-9;

/// The length that an error exceeds with probability `share`, 0 < share < 1, in the mean over a mixture of errors, each
/// with its weight and its principal variances; `None` if there are none, or all are 0.
#[must_use]
pub fn length_exceeded_by<const D: usize>(share: f64, errors: &[(f64, [f64; D])]) -> Option<f64> {
    let total: f64 = errors.iter().map(|(weight, _)| weight).sum();
    let sum = |of: &[(f64, [f64; D])], term: &dyn Fn(&[f64; D]) -> f64| -> f64 {
        of.iter().map(|(weight, one)| weight * term(one)).sum()
    };
    let mean_square = sum(errors, &|one| one.iter().sum()) / total;
    if mean_square.is_nan() || mean_square <= 0.0 {
        return None;
    }
    let excess = |logarithm: f64| {
        let length = logarithm.exp();
        let pieces = errors.par_chunks(PIECE);
        let parts: Vec<f64> = pieces
            .map(|piece| sum(piece, &|one| exceedance(one, length)))
            .collect();
        parts.iter().sum::<f64>() / total - share
    };
    let start = 0.5 * (mean_square / share).ln();
    // By Chebyshev's inequality the mean exceedance of the start is at most `share`.
    Some(root_below(excess, start)?.exp())
}

/// The root below `high` of a falling function that is at most 0 there, by the Illinois method: regula falsi that
/// halves the value of an end that stays a second time.
fn root_below(value: impl Fn(f64) -> f64, high: f64) -> Option<f64> {
    const STEPS: usize = 100;
    let (mut high, mut at_high) = (high, value(high));
    let mut low = high - 0.5;
    let mut at_low = value(low);
    let mut steps = 0;
    while at_low < 0.0 {
        (high, at_high) = (low, at_low);
        low -= 1.0;
        at_low = value(low);
        steps += 1;
        if steps > STEPS {
            return None;
        }
    }
    let mut last = high;
    let mut stayed = 0.0;
    for _ in 0..STEPS {
        let between = (low * at_high - high * at_low) / (at_high - at_low);
        if !between.is_finite() || (between - last).abs() <= TOLERANCE {
            break;
        }
        last = between;
        let found = value(between);
        if found > 0.0 {
            (low, at_low) = (between, found);
            at_high *= if stayed > 0.0 { 0.5 } else { 1.0 };
        } else {
            (high, at_high) = (between, found);
            at_low *= if stayed < 0.0 { 0.5 } else { 1.0 };
        }
        stayed = found;
    }
    Some(last)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Table 1 of Imhof, *Biometrika* 48 (1961) 419: P(0.6 χ₁² + 0.3 χ₁² + 0.1 χ₁² > x), four digits.
    #[test]
    fn validate_the_table_of_imhof() {
        for (x, printed) in [(0.1_f64, 0.9458), (0.7, 0.5064), (2.0, 0.1240)] {
            let found = exceedance(&[0.6, 0.3, 0.1], x.sqrt());
            assert!((found - printed).abs() <= 0.5e-4, "{x}: {found}");
        }
    }

    /// The 95 % quantiles of the normal, Rayleigh and Maxwell distributions, of tables.
    #[test]
    fn validate_quantiles_of_equal_variances() {
        let one = length_exceeded_by(0.05, &[(1.0, [4.0])]).unwrap();
        let two = length_exceeded_by(0.05, &[(1.0, [4.0; 2])]).unwrap();
        let three = length_exceeded_by(0.05, &[(1.0, [4.0; 3])]).unwrap();
        let rayleigh = (-2.0 * 0.05_f64.ln()).sqrt();
        for (found, expected) in [
            (one, 1.959_963_984_540),
            (two, rayleigh),
            (three, 2.795_483_482_915),
        ] {
            // 1e-10 of probability is 1e-9 of length there.
            assert!((found / (2.0 * expected) - 1.0).abs() < 3e-9, "{found}");
        }
    }

    /// A mixture of 1 and 100: an equation in one unknown, solved by bisection of the closed form.
    #[test]
    fn validate_a_mixture_in_two_dimensions() {
        let errors = [(3.0, [1.0, 1.0]), (1.0, [100.0, 100.0])];
        let found = length_exceeded_by(0.05, &errors).unwrap();
        let share = |x: f64| 0.75 * (-x * x / 2.0).exp() + 0.25 * (-x * x / 200.0).exp();
        assert!((share(found) - 0.05).abs() < 1e-9, "{found}");
        // It is no mean of both quantiles.
        assert!((found - 17.941).abs() < 0.001, "{found}");
    }

    #[test]
    fn errors_of_nothing_have_no_quantile() {
        assert_eq!(length_exceeded_by::<3>(0.05, &[]), None);
        assert_eq!(length_exceeded_by(0.05, &[(1.0, [0.0])]), None);
    }

    proptest! {
        /// In two dimensions, in polar coordinates: the mean over φ of exp(-x²/(2 (λ cos² φ + μ sin² φ))), whose
        /// midpoint rule converges geometrically.
        #[test]
        fn validate_two_dimensions_by_quadrature(ratio in 0.05..1.0_f64, length in 0.05..5.0_f64) {
            let points = 400;
            let term = |k: usize| {
                let (sin, cos) = (PI * (k as f64 + 0.5) / f64::from(points)).sin_cos();
                (-length * length / (2.0 * (cos * cos + ratio * sin * sin))).exp()
            };
            let expected = (0..points as usize).map(term).sum::<f64>() / f64::from(points);
            let found = exceedance(&[1.0, ratio], length);
            prop_assert!((found - expected).abs() < 1e-10, "{found} {expected}");
        }

        /// A variance of 0 drops a dimension; a scale of the error is one of the length.
        #[test]
        fn dimensions_and_scales_agree(ratio in 0.0..1.0_f64, length in 0.05..5.0_f64, scale in 1e-3..1e3_f64) {
            let plane = exceedance(&[1.0, ratio], length);
            prop_assert!((exceedance(&[0.0, 1.0, ratio], length) - plane).abs() < 1e-12);
            let scaled = exceedance(&[scale * scale, ratio * scale * scale], length * scale);
            prop_assert!((scaled - plane).abs() < 1e-11);
        }
    }
}
