//! `navwalker export`.

use crate::cli::args::{ChosenArgs, ExportArgs, StudyArgs};
use crate::cli::progress::FileCount;
use crate::cli::provenance::provenance;
use crate::cli::study::Study;
use crate::cli::{Status, coincidence, constellations, files, limits, output, read_constellation};
use crate::constellation::gnss::Preset;
use crate::evaluate::Evaluator;
use crate::exchange::constellation::Constellation;
use crate::exchange::export::{
    Choices, ExportSource, ExportSubject, Naming, Product, ShownScenario, export_size,
};
use crate::exchange::import::StateChoice;
use crate::exchange::lint::Format as LintFormat;
use crate::exchange::manifest::{ChangedIdentity, ExportedStudy, FILE_NAME, Manifest};
use crate::exchange::read_back::{Difference, Grouping, Original, ReadBack};
use crate::formats::ccsds::oem;
use crate::formats::metadata::ElementChoice;
use crate::frames::Frame;
use crate::keyword::Keyword;
use crate::report::validation::digits;
use crate::report::{Align, Table};
use crate::run::PROVENANCE;
use crate::time::Epoch;
use anyhow::{Context, Result, bail};
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

/// Maximum number of changed identities that are named.
const TOLD_IDENTITIES: usize = 3;

pub(crate) fn run(args: &ExportArgs) -> Result<Status> {
    check_choices(args)?;
    files::require_replaceable(&args.out, args.force, &own(&args.out))?;
    let mut asked = args.study.clone();
    if let Some(date) = &args.creation_date {
        let key = format!("export.creation-date=\"{date}\"");
        asked.overrides.push(key);
    }
    let (mut study, constellation) = study_and_constellation(&asked, &args.chosen)?;
    if let Some(key) = study.taking_out(&args.without)? {
        asked.overrides.push(key);
        study = match &args.chosen.run {
            Some(directory) => Study::of_run(directory, &asked.overrides)?,
            None => Study::load(&asked, &[])?,
        };
    }
    let inputs = study.inputs();
    let read = args.chosen.given.inputs();
    files::refuse_inputs(&args.out, inputs.iter().map(PathBuf::as_path).chain(read))?;
    let scenario = &study.scenario;
    let products = products(args);
    let uses_scenario = products.iter().any(|one| one.row().uses_scenario());
    let has_outages = !scenario.outages.satellites.is_empty();
    let evaluator = (uses_scenario || args.check || has_outages).then(|| study.evaluator());
    let evaluator = evaluator.transpose()?;
    let down = evaluator.as_ref().filter(|_| has_outages);
    let down = down.map(|evaluator| constellation.places_down(evaluator.setup()));
    let subject = ExportSubject {
        constellation,
        down: down.transpose()?.unwrap_or_default(),
        naming: Naming {
            prefix: scenario.export.name_prefix.clone(),
            first_catalog_number: scenario.export.first_catalog_number,
        },
        model: scenario.propagation.model,
        grid: scenario.time_grid()?,
        study: ExportedStudy {
            name: scenario.name.clone(),
            hash: study.hash()?,
        },
        originator: scenario.export.originator.clone(),
        creation: Epoch::from_utc(scenario.export.creation_date),
        provenance: Some(PROVENANCE.to_owned()),
    };
    let choices = choices(args);
    limits::check_export(export_size(&subject, &products, &choices))?;
    constellations::warn_of_files(&subject.constellation, subject.grid);
    let not_exported = || format!("cannot export to {}", args.out.display());
    let source = ExportSource::new(&subject, choices).with_context(not_exported)?;
    coincidence::warn(&[], subject.grid, Some(source.ephemeris()));
    let staged = files::StagedDirectory::new(&args.out)?;
    let progress = FileCount::new();
    let sink = |path: &str| {
        let path = staged.path().join(path);
        path.parent().map_or(Ok(()), fs::create_dir_all)?;
        progress.one_more();
        File::create(path)
    };
    let shown = evaluator.as_ref().filter(|_| uses_scenario);
    let shown = shown.map(|evaluator| ShownScenario {
        evaluator,
        surface: scenario.earth.surface,
    });
    let manifest = source.export(&products, shown, &sink);
    let manifest = manifest.with_context(not_exported)?;
    drop(progress);
    staged.commit(&provenance(vec![study.stamp()?]))?;
    output::result(&text(args, &manifest))?;
    warn(args);
    warn_of_identities(&manifest.changed_identities);
    match evaluator.filter(|_| args.check) {
        Some(evaluator) => check(args, &evaluator, &source, &manifest),
        None => Ok(Status::Done),
    }
}

