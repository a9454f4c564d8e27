//! `navwalker export`.

use crate::args::ExportArgs;
use crate::study::study_and_design;
use crate::{Status, files, output};
use anyhow::{Context, Result};
use navwalker::formats::export::{Choices, Product, Subject, export};
use navwalker::formats::manifest::{Manifest, Study};
use navwalker::formats::metadata::ElementChoice;
use navwalker::frames::Frame;
use navwalker::report::{Align, Table};
use navwalker::time::Epoch;
use std::fs::{self, File};

pub(crate) fn run(args: &ExportArgs) -> Result<Status> {
    files::require_vacant(&args.out, args.force)?;
    let (study, design) = study_and_design(&args.study, &args.design)?;
    let scenario = &study.scenario;
    let subject = Subject {
        design,
        model: scenario.propagation.model,
        grid: scenario.time_grid()?,
        study: Study {
            name: scenario.name.clone(),
            hash: study.hash()?,
        },
        originator: scenario.export.originator.clone(),
        creation: Epoch::from_utc(scenario.export.creation_date),
    };
    let choices = Choices {
        frame: args.frame,
        elements: args.tle_theory,
        ccsds_version: args.ccsds_version,
        sp3_version: args.sp3_version,
        sp3_letter: args.sp3_letter,
    };
    let staged = files::StagedDirectory::new(&args.out)?;
    let mut sink = |path: &str| {
        let path = staged.path().join(path);
        path.parent().map_or(Ok(()), fs::create_dir_all)?;
        File::create(path)
    };
    let manifest = export(&subject, &products(args), choices, &mut sink)
        .with_context(|| format!("cannot export to {}", args.out.display()))?;
    staged.commit()?;
    output::result(&text(args, &manifest))?;
    if args.tle_theory == ElementChoice::Kepler {
        output::warning(
            "the mean motion slot holds sqrt(mu/a^3): SGP4 flies the design away from its J2 \
             trajectory by up to 400 km a day; navwalker validate --against sgp4 prints how much",
        );
    }
    if args.frame == Frame::Teme {
        output::warning("TEME is no frame of CCSDS ephemerides; not every reader takes it");
    }
    Ok(Status::Done)
}

/// Each product once, in the order in which it was asked for.
fn products(args: &ExportArgs) -> Vec<Product> {
    let mut products = Vec::new();
    for product in &args.products {
        if !products.contains(product) {
            products.push(*product);
        }
    }
    products
}

fn text(args: &ExportArgs, manifest: &Manifest) -> String {
    let mut table = Table::new(&[
        ("format", Align::Left),
        ("files", Align::Right),
        ("satellites", Align::Right),
        ("frame", Align::Left),
        ("time", Align::Left),
        ("rounding (m)", Align::Right),
        ("interpolation (m)", Align::Right),
        ("theory", Align::Left),
    ]);
    let metres = |values: &mut dyn Iterator<Item = f64>| {
        values
            .reduce(f64::max)
            .map_or_else(|| "-".to_owned(), |km| format!("{:.2e}", km * 1000.0))
    };
    let mut formats: Vec<&str> = Vec::new();
    for file in &manifest.files {
        if !formats.contains(&file.format.as_str()) {
            formats.push(&file.format);
        }
    }
    for format in formats {
        let of: Vec<_> = manifest
            .files
            .iter()
            .filter(|file| file.format == format)
            .collect();
        table.row([
            format.to_owned(),
            of.len().to_string(),
            of.iter()
                .map(|file| file.objects)
                .sum::<usize>()
                .to_string(),
            of[0].frame.clone(),
            of[0].time_system.clone(),
            metres(&mut of.iter().filter_map(|file| file.loss.quantisation_max_km)),
            metres(&mut of.iter().filter_map(|file| file.loss.interpolation_max_km)),
            of[0].theory.clone(),
        ]);
    }
    format!(
        "{} in {}\n\n{}",
        manifest.design,
        args.out.display(),
        table.to_text()
    )
}
