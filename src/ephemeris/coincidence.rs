//! Coincident satellites: docked, listed twice, or placed in the same slot by the pattern.
//!
//! A receiver sees them in a single direction, however many count as visible.

use super::{Ephemeris, EphemerisError, EphemerisSatellite};
use nalgebra::Vector3;

/// Satellites within this distance of each other at every instant tested are coincident, km.
///
/// At a range of 500 km or more they are at most 4 arcseconds apart, so a solution that depends on
/// the difference has a PDOP above 10 000. The rounding of element sets is smaller.
pub const COINCIDENT_WITHIN_KM: f64 = 0.01;

/// A satellite by the index of its ephemeris and its index in it.
pub type SatellitePlace = (usize, usize);

/// The groups of two or more coincident satellites, each in the order of the satellites.
///
/// Tests three unevenly spaced instants of the grid: satellites on crossing orbits may meet at one
/// of them but not at all. All ephemerides are tested on the grid of the first.
///
/// # Errors
/// If a satellite cannot be propagated.
pub fn coincident(ephemerides: &[&Ephemeris]) -> Result<Vec<Vec<SatellitePlace>>, EphemerisError> {
    let Some(first) = ephemerides.first() else {
        return Ok(Vec::new());
    };
    let last = first.grid().len().saturating_sub(1);
    let instants = [0, last * 2 / 5, last].map(|n| first.grid().elapsed_s(n));
    let mut tracks = Vec::new();
    for (number, ephemeris) in ephemerides.iter().enumerate() {
        for (place, satellite) in ephemeris.satellites().iter().enumerate() {
            if let Some(track) = track(ephemeris, satellite, instants)? {
                tracks.push(((number, place), track));
            }
        }
    }
    tracks.sort_by(|a, b| a.1[0].x.total_cmp(&b.1[0].x));
    Ok(groups(&tracks))
}

/// The positions of a satellite, km; `None` if its file has a gap at one of the instants.
fn track(
    ephemeris: &Ephemeris,
    satellite: &EphemerisSatellite,
    instants: [f64; 3],
) -> Result<Option<[Vector3<f64>; 3]>, EphemerisError> {
    let mut track = [Vector3::zeros(); 3];
    for (position, elapsed_s) in track.iter_mut().zip(instants) {
        let Some(state) = ephemeris.state_or_gap(satellite, elapsed_s)? else {
            return Ok(None);
        };
        *position = state.position_km.km();
    }
    Ok(Some(track))
}

/// A satellite and its positions at the three instants, km.
type Located = (SatellitePlace, [Vector3<f64>; 3]);

/// The places that have not been taken, so that those of a large group are passed over at once.
struct FreePlaces {
    /// The place itself if it is free, or else one that is not after the next free one.
    next: Vec<usize>,
}

impl FreePlaces {
    fn new(count: usize) -> Self {
        let next = (0..=count).collect();
        Self { next }
    }

    /// The first free place from one on; their number if there is none.
    fn from(&mut self, place: usize) -> usize {
        let mut at = place;
        while self.next[at] != at {
            // Every second step is saved for the next time.
            self.next[at] = self.next[self.next[at]];
            at = self.next[at];
        }
        at
    }

    fn take(&mut self, place: usize) {
        self.next[place] = place + 1;
    }
}

/// Groups of coincident tracks; the tracks are sorted by x at the first instant.
fn groups(tracks: &[Located]) -> Vec<Vec<SatellitePlace>> {
    // The group of each track, identified by its first track.
    let mut leaders: Vec<usize> = (0..tracks.len()).collect();
    let mut free = FreePlaces::new(tracks.len());
    for (n, (_, track)) in tracks.iter().enumerate() {
        let mut m = free.from(n + 1);
        while let Some((_, other)) = tracks.get(m)
            && other[0].x - track[0].x <= COINCIDENT_WITHIN_KM
        {
            let mut pairs = track.iter().zip(other);
            if pairs.all(|(a, b)| (a - b).norm() <= COINCIDENT_WITHIN_KM) {
                leaders[m] = leaders[n];
                free.take(m);
            }
            m = free.from(m + 1);
        }
    }
    let mut groups: Vec<Vec<SatellitePlace>> = vec![Vec::new(); tracks.len()];
    for (leader, (member, _)) in leaders.into_iter().zip(tracks) {
        groups[leader].push(*member);
    }
    groups.retain(|group| group.len() > 1);
    groups.iter_mut().for_each(|group| group.sort_unstable());
    groups.sort_unstable();
    groups
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constellation::Design;
    use crate::constellation::gnss::Preset;
    use crate::orbit::Model;
    use crate::time::{Epoch, TimeGrid};

    fn grid() -> TimeGrid {
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        TimeGrid::new(epoch, 86_400.0, 60.0).unwrap()
    }

    fn ephemeris(text: &str) -> Ephemeris {
        let design: Design = text.parse().unwrap();
        Ephemeris::of_design(&design, Model::J2, grid()).unwrap()
    }

    #[test]
    fn planes_of_an_equatorial_ring_share_their_places() {
        let groups = coincident(&[&ephemeris("delta:0:36/6/0@3000")]).unwrap();
        assert_eq!(groups.len(), 6);
        assert!(groups.iter().all(|group| group.len() == 6));
        // Slot j of plane k is 60° (j + k) along the equator.
        let first = [0, 11, 16, 21, 26, 31].map(|place| (0, place));
        assert_eq!(groups[0], first);
    }

    /// All planes of a star pattern without phasing cross at the poles, where their satellites meet
    /// twice a revolution.
    #[test]
    fn orbits_that_cross_are_not_one_place() {
        for text in [
            "star:90:24/6/0@925",
            "delta:55:182/13/1@925",
            "delta:0:36/6/1@3000",
        ] {
            assert_eq!(coincident(&[&ephemeris(text)]), Ok(vec![]), "{text}");
        }
    }

    /// 100 000 satellites in each of two places, and 100 000 on a line through them: a comparison of all pairs of a place
    /// would not end here.
    #[test]
    fn large_groups_take_no_longer_than_their_satellites() {
        let at = |x_km: f64| [Vector3::new(x_km, 0.0, 0.0); 3];
        let count = 100_000;
        let place = |n: usize| match n % 3 {
            0 => at(7000.0),
            1 => at(7000.02),
            _ => at(7001.0 + n as f64),
        };
        let mut tracks: Vec<Located> = (0..3 * count).map(|n| ((0, n), place(n))).collect();
        tracks.sort_by(|a, b| a.1[0].x.total_cmp(&b.1[0].x));
        let groups = groups(&tracks);
        let sizes: Vec<usize> = groups.iter().map(Vec::len).collect();
        assert_eq!(sizes, [count, count]);
        assert_eq!(groups[1][..2], [(0, 1), (0, 4)]);
    }

    #[test]
    fn satellites_of_two_lists_are_found() {
        let gnss = |_| Ephemeris::of_gnss(Preset::Gps.satellites(grid().epoch()), grid());
        let lists = [0, 1].map(gnss);
        let leo = ephemeris("delta:55:24/6/1@925");
        let groups = coincident(&[&leo, &lists[0], &lists[1]]).unwrap();
        assert_eq!(groups.len(), 24);
        assert_eq!(groups[3], [(1, 3), (2, 3)]);
        assert_eq!(coincident(&[]), Ok(vec![]));
    }
}
