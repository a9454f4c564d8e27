//! All dilutions of precision of a constellation with its GNSS, by the plain path.

use super::{Evaluator, Setup, plain};
use crate::dop::{ClockGroup, Clocks, DopFamily};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::{EarthFixed, LocalFrame, Position};
use crate::stats::{Level, Summary, Weighted, summarize_weighted};
use crate::visibility::Mask;
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
        let fixed = [
            ("GDOP", self.gdop),
            ("PDOP", self.pdop),
            ("HDOP", self.hdop),
            ("VDOP", self.vdop),
        ];
        let mut named: Vec<_> = fixed
            .into_iter()
            .map(|(name, summary)| (name.to_owned(), summary))
            .collect();
        named.extend(
            self.tdop
                .iter()
                .map(|clock| (format!("TDOP {}", clock.system), clock.tdop)),
        );
        named
    }
}

/// The dilution of precision of one clock.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ClockDop {
    /// The system of the clock: `leo`, or the name of a GNSS; `shared` for one clock of all.
    pub system: String,
    /// Statistics over the solved samples with a satellite of the system in view.
    pub tdop: Option<Summary>,
}

/// Satellites observed above one mask with one clock.
struct View<'a> {
    ephemeris: &'a Ephemeris,
    mask: Mask,
    clock: usize,
    positions: Vec<Position<EarthFixed>>,
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
        let systems: Vec<_> = setup
            .gnss
            .iter()
            .map(|system| Ephemeris::of_gnss(system.satellites(setup.grid.epoch()), setup.grid))
            .collect();
        let clocks = self.clock_names();
        let clock = |n: usize| n.min(clocks.len() - 1);
        let mut views = vec![View::new(ephemeris, setup.mask, 0)];
        let gnss = systems.iter().enumerate();
        views.extend(gnss.map(|(n, system)| View::new(system, setup.gnss_mask, clock(n + 1))));

        let mut collected = Collected::new(clocks.len());
        let mut groups = Vec::new();
        for time in 0..setup.grid.len() {
            for view in &mut views {
                plain::earth_fixed(self, view.ephemeris, time, &mut view.positions)?;
            }
            for site in &setup.sites {
                groups.clear();
                groups.resize(clocks.len(), ClockGroup::default());
                for view in &views {
                    view.observe(setup, &site.local, &mut groups[view.clock]);
                }
                let dops = DopFamily::of(&groups, &site.local, setup.pdop_cap);
                collected.add(dops.as_ref(), site.weight);
            }
        }
        Ok(collected.statistics(clocks, setup.metrics.cvar_level))
    }

    fn clock_names(&self) -> Vec<String> {
        match self.setup().clocks {
            Clocks::Shared => vec!["shared".to_owned()],
            Clocks::PerSystem => {
                let gnss = self.setup().gnss.iter().map(|system| system.name());
                std::iter::once("leo")
                    .chain(gnss)
                    .map(str::to_owned)
                    .collect()
            }
        }
    }
}

impl<'a> View<'a> {
    fn new(ephemeris: &'a Ephemeris, mask: Mask, clock: usize) -> Self {
        Self {
            ephemeris,
            mask,
            clock,
            positions: Vec::with_capacity(ephemeris.satellites().len()),
        }
    }

    fn observe(&self, setup: &Setup, site: &LocalFrame, group: &mut ClockGroup) {
        for &position in &self.positions {
            if let Some(unit) = setup.line_of_sight(self.mask, site, position) {
                group.add(unit, setup.observation_weight(site, unit));
            }
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
        DopStatistics {
            gdop: summarize_weighted(&mut self.gdop, level),
            pdop: summarize_weighted(&mut self.pdop, level),
            hdop: summarize_weighted(&mut self.hdop, level),
            vdop: summarize_weighted(&mut self.vdop, level),
            tdop: clocks.into_iter().zip(self.tdop).map(clock).collect(),
            solved_fraction: self.solved_weight / self.weight,
        }
    }
}
