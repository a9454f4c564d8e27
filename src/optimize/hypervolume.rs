//! The volume that a set of points dominates up to a reference point.

use super::sorting::dominates;

/// The exact hypervolume of `points` (smaller is better) at `reference`: the
/// volume of the union of the boxes between each point and the reference.
///
/// A point that is not better than the reference in every objective dominates
/// no volume and contributes nothing; neither does one of another dimension.
///
/// One and two objectives take a sort and a sweep, O(N log N). Each further one
/// sums what every point adds to those with a better last objective, a volume of
/// one dimension less: O(N² log N) for three objectives, and exponential in their
/// number. Source: the exclusive volumes and the slicing of L. While, L. Bradstreet,
/// L. Barone, "A fast way of calculating exact hypervolumes", IEEE Transactions on
/// Evolutionary Computation 16(1), 2012.
#[must_use]
pub fn hypervolume<P: AsRef<[f64]>>(points: &[P], reference: &[f64]) -> f64 {
    let inside = |point: &&[f64]| {
        point.len() == reference.len() && point.iter().zip(reference).all(|(p, r)| p < r)
    };
    let points: Vec<Vec<f64>> = points
        .iter()
        .map(AsRef::as_ref)
        .filter(inside)
        .map(<[f64]>::to_vec)
        .collect();
    volume(points, reference)
}

/// The hypervolume of points inside the reference, which it sorts by descending
/// last objective.
fn volume(mut points: Vec<Vec<f64>>, reference: &[f64]) -> f64 {
    points.sort_by(|a, b| {
        let last_first = b.iter().rev().zip(a.iter().rev());
        last_first
            .map(|(b, a)| b.total_cmp(a))
            .find(|order| order.is_ne())
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    match *reference {
        [] => 0.0,
        [reference] => points.last().map_or(0.0, |best| reference - best[0]),
        [x, y] => sweep(&points, x, y),
        _ => (0..points.len())
            .map(|i| exclusive(&points[i], &points[i + 1..], reference))
            .sum(),
    }
}

/// Two objectives, points by descending second objective: from the best second
/// objective upwards, each strip up to the next point is as wide as the widest
/// box so far.
fn sweep(points: &[Vec<f64>], x: f64, y: f64) -> f64 {
    let mut area = 0.0;
    let mut width = 0.0_f64;
    let mut rows = points.iter().rev().peekable();
    while let Some(row) = rows.next() {
        width = width.max(x - row[0]);
        let top = rows.peek().map_or(y, |next| next[1]);
        area += width * (top - row[1]);
    }
    area
}

/// The volume that `point` dominates and none of `better` does, whose last
/// objectives are no greater: its height in the last objective times the part of
/// its base that the others, limited to that base, leave free.
fn exclusive(point: &[f64], better: &[Vec<f64>], reference: &[f64]) -> f64 {
    let last = reference.len() - 1;
    let base: f64 = point[..last]
        .iter()
        .zip(reference)
        .map(|(p, r)| r - p)
        .product();
    let limit = |other: &Vec<f64>| {
        let sides = other[..last].iter().zip(point);
        sides.map(|(o, p)| o.max(*p)).collect()
    };
    let limited = non_dominated(better.iter().map(limit).collect());
    (reference[last] - point[last]) * (base - volume(limited, &reference[..last]))
}

/// The points that no other one dominates, one of each group of equal ones. Only
/// for speed, and in one or two objectives the sweep is faster.
fn non_dominated(points: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    if points.first().is_none_or(|point| point.len() <= 2) {
        return points;
    }
    let mut kept: Vec<Vec<f64>> = Vec::new();
    for point in points {
        if kept.iter().any(|k| *k == point || dominates(k, &point)) {
            continue;
        }
        kept.retain(|k| !dominates(&point, k));
        kept.push(point);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn validate_closed_forms() {
        let empty: [[f64; 2]; 0] = [];
        assert_eq!(hypervolume(&empty, &[1.0, 1.0]), 0.0);
        assert_eq!(hypervolume(&[[0.25], [0.5]], &[1.0]), 0.75);
        assert_eq!(hypervolume(&[[0.5, 0.25]], &[1.0, 1.0]), 0.375);
        // A staircase of n steps under the diagonal covers (n + 1)/(2 n) of the square.
        let n = 8;
        let stairs: Vec<[f64; 2]> = (0..n)
            .map(|k| [f64::from(k) / 8.0, f64::from(n - 1 - k) / 8.0])
            .collect();
        assert_eq!(hypervolume(&stairs, &[1.0, 1.0]), 9.0 / 16.0);
        // Three boxes of volume 1/4 whose pairs and triple all meet in a cube of 1/8.
        let slabs = [[0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]];
        assert_eq!(
            hypervolume(&slabs, &[1.0; 3]),
            3.0 / 4.0 - 3.0 / 8.0 + 1.0 / 8.0
        );
        assert_eq!(hypervolume(&[[0.5; 5]], &[1.0; 5]), 1.0 / 32.0);
    }

    #[test]
    fn points_beyond_the_reference_contribute_nothing() {
        let inside = [0.5, 0.5];
        let reference = [1.0, 1.0];
        for beyond in [
            [0.0, 1.0],
            [0.0, 2.0],
            [f64::INFINITY, 0.0],
            [f64::NAN, 0.0],
        ] {
            assert_eq!(
                hypervolume(&[inside, beyond], &reference),
                0.25,
                "{beyond:?}"
            );
        }
        assert_eq!(hypervolume(&[vec![0.5], inside.to_vec()], &reference), 0.25);
    }

    /// The union's volume by inclusion and exclusion over every subset.
    fn inclusion_exclusion(points: &[Vec<f64>], reference: &[f64]) -> f64 {
        let subsets = 1_u32..1 << points.len();
        let signed = |subset: u32| {
            let members = || (0..points.len()).filter(|i| subset >> i & 1 == 1);
            let corner = |m: usize| members().map(|i| points[i][m]).fold(0.0, f64::max);
            let sides = (0..reference.len()).map(|m| (reference[m] - corner(m)).max(0.0));
            let sign = if subset.count_ones() % 2 == 1 {
                1.0
            } else {
                -1.0
            };
            sign * sides.product::<f64>()
        };
        subsets.map(signed).sum()
    }

    fn sets(objectives: usize) -> impl Strategy<Value = Vec<Vec<f64>>> {
        let coordinate = prop_oneof![0.0..1.2_f64, (0_u8..6).prop_map(|k| f64::from(k) / 5.0)];
        prop::collection::vec(prop::collection::vec(coordinate, objectives), 0..9)
    }

    proptest! {
        // At most 2^8 terms of at most 1 each: rounding stays below 256 * 2^-52 = 6e-14.
        #[test]
        fn equals_inclusion_exclusion(
            set in (1_usize..5).prop_flat_map(sets)
        ) {
            let reference = vec![1.0; set.first().map_or(2, Vec::len)];
            let expected = inclusion_exclusion(&set, &reference);
            prop_assert!((hypervolume(&set, &reference) - expected).abs() < 1e-13);
        }

        #[test]
        fn never_falls_when_a_point_joins(set in sets(3), point in prop::collection::vec(0.0..1.2_f64, 3)) {
            let reference = [1.0; 3];
            let before = hypervolume(&set, &reference);
            let mut more = set;
            more.push(point);
            // Rounding of sums of volumes below 1.
            prop_assert!(hypervolume(&more, &reference) >= before - 1e-14);
        }
    }
}
