//! The keys of the setting of a study: when, where, seen how, beside which GNSS.

use chrono::DateTime;

use crate::scenario::keys::{Key, Otherwise};
use crate::scenario::resolved::{Grid, Region, Scenario};
use crate::scenario::rule::{
    Eastward, Instant, Interval, Number, OneOf, Paths, Skyline, SomeOf, Steps, Text,
};
use crate::scenario::{Clocks, Model, ObservationWeights, PointWeights, Preset, Surface};

pub(in crate::scenario) static NAME: Key<Text> = Key {
    section: "",
    name: "name",
    unit: "",
    meaning: "Name of the study, also part of the default output directory",
    rule: Text::Name,
    otherwise: Otherwise::Value(|| "scenario".to_owned()),
    of: |s| Some(s.name.clone()),
};

pub(in crate::scenario) static REFERENCE_DESIGN: Key<Text> = Key {
    section: "",
    name: "reference-design",
    unit: "",
    meaning: "Design that is validated when none is named, in Walker notation pattern:inclination:T/P/F@altitude",
    rule: Text::Any,
    otherwise: Otherwise::Value(|| "delta:55:182/13/1@925".to_owned()),
    of: |s| Some(s.reference_design.clone()),
};

pub(in crate::scenario) static EPOCH: Key<Instant> = Key {
    section: "time",
    name: "epoch",
    unit: "",
    meaning: "First sample, UTC; the elements of every design hold at it",
    rule: Instant,
    otherwise: Otherwise::Value(|| DateTime::from_timestamp_nanos(1_735_689_600_000_000_000)),
    of: |s| Some(s.time.epoch),
};

pub(in crate::scenario) static DURATION_H: Key<Number> = Key {
    section: "time",
    name: "duration-h",
    unit: "h",
    meaning: "Length of the study; the closing instant is no sample",
    rule: Number::above_to(0.0, 366.0 * 24.0),
    otherwise: Otherwise::Value(|| 24.0),
    of: |s| Some(s.time.duration_h),
};

pub(in crate::scenario) static STEP_S: Key<Number> = Key {
    section: "time",
    name: "step-s",
    unit: "s",
    meaning: "Interval between samples",
    rule: Number::above(0.0),
    otherwise: Otherwise::Value(|| 60.0),
    of: |s| Some(s.time.step_s),
};

pub(in crate::scenario) static SURFACE: Key<OneOf<Surface>> = Key {
    section: "earth",
    name: "surface",
    unit: "",
    meaning: "Surface on which ground points lie and to which their verticals belong",
    rule: OneOf::new(),
    otherwise: Otherwise::Value(|| Surface::Wgs84),
    of: |s| Some(s.earth.surface),
};

pub(in crate::scenario) static MODEL: Key<OneOf<Model>> = Key {
    section: "propagation",
    name: "model",
    unit: "",
    meaning: "Motion of the LEO design; GNSS constellations are always flown as they are defined",
    rule: OneOf::new(),
    otherwise: Otherwise::Value(|| Model::J2),
    of: |s| Some(s.propagation.model),
};

pub(in crate::scenario) static LATITUDE_DEG: Key<Interval<Number>> = Key {
    section: "region",
    name: "latitude-deg",
    unit: "deg",
    meaning: "Southern and northern limit of the grid",
    rule: Interval {
        of: Number::from_to(-90.0, 90.0),
        or_single: false,
    },
    otherwise: Otherwise::Value(|| [3.0, 54.0]),
    of: |s| grid(s).map(|grid| grid.latitude_deg),
};

pub(in crate::scenario) static LONGITUDE_DEG: Key<Eastward> = Key {
    section: "region",
    name: "longitude-deg",
    unit: "deg",
    meaning: "Western and eastern limit of the grid; [160, -155] runs over the date line",
    rule: Eastward,
    otherwise: Otherwise::Value(|| [73.0, 136.0]),
    of: |s| grid(s).map(|grid| grid.longitude_deg),
};

pub(in crate::scenario) static STEP_DEG: Key<Steps> = Key {
    section: "region",
    name: "step-deg",
    unit: "deg",
    meaning: "Step of the grid from its south-western corner",
    rule: Steps(Number::above_to(0.0, 360.0)),
    otherwise: Otherwise::Value(|| [5.0, 5.0]),
    of: |s| grid(s).map(|grid| grid.step_deg),
};

