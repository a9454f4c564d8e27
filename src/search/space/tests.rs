/// The place of the phasing after P, S, i and h.
const PHASING: usize = 4;

use super::super::testing::shell;
use super::*;
use crate::constellation::Pattern;

fn space() -> DesignSpace {
    shell().into()
}

#[test]
fn vectors_become_short_designs() {
    let mut genome = vec![3.0, 11.0, 43.827_364_651, 999.999_96, 14.0];
    space().repair(&mut genome);
    let design = space().design(&genome).unwrap().unwrap();
    assert_eq!(design.to_string(), "delta:43.8274:33/3/2@1000");
    let before = genome.clone();
    space().repair(&mut genome);
    assert_eq!(genome, before);
}

#[test]
fn phasing_stays_between_limits_that_are_cut() {
    let narrow: DesignSpace = ShellSpace {
        phasing: [3, 20],
        planes: [2, 8],
        ..shell()
    }
    .into();
    let vectors = narrow.vectors().unwrap();
    assert_eq!(vectors.variables()[PHASING].kind.bounds(), (1.0, 7.0));
    for (planes, phasing, repaired) in [(2.0, 5.0, 1.0), (8.0, 1.0, 3.0), (8.0, 7.0, 7.0)] {
        let mut genome = vec![planes, 11.0, 50.0, 925.0, phasing];
        narrow.repair(&mut genome);
        assert_eq!(genome[PHASING], repaired);
        assert_eq!(vectors.check(&genome), Ok(()));
    }
}

#[test]
fn ellipses_are_variables_where_they_vary() {
    let free: DesignSpace = ShellSpace {
        pattern: vec![Pattern::Lattice],
        arg_perigee_deg: [0.0, 360.0],
        eccentricity: [0.01, 0.01],
        ..shell()
    }
    .into();
    assert_eq!(space().vectors().unwrap().variables().len(), 5);
    assert_eq!(free.vectors().unwrap().variables().len(), 6);
    assert_eq!(free.steps(), [1.0, 1.0, 0.5, 50.0, 1.0, 30.0]);
    let mut genome = vec![13.0, 14.0, 55.0, 925.0, 5.0, 270.000_04];
    free.repair(&mut genome);
    let design = free.design(&genome).unwrap().unwrap();
    assert_eq!(design.to_string(), "lattice:55:182/13/5@925,e=0.01,w=270");
}

/// A shell at middle latitudes and a polar one that may be empty.
fn two_shells() -> DesignSpace {
    let polar = ShellSpace {
        pattern: vec![Pattern::Star, Pattern::Delta],
        planes: [2, 6],
        satellites_per_plane: [0, 8],
        inclination_deg: [80.0, 90.0].into(),
        raan_deg: Some([0.0, 60.0]),
        arg_latitude_deg: Some([45.0, 45.0]),
        node_step_deg: Some([20.0, 31.6]),
        ..shell()
    };
    DesignSpace {
        shells: vec![shell(), polar],
        fixed: None,
    }
}

#[test]
fn variables_of_several_shells_follow_each_other() {
    let space = two_shells();
    let vectors = space.vectors().unwrap();
    let names: Vec<&str> = vectors
        .variables()
        .iter()
        .map(|v| v.name.as_str())
        .collect();
    assert_eq!(
        names,
        [
            "A.planes",
            "A.satellites-per-plane",
            "A.inclination-deg",
            "A.altitude-km",
            "A.phasing",
            "B.planes",
            "B.satellites-per-plane",
            "B.inclination-deg",
            "B.altitude-km",
            "B.phasing",
            "B.raan-deg",
            "B.node-step-deg",
            "B.pattern",
        ]
    );
    assert_eq!(
        space.steps(),
        [
            1.0, 1.0, 0.5, 50.0, 1.0, 1.0, 1.0, 0.5, 50.0, 1.0, 30.0, 1.0, 1.0
        ]
    );
    let genome = [
        4.0, 12.0, 50.0, 800.0, 1.0, // A
        3.0, 7.0, 86.4, 780.0, 2.0, 12.5, 31.6, 1.0, // B
    ];
    let design = space.design(&genome).unwrap().unwrap();
    assert_eq!(
        design.to_string(),
        "delta:50:48/4/1@800+delta:86.4:21/3/2@780,raan=12.5,u=45,node-step=31.6"
    );
    assert!(!space.is_idle(&genome, 12));
}

/// An empty shell is one vector, whatever its other variables were, and its satellites alone bring it back.
#[test]
fn an_empty_shell_is_one_vector() {
    let space = two_shells();
    let mut one = vec![
        4.0, 12.0, 50.0, 800.0, 1.0, 6.0, 0.0, 86.4, 780.0, 2.0, 12.5, 31.6, 1.0,
    ];
    let mut other = vec![
        4.0, 12.0, 50.0, 800.0, 1.0, 3.0, 0.0, 83.0, 500.0, 1.0, 0.0, 25.0, 0.0,
    ];
    for genome in [&mut one, &mut other] {
        space.repair(genome);
        space.unify(genome);
    }
    assert_eq!(one, other);
    assert_eq!(space.vectors().unwrap().check(&one), Ok(()));
    assert_eq!(
        space.design(&one).unwrap().unwrap().to_string(),
        "delta:50:48/4/1@800"
    );
    assert_eq!(space.shells_of(&one).unwrap()[1], None);
    assert!(space.is_idle(&one, 5) && space.is_idle(&one, 12));
    assert!(!space.is_idle(&one, 6) && !space.is_idle(&one, 0));
}

#[test]
fn what_is_fixed_is_in_every_design() {
    let fixed: Design = "star:86.4:66/6/3@780,node-step=31.6".parse().unwrap();
    let mut space = two_shells();
    space.shells[0].satellites_per_plane = [0, 12];
    let nothing = [
        3.0, 0.0, 40.0, 400.0, 0.0, 2.0, 0.0, 80.0, 400.0, 0.0, 0.0, 20.0, 0.0,
    ];
    assert!(space.may_be_empty());
    assert_eq!(space.design(&nothing), Ok(None));
    space.fixed = Some(fixed.clone());
    assert_eq!(space.design(&nothing), Ok(Some(fixed)));
}

#[test]
fn equal_shells_are_told_in_any_order_of_their_patterns() {
    let mut space = two_shells();
    assert!(space.repetitions()[0].starts_with("shell B: with node-step-deg, delta and star"));
    space.shells[1].node_step_deg = None;
    assert!(space.repetitions().is_empty());
    let mut same = space.shells[1].clone();
    same.pattern.reverse();
    same.steps.altitude_step_km = 1.0;
    space.shells.push(same);
    let told = space.repetitions();
    assert_eq!(told.len(), 1);
    assert!(
        told[0].starts_with("shells B and C of the search have the same intervals"),
        "{told:?}"
    );
    space.shells[2].planes = [2, 7];
    assert!(space.repetitions().is_empty());
}
