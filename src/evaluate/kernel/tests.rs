use crate::constellation::Design;
use crate::earth::Surface;
use crate::ephemeris::Ephemeris;
use crate::evaluate::{Evaluator, tests::setup};

#[test]
fn probe() {
    for surface in [Surface::Sphere, Surface::Wgs84] {
        for text in [
            "delta:55:182/13/1@925",
            "star:90:182/13/1@925",
            "delta:50:121/11/1@400",
            "lattice:63.4:182/13/5@950,e=0.01,w=270",
        ] {
            let design: Design = text.parse().unwrap();
            let setup = setup([3.0, 54.0], surface);
            let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
            let evaluator = Evaluator::new(setup).unwrap();
            let plain = evaluator.plain(&ephemeris).unwrap();
            let (fast, retakes) = evaluator.design_counted(&design).unwrap();
            let rel = |a: Option<f64>, b: Option<f64>| a.unwrap() / b.unwrap() - 1.0;
            println!(
                "{text} {surface:?} visible {} {} {retakes:?}",
                plain.mean_visible,
                fast.mean_visible - plain.mean_visible
            );
            println!(
                "  mean {:?} {:.1e} cvar {:.1e} p50 {:.1e} p95 {:.1e} p99 {:.1e} max {:?} {:.1e} solved {} avail {}",
                plain.mean_pdop,
                rel(fast.mean_pdop, plain.mean_pdop),
                rel(fast.cvar_pdop, plain.cvar_pdop),
                rel(fast.p50_pdop, plain.p50_pdop),
                rel(fast.p95_pdop, plain.p95_pdop),
                rel(fast.p99_pdop, plain.p99_pdop),
                plain.max_pdop,
                rel(fast.max_pdop, plain.max_pdop),
                fast.solved_fraction - plain.solved_fraction,
                fast.availability - plain.availability
            );
        }
    }
}
