//! The second stage: what was written becomes a [`Scenario`], or a list of problems.

use super::keys::table::{self, MOST_SATELLITES};
use super::keys::{AnyKey, Key};
use super::problem::{Fault, Report};
use super::resolved::{
    Earth, Export, GnssSetup, Grid, Objectives, Optimizer, Propagation, Region, Scenario,
    SearchSpace, TimeSpan, Visibility,
};
use super::rule::{Reading, Rule};
use super::written::Written;
use super::{Algorithm, LaunchCost, PointWeights, Quantity};
use crate::earth::RADIUS_KM;

/// Samples in time: 366 days at every 3.2 seconds.
const MOST_SAMPLES: u64 = 10_000_000;
/// Points of a grid: the globe at every quarter of a degree.
const MOST_POINTS: u64 = 1_040_000;
/// Points times samples: beyond, one evaluation takes gigabytes.
const MOST_POINT_SAMPLES: u64 = 1_000_000_000;
/// Designs of an exhaustive search: weeks of a machine.
const MOST_DESIGNS: u64 = 1_000_000_000;

/// Checks everything that was written, and adds what is wrong to `report`.
///
/// `None` only if something is wrong.
pub(super) fn resolve(written: &Written<'_>, report: &mut Report) -> Option<Scenario> {
    let mut resolver = Resolver { written, report };
    let name = resolver.value(&table::NAME);
    let reference_design = resolver.value(&table::REFERENCE_DESIGN);
    let time = resolver.time();
    let surface = resolver.value(&table::SURFACE);
    let model = resolver.value(&table::MODEL);
    let region = resolver.region();
    let visibility = resolver.visibility();
    let gnss = resolver.gnss();
    let objectives = resolver.objectives();
    let search = resolver.search();
    let optimizer = resolver.optimizer();
    let export = resolver.export(time.as_ref());
    let scenario = Scenario {
        name: name?,
        reference_design: reference_design?,
        time: time?,
        earth: Earth { surface: surface? },
        propagation: Propagation { model: model? },
        region: region?,
        visibility: visibility?,
        gnss: gnss?,
        objectives: objectives?,
        search: search?,
        optimizer: optimizer?,
        export: export?,
    };
    resolver.size(&scenario)?;
    Some(scenario)
}

struct Resolver<'w, 'a> {
    written: &'w Written<'a>,
    report: &'w mut Report,
}

impl Resolver<'_, '_> {
    /// The value of a key or its default; `None` where it is given and wrong.
    fn value<R: Rule>(&mut self, key: &Key<R>) -> Option<R::Value> {
        self.value_or(key, || Some(key.otherwise.value()))
    }

    fn value_or<R: Rule>(
        &mut self,
        key: &Key<R>,
        otherwise: impl FnOnce() -> Option<R::Value>,
    ) -> Option<R::Value> {
        let Some(entry) = self.written.entry(key) else {
            return otherwise();
        };
        let mut reading = Reading {
            source: &entry.source,
            key: key.path(),
            accepted: key.accepted(),
            report: self.report,
        };
        key.rule.read(&entry.value, &mut reading)
    }

    fn report(&mut self, keys: &[&dyn AnyKey], fault: Fault) {
        self.written.report_between(keys, fault, self.report);
    }

    fn at_most(
        &mut self,
        most: u64,
        count: f64,
        what: &'static str,
        keys: &[&dyn AnyKey],
    ) -> Option<()> {
        // A count that overflowed to infinity is too many as well.
        if count <= most as f64 {
            return Some(());
        }
        self.report(keys, Fault::TooMany { what, count, most });
        None
    }

    fn time(&mut self) -> Option<TimeSpan> {
        let epoch = self.value(&table::EPOCH);
        let duration_h = self.value(&table::DURATION_H);
        let step_s = self.value(&table::STEP_S);
        let span = TimeSpan {
            epoch: epoch?,
            duration_h: duration_h?,
            step_s: step_s?,
        };
        let keys: [&dyn AnyKey; 2] = [&table::STEP_S, &table::DURATION_H];
        self.at_most(MOST_SAMPLES, span.steps(), "samples in time", &keys)?;
        Some(span)
    }

    fn region(&mut self) -> Option<Region> {
        let grid = self.grid();
        if self.written.entry(&table::POINTS).is_none() {
            return grid.map(Region::Grid);
        }
        let file = self.value(&table::POINTS);
        let rivals: [&dyn AnyKey; 4] = [
            &table::LATITUDE_DEG,
            &table::LONGITUDE_DEG,
            &table::STEP_DEG,
            &table::WEIGHTS,
        ];
        let mut alone = true;
        for rival in rivals {
            if self.written.entry(rival).is_some() {
                self.report(
                    &[rival],
                    Fault::Excluded {
                        other: table::POINTS.path(),
                    },
                );
                alone = false;
            }
        }
        file.filter(|_| alone).map(|file| Region::Points { file })
    }

