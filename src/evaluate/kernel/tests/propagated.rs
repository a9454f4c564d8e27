//! Positions of shells in the lanes, alone and among other satellites.

use super::super::propagation::Turn;
use super::*;

/// Shells under a secular model at any place among other satellites, whose numbers fill no block.
#[test]
fn shells_among_other_satellites_equal_the_plain_path() {
    let base = setup([3.0, 54.0], Surface::Sphere);
    let setup = Setup {
        grid: TimeGrid::new(base.grid.epoch(), 7_200.0, 60.0).unwrap(),
        ..base
    };
    let part = |text: &str, model: Model| {
        let design: Design = text.parse().unwrap();
        Ephemeris::of_design(&design, model, setup.grid).unwrap()
    };
    let ephemeris = part("delta:60:30/5/1@700", Model::J2Osculating)
        .joined(part("delta:53:91/7/1@1000", Model::J2))
        .joined(part("star:80:24/6/1@800", Model::J2Osculating))
        .joined(part("delta:45:66/6/1@1200", Model::TwoBody));
    assert_eq!(Propagation::new(&ephemeris).patterns.len(), 2);
    let evaluator = Evaluator::new(setup.clone()).unwrap();
    let plain = evaluator.evaluate_plain(&ephemeris).unwrap();
    let fast = evaluator.evaluate_ephemeris(&ephemeris).unwrap();
    assert!(plain.mean_visible > 5.0);
    compare(&fast, &plain).unwrap();
}

/// Positions of a pattern compared with those of its propagators, over a week.
#[test]
fn patterns_propagate_as_their_propagators_do() {
    for text in [
        "delta:55:182/13/1@925",
        "star:97.5:70/7/2@500",
        "lattice:63.4:60/6/5@2000",
        "delta:63.4:24/6/1@2000,e=0.01,w=270",
        "lattice:40:24/6/5@9000,e=0.25,w=77",
        "star:86.4:66/6/3@780,raan=77,u=5,node-step=31.6",
        "delta:63.4:24/6/1@2000,e=0.01,w=270,u=100+delta:55:182/13/1@925+lattice:40:24/6/5@9000,e=0.25",
    ] {
        let design: Design = text.parse().unwrap();
        let base = setup([3.0, 54.0], Surface::Sphere);
        let grid = TimeGrid::new(base.grid.epoch(), 7.0 * 86_400.0, 5000.0).unwrap();
        let ephemeris = Ephemeris::of_design(&design, Model::J2, grid).unwrap();
        let propagation = Propagation::new(&ephemeris);
        assert_eq!(propagation.patterns.len(), design.shells().len());
        let mut propagated = Positions::new(design.satellite_count());
        let mut asked = propagated.clone();
        let mut turns: Vec<Turn> = Vec::new();
        for elapsed_s in grid.iter() {
            let rotation = EarthRotation::from_gmst(grid.epoch().gmst_rad(elapsed_s));
            propagation
                .start(elapsed_s, rotation, &mut propagated, &mut turns)
                .unwrap();
            for (pattern, turn) in propagation.patterns.iter().zip(&turns) {
                pattern.place_at(turn, &mut propagated);
            }
            asked.propagate(&ephemeris, elapsed_s, rotation).unwrap();
            for n in 0..design.satellite_count() {
                let apart = Vector3::from(propagated.at(n)) - Vector3::from(asked.at(n));
                // An angle of 700 rad in doubles is accurate to 1e-13 rad: 1e-9 km.
                assert!(apart.norm() < 2e-9, "{text} {n} {apart}");
            }
        }
    }
}
