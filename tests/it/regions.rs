//! Where users are: countries, polygons, cells of equal area and sites, as typed.

use crate::cli::{ran, refused};
use navwalker::earth::Surface;
use navwalker::evaluate::{Evaluator, Setup};
use navwalker::ground::EqualAreaCells;
use navwalker::time::{Epoch, TimeGrid};
use navwalker::visibility::Mask;
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const EVALUATE: [&str; 6] = [
    "evaluate",
    "--design",
    "delta:55:60/6/1@925",
    "--set",
    "time.step-s=3600",
    "--format=json",
];

/// The JSON of an evaluation with further arguments.
fn evaluated(place: &Path, further: &[&str]) -> Value {
    let ran = ran(place, &[&EVALUATE[..], further].concat());
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    serde_json::from_str(&ran.stdout).unwrap()
}

fn refused_region(setting: &str) -> String {
    refused(&[&EVALUATE[..], &["--set", setting]].concat())
}

/// The rows of points.csv of an evaluation.
fn points(place: &Path, further: &[&str]) -> Vec<(f64, f64)> {
    let all = [&["--series", "series", "--force"], further].concat();
    evaluated(place, &all);
    let text = fs::read_to_string(place.join("series/points.csv")).unwrap();
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let rows = reader.records().map(|row| {
        let row = row.unwrap();
        let number = |n: usize| row[n].parse::<f64>().unwrap();
        (number(0), number(1))
    });
    rows.collect()
}

/// T (1 - cos λ)/2 satellites of T on circular orbits of a spherical Earth are in view of the mean point, λ = acos(R cos ε/r) - ε:
/// the share of the globe in which each is above the mask, at any instant. The count of points in a cap differs from its share of
/// the area by the cells that its edge cuts: at 100 km 51 000 cells, of which a cap of 22° has 1860 and its edge cuts about
/// 150, each with a random remainder, so that one cap is off by 0.3 sqrt(150) = 4 cells or 0.2 %; the mean of 60 satellites at
/// 24 instants by 0.2 %/sqrt(1440) = 6e-5 of the count.
#[test]
fn validate_the_global_mean_in_view() {
    let (altitude_km, mask_deg, satellites) = (925.0, 7.0_f64, 60.0);
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let time = TimeGrid::new(epoch, 24.0 * 3600.0, 3600.0).unwrap();
    let sites = EqualAreaCells::globe(100.0).sites(Surface::Sphere).unwrap();
    let setup = Setup::new(time, sites).with_mask(Mask::from_degrees(mask_deg).unwrap());
    let evaluator = Evaluator::new(setup).unwrap();
    let found = evaluator
        .evaluate(&"delta:55:60/6/1@925".parse().unwrap())
        .unwrap();
    let mask = mask_deg.to_radians();
    let ratio = navwalker::earth::RADIUS_KM / (navwalker::earth::RADIUS_KM + altitude_km);
    let cap = (ratio * mask.cos()).acos() - mask;
    let expected = satellites * (1.0 - cap.cos()) / 2.0;
    let off = found.mean_visible / expected - 1.0;
    assert!(
        off.abs() < 1e-4,
        "{} {expected}: {off:e}",
        found.mean_visible
    );
}

#[test]
fn a_country_has_the_points_of_the_lattice_inside() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let points = points(
        place,
        &[
            "--set",
            "region.country=Lesotho",
            "--set",
            "region.step-deg=0.5",
        ],
    );
    assert!(points.contains(&(-29.5, 28.5)), "{points:?}");
    // Lesotho is 30 355 km²; a cell of half a degree at 29.5° S is 2690 km².
    assert!((9..=14).contains(&points.len()), "{points:?}");
    let around = evaluated(
        place,
        &[
            "--set",
            "region.country=south africa",
            "--set",
            "region.step-deg=0.5",
            "--set",
            "region.weights=cos-latitude",
        ],
    );
    assert!(around["metrics"]["mean_visible"].as_f64().unwrap() > 0.0);
    let two = "region.country=[\"Lesotho\",\"South Africa\"]";
    let both = self::points(place, &["--set", two, "--set", "region.step-deg=0.5"]);
    let alone = self::points(
        place,
        &[
            "--set",
            "region.country=RSA",
            "--set",
            "region.step-deg=0.5",
        ],
    );
    assert_eq!(both.len(), alone.len() + points.len());
}

