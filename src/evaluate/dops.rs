//! All dilutions of precision of a constellation with its GNSS, by the plain path.

use super::fixed::PlainPositions;
use super::{Evaluator, Setup, fixed, plain};
use crate::dop::{ClockGroup, Clocks, DopFamily};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::LocalFrame;
use crate::stats::{Level, Summary, Weighted, summarize_weighted};
use serde::Serialize;

/// Statistics of the dilutions of precision over the solved samples, weighted by point; `None` if
/// there are no samples.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DopStatistics {
    /// Position and clocks.
    pub gdop: Option<Summary>,
    /// Position.
    pub pdop: Option<Summary>,
    /// Horizontal position.
    pub hdop: Option<Summary>,
    /// Height.
    pub vdop: Option<Summary>,
    /// Clock by clock.
    pub tdop: Vec<ClockDop>,
    /// Fraction of the samples that are solved.
    pub solved_fraction: f64,
}

impl DopStatistics {
    /// Each dilution by name: GDOP, PDOP, HDOP, VDOP, and the TDOP of each clock.
    #[must_use]
    pub fn named(&self) -> Vec<(String, Option<Summary>)> {
        let clocks = self.tdop.iter().map(|clock| clock.system.as_str());
        let position = [self.gdop, self.pdop, self.hdop, self.vdop];
        let summaries = position
            .into_iter()
            .chain(self.tdop.iter().map(|clock| clock.tdop));
        names(clocks).into_iter().zip(summaries).collect()
    }
}

/// The names of the dilutions: of position, and of each clock.
fn names<'a>(clocks: impl Iterator<Item = &'a str>) -> Vec<String> {
    let position = ["GDOP", "PDOP", "HDOP", "VDOP"].map(str::to_owned);
    let clocks = clocks.map(|system| format!("TDOP {system}"));
    position.into_iter().chain(clocks).collect()
}

/// The dilution of precision of one clock.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ClockDop {
    /// The system of the clock: `leo`, or the name of a GNSS; `shared` for one clock of all.
    pub system: String,
    /// Statistics over the solved samples with a satellite of the system in view.
    pub tdop: Option<Summary>,
}

/// The samples of each quantity.
struct Collected {
    gdop: Vec<Weighted>,
    pdop: Vec<Weighted>,
    hdop: Vec<Weighted>,
    vdop: Vec<Weighted>,
    tdop: Vec<Vec<Weighted>>,
    solved_weight: f64,
    weight: f64,
}

impl Evaluator {
    /// Every dilution of precision of some satellites together with the GNSS of the setup.
    ///
    /// PDOP is that of the metrics.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn dops(&self, ephemeris: &Ephemeris) -> Result<DopStatistics, EphemerisError> {
        let setup = self.setup();
        let systems = fixed::systems(setup);
        let clocks = self.clock_names();
        let mut collected = Collected::new(clocks.len());
        let mut leo = Vec::with_capacity(ephemeris.satellites().len());
        for (elapsed_s, &rotation) in setup.grid.iter().zip(self.rotations.iter()) {
            plain::earth_fixed(ephemeris, elapsed_s, rotation, &mut leo)?;
            let gnss = fixed::positions(&systems, elapsed_s, rotation)?;
            for site in &setup.sites {
                let groups = groups(setup, &site.local, &leo, &gnss);
                let dops = DopFamily::of(&groups, &site.local, setup.pdop_cap);
                collected.add(dops.as_ref(), site.weight);
            }
        }
        Ok(collected.statistics(clocks, setup.metrics.cvar_level))
    }

    /// The names of the dilutions of precision, in the order of [`DopStatistics::named`].
    #[must_use]
    pub fn dop_names(&self) -> Vec<String> {
        let mut clocks = self.clock_names();
        clocks.rotate_right(1);
        names(clocks.iter().map(String::as_str))
    }

    /// The clocks in the order of [`groups`].
    fn clock_names(&self) -> Vec<String> {
        match self.setup().clocks {
            Clocks::Shared => vec!["shared".to_owned()],
            Clocks::PerSystem => {
                let gnss = self.setup().gnss.iter().map(|system| system.name());
                gnss.chain(["leo"]).map(str::to_owned).collect()
            }
        }
    }
}

/// The observations of each clock: the systems one by one and the LEO satellites last, or all in
/// one. The sums are those of [`plain::geometry`], so that the decisions are the same.
fn groups(
    setup: &Setup,
    site: &LocalFrame,
    leo: &PlainPositions,
    gnss: &[PlainPositions],
) -> Vec<ClockGroup> {
    let (_, mut leo) = plain::observe(setup, setup.mask, site, leo);
    let systems = gnss
        .iter()
        .map(|positions| plain::observe(setup, setup.gnss_mask, site, positions).1);
    match setup.clocks {
        Clocks::PerSystem => systems.chain([leo]).collect(),
        Clocks::Shared => {
            let mut shared = ClockGroup::default();
            systems.for_each(|system| shared += system);
            leo += shared;
            vec![leo]
        }
    }
}

impl Collected {
    fn new(clocks: usize) -> Self {
        Self {
            gdop: Vec::new(),
            pdop: Vec::new(),
            hdop: Vec::new(),
            vdop: Vec::new(),
            tdop: vec![Vec::new(); clocks],
            solved_weight: 0.0,
            weight: 0.0,
        }
    }

    fn add(&mut self, dops: Option<&DopFamily>, weight: f64) {
        self.weight += weight;
        let Some(dops) = dops else { return };
        self.solved_weight += weight;
        let weighted = |value: f64| Weighted { value, weight };
        self.gdop.push(weighted(dops.gdop));
        self.pdop.push(weighted(dops.pdop));
        self.hdop.push(weighted(dops.hdop));
        self.vdop.push(weighted(dops.vdop));
        for (samples, tdop) in self.tdop.iter_mut().zip(&dops.tdop) {
            samples.extend(tdop.map(weighted));
        }
    }

    fn statistics(mut self, clocks: Vec<String>, level: Level) -> DopStatistics {
        let clock = |(system, mut samples): (String, Vec<Weighted>)| ClockDop {
            system,
            tdop: summarize_weighted(&mut samples, level),
        };
        let mut tdop: Vec<_> = clocks.into_iter().zip(self.tdop).map(clock).collect();
        // The clock of the LEO satellites is named first.
        tdop.rotate_right(1);
        DopStatistics {
            gdop: summarize_weighted(&mut self.gdop, level),
            pdop: summarize_weighted(&mut self.pdop, level),
            hdop: summarize_weighted(&mut self.hdop, level),
            vdop: summarize_weighted(&mut self.vdop, level),
            tdop,
            solved_fraction: self.solved_weight / self.weight,
        }
    }
}
