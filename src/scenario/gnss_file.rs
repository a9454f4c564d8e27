//! The navigation systems of a file: element sets, almanacs, or states such as those of SP3.
//!
//! A file of one system is named by the file. One of several is split by the letter of SP3 or by the names that
//! catalogues use, so that each system keeps a clock of its own.

use super::setup::GnssFileError;
use crate::constellation::gnss::{
    ElementSets, GivenOrbit, GnssOrbit, GnssSatellite, StaleElements, System,
};
use crate::ephemeris::EphemerisSatellite;
use crate::exchange::import::Fleet;
use crate::orbit::Model;
use crate::time::TimeGrid;
use std::sync::Arc;

/// The systems of the files, with notes for the user.
#[derive(Default)]
pub(super) struct GnssFile {
    pub(super) systems: Vec<System>,
    pub(super) notes: Vec<String>,
}

/// Files of a scenario read so far but not yet split into systems, since the states of a satellite may continue in
/// the next file.
#[derive(Default)]
pub(super) struct GnssFiles {
    found: GnssFile,
    /// Files of states, each with its name; one that continues the satellites of an earlier one is joined to it.
    sampled: Vec<(String, Fleet)>,
}

impl GnssFiles {
    /// Adds the systems of a file.
    pub(super) fn add(
        &mut self,
        file: &str,
        bytes: &[u8],
        grid: TimeGrid,
    ) -> Result<(), GnssFileError> {
        let file_name = file.rsplit('/').next().unwrap_or(file);
        let read = Fleet::read(bytes, None, Some(file_name))?;
        if !read.left_out.is_empty() {
            self.found.notes.push(format!("{file}: {}", read.left_out));
        }
        let name = file_name.strip_suffix(".gz").unwrap_or(file_name);
        let name = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
        match read.fleet {
            Fleet::Sets(sets) => {
                let groups = by_system(name, sets, |set| set.object_name.as_deref().unwrap_or(""));
                for (name, sets) in groups {
                    let system = ElementSets::new(&name, &sets)?;
                    let stale = system.stale(grid);
                    self.found
                        .notes
                        .extend(stale.as_ref().map(StaleElements::to_string));
                    self.found.systems.push(system.into());
                }
            }
            more @ Fleet::Sampled(_) => {
                let labels = more.labels();
                let continues =
                    |known: &Fleet| known.labels().iter().any(|label| labels.contains(label));
                match self.sampled.iter_mut().find(|(_, known)| continues(known)) {
                    Some((_, known)) => known.append(more),
                    None => self.sampled.push((name.to_owned(), more)),
                }
            }
            Fleet::Elements(_) => {
                let content = read.fleet.content();
                return Err(GnssFileError::NoSets { content });
            }
            other => {
                let stale = other.stale(name, grid);
                let notes = &mut self.found.notes;
                notes.extend(stale.as_ref().map(StaleElements::to_string));
                self.propagate(name, &other, grid)?;
            }
        }
        Ok(())
    }

    /// The systems, those of states last.
    pub(super) fn finish(mut self, grid: TimeGrid) -> Result<GnssFile, GnssFileError> {
        for (name, sampled) in std::mem::take(&mut self.sampled) {
            self.propagate(&name, &sampled, grid)?;
        }
        Ok(self.found)
    }

    fn propagate(
        &mut self,
        name: &str,
        fleet: &Fleet,
        grid: TimeGrid,
    ) -> Result<(), GnssFileError> {
        let notes = fleet.sampling_notes(grid);
        self.found
            .notes
            .extend(notes.iter().map(|note| format!("gnss.files: {note}")));
        // These files have no mean elements, which are the only input that needs a model.
        let ephemeris = fleet.propagate_continuously(grid, Model::J2)?;
        let groups = by_system(name, ephemeris.into_satellites(), |one| &one.name);
        for (name, satellites) in groups {
            let given = |satellite: EphemerisSatellite| GnssSatellite {
                name: satellite.name,
                orbit: GnssOrbit::Given(GivenOrbit(Arc::from(satellite.propagator))),
            };
            let satellites = satellites.into_iter().map(given).collect();
            self.found.systems.push(System::Listed { name, satellites });
        }
        Ok(())
    }
}

/// Satellites by system, in order of first appearance; a single system is named after the file.
fn by_system<T>(
    file: &str,
    satellites: Vec<T>,
    name: impl Fn(&T) -> &str,
) -> Vec<(String, Vec<T>)> {
    let mut groups: Vec<(&str, Vec<T>)> = Vec::new();
    for satellite in satellites {
        let system = system_of(name(&satellite)).unwrap_or("other");
        match groups.iter_mut().find(|(known, _)| *known == system) {
            Some((_, group)) => group.push(satellite),
            None => groups.push((system, vec![satellite])),
        }
    }
    if let [(_, _)] = groups.as_slice() {
        let only = groups
            .into_iter()
            .map(|(_, group)| (file.to_owned(), group));
        return only.collect();
    }
    let named = groups
        .into_iter()
        .map(|(system, group)| (format!("{file}-{system}"), group));
    named.collect()
}

/// The system of a satellite by its id in SP3, its number in an almanac, or its name in a catalogue.
fn system_of(name: &str) -> Option<&'static str> {
    let name = name.trim().to_ascii_uppercase();
    if let [letter, b'0'..=b'9', b'0'..=b'9'] = name.as_bytes() {
        return of_letter(*letter);
    }
    if let Some(number) = name
        .strip_prefix("PRN-")
        .and_then(|number| number.parse::<u32>().ok())
    {
        return match number {
            1..=63 => Some("gps"),
            193..=202 => Some("qzss"),
            _ => None,
        };
    }
    let has = |starts: &[&str]| starts.iter().any(|start| name.starts_with(start));
    Some(match () {
        () if has(&["GPS", "NAVSTAR"]) => "gps",
        () if has(&["GLONASS", "COSMOS"]) => "glonass",
        () if has(&["GALILEO", "GSAT0", "GIOVE"]) => "galileo",
        () if has(&["BEIDOU"]) => "beidou",
        () if has(&["QZS", "MICHIBIKI"]) => "qzss",
        () if has(&["IRNSS", "NVS-"]) => "navic",
        () => return None,
    })
}

/// The letters of SP3-d ("satellite id").
fn of_letter(letter: u8) -> Option<&'static str> {
    Some(match letter {
        b'G' => "gps",
        b'R' => "glonass",
        b'E' => "galileo",
        b'C' => "beidou",
        b'J' => "qzss",
        b'I' => "navic",
        b'S' => "sbas",
        b'L' => "leo",
        _ => return None,
    })
}

#[cfg(test)]
mod tests;
