//! Random search spaces.

use super::{Keyword, Pattern, SearchShells, SearchSpace, rising};
use crate::orbit::relations::SunSynchronous;
use crate::search::{IntervalOr, ShellSpace, SweepSteps};
use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;
use proptest::sample::subsequence;

/// An interval of an angle that is given or not.
fn angles() -> impl Strategy<Value = Option<[f64; 2]>> {
    option::of(rising(-360.0..=360.0))
}

fn steps() -> impl Strategy<Value = SweepSteps> {
    let step = || 0.001..360.0;
    let always = (1.0..1e3, 1.0..1e3, 0.001..1.0, step());
    let at_times = (option::of(step()), option::of(step()), option::of(step()));
    (always, at_times).prop_map(|(always, at_times)| {
        let (inclination_step_deg, altitude_step_km, eccentricity_step, arg_perigee_step_deg) =
            always;
        let (raan_step_deg, arg_latitude_step_deg, node_step_step_deg) = at_times;
        SweepSteps {
            inclination_step_deg,
            altitude_step_km,
            eccentricity_step,
            arg_perigee_step_deg,
            raan_step_deg,
            arg_latitude_step_deg,
            node_step_step_deg,
        }
    })
}

/// Three of them have at most 97 200 satellites.
fn shell() -> impl Strategy<Value = ShellSpace> {
    let whole = (
        rising(1..=180_u32),
        rising(1..=180_u32),
        rising(0..=400_u32),
        subsequence(<Pattern as Keyword>::ALL.to_vec(), 1..=3),
    );
    let real = (rising(0.0..=180.0), rising(1.0..=100_000.0), 0..4_u8);
    let ellipse = (rising(0.0..=0.89), rising(0.0..=360.0));
    let orientation = (angles(), angles(), angles());
    (whole, real, ellipse, orientation, steps()).prop_map(
        |(whole, real, ellipse, orientation, steps)| {
            let (planes, satellites_per_plane, mut phasing, pattern) = whole;
            let (inclination_deg, altitude_km, following) = real;
            let (eccentricity, arg_perigee_deg) = ellipse;
            let (raan_deg, arg_latitude_deg, node_step_deg) = orientation;
            phasing[0] = phasing[0].min(planes[1] - 1);
            // At least the roundest and highest design is above ground.
            let mut eccentricity: [f64; 2] = eccentricity;
            let roundest = if following < 2 {
                altitude_km[1] / 2e5
            } else {
                1e-3
            };
            eccentricity[0] = eccentricity[0].min(roundest);
            ShellSpace {
                node_step_deg: node_step_deg.filter(|_| !pattern.contains(&Pattern::Lattice)),
                pattern,
                planes,
                satellites_per_plane,
                inclination_deg: match following {
                    3 => IntervalOr::Following(SunSynchronous),
                    _ => inclination_deg.into(),
                },
                altitude_km: match following {
                    2 | 3 => IntervalOr::Following("repeat:14/1".parse().unwrap()),
                    _ => altitude_km.into(),
                },
                phasing,
                eccentricity,
                arg_perigee_deg,
                raan_deg,
                arg_latitude_deg,
                steps,
            }
        },
    )
}

/// One shell, or several of which all but the first may be empty.
pub(super) fn search() -> impl Strategy<Value = SearchSpace> {
    let listed = vec((shell(), any::<bool>()), 1..=3).prop_map(|shells| {
        let each = shells.into_iter().enumerate();
        let shells = each.map(|(n, (mut shell, may_be_empty))| {
            if may_be_empty && n > 0 {
                shell.satellites_per_plane[0] = 0;
            }
            shell
        });
        SearchShells::Listed(shells.collect())
    });
    let shells = prop_oneof![
        shell().prop_map(|shell| SearchShells::One(Box::new(shell))),
        listed
    ];
    let fixed = option::of(Just("star:86.4:66/6/3@780,node-step=31.6".to_owned()));
    (shells, fixed).prop_map(|(shells, fixed)| SearchSpace { shells, fixed })
}
