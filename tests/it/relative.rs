//! Satellites and shells with respect to each other, and orbits with respect to the Earth and the Sun, as a user sees them.

use crate::cli::{ran, refused};
use serde_json::Value;
use tempfile::TempDir;

const SMALL: [&str; 6] = [
    "--set",
    "region.step-deg=20",
    "--set",
    "time.step-s=1200",
    "--set",
    "time.duration-h=4",
];

const HYBRID: &str = "delta:53:12/3/1@1100+star:90:8/2/1@1100";

fn json(arguments: &[&str]) -> Value {
    let place = TempDir::new().unwrap();
    let ran = ran(place.path(), &[arguments, &["--format", "json"]].concat());
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    serde_json::from_str(&ran.stdout).unwrap()
}

fn evaluated(arguments: &[&str]) -> Value {
    json(&[&["evaluate"], &SMALL[..], arguments].concat())
}

/// F = 0 to 12 of 182/13 at 55° and 925 km, computed elsewhere by brute force.
#[test]
fn validate_the_table_of_separations_by_phasing() {
    let table = json(&["separation", "delta:55:182/13/5@925", "--all-phasings"]);
    let expected = [
        134.20, 460.94, 12.54, 31.08, 50.05, 33.68, 155.13, 187.27, 161.63, 298.97, 403.43, 14.02,
        25.18,
    ];
    let rows = table.as_array().unwrap();
    assert_eq!(rows.len(), 13);
    for (row, expected) in rows.iter().zip(expected) {
        let ours = row["least_separation_km"].as_f64().unwrap();
        assert!(
            (ours - expected).abs() <= 0.005,
            "{}: {ours}",
            row["notation"]
        );
        assert!(row["separations"][0]["satellites"][1].is_string());
    }
    let place = TempDir::new().unwrap();
    let text = ran(place.path(), &["separation", HYBRID, "--duration-h", "2"]).stdout;
    assert!(
        text.contains("A-B") && text.contains("within 2 h"),
        "{text}"
    );
    assert!(text.contains("-0.4 to +4.4 km"), "{text}");
    let told = refused(&["separation", HYBRID, "--duration-h", "0"]);
    assert!(told.contains("hours above 0, at most 8784"), "{told}");
}

/// As a constraint it needs no evaluation, and files have none.
#[test]
fn a_separation_is_a_constraint() {
    let bound = "objectives.constraints=[\"least-separation-km >= 100\"]";
    let verdict = |phasing: usize| {
        let design = format!("delta:55:182/13/{phasing}@925");
        let found = evaluated(&["--set", bound, "--design", &design]);
        let separation = &found["separation"][0]["least_km"];
        assert_eq!(&found["constraints"][0]["value"], separation);
        found["constraints"][0]["met"].as_bool().unwrap()
    };
    assert!(verdict(1));
    assert!(!verdict(2));
}

#[test]
fn metrics_spread_over_relative_nodes() {
    let found = evaluated(&["--design", HYBRID, "--relative-nodes", "3"]);
    let nodes = &found["relative_nodes"];
    let rate = nodes["pairs"][0]["rate_deg_per_day"].as_f64().unwrap();
    assert!((rate - 3.436).abs() < 5e-4, "{rate}");
    assert_eq!(nodes["spread"]["nodes"], 3);
    let of = |part: &str| {
        let metric = &nodes["spread"]["metrics"]["mean_visible"];
        metric[part].as_f64().unwrap()
    };
    assert!(of("min") < of("mean") && of("mean") < of("max"));
    // The node of the design is one of them, and another is that of the turned design.
    let own = found["metrics"]["mean_visible"].as_f64().unwrap();
    let turned = HYBRID.to_owned() + ",raan=120";
    let later = evaluated(&["--design", &turned]);
    let later = later["metrics"]["mean_visible"].as_f64().unwrap();
    for value in [own, later] {
        assert!(of("min") <= value && value <= of("max"), "{value}");
    }
    let flag = ["--relative-nodes", "3"];
    let one = ["evaluate", "--design", "delta:53:12/3/1@1100"];
    let told = refused(&[&one[..], &flag].concat());
    assert!(told.contains("one shell"), "{told}");
    let slow = [
        "evaluate",
        "--design",
        "delta:53:12/3/1@1100+delta:53:4/2/1@1100,u=7",
    ];
    let told = refused(&[&slow[..], &flag].concat());
    assert!(
        told.contains("shells A and B turn against each other by 0.000° a year"),
        "{told}"
    );
    let place = TempDir::new().unwrap();
    let csv = [
        &["evaluate", "--design", HYBRID, "--format", "csv"],
        &flag[..],
        &SMALL,
    ]
    .concat();
    let csv = ran(place.path(), &csv).stdout;
    let mut lines = csv.lines();
    let [header, row, gnss] = [(); 3].map(|()| lines.next().unwrap().split(',').count());
    assert!(csv.contains("mean_pdop_nodes_max"), "{csv}");
    assert_eq!((row, gnss), (header, header));
}