    fn grid(&mut self) -> Option<Grid> {
        let latitude_deg = self.value(&table::LATITUDE_DEG);
        let longitude_deg = self.value(&table::LONGITUDE_DEG);
        let step_deg = self.value(&table::STEP_DEG);
        let weights = self.value(&table::WEIGHTS);
        let grid = Grid {
            latitude_deg: latitude_deg?,
            longitude_deg: longitude_deg?,
            step_deg: step_deg?,
            weights: weights?,
        };
        let keys: [&dyn AnyKey; 3] = [
            &table::STEP_DEG,
            &table::LATITUDE_DEG,
            &table::LONGITUDE_DEG,
        ];
        self.at_most(MOST_POINTS, grid.points(), "grid points", &keys)?;
        if grid.weights == PointWeights::CosLatitude && grid.only_poles() {
            self.report(&[&table::LATITUDE_DEG, &table::WEIGHTS], Fault::Weightless);
            return None;
        }
        Some(grid)
    }

    fn visibility(&mut self) -> Option<Visibility> {
        let mask_deg = self.value(&table::MASK_DEG);
        let gnss_mask_deg = self.value_or(&table::GNSS_MASK_DEG, || mask_deg);
        let mask_table = self.value(&table::MASK_TABLE);
        let weighting = self.value(&table::WEIGHTING);
        let pdop_cap = self.value(&table::PDOP_CAP);
        Some(Visibility {
            mask_deg: mask_deg?,
            gnss_mask_deg: gnss_mask_deg?,
            mask_table: mask_table?,
            weighting: weighting?,
            pdop_cap: pdop_cap?,
        })
    }

    fn gnss(&mut self) -> Option<GnssSetup> {
        let constellations = self.value(&table::CONSTELLATIONS);
        let files = self.value(&table::FILES);
        let clocks = self.value(&table::CLOCKS);
        Some(GnssSetup {
            constellations: constellations?,
            files: files?,
            clocks: clocks?,
        })
    }

    fn objectives(&mut self) -> Option<Objectives> {
        let minimize = self.value(&table::MINIMIZE);
        let cvar_weight = self.value(&table::CVAR_WEIGHT);
        let cvar_level = self.value(&table::CVAR_LEVEL);
        let constraints = self.value(&table::CONSTRAINTS);
        let availability_pdop = self.value(&table::AVAILABILITY_PDOP);
        let launch_cost = self.launch_cost();
        let reference = self.hypervolume_reference(minimize.as_deref());
        Some(Objectives {
            minimize: minimize?,
            cvar_weight: cvar_weight?,
            cvar_level: cvar_level?,
            constraints: constraints?,
            availability_pdop: availability_pdop?,
            launch_cost: launch_cost?,
            hypervolume_reference: reference?,
        })
    }

    fn launch_cost(&mut self) -> Option<LaunchCost> {
        let per_satellite = self.value(&table::LAUNCH_COST_PER_SATELLITE);
        let per_plane = self.value(&table::LAUNCH_COST_PER_PLANE);
        let per_1000_km = self.value(&table::LAUNCH_COST_PER_1000_KM);
        Some(LaunchCost {
            per_satellite: per_satellite?,
            per_plane: per_plane?,
            per_1000_km: per_1000_km?,
        })
    }

    /// The reference point as given, or the usual one of the objectives if they have one. The outer
    /// `None` says that it was given and is wrong.
    fn hypervolume_reference(&mut self, minimize: Option<&[Quantity]>) -> Option<Option<Vec<f64>>> {
        let key = &table::HYPERVOLUME_REFERENCE;
        if self.written.entry(key).is_none() {
            let usual = minimize?
                .iter()
                .map(|quantity| quantity.default_reference());
            return Some(usual.collect());
        }
        let reference = self.value(key)?;
        let (found, expected) = (reference.len(), minimize?.len());
        if found != expected {
            self.report(&[key], Fault::Length { found, expected });
            return None;
        }
        Some(Some(reference))
    }

