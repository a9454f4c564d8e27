use super::*;
use crate::orbit::j2::SecularOrbit;
use nalgebra::Vector3;

fn design(text: &str) -> Design {
    text.parse().unwrap()
}

/// Positions of all satellites of a design under secular J2.
fn positions(design: &Design, elapsed_s: f64) -> Vec<Vector3<f64>> {
    let satellites = design.satellites().into_iter();
    let place =
        |elements: &MeanElements| SecularOrbit::j2(elements).state(elapsed_s).position_km.km();
    satellites.map(|one| place(&one.elements)).collect()
}

/// 182/13 at 55° and 925 km by phasing, computed elsewhere by the distances of all pairs over a revolution; to the
/// digits given.
#[test]
fn validate_the_least_separation_by_phasing() {
    let expected = [
        134.20, 460.94, 12.54, 31.08, 50.05, 33.68, 155.13, 187.27, 161.63, 298.97, 403.43, 14.02,
        25.18,
    ];
    for (phasing, expected) in expected.into_iter().enumerate() {
        let ours = least_separation_km(&design(&format!("delta:55:182/13/{phasing}@925"))).unwrap();
        assert!((ours - expected).abs() <= 0.005, "F = {phasing}: {ours}");
    }
}

/// The closed form against the distances of all pairs at steps of 2 s over an orbit: a chord changes by less
/// than 2 · 7.6 km/s · 1 s between steps. Two shells of one orbit are as one.
#[test]
fn validate_the_least_separation_by_brute_force() {
    for text in [
        "delta:55:24/6/1@925",
        "star:90:24/6/0@925",
        "star:86.4:66/6/2@780",
        "lattice:63.4:30/6/5@950",
        "delta:53:20/5/2@1000,raan=20,u=10,node-step=31.6",
        "delta:0:12/4/1@800",
        "delta:120:21/7/3@600",
        "delta:55:24/6/1@925+delta:55:21/7/3@925,raan=13,u=5",
    ] {
        let design = design(text);
        let expected = least_separation_km(&design).unwrap();
        let mut least = f64::INFINITY;
        for n in 0..3200 {
            let places = positions(&design, 2.0 * f64::from(n));
            for (n, one) in places.iter().enumerate() {
                for other in &places[n + 1..] {
                    least = least.min((one - other).norm());
                }
            }
        }
        let over = least - expected;
        assert!((-1e-6..15.2).contains(&over), "{text}: {least} {expected}");
    }
}

/// The pair that is named is that far apart when it says.
#[test]
fn the_closest_pair_is_named() {
    for text in [
        "delta:55:182/13/2@925",
        "star:86.4:66/6/3@780,node-step=31.6",
        "delta:55:24/6/1@925+delta:55:21/7/3@925,raan=13,u=5",
    ] {
        let design = design(text);
        let separations = ShellSeparation::all_of(&design);
        let last = separations.last().unwrap();
        let pair = last.pair.unwrap();
        let places = positions(&design, pair.first_s.unwrap());
        let slots: Vec<Slot> = design.slots().collect();
        let [one, other] = pair
            .slots
            .map(|slot| places[slots.iter().position(|one| *one == slot).unwrap()]);
        assert!(
            ((one - other).norm() - last.least_km).abs() < 1e-6,
            "{text}"
        );
    }
}

/// Shells of other rates come as close as their altitudes.
#[test]
fn other_rates_leave_the_difference_in_altitude() {
    let separations = ShellSeparation::all_of(&design(
        "delta:53:160/10/1@1000+star:90:40/5/1@1100+delta:53:4/2/1@1000,e=0.001",
    ));
    let between = |one, other| {
        let found = separations.iter().find(|of| of.shells == [one, other]);
        found.unwrap()
    };
    assert!((between(0, 1).least_km - 100.0).abs() < 1e-9);
    assert_eq!(between(0, 1).pair, None);
    assert_eq!(between(0, 2).least_km, 0.0);
    assert!((between(1, 2).least_km - (100.0 - 7.378_137)).abs() < 1e-9);
    assert_eq!(separations.len(), 6);
    assert_eq!(least_separation_km(&design("delta:53:1/1/0@1000")), None);
}

/// The closest approach in a span against all pairs at steps of a second, between which a distance changes by at
/// most 15 km/s times half of it.
#[test]
fn validate_the_span_by_brute_force() {
    let design = design("delta:53:12/3/1@1000+star:90:10/2/1@1013,u=7");
    let duration_s = 10_000.0;
    let found = Approach::between(&design, [0, 1], duration_s)
        .unwrap()
        .unwrap();
    let mut least = (f64::INFINITY, 0.0);
    for second in 0..=10_000 {
        let places = positions(&design, f64::from(second));
        for one in &places[..12] {
            for other in &places[12..] {
                let distance_km = (one - other).norm();
                if distance_km < least.0 {
                    least = (distance_km, f64::from(second));
                }
            }
        }
    }
    assert!(
        (-1e-6..8.0).contains(&(least.0 - found.distance_km)),
        "{least:?} {found:?}"
    );
    assert!(
        (least.1 - found.elapsed_s).abs() <= 1.0,
        "{least:?} {found:?}"
    );
    assert!(found.slots[0].shell == Some(0) && found.slots[1].shell == Some(1));
    let long = Approach::between(&design, [0, 1], 1e12);
    assert!(long.unwrap_err().to_string().contains("120 pairs"));
}
