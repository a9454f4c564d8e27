//! The files of an export, in memory.

use navwalker::exchange::export::{Choices, ExportSubject, Product, Request, export};
use std::io;
use std::sync::Mutex;

const SOUND: &str = "the design can be exported";

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
