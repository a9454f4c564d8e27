//! Satellites that are out of service: throughout, or for an interval.

use super::{Ephemeris, EphemerisSatellite, ShellSpan};
use crate::constellation::gnss::{GivenOrbit, GnssOrbit, GnssSatellite};
use crate::frames::{State, Teme};
use crate::keyword::nearest;
use crate::orbit::{PropagationError, Propagator};
use crate::time::TimeGrid;
use std::ops::Range;
use std::sync::Arc;
use thiserror::Error;

/// A satellite out of service.
#[derive(Debug, Clone, PartialEq)]
pub struct SatelliteOutage {
    /// Its name, or that of a plane or shell of a design for all of its satellites: `NW-P01-S03`, `NW-P01`, `NW-A`; one
    /// of a GNSS may be given as `gps:A3`.
    pub satellite: String,
    /// Where this is said, for messages: `outages.csv, line 3`.
    pub origin: String,
    /// Seconds since the epoch of the study, the end excluded; `None`: throughout.
    pub interval_s: Option<Range<f64>>,
}

/// Why satellites cannot be taken out of service.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum OutageError {
    /// No satellite has the name.
    #[error(
        "{origin}: '{name}' is not a satellite or plane of {constellation}{}", no_gnss_either(.gnss, .meant.as_deref())
    )]
    Unknown {
        /// Where it is named.
        origin: String,
        /// The name.
        name: String,
        /// The constellation.
        constellation: String,
        /// The names of the GNSS.
        gnss: Vec<String>,
        /// The nearest name.
        meant: Option<String>,
    },
    /// Several GNSS have a satellite of the name.
    #[error("{origin}: '{name}' is a satellite of {}; write {}:{name}", .systems.join(" and of "), .systems[0])]
    Ambiguous {
        /// Where it is named.
        origin: String,
        /// The name.
        name: String,
        /// The systems, at least two.
        systems: Vec<String>,
    },
    /// No satellite is left.
    #[error("all {satellites} satellites of {constellation} are out of service throughout")]
    AllDown {
        /// The constellation.
        constellation: String,
        /// Its satellites.
        satellites: usize,
    },
}

fn no_gnss_either(gnss: &[String], meant: Option<&str>) -> String {
    let of_gnss = match gnss {
        [] => String::new(),
        systems => format!(", nor a satellite of {}", systems.join(" or ")),
    };
    let meant = meant.map_or_else(String::new, |name| format!(", did you mean '{name}'?"));
    format!("{of_gnss}{meant}")
}

impl SatelliteOutage {
    /// What of an interval has no effect on the samples of a grid, if anything: what is outside its span, or all of an interval
    /// between two samples.
    #[must_use]
    pub fn note(&self, grid: TimeGrid) -> Option<String> {
        let interval = self.interval_s.as_ref()?;
        let at = |elapsed_s: f64| grid.epoch().plus_seconds(elapsed_s);
        let (start, end) = (at(interval.start), at(interval.end));
        let what = format!(
            "{}: {} is out of service from {start} to {end}",
            self.origin, self.satellite
        );
        let span_s = grid.elapsed_s(grid.len());
        if !grid.iter().any(|elapsed_s| interval.contains(&elapsed_s)) {
            let step_s = grid.step_s();
            return Some(format!(
                "{what}, between two samples {step_s} s apart: it has no effect"
            ));
        }
        let is_cut = interval.start < 0.0 || interval.end > span_s;
        is_cut.then(|| {
            let (first, last) = (grid.epoch(), at(span_s));
            format!("{what}, of which only what is within the span of the study counts, {first} to {last}")
        })
    }

    /// Whether it is of this satellite.
    fn is_of(&self, satellite: &EphemerisSatellite) -> bool {
        let name = &satellite.name;
        let in_group = || {
            let rest = name.strip_prefix(self.satellite.as_str());
            rest.is_some_and(|rest| rest.starts_with("-S") || rest.starts_with("-P"))
        };
        *name == self.satellite || (satellite.slot.is_some() && in_group())
    }

    /// Whether it is of a satellite of this name in a GNSS.
    pub(crate) fn is_of_gnss(&self, system: &str, name: &str) -> bool {
        let qualified = self.satellite.strip_prefix(system);
        let qualified = qualified.and_then(|rest| rest.strip_prefix(':'));
        self.satellite == name || qualified == Some(name)
    }
}

