//! Exports of several shells and of satellites from files, read back.

use crate::evaluate::Evaluator;
use crate::exchange::constellation::{Constellation, FileSatellites};
use crate::exchange::export::testing::{in_memory, setup, subject, subject_of};
use crate::exchange::export::{
    Choices, ExportSource, ExportSubject, Naming, Product, Request, export,
};
use crate::exchange::import::{Fleet, FleetError};
use crate::exchange::manifest::Manifest;
use crate::exchange::read_back::{Grouping, Original};
use crate::formats::metadata::ElementChoice;
use crate::formats::tle;
use crate::keyword::Keyword;
use crate::orbit::Model;
use crate::time::{Epoch, TimeGrid};
use std::collections::BTreeMap;
use std::io;

pub(super) type Files = BTreeMap<String, Vec<u8>>;

/// Two shells of different heights, whose satellites are far from each other.
const HYBRID: &str = "delta:53:8/4/1@1000+star:86.4:6/3/1@600";

/// Products with the satellites of a constellation.
const READ: [Product; 9] = [
    Product::Tle,
    Product::TleStates,
    Product::Omm,
    Product::Oem,
    Product::Opm,
    Product::Sp3,
    Product::Stk,
    Product::Csv,
    Product::Czml,
];

pub(super) fn grid() -> TimeGrid {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    TimeGrid::new(epoch, 7_200.0, 120.0).unwrap()
}

/// Files of a product in the order of the manifest, as they are read together; `change` plants errors in a file's path
/// and text.
fn read(
    product: Product,
    (manifest, files): &(Manifest, Files),
    change: fn(&str) -> String,
) -> Result<Fleet, String> {
    let mut whole: Option<Fleet> = None;
    for file in &manifest.files {
        if product == Product::Csv && file.path == "elements.csv" {
            continue;
        }
        let text = change(std::str::from_utf8(&files[&file.path]).unwrap());
        let read = Fleet::read(text.as_bytes(), None, Some(&change(&file.path)));
        let fleet = read
            .map_err(|error| format!("{}: {error}", file.path))?
            .fleet;
        match &mut whole {
            None => whole = Some(fleet),
            Some(whole) => whole.append(fleet),
        }
    }
    Ok(whole.unwrap())
}

fn as_it_is(text: &str) -> String {
    text.to_owned()
}

fn letters_swapped(text: &str) -> String {
    text.replace("NW-A-", "NW-?-")
        .replace("NW-B-", "NW-A-")
        .replace("NW-?-", "NW-B-")
}

fn letters_dropped(text: &str) -> String {
    text.replace("NW-A-", "NW-").replace("NW-B-", "NW-")
}

/// What is wrong with satellites by their names, compared with a constellation: names of none, and places that are more
/// than `most_km` from those of the name.
fn wrong_identities(fleet: &Fleet, constellation: &Constellation, most_km: f64) -> Vec<String> {
    let truth = constellation.ephemeris(grid(), Model::J2).unwrap();
    let found = match fleet.propagate(grid(), Model::J2) {
        Ok(found) => found,
        Err(error) => return vec![error.to_string()],
    };
    let mut wrong = Vec::new();
    for satellite in found.satellites() {
        let mut all = truth.satellites().iter();
        let Some(known) = all.find(|one| one.name == satellite.name) else {
            wrong.push(format!("{} is unknown", satellite.name));
            continue;
        };
        let [one, other] = [(&found, satellite), (&truth, known)]
            .map(|(of, satellite)| of.state(satellite, 3_600.0).unwrap().position_km);
        if (one - other).norm() > most_km {
            wrong.push(format!("{} is elsewhere", satellite.name));
        }
    }
    if found.satellites().len() != truth.satellites().len() {
        wrong.push(format!("{} satellites", found.satellites().len()));
    }
    wrong
}

/// Shell, plane and slot come back by name from every format; SGP4 is within the 40 km of its budget.
#[test]
fn hybrids_come_back_by_name_from_every_format() {
    let design: crate::constellation::Design = HYBRID.parse().unwrap();
    let constellation = Constellation::of_design(design.clone());
    for product in READ {
        let files = in_memory(
            &subject(design.clone(), grid()),
            &[product],
            Choices::default(),
        );
        let wrong = |change| match read(product, &files, change) {
            Ok(fleet) => wrong_identities(&fleet, &constellation, 40.0),
            Err(error) => vec![error],
        };
        assert_eq!(wrong(as_it_is), Vec::<String>::new(), "{product}");
        for planted in [letters_swapped, letters_dropped] {
            assert!(!wrong(planted).is_empty(), "{product}");
        }
    }
}

