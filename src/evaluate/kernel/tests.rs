use crate::evaluate::{Evaluator, tests::setup};
use crate::earth::Surface;
use crate::ephemeris::Ephemeris;
use crate::constellation::Design;

#[test]
fn probe() {
    for surface in [Surface::Sphere, Surface::Wgs84] {
    for text in ["delta:55:182/13/1@925", "star:90:182/13/1@925", "delta:50:121/11/1@400", "lattice:63.4:182/13/5@950,e=0.01,w=270"] {
        let design: Design = text.parse().unwrap();
        let setup = setup([3.0, 54.0], surface);
        let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
        let evaluator = Evaluator::new(setup).unwrap();
        let plain = evaluator.plain(&ephemeris).unwrap();
        let (fast, retakes) = evaluator.design_counted(&design).unwrap();
        let rel = |a: Option<f64>, b: Option<f64>| a.unwrap() / b.unwrap() - 1.0;
        println!("{text} {surface:?} visible {} {} {retakes:?}", plain.mean_visible, fast.mean_visible - plain.mean_visible);
        println!("  mean {:?} {:.1e} cvar {:.1e} p50 {:.1e} p95 {:.1e} p99 {:.1e} max {:?} {:.1e} solved {} avail {}", plain.mean_pdop, rel(fast.mean_pdop, plain.mean_pdop), rel(fast.cvar_pdop, plain.cvar_pdop), rel(fast.p50_pdop, plain.p50_pdop),
          rel(fast.p95_pdop, plain.p95_pdop), rel(fast.p99_pdop, plain.p99_pdop), plain.max_pdop, rel(fast.max_pdop, plain.max_pdop), fast.solved_fraction - plain.solved_fraction, fast.availability-plain.availability);
    }
    }
}

#[test]
fn probe_count() {
    use super::candidates::Candidates;
    use super::flight::{PatternFlight, Positions};
    use super::tiles::{Horizon, Tiles};
    use crate::frames::EarthRotation;
    let setup = setup([3.0, 54.0], Surface::Sphere);
    let design: Design = "delta:55:182/13/1@925".parse().unwrap();
    let flight = PatternFlight::new(&design, setup.model).unwrap();
    let tiles = Tiles::new(&setup.sites, setup.mask);
    for t in &tiles.tiles {
        let mut v: Vec<(i32, i32)> = t.members.iter().map(|&m| (setup.sites[m as usize].latitude_deg as i32, setup.sites[m as usize].longitude_deg as i32)).collect();
        v.sort();
        println!("{:?}", v);
    }
    let mut positions = Positions::new(182);
    let mut all = Candidates::with_capacity(182);
    let mut near = Candidates::with_capacity(182);
    let (mut tests, mut region) = (0, 0);
    for e in setup.grid.iter() {
        let rotation = EarthRotation::from_gmst(setup.grid.epoch().gmst_rad(e));
        flight.fly(&flight.turn(e, rotation), &mut positions);
        all.fill(&positions, &tiles.horizon);
        let slack = Horizon::cap_slack_km(&positions);
        for g in &tiles.groups {
            near.select(&all, &g.cap, slack);
            region += near.blocks().iter().map(|b| b.inside(&g.cap, slack).count_ones()).sum::<u32>();
            for t in &tiles.tiles[g.tiles.clone()] {
                tests += near.blocks().iter().map(|b| b.inside(&t.cap, slack).count_ones()).sum::<u32>();
            }
        }
    }
    println!("tests {tests} region {region} per sample {} {}", tests as f64 / 1440., region as f64 / 1440.);
}
