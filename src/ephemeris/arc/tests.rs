use super::*;
use crate::constellation::Design;
use crate::ephemeris::Ephemeris;
use crate::orbit::Model;
use crate::time::TimeGrid;

fn start() -> Epoch {
    Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap())
}

/// A satellite of 925 km sampled in TEME from the epoch on.
fn arc(interpolation: Interpolation, step_s: f64, count: usize) -> Arc {
    let nodes = (0..count)
        .map(|k| k as f64 * step_s)
        .map(|t| (start().plus_seconds(t), truth(t)));
    Arc::new(Frame::Teme, interpolation, nodes.collect()).unwrap()
}

fn truth(t: f64) -> State<Frame> {
    let design: Design = "delta:55:1/1/0@925".parse().unwrap();
    let grid = TimeGrid::new(start(), 60.0, 60.0).unwrap();
    let ephemeris = Ephemeris::of_design(&design, Model::J2, grid).unwrap();
    let state = ephemeris.state(&ephemeris.satellites()[0], t).unwrap();
    State::new(state.position_km.km(), state.velocity_km_s)
}

/// Polynomials of the named degree come back, with their derivative, and of a higher one do not.
#[test]
fn validate_degrees_are_those_of_the_file() {
    let polynomial = |degree: i32, t: f64| {
        let x = t / 60.0;
        let slope = f64::from(degree) * x.powi(degree - 1) / 60.0;
        State::new(
            Vector3::new(x.powi(degree), 1.0, 0.0),
            Vector3::new(slope, 0.0, 0.0),
        )
    };
    for (interpolation, degree) in [
        (Interpolation::Lagrange(1), 1),
        (Interpolation::Lagrange(5), 5),
        (Interpolation::Hermite(3), 3),
        (Interpolation::Hermite(7), 7),
    ] {
        let off = |power: i32| {
            let node = |k: i32| 60.0 * f64::from(k - 6);
            let nodes =
                (0..12).map(|k| (start().plus_seconds(node(k)), polynomial(power, node(k))));
            let arc = Arc::new(Frame::Teme, interpolation, nodes.collect()).unwrap();
            let (state, interpolated) = arc.state(start().plus_seconds(17.0)).unwrap();
            assert!(interpolated);
            let expected = polynomial(power, 17.0);
            let apart = (state.position_km - expected.position_km).norm();
            apart.max((state.velocity_km_s - expected.velocity_km_s).norm())
        };
        // Rounding of sums of terms up to 4^7.
        assert!(off(degree) < 1e-10, "{interpolation:?}: {}", off(degree));
        assert!(off(degree + 2) > 1e-4, "{interpolation:?}");
    }
}

#[test]
fn nothing_is_extrapolated() {
    let whole = arc(Interpolation::OF_STATES, 60.0, 11);
    let at = |t: f64| start().plus_seconds(t);
    assert!(whole.state(at(-1.0)).is_none() && whole.state(at(601.0)).is_none());
    assert_eq!(
        whole.state(at(0.0)).map(|(_, interpolated)| interpolated),
        Some(false)
    );
    // Within the nanosecond of the instants and the microsecond that counts as the same.
    assert!(
        whole
            .state(at(600.000_000_5))
            .is_some_and(|(_, interpolated)| !interpolated)
    );
    let part = whole.clone().within((at(90.0), at(330.0))).unwrap();
    assert!(part.state(at(80.0)).is_none() && part.state(at(340.0)).is_none());
    assert_eq!(part.samples().count(), 4);
    // The samples beyond the span still carry its interpolation.
    let (edge, _) = part.state(at(91.0)).unwrap();
    assert_eq!(whole.state(at(91.0)).unwrap().0, edge);
    assert!(whole.within((at(700.0), at(800.0))).is_none());
}

/// The estimate is the error at twice the spacing: above the true one by two to the power of the order.
#[test]
fn the_estimate_is_above_the_true_error() {
    for (interpolation, step_s) in [
        (Interpolation::Lagrange(3), 120.0),
        (Interpolation::Hermite(3), 240.0),
    ] {
        let arc = arc(interpolation, step_s, 41);
        let estimate_km = arc.left_out_error_km().unwrap();
        let true_km = (10..30)
            .map(|k| (f64::from(k) + 0.5) * step_s)
            .map(|t| {
                (arc.state(start().plus_seconds(t)).unwrap().0.position_km - truth(t).position_km)
                    .norm()
            })
            .fold(0.0, f64::max);
        let times = estimate_km / true_km;
        let told = f64::from(2_u32.pow(interpolation.order()));
        // The ends have their nodes on one side: up to several times the error of the middle.
        assert!(
            times > 0.8 * told && times < 12.0 * told,
            "{interpolation:?}: {times} {told}"
        );
    }
    assert_eq!(
        arc(Interpolation::Lagrange(10), 60.0, 12).left_out_error_km(),
        None
    );
}

/// A run between gaps that is too short for the usual polynomial has states only at its samples.
#[test]
fn short_runs_are_not_interpolated() {
    for (count, expected) in [(10, None), (11, Some(true))] {
        let mut run = arc(Interpolation::Lagrange(10), 60.0, count);
        run.is_open = true;
        let at = start().plus_seconds(30.0);
        assert_eq!(
            run.state(at).map(|(_, interpolated)| interpolated),
            expected
        );
        assert_eq!(run.is_interpolated(at), expected);
        assert_eq!(run.is_interpolated(start()), Some(false));
    }
}
