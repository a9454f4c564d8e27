//! Exports into memory, for tests.

use super::{Choices, ExportSubject, Naming, Product, Request, ShownScenario, export};
use crate::constellation::Design;
use crate::earth::Surface;
use crate::evaluate::{Evaluator, Setup, testing};
use crate::exchange::constellation::Constellation;
use crate::exchange::manifest::{ExportedStudy, Manifest};
use crate::ground::{Grid, PointWeights, RegionMap};
use crate::orbit::Model;
use crate::time::TimeGrid;
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::sync::{Arc, Mutex};

/// A small region across the antimeridian.
pub(crate) const GRID: Grid = Grid {
    latitude_deg: [-10.0, 50.0],
    longitude_deg: [170.0, 190.0],
    step_deg: [30.0, 10.0],
    weights: PointWeights::Equal,
};

/// A subject for tests: a design of the study `paper`, propagated by J2.
pub(crate) fn subject(design: Design, grid: TimeGrid) -> ExportSubject {
    subject_of(Constellation::of_design(design), grid)
}

/// The same for any constellation.
pub(crate) fn subject_of(constellation: Constellation, grid: TimeGrid) -> ExportSubject {
    ExportSubject {
        constellation,
        down: Vec::new(),
        naming: Naming::default(),
        model: Model::J2,
        grid,
        study: ExportedStudy {
            name: "paper".to_owned(),
            hash: "0123".to_owned(),
        },
        originator: "NAVWALKER".to_owned(),
        creation: grid.epoch(),
        provenance: None,
    }
}

/// A scenario for a subject: the region and BeiDou-3 at 7°.
pub(crate) fn setup(subject: &ExportSubject) -> Setup {
    Setup {
        model: subject.model,
        map: RegionMap::of_grid(&GRID),
        ..testing::setup(subject.grid, GRID.sites(Surface::Wgs84).unwrap(), 7.0)
    }
}

type Contents = Arc<Mutex<BTreeMap<String, Vec<u8>>>>;

/// A file in memory.
struct Kept(Contents, String);

impl Write for Kept {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut files = self.0.lock().unwrap();
        let file = files.entry(self.1.clone()).or_default();
        file.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The manifest and the files of an export by their paths.
pub(crate) fn in_memory(
    subject: &ExportSubject,
    products: &[Product],
    choices: Choices,
) -> (Manifest, BTreeMap<String, Vec<u8>>) {
    let contents = Contents::default();
    let sink = |path: &str| Ok(Kept(Arc::clone(&contents), path.to_owned()));
    let evaluator = Evaluator::new(setup(subject)).unwrap();
    let scenario = ShownScenario {
        evaluator: &evaluator,
        surface: Surface::Wgs84,
    };
    // The ephemerides of STK alone have none.
    let shown = products.iter().any(|one| one.row().needs_scenario());
    let request = Request {
        subject,
        shown: shown.then_some(scenario),
        products,
        choices,
    };
    let manifest = export(&request, &sink).unwrap();
    let files = std::mem::take(&mut *contents.lock().unwrap());
    (manifest, files)
}

/// Whether there is a reader for a file of an export.
pub(crate) fn is_read(path: &str) -> bool {
    let unread = [
        ".geojson",
        ".kml",
        ".script",
        ".cof",
        ".txt",
        ".pnt",
        "metrics/points.csv",
        "metrics/epochs.csv",
        "manifest.json",
    ];
    !unread.iter().any(|end| path.ends_with(end))
}