pub(in crate::scenario) static WEIGHTS: Key<OneOf<PointWeights>> = Key {
    section: "region",
    name: "weights",
    unit: "",
    meaning: "How the points of the grid count in a mean",
    rule: OneOf::new(),
    otherwise: Otherwise::Value(|| PointWeights::Equal),
    of: |s| grid(s).map(|grid| grid.weights),
};

pub(in crate::scenario) static POINTS: Key<Text> = Key {
    section: "region",
    name: "points",
    unit: "",
    meaning: "CSV file latitude_deg,longitude_deg[,weight] in place of the grid, path relative to this file",
    rule: Text::Any,
    otherwise: Otherwise::Follows {
        what: "the grid",
        example: || "points.csv".to_owned(),
    },
    of: points_file,
};

pub(in crate::scenario) static MASK_DEG: Key<Number> = Key {
    section: "visibility",
    name: "mask-deg",
    unit: "deg",
    meaning: "Lowest elevation of a visible LEO satellite",
    rule: Number::from_below(0.0, 90.0),
    otherwise: Otherwise::Value(|| 7.0),
    of: |s| Some(s.visibility.mask_deg),
};

pub(in crate::scenario) static GNSS_MASK_DEG: Key<Number> = Key {
    section: "visibility",
    name: "gnss-mask-deg",
    unit: "deg",
    meaning: "Lowest elevation of a visible GNSS satellite",
    rule: Number::from_below(0.0, 90.0),
    otherwise: Otherwise::Follows {
        what: "mask-deg",
        example: || 7.0,
    },
    of: |s| Some(s.visibility.gnss_mask_deg),
};

pub(in crate::scenario) static MASK_TABLE: Key<Skyline> = Key {
    section: "visibility",
    name: "mask-table",
    unit: "deg",
    meaning: "Skyline [[azimuth, mask], ...] from 0 to 360 deg, linear between its points; counts where it is higher than a mask",
    rule: Skyline,
    otherwise: Otherwise::Value(Vec::new),
    of: |s| Some(s.visibility.mask_table.clone()),
};

pub(in crate::scenario) static WEIGHTING: Key<OneOf<ObservationWeights>> = Key {
    section: "visibility",
    name: "weighting",
    unit: "",
    meaning: "How a line of sight counts in the least-squares solution",
    rule: OneOf::new(),
    otherwise: Otherwise::Value(|| ObservationWeights::Unit),
    of: |s| Some(s.visibility.weighting),
};

pub(in crate::scenario) static PDOP_CAP: Key<Number> = Key {
    section: "visibility",
    name: "pdop-cap",
    unit: "",
    meaning: "PDOP above which a sample has no solution",
    rule: Number::above(1.0),
    otherwise: Otherwise::Value(|| 100.0),
    of: |s| Some(s.visibility.pdop_cap),
};

pub(in crate::scenario) static CONSTELLATIONS: Key<SomeOf<Preset>> = Key {
    section: "gnss",
    name: "constellations",
    unit: "",
    meaning: "Built-in GNSS constellations that the design augments",
    rule: SomeOf::at_least(0),
    otherwise: Otherwise::Value(|| vec![Preset::Beidou3]),
    of: |s| Some(s.gnss.constellations.clone()),
};

pub(in crate::scenario) static FILES: Key<Paths> = Key {
    section: "gnss",
    name: "files",
    unit: "",
    meaning: "TLE or OMM files of GNSS satellites, paths relative to this file",
    rule: Paths,
    otherwise: Otherwise::Value(Vec::new),
    of: |s| Some(s.gnss.files.clone()),
};

pub(in crate::scenario) static CLOCKS: Key<OneOf<Clocks>> = Key {
    section: "gnss",
    name: "clocks",
    unit: "",
    meaning: "Receiver clocks solved for beside the position",
    rule: OneOf::new(),
    otherwise: Otherwise::Value(|| Clocks::PerSystem),
    of: |s| Some(s.gnss.clocks),
};

fn grid(scenario: &Scenario) -> Option<&Grid> {
    match &scenario.region {
        Region::Grid(grid) => Some(grid),
        Region::Points { .. } => None,
    }
}

fn points_file(scenario: &Scenario) -> Option<String> {
    match &scenario.region {
        Region::Grid(_) => None,
        Region::Points { file } => Some(file.clone()),
    }
}
