//! `dop` and `orbit`, as they are typed.

use crate::cli::ran;
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

/// Four skies whose dilutions others have published; the sources are in `data/studies/skies.toml`.
const SKIES: &str = "sky,elevation_deg,azimuth_deg
overhead,80,0\noverhead,74,120\noverhead,81,240\noverhead,90,300
low,10,0\nlow,10,60\nlow,12,120\nlow,10,200\nlow,12,300
";

fn json(directory: &TempDir, args: &[&str]) -> Value {
    let ran = ran(directory.path(), args);
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    serde_json::from_str(&ran.stdout).unwrap()
}

/// The numbers that a MATLAB function printed in sci.geo.satellite-nav, 21 November 2008, to four decimals.
#[test]
fn validate_dilutions_of_a_table_of_skies() {
    let directory = TempDir::new().unwrap();
    fs::write(directory.path().join("skies.csv"), SKIES).unwrap();
    let value = json(&directory, &["dop", "skies.csv", "--format", "json"]);
    let skies = value.as_array().unwrap();
    for (sky, name, satellites, published) in [
        (&skies[0], "overhead", 4, [60.2554, 7.5906, 59.7754]),
        (&skies[1], "low", 5, [27.1315, 0.9339, 27.1154]),
    ] {
        assert_eq!(
            (&sky["sky"], &sky["satellites"]),
            (&name.into(), &satellites.into())
        );
        for (key, expected) in ["pdop", "hdop", "vdop"].into_iter().zip(published) {
            let ours = sky[key].as_f64().unwrap();
            assert!((ours - expected).abs() <= 5e-5, "{name} {key}: {ours}");
        }
    }
    let text = ran(directory.path(), &["dop", "skies.csv"]).stdout;
    assert!(
        text.contains("60.2554") && text.contains("27.1154"),
        "{text}"
    );
    let csv = ran(directory.path(), &["dop", "skies.csv", "--format", "csv"]).stdout;
    assert!(
        csv.starts_with("sky,satellites,below_mask,gdop,pdop,hdop,vdop,tdop\noverhead,4,0,"),
        "{csv}"
    );
}

#[test]
fn systems_have_clocks_and_unsolved_skies_say_why() {
    let directory = TempDir::new().unwrap();
    let table = "azimuth_deg,elevation_deg,system,prn\n0,5,gps,1\n120,5,gps,2\n240,5,gps,3\n0,90,gps,4\n40,30,galileo,5\n80,3,galileo,6\n";
    fs::write(directory.path().join("two.csv"), table).unwrap();
    let both = json(&directory, &["dop", "two.csv", "--format", "json"]);
    assert_eq!(both[0]["clocks"][1]["system"], "galileo");
    let squares = |sky: &Value| {
        let clocks = sky["clocks"].as_array().unwrap().iter();
        let clocks: f64 = clocks
            .filter_map(|clock| clock["tdop"].as_f64())
            .map(|t| t * t)
            .sum();
        let of = |key: &str| sky[key].as_f64().unwrap().powi(2);
        [
            of("gdop") - of("pdop") - clocks,
            of("pdop") - of("hdop") - of("vdop"),
        ]
    };
    assert!(
        squares(&both[0]).iter().all(|rest| rest.abs() < 1e-12),
        "{both}"
    );
    let csv = ran(directory.path(), &["dop", "two.csv", "--format", "csv"]);
    assert!(
        csv.stdout.starts_with(
            "sky,satellites,below_mask,gdop,pdop,hdop,vdop,tdop,tdop_gps,tdop_galileo\n"
        )
    );
    assert!(
        csv.stderr.contains("columns that are not used: prn"),
        "{}",
        csv.stderr
    );

    let masked = ran(
        directory.path(),
        &["dop", "two.csv", "--mask-deg", "20", "--format", "json"],
    );
    assert_eq!(masked.status, 0);
    let value: Value = serde_json::from_str(&masked.stdout).unwrap();
    assert!(
        value[0]["pdop"].is_null() && value[0]["below_mask"] == 4,
        "{value}"
    );
    assert!(
        masked
            .stderr
            .contains("sky is unsolved: 2 satellites for 5 unknowns"),
        "{}",
        masked.stderr
    );
}

#[test]
fn tables_and_arguments_that_are_wrong_are_refused() {
    let directory = TempDir::new().unwrap();
    fs::write(
        directory.path().join("bad.csv"),
        "azimuth_deg,elevation_deg\n0,5\n10,91\n",
    )
    .unwrap();
    for (args, told) in [
        (
            &["dop", "bad.csv"][..],
            "bad.csv:3: elevation_deg: found \"91\", expected a number from -90 to 90 degrees",
        ),
        (&["dop", "none.csv"], "cannot read none.csv"),
        (
            &["dop", "bad.csv", "--mask-deg", "90"],
            "expected degrees from 0 to below 90",
        ),
        (
            &["dop", "bad.csv", "--clocks", "per-sytem"],
            "did you mean \"per-system\"?",
        ),
        (&["orbit", "delta:97.4:1/1/0"], "delta:97.4:1/1/0"),
        (&["orbit", "delta:97.4:1/1/0@-10"], "altitude"),
        (&["orbit"], "required"),
    ] {
        let ran = ran(directory.path(), args);
        assert_eq!(
            (ran.status, ran.stdout.as_str()),
            (2, ""),
            "{args:?}: {}",
            ran.stderr
        );
        assert!(ran.stderr.contains(told), "{args:?}: {}", ran.stderr);
    }
}

/// Inclinations worked out apart (`orbit::ground_track` has the formula), the repeat of TOPEX/Poseidon, and of each shell its own.
#[test]
fn validate_orbits_as_printed() {
    let directory = TempDir::new().unwrap();
    for (altitude, inclination) in [("500", "97.4018"), ("800", "98.6031"), ("925", "99.1434")] {
        let notation = format!("delta:{inclination}:1/1/0@{altitude}");
        let text = ran(directory.path(), &["orbit", &notation]).stdout;
        let line = text
            .lines()
            .find(|line| line.starts_with("sun-synchronous"))
            .unwrap();
        assert!(line.contains(inclination), "{line}");
        // A turn in a tropical year; a digit of the inclination is 7e-6 °/day.
        let value = json(&directory, &["orbit", &notation, "--format", "json"]);
        let rate = value[0]["nodal_rate_deg_per_day"].as_f64().unwrap();
        assert!((rate - 360.0 / 365.2422).abs() < 7e-6, "{rate}");
        assert!((value[0]["nodal_day_h"].as_f64().unwrap() - 24.0).abs() < 1e-5);
    }
    let two = "delta:66.0408:1/1/0@1336.29238+delta:98:4/2/1@30000";
    let value = json(&directory, &["orbit", two, "--format", "json"]);
    let repeats = value[0]["repeats"].as_array().unwrap();
    let topex = repeats
        .iter()
        .find(|repeat| repeat["nodal_days"] == 10)
        .unwrap();
    assert_eq!(topex["revolutions"], 127);
    assert!(
        (topex["exact_altitude_km"].as_f64().unwrap() - 1336.29238).abs() < 0.05,
        "{topex}"
    );
    assert!(value[1]["sun_synchronous_inclination_deg"].is_null());
    let text = ran(directory.path(), &["orbit", two]).stdout;
    assert!(
        text.contains("sun-synchronous inclination") && text.contains("none"),
        "{text}"
    );
    let csv = ran(directory.path(), &["orbit", two, "--format", "csv"]).stdout;
    let rows = repeats.len() + value[1]["repeats"].as_array().unwrap().len();
    assert_eq!(csv.lines().count(), rows + 1);
}
