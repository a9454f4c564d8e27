//! The defaults, the built-in scenarios, the template and the schema.

use chrono::{TimeZone, Utc};

use super::{defaults, parse};
use crate::scenario::values::points;
use crate::scenario::{
    Algorithm, Clocks, Model, ObservationWeights, Pattern, PointWeights, Preset, Quantity, Region,
    Scenario, Surface, builtin, builtin_names, describe_keys, json_schema, template,
};

fn built_in(name: &str) -> Scenario {
    parse(builtin(name).unwrap(), &[]).unwrap()
}

#[test]
fn an_empty_file_has_the_documented_defaults() {
    let scenario = defaults();
    assert_eq!(scenario.name, "scenario");
    assert_eq!(scenario.reference_design, "delta:55:182/13/1@925");
    let midnight = Utc.with_ymd_and_hms(2025, 1, 1, 0, 0, 0).unwrap();
    assert_eq!(scenario.time.epoch, midnight);
    assert_eq!(scenario.time.samples(), 1440);
    assert_eq!(scenario.earth.surface, Surface::Wgs84);
    assert_eq!(scenario.propagation.model, Model::J2);
    let Region::Grid(grid) = scenario.region else {
        panic!("the default region is a grid");
    };
    assert_eq!(grid.latitude_deg, [3.0, 54.0]);
    assert_eq!(grid.longitude_deg, [73.0, 136.0]);
    assert_eq!(grid.step_deg, [5.0, 5.0]);
    assert_eq!(grid.weights, PointWeights::Equal);
    assert_eq!(points(&grid), 143.0);
    let visibility = scenario.visibility;
    assert_eq!((visibility.mask_deg, visibility.gnss_mask_deg), (7.0, 7.0));
    assert_eq!(visibility.pdop_cap, 100.0);
    assert_eq!(visibility.mask_table, []);
    assert_eq!(visibility.weighting, ObservationWeights::Unit);
    assert_eq!(scenario.gnss.constellations, [Preset::Beidou3]);
    assert!(scenario.gnss.files.is_empty());
    assert_eq!(scenario.gnss.clocks, Clocks::PerSystem);
    assert_eq!(scenario.export.originator, "NAVWALKER");
    assert_eq!(scenario.export.creation_date, midnight);
}

#[test]
fn an_empty_file_has_the_documented_search() {
    let scenario = defaults();
    let objectives = scenario.objectives;
    assert_eq!(objectives.minimize, [Quantity::JPos, Quantity::JCost]);
    assert_eq!((objectives.cvar_weight, objectives.cvar_level), (0.5, 0.95));
    assert_eq!(objectives.constraints, []);
    assert_eq!(objectives.availability_pdop, 6.0);
    assert_eq!(objectives.hypervolume_reference, Some(vec![2.0, 22.0]));
    let cost = objectives.launch_cost;
    let parameters = (cost.per_satellite, cost.per_plane, cost.per_1000_km);
    assert_eq!(parameters, (1.0, 5.0, 0.2));
    let search = scenario.search;
    let [designs] = search.shells.as_slice() else {
        panic!("{search:?}");
    };
    assert_eq!(designs.pattern, [Pattern::Delta]);
    assert_eq!(
        (designs.planes, designs.satellites_per_plane),
        ([11, 15], [11, 15])
    );
    assert_eq!(
        (designs.inclination_deg, designs.altitude_km),
        ([40.0, 60.0].into(), [400.0, 1000.0].into())
    );
    assert_eq!(designs.phasing, [1, 1]);
    assert_eq!(
        (
            designs.steps.inclination_step_deg,
            designs.steps.altitude_step_km
        ),
        (0.5, 50.0)
    );
    let optimizer = scenario.optimizer;
    assert_eq!(optimizer.algorithm, Algorithm::Nsga2);
    assert_eq!(
        (optimizer.population, optimizer.generations, optimizer.seed),
        (30, 30, 1)
    );
    assert_eq!(
        (
            optimizer.crossover_probability,
            optimizer.mutation_probability
        ),
        (0.8, 0.1)
    );
    assert_eq!(
        (optimizer.crossover_index, optimizer.mutation_index),
        (5.0, 10.0)
    );
}

