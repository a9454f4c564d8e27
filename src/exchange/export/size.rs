//! The size of an export, estimated before it is written.

use super::{Choices, ExportSubject, Product};
use crate::formats::ccsds::{oem, omm};

/// Satellites of a GNSS beside a design, about.
const GNSS_SATELLITES: u64 = 30;
/// Size of an XML of states, as a multiple of that in KVN.
const XML: u64 = 2;
const DAY_S: f64 = 86_400.0;

/// What the files of a product hold, bytes as measured.
pub(super) struct ProductSize {
    /// Whether each satellite has a file of its own.
    pub(super) each: bool,
    /// Bytes for each satellite.
    pub(super) satellite: u64,
    /// Bytes for each satellite and instant.
    pub(super) state: u64,
    /// Bytes for each satellite and day begun, for tracks of their own step.
    pub(super) day: u64,
}

/// Number and size of the files of an export.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ExportSize {
    /// Files.
    pub files: u64,
    /// Size of all files, bytes.
    pub bytes: u64,
}

/// The estimated size of an export, from the satellites and instants of each product. What depends on the
/// region alone, megabytes at most for a usual one, is not included.
#[must_use]
pub fn export_size(subject: &ExportSubject, products: &[Product], choices: &Choices) -> ExportSize {
    let of_design = (subject.constellation.satellite_count() - subject.down.len()) as u64;
    let instants = subject.grid.len() as u64;
    let span_s = (instants - 1) as f64 * subject.grid.step_s();
    let days = (span_s / DAY_S).ceil() as u64;
    let mut size = ExportSize { files: 1, bytes: 0 };
    for &product in products {
        let ProductSize {
            each,
            satellite,
            state,
            day,
        } = product.row().size;
        let beside = choices.sp3_gnss.iter().filter(|chosen| **chosen).count() as u64;
        let satellites = match product {
            Product::Sp3 => of_design + beside * GNSS_SATELLITES,
            _ => of_design,
        };
        let state = match product {
            Product::Oem if choices.oem == oem::OemSyntax::Xml => XML * state,
            _ => state,
        };
        let is_one = match product {
            Product::Oem => choices.oem_combined,
            Product::Omm => choices.omm != omm::OmmSyntax::Kvn,
            _ => !each,
        };
        size.files += match product {
            // Elements and states.
            Product::Csv => 2,
            _ if is_one => 1,
            _ => satellites,
        };
        size.bytes += satellites * (satellite + instants * state + days * day);
    }
    size
}

#[cfg(test)]
mod tests {
    use super::super::testing::{in_memory, subject};
    use super::*;
    use crate::keyword::Keyword;
    use crate::time::{Epoch, TimeGrid};

    /// Every product whose size matters, at two lengths: within a fifth of what is written, which leaves
    /// room for names and digits of other lengths.
    #[test]
    fn the_estimate_is_near_the_export() {
        let xml = Choices {
            oem: oem::OemSyntax::Xml,
            ..Choices::default()
        };
        let epoch: Epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        for step_s in [1200.0, 300.0] {
            let grid = TimeGrid::new(epoch, 86_400.0, step_s).unwrap();
            let subject = subject("delta:55:24/6/1@925".parse().unwrap(), grid);
            for (product, choices) in [
                (Product::Oem, Choices::default()),
                (Product::Oem, xml),
                (Product::Sp3, Choices::default()),
                (Product::Stk, Choices::default()),
                (Product::Csv, Choices::default()),
                (Product::TleStates, Choices::default()),
                (Product::Omm, Choices::default()),
                (Product::Opm, Choices::default()),
            ] {
                let (manifest, files) = in_memory(&subject, &[product], choices);
                let of_product = files.iter().filter(|(path, _)| *path != "manifest.json");
                let bytes: usize = of_product.map(|(_, bytes)| bytes.len()).sum();
                let estimate = export_size(&subject, &[product], &choices);
                let ratio = estimate.bytes as f64 / bytes as f64;
                assert!((0.8..1.2).contains(&ratio), "{product} {step_s}: {ratio}");
                let files = manifest.files.len() as f64 + 1.0;
                let ratio = estimate.files as f64 / files;
                assert!((0.8..1.2).contains(&ratio), "{product}: {ratio} files");
            }
        }
    }

    /// No product grows without its growth being in the estimate.
    #[test]
    fn no_product_is_free() {
        let without = [Product::Yuma, Product::Metrics];
        for product in Product::ALL
            .iter()
            .filter(|product| !without.contains(product))
        {
            assert!(product.row().size.satellite > 0, "{product}");
        }
    }
}
