//! Exports into memory, for tests.

use super::{Choices, Product, Subject, export_scene};
use crate::constellation::gnss::Preset;
use crate::dop::{Clocks, ObservationWeights};
use crate::earth::Surface;
use crate::evaluate::{Evaluator, MetricOptions, Setup};
use crate::formats::manifest::Manifest;
use crate::formats::scene::Scene;
use crate::ground::{Grid, PointWeights};
use crate::stats::Level;
use crate::visibility::Mask;
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

/// A scenario for a subject: the region and BeiDou-3 at 7°.
pub(crate) fn setup(subject: &Subject) -> Setup {
    Setup {
        grid: subject.grid,
        sites: GRID.sites(Surface::Wgs84).unwrap(),
        mask: Mask::from_degrees(7.0).unwrap(),
        gnss_mask: Mask::from_degrees(7.0).unwrap(),
        skyline: None,
        gnss: vec![Preset::Beidou3.into()],
        clocks: Clocks::PerSystem,
        observation_weights: ObservationWeights::Unit,
        pdop_cap: 100.0,
        model: subject.model,
        metrics: MetricOptions {
            cvar_weight: 0.5,
            cvar_level: Level::new(0.95).unwrap(),
            availability_pdop: 6.0,
        },
    }
}

type Contents = Arc<Mutex<BTreeMap<String, Vec<u8>>>>;

/// A file that is kept in memory.
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
    subject: &Subject,
    products: &[Product],
    choices: Choices,
) -> (Manifest, BTreeMap<String, Vec<u8>>) {
    let contents = Contents::default();
    let sink = |path: &str| Ok(Kept(Arc::clone(&contents), path.to_owned()));
    let evaluator = Evaluator::new(setup(subject)).unwrap();
    let scene = Scene::new(&evaluator, subject.design, Surface::Wgs84, Some(GRID));
    // The ephemerides of STK alone have none.
    let shown = [
        Product::Czml,
        Product::Geojson,
        Product::Kml,
        Product::Yuma,
        Product::Metrics,
    ];
    let scene = Some(&scene).filter(|_| products.iter().any(|one| shown.contains(one)));
    let manifest = export_scene(subject, scene, (products, choices), &sink).unwrap();
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
        ".alm",
        ".txt",
        ".pnt",
        "metrics/points.csv",
        "metrics/epochs.csv",
        "manifest.json",
    ];
    !unread.iter().any(|end| path.ends_with(end))
}
