use super::*;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

fn geometry(groups: &[Vec<Vector3<f64>>]) -> Geometry {
    let mut geometry = Geometry::default();
    for group in groups {
        let mut clock = ClockGroup::default();
        group.iter().for_each(|v| clock.add(*v, 1.0));
        geometry.add(&clock);
    }
    geometry
}

/// PDOP by the definition, equation (7) of the paper: the geometry matrix with a column of ones
/// per clock, inverted in full.
fn pdop_by_inversion(groups: &[Vec<Vector3<f64>>]) -> Option<f64> {
    let in_view: Vec<_> = groups.iter().filter(|group| !group.is_empty()).collect();
    let rows: usize = in_view.iter().map(|group| group.len()).sum();
    let mut g = DMatrix::zeros(rows, 3 + in_view.len());
    let lines = in_view
        .iter()
        .enumerate()
        .flat_map(|(c, group)| group.iter().map(move |v| (c, v)));
    for (row, (clock, v)) in lines.enumerate() {
        g.fixed_view_mut::<1, 3>(row, 0).copy_from(&v.transpose());
        g[(row, 3 + clock)] = 1.0;
    }
    let inverse = (g.transpose() * &g).try_inverse()?;
    let diagonal: DVector<f64> = inverse.diagonal();
    Some((diagonal[0] + diagonal[1] + diagonal[2]).sqrt())
}

fn direction(elevation_deg: f64, azimuth_deg: f64) -> Vector3<f64> {
    let (sin_e, cos_e) = elevation_deg.to_radians().sin_cos();
    let (sin_a, cos_a) = azimuth_deg.to_radians().sin_cos();
    Vector3::new(cos_e * sin_a, cos_e * cos_a, sin_e)
}

/// One satellite at the zenith and three at elevation ε, 120° apart. By symmetry
/// A = diag(3/2 cos² ε, 3/2 cos² ε, 3/4 (1 - sin ε)²), so
/// PDOP² = 4 / (3 cos² ε) + 4 / (3 (1 - sin ε)²).
#[test]
fn validate_pdop_of_a_symmetric_geometry() {
    for elevation_deg in [0.0_f64, 5.0, 30.0] {
        let mut group = vec![direction(90.0, 0.0)];
        group.extend([0.0, 120.0, 240.0].map(|azimuth| direction(elevation_deg, azimuth)));
        let (s, c) = elevation_deg.to_radians().sin_cos();
        let expected = (4.0 / (3.0 * c * c) + 4.0 / (3.0 * (1.0 - s) * (1.0 - s))).sqrt();
        let pdop = geometry(&[group]).pdop(100.0).unwrap();
        assert!(
            (pdop / expected - 1.0).abs() < 1e-13,
            "{elevation_deg}: {pdop} {expected}"
        );
    }
}

/// Five satellites, four of them at 15° elevation to the north, east, south and west and one at the
/// zenith; the closed form follows from the same symmetry as above.
#[test]
fn validate_pdop_of_a_cross() {
    let (s, c) = 15_f64.to_radians().sin_cos();
    let mut group = vec![direction(90.0, 0.0)];
    group.extend([0.0, 90.0, 180.0, 270.0].map(|azimuth| direction(15.0, azimuth)));
    // Σ v vᵀ = diag(2c², 2c², 1 + 4s²), Σ v = (0, 0, 1 + 4s), n = 5
    let vertical = 1.0 + 4.0 * s * s - (1.0 + 4.0 * s).powi(2) / 5.0;
    let expected = (1.0 / (c * c) + 1.0 / vertical).sqrt();
    assert!((geometry(&[group]).pdop(100.0).unwrap() / expected - 1.0).abs() < 1e-13);
}

#[test]
fn unsolved_is_a_value_of_its_own() {
    let four =
        [(10.0, 0.0), (40.0, 100.0), (70.0, 200.0), (20.0, 290.0)].map(|(e, a)| direction(e, a));
    let (first, rest) = four.split_at(1);
    assert!(geometry(&[four.to_vec()]).pdop(100.0).is_some());
    // Two clocks make five states.
    assert_eq!(geometry(&[first.to_vec(), rest.to_vec()]).pdop(100.0), None);
    assert_eq!(geometry(&[]).pdop(100.0), None);
    // Four satellites in one direction determine no position.
    assert_eq!(geometry(&[vec![four[0]; 4]]).pdop(100.0), None);
    let pdop = geometry(&[four.to_vec()]).pdop(f64::INFINITY).unwrap();
    assert_eq!(geometry(&[four.to_vec()]).pdop(pdop * 0.999), None);
}

/// A geometry with this diagonal normal matrix, as of eight satellites in opposite pairs along the
/// axes, so that Σ w v vanishes.
fn diagonal(elements: [f64; 3], weight: f64) -> Geometry {
    let [xx, yy, zz] = elements;
    Geometry {
        normal: Symmetric3 {
            xx,
            yy,
            zz,
            ..Symmetric3::default()
        },
        weight,
        satellites: 8,
        clocks: 1,
    }
}

/// A pivot has to exceed δ = 16 · 2⁻⁵³ W, wherever on the diagonal it is.
#[test]
fn a_pivot_at_the_floor_is_rounding() {
    let floor = 16.0 * 8.0 / 2_f64.powi(53);
    for axis in 0..3 {
        let mut elements = [3.0, 2.0, 4.0];
        for (pivot, solved) in [
            (floor, false),
            (floor.next_up(), true),
            (0.0, false),
            (-1.0, false),
            (f64::NAN, false),
        ] {
            elements[axis] = pivot;
            let pdop = diagonal(elements, 8.0).pdop(f64::INFINITY);
            assert_eq!(pdop.is_some(), solved, "{axis} {pivot:e}");
        }
        // The floor grows with the total weight.
        elements[axis] = floor.next_up();
        assert_eq!(diagonal(elements, 8.001).pdop(f64::INFINITY), None);
    }
}

