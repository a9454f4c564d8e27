//! What must agree: the scenario, its canonical text and its hash.

use super::{defaults, parse};
use crate::scenario::{Scenario, builtin, describe_keys, reference_markdown};

fn with(overrides: &[&str]) -> Scenario {
    parse("", overrides).unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn the_canonical_text_has_every_key_and_parses_back() {
    let text = defaults().to_toml();
    // What has no value unless it is given.
    let absent = [
        "points",
        "terrain",
        "weight-grid",
        "antenna-height-m",
        "polygon",
        "country",
        "spacing-km",
        "raan-deg",
        "arg-latitude-deg",
        "node-step-deg",
        "raan-step-deg",
        "arg-latitude-step-deg",
        "node-step-step-deg",
        "shells",
        "fixed",
    ];
    for key in describe_keys().iter().filter(|key| {
        !absent.contains(&key.name)
            && !["accuracy", "metrics", "outages", "reliability"].contains(&key.section)
    }) {
        assert!(
            text.contains(&format!("\n{} = ", key.name)) || key.name == "name",
            "{}",
            key.name
        );
    }
    assert_eq!(parse(&text, &[]).unwrap(), defaults());
}

#[test]
fn spelling_does_not_move_the_canonical_text() {
    let one = "[time]\nduration-h = 24.0\n[region]\nlongitude-deg = [160, -155]\nstep-deg = [5, 5.0]\n\
               [visibility]\nmask-table = [[-0.0, 1e1], [360, 10]]\n[search]\nphasing = [2, 2]";
    let two = "[search]\nphasing = 2\n[region]\nstep-deg = 5\nlongitude-deg = [160.0, 205]\n\
               [visibility]\nmask-table = [[0, 10], [3.6e2, 10]]\n[time]\nduration-h = 2.4e1";
    let (one, two) = (parse(one, &[]).unwrap(), parse(two, &[]).unwrap());
    assert_eq!(one.to_toml(), two.to_toml());
    assert_eq!(one.hash(&[]), two.hash(&[]));
}

/// A key of [accuracy] needs those of the systems in use.
const RANGE_ERRORS: [&str; 8] = [
    "accuracy.leo-m=0.5",
    "accuracy.beidou-3-m=0.6",
    "accuracy.galileo-m=0.7",
    "accuracy.gps-m=0.7",
    "accuracy.glonass-m=0.7",
    "accuracy.qzss-m=0.7",
    "accuracy.navic-m=0.7",
    "accuracy.files-m=0.7",
];

/// Of the times of [reliability], one needs the other, and spares need either.
const TIMES: [&[&str]; 3] = [
    &["reliability.mtbf-h=1000", "reliability.mttr-h=100"],
    &["reliability.mtbf-h=1000", "reliability.mttr-h=50"],
    &[
        "reliability.availability=0.95",
        "reliability.spares-per-plane=1",
    ],
];

fn hashes_of_times() -> [String; 3] {
    TIMES.map(|times| with(times).hash(&[]))
}

#[test]
fn the_hash_moves_with_everything_that_is_computed() {
    let changes = [
        "reference-design=star:90:4/2/1@925",
        "time.epoch=2025-01-01T00:00:01Z",
        "time.duration-h=23",
        "time.step-s=30",
        "earth.surface=sphere",
        "propagation.model=sgp4",
        "region.latitude-deg=[3, 55]",
        "region.longitude-deg=[73, 137]",
        "region.step-deg=4",
        "region.weights=cos-latitude",
        "region.spacing-km=500",
        "region.country=Japan",
        "visibility.mask-deg=8",
        "visibility.gnss-mask-deg=8",
        "visibility.mask-table=[[0, 10], [360, 10]]",
        "visibility.weighting=sine-elevation",
        "visibility.pdop-cap=10",
        "gnss.constellations=[]",
        "gnss.clocks=shared",
        "gnss.leo-clocks=per-part",
        "metrics.window-min=10",
        "outages.satellites=[\"NW-P01-S03\"]",
        "reliability.availability=0.9",
        "objectives.minimize=[\"j-cost\", \"j-pos\"]",
        "objectives.cvar-weight=0.6",
        "objectives.cvar-level=0.9",
        "objectives.constraints=[\"planes <= 12\"]",
        "objectives.availability-pdop=5",
        "objectives.launch-cost-per-satellite=2",
        "objectives.launch-cost-per-plane=6",
        "objectives.launch-cost-per-1000-km=0.3",
        "objectives.hypervolume-reference=[2, 23]",
        "search.pattern=star",
        "search.planes=11",
        "search.satellites-per-plane=11",
        "search.inclination-deg=50",
        "search.altitude-km=925",
        "search.phasing=2",
        "search.inclination-step-deg=1",
        "search.altitude-step-km=10",
        "optimizer.algorithm=mopso",
        "optimizer.population=31",
        "optimizer.crossover-probability=0.9",
        "optimizer.mutation-probability=0.2",
        "optimizer.crossover-index=15",
        "optimizer.mutation-index=20",
        "optimizer.seed=2",
        "search.eccentricity=[0, 0.01]",
        "search.arg-perigee-deg=90",
        "search.eccentricity-step=0.002",
        "search.arg-perigee-step-deg=10",
        "search.raan-deg=10",
        "search.arg-latitude-deg=10",
        "search.node-step-deg=10",
        "search.raan-step-deg=10",
        "search.arg-latitude-step-deg=10",
        "search.node-step-step-deg=2",
        "search.shells=[{ planes = 3 }, {}]",
        "search.fixed=delta:55:4/2/1@800",
    ];
    let mut hashes: Vec<String> = changes
        .iter()
        .map(|change| with(&[change]).hash(&[]))
        .collect();
    let errors: Vec<String> = describe_keys()
        .iter()
        .filter(|key| key.section == "accuracy")
        .map(|key| {
            let value = if key.name.ends_with("-m") {
                "2"
            } else {
                "[1, 2]"
            };
            format!("accuracy.{}={value}", key.name)
        })
        .collect();
    for error in &errors {
        hashes.push(with(&[&RANGE_ERRORS[..], &[error]].concat()).hash(&[]));
    }
    hashes.extend(hashes_of_times());
    // The antenna needs a terrain.
    let antenna = ["region.terrain=t.asc", "region.antenna-height-m=3"];
    hashes.push(with(&antenna).hash(&[]));
    hashes.push(with(&RANGE_ERRORS).hash(&[]));
    hashes.push(defaults().hash(&[]));
    assert!(hashes.iter().all(|hash| hash.len() == 64));
    // name, constellations and the keys of [export]; region.points, region.polygon, region.weight-grid, region.terrain, gnss.files, outages.file;
    // optimizer.generations
    let (labels, files, budgets) = (6, 6, 1);
    let with_conditions = errors.len() + TIMES.len() + antenna[1..].len();
    assert_eq!(
        changes.len() + with_conditions + labels + files + budgets,
        describe_keys().len()
    );
    hashes.sort();
    hashes.dedup();
    assert_eq!(hashes.len(), changes.len() + with_conditions + 2);
}

#[test]
fn the_hash_stays_when_only_labels_and_budgets_change() {
    let labels = [
        "optimizer.generations=31",
        "name=other",
        "constellations={ a = 'star:90:4/2/1@925', b = { files = ['b.tle'] } }",
        "export.originator=ME",
        "export.creation-date=2026-01-01T00:00:00Z",
        "export.name-prefix=X",
        "export.first-catalog-number=1",
    ];
    assert_eq!(with(&labels).hash(&[]), defaults().hash(&[]));
}

#[test]
fn the_hash_covers_the_contents_of_files() {
    let scenario = with(&["region.points=p.csv", "gnss.files=[\"a.tle\", \"b.tle\"]"]);
    assert_eq!(scenario.files(), ["p.csv", "a.tle", "b.tle"]);
    let hash = |contents: [&[u8]; 3]| scenario.hash(&contents);
    let one = hash([b"p", b"ab", b""]);
    assert_ne!(one, hash([b"p", b"a", b"b"]));
    assert_ne!(one, hash([b"q", b"ab", b""]));
    assert_eq!(one, hash([b"p", b"ab", b""]));
    // Not what the files are called.
    let moved = with(&["region.points=q.csv", "gnss.files=[\"c.tle\", \"d.tle\"]"]);
    assert_eq!(moved.hash(&[b"p", b"ab", b""]), one);
    // Nor those of constellations, which are the last.
    let compared = with(&[
        "region.points=p.csv",
        "gnss.files=['a.tle', 'b.tle']",
        "constellations.x.files=['x.tle', 'y.tle']",
    ]);
    let names = ["p.csv", "a.tle", "b.tle", "x.tle", "y.tle"];
    assert_eq!(
        (compared.files(), compared.computed_files()),
        (names.into(), 3)
    );
    assert_eq!(compared.hash(&[b"p", b"ab", b"", b"x", b"y"]), one);
    let grid = with(&["gnss.files=[\"a.tle\"]"]);
    assert_ne!(
        grid.hash(&[b"p"]),
        with(&["region.points=p.csv"]).hash(&[b"p"])
    );
}

#[test]
fn a_reference_design_by_name_counts_as_its_design() {
    let design = "star:90:4/2/1@925";
    let by_notation = with(&[&format!("reference-design={design}")]);
    let by_name = |design| {
        let constellation = format!("constellations.polar={design}");
        with(&["reference-design=polar", &constellation])
    };
    assert_eq!(by_name(design).hash(&[]), by_notation.hash(&[]));
    assert_eq!(by_name(design).differences(&by_notation), []);
    let other = by_name("star:90:6/2/1@925");
    assert_ne!(other.hash(&[]), by_notation.hash(&[]));
    let differences = other.differences(&by_notation);
    assert_eq!(differences[0].key, "reference-design");
}

#[test]
fn regress_the_hash_of_paper() {
    // Runs are found again by this hash: let it move only with a line in the changelog.
    let paper = parse(builtin("paper").unwrap(), &[]).unwrap();
    assert_eq!(&paper.hash(&[])[..16], "f56dc55ee5a0a2b4");
}

#[test]
fn the_reference_lists_every_key() {
    let reference = reference_markdown();
    for key in describe_keys() {
        assert!(
            reference.contains(&format!("\n| `{}` |", key.name)),
            "{}",
            key.name
        );
    }
    let step = "| `step-s` | s | `60` | a number > 0 | Interval between samples |";
    assert!(reference.contains(step), "{reference}");
}