    fn search(&mut self) -> Option<SearchSpace> {
        let pattern = self.value(&table::PATTERN);
        let planes = self.value(&table::PLANES);
        let satellites_per_plane = self.value(&table::SATELLITES_PER_PLANE);
        let inclination_deg = self.value(&table::INCLINATION_DEG);
        let altitude_km = self.value(&table::ALTITUDE_KM);
        let phasing = self.phasing(planes);
        let eccentricity = self.value(&table::ECCENTRICITY);
        let arg_perigee_deg = self.value(&table::ARG_PERIGEE_DEG);
        let eccentricity_step = self.value(&table::ECCENTRICITY_STEP);
        let arg_perigee_step_deg = self.value(&table::ARG_PERIGEE_STEP_DEG);
        let inclination_step_deg = self.value(&table::INCLINATION_STEP_DEG);
        let altitude_step_km = self.value(&table::ALTITUDE_STEP_KM);
        let space = SearchSpace {
            pattern: pattern?,
            planes: planes?,
            satellites_per_plane: satellites_per_plane?,
            inclination_deg: inclination_deg?,
            altitude_km: altitude_km?,
            phasing: phasing?,
            eccentricity: eccentricity?,
            arg_perigee_deg: arg_perigee_deg?,
            eccentricity_step: eccentricity_step?,
            arg_perigee_step_deg: arg_perigee_step_deg?,
            inclination_step_deg: inclination_step_deg?,
            altitude_step_km: altitude_step_km?,
        };
        let satellites = f64::from(space.planes[1]) * f64::from(space.satellites_per_plane[1]);
        let keys: [&dyn AnyKey; 2] = [&table::PLANES, &table::SATELLITES_PER_PLANE];
        self.at_most(
            MOST_SATELLITES.into(),
            satellites,
            "satellites in a design",
            &keys,
        )?;
        self.above_ground(&space)?;
        Some(space)
    }

    /// At least the roundest and highest design of a search has its perigee above ground.
    fn above_ground(&mut self, space: &SearchSpace) -> Option<()> {
        let (eccentricity, altitude_km) = (space.eccentricity[0], space.altitude_km[1]);
        let perigee_km = (RADIUS_KM + altitude_km) * (1.0 - eccentricity) - RADIUS_KM;
        if perigee_km > 0.0 {
            return Some(());
        }
        let keys: [&dyn AnyKey; 2] = [&table::ECCENTRICITY, &table::ALTITUDE_KM];
        let fault = Fault::Underground {
            eccentricity,
            altitude_km,
            perigee_km,
        };
        self.report(&keys, fault);
        None
    }

    /// The phasing; its default is cut for a search of one plane alone, where only 0 exists.
    fn phasing(&mut self, planes: Option<[u32; 2]>) -> Option<[u32; 2]> {
        let key = &table::PHASING;
        let highest = planes.map(|planes| planes[1] - 1);
        let cut = || {
            Some(
                key.otherwise
                    .value()
                    .map(|limit| limit.min(highest.unwrap_or(limit))),
            )
        };
        let phasing = self.value_or(key, cut)?;
        let lowest = phasing[0];
        if highest.is_some_and(|highest| lowest > highest) {
            let planes = planes?[1];
            self.report(&[key], Fault::PhasingAbovePlanes { lowest, planes });
            return None;
        }
        Some(phasing)
    }

    fn optimizer(&mut self) -> Option<Optimizer> {
        let algorithm = self.value(&table::ALGORITHM);
        let population = self.value(&table::POPULATION);
        let generations = self.value(&table::GENERATIONS);
        let crossover_probability = self.value(&table::CROSSOVER_PROBABILITY);
        let mutation_probability = self.value(&table::MUTATION_PROBABILITY);
        let crossover_index = self.value(&table::CROSSOVER_INDEX);
        let mutation_index = self.value(&table::MUTATION_INDEX);
        let seed = self.value(&table::SEED);
        Some(Optimizer {
            algorithm: algorithm?,
            population: population?,
            generations: generations?,
            crossover_probability: crossover_probability?,
            mutation_probability: mutation_probability?,
            crossover_index: crossover_index?,
            mutation_index: mutation_index?,
            seed: seed?,
        })
    }

    fn export(&mut self, time: Option<&TimeSpan>) -> Option<Export> {
        let originator = self.value(&table::ORIGINATOR);
        let epoch = || time.map(|time| time.epoch);
        let creation_date = self.value_or(&table::CREATION_DATE, epoch);
        Some(Export {
            originator: originator?,
            creation_date: creation_date?,
        })
    }

    /// Bounds that span several sections.
    fn size(&mut self, scenario: &Scenario) -> Option<()> {
        if let Region::Grid(grid) = &scenario.region {
            let count = grid.points() * scenario.time.steps();
            let keys: [&dyn AnyKey; 3] = [&table::STEP_S, &table::DURATION_H, &table::STEP_DEG];
            self.at_most(MOST_POINT_SAMPLES, count, "points times samples", &keys)?;
        }
        if scenario.optimizer.algorithm == Algorithm::Exhaustive {
            let keys: [&dyn AnyKey; 6] = [
                &table::INCLINATION_STEP_DEG,
                &table::ALTITUDE_STEP_KM,
                &table::PHASING,
                &table::PLANES,
                &table::SATELLITES_PER_PLANE,
                &table::ALGORITHM,
            ];
            let designs = scenario.search.designs();
            self.at_most(
                MOST_DESIGNS,
                designs,
                "designs in an exhaustive search",
                &keys,
            )?;
        }
        Some(())
    }
}
