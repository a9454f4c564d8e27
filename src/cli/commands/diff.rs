//! `navwalker diff`.

use crate::cli::args::{DiffArgs, OutputFormat};
use crate::cli::output::shown_path;
use crate::cli::run::HOLDER;
use crate::cli::sweep_store::SweepStore;
use crate::cli::{Status, files, output};
use crate::report::{Diff, ResultFile, Side, Tolerance, records_csv};
use crate::run::sweep::SWEEP_JSON;
use crate::run::{CHECKPOINT, MANIFEST, PROVENANCE, ResultProvenance, SCENARIO};
use anyhow::{Context, Result, bail};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

pub(crate) fn run(args: &DiffArgs) -> Result<Status> {
    let tolerance = Tolerance {
        absolute: args.absolute,
        relative: args.relative,
    };
    let (a, b) = (side(&args.a)?, side(&args.b)?);
    require_values(args, &a, &b)?;
    if !a.files.keys().any(|name| b.files.contains_key(name)) {
        bail!(
            "{} and {} have no file in common: a run is compared with a run, a report with a report",
            shown_path(&args.a),
            shown_path(&args.b)
        );
    }
    let diff = Diff::of(&a, &b, tolerance);
    output::result(&match args.format {
        OutputFormat::Text => diff.to_text(),
        OutputFormat::Json => crate::printable::json(&diff)? + "\n",
        OutputFormat::Csv => records_csv(&diff.moved)?,
    })?;
    Ok(if diff.is_none() {
        Status::Done
    } else {
        Status::Failed
    })
}

/// Fails for two pages or figures that differ: their values are in other files, which the error names.
fn require_values(args: &DiffArgs, a: &Side, b: &Side) -> Result<()> {
    if args.a.is_dir() || args.b.is_dir() || a.files == b.files {
        return Ok(());
    }
    let drawn = [(&args.a, a), (&args.b, b)]
        .into_iter()
        .find(|(_, side)| side.files.values().any(ResultFile::is_drawing));
    let Some((path, _)) = drawn else {
        return Ok(());
    };
    let beside = values_beside(path);
    let shown = shown_path(path);
    bail!(match beside.as_slice() {
        [] => format!(
            "{shown} is drawn from values that are in other files; compare the directories of the results"
        ),
        files => format!(
            "{shown} is drawn from values that are in {} beside it; compare those, or the directories",
            files.join(", ")
        ),
    })
}

/// The files beside a page or a figure that have its values: the table of its name, or else the results.
fn values_beside(path: &Path) -> Vec<String> {
    let table = path.with_extension("csv");
    if table.is_file() {
        return vec![shown_path(Path::new(table.file_name().unwrap_or_default()))];
    }
    let directory = path.parent().filter(|parent| *parent != Path::new(""));
    let entries = fs::read_dir(directory.unwrap_or(Path::new(".")));
    let names = entries.into_iter().flatten().flatten();
    let mut names: Vec<String> = names
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .filter(|name| name.ends_with(".json") && ![MANIFEST, PROVENANCE].contains(&name.as_str()))
        .map(|name| shown_path(Path::new(&name)))
        .collect();
    names.sort();
    names
}

/// The name that single files are compared under, since theirs may differ.
fn common_name(path: &Path) -> String {
    let end = path
        .extension()
        .map(|end| end.to_string_lossy().to_lowercase());
    end.map_or("file".to_owned(), |end| format!("file.{end}"))
}

fn side(path: &Path) -> Result<Side> {
    let read = || -> Result<Side> {
        if !path.is_dir() {
            let document = ResultFile::read(&common_name(path), files::read_run(path)?)?;
            return Ok(Side {
                files: [(common_name(path), document)].into(),
                provenance: None,
            });
        }
        let provenance = provenance(path)?;
        let files = if path.join(SWEEP_JSON).exists() {
            sweep(path)?
        } else {
            directory(path)?
        };
        Ok(Side { files, provenance })
    };
    read().with_context(|| format!("cannot read {}", shown_path(path)))
}

fn provenance(directory: &Path) -> Result<Option<ResultProvenance>> {
    let path = directory.join(PROVENANCE);
    if !path.exists() {
        return Ok(None);
    }
    let found = serde_json::from_slice(&files::read_run(&path)?);
    Ok(Some(
        found.with_context(|| format!("{PROVENANCE} is damaged"))?,
    ))
}

/// The scenario of a sweep and its table, from the chunks, each of which proves to be whole.
fn sweep(directory: &Path) -> Result<BTreeMap<String, ResultFile>> {
    let store = SweepStore::read(directory)?;
    let mut csv = String::new();
    for number in 0..store.chunks().len() {
        let table = store.table(number)?;
        if number == 0 {
            csv += &table.csv_heading()?;
        }
        csv += &table.csv_rows()?;
    }
    let scenario = ResultFile::read(SCENARIO, files::read_run(&directory.join(SCENARIO))?)?;
    Ok([
        (SCENARIO.to_owned(), scenario),
        ("table".to_owned(), ResultFile::table(&csv)?),
    ]
    .into())
}

/// The files of a directory and those below it, save what only serves to continue the work or says where it
/// comes from.
fn directory(directory: &Path) -> Result<BTreeMap<String, ResultFile>> {
    let mut found = BTreeMap::new();
    let mut waiting = vec![(directory.to_owned(), String::new())];
    while let Some((path, before)) = waiting.pop() {
        for entry in fs::read_dir(&path)? {
            let entry = entry?;
            let file_name = entry.file_name();
            let name = file_name.to_string_lossy();
            let is_kept = !files::is_staged(&file_name)
                && !name.starts_with(CHECKPOINT)
                && ![MANIFEST, PROVENANCE, HOLDER].contains(&&*name);
            if !is_kept {
                continue;
            }
            let shown = format!("{before}{name}");
            if entry.file_type()?.is_dir() {
                waiting.push((entry.path(), shown + "/"));
                continue;
            }
            let read = || anyhow::Ok(ResultFile::read(&shown, files::read_run(&entry.path())?)?);
            let document = read().with_context(|| format!("cannot read {shown}"))?;
            found.insert(shown.clone(), document);
        }
    }
    Ok(found)
}
