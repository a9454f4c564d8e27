//! Satellites of one constellation that come too close to each other.

use super::coincidence::coincident;
use super::{Ephemeris, EphemerisError, ShellSpan};
use crate::constellation::Slot;
use crate::constellation::separation::least_separation_km;
use crate::orbit::Model;
use nalgebra::Vector3;
use rayon::prelude::*;

/// Satellites within this distance of each other meet, km.
pub const MEET_WITHIN_KM: f64 = 1.0;

/// What short-period terms and J3 move a satellite from its mean orbit, km: at most 20 km in low orbit, along the
/// track; two satellites are moved against each other by less than this.
const PERIODIC_KM: f64 = 50.0;

/// Eccentricity up to which a satellite stays within 2.5 a e of its place on the circle; two satellites within 5 a e.
const NEARLY_CIRCULAR: f64 = 0.05;

/// A direction that no plane of a usual constellation is perpendicular to: the satellites of an orbit are spread
/// along it.
const SWEEP: Vector3<f64> = Vector3::new(0.48, 0.60, 0.64);

/// Two satellites within [`MEET_WITHIN_KM`] of each other at a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meeting {
    /// Their places in the ephemeris, the lower first.
    pub pair: [usize; 2],
    /// Seconds from the epoch of the grid.
    pub elapsed_s: f64,
    /// Distance, km.
    pub distance_km: f64,
}

/// The meetings of a constellation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meetings {
    /// How many there are: pairs of satellites, each at each of its samples.
    pub count: u64,
    /// The earliest.
    pub first: Meeting,
    /// The one with the smallest distance.
    pub closest: Meeting,
}

impl Meetings {
    fn of(meeting: Meeting) -> Self {
        Self {
            count: 1,
            first: meeting,
            closest: meeting,
        }
    }

    /// The meetings of both; independent of the order.
    fn and(self, other: Self) -> Self {
        let is_before = |a: &Meeting, b: &Meeting| {
            let by_time = a.elapsed_s.total_cmp(&b.elapsed_s);
            by_time.then(a.pair.cmp(&b.pair)).is_lt()
        };
        let is_closer = |a: &Meeting, b: &Meeting| {
            let by_distance = a.distance_km.total_cmp(&b.distance_km);
            by_distance.is_lt() || by_distance.is_eq() && is_before(a, b)
        };
        let (ours, theirs) = (self.first, other.first);
        let (near, also_near) = (self.closest, other.closest);
        Self {
            count: self.count + other.count,
            first: if is_before(&theirs, &ours) {
                theirs
            } else {
                ours
            },
            closest: if is_closer(&also_near, &near) {
                also_near
            } else {
                near
            },
        }
    }
}

/// The meetings of the satellites at the samples of the grid; `None` if there are none. Satellites that are in one
/// place all the time do not meet.
///
/// Only what can meet is propagated: shells whose satellites come close to each other, shells at the same distance
/// from the Earth, and satellites that belong to no shell.
///
/// # Errors
/// If a satellite cannot be propagated.
pub fn meetings(ephemeris: &Ephemeris) -> Result<Option<Meetings>, EphemerisError> {
    let candidates = candidates(ephemeris);
    if candidates.len() < 2 {
        return Ok(None);
    }
    let mut together = vec![usize::MAX; ephemeris.satellites().len()];
    for (group, members) in coincident(&[ephemeris])?.iter().enumerate() {
        for &(_, place) in members {
            together[place] = group;
        }
    }
    let grid = ephemeris.grid();
    let instants = (0..grid.len()).into_par_iter().with_min_len(16);
    let at = |k: usize| at_instant(ephemeris, &candidates, &together, grid.elapsed_s(k));
    let merge = |a: Option<Meetings>, b: Option<Meetings>| match (a, b) {
        (Some(a), Some(b)) => Some(a.and(b)),
        (a, b) => a.or(b),
    };
    instants.map(at).try_reduce(|| None, |a, b| Ok(merge(a, b)))
}