impl Ephemeris {
    /// The same satellites without those that are out of service throughout, and the others without states while they are.
    /// An outage of none of the satellites changes nothing.
    #[must_use]
    pub fn with_outages(self, outages: &[SatelliteOutage]) -> Self {
        self.of_fates(|satellite| Fate::of(outages.iter().filter(|one| one.is_of(satellite))))
    }

    /// The same satellites but for those at some places.
    #[must_use]
    pub fn without(self, places: &[usize]) -> Self {
        let mut is_down = vec![false; self.satellites.len()];
        places.iter().for_each(|place| is_down[*place] = true);
        let mut fates = is_down.into_iter().map(|is_down| match is_down {
            true => Fate::Down,
            false => Fate::Up,
        });
        self.of_fates(|_| fates.next().unwrap_or(Fate::Up))
    }

    /// What becomes of each satellite, in their order. A shell that is not whole any more is none.
    fn of_fates(self, mut fate: impl FnMut(&EphemerisSatellite) -> Fate) -> Self {
        let Self {
            grid,
            satellites,
            shells,
            parts,
        } = self;
        let mut left = Self::new(grid, Vec::new());
        let mut moved_to = Vec::with_capacity(satellites.len());
        for (mut satellite, part) in satellites.into_iter().zip(parts) {
            let fate = fate(&satellite);
            moved_to.push(matches!(fate, Fate::Up).then_some(left.satellites.len()));
            match fate {
                Fate::Down => continue,
                Fate::Up => {}
                Fate::Interrupted(intervals_s) => {
                    satellite.propagator = Box::new(Interrupted {
                        propagator: satellite.propagator,
                        intervals_s,
                    });
                }
            }
            left.satellites.push(satellite);
            left.parts.push(part);
        }
        for shell in shells {
            let places = &moved_to[shell.places()];
            if let (Some(first), true) = (places[0], places.iter().all(Option::is_some)) {
                left.shells.push(ShellSpan { first, ..shell });
            }
        }
        left
    }
}

/// What becomes of a satellite.
enum Fate {
    Up,
    Down,
    /// Out of service in these intervals, seconds since the epoch.
    Interrupted(Vec<Range<f64>>),
}

impl Fate {
    /// What the outages of a satellite make of it.
    fn of<'a>(outages: impl Iterator<Item = &'a SatelliteOutage>) -> Self {
        let intervals: Option<Vec<Range<f64>>> =
            outages.map(|one| one.interval_s.clone()).collect();
        match intervals {
            None => Self::Down,
            Some(intervals) if intervals.is_empty() => Self::Up,
            Some(intervals) => Self::Interrupted(intervals),
        }
    }
}

/// The satellites of a GNSS without those that are out of service throughout, and the others without states while they are.
#[must_use]
pub fn gnss_in_service(
    system: &str,
    satellites: Vec<GnssSatellite>,
    outages: &[SatelliteOutage],
) -> Vec<GnssSatellite> {
    let in_service = |satellite: GnssSatellite| {
        let of = |one: &&SatelliteOutage| one.is_of_gnss(system, &satellite.name);
        match Fate::of(outages.iter().filter(of)) {
            Fate::Up => Some(satellite),
            Fate::Down => None,
            Fate::Interrupted(intervals_s) => Some(GnssSatellite {
                name: satellite.name,
                orbit: GnssOrbit::Given(GivenOrbit(Arc::new(Interrupted {
                    propagator: Box::new(satellite.orbit),
                    intervals_s,
                }))),
            }),
        }
    };
    satellites.into_iter().filter_map(in_service).collect()
}

/// A satellite without states while it is out of service.
struct Interrupted {
    propagator: Box<dyn Propagator>,
    intervals_s: Vec<Range<f64>>,
}

impl Propagator for Interrupted {
    fn state_at(&self, elapsed_s: f64) -> Result<State<Teme>, PropagationError> {
        if self.intervals_s.iter().any(|one| one.contains(&elapsed_s)) {
            return Err(PropagationError::NotSampled { elapsed_s });
        }
        self.propagator.state_at(elapsed_s)
    }
}

