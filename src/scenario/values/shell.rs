//! The intervals of a shell: the keys of `[search]` and of each `[[search.shells]]`.

use crate::earth::RADIUS_KM;
use crate::scenario::Pattern;
use crate::scenario::keys::{KeyPath, key, section};
use crate::scenario::problem::Fault;
use crate::scenario::reader::Reader;
use crate::scenario::rule::{FollowingOr, Integer, Interval, Number, OneOrMore, Optional};
use crate::search::{IntervalOr, ShellSpace, SweepSteps};

/// Maximum number of satellites of a design.
pub(super) const MAX_SATELLITES: u32 = 100_000;

/// The interval of an orientation in the examples of the template, degrees.
const EXAMPLE_DEG: Option<[f64; 2]> = Some([0.0, 60.0]);

section! {
    impl ShellSpace in "search", finish finish_shell {
        /// Pattern of the designs, or several to choose from.
        pattern = OneOrMore::new(), default vec![Pattern::Delta];
        /// Number of planes.
        planes = integers(1, MAX_SATELLITES), default [11, 15];
        /// Number of satellites per plane; a shell may be empty if they start at 0, unless all may be and none is fixed.
        satellites_per_plane = integers(0, MAX_SATELLITES), default [11, 15];
        /// Inclination; `"sun-synchronous"` for the one at which the node follows the Sun.
        inclination_deg = FollowingOr::sun_synchronous(numbers(Number::from_to(0.0, 180.0))), unit "deg",
            default IntervalOr::Between([40.0, 60.0]);
        /// Altitude over the equatorial radius; `"repeat:15/1"` for the one at which the ground track repeats after 15
        /// revolutions in 1 nodal day.
        altitude_km = FollowingOr::repeat(numbers(Number::above_to(0.0, 100_000.0))), unit "km",
            default IntervalOr::Between([400.0, 1000.0]);
        /// Walker's F, or N_c of a lattice, capped at the number of planes minus one.
        phasing = integers(0, MAX_SATELLITES), default [1, 1];
        /// Eccentricity; a variable of the search if the limits differ.
        eccentricity = numbers(Number::from_below(0.0, 0.9)), default [0.0, 0.0];
        /// Argument of perigee; a variable of the search if the limits differ.
        arg_perigee_deg = numbers(Number::from_to(0.0, 360.0)), unit "deg", default [0.0, 0.0];
        /// Right ascension of the first node at the epoch, in TEME; a variable of the search if the limits differ.
        raan_deg = Optional(angles()), unit "deg", follows "0", example EXAMPLE_DEG;
        /// Mean argument of latitude of the first satellite at the epoch; a variable of the search if the limits differ.
        arg_latitude_deg = Optional(angles()), unit "deg", follows "that of mean anomaly 0", example EXAMPLE_DEG;
        /// Step from node to node, not of a lattice; a variable of the search if the limits differ.
        node_step_deg = Optional(angles()), unit "deg",
            follows "360/P of a delta and 180/P of a star", example Some([29.0, 32.0]);
        /// Steps of a sweep.
        steps;
    }
}

section! {
    impl SweepSteps in "search" {
        /// Step of an exhaustive search in inclination.
        inclination_step_deg = Number::above(0.0), unit "deg", default 0.5;
        /// Step of an exhaustive search in altitude.
        altitude_step_km = Number::above(0.0), unit "km", default 50.0;
        /// Step of an exhaustive search in eccentricity.
        eccentricity_step = Number::above(0.0), default 0.005;
        /// Step of an exhaustive search in argument of perigee.
        arg_perigee_step_deg = Number::above(0.0), unit "deg", default 30.0;
        /// Step of an exhaustive search in the right ascension of the first node.
        raan_step_deg = Optional(Number::above(0.0)), unit "deg", follows "30", example Some(30.0);
        /// Step of an exhaustive search in the argument of latitude of the first satellite.
        arg_latitude_step_deg = Optional(Number::above(0.0)), unit "deg", follows "30", example Some(30.0);
        /// Step of an exhaustive search in the step from node to node.
        node_step_step_deg = Optional(Number::above(0.0)), unit "deg", follows "1", example Some(1.0);
    }
}

/// The keys that give the intervals of a shell.
pub(in crate::scenario) const INTERVALS: [KeyPath; 11] = [
    key!(ShellSpace.pattern),
    key!(ShellSpace.planes),
    key!(ShellSpace.satellites_per_plane),
    key!(ShellSpace.inclination_deg),
    key!(ShellSpace.altitude_km),
    key!(ShellSpace.phasing),
    key!(ShellSpace.eccentricity),
    key!(ShellSpace.arg_perigee_deg),
    key!(ShellSpace.raan_deg),
    key!(ShellSpace.arg_latitude_deg),
    key!(ShellSpace.node_step_deg),
];

const fn integers(low: u32, high: u32) -> Interval<Integer<u32>> {
    Interval {
        of: Integer { low, high },
        or_single: true,
    }
}

const fn numbers(of: Number) -> Interval<Number> {
    Interval {
        of,
        or_single: true,
    }
}

/// Any angle within a turn, so that an interval may contain 0.
const fn angles() -> Interval<Number> {
    numbers(Number::from_to(-360.0, 360.0))
}

