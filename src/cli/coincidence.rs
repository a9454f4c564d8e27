//! The warnings about satellites in one place, and about satellites that meet.

use crate::cli::output;
use crate::constellation::gnss::System;
use crate::ephemeris::Ephemeris;
use crate::ephemeris::coincidence::{COINCIDENT_WITHIN_KM, SatellitePlace, coincident};
use crate::ephemeris::meetings::{MEET_WITHIN_KM, Meeting, meetings};
use crate::time::TimeGrid;

/// Maximum number of groups, and of members of a group, to name.
const NAMED: usize = 3;

/// Warns of coincident satellites among the constellation and the GNSS. A satellite that cannot be
/// propagated is ignored here; the command itself reports it.
pub(crate) fn warn(gnss: &[System], grid: TimeGrid, leo: Option<&Ephemeris>) {
    let systems: Vec<Ephemeris> = gnss
        .iter()
        .map(|system| Ephemeris::of_gnss(system.satellites(grid.epoch()), grid))
        .collect();
    let all: Vec<&Ephemeris> = leo.into_iter().chain(&systems).collect();
    if let Ok(groups) = coincident(&all)
        && !groups.is_empty()
    {
        output::warning(&text(&all, &groups));
    }
}

/// Warns of satellites of a constellation that meet. One that cannot be propagated is ignored here.
pub(crate) fn warn_of_meetings(name: &str, ephemeris: &Ephemeris) {
    let Ok(Some(found)) = meetings(ephemeris) else {
        return;
    };
    let told = |meeting: Meeting| {
        let [a, b] = meeting
            .pair
            .map(|place| &ephemeris.satellites()[place].name);
        let at = ephemeris.grid().epoch().plus_seconds(meeting.elapsed_s);
        let distance_km = meeting.distance_km;
        format!("{a} and {b} are {distance_km:.3} km apart at {at}")
    };
    let closest = match found.count {
        1 => String::new(),
        count if found.closest == found.first => {
            format!(", the closest of {count} meetings at the samples")
        }
        count => format!(
            "; the closest of {count} meetings at the samples: {}",
            told(found.closest)
        ),
    };
    output::warning(&format!(
        "{name}: satellites come within {MEET_WITHIN_KM} km of each other: {}{closest}",
        told(found.first)
    ));
}

fn text(all: &[&Ephemeris], groups: &[Vec<SatellitePlace>]) -> String {
    let satellites: usize = groups.iter().map(Vec::len).sum();
    let name = |&(number, place): &SatellitePlace| all[number].satellites()[place].name.clone();
    let members = |group: &Vec<SatellitePlace>| {
        listed(&group.iter().map(name).collect::<Vec<_>>(), " = ", "more")
    };
    let named: Vec<String> = groups.iter().map(members).collect();
    let places = match groups.len() {
        1 => "one place".to_owned(),
        count => format!("{count} places"),
    };
    format!(
        "{satellites} satellites are in {places}, within {} m of each other all the time ({}): each \
         counts as visible, but together they are one direction",
        COINCIDENT_WITHIN_KM * 1000.0,
        listed(&named, "; ", "more places")
    )
}

/// The first few names, and how many more there are.
fn listed(names: &[String], between: &str, rest: &str) -> String {
    let shown = names[..names.len().min(NAMED)].join(between);
    match names.len().saturating_sub(NAMED) {
        0 => shown,
        more => format!("{shown}{between}{more} {rest}"),
    }
}