/// Three satellites more than there are clock states are enough for a position.
#[test]
fn as_many_satellites_as_states_are_enough() {
    let sky = [
        (10.0, 0.0),
        (40.0, 100.0),
        (70.0, 200.0),
        (20.0, 290.0),
        (33.0, 40.0),
    ]
    .map(|(e, a)| direction(e, a));
    assert!(geometry(&[sky[..4].to_vec()]).pdop(100.0).is_some());
    assert_eq!(geometry(&[sky[..3].to_vec()]).pdop(100.0), None);
    assert!(
        geometry(&[sky[..3].to_vec(), sky[3..].to_vec()])
            .pdop(1e6)
            .is_some()
    );
    assert_eq!(
        geometry(&[sky[..3].to_vec(), sky[3..4].to_vec()]).pdop(1e6),
        None
    );
}

/// The factor of a positive definite matrix yields its inverse, whatever the order of the pivots.
#[test]
fn factors_follow_the_largest_pivot() {
    let matrix = nalgebra::Matrix3::new(2.0, 0.5, -0.3, 0.5, 3.0, 0.7, -0.3, 0.7, 5.0);
    let inverse = matrix.try_inverse().unwrap();
    for axes in [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 1, 0],
    ] {
        let at = |i: usize, j: usize| matrix[(axes[i], axes[j])];
        let factor = Factor::new(&Symmetric3 {
            xx: at(0, 0),
            yy: at(1, 1),
            zz: at(2, 2),
            xy: at(0, 1),
            xz: at(0, 2),
            yz: at(1, 2),
        });
        assert!((factor.trace_of_inverse() - inverse.trace()).abs() < 1e-15);
        assert!(factor.exceeds(1.0) && !factor.exceeds(2.0));
        let v = Vector3::new(0.3, -1.2, 0.8);
        let permuted = Vector3::from_fn(|i, _| v[axes[i]]);
        let form = (v.transpose() * inverse * v)[0];
        assert!((factor.inverse_form(permuted) - form).abs() < 1e-15);
        // Numbers below 1, of a matrix with a condition of 3.
        let solution = inverse * v;
        let apart = factor.solve(permuted) - Vector3::from_fn(|i, _| solution[axes[i]]);
        assert!(apart.amax() < 1e-15, "{apart}");
    }
}

/// The sum of two geometries is the geometry of all groups: three satellites and one with a clock of its own are
/// too few for five unknowns, and two with that clock are enough.
#[test]
fn geometries_add_with_their_clocks() {
    let own = [5.0, 20.0, 40.0, 80.0]
        .map(|e| direction(e, 13.0 * e))
        .to_vec();
    let other = [30.0, 60.0].map(|e| direction(e, 7.0 * e)).to_vec();
    for count in [1, 2] {
        let other = other[..count].to_vec();
        let mut sum = geometry(std::slice::from_ref(&own[..3].to_vec()));
        assert!(sum.lacks_satellites());
        sum += &geometry(std::slice::from_ref(&other));
        let whole = geometry(&[own[..3].to_vec(), other.clone()]);
        assert_eq!(sum.lacks_satellites(), count == 1, "{count}");
        assert_eq!(whole.lacks_satellites(), count == 1);
        // The sums are rounded in another order: some units in the last place, times the condition.
        let ratio = sum.pdop(1e6).zip(whole.pdop(1e6)).map(|(a, b)| a / b);
        assert!(
            ratio.is_none_or(|ratio| (ratio - 1.0).abs() < 1e-13),
            "{ratio:?}"
        );
        assert_eq!(ratio.is_some(), count == 2);
    }
    assert!(!geometry(std::slice::from_ref(&own)).lacks_satellites());
}

fn sky(n: std::ops::Range<usize>) -> impl Strategy<Value = Vec<Vector3<f64>>> {
    prop::collection::vec(
        (5.0..89.0_f64, 0.0..360.0_f64).prop_map(|(e, a)| direction(e, a)),
        n,
    )
}

proptest! {
    #[test]
    fn validate_schur_complement_against_inversion(a in sky(4..12), b in sky(0..8), c in sky(0..3)) {
        let groups = [a, b, c];
        let ours = geometry(&groups).pdop(20.0);
        // Beyond PDOP 20 the inversion itself loses the digits that are compared.
        if let (Some(ours), Some(theirs)) = (ours, pdop_by_inversion(&groups)) {
            prop_assert!((ours / theirs - 1.0).abs() < 1e-9, "{ours} {theirs}");
        }
    }

    /// Teng and Wang (2015): the clock of a single satellite of a new system absorbs its measurement.
    #[test]
    fn validate_a_lone_satellite_with_its_own_clock_changes_nothing(a in sky(5..12), b in sky(1..2)) {
        let without = geometry(std::slice::from_ref(&a)).pdop(100.0);
        let with = geometry(&[a, b]).pdop(100.0);
        prop_assert_eq!(without.is_some(), with.is_some());
        if let (Some(x), Some(y)) = (without, with) {
            prop_assert!((x / y - 1.0).abs() < 1e-10);
        }
    }

    #[test]
    fn a_further_satellite_of_a_system_in_view_never_hurts(a in sky(5..12), v in sky(1..2)) {
        let before = geometry(std::slice::from_ref(&a)).pdop(1e6);
        let mut more = a;
        more.extend(v);
        if let (Some(before), Some(after)) = (before, geometry(&[more]).pdop(1e6)) {
            prop_assert!(after <= before * (1.0 + 1e-9));
        }
    }
}