#[test]
fn an_unknown_country_is_refused_with_the_nearest() {
    let message = refused_region("region.country=Germny");
    assert!(
        message.contains("region.country: unknown country \"Germny\", did you mean \"Germany\"? (the 177 countries of Natural Earth"),
        "{message}"
    );
    let message = refused_region("region.country=[\"China\",\"PRC\"]");
    assert!(
        message.contains("\"PRC\" appears more than once"),
        "{message}"
    );
    let message = refused_region("region.country=Luxembourg");
    assert!(
        message.contains("region.country: no point lies inside the area of ")
            && message.contains("step-deg is 5 degrees; 2 gives 1 point"),
        "{message}"
    );
}

#[test]
fn polygons_come_from_a_file_beside_the_scenario() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let write = |ring: &str| {
        let text = format!(
            r#"{{"type": "Feature", "properties": {{}}, "geometry": {{"type": "Polygon", "coordinates": [{ring}]}}}}"#
        );
        fs::write(place.join("area.geojson"), text).unwrap();
    };
    let set = ["--set", "region.polygon=area.geojson"];
    write("[[10,40],[20,40],[20,50],[10,50],[10,40]]");
    assert_eq!(
        points(place, &set),
        [(40.0, 10.0), (40.0, 15.0), (45.0, 10.0), (45.0, 15.0)]
    );
    // The same places as the grid.
    let grid = [
        "--set",
        "region.latitude-deg=[40,45]",
        "--set",
        "region.longitude-deg=[10,15]",
    ];
    let of_grid = evaluated(place, &grid);
    let of_polygon = evaluated(place, &set);
    assert_eq!(of_polygon["metrics"], of_grid["metrics"]);
    // The polygon is part of the study, its path is not.
    let hash = |json: &Value| json["scenario"]["hash"].as_str().unwrap().to_owned();
    fs::copy(place.join("area.geojson"), place.join("other.geojson")).unwrap();
    let renamed = evaluated(place, &["--set", "region.polygon=other.geojson"]);
    assert_eq!(hash(&renamed), hash(&of_polygon));
    write("[[10,40],[20,40],[20,50],[10,51],[10,40]]");
    assert_ne!(hash(&evaluated(place, &set)), hash(&of_polygon));
    let refused = |ring: &str, message: &str| {
        write(ring);
        let ran = ran(place, &[&EVALUATE[..], &set].concat());
        assert_eq!((ran.status, ran.stdout.as_str()), (2, ""));
        assert!(ran.stderr.contains(message), "{}", ran.stderr);
    };
    refused(
        "[[0,0],[10,10],[10,0],[0,10],[0,0]]",
        "region.polygon: area.geojson: geometry.coordinates: the border crosses itself near longitude 5.0000, latitude 5.0000 degrees",
    );
    refused(
        "[[11,41],[12,41],[12,42],[11,42],[11,41]]",
        "region.polygon: area.geojson: no point lies inside the area of 9",
    );
    refused(
        "[[11,41],[12,41],[12,42]]",
        "geometry.coordinates[0]: found 3 positions",
    );
    let missing = refused_region("region.polygon=none.geojson");
    assert!(
        missing.contains("region.polygon: cannot read none.geojson: "),
        "{missing}"
    );
}

/// A run directory holds a copy of its polygons.
#[test]
fn a_run_keeps_its_polygons() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let text = r#"{"type": "Polygon", "coordinates": [[[10,40],[30,40],[30,60],[10,60],[10,40]]]}"#;
    fs::write(place.join("area.geojson"), text).unwrap();
    let optimize = "optimize --quiet --out run --set region.polygon=area.geojson --set time.step-s=3600 --set optimizer.population=8 \
        --set optimizer.generations=2 --set search.planes=[5,6] --set search.satellites-per-plane=[5,6]";
    let arguments: Vec<&str> = optimize.split_whitespace().collect();
    let made = ran(place, &arguments);
    assert_eq!(made.status, 0, "{}", made.stderr);
    fs::remove_file(place.join("area.geojson")).unwrap();
    let report = ran(place, &["report", "run"]);
    assert_eq!(report.status, 0, "{}", report.stderr);
    let page = fs::read_to_string(place.join("run/report.html")).unwrap();
    assert!(
        page.contains("the polygons in "),
        "the page says what the region is"
    );
    let map = ran(place, &["plot", "run", "--figure", "map", "--as", "svg"]);
    assert_eq!(map.status, 0, "{}", map.stderr);
}

