use super::*;
use crate::constellation::Design;
use crate::earth::Surface;
use crate::evaluate::testing;
use crate::exchange::export::testing::{in_memory, subject};
use crate::exchange::export::{Choices, Product};
use crate::exchange::import::ReadFleetError;
use crate::formats::ccsds::oem;
use crate::frames::Frame;
use crate::ground::{Grid, PointWeights};
use crate::time::TimeGrid;
use chrono::TimeDelta;

fn grid() -> TimeGrid {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    TimeGrid::new(epoch, 86_400.0, 1_200.0).unwrap()
}

fn evaluator() -> Evaluator {
    let region = Grid {
        latitude_deg: [0.0, 60.0],
        longitude_deg: [80.0, 140.0],
        step_deg: [20.0, 20.0],
        weights: PointWeights::Equal,
    };
    let setup = testing::setup(grid(), region.sites(Surface::Wgs84).unwrap(), 7.0);
    Evaluator::new(setup).unwrap()
}

fn design() -> Design {
    "delta:40:12/4/1@925".parse().unwrap()
}

/// The satellites of a product as a user would read them back, after a change to the files.
fn read_back(
    product: Product,
    choices: Choices,
    change: &dyn Fn(String) -> String,
) -> Result<Fleet, ReadFleetError> {
    let subject = subject(design(), grid());
    let mut whole: Option<Fleet> = None;
    for (path, bytes) in in_memory(&subject, &[product], choices).1 {
        if path == "manifest.json" || path == "elements.csv" {
            continue;
        }
        let text = change(String::from_utf8(bytes).unwrap());
        let fleet = Fleet::read(text.as_bytes(), None, Some(&path))?.fleet;
        match &mut whole {
            None => whole = Some(fleet),
            Some(whole) => whole.append(fleet),
        }
    }
    Ok(whole.unwrap())
}

/// How a product is read back.
fn reader(product: Product) -> ReadBack {
    product.row().read_back.unwrap()
}

const CHECKED: [Product; 8] = [
    Product::Tle,
    Product::TleStates,
    Product::Omm,
    Product::Oem,
    Product::Opm,
    Product::Sp3,
    Product::Stk,
    Product::Csv,
];

fn as_it_is(text: String) -> String {
    text
}

/// Exports pass, with a gate in metres that the digits of the format explain.
#[test]
fn exports_pass_gates_of_their_digits() {
    let (evaluator, subject) = (evaluator(), subject(design(), grid()));
    let source = ExportSource::new(&subject, Choices::default()).unwrap();
    let original = Original::new(&evaluator, &source).unwrap();
    for product in CHECKED {
        let fleet = read_back(product, Choices::default(), &as_it_is).unwrap();
        let found = original
            .check(&reader(product), ElementChoice::Kozai, &fleet)
            .unwrap();
        assert!(found.passed(), "{product:?}: {found:?}");
        let gate_m = found.position_km.gate.unwrap() * 1e3;
        let most_m = match product {
            Product::Tle | Product::TleStates => 50.0,
            Product::Sp3 => 1.1e-3,
            _ => 1e-4,
        };
        assert!(gate_m < most_m, "{product:?}: {gate_m} m");
        // A gate is at most about a hundred times the value found.
        assert!(
            found.position_km.value > 1e-3 * found.position_km.gate.unwrap(),
            "{product:?}: {found:?}"
        );
        let sgp4 = matches!(product, Product::Tle | Product::TleStates | Product::Omm);
        assert_eq!(
            found.theory_km.is_some_and(|km| km > 1.0),
            sgp4,
            "{product:?}"
        );
    }
}

/// Two satellites swapped.
fn swapped(fleet: &mut Fleet) {
    match fleet {
        Fleet::Sets(sets) => sets.swap(2, 3),
        Fleet::Elements(rows) => rows.swap(2, 3),
        Fleet::Sampled(trajectories) => trajectories.swap(2, 3),
        Fleet::Almanacs(_) | Fleet::Mixed(_) => unreachable!("a product is of one kind"),
    }
}

/// Everything a second late: each state is that of a second before.
fn a_second_late(fleet: &mut Fleet) {
    match fleet {
        Fleet::Sets(sets) => sets
            .iter_mut()
            .for_each(|set| set.datetime += TimeDelta::seconds(1)),
        Fleet::Elements(rows) => rows
            .iter_mut()
            .for_each(|row| row.epoch = row.epoch.plus_seconds(1.0)),
        Fleet::Almanacs(_) | Fleet::Mixed(_) => unreachable!("a product is of one kind"),
        Fleet::Sampled(trajectories) => {
            for arc in trajectories.iter_mut().flat_map(|one| &mut one.arcs) {
                for (_, state) in &mut arc.nodes {
                    state.position_km = state.position_km + -state.velocity_km_s;
                }
            }
        }
    }
}