/// The gates of `--check` hold for a constellation in every product that is read back.
fn passes_its_gates(subject: &ExportSubject, choices: Choices, products: &[Product]) {
    let evaluator = Evaluator::new(setup(subject)).unwrap();
    let source = ExportSource::new(subject, choices).unwrap();
    let original = Original::new(&evaluator, &source).unwrap();
    for product in products {
        let files = in_memory(subject, &[*product], choices);
        let mut fleet = read(*product, &files, as_it_is).unwrap();
        if *product == Product::Sp3 {
            fleet.name_by_place();
        }
        let read_back = product.row().read_back.unwrap();
        assert!(matches!(
            read_back.files,
            Grouping::Together | Grouping::Each
        ));
        let found = original
            .check(&read_back, choices.elements, &fleet)
            .unwrap();
        assert!(found.passed(), "{product}: {found:?}");
    }
}

#[test]
fn hybrids_pass_the_gates_of_their_digits() {
    passes_its_gates(
        &subject(HYBRID.parse().unwrap(), grid()),
        Choices::default(),
        &READ,
    );
}

/// Satellites of a file that another program could have written.
pub(super) fn of_file(name: &str, bytes: &[u8]) -> Constellation {
    let imported = Fleet::read(bytes, None, Some(name)).unwrap();
    Constellation::of_files(FileSatellites::of_file(name.to_owned(), imported))
}

/// A star of 6 in one file of a product.
fn star(product: Product, path: &str) -> Vec<u8> {
    let subject = ExportSubject {
        naming: Naming {
            prefix: "IR".to_owned(),
            first_catalog_number: 24_793,
        },
        ..subject("star:86.4:6/3/1@780".parse().unwrap(), grid())
    };
    let (_, mut files) = in_memory(&subject, &[product], Choices::default());
    files.remove(path).unwrap()
}

pub(super) fn exported(constellation: Constellation, product: Product) -> (Manifest, Files) {
    in_memory(
        &subject_of(constellation, grid()),
        &[product],
        Choices::default(),
    )
}

#[test]
fn element_sets_go_out_as_they_came_and_as_states_by_sgp4() {
    let source = star(Product::Tle, "constellation.tle");
    let constellation = of_file("iridium.tle", &source);
    let (manifest, files) = exported(constellation.clone(), Product::Tle);
    let [written, read] =
        [&files["constellation.tle"], &source].map(|bytes| std::str::from_utf8(bytes).unwrap());
    assert_eq!(written, read);
    assert_eq!(manifest.files[0].theory, "SGP4 elements of the source");
    assert_eq!(manifest.design, None);
    let converted = manifest.converted.unwrap();
    assert_eq!(
        converted,
        "6 satellites from iridium.tle (tle: SGP4 element sets); theory of their states: SGP4 from the elements of the \
         source"
    );
    let (manifest, files) = exported(constellation.clone(), Product::Omm);
    assert_eq!(manifest.files.len(), 6);
    let text = std::str::from_utf8(&files["omm/IR-P01-S02.omm"]).unwrap();
    for line in ["OBJECT_NAME = IR-P01-S02\n", "NORAD_CAT_ID = 24794\n"] {
        assert!(text.contains(line), "{text}");
    }
    let read_back = READ.into_iter().filter(|product| *product != Product::Opm);
    let read_back: Vec<Product> = read_back.collect();
    passes_its_gates(
        &subject_of(constellation.clone(), grid()),
        Choices::default(),
        &read_back,
    );
    let (manifest, files) = exported(constellation.clone(), Product::Opm);
    let text = std::str::from_utf8(&files["opm/IR-P03-S02.opm"]).unwrap();
    assert!(!text.contains("USER_DEFINED") && text.contains("SEMI_MAJOR_AXIS"));
    assert!(
        manifest.files[0]
            .loss
            .note
            .as_ref()
            .unwrap()
            .contains("without mean elements")
    );
    let (manifest, files) = exported(constellation, Product::Gmat);
    let text = std::str::from_utf8(&files["gmat/navwalker.script"]).unwrap();
    assert_eq!(text.matches("Create Spacecraft IR_P").count(), 6);
    let told = manifest.files[0].assumptions.concat();
    assert!(told.contains("osculating state at the epoch") && !told.contains("mean elements"));
}

