//! Every key of a scenario moves a result: one row each, and none without a row.

use crate::cli::ran;
use navwalker::scenario::describe_keys;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Where the effect of a key is seen: a command that prints JSON, and a place in it; or a file of an export.
struct Row {
    key: &'static str,
    value: &'static str,
    command: &'static str,
    seen: &'static str,
}

const EVALUATE: &str = "evaluate --format json --design delta:55:60/6/1@925 --set time.step-s=1200 --set region.step-deg=20";
/// The region is another.
const EVALUATE_POINTS: &str =
    "evaluate --format json --design delta:55:60/6/1@925 --set time.step-s=1200";
const EVALUATE_TERRAIN: &str = "evaluate --format json --design delta:55:60/6/1@925 --set time.step-s=1200 --set region.terrain=terrain.csv";
const VALIDATE: &str = "validate --format json --against sgp4 --set time.duration-h=2 --set region.step-deg=20 \
     --set reference-design=delta:55:4/2/1@925";
const OPTIMIZE: &str = "optimize --quiet --format json --out run --set region.step-deg=20 --set time.step-s=1200 \
     --set optimizer.population=8 --set optimizer.generations=6 --set search.planes=[5,7] \
     --set search.satellites-per-plane=[5,7]";
const LAUNCH_COST: &str = "optimize --quiet --format json --out run --set region.step-deg=20 --set time.step-s=1200 \
     --set optimizer.population=8 --set optimizer.generations=2 --set objectives.minimize=[\"j-pos\",\"launch-cost\"]";
/// Two values on each axis.
const SWEEP: &str = "optimize --quiet --format json --out run --set region.step-deg=20 --set time.step-s=3600 \
     --set optimizer.algorithm=exhaustive --set search.planes=[5,5] --set search.satellites-per-plane=[5,5] \
     --set search.inclination-deg=[50,60] --set search.altitude-km=[900,1000] --set search.eccentricity=[0,0.01] \
     --set search.arg-perigee-deg=[0,60] --set search.inclination-step-deg=10 --set search.altitude-step-km=100 \
     --set search.eccentricity-step=0.01 --set search.arg-perigee-step-deg=60";
/// Without intervals of one shell, which a list of shells excludes.
const OPTIMIZE_LISTED: &str = "optimize --quiet --format json --out run --set region.step-deg=20 --set time.step-s=1200 \
     --set optimizer.population=8 --set optimizer.generations=2";
const SWEEP_TURNED: &str = "optimize --quiet --format json --out run --set region.step-deg=20 --set time.step-s=7200 \
     --set optimizer.algorithm=exhaustive --set search.planes=[3,3] --set search.satellites-per-plane=[5,5] \
     --set search.inclination-deg=50 --set search.altitude-km=900 --set search.raan-deg=[0,30] \
     --set search.arg-latitude-deg=[0,30] --set search.node-step-deg=[30,31]";
const EXPORT: &str =
    "export --quiet --as oem --out files --design delta:55:2/2/1@925 --set time.duration-h=1";

const EXPORT_TLE: &str =
    "export --quiet --as tle --out files --design delta:55:2/2/1@925 --set time.duration-h=1";
const EVALUATE_OWN: &str = "evaluate --format json --set constellations.two=delta:55:6/3/1@925 \
     --set constellations.three=delta:60:6/3/1@925 --set time.step-s=3600 --set region.step-deg=25";

const EVALUATE_HYBRID: &str = "evaluate --format json --design delta:55:24/6/1@925+star:90:24/4/1@1000 --set time.step-s=3600 \
     --set region.step-deg=25";
const EVALUATE_RELIABILITY: &str = "evaluate --format json --design delta:55:12/3/1@925 --set time.step-s=3600 \
     --set region.step-deg=25 --set reliability.mtbf-h=1000 --set reliability.mttr-h=100";