#[test]
fn paper_is_the_defaults_on_a_sphere() {
    let mut expected = defaults();
    expected.name = "paper".to_owned();
    expected.earth.surface = Surface::Sphere;
    assert_eq!(built_in("paper"), expected);
}

#[test]
fn regional_is_the_defaults_at_ten_degrees() {
    let mut expected = defaults();
    expected.name = "regional".to_owned();
    expected.visibility.mask_deg = 10.0;
    expected.visibility.gnss_mask_deg = 10.0;
    assert_eq!(built_in("regional"), expected);
}

#[test]
fn every_builtin_has_its_own_name() {
    assert_eq!(
        builtin_names(),
        ["paper", "regional", "global", "europe", "robust"]
    );
    for name in builtin_names() {
        assert_eq!(built_in(name).name, name);
    }
}

#[test]
fn an_unknown_builtin_suggests_the_nearest() {
    let message = builtin("regoinal").unwrap_err().to_string();
    assert_eq!(
        message,
        "unknown name \"regoinal\", did you mean \"regional\"? (choices: paper, regional, global, europe, robust)"
    );
}

#[test]
fn the_template_parses_to_the_defaults() {
    assert_eq!(parse(&template(), &[]).unwrap(), defaults());
}

#[test]
fn the_template_uncommented_is_still_a_scenario() {
    // The lines of keys that follow others are examples, and must be valid ones; other regions
    // exclude the grid, shells the intervals of one, and no constellations, nothing fixed, no
    // orientation, range errors and windows are the default, so these lines stay out.
    let on_demand = describe_keys().into_iter();
    let on_demand = on_demand
        .filter(|key| ["accuracy", "metrics", "outages", "reliability"].contains(&key.section));
    let mut left_out: Vec<&str> = on_demand.map(|key| key.name).collect();
    left_out.extend([
        "points",
        "weight-grid",
        "terrain",
        "antenna-height-m",
        "polygon",
        "country",
        "spacing-km",
        "constellations",
        "shells",
        "fixed",
        "raan-deg",
        "arg-latitude-deg",
        "node-step-deg",
        "raan-step-deg",
        "arg-latitude-step-deg",
        "node-step-step-deg",
    ]);
    let uncommented: String = template()
        .lines()
        .map(|line| match line.strip_prefix("# ") {
            Some(key)
                if key
                    .split_once(" = ")
                    .is_some_and(|(name, _)| left_out.contains(&name)) =>
            {
                String::new()
            }
            Some(key) if key.contains(" = ") => format!("{key}\n"),
            _ if line.starts_with('#') => String::new(),
            _ => format!("{line}\n"),
        })
        .collect();
    assert!(
        uncommented.contains("\ngnss-mask-deg = 7\n"),
        "{uncommented}"
    );
    assert_eq!(parse(&uncommented, &[]).unwrap(), defaults());
}

#[test]
fn the_template_names_unit_range_and_default_of_every_key() {
    let template = template();
    for key in describe_keys() {
        let accepts = format!("\n# Accepts {}", key.accepted);
        let line = format!("{} = {}\n", key.name, key.shown);
        assert!(template.contains(&accepts), "{accepts}");
        assert!(template.contains(&line), "{line}");
    }
    assert!(template.contains("# Accepts a number > 0 and <= 8784, in h.\nduration-h = 24\n"));
}

#[test]
fn the_schema_has_every_key_with_its_default() {
    let schema = json_schema();
    for key in describe_keys() {
        let mut place = &schema["properties"];
        if !key.section.is_empty() {
            place = &place[key.section]["properties"];
        }
        let entry = &place[key.name];
        assert_eq!(entry["description"], key.meaning, "{}", key.name);
        if key.follows.is_none() {
            let default: serde_json::Value = serde_json::from_str(&key.shown).unwrap();
            assert_eq!(entry["default"], default, "{}", key.name);
        }
    }
    let duration = &schema["properties"]["time"]["properties"]["duration-h"];
    assert_eq!(duration["exclusiveMinimum"], 0.0);
    assert_eq!(duration["maximum"], 8784.0);
    assert_eq!(schema["properties"]["time"]["additionalProperties"], false);
}