/// States of SGP4 give back its elements: the fit is within the digits of the states and its own convergence, a metre.
#[test]
fn states_become_element_sets_by_a_fit_only() {
    let source = star(Product::TleStates, "tle-states.csv");
    let constellation = of_file("states.csv", &source);
    let subject = subject_of(constellation, grid());
    for product in [
        Product::Tle,
        Product::Omm,
        Product::TleStates,
        Product::Yuma,
    ] {
        let request = Request {
            subject: &subject,
            shown: None,
            products: &[Product::Csv, product],
            choices: Choices::default(),
        };
        let sink = |path: &str| -> io::Result<Vec<u8>> { panic!("{path} is written") };
        let error = export(&request, &sink).unwrap_err().to_string();
        let start = format!("{product} cannot hold the satellites of states.csv: ");
        assert!(error.starts_with(&start), "{error}");
    }
    let fitted = Choices {
        elements: ElementChoice::Fit,
        ..Choices::default()
    };
    let (manifest, files) = in_memory(&subject, &[Product::Tle], fitted);
    let loss = &manifest.files[0].loss;
    assert!(loss.theory_max_km.unwrap() < 1e-3, "{loss:?}");
    let sets = tle::read(files["constellation.tle"].as_slice()).unwrap();
    assert_eq!(sets[1].object_name.as_deref(), Some("IR-P01-S02"));
    passes_its_gates(
        &subject,
        fitted,
        &READ.map(|product| match product {
            Product::Opm => Product::Oem,
            other => other,
        }),
    );
}

/// No format here writes gaps, so a satellite with one is named before anything is written.
#[test]
fn a_satellite_with_a_gap_is_named() {
    let table = String::from_utf8(star(Product::TleStates, "tle-states.csv")).unwrap();
    // The last row of one satellite.
    let ends = |line: &&str| line.starts_with("IR-P02-S01,2025-01-01T01:58:");
    let text: Vec<&str> = table.lines().filter(|line| !ends(line)).collect();
    assert_eq!(text.len(), table.lines().count() - 1);
    let subject = subject_of(of_file("gap.csv", text.join("\n").as_bytes()), grid());
    let request = Request {
        subject: &subject,
        shown: None,
        products: &[Product::Oem],
        choices: Choices::default(),
    };
    let sink = |path: &str| -> io::Result<Vec<u8>> { panic!("{path} is written") };
    let error = export(&request, &sink).unwrap_err().to_string();
    let start = "IR-P02-S01 has no state at 2025-01-01T01:58:00Z: leave it out with --exclude";
    assert!(error.starts_with(start), "{error}");
}

#[test]
fn a_keplerian_slot_is_not_for_element_sets_of_a_file() {
    let constellation = of_file("a.tle", &star(Product::Tle, "constellation.tle"));
    let request = Request {
        subject: &subject_of(constellation, grid()),
        shown: None,
        products: &[Product::Tle],
        choices: Choices {
            elements: ElementChoice::Kepler,
            ..Choices::default()
        },
    };
    let sink = |_: &str| -> io::Result<Vec<u8>> { Ok(Vec::new()) };
    let error = export(&request, &sink).unwrap_err().to_string();
    assert!(error.contains("omit --tle-theory kepler"), "{error}");
}

/// Shells beside satellites of a file, whose numbers are taken.
#[test]
fn shells_and_files_go_out_together() {
    let tle = star(Product::Tle, "constellation.tle");
    let mixed = Constellation {
        design: Some("delta:53:8/4/1@1000".parse().unwrap()),
        ..of_file("iridium.tle", &tle)
    };
    let subject = ExportSubject {
        naming: Naming {
            prefix: "NW".to_owned(),
            // 24793 is that of the first in the file.
            first_catalog_number: 24_790,
        },
        ..subject_of(mixed, grid())
    };
    let (manifest, files) = in_memory(&subject, &[Product::Tle], Choices::default());
    let sets = tle::read(files["constellation.tle"].as_slice()).unwrap();
    let numbers: Vec<u64> = sets.iter().map(|set| set.norad_id).collect();
    assert_eq!(numbers[..4], [24_790, 24_791, 24_792, 24_799]);
    assert_eq!(
        numbers[8..],
        [24_793, 24_794, 24_795, 24_796, 24_797, 24_798]
    );
    assert_eq!(
        manifest.files[0].theory,
        "SGP4 elements, Kozai mean motion dM/dt of secular J2; SGP4 elements of the source"
    );
    let products = [
        Product::Tle,
        Product::Oem,
        Product::Sp3,
        Product::Csv,
        Product::Czml,
    ];
    passes_its_gates(&subject, Choices::default(), &products);
    let (_, files) = in_memory(&subject, &[Product::Csv], Choices::default());
    assert!(!files.contains_key("elements.csv"));
}