/// Every candidate has the altitude at which its track repeats.
#[test]
fn a_search_follows_the_ground_track() {
    let place = TempDir::new().unwrap();
    let small = [
        "optimize",
        "--out",
        "out",
        "--format",
        "json",
        "--set",
        "optimizer.population=4",
        "--set",
        "optimizer.generations=2",
        "--set",
        "search.altitude-km=repeat:14/1",
    ];
    let ran = ran(place.path(), &[&small[..], &SMALL].concat());
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    let result: Value = serde_json::from_str(&ran.stdout).unwrap();
    for member in result["front"].as_array().unwrap() {
        let orbit = json(&["orbit", member["design"]["notation"].as_str().unwrap()]);
        let per_day = orbit[0]["revolutions_per_nodal_day"].as_f64().unwrap();
        // Altitudes are rounded to a millimetre, 3e-9 revolutions.
        assert!((per_day - 14.0).abs() < 1e-8, "{per_day}");
    }
    let both = json(&["orbit", "delta:sun-synchronous:1/1/0@repeat:233/16"]);
    let notation = both[0]["notation"].as_str().unwrap();
    assert!(notation.starts_with("delta:98."), "{notation}");
    let told = refused(&["orbit", "delta:55:1/1/0@repeat:18/1"]);
    assert!(
        told.contains("repeat:18/1 needs an orbit whose perigee is below the ground"),
        "{told}"
    );
    let told = refused(&["orbit", "delta:55:1/1/0@repeat:15"]);
    assert!(told.contains("repeat:REVOLUTIONS/DAYS"), "{told}");
}

/// What first-order J2 is off by in five years, known beforehand, and what drag and the rules of disposal ask for.
#[test]
fn validate_what_years_do_to_a_design() {
    let found = json(&["lifetime", "delta:40:182/13/1@925", "delta:55:182/13/1@925"]);
    let shell = |n: usize| &found[n]["shells"][0];
    for (n, expected_deg) in [(0, 20.0), (1, 0.2)] {
        let off = shell(n)["node_off_in_5_years_deg"].as_f64().unwrap();
        // One digit is known.
        assert!((off.abs() / expected_deg - 1.0).abs() < 0.1, "{off}");
    }
    let drag = shell(1)["drag"].as_array().unwrap();
    assert_eq!(drag.len(), 3);
    let mut years = Vec::new();
    for one in drag {
        let of = |n: usize, key: &str| one["disposals"][n][key].as_f64().unwrap();
        years.push(one["decay_years"].as_f64().unwrap());
        assert_eq!([0, 1].map(|n| of(n, "years")), [5.0, 25.0]);
        let [lower, higher] = [0, 1].map(|n| of(n, "altitude_km"));
        assert!(300.0 < lower && lower < higher && higher < 925.0);
        assert!(of(0, "delta_v_m_s") > of(1, "delta_v_m_s"));
    }
    // At 925 km neither 5 nor 25 years are kept without help, and a more active Sun brings satellites down sooner.
    assert!(years.is_sorted_by(|one, next| one > next) && years[2] > 25.0);
    let place = TempDir::new().unwrap();
    let csv = ran(
        place.path(),
        &["lifetime", HYBRID, "--format", "csv", "--mass-kg", "100"],
    )
    .stdout;
    // A header, and three activities for each of two shells.
    assert_eq!(csv.lines().count(), 7, "{csv}");
    let text = ran(place.path(), &["lifetime", HYBRID]).stdout;
    assert!(text.contains("node of B against that of A: +3.4"), "{text}");
    assert!(!text.contains("-0.00000"), "{text}");
    let ellipse = ran(place.path(), &["lifetime", "lattice:63:4/2/1@1500,e=0.1"]).stdout;
    assert!(ellipse.contains("for circular orbits only"), "{ellipse}");
    // The perigee of a critical inclination stands still under J2 alone, and on a circle there is none.
    let critical = json(&[
        "lifetime",
        "lattice:63.4349488229220:4/2/1@1500,e=0.05",
        "delta:55:4/2/1@1500",
    ]);
    let perigee = &critical[0]["shells"][0]["perigee"];
    // Its digits: 1e-13 degrees of 63 are nothing beside the 3e-3 deg/day of J2² and J4.
    assert!(
        perigee["j2_deg_per_day"].as_f64().unwrap().abs() < 1e-10,
        "{perigee}"
    );
    let zonal = perigee["zonal_deg_per_day"].as_f64().unwrap().abs();
    assert!(1e-4 < zonal && zonal < 0.1, "{perigee}");
    assert!(critical[1]["shells"][0]["perigee"].is_null());
    let high = ran(place.path(), &["lifetime", "delta:55:4/2/1@1600"]).stdout;
    assert!(high.contains("above 1500 km the density"), "{high}");
}

#[test]
fn lifetimes_that_cannot_be_are_refused() {
    for (arguments, told) in [
        (&["lifetime"][..], "required"),
        (
            &["lifetime", "delta:55:6/3/1@925", "--mass-kg", "0"],
            "the mass in kg must be above 0",
        ),
        (
            &["lifetime", "delta:55:6/3/1@925", "--area-m2", "0"],
            "the area in m² must be above 0",
        ),
        (
            &["lifetime", "delta:55:6/3/1@925", "--box-km", "0"],
            "kilometres above 0",
        ),
        (&["lifetime", "delta:55:6/3/1@110"], "is in the atmosphere"),
        (
            &["lifetime", "lattice:63:4/2/1@1500,e=0.18"],
            "is in the atmosphere",
        ),
    ] {
        let error = refused(arguments);
        assert!(error.contains(told), "{arguments:?}: {error}");
    }
}
