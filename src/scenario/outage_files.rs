//! The satellites of a study that are out of service, from names and files.

use super::Scenario;
use super::setup::SetupError;
use crate::ephemeris::outages::SatelliteOutage;
use crate::formats::outages::{self, OutageInterval};
use crate::time::TimeGrid;
use std::io;

impl Scenario {
    /// The outages of the scenario, those throughout before those of an interval.
    pub(super) fn satellite_outages(
        &self,
        grid: TimeGrid,
        read: &dyn Fn(&str) -> io::Result<Vec<u8>>,
    ) -> Result<Vec<SatelliteOutage>, SetupError> {
        let throughout = |name: &String| SatelliteOutage {
            satellite: name.clone(),
            origin: "outages.satellites (--without)".to_owned(),
            interval_s: None,
        };
        let mut found: Vec<_> = self.outages.satellites.iter().map(throughout).collect();
        for file in &self.outages.file {
            let bytes = read(file).map_err(|source| self.unreadable(file, source))?;
            let refused = |reason: String| SetupError::OutageFile {
                file: file.clone(),
                reason,
            };
            let intervals = outages::read(&bytes).map_err(|error| refused(error.to_string()))?;
            for interval in &intervals {
                found.push(of_interval(file, interval, grid).map_err(refused)?);
            }
        }
        Ok(found)
    }
}

/// An interval in seconds since the epoch of the study.
fn of_interval(
    file: &str,
    interval: &OutageInterval,
    grid: TimeGrid,
) -> Result<SatelliteOutage, String> {
    let OutageInterval {
        satellite,
        start,
        end,
        line,
    } = interval;
    let name = file.rsplit('/').next().unwrap_or(file);
    let [start_s, end_s] = [start, end].map(|at| at.seconds_since(grid.epoch()));
    let span_s = grid.elapsed_s(grid.len());
    if end_s <= 0.0 || start_s >= span_s {
        let (first, last) = (grid.epoch(), grid.epoch().plus_seconds(span_s));
        return Err(format!(
            "line {line}: {start} to {end} is outside the span of the study, {first} to {last}"
        ));
    }
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    Ok(SatelliteOutage {
        satellite: satellite.as_deref().unwrap_or(stem).to_owned(),
        origin: format!("{name}, line {line}"),
        interval_s: Some(start_s..end_s),
    })
}