/// Two exports are told apart by prefix and numbers, in every format that names satellites; with the same they are not.
#[test]
fn two_exports_are_read_together() {
    let of = |prefix: &str, first_catalog_number, design: &str| ExportSubject {
        naming: Naming {
            prefix: prefix.to_owned(),
            first_catalog_number,
        },
        ..subject(design.parse().unwrap(), grid())
    };
    let first = of("NW", 90_001, "delta:53:8/4/1@1000");
    let second = of("EU-2", 95_001, "star:86.4:6/3/1@600");
    let same = of("NW", 90_001, "star:86.4:6/3/1@600");
    for product in READ {
        let fleets = [&first, &second, &same].map(|subject| {
            read(
                product,
                &in_memory(subject, &[product], Choices::default()),
                as_it_is,
            )
            .unwrap()
        });
        let [first, second, same] = fleets;
        let mut together = first.clone();
        together.append(second);
        let found = together.propagate(grid(), Model::J2).unwrap();
        assert_eq!(found.satellites().len(), 14, "{product}");
        assert!(
            found
                .satellites()
                .iter()
                .any(|one| one.name == "EU-2-P01-S01"),
            "{product}"
        );
        let mut clash = first;
        clash.append(same);
        let error = clash.propagate(grid(), Model::J2).err();
        let repeated = matches!(
            error,
            Some(FleetError::Repeated(_) | FleetError::TwoNames(..))
        );
        assert!(repeated, "{product}: {error:?}");
    }
    let late = of("NW", 339_995, "delta:53:8/4/1@1000");
    let request = Request {
        subject: &late,
        shown: None,
        products: &[Product::Csv],
        choices: Choices::default(),
    };
    let sink = |path: &str| -> io::Result<Vec<u8>> { panic!("{path} is written") };
    let error = export(&request, &sink).unwrap_err().to_string();
    assert!(
        error.starts_with(
            "export.first-catalog-number: from 339995 on there are too few numbers for 8 satellites"
        ),
        "{error}"
    );
}

/// Maps and tables tell shells apart.
#[test]
fn shells_show_in_maps_and_tables() {
    let products = [
        Product::Czml,
        Product::Kml,
        Product::Geojson,
        Product::Csv,
        Product::Gmat,
    ];
    let (_, files) = in_memory(
        &subject(HYBRID.parse().unwrap(), grid()),
        &products,
        Choices::default(),
    );
    let text = |path: &str| std::str::from_utf8(&files[path]).unwrap();
    let packets: Vec<serde_json::Value> = serde_json::from_str(text("scene.czml")).unwrap();
    let packet = |id: &str| packets.iter().find(|packet| packet["id"] == id).unwrap();
    let colour = |id: &str| packet(id)["point"]["color"].clone();
    assert_eq!(colour("NW-A-P01-S01"), colour("NW-A-P04-S02"));
    assert_ne!(colour("NW-A-P01-S01"), colour("NW-B-P01-S01"));
    assert_eq!(
        packet("NW-B-P02-S01")["description"],
        "shell B, plane 2, place 1"
    );
    let orbits = packets.iter().filter(|packet| packet.get("path").is_some());
    assert_eq!(orbits.count(), 7);
    // Half a period of each shell: 1000 km and 600 km.
    assert_eq!(packet("NW-A-P01-S01")["path"]["leadTime"], 3_154.0);
    assert_eq!(packet("NW-B-P01-S01")["path"]["leadTime"], 2_901.0);
    let kml = text("scene.kml");
    assert!(kml.contains("<Style id=\"shellA\">") && kml.contains("<Style id=\"shellB\">"));
    assert!(kml.contains(
        "<description>shell B, plane 2, place 1</description><styleUrl>#shellB</styleUrl>"
    ));
    assert!(text("geojson/footprints.geojson").contains("\"shell\":\"B\""));
    let mut elements = csv::Reader::from_reader(files["elements.csv"].as_slice());
    assert_eq!(&elements.headers().unwrap()[3], "shell");
    let rows: Vec<_> = elements.records().map(Result::unwrap).collect();
    assert_eq!((&rows[0][3], &rows[13][3], &rows[13][4]), ("A", "B", "3"));
    let script = text("gmat/navwalker.script");
    assert_eq!(script.matches(".OrbitColor = [").count(), 14);
    let keyword = Product::Gmat.keyword();
    assert!(files.keys().any(|path| path.starts_with(keyword)));
}