fn choices(args: &ExportArgs) -> Choices {
    Choices {
        frame: args.frame.unwrap_or(Frame::Eme2000),
        time_system: args.time_system,
        omm: args.omm_syntax,
        oem: args.oem_syntax,
        opm: args.opm_syntax,
        oem_combined: args.oem_combined,
        elements: args.tle_theory,
        ccsds_version: args.ccsds_version,
        sp3_version: args.sp3_version,
        sp3_letter: args.sp3_letter,
        sp3_gnss: std::array::from_fn(|at| args.gnss.contains(&Preset::ALL[at])),
    }
}

/// The study, and the one constellation to export.
fn study_and_constellation(
    study: &StudyArgs,
    chosen: &ChosenArgs,
) -> Result<(Study, Constellation)> {
    constellations::require_files(&chosen.given)?;
    let (study, mut chosen) = constellations::study_and_constellations(study, chosen)?;
    match (chosen.pop(), chosen.as_slice()) {
        (Some(one), []) => Ok((study, one)),
        (one, others) => {
            let names: Vec<&str> = others
                .iter()
                .chain(&one)
                .map(|one| one.name.as_str())
                .collect();
            bail!(
                "an export is of one constellation, not of {} ({}); export each to a directory of its own",
                names.len(),
                names.join(", ")
            );
        }
    }
}

/// The files of the previous export, from its manifest.
fn own(directory: &Path) -> BTreeSet<String> {
    let manifest = files::read_run(&directory.join(FILE_NAME)).ok();
    let manifest = manifest.and_then(|bytes| Manifest::read(bytes.as_slice()).ok());
    let files = manifest.into_iter().flat_map(|manifest| manifest.files);
    let files = files.map(|file| file.path);
    files.chain([FILE_NAME.to_owned()]).collect()
}

/// Says what the products cost that were asked for.
fn warn(args: &ExportArgs) {
    if args.tle_theory == ElementChoice::Kepler {
        output::warning(
            "the mean motion field is sqrt(mu/a^3): with SGP4 the design drifts from its J2 \
             trajectory by up to 400 km a day; navwalker validate --against sgp4 prints how much",
        );
    }
    if args.frame == Some(Frame::Teme) {
        output::warning("CCSDS ephemerides do not define TEME; some readers reject it");
    }
}

/// Names the first identities of files that are not written as they are there.
fn warn_of_identities(changed: &[ChangedIdentity]) {
    let told = |one: &ChangedIdentity| format!("{} as {}", one.source, one.written);
    let first: Vec<String> = changed.iter().take(TOLD_IDENTITIES).map(told).collect();
    let more = match changed.len() - first.len() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    if !first.is_empty() {
        output::warning(&format!(
            "names, numbers or designators that the formats cannot hold are changed: {}{more}; {FILE_NAME} lists them \
             under changed_identities",
            first.join(", ")
        ));
    }
}

