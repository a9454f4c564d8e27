//! The triangular factor of the position normal matrix, from which every dilution of precision is
//! computed.

use super::Symmetric3;
use nalgebra::Vector3;

/// Rounding error of a pivot that should be zero, as a multiple of the total weight of the
/// observations: sixteen units of 2⁻⁵³ ([M-26](crate::models#m-26)).
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// δ: a pivot up to this is indistinguishable from rounding. `weight` is the sum of the weights of all satellites used.
#[inline(always)]
pub(crate) fn pivot_floor(weight: f64) -> f64 {
    ROUNDING * weight
}

/// The factors L D Lᵀ of a symmetric 3x3 matrix; each pivot is the largest element left on the diagonal.
///
/// Branch-free, so that the evaluator can compute it in SIMD lanes. A matrix that is singular or not
/// positive definite yields pivots that are zero, negative or NaN.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Factor {
    /// The axes in the order in which they were eliminated.
    axes: [usize; 3],
    pivots: [f64; 3],
    /// Elements (1, 0), (2, 0) and (2, 1) of L.
    lower: [f64; 3],
}

#[inline(always)]
fn swap_if<T: Copy>(swap: bool, (a, b): (T, T)) -> (T, T) {
    (if swap { b } else { a }, if swap { a } else { b })
}

impl Factor {
    #[inline(always)]
    pub(crate) fn new(matrix: &Symmetric3) -> Self {
        let Symmetric3 {
            xx,
            yy,
            zz,
            xy,
            xz,
            yz,
        } = *matrix;
        // The largest of the three becomes the first pivot.
        let swap = yy > xx;
        let (first, second) = swap_if(swap, (xx, yy));
        let (first_third, second_third) = swap_if(swap, (xz, yz));
        let (axis_0, axis_1) = swap_if(swap, (0, 1));
        let swap = zz > first;
        let (first, third) = swap_if(swap, (first, zz));
        let (first_second, second_third) = swap_if(swap, (xy, second_third));
        let (axis_0, axis_2) = swap_if(swap, (axis_0, 2));

        let (lower_1, lower_2) = (first_second / first, first_third / first);
        let second = second - lower_1 * first_second;
        let third = third - lower_2 * first_third;
        let rest = second_third - lower_1 * first_third;

        let swap = third > second;
        let (second, third) = swap_if(swap, (second, third));
        let (lower_1, lower_2) = swap_if(swap, (lower_1, lower_2));
        let (axis_1, axis_2) = swap_if(swap, (axis_1, axis_2));
        let lower_21 = rest / second;
        Self {
            axes: [axis_0, axis_1, axis_2],
            pivots: [first, second, third - lower_21 * rest],
            lower: [lower_1, lower_2, lower_21],
        }
    }

    /// Whether every pivot is above a bound; false if one is NaN.
    #[inline(always)]
    pub(crate) fn exceeds(&self, floor: f64) -> bool {
        let [first, second, third] = self.pivots;
        (first > floor) & (second > floor) & (third > floor)
    }

    /// The trace of the inverse, a sum whose terms are all non-negative if the pivots are positive.
    #[inline(always)]
    pub(crate) fn trace_of_inverse(&self) -> f64 {
        let [first, second, third] = self.pivots;
        let [lower_1, lower_2, lower_21] = self.lower;
        let corner = lower_1 * lower_21 - lower_2;
        1.0 / first
            + (1.0 + lower_1 * lower_1) / second
            + (1.0 + lower_21 * lower_21 + corner * corner) / third
    }

    /// A⁻¹ v.
    pub(crate) fn solve(&self, v: Vector3<f64>) -> Vector3<f64> {
        let [lower_1, lower_2, lower_21] = self.lower;
        let [first, second, third] = self.axes.map(|axis| v[axis]);
        let second = second - lower_1 * first;
        let third = third - lower_2 * first - lower_21 * second;
        let third = third / self.pivots[2];
        let second = second / self.pivots[1] - lower_21 * third;
        let first = first / self.pivots[0] - lower_1 * second - lower_2 * third;
        let mut solution = Vector3::zeros();
        for (axis, value) in self.axes.into_iter().zip([first, second, third]) {
            solution[axis] = value;
        }
        solution
    }

    /// vᵀ A⁻¹ v as Σ y²/d with L y = v; all terms are non-negative if the pivots are positive.
    pub(crate) fn inverse_form(&self, v: Vector3<f64>) -> f64 {
        let [lower_1, lower_2, lower_21] = self.lower;
        let [first, second, third] = self.axes.map(|axis| v[axis]);
        let second = second - lower_1 * first;
        let third = third - lower_2 * first - lower_21 * second;
        first * first / self.pivots[0]
            + second * second / self.pivots[1]
            + third * third / self.pivots[2]
    }
}