/// The places of the satellites that may meet another one.
fn candidates(ephemeris: &Ephemeris) -> Vec<usize> {
    let shells = ephemeris.shells();
    let others = ephemeris.outside_shells();
    let has_others = !others.is_empty();
    let may_meet = |n: usize| {
        let shell = &shells[n];
        let other = |m: usize| m != n && share_radii(shell, &shells[m]);
        has_others || may_meet_itself(shell) || (0..shells.len()).any(other)
    };
    let mut places: Vec<usize> = (0..shells.len())
        .filter(|n| may_meet(*n))
        .flat_map(|n| shells[n].places())
        .collect();
    places.extend(others);
    places
}

/// Whether satellites of two shells are ever at the same distance from the centre of the Earth.
fn share_radii(one: &ShellSpan, other: &ShellSpan) -> bool {
    let ([low, high], [other_low, other_high]) = (radii_km(one), radii_km(other));
    low <= other_high + MEET_WITHIN_KM && other_low <= high + MEET_WITHIN_KM
}

/// Lowest and highest distance of a shell from the centre of the Earth, km.
fn radii_km(span: &ShellSpan) -> [f64; 2] {
    let elements = span.shell.elements(Slot::FIRST);
    let (a, e) = (elements.semi_major_axis_km, elements.eccentricity);
    let periodic_km = periodic_km(span.model);
    [a * (1.0 - e) - periodic_km, a * (1.0 + e) + periodic_km]
}

/// How far two satellites are from where the mean orbits put them with respect to each other, km.
fn periodic_km(model: Model) -> f64 {
    match model {
        Model::TwoBody | Model::J2 => 0.0,
        Model::J2Osculating | Model::Sgp4 => PERIODIC_KM,
    }
}

/// Whether two satellites of a shell may meet.
fn may_meet_itself(span: &ShellSpan) -> bool {
    let elements = span.shell.elements(Slot::FIRST);
    let (a, e) = (elements.semi_major_axis_km, elements.eccentricity);
    let margin_km = periodic_km(span.model) + 5.0 * a * e;
    let Ok(round) = span.shell.with_ellipse(0.0, 0.0) else {
        return true;
    };
    let is_close = |least_km| least_km <= MEET_WITHIN_KM + margin_km;
    e > NEARLY_CIRCULAR || least_separation_km(&round.into()).is_some_and(is_close)
}

