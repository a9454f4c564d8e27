//! The numbers embedded in the page for its figures.

mod instants;
mod outages;
mod readouts;
mod setting;
mod tracks;
mod variables;

use super::Page;
use super::pack::{Packed, short};
use crate::constellation::{Design, Shell};
use crate::evaluate::{EpochMetrics, PointMetrics, Setup};
use crate::optimize::Record;
use crate::orbit::Model;
use crate::orbit::j2::SecularRates;
use crate::report::figures::{Measure, at_epoch, at_point, earlier, quantity_label};
use crate::report::profile::{Profile, Quantile, drawn_levels, quantiles_of};
use crate::report::{Compared, shown};
use crate::run::{FrontMember, Run};
use crate::scenario::{Keyword, Quantity};
use instants::InstantMaps;
use outages::OutageRow;
use serde::Serialize;
use setting::{RegionData, World};
use std::collections::BTreeMap;
use tracks::Tracks;
use variables::VariableColumn;

/// Maximum number of instants of a series in the page; longer series are reduced to intervals.
const MOST_EPOCHS: usize = 1440;

/// Measures shown over the region.
const MAPS: [Measure; 8] = [
    Measure::MeanVisible,
    Measure::MeanPdop,
    Measure::P95Pdop,
    Measure::MaxPdop,
    Measure::Availability,
    Measure::LongestOutageS,
    Measure::Coverage4,
    Measure::GainMeanPdop,
];

/// Measures shown over time.
const SERIES: [Measure; 4] = [
    Measure::MeanVisible,
    Measure::MeanPdop,
    Measure::MaxPdop,
    Measure::Availability,
];

/// Measures whose distribution over the points is shown.
const OVER_POINTS: [Measure; 4] = [
    Measure::Availability,
    Measure::LongestOutageS,
    Measure::Coverage4,
    Measure::GainMeanPdop,
];

/// All data for the script of the page.
#[derive(Serialize)]
pub(super) struct Payload {
    objectives: Vec<Objective>,
    front: Front,
    chosen: Option<usize>,
    generations: Vec<(u64, Vec<f64>)>,
    baselines: Vec<Beside>,
    /// Of the satellites from files that every member of the front has.
    fixed_tracks: Option<Tracks>,
    fronts: Vec<OtherFront>,
    history: Vec<Generation>,
    reference: Option<String>,
    levels: Vec<f64>,
    /// By position in the front.
    cuts: BTreeMap<usize, Cuts>,
    /// The instants that have maps, seconds from the epoch.
    instants_s: Vec<f64>,
    region: Option<RegionData>,
    world: Option<World>,
    budget: Vec<Budget>,
}

#[derive(Serialize)]
struct Objective {
    name: String,
    label: String,
    maximised: bool,
}

/// The front, column by column.
#[derive(Serialize)]
struct Front {
    index: Vec<usize>,
    notation: Vec<String>,
    objectives: Vec<Vec<f64>>,
    membership: Vec<Option<f64>>,
    membership_sum: Vec<Option<f64>>,
    /// The values shown for the selected design, with the digits of the table.
    tiles: Vec<(String, Vec<String>)>,
    memberships_shown: Vec<String>,
    variables: Vec<VariableColumn>,
    /// Satellites of each shell of the search, by its letter; none if one shell is the whole design.
    shells: Vec<(String, Vec<usize>)>,
}

#[derive(Serialize)]
struct Beside {
    name: String,
    notation: String,
    objectives: Vec<Option<f64>>,
    /// The values shown when it is selected, in the order of those of the front.
    tiles: Vec<String>,
    cuts: Option<Cuts>,
}

#[derive(Serialize)]
struct OtherFront {
    name: String,
    notation: Vec<String>,
    objectives: Vec<Vec<Option<f64>>>,
}

#[derive(Serialize)]
struct Generation {
    generation: u64,
    evaluations: u64,
    hypervolume: Option<f64>,
    front_size: usize,
}