/// The outages that are of none of the systems are of satellites of a constellation; each must be known there.
///
/// # Errors
/// If the constellation has no such satellite, or none that is in service at some time.
pub(crate) fn in_service(
    constellation: &str,
    ephemeris: Ephemeris,
    outages: &[SatelliteOutage],
    systems: &[(String, Vec<String>)],
) -> Result<Ephemeris, OutageError> {
    if outages.is_empty() {
        return Ok(ephemeris);
    }
    let mut own = Vec::new();
    for outage in outages {
        let of_gnss = systems.iter().any(|(system, names)| {
            let mut names = names.iter();
            names.any(|name| outage.is_of_gnss(system, name))
        });
        let is_known = || ephemeris.satellites.iter().any(|one| outage.is_of(one));
        if !of_gnss {
            if !is_known() {
                return Err(unknown(constellation, &ephemeris, outage, systems));
            }
            own.push(outage.clone());
        }
    }
    let satellites = ephemeris.satellites.len();
    let left = ephemeris.with_outages(&own);
    if left.satellites.is_empty() && satellites > 0 {
        return Err(OutageError::AllDown {
            constellation: constellation.to_owned(),
            satellites,
        });
    }
    Ok(left)
}

fn unknown(
    constellation: &str,
    ephemeris: &Ephemeris,
    outage: &SatelliteOutage,
    systems: &[(String, Vec<String>)],
) -> OutageError {
    let own = ephemeris.satellites.iter().map(|one| one.name.as_str());
    let planes = ephemeris.satellites.iter().filter_map(plane_name);
    let of_gnss = systems.iter().flat_map(|(_, names)| names);
    let known: Vec<&str> = own
        .chain(planes)
        .chain(of_gnss.map(String::as_str))
        .collect();
    OutageError::Unknown {
        origin: outage.origin.clone(),
        name: outage.satellite.clone(),
        constellation: constellation.to_owned(),
        gnss: systems.iter().map(|(name, _)| name.clone()).collect(),
        meant: nearest_name(&outage.satellite, &known).map(str::to_owned),
    }
}

/// The nearest of several names, whatever their case.
fn nearest_name<'a>(written: &str, known: &[&'a str]) -> Option<&'a str> {
    let lower: Vec<String> = known.iter().map(|name| name.to_lowercase()).collect();
    let candidates: Vec<&str> = lower.iter().map(String::as_str).collect();
    let found = nearest(written, &candidates)?;
    let at = lower.iter().position(|name| name == found)?;
    Some(known[at])
}

impl Ephemeris {
    /// The places of the satellites of a name, or of those of a plane or shell; `constellation` and `origin` are for messages.
    ///
    /// # Errors
    /// If there is none.
    pub fn places_of(
        &self,
        constellation: &str,
        name: &str,
        origin: &str,
    ) -> Result<Vec<usize>, OutageError> {
        let part = SatelliteOutage {
            satellite: name.to_owned(),
            origin: origin.to_owned(),
            interval_s: None,
        };
        let satellites = self.satellites.iter().enumerate();
        let own = satellites.filter(|(_, one)| part.is_of(one));
        let places: Vec<usize> = own.map(|(place, _)| place).collect();
        match places.as_slice() {
            [] => Err(unknown(constellation, self, &part, &[])),
            _ => Ok(places),
        }
    }

    /// The planes of its designs, each with the places of its satellites.
    #[must_use]
    pub fn planes(&self) -> Vec<(String, Vec<usize>)> {
        let mut planes: Vec<(String, Vec<usize>)> = Vec::new();
        for (place, satellite) in self.satellites.iter().enumerate() {
            let Some(name) = plane_name(satellite) else {
                continue;
            };
            match planes.last_mut().filter(|(last, _)| last == name) {
                Some((_, places)) => places.push(place),
                None => planes.push((name.to_owned(), vec![place])),
            }
        }
        planes
    }
}