/// TEME states labelled EME2000.
fn in_another_frame(fleet: &mut Fleet) {
    if let Fleet::Sampled(trajectories) = fleet {
        trajectories
            .iter_mut()
            .flat_map(|one| &mut one.arcs)
            .for_each(|arc| arc.frame = Frame::Eme2000);
    }
}

type Mistake = fn(&mut Fleet);

#[test]
fn planted_mistakes_fail() {
    let (evaluator, subject) = (evaluator(), subject(design(), grid()));
    let source = ExportSource::new(&subject, Choices::default()).unwrap();
    let original = Original::new(&evaluator, &source).unwrap();
    let teme = Choices {
        frame: Frame::Teme,
        ..Choices::default()
    };
    let mistakes: [(&str, Mistake); 3] = [
        ("swapped", swapped),
        ("late", a_second_late),
        ("frame", in_another_frame),
    ];
    for product in CHECKED {
        for (name, mistake) in mistakes {
            let mut fleet = read_back(product, teme, &as_it_is).unwrap();
            // Sets and mean elements are in TEME by definition.
            if name == "frame" && !matches!(fleet, Fleet::Sampled(_)) {
                continue;
            }
            mistake(&mut fleet);
            let found = original.check(&reader(product), ElementChoice::Kozai, &fleet);
            let found = found.unwrap();
            assert!(!found.position_km.passed(), "{product:?} {name}: {found:?}");
        }
    }
    let kepler = Choices {
        elements: ElementChoice::Kepler,
        ..Choices::default()
    };
    let fleet = read_back(Product::Omm, kepler, &as_it_is).unwrap();
    let found = original
        .check(&reader(Product::Omm), ElementChoice::Kepler, &fleet)
        .unwrap();
    assert!(found.position_km.value > 100.0 && !found.passed());
    let mut fleet = read_back(Product::Oem, teme, &as_it_is).unwrap();
    if let Fleet::Sampled(trajectories) = &mut fleet {
        trajectories.pop();
    }
    let error = original
        .check(&reader(Product::Oem), ElementChoice::Kozai, &fleet)
        .unwrap_err();
    assert_eq!(
        error.to_string(),
        "11 satellites were read back; the constellation has 12"
    );
}

/// The same in the text of a file, as another program would have written it.
#[test]
fn a_frame_that_is_misnamed_in_the_file_fails() {
    let (evaluator, subject) = (evaluator(), subject(design(), grid()));
    let source = ExportSource::new(&subject, Choices::default()).unwrap();
    let original = Original::new(&evaluator, &source).unwrap();
    for (notation, from, to) in [
        (
            oem::OemSyntax::Kvn,
            "REF_FRAME = TEME",
            "REF_FRAME = EME2000",
        ),
        (
            oem::OemSyntax::Xml,
            "<REF_FRAME>TEME<",
            "<REF_FRAME>EME2000<",
        ),
    ] {
        let choices = Choices {
            frame: Frame::Teme,
            oem: notation,
            ..Choices::default()
        };
        let change = |text: String| text.replace(from, to);
        let fleet = read_back(Product::Oem, choices, &change).unwrap();
        let found = original
            .check(&reader(Product::Oem), ElementChoice::Kozai, &fleet)
            .unwrap();
        // A third of a degree of precession since 2000 at 7303 km: 41 km.
        let apart_km = found.position_km.value;
        assert!((30.0..60.0).contains(&apart_km), "{apart_km}");
        assert!(!found.passed());
    }
}

#[test]
fn fitted_sets_are_held_against_the_propagated_design() {
    let (evaluator, subject) = (evaluator(), subject(design(), grid()));
    let source = ExportSource::new(&subject, Choices::default()).unwrap();
    let original = Original::new(&evaluator, &source).unwrap();
    let fit = Choices {
        elements: ElementChoice::Fit,
        ..Choices::default()
    };
    let fleet = read_back(Product::Omm, fit, &as_it_is).unwrap();
    let found = original
        .check(&reader(Product::Omm), ElementChoice::Fit, &fleet)
        .unwrap();
    assert!(found.passed() && found.theory_km.is_none(), "{found:?}");
}
