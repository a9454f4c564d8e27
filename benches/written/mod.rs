//! The subject of an export, and its files in memory.

use navwalker::exchange::constellation::Constellation;
use navwalker::exchange::export::{Choices, ExportSubject, Naming, Product, Request, export};
use navwalker::exchange::manifest::ExportedStudy;
use navwalker::orbit::Model;
use navwalker::time::{Epoch, TimeGrid};
use std::io;
use std::sync::Mutex;

const SOUND: &str = "the design can be exported";

/// A design propagated by J2, with its samples a minute apart.
pub(crate) fn subject(design: &str, samples: usize) -> ExportSubject {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().expect("a date"));
    ExportSubject {
        constellation: Constellation::of_design(design.parse().expect(SOUND)),
        down: Vec::new(),
        naming: Naming::default(),
        model: Model::J2,
        grid: TimeGrid::new(epoch, samples as f64 * 60.0, 60.0).expect(SOUND),
        study: ExportedStudy {
            name: "bench".to_owned(),
            hash: String::new(),
        },
        originator: "NAVWALKER".to_owned(),
        creation: epoch,
        provenance: None,
    }
}

/// A file that is kept.
struct Kept<'a>(&'a Mutex<Vec<(String, Vec<u8>)>>, String, Vec<u8>);

impl io::Write for Kept<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.2.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Drop for Kept<'_> {
    fn drop(&mut self) {
        let file = (std::mem::take(&mut self.1), std::mem::take(&mut self.2));
        self.0.lock().expect(SOUND).push(file);
    }
}

/// The files of a product without the manifest: path and bytes.
pub(crate) fn files(
    subject: &ExportSubject,
    product: Product,
    choices: Choices,
) -> Vec<(String, Vec<u8>)> {
    let kept = Mutex::new(Vec::new());
    let sink = |path: &str| Ok(Kept(&kept, path.to_owned(), Vec::new()));
    let request = Request {
        subject,
        shown: None,
        products: &[product],
        choices,
    };
    export(&request, &sink).expect(SOUND);
    let mut files = kept.into_inner().expect(SOUND);
    files.retain(|(path, _)| path != "manifest.json");
    files
}
