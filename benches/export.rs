//! How fast every format is written.
//!
//! `cargo bench --bench export`; `DIVAN_SAMPLE_COUNT` sets the samples of each case. One thread;
//! 24 satellites at 360 instants.

mod written;

use divan::Bencher;
use divan::counter::{BytesCount, ItemsCount};
use navwalker::exchange::export::{Choices, Product, Request, export};
use navwalker::formats::ccsds::{oem, omm};
use std::io;

fn main() {
    divan::main();
}

const SOUND: &str = "the design can be exported";
/// The design, and its satellites.
const DESIGN: &str = "delta:55:24/6/1@925";
const SATELLITES: usize = 24;
const SAMPLES: usize = 360;

/// A product and its notation.
const CASES: [(&str, Product, omm::OmmSyntax, oem::OemSyntax); 12] = [
    (
        "tle",
        Product::Tle,
        omm::OmmSyntax::Kvn,
        oem::OemSyntax::Kvn,
    ),
    (
        "omm-kvn",
        Product::Omm,
        omm::OmmSyntax::Kvn,
        oem::OemSyntax::Kvn,
    ),
    (
        "omm-xml",
        Product::Omm,
        omm::OmmSyntax::Xml,
        oem::OemSyntax::Kvn,
    ),
    (
        "omm-json",
        Product::Omm,
        omm::OmmSyntax::Json,
        oem::OemSyntax::Kvn,
    ),
    (
        "omm-csv",
        Product::Omm,
        omm::OmmSyntax::Csv,
        oem::OemSyntax::Kvn,
    ),
    (
        "oem-kvn",
        Product::Oem,
        omm::OmmSyntax::Kvn,
        oem::OemSyntax::Kvn,
    ),
    (
        "oem-xml",
        Product::Oem,
        omm::OmmSyntax::Kvn,
        oem::OemSyntax::Xml,
    ),
    (
        "opm",
        Product::Opm,
        omm::OmmSyntax::Kvn,
        oem::OemSyntax::Kvn,
    ),
    (
        "sp3",
        Product::Sp3,
        omm::OmmSyntax::Kvn,
        oem::OemSyntax::Kvn,
    ),
    (
        "stk",
        Product::Stk,
        omm::OmmSyntax::Kvn,
        oem::OemSyntax::Kvn,
    ),
    (
        "csv",
        Product::Csv,
        omm::OmmSyntax::Kvn,
        oem::OemSyntax::Kvn,
    ),
    (
        "tle-states",
        Product::TleStates,
        omm::OmmSyntax::Kvn,
        oem::OemSyntax::Kvn,
    ),
];

fn names() -> impl Iterator<Item = &'static str> {
    CASES.iter().map(|(name, ..)| *name)
}

fn case(name: &str) -> (Product, Choices) {
    let (_, product, omm, oem) = CASES
        .iter()
        .find(|(known, ..)| *known == name)
        .expect(SOUND);
    let choices = Choices {
        omm: *omm,
        oem: *oem,
        ..Choices::default()
    };
    (*product, choices)
}

fn files(name: &str) -> Vec<(String, Vec<u8>)> {
    let (product, choices) = case(name);
    written::files(&written::subject(DESIGN, SAMPLES), product, choices)
}

fn one_thread() -> rayon::ThreadPool {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1);
    pool.build().expect(SOUND)
}

/// The whole export, propagation, hashes and the looks at the loss included.
#[divan::bench(args = names())]
fn write(bencher: Bencher, name: &str) {
    let bytes: usize = files(name).iter().map(|(_, bytes)| bytes.len()).sum();
    let (product, choices) = case(name);
    let (subject, pool) = (written::subject(DESIGN, SAMPLES), one_thread());
    let sink = |_: &str| Ok(io::sink());
    bencher
        .counter(BytesCount::new(bytes))
        .counter(ItemsCount::new(SATELLITES * SAMPLES))
        .bench_local(|| {
            let request = Request {
                subject: &subject,
                shown: None,
                products: &[product],
                choices,
            };
            pool.install(|| export(&request, &sink).expect(SOUND))
        });
}