fn finish_shell(shell: &mut ShellSpace, reader: &mut Reader<'_>) {
    clear_examples(shell, reader);
    finish_phasing(shell, reader);
    let [planes, per_plane] = [shell.planes[1], shell.satellites_per_plane[1]].map(f64::from);
    let keys = [
        key!(ShellSpace.planes),
        key!(ShellSpace.satellites_per_plane),
    ];
    let most = MAX_SATELLITES.into();
    reader.at_most(most, planes * per_plane, "satellites in a design", &keys);
    if per_plane == 0.0 {
        reader.refuse(&[key!(ShellSpace.satellites_per_plane)], Fault::AlwaysEmpty);
    }
    check_above_ground(shell, reader);
    if shell.node_step_deg.is_some() && shell.pattern.contains(&Pattern::Lattice) {
        let keys = [key!(ShellSpace.node_step_deg), key!(ShellSpace.pattern)];
        reader.refuse(&keys, Fault::NodeStepOfLattice);
    }
}

/// Keys that are not given have no value, and not that of the template.
fn clear_examples(shell: &mut ShellSpace, reader: &Reader<'_>) {
    let ShellSpace {
        raan_deg,
        arg_latitude_deg,
        node_step_deg,
        steps,
        ..
    } = shell;
    for (interval, key) in [
        (raan_deg, key!(ShellSpace.raan_deg)),
        (arg_latitude_deg, key!(ShellSpace.arg_latitude_deg)),
        (node_step_deg, key!(ShellSpace.node_step_deg)),
    ] {
        if !reader.is_given(key) {
            *interval = None;
        }
    }
    for (step, key) in [
        (&mut steps.raan_step_deg, key!(SweepSteps.raan_step_deg)),
        (
            &mut steps.arg_latitude_step_deg,
            key!(SweepSteps.arg_latitude_step_deg),
        ),
        (
            &mut steps.node_step_step_deg,
            key!(SweepSteps.node_step_step_deg),
        ),
    ] {
        if !reader.is_given(key) {
            *step = None;
        }
    }
}

/// The default phasing is capped for a search with a single plane, where only 0 exists.
fn finish_phasing(shell: &mut ShellSpace, reader: &mut Reader<'_>) {
    let key = key!(ShellSpace.phasing);
    let planes = shell.planes[1];
    let highest = planes - 1;
    if !reader.is_given(key) {
        shell.phasing = shell.phasing.map(|limit| limit.min(highest));
    }
    let lowest = shell.phasing[0];
    if lowest > highest && !reader.is_wrong(key!(ShellSpace.planes)) {
        reader.refuse(&[key], Fault::PhasingAbovePlanes { lowest, planes });
    }
}

/// At least the roundest and highest design of a search has its perigee above ground.
fn check_above_ground(shell: &ShellSpace, reader: &mut Reader<'_>) {
    let eccentricity = shell.eccentricity[0];
    let Some([_, altitude_km]) = shell.altitude_km.limits() else {
        return check_relations(shell, reader);
    };
    let perigee_km = (RADIUS_KM + altitude_km) * (1.0 - eccentricity) - RADIUS_KM;
    if perigee_km > 0.0 {
        check_relations(shell, reader);
    } else {
        let keys = [key!(ShellSpace.eccentricity), key!(ShellSpace.altitude_km)];
        let fault = Fault::Underground {
            eccentricity,
            altitude_km,
            perigee_km,
        };
        reader.refuse(&keys, fault);
    }
}

/// There is an orbit at one end of what is given as an interval.
fn check_relations(shell: &ShellSpace, reader: &mut Reader<'_>) {
    let ends = |limits: Option<[f64; 2]>| limits.map_or(vec![None], |of| of.map(Some).to_vec());
    let mut fault = None;
    for inclination_deg in ends(shell.inclination_deg.limits()) {
        for altitude_km in ends(shell.altitude_km.limits()) {
            match shell.orbit(inclination_deg, altitude_km, shell.eccentricity[0]) {
                Ok(_) => return,
                Err(error) => fault = Some(error),
            }
        }
    }
    if let Some(source) = fault {
        let keys = [
            key!(ShellSpace.altitude_km),
            key!(ShellSpace.inclination_deg),
        ];
        reader.refuse(&keys, Fault::NoSuchOrbit { source });
    }
}

impl ShellSpace {
    /// What the template of a scenario shows.
    pub(super) fn examples() -> Vec<Self> {
        let shell = |pattern, inclination_deg: [f64; 2]| Self {
            pattern,
            planes: [4, 12],
            satellites_per_plane: [0, 12],
            inclination_deg: inclination_deg.into(),
            altitude_km: [600.0, 1200.0].into(),
            phasing: [1, 1],
            eccentricity: [0.0, 0.0],
            arg_perigee_deg: [0.0, 0.0],
            raan_deg: None,
            arg_latitude_deg: None,
            node_step_deg: None,
            steps: SweepSteps {
                inclination_step_deg: 0.5,
                altitude_step_km: 50.0,
                eccentricity_step: 0.005,
                arg_perigee_step_deg: 30.0,
                raan_step_deg: None,
                arg_latitude_step_deg: None,
                node_step_step_deg: None,
            },
        };
        let mid_latitudes = Self {
            satellites_per_plane: [8, 12],
            ..shell(vec![Pattern::Delta], [40.0, 60.0])
        };
        let polar = shell(vec![Pattern::Star, Pattern::Delta], [80.0, 90.0]);
        vec![mid_latitudes, polar]
    }
}