/// Every system is in use and has a range error.
const METRES: &str = "evaluate --format json --design delta:55:60/6/1@925 --set time.step-s=7200 --set region.step-deg=30 \
     --set gnss.constellations=[\"beidou-3\",\"gps\",\"galileo\",\"glonass\",\"qzss\",\"navic\"] --set gnss.files=[\"gnss.alm\"] \
     --set accuracy.leo-m=1 --set accuracy.beidou-3-m=1 --set accuracy.gps-m=1 --set accuracy.galileo-m=1 \
     --set accuracy.glonass-m=1 --set accuracy.qzss-m=1 --set accuracy.navic-m=1 --set accuracy.files-m=1";

const fn row(
    key: &'static str,
    value: &'static str,
    command: &'static str,
    seen: &'static str,
) -> Row {
    Row {
        key,
        value,
        command,
        seen,
    }
}

/// One row for each key. `mean_visible` counts LEO satellites alone, so that it tells their mask from that of the GNSS.
const ROWS: [Row; 94] = [
    row("name", "other", EVALUATE, "/scenario/name"),
    row(
        "constellations",
        "{one=\"delta:55:4/2/1@800\"}",
        EVALUATE_OWN,
        "/constellations",
    ),
    row(
        "outages.satellites",
        "[\"NW-P02\"]",
        EVALUATE,
        "/metrics/mean_visible",
    ),
    row(
        "outages.file",
        "outages.csv",
        EVALUATE,
        "/metrics/mean_visible",
    ),
    row(
        "reliability.availability",
        "0.9",
        EVALUATE,
        "/expected/availability",
    ),
    row(
        "reliability.mtbf-h",
        "900",
        EVALUATE_RELIABILITY,
        "/expected/mean_visible",
    ),
    row(
        "reliability.mttr-h",
        "200",
        EVALUATE_RELIABILITY,
        "/expected/mean_visible",
    ),
    row(
        "reliability.spares-per-plane",
        "1",
        EVALUATE_RELIABILITY,
        "/expected/mean_visible",
    ),
    row(
        "export.name-prefix",
        "AB",
        EXPORT_TLE,
        "file:constellation.tle",
    ),
    row(
        "export.first-catalog-number",
        "91001",
        EXPORT_TLE,
        "file:constellation.tle",
    ),
    row(
        "reference-design",
        "delta:55:4/2/1@800",
        VALIDATE,
        "/budget",
    ),
    row(
        "time.epoch",
        "2025-03-01T00:00:00Z",
        EVALUATE,
        "/metrics/mean_pdop",
    ),
    row("time.duration-h", "12", EVALUATE, "/metrics/mean_visible"),
    row("time.step-s", "900", EVALUATE, "/metrics/mean_visible"),
    row("earth.surface", "wgs84", EVALUATE, "/metrics/mean_visible"),
    row(
        "propagation.model",
        "two-body",
        EVALUATE,
        "/metrics/mean_pdop",
    ),
    row(
        "region.latitude-deg",
        "[3,30]",
        EVALUATE,
        "/metrics/mean_visible",
    ),
    row(
        "region.longitude-deg",
        "[73,100]",
        EVALUATE,
        "/metrics/mean_visible",
    ),
    row("region.step-deg", "15", EVALUATE, "/metrics/mean_visible"),
    row(
        "region.weights",
        "cos-latitude",
        EVALUATE,
        "/metrics/mean_visible",
    ),
    row(
        "region.spacing-km",
        "1000",
        EVALUATE_POINTS,
        "/metrics/mean_visible",
    ),
    row(
        "region.polygon",
        "area.geojson",
        EVALUATE_POINTS,
        "/metrics/mean_visible",
    ),
    row(
        "region.country",
        "[\"Brazil\",\"Japan\"]",
        EVALUATE_POINTS,
        "/metrics/mean_visible",
    ),
    row(
        "region.points",
        "points.csv",
        EVALUATE_POINTS,
        "/metrics/mean_visible",
    ),
    row(
        "region.weight-grid",
        "people.csv",
        EVALUATE_POINTS,
        "/metrics/mean_visible",
    ),
    row(
        "region.terrain",
        "terrain.csv",
        EVALUATE_POINTS,
        "/metrics/mean_visible",
    ),
    row(
        "region.antenna-height-m",
        "500",
        EVALUATE_TERRAIN,
        "/metrics/mean_visible",
    ),
    row(
        "visibility.mask-deg",
        "20",
        EVALUATE,
        "/metrics/mean_visible",
    ),
    row(
        "visibility.gnss-mask-deg",
        "30",
        EVALUATE,
        "/metrics/mean_pdop",
    ),
    row(
        "visibility.mask-table",
        "[[0,0],[90,30],[360,0]]",
        EVALUATE,
        "/metrics/mean_visible",
    ),
    row(
        "visibility.weighting",
        "sine-elevation",
        EVALUATE,
        "/metrics/mean_pdop",
    ),
    row(
        "visibility.pdop-cap",
        "1.2",
        EVALUATE,
        "/metrics/solved_fraction",
    ),
    row(
        "gnss.constellations",
        "[\"gps\"]",
        EVALUATE,
        "/metrics/mean_pdop",
    ),
    row(
        "gnss.files",
        "[\"gnss.alm\"]",
        EVALUATE,
        "/metrics/mean_pdop",
    ),
    row("gnss.clocks", "shared", EVALUATE, "/metrics/mean_pdop"),
    row(
        "gnss.leo-clocks",
        "per-part",
        EVALUATE_HYBRID,
        "/metrics/mean_pdop",
    ),
    row(
        "metrics.window-min",
        "40",
        EVALUATE,
        "/metrics/information_pdop/mean",
    ),
    row("accuracy.leo-m", "9", METRES, "/metrics/error95_3d_m"),
    row(
        "accuracy.leo-elevation",
        "[1,2]",
        METRES,
        "/metrics/sigma_3d_m/mean",
    ),
    row("accuracy.beidou-3-m", "9", METRES, "/metrics/error95_3d_m"),
    row(
        "accuracy.beidou-3-elevation",
        "[1,2]",
        METRES,
        "/metrics/sigma_3d_m/mean",
    ),
    row("accuracy.gps-m", "9", METRES, "/metrics/error95_3d_m"),
    row(
        "accuracy.gps-elevation",
        "[1,2]",
        METRES,
        "/metrics/sigma_3d_m/mean",
    ),
    row("accuracy.galileo-m", "9", METRES, "/metrics/error95_3d_m"),
    row(
        "accuracy.galileo-elevation",
        "[1,2]",
        METRES,
        "/metrics/sigma_3d_m/mean",
    ),
    row("accuracy.glonass-m", "9", METRES, "/metrics/error95_3d_m"),
    row(
        "accuracy.glonass-elevation",
        "[1,2]",
        METRES,
        "/metrics/sigma_3d_m/mean",
    ),
    row("accuracy.qzss-m", "9", METRES, "/metrics/error95_3d_m"),
    row(
        "accuracy.qzss-elevation",
        "[1,2]",
        METRES,
        "/metrics/sigma_3d_m/mean",
    ),
    row("accuracy.navic-m", "9", METRES, "/metrics/error95_3d_m"),
    row(
        "accuracy.navic-elevation",
        "[1,2]",
        METRES,
        "/metrics/sigma_3d_m/mean",
    ),
    row("accuracy.files-m", "9", METRES, "/metrics/error95_3d_m"),
    row(
        "accuracy.files-elevation",
        "[1,2]",
        METRES,
        "/metrics/sigma_3d_m/mean",
    ),
    row(
        "objectives.minimize",
        "[\"j-pos\",\"satellites\"]",
        OPTIMIZE,
        "/front/0/objectives",
    ),
    row("objectives.cvar-weight", "2", EVALUATE, "/metrics/j_pos"),
    row(
        "objectives.cvar-level",
        "0.5",
        EVALUATE,
        "/metrics/cvar_pdop",
    ),
    row(
        "objectives.constraints",
        "[\"satellites <= 30\"]",
        OPTIMIZE,
        "/front",
    ),
    row(
        "objectives.availability-pdop",
        "1.2",
        EVALUATE,
        "/metrics/availability",
    ),
    row(
        "objectives.launch-cost-per-satellite",
        "2",
        LAUNCH_COST,
        "/front/0/objectives/launch-cost",
    ),
    row(
        "objectives.launch-cost-per-plane",
        "9",
        LAUNCH_COST,
        "/front/0/objectives/launch-cost",
    ),
    row(
        "objectives.launch-cost-per-1000-km",
        "0.7",
        LAUNCH_COST,
        "/front/0/objectives/launch-cost",
    ),
    row(
        "objectives.hypervolume-reference",
        "[3,40]",
        OPTIMIZE,
        "/hypervolume/value",
    ),
    row(
        "search.pattern",
        "star",
        OPTIMIZE,
        "/front/0/design/pattern",
    ),
    row("search.planes", "[3,4]", OPTIMIZE, "/front/0/design/planes"),
    row(
        "search.satellites-per-plane",
        "[8,9]",
        OPTIMIZE,
        "/front/0/design/satellites_per_plane",
    ),
    row(
        "search.inclination-deg",
        "[20,30]",
        OPTIMIZE,
        "/front/0/design/inclination_deg",
    ),
    row(
        "search.altitude-km",
        "[500,600]",
        OPTIMIZE,
        "/front/0/design/altitude_km",
    ),
    row("search.phasing", "2", OPTIMIZE, "/front/0/design/phasing"),
    row(
        "search.eccentricity",
        "0.01",
        OPTIMIZE,
        "/front/0/design/eccentricity",
    ),
    row(
        "search.arg-perigee-deg",
        "90",
        OPTIMIZE,
        "/front/0/design/arg_perigee_deg",
    ),
    row(
        "search.raan-deg",
        "30",
        OPTIMIZE,
        "/front/0/design/raan_deg",
    ),
    row(
        "search.arg-latitude-deg",
        "45",
        OPTIMIZE,
        "/front/0/design/arg_latitude_deg",
    ),
    row(
        "search.node-step-deg",
        "31.6",
        OPTIMIZE,
        "/front/0/design/node_step_deg",
    ),
    row(
        "search.shells",
        "[{planes=[3,4]},{planes=2,satellites-per-plane=[2,3]}]",
        OPTIMIZE_LISTED,
        "/front/0/shells",
    ),
    row("search.fixed", "star:86.4:12/3/1@780", OPTIMIZE, "/fixed"),
    row("search.raan-step-deg", "10", SWEEP_TURNED, "/evaluations"),
    row(
        "search.arg-latitude-step-deg",
        "10",
        SWEEP_TURNED,
        "/evaluations",
    ),
    row(
        "search.node-step-step-deg",
        "0.5",
        SWEEP_TURNED,
        "/evaluations",
    ),
    row("search.inclination-step-deg", "5", SWEEP, "/evaluations"),
    row("search.altitude-step-km", "50", SWEEP, "/evaluations"),
    row("search.eccentricity-step", "0.005", SWEEP, "/evaluations"),
    row("search.arg-perigee-step-deg", "30", SWEEP, "/evaluations"),
    row("optimizer.algorithm", "random", OPTIMIZE, "/front"),
    row("optimizer.population", "12", OPTIMIZE, "/evaluations"),
    row("optimizer.generations", "5", OPTIMIZE, "/evaluations"),
    row("optimizer.crossover-probability", "0.1", OPTIMIZE, "/front"),
    row("optimizer.mutation-probability", "0.9", OPTIMIZE, "/front"),
    row("optimizer.crossover-index", "60", OPTIMIZE, "/front"),
    row("optimizer.mutation-index", "200", OPTIMIZE, "/front"),
    row("optimizer.seed", "2", OPTIMIZE, "/front"),
    row(
        "export.originator",
        "OTHERS",
        EXPORT,
        "file:oem/NW-P01-S01.oem",
    ),
    row(
        "export.creation-date",
        "2025-02-01T00:00:00Z",
        EXPORT,
        "file:oem/NW-P01-S01.oem",
    ),
    // The effects that a second place shows better.
    row(
        "objectives.cvar-weight",
        "2",
        OPTIMIZE,
        "/front/0/objectives/j-pos",
    ),
    row(
        "objectives.constraints",
        "[\"max-pdop <= 1.5\"]",
        EVALUATE,
        "/constraints",
    ),
];