#[test]
fn spacing_replaces_steps_and_excludes_them() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let cells = points(place, &["--set", "region.spacing-km=500"]);
    // 3 to 54° N by 73 to 136° E are 34.5 million km².
    assert!((130..=146).contains(&cells.len()), "{}", cells.len());
    let message = refused(
        &[
            &EVALUATE[..],
            &[
                "--set",
                "region.spacing-km=500",
                "--set",
                "region.step-deg=5",
            ],
        ]
        .concat(),
    );
    assert!(
        message.contains("region.step-deg: excluded by `region.spacing-km`"),
        "{message}"
    );
    let message = refused(
        &[
            &EVALUATE[..],
            &[
                "--set",
                "region.country=China",
                "--set",
                "region.latitude-deg=[0,5]",
            ],
        ]
        .concat(),
    );
    assert!(
        message.contains("region.latitude-deg: excluded by `region.country`"),
        "{message}"
    );
    let many = refused_region("region.spacing-km=1");
    assert!(
        many.contains("region.spacing-km: ") && many.contains("cells, expected at most 1040000"),
        "{many}"
    );
    let china = points(
        place,
        &[
            "--set",
            "region.country=China",
            "--set",
            "region.spacing-km=500",
        ],
    );
    assert!((33..=43).contains(&china.len()), "{}", china.len());
}

/// The scenario formats show cells of equal area and the borders of a country.
#[test]
fn exports_show_cells_and_borders() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let export = "export --quiet --as geojson,czml,kml,stk --out files --design delta:55:2/2/1@925 --set time.duration-h=1 \
        --set region.country=Lesotho --set region.spacing-km=50";
    let arguments: Vec<&str> = export.split_whitespace().collect();
    let made = ran(place, &arguments);
    assert_eq!(made.status, 0, "{}", made.stderr);
    let read = |path: &str| fs::read_to_string(place.join("files").join(path)).unwrap();
    let region: Value = serde_json::from_str(&read("geojson/region.geojson")).unwrap();
    let features = region["features"].as_array().unwrap();
    let (border, cells) = features.split_last().unwrap();
    assert_eq!(border["geometry"]["type"], "MultiLineString");
    // The border encloses the middle of every cell, and is closed.
    let line = border["geometry"]["coordinates"][0].as_array().unwrap();
    assert_eq!(line.first(), line.last());
    let ends = |axis: usize| {
        let along = line.iter().map(|place| place[axis].as_f64().unwrap());
        along.fold((f64::MAX, f64::MIN), |(low, high), x| {
            (low.min(x), high.max(x))
        })
    };
    for (axis, key) in ["longitude_deg", "latitude_deg"].into_iter().enumerate() {
        let (low, high) = ends(axis);
        let within =
            |cell: &Value| (low..=high).contains(&cell["properties"][key].as_f64().unwrap());
        assert!(cells.iter().all(within), "{key}: {low} to {high}");
    }
    assert!((10..=14).contains(&cells.len()));
    assert!(
        cells
            .iter()
            .all(|cell| cell["geometry"]["type"] == "Polygon")
    );
    let kml = read("scene.kml");
    let border = kml
        .split("<name>Border of the region</name>")
        .nth(1)
        .unwrap();
    let border = border.split("</Placemark>").next().unwrap();
    let places = |text: &str| text.matches(',').count();
    assert_eq!(places(border), line.len(), "the same border in both");
    let scene = read("scene.czml");
    assert!(
        scene.contains("region-border:1")
            && scene.contains("inside Lesotho, in the middle of cells of equal area")
    );
}