/// The cuts of a design.
#[derive(Serialize)]
struct Cuts {
    /// By measure, point by point.
    maps: Vec<(&'static str, Packed)>,
    /// By measure, instant by instant.
    series: Vec<(&'static str, Packed)>,
    /// Quantiles over the instants, by measure, at the levels.
    over_time: Vec<(&'static str, Packed)>,
    /// Quantiles over the points, by measure, at the levels.
    over_points: Vec<(&'static str, Packed)>,
    /// Fraction of the samples by number of satellites: LEO, GNSS and all.
    histograms: [Packed; 3],
    /// The outages of the points that are out longest.
    timeline: Vec<OutageRow>,
    /// Quantiles of PDOP over all samples.
    pdop: Packed,
    /// Level, quantile and CVaR.
    tail: Option<[f64; 3]>,
    /// Quantile and CVaR with the digits of the table.
    tail_shown: Option<[String; 2]>,
    /// One of each shell.
    orbits: Vec<Orbit>,
    /// The satellites that are in no shell.
    tracks: Option<Tracks>,
    /// Of the constellations that a reader looks at first.
    instants: Option<InstantMaps>,
}

/// Data for the globe, of one shell: mean elements at the epoch and their rates.
#[derive(Serialize)]
struct Orbit {
    notation: String,
    semi_major_axis_km: f64,
    eccentricity: f64,
    inclination_deg: f64,
    arg_perigee_deg: f64,
    per_plane: usize,
    raan_deg: Vec<f64>,
    mean_anomaly_deg: Packed,
    /// Of node, perigee and mean anomaly, degrees per second.
    rates_deg_s: [f64; 3],
}

#[derive(Serialize)]
struct Budget {
    case: String,
    rms_km: [f64; 3],
}

/// Approximate bytes of the page for the cuts of one design of this many satellites, but for positions.
pub(super) fn cut_bytes(epochs: usize, points: usize, satellites: usize) -> usize {
    let numbers = SERIES.len() * epochs.min(MOST_EPOCHS)
        + MAPS.len() * points
        + (SERIES.len() + OVER_POINTS.len() + 1) * drawn_levels().len();
    let outages = outages::MOST_ROWS * epochs.min(MOST_EPOCHS) / 8;
    // Two bytes each, in base64, and the names.
    (2 * (numbers + satellites) + outages) * 4 / 3 + 3500
}

impl Payload {
    pub(super) fn new(
        page: &Page<'_>,
        places: &[usize],
        members: &[Option<Profile>],
        compared: &[Option<Profile>],
    ) -> Self {
        let run = page.run;
        let names = run.objective_names();
        let setup = page.evaluator.map(|evaluator| evaluator.setup());
        let of_members = places.iter().zip(members).filter_map(|(&n, profile)| {
            let cuts = Cuts::new(profile.as_ref()?);
            let cuts = match run.front[n].only_design() {
                Some(design) => cuts.with_orbits(&design, setup?.model),
                None => cuts,
            };
            Some((n, cuts))
        });
        let generations = earlier(run, &names).into_iter();
        let payload = Self {
            objectives: names.iter().map(|name| Objective::new(name)).collect(),
            front: Front::new(run, &names),
            chosen: run.chosen(),
            generations: generations
                .map(|(g, x)| (g, x.into_iter().map(short).collect()))
                .collect(),
            baselines: page
                .compared
                .iter()
                .zip(compared)
                .map(|(one, profile)| Beside::new(one, profile.as_ref(), page))
                .collect(),
            fixed_tracks: setup.and_then(|setup| fixed_tracks(page, setup)),
            fronts: page
                .fronts
                .iter()
                .map(|f| OtherFront::new(&f.name, &f.front, &names))
                .collect(),
            history: history(run),
            reference: run.reference().map(|reference| shown::point(&reference)),
            levels: drawn_levels().into_iter().map(short).collect(),
            cuts: of_members.collect(),
            instants_s: Vec::new(),
            region: setup.and_then(RegionData::new),
            world: setup
                .zip(run.scenario.as_ref())
                .map(|(setup, scenario)| World::new(setup, scenario)),
            budget: budget(run),
        };
        payload.with_instants(page)
    }
}

impl Beside {
    fn new(one: &Compared, profile: Option<&Profile>, page: &Page<'_>) -> Self {
        let (run, baseline) = (page.run, &one.baseline);
        let (names, further) = (run.objective_names(), run.constraint_names());
        let quantity = |name: &str| {
            let objectives = names.iter().zip(&baseline.objectives);
            let constraints = further.iter().zip(&baseline.constraints);
            let mut all = objectives.chain(constraints);
            *all.find(|(known, _)| *known == name)?.1
        };
        let setup = page.evaluator.map(|evaluator| evaluator.setup());
        let cuts = setup.zip(profile).map(|(setup, profile)| {
            let cuts = Cuts {
                tracks: Tracks::new(&one.ephemeris, page.track_bytes()),
                ..Cuts::new(profile)
            };
            match &one.constellation.design {
                Some(design) => cuts.with_orbits(design, setup.model),
                None => cuts,
            }
        });
        Self {
            name: baseline.name.clone(),
            notation: baseline.made_of.clone(),
            objectives: baseline.objectives.iter().map(|x| x.map(short)).collect(),
            tiles: readouts::all(run, &names)
                .iter()
                .map(|one| one.text(&quantity, &baseline.metrics))
                .collect(),
            cuts,
        }
    }
}

/// The positions of the fixed satellites.
fn fixed_tracks(page: &Page<'_>, setup: &Setup) -> Option<Tracks> {
    let ephemeris = page.fixed?.fleet.propagate(setup.grid, setup.model).ok()?;
    Tracks::new(&ephemeris, page.track_bytes())
}

fn history(run: &Run) -> Vec<Generation> {
    let volumes = Record::volumes(&run.history);
    let records = run
        .history
        .iter()
        .zip(volumes)
        .map(|(record, volume)| Generation {
            generation: record.generation,
            evaluations: record.evaluations,
            hypervolume: volume.map(short),
            front_size: record.front_size,
        });
    records.collect()
}

fn budget(run: &Run) -> Vec<Budget> {
    let lines = run
        .validation
        .iter()
        .flat_map(|validation| &validation.findings.budget);
    let budget = lines.map(|line| Budget {
        case: line.case.clone(),
        rms_km: line.rms_km.axes().map(short),
    });
    budget.collect()
}

impl Objective {
    fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            label: quantity_label(name),
            maximised: Quantity::from_keyword(name).is_ok_and(Quantity::is_maximised),
        }
    }
}

impl Front {
    fn new(run: &Run, names: &[String]) -> Self {
        let members = &run.front;
        let column = |value: &dyn Fn(&FrontMember) -> Option<f64>| {
            members
                .iter()
                .map(|m| value(m).map(short))
                .collect::<Vec<_>>()
        };
        Self {
            index: members.iter().map(|m| m.index).collect(),
            notation: members.iter().map(FrontMember::made_of).collect(),
            objectives: names
                .iter()
                .map(|name| {
                    members
                        .iter()
                        .filter_map(|m| m.objective(name))
                        .map(short)
                        .collect()
                })
                .collect(),
            membership: column(&|m| Some(m.membership)),
            membership_sum: column(&|m| Some(m.membership_sum)),
            tiles: readouts::of_members(run, names),
            memberships_shown: members
                .iter()
                .map(|m| shown::membership(m.membership))
                .collect(),
            variables: variables::all(members, run.scenario.as_ref()),
            shells: variables::satellites_by_shell(members),
        }
    }
}

impl OtherFront {
    fn new(name: &str, front: &[FrontMember], names: &[String]) -> Self {
        let objective = |name: &String| {
            let values = front.iter().map(|m| m.objective(name).map(short));
            values.collect()
        };
        Self {
            name: name.to_owned(),
            notation: front.iter().map(FrontMember::made_of).collect(),
            objectives: names.iter().map(objective).collect(),
        }
    }
}

impl Cuts {
    fn new(profile: &Profile) -> Self {
        let map = |measure: Measure| {
            let values = profile
                .points
                .iter()
                .map(|p: &PointMetrics| at_point(measure, p));
            (measure.keyword(), Packed::new(values))
        };
        let over_time = |measure: Measure| {
            let values = profile.epochs.iter().filter_map(|e| at_epoch(measure, e));
            (measure.keyword(), levels(&quantiles_of(values)))
        };
        let over_points = |measure: Measure| {
            let quantiles = profile.over_points(|point| at_point(measure, point));
            (measure.keyword(), levels(&quantiles))
        };
        let shares = |of: &[f64]| Packed::of(of.iter().copied());
        let histograms = &profile.histograms;
        let series = |measure: Measure| (measure.keyword(), by_intervals(&profile.epochs, measure));
        Self {
            maps: MAPS.into_iter().map(map).collect(),
            series: SERIES.into_iter().map(series).collect(),
            over_time: SERIES.into_iter().map(over_time).collect(),
            over_points: OVER_POINTS.into_iter().map(over_points).collect(),
            histograms: [&histograms.leo, &histograms.gnss, &histograms.all].map(|of| shares(of)),
            timeline: outages::rows(profile),
            pdop: levels(&profile.pdop),
            tail: profile
                .tail
                .map(|tail| [tail.level, tail.value_at_risk, tail.cvar].map(short)),
            tail_shown: profile
                .tail
                .map(|tail| [tail.value_at_risk, tail.cvar].map(|x| shown::pdop(Some(x)))),
            orbits: Vec::new(),
            tracks: None,
            instants: None,
        }
    }

    fn with_orbits(self, design: &Design, model: Model) -> Self {
        Self {
            orbits: Orbit::of_design(design, model),
            ..self
        }
    }
}

fn levels(quantiles: &[Quantile]) -> Packed {
    Packed::of(quantiles.iter().map(|q| q.value))
}

/// Number of instants that are drawn as one point.
fn interval(epochs: usize) -> usize {
    epochs.div_ceil(MOST_EPOCHS).max(1)
}

/// A measure over time: the mean of each interval, or the maximum for the maximum PDOP.
fn by_intervals(epochs: &[EpochMetrics], measure: Measure) -> Packed {
    let of_interval = |interval: &[EpochMetrics]| {
        let values: Vec<f64> = interval
            .iter()
            .filter_map(|e| at_epoch(measure, e))
            .collect();
        match measure {
            Measure::MaxPdop => values.into_iter().reduce(f64::max),
            _ => (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64),
        }
    };
    Packed::new(epochs.chunks(interval(epochs.len())).map(of_interval))
}

impl Orbit {
    fn of_design(design: &Design, model: Model) -> Vec<Self> {
        let shells = design.shells().iter();
        shells.map(|shell| Self::new(shell, model)).collect()
    }

    fn new(shell: &Shell, model: Model) -> Self {
        let satellites = shell.satellites();
        let per_plane = shell.satellites_per_plane();
        let first = satellites[0].elements;
        let rates = match model {
            Model::TwoBody => SecularRates::two_body(&first),
            _ => SecularRates::j2(&first),
        };
        let raan = satellites
            .iter()
            .step_by(per_plane)
            .map(|s| s.elements.raan_rad);
        let anomalies = satellites
            .iter()
            .map(|s| s.elements.mean_anomaly_rad.to_degrees());
        Self {
            notation: shell.to_string(),
            semi_major_axis_km: first.semi_major_axis_km,
            eccentricity: first.eccentricity,
            inclination_deg: shell.inclination_deg(),
            arg_perigee_deg: shell.arg_perigee_deg(),
            per_plane,
            raan_deg: raan.map(|x| short(x.to_degrees())).collect(),
            mean_anomaly_deg: Packed::of(anomalies),
            rates_deg_s: [
                rates.raan_rad_s,
                rates.arg_perigee_rad_s,
                rates.mean_anomaly_rad_s,
            ]
            .map(f64::to_degrees),
        }
    }
}