/// What a command shows at a place.
fn seen(place: &Path, command: &str, key: Option<(&str, &str)>, at: &str) -> Option<Value> {
    let mut arguments: Vec<String> = command.split_whitespace().map(str::to_owned).collect();
    if let Some((key, value)) = key {
        arguments.extend(["--set".to_owned(), format!("{key}={value}")]);
    }
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let ran = ran(place, &arguments);
    assert!(ran.status < 2, "{arguments:?}: {}", ran.stderr);
    let found = match at.strip_prefix("file:") {
        Some(file) => Some(
            fs::read_to_string(place.join("files").join(file))
                .unwrap()
                .into(),
        ),
        None => serde_json::from_str::<Value>(&ran.stdout)
            .unwrap()
            .pointer(at)
            .cloned(),
    };
    for made in ["run", "files"] {
        let made = place.join(made);
        if made.exists() {
            fs::remove_dir_all(made).unwrap();
        }
    }
    found
}

#[test]
fn every_key_has_a_row() {
    let keys = describe_keys().into_iter().map(|key| match key.section {
        "" => key.name.to_owned(),
        section => format!("{section}.{}", key.name),
    });
    let keys: BTreeSet<String> = keys.collect();
    let rows: BTreeSet<String> = ROWS.iter().map(|row| row.key.to_owned()).collect();
    assert_eq!(keys, rows);
}