/// Reads the products back and prints the metrics from each.
fn check(
    args: &ExportArgs,
    evaluator: &Evaluator,
    source: &ExportSource<'_>,
    manifest: &Manifest,
) -> Result<Status> {
    let original = Original::new(evaluator, source)?;
    let has_elements = source.has_mean_elements();
    if !has_elements && args.products.contains(&Product::Opm) {
        output::hint(
            "opm is not read back: it has states at the epoch alone, without a theory to propagate them",
        );
    }
    let mut table = Table::new(&[
        ("read back", Align::Left),
        ("position (m)", Align::Right),
        ("at most", Align::Right),
        ("theory (m)", Align::Right),
        ("mean visible", Align::Right),
        ("at most", Align::Right),
        ("mean PDOP", Align::Right),
        ("at most", Align::Right),
        ("", Align::Left),
    ]);
    let mut passed = true;
    for FileGroup {
        name,
        paths,
        read_back,
    } in groups(args, manifest, has_elements)
    {
        let mut merged = read_constellation::read(&paths, None, &StateChoice::default())?;
        let fleet = &mut merged.fleet;
        if merged.formats == [LintFormat::Sp3] {
            fleet.name_by_place();
        }
        let found = original
            .check(&read_back, args.tle_theory, fleet)
            .with_context(|| format!("cannot check {name}"))?;
        passed &= found.passed();
        let cells = |difference: Option<Difference>, scale: f64| {
            let number = |value: f64| digits(value * scale);
            let gate = difference.and_then(|difference| difference.gate);
            [difference.map(|difference| difference.value), gate]
                .map(|value| value.map_or_else(|| "none".to_owned(), number))
        };
        let mut row = vec![name];
        row.extend(cells(Some(found.position_km), 1000.0));
        let theory = found.theory_km.map(|km| digits(km * 1000.0));
        row.push(theory.unwrap_or_else(|| "-".to_owned()));
        row.extend(cells(Some(found.mean_visible), 1.0));
        row.extend(cells(found.mean_pdop, 1.0));
        row.push(if found.passed() { "passed" } else { "FAILED" }.to_owned());
        table.row(row);
    }
    output::result(&format!("\n{}", table.to_text()))?;
    Ok(if passed { Status::Done } else { Status::Failed })
}

/// Files that together contain the constellation once.
struct FileGroup {
    name: String,
    paths: Vec<PathBuf>,
    read_back: ReadBack,
}

/// The files of the constellation to read back, grouped as their products require.
fn groups(args: &ExportArgs, manifest: &Manifest, has_elements: bool) -> Vec<FileGroup> {
    let mut groups: Vec<FileGroup> = Vec::new();
    for file in &manifest.files {
        let Some(read_back) = Product::read_back_of(file) else {
            continue;
        };
        if file.format == Product::Opm.keyword() && !has_elements {
            continue;
        }
        let name = match read_back.files {
            Grouping::Together => file.format.clone(),
            Grouping::Each => file.path.clone(),
        };
        let path = args.out.join(&file.path);
        match groups.iter_mut().find(|known| known.name == name) {
            Some(known) => known.paths.push(path),
            None => groups.push(FileGroup {
                name,
                paths: vec![path],
                read_back,
            }),
        }
    }
    groups
}

/// Rejects options that none of the products can honour.
fn check_choices(args: &ExportArgs) -> Result<()> {
    let asked = |product| args.products.contains(&product);
    if args.oem_combined && args.oem_syntax != oem::OemSyntax::Xml {
        bail!("--oem-combined needs --oem-syntax xml: a KVN file holds one satellite");
    }
    if !args.gnss.is_empty() && !asked(Product::Sp3) {
        bail!("--gnss writes SP3; add sp3 to --as");
    }
    let has_frame = args.products.iter().any(|product| product.row().has_frame);
    if let Some(frame) = args.frame
        && asked(Product::Sp3)
        && !has_frame
        && frame != Frame::EarthFixed
    {
        bail!("SP3 is Earth-fixed; --frame {frame} cannot be combined with it");
    }
    Ok(())
}

/// Each product once, in the order given.
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
        ("objects", Align::Right),
        ("frame", Align::Left),
        ("time", Align::Left),
        ("rounding (m)", Align::Right),
        ("interpolation (m)", Align::Right),
        ("theory", Align::Left),
    ]);
    let metres = |values: &mut dyn Iterator<Item = f64>| {
        values
            .reduce(f64::max)
            .map_or_else(|| "-".to_owned(), |km| digits(km * 1000.0))
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
        title(manifest),
        args.out.display(),
        table.to_text()
    )
}

/// The notation of a design, or the name of the constellation and what was converted.
fn title(manifest: &Manifest) -> String {
    let name = manifest.constellation.as_ref().or(manifest.design.as_ref());
    let name = name.map_or("", String::as_str);
    match &manifest.converted {
        Some(converted) => format!("{name}: {converted}"),
        None => name.to_owned(),
    }
}