/// Sites with heights and names: the report has their names, a name that comes twice is refused with both lines.
#[test]
fn sites_have_names_and_heights() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let write = |rows: &str| {
        fs::write(
            place.join("sites.csv"),
            format!("name,latitude_deg,longitude_deg,height_m\n{rows}"),
        )
        .unwrap()
    };
    let set = ["--set", "region.points=sites.csv"];
    write("Zurich,47.38,8.54,\nDavos,46.8,9.84,\n");
    let low = evaluated(place, &set);
    write("Zurich,47.38,8.54,9000\nDavos,46.8,9.84,9000\n");
    let high = evaluated(place, &set);
    // The horizon of a mask does not move with height, but the directions do: PDOP moves by about 9 km of 1000.
    let pdop = |json: &Value| json["metrics"]["mean_pdop"].as_f64().unwrap();
    assert!((pdop(&high) / pdop(&low) - 1.0).abs() < 0.02 && pdop(&high) != pdop(&low));
    let report = "report --design delta:55:60/6/1@925 --set time.step-s=3600 --set region.points=sites.csv --out page.html";
    let made = ran(place, &report.split_whitespace().collect::<Vec<_>>());
    assert_eq!(made.status, 0, "{}", made.stderr);
    let page = fs::read_to_string(place.join("page.html")).unwrap();
    assert!(
        page.contains("id=\"sites\"") && page.contains("\"Davos\""),
        "the page has a table of sites"
    );
    write("Zurich,47.38,8.54,\nZurich,46.8,9.84,\n");
    let twice = ran(place, &[&EVALUATE[..], &set].concat());
    assert_eq!((twice.status, twice.stdout.as_str()), (2, ""));
    let message = "region.points: sites.csv: line 3: the site Zurich is in line 2 already";
    assert!(twice.stderr.contains(message), "{}", twice.stderr);
}

/// A street from north to south between houses: every 10 degrees an azimuth and the elevation of the roofs.
fn street() -> String {
    let line = |n: u32| {
        let across = f64::from(10 * n).to_radians().sin().abs();
        format!(
            "{},{}\n",
            10 * n,
            (30.0 * across / 11.0).atan().to_degrees()
        )
    };
    "azimuth_deg,elevation_deg\n".to_owned() + &(0..36).map(line).collect::<String>()
}

/// Each site under its own skyline, by a file of it; a run keeps what it was made from, and another skyline is another study.
#[test]
fn sites_have_their_own_skylines() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    fs::create_dir_all(place.join("sites/skylines")).unwrap();
    fs::write(place.join("sites/skylines/street.csv"), street()).unwrap();
    let write = |cells: [&str; 2]| {
        let text = format!(
            "name,latitude_deg,longitude_deg,skyline\nStreet,35.7,139.7,{}\nSquare,35.7,139.8,{}\n",
            cells[0], cells[1]
        );
        fs::write(place.join("sites/two.csv"), text).unwrap();
    };
    let points = ["--set", "region.points=sites/two.csv"];
    let visible = |series: &str| -> Vec<f64> {
        let all = [&points[..], &["--series", series]].concat();
        evaluated(place, &all);
        let text = fs::read_to_string(place.join(series).join("points.csv")).unwrap();
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let column = reader
            .headers()
            .unwrap()
            .iter()
            .position(|name| name == "mean_visible");
        let rows = reader
            .records()
            .map(|row| row.unwrap()[column.unwrap()].parse().unwrap());
        rows.collect()
    };
    write(["", ""]);
    let open = visible("open");
    write(["skylines/street.csv", ""]);
    let behind = visible("behind");
    assert!(behind[0] < 0.5 * open[0], "{behind:?} {open:?}");
    assert_eq!(behind[1], open[1]);
    // A skyline is an input, which is no output.
    let plot = "plot --design delta:55:24/6/1@925 --figure map --as csv --out sites/skylines/street.csv --force";
    let words: Vec<&str> = plot.split(' ').chain(points).collect();
    let refused = ran(place, &words);
    assert_eq!(refused.status, 2, "{}", refused.stderr);
    assert_eq!(
        fs::read_to_string(place.join("sites/skylines/street.csv")).unwrap(),
        street()
    );

    let evaluated_in = |run: &str| evaluated(place, &[&points[..], &["--out", run]].concat());
    let first = evaluated_in("run");
    let flat = street().replace("\n90,", "\n90.5,");
    fs::write(place.join("sites/skylines/street.csv"), &flat).unwrap();
    let second = evaluated_in("other");
    assert_ne!(first["scenario"]["hash"], second["scenario"]["hash"]);
    fs::remove_dir_all(place.join("sites")).unwrap();
    let report = ran(place, &["report", "run"]);
    assert_eq!(report.status, 0, "{}", report.stderr);
    let again = [
        "evaluate",
        "run/scenario.toml",
        "--design",
        "delta:55:60/6/1@925",
        "--format=json",
    ];
    let again = ran(place, &again);
    assert_eq!(again.status, 0, "{}", again.stderr);
    let again: Value = serde_json::from_str(&again.stdout).unwrap();
    assert_eq!(again["metrics"], first["metrics"]);
    assert_eq!(again["scenario"]["hash"], first["scenario"]["hash"]);
}