#[test]
fn every_key_moves_its_result() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    fs::write(
        place.join("points.csv"),
        "latitude_deg,longitude_deg\n-50,10\n60,170\n",
    )
    .unwrap();
    fs::write(
        place.join("terrain.csv"),
        "latitude_deg,longitude_deg,height_m\n0,70,0\n0,140,3000\n60,70,3000\n60,140,0\n",
    )
    .unwrap();
    fs::write(
        place.join("people.csv"),
        "latitude_deg,longitude_deg,weight\n0,70,1\n0,140,0\n60,70,9\n60,140,0\n",
    )
    .unwrap();
    fs::write(
        place.join("area.geojson"),
        r#"{"type": "Polygon", "coordinates": [[[10,-20],[40,-20],[40,10],[10,10],[10,-20]]]}"#,
    )
    .unwrap();
    fs::write(
        place.join("outages.csv"),
        "satellite,start_utc,end_utc\nNW-P01,2025-01-01T06:00:00Z,2025-01-01T18:00:00Z\n",
    )
    .unwrap();
    let almanac: Vec<&str> = "export --quiet --as yuma --out almanac --set gnss.constellations=[\"galileo\"] --design delta:55:2/2/1@925"
        .split(' ').collect();
    assert_eq!(ran(place, &almanac).status, 0);
    fs::copy(
        place.join("almanac/yuma/galileo.alm"),
        place.join("gnss.alm"),
    )
    .unwrap();
    let mut before = BTreeMap::new();
    let mut unmoved = Vec::new();
    for row in &ROWS {
        let base = before.entry((row.command, row.seen));
        let base = base.or_insert_with(|| seen(place, row.command, None, row.seen));
        let moved = seen(place, row.command, Some((row.key, row.value)), row.seen);
        if moved.is_none() || *base == moved {
            unmoved.push((row.key, row.seen, base.clone()));
        }
    }
    assert!(unmoved.is_empty(), "{unmoved:#?}");
}
