//! All dilutions of precision of a constellation with its GNSS.

use super::fixed::PlainPositions;
use super::{Evaluator, Metrics, Setup, fixed, leo, plain};
use crate::dop::{ClockGroup, Clocks, DopFamily};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::ground::Site;
use crate::stats::{Level, Summary, Weighted, weighted_quantile};
use serde::Serialize;

/// The place of the first clock among the dilutions of the kernel: GDOP, HDOP and VDOP come before.
pub(super) const CLOCKS_FROM: usize = 3;

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
    /// The system of the clock: `leo`, or the name of a GNSS; `shared` for one clock of all. Several LEO clocks
    /// are one entry, with a sample for each clock.
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
}

impl Evaluator {
    /// Every dilution of precision of some satellites together with the GNSS of the setup.
    ///
    /// PDOP is that of the metrics.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn dops(&self, ephemeris: &Ephemeris) -> Result<DopStatistics, EphemerisError> {
        let (metrics, ..) = self.counted(ephemeris, false)?;
        self.dops_beside(&metrics, ephemeris)
    }

    /// The same of satellites that have these metrics.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn dops_beside(
        &self,
        metrics: &Metrics,
        ephemeris: &Ephemeris,
    ) -> Result<DopStatistics, EphemerisError> {
        let summaries = self.kernel.dops(ephemeris)?;
        let clocks = self.clock_names().into_iter();
        let tdop = clocks.zip(&summaries[CLOCKS_FROM..]);
        let mut tdop: Vec<_> = tdop
            .map(|(system, &tdop)| ClockDop { system, tdop })
            .collect();
        tdop.rotate_right(1);
        Ok(DopStatistics {
            gdop: summaries[0],
            pdop: metrics.pdop_summary(),
            hdop: summaries[1],
            vdop: summaries[2],
            tdop,
            solved_fraction: metrics.solved_fraction,
        })
    }

    /// The same by the plain path, the reference for the kernel.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    #[cfg(test)]
    pub(super) fn dops_plain(
        &self,
        ephemeris: &Ephemeris,
    ) -> Result<DopStatistics, EphemerisError> {
        let collected = self.collected(ephemeris)?;
        let level = self.setup().metrics.cvar_level;
        Ok(collected.statistics(self.clock_names(), level, self.weights.total()))
    }

    /// The quantile of level `q` of each dilution of the solved samples, in the order of [`DopStatistics::named`], by
    /// the plain path; `None` for one without samples.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn dop_quantiles(
        &self,
        ephemeris: &Ephemeris,
        q: Level,
    ) -> Result<Vec<Option<f64>>, EphemerisError> {
        let mut collected = self.collected(ephemeris)?;
        let position = [
            &mut collected.gdop,
            &mut collected.pdop,
            &mut collected.hdop,
            &mut collected.vdop,
        ];
        let position = position.map(|samples| weighted_quantile(samples, q));
        let clocks = collected.tdop.iter_mut();
        let mut clocks: Vec<_> = clocks
            .map(|samples| weighted_quantile(samples, q))
            .collect();
        // The clock of the LEO satellites is named first.
        clocks.rotate_right(1);
        Ok(position.into_iter().chain(clocks).collect())
    }

    /// The samples of each dilution, by the plain path.
    fn collected(&self, ephemeris: &Ephemeris) -> Result<Collected, EphemerisError> {
        let setup = self.setup();
        let systems = fixed::systems(setup);
        let mut collected = Collected::new(self.clock_names().len());
        let mut leo = Vec::new();
        for (elapsed_s, &rotation) in setup.grid.iter().zip(self.rotations.iter()) {
            leo::positions(setup, ephemeris, elapsed_s, rotation, &mut leo)?;
            let gnss = fixed::positions(&systems, elapsed_s, rotation)?;
            for (number, site) in setup.sites.iter().enumerate() {
                let groups = groups(setup, site, &leo, &gnss);
                let dops = DopFamily::of(&groups, &site.local, setup.pdop_cap);
                collected.add(dops.as_ref(), self.weights.of(number));
            }
        }
        Ok(collected)
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

/// The observations of each clock: the systems one by one and the LEO clocks last, or all in
/// one. The sums are those of [`plain::geometry`], so that the decisions are the same.
pub(super) fn groups(
    setup: &Setup,
    site: &Site,
    leo: &[PlainPositions],
    gnss: &[PlainPositions],
) -> Vec<ClockGroup> {
    let leo = leo
        .iter()
        .map(|positions| plain::observe(setup, setup.mask, site, positions).1);
    let systems = gnss
        .iter()
        .map(|positions| plain::observe(setup, setup.gnss_mask, site, positions).1);
    match setup.clocks {
        Clocks::PerSystem => systems.chain(leo).collect(),
        Clocks::Shared => {
            let mut shared = ClockGroup::default();
            systems.for_each(|system| shared += system);
            let with_gnss = |mut leo: ClockGroup| {
                leo += shared;
                leo
            };
            leo.map(with_gnss).collect()
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
        }
    }

    fn add(&mut self, dops: Option<&DopFamily>, weight: u64) {
        let Some(dops) = dops else { return };
        let weight = weight as f64;
        let weighted = |value: f64| Weighted { value, weight };
        self.gdop.push(weighted(dops.gdop));
        self.pdop.push(weighted(dops.pdop));
        self.hdop.push(weighted(dops.hdop));
        self.vdop.push(weighted(dops.vdop));
        // The last entry is that of all LEO clocks.
        let last = self.tdop.len() - 1;
        for (clock, tdop) in dops.tdop.iter().enumerate() {
            self.tdop[clock.min(last)].extend(tdop.map(weighted));
        }
    }

    /// With the weight of all samples.
    #[cfg(test)]
    fn statistics(mut self, clocks: Vec<String>, level: Level, total: u64) -> DopStatistics {
        let solved: f64 = self.pdop.iter().map(|sample| sample.weight).sum();
        use crate::stats::summarize_weighted;
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
            solved_fraction: solved / total as f64,
        }
    }
}