/// The meetings at one instant: the satellites are swept in the order of their coordinate along a line.
fn at_instant(
    ephemeris: &Ephemeris,
    places: &[usize],
    together: &[usize],
    elapsed_s: f64,
) -> Result<Option<Meetings>, EphemerisError> {
    let mut swept = Vec::with_capacity(places.len());
    for &place in places {
        let satellite = &ephemeris.satellites()[place];
        if let Some(state) = ephemeris.state_or_gap(satellite, elapsed_s)? {
            let position = state.position_km.km();
            swept.push((position.dot(&SWEEP), position, place));
        }
    }
    swept.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let is_one = |a: usize, b: usize| together[a] != usize::MAX && together[a] == together[b];
    // The end of the run of satellites in one place that each belongs to.
    let mut run_end: Vec<usize> = (1..=swept.len()).collect();
    for n in (1..swept.len()).rev() {
        if is_one(swept[n - 1].2, swept[n].2) {
            run_end[n - 1] = run_end[n];
        }
    }
    let mut found: Option<Meetings> = None;
    // The line has a length of 1.
    for (n, &(along, position, place)) in swept.iter().enumerate() {
        let mut next = run_end[n];
        while let Some(&(other_along, other_position, other)) = swept.get(next)
            && other_along - along <= MEET_WITHIN_KM
        {
            if is_one(place, other) {
                next = run_end[next];
                continue;
            }
            next += 1;
            let distance_km = (position - other_position).norm();
            if distance_km > MEET_WITHIN_KM {
                continue;
            }
            let meeting = Meetings::of(Meeting {
                pair: [place.min(other), place.max(other)],
                elapsed_s,
                distance_km,
            });
            found = Some(found.map_or(meeting, |found| found.and(meeting)));
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constellation::Design;
    use crate::time::{Epoch, TimeGrid};

    fn grid(duration_s: f64, step_s: f64) -> TimeGrid {
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        TimeGrid::new(epoch, duration_s, step_s).unwrap()
    }

    fn found(text: &str, grid: TimeGrid) -> Option<Meetings> {
        let design: Design = text.parse().unwrap();
        meetings(&Ephemeris::of_design(&design, Model::J2, grid).unwrap()).unwrap()
    }

    /// Those in one place are passed over together, and each meets the one that passes by.
    #[test]
    fn every_satellite_in_one_place_meets_another() {
        // Three in one place, between two that pass at the epoch only, 0.64 km from it.
        let text = "delta:53:1/1/0@1000+delta:53:1/1/0@1000+delta:53:1/1/0@1000\
            +star:90:1/1/0@1000,u=0.005+star:100:1/1/0@1000,u=-0.005";
        let meetings = found(text, grid(60.0, 60.0)).unwrap();
        // The two are 1.29 km apart.
        assert_eq!(meetings.count, 6);
        assert_eq!(meetings.first.pair, [0, 3]);
    }

    /// The satellites start at the same node, 0.01° = 1.27 km apart in altitude and phase: at the epoch only.
    #[test]
    fn shells_of_one_altitude_meet_where_their_orbits_cross() {
        let grid = grid(7200.0, 60.0);
        let meeting = found("delta:53:1/1/0@1000+star:90:1/1/0@1000,u=0.005", grid).unwrap();
        assert_eq!((meeting.count, meeting.first.pair), (1, [0, 1]));
        assert_eq!(meeting.first.elapsed_s, 0.0);
        // An arc of 0.005° at 7378.137 km, measured by its chord: 0.6439 km.
        assert!(
            (meeting.closest.distance_km - 0.643_86).abs() < 1e-5,
            "{meeting:?}"
        );
        for apart in [
            "delta:53:1/1/0@1000+star:90:1/1/0@1000,u=0.008",
            "delta:53:1/1/0@1000+star:90:1/1/0@1100,u=0.005",
        ] {
            assert_eq!(found(apart, grid), None, "{apart}");
        }
    }

    /// Shells at other altitudes are skipped without propagation.
    #[test]
    fn only_what_can_meet_is_propagated() {
        for (text, propagated) in [
            ("delta:53:160/10/1@1000+star:90:40/5/1@1100", 0),
            ("delta:53:160/10/1@1000+star:90:40/5/1@1000.5", 200),
            (
                "delta:53:160/10/1@1000+star:90:40/5/1@1100+star:80:40/5/1@1100",
                80,
            ),
            ("delta:55:182/13/1@925", 0),
            // Phased so that satellites meet where two planes cross.
            ("star:90:24/6/0@925", 24),
            ("delta:55:2/1/0@900,e=0.1", 2),
        ] {
            let design: Design = text.parse().unwrap();
            let ephemeris = Ephemeris::of_design(&design, Model::J2, grid(60.0, 60.0)).unwrap();
            assert_eq!(candidates(&ephemeris).len(), propagated, "{text}");
        }
    }

    /// All planes of a star without phasing meet at the pole a quarter of a period after the epoch.
    #[test]
    fn a_shell_meets_itself_where_its_phasing_is_bad() {
        let design: Design = "star:90:24/6/0@925".parse().unwrap();
        let orbit = crate::orbit::j2::SecularOrbit::j2(&design.shells()[0].elements(Slot::FIRST));
        let rates = orbit.rates();
        let quarter_s = std::f64::consts::FRAC_PI_2 / rates.arg_latitude_rad_s();
        let meeting = found("star:90:24/6/0@925", grid(2.5 * quarter_s, quarter_s)).unwrap();
        // Six satellites at either pole, fifteen pairs each, at the second of the three samples.
        assert_eq!((meeting.count, meeting.first.elapsed_s), (30, quarter_s));
    }

    /// Satellites that are in one place all the time have a warning of their own.
    #[test]
    fn coincident_satellites_do_not_meet() {
        assert_eq!(found("delta:0:36/6/0@3000", grid(86_400.0, 600.0)), None);
    }
}