/// What is wrong with a skyline or a terrain is told with its file and line, and nothing is left behind.
#[test]
fn wrong_skylines_and_terrains_are_refused() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let gap = street().replace("\n100,", "\n115,");
    fs::write(place.join("gap.csv"), gap).unwrap();
    let grid = "ncols 3\nnrows 3\nxllcenter 10\nyllcenter 50\ncellsize 0.01\nNODATA_value -1\n5 5 5\n5 5 5\n5 5 -1\n";
    fs::write(place.join("t.asc"), grid).unwrap();
    fs::write(place.join("m.asc"), grid.replace("10", "399960")).unwrap();
    let refused = |sites: &str, further: &[&str]| {
        fs::write(place.join("sites.csv"), sites).unwrap();
        let all = [
            &EVALUATE[..],
            &["--set", "region.points=sites.csv"],
            further,
        ]
        .concat();
        let ran = ran(place, &all);
        assert_eq!((ran.status, ran.stdout.as_str()), (2, ""), "{}", ran.stderr);
        ran.stderr
    };
    let header = "name,latitude_deg,longitude_deg,height_m,skyline\n";
    for (site, terrain, expected) in [
        (
            "A,50,10,,none.csv",
            None,
            "region.points: sites.csv: line 2: skyline: none.csv: cannot read it: ",
        ),
        (
            "A,50,10,,gap.csv",
            None,
            "line 2: skyline: gap.csv: line 13: azimuth 110 degrees follows 115",
        ),
        (
            "A,50,10,,",
            Some("none.asc"),
            "region.terrain: cannot read none.asc",
        ),
        (
            "A,50,11,,",
            Some("t.asc"),
            "region.terrain: t.asc: the site A is outside the terrain",
        ),
        (
            "A,50.01,10.01,1,",
            Some("t.asc"),
            "region.terrain: t.asc: the site A is at 1 m, 4.00 m below the terrain",
        ),
        (
            "A,50.005,10.015,,",
            Some("t.asc"),
            "region.terrain: t.asc: the terrain has a hole (NODATA)",
        ),
        (
            "A,50,10,,",
            Some("m.asc"),
            "region.terrain: m.asc: latitudes 50 to 50.02 and longitudes 399960 to",
        ),
        (
            "A,50,10,,",
            Some("sites.csv"),
            "region.terrain: sites.csv: ",
        ),
    ] {
        let terrain = terrain.map(|file| format!("region.terrain={file}"));
        let set: Vec<&str> = terrain.iter().flat_map(|key| ["--set", key]).collect();
        let message = refused(&format!("{header}{site}\n"), &set);
        // The lines are broken to the width of the terminal.
        let message = message.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(message.contains(expected), "{message}");
    }
    let both = [
        "--set",
        "region.terrain=t.asc",
        "--set",
        "visibility.mask-table=[[0,5],[360,5]]",
    ];
    let message = refused(&format!("{header}A,50,10,,\n"), &both);
    assert!(
        message.contains("visibility.mask-table: excluded by `region.terrain`"),
        "{message}"
    );
    let antenna = ["--set", "region.antenna-height-m=5"];
    let message = refused(&format!("{header}A,50,10,,\n"), &antenna);
    assert!(
        message.contains("a height over the terrain needs `region.terrain`"),
        "{message}"
    );
}
