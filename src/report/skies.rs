//! The dilutions of precision of skies, as text, JSON and CSV.

use super::{Align, Table};
use crate::dop::{DopFamily, SkyClock, SkyRule, SkyView};
use crate::run::columns::optional;
use crate::run::tables::text;
use ::csv::Writer;
use serde::Serialize;
use std::io;

/// A sky with its dilutions of precision.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SkyResult {
    /// Its name, if the table names skies.
    pub sky: Option<String>,
    /// Satellites used.
    pub satellites: usize,
    /// Satellites below the mask.
    pub below_mask: usize,
    /// Of position and clocks; `None` if unsolved, as all of them.
    pub gdop: Option<f64>,
    /// Of position.
    pub pdop: Option<f64>,
    /// Of the horizontal position.
    pub hdop: Option<f64>,
    /// Of the height.
    pub vdop: Option<f64>,
    /// Of the clock; of several, the first.
    pub tdop: Option<f64>,
    /// Every clock.
    pub clocks: Vec<SkyClockResult>,
    /// Why there are no dilutions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unsolved: Option<String>,
}

/// A clock of a sky.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SkyClockResult {
    /// The system; `shared` for one clock of all.
    pub system: String,
    /// Satellites used with it.
    pub satellites: usize,
    /// Its dilution of precision.
    pub tdop: Option<f64>,
}

impl SkyResult {
    /// The result of a sky.
    #[must_use]
    pub fn new(sky: &SkyView, rule: SkyRule) -> Self {
        let found = sky.dops(rule);
        let of = |dilution: fn(&DopFamily) -> f64| found.dops.as_ref().map(dilution);
        let clock = |clock: &SkyClock| SkyClockResult {
            system: clock.system.clone(),
            satellites: clock.satellites,
            tdop: clock.tdop,
        };
        Self {
            sky: sky.name.clone(),
            satellites: found.satellites,
            below_mask: found.below_mask,
            gdop: of(|dops| dops.gdop),
            pdop: of(|dops| dops.pdop),
            hdop: of(|dops| dops.hdop),
            vdop: of(|dops| dops.vdop),
            tdop: found.tdop(),
            clocks: found.clocks.iter().map(clock).collect(),
            unsolved: found.unsolved(),
        }
    }

    fn dilutions(&self) -> [Option<f64>; 5] {
        [self.gdop, self.pdop, self.hdop, self.vdop, self.tdop]
    }

    fn clock(&self, system: &str) -> Option<f64> {
        let clock = self.clocks.iter().find(|clock| clock.system == system);
        clock.and_then(|clock| clock.tdop)
    }
}

/// The systems of all skies, if there is more than one.
fn systems(skies: &[SkyResult]) -> Vec<&str> {
    let mut systems = Vec::new();
    for clock in skies.iter().flat_map(|sky| &sky.clocks) {
        if !systems.contains(&clock.system.as_str()) {
            systems.push(clock.system.as_str());
        }
    }
    if systems.len() < 2 {
        systems.clear();
    }
    systems
}

/// The skies for a terminal.
#[must_use]
pub fn skies_text(skies: &[SkyResult]) -> String {
    let systems = systems(skies);
    let clocks: Vec<String> = systems
        .iter()
        .map(|system| format!("TDOP\n{system}"))
        .collect();
    let mut columns = vec![
        ("sky", Align::Left),
        ("satellites", Align::Right),
        ("below\nmask", Align::Right),
        ("GDOP", Align::Right),
        ("PDOP", Align::Right),
        ("HDOP", Align::Right),
        ("VDOP", Align::Right),
    ];
    match clocks.as_slice() {
        [] => columns.push(("TDOP", Align::Right)),
        several => columns.extend(several.iter().map(|name| (name.as_str(), Align::Right))),
    }
    let shown = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |x| format!("{x:.4}"));
    let mut table = Table::new(&columns);
    for sky in skies {
        let mut cells = vec![
            sky.sky.clone().unwrap_or_else(|| "1".to_owned()),
            sky.satellites.to_string(),
            sky.below_mask.to_string(),
        ];
        let position = if systems.is_empty() { 5 } else { 4 };
        cells.extend(sky.dilutions()[..position].iter().copied().map(shown));
        cells.extend(systems.iter().map(|system| shown(sky.clock(system))));
        table.row(cells);
    }
    table.to_text()
}

/// The skies, one per row; with several systems a column for each clock.
///
/// # Errors
/// Never for a table in memory.
pub fn skies_csv(skies: &[SkyResult]) -> io::Result<String> {
    let systems = systems(skies);
    let mut writer = Writer::from_writer(Vec::new());
    let header = [
        "sky",
        "satellites",
        "below_mask",
        "gdop",
        "pdop",
        "hdop",
        "vdop",
        "tdop",
    ];
    let clocks = systems.iter().map(|system| format!("tdop_{system}"));
    writer.write_record(header.into_iter().map(str::to_owned).chain(clocks))?;
    for sky in skies {
        let mut row = vec![
            sky.sky.clone().unwrap_or_default(),
            sky.satellites.to_string(),
            sky.below_mask.to_string(),
        ];
        row.extend(sky.dilutions().map(optional));
        row.extend(systems.iter().map(|system| optional(sky.clock(system))));
        writer.write_record(row)?;
    }
    text(writer)
}
