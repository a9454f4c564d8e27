//! Exports into memory, for tests.

use super::{Choices, Product, Subject, export};
use crate::formats::manifest::Manifest;
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::sync::{Arc, Mutex};

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
    let manifest = export(subject, products, choices, &sink).unwrap();
    let files = std::mem::take(&mut *contents.lock().unwrap());
    (manifest, files)
}