/// The name of the plane of a satellite of a design: that of the satellite without its place in the plane.
#[must_use]
fn plane_name(satellite: &EphemerisSatellite) -> Option<&str> {
    satellite.slot?;
    let (plane, _) = satellite.name.rsplit_once("-S")?;
    Some(plane)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constellation::Design;
    use crate::orbit::Model;
    use crate::time::Epoch;

    fn hybrid() -> Ephemeris {
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let grid = TimeGrid::new(epoch, 600.0, 60.0).unwrap();
        let design: Design = "delta:55:4/2/1@925+star:90:4/2/1@1200+delta:40:2/1/0@800"
            .parse()
            .unwrap();
        Ephemeris::of_design(&design, Model::J2, grid).unwrap()
    }

    fn outage(satellite: &str, interval_s: Option<Range<f64>>) -> SatelliteOutage {
        SatelliteOutage {
            satellite: satellite.to_owned(),
            origin: "outages.satellites".to_owned(),
            interval_s,
        }
    }

    fn names(ephemeris: &Ephemeris) -> Vec<&str> {
        let satellites = ephemeris.satellites().iter();
        satellites.map(|one| one.name.as_str()).collect()
    }

    /// A satellite, a plane and a shell; the shells left keep their places and the parts their numbers.
    #[test]
    fn satellites_planes_and_shells_go() {
        let left = hybrid().with_outages(&[outage("NW-A-P02-S01", None), outage("NW-A-P01", None)]);
        assert_eq!(
            names(&left)[..3],
            ["NW-A-P02-S02", "NW-B-P01-S01", "NW-B-P01-S02"]
        );
        let firsts: Vec<usize> = left.shells().iter().map(|span| span.first).collect();
        assert_eq!(firsts, [1, 5]);
        assert_eq!(left.parts(), [0, 1, 1, 1, 1, 2, 2]);
        let left = hybrid().with_outages(&[outage("NW-B", None)]);
        assert_eq!(left.satellites().len(), 6);
        assert_eq!(left.parts(), [0, 0, 0, 0, 2, 2]);
        // A prefix of a name is no plane.
        let left = hybrid().with_outages(&[outage("NW-A-P0", None), outage("NW", None)]);
        assert_eq!(left.satellites().len(), 10);
        assert_eq!(
            names(&hybrid().without(&[0, 9]))[7],
            "NW-B-P02-S02".replace("B-P02-S02", "C-P01-S01")
        );
    }

    /// The end of an interval is excluded, and outside it states are those of the satellite.
    #[test]
    fn an_interval_leaves_a_gap() {
        let whole = hybrid();
        let outages = [
            outage("NW-A-P01-S01", Some(60.0..180.0)),
            outage("NW-A-P01-S01", Some(300.0..360.0)),
        ];
        let left = hybrid().with_outages(&outages);
        assert_eq!((left.satellites().len(), left.shells().len()), (10, 2));
        let [one, same] = [&left, &whole].map(|of| &of.satellites()[0]);
        for (elapsed_s, is_up) in [
            (0.0, true),
            (60.0, false),
            (179.0, false),
            (180.0, true),
            (300.0, false),
            (360.0, true),
        ] {
            let state = left.state_or_gap(one, elapsed_s).unwrap();
            let expected = whole.state(same, elapsed_s).unwrap();
            assert_eq!(state, is_up.then_some(expected), "{elapsed_s}");
        }
        // Throughout wins over an interval.
        let both = [
            outage("NW-A-P01-S01", Some(60.0..180.0)),
            outage("NW-A-P01", None),
        ];
        assert_eq!(hybrid().with_outages(&both).satellites().len(), 8);
    }

    #[test]
    fn intervals_without_effect_are_noted() {
        let grid = hybrid().grid();
        let note = |interval: Range<f64>| outage("NW-C", Some(interval)).note(grid);
        assert_eq!(note(60.0..61.0), None);
        assert_eq!(note(0.0..grid.elapsed_s(grid.len())), None);
        let between = note(61.0..120.0).unwrap();
        assert_eq!(
            between,
            "outages.satellites: NW-C is out of service from 2025-01-01T00:01:01Z to 2025-01-01T00:02:00Z, between two samples 60 s \
             apart: it has no effect"
        );
        for cut in [-1.0..61.0, 500.0..601.0] {
            let note = note(cut).unwrap();
            assert!(
                note.ends_with("2025-01-01T00:00:00Z to 2025-01-01T00:10:00Z"),
                "{note}"
            );
        }
        assert_eq!(outage("NW-C", None).note(grid), None);
    }

    #[test]
    fn names_are_of_the_constellation_or_of_a_gnss() {
        let systems = [("gps".to_owned(), vec!["A3".to_owned()])];
        let of = |names: &[&str]| {
            let outages: Vec<_> = names.iter().map(|name| outage(name, None)).collect();
            in_service("it", hybrid(), &outages, &systems)
        };
        assert_eq!(of(&["A3", "gps:A3", "NW-C"]).unwrap().satellites().len(), 8);
        let error = of(&["nw-a-p01-s09"]).err().unwrap().to_string();
        assert!(error.starts_with("outages.satellites: 'nw-a-p01-s09' is not a satellite or plane of it, nor a satellite of gps, did you mean 'NW-A-P01-S0"), "{error}");
        let error = of(&["NW-A", "NW-B", "NW-C"]).err().unwrap().to_string();
        assert_eq!(
            error,
            "all 10 satellites of it are out of service throughout"
        );
    }
}
