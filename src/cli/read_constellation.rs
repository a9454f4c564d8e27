//! Constellations from files.

use crate::cli::files;
use crate::cli::output::{self, shown_path};
use crate::exchange::import::{Fleet, Imported, Merged, MergedFiles, StateChoice};
use crate::exchange::lint::Format;
use crate::exchange::manifest::FILE_NAME as MANIFEST;
use crate::exchange::recognise::recognise;
use crate::formats::text::finding::LeftOut;
use crate::run::PROVENANCE;
use anyhow::{Context, Result, bail};
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Cursor};
use std::path::{Path, PathBuf};

/// Maximum number of other files in a directory to list.
const MOST_NAMES: usize = 5;

/// Opens a file that is read.
type Opener<'a> = &'a mut dyn FnMut(&Path) -> io::Result<Box<dyn BufRead>>;

/// A file and its contents.
pub(crate) type FileContents = (PathBuf, Vec<u8>);

/// The satellites of files and directories, in the order of the names, and the formats found.
pub(crate) fn read(
    paths: &[PathBuf],
    format: Option<Format>,
    choice: &StateChoice,
) -> Result<Merged> {
    read_by(&mut open, paths, format, choice)
}

/// The same, with the contents of the files that were read.
pub(crate) fn read_with_contents(
    paths: &[PathBuf],
    format: Option<Format>,
    choice: &StateChoice,
) -> Result<(Merged, Vec<FileContents>)> {
    let mut contents: Vec<FileContents> = Vec::new();
    let mut keep = |file: &Path| {
        let bytes = files::read_whole(file)?;
        contents.push((file.to_owned(), bytes.clone()));
        Ok(Box::new(Cursor::new(bytes)) as Box<dyn BufRead>)
    };
    let merged = read_by(&mut keep, paths, format, choice)?;
    Ok((merged, contents))
}

fn open(file: &Path) -> io::Result<Box<dyn BufRead>> {
    Ok(Box::new(BufReader::new(File::open(file)?)))
}

fn read_by(
    open: Opener<'_>,
    paths: &[PathBuf],
    format: Option<Format>,
    choice: &StateChoice,
) -> Result<Merged> {
    let mut merged = MergedFiles::default();
    for path in paths {
        let mut add = |_, imported| merged.add(imported);
        each_by(open, path, (format, choice), &mut add)?;
    }
    merged.finish().context("no file to read")
}

/// Imports each file of a path: the file itself, or the constellation files in a directory. A warning lists the
/// other files in the directory, but for those with which this program describes its own directories.
pub(crate) fn read_each(path: &Path, format: Option<Format>) -> Result<Vec<(PathBuf, Imported)>> {
    let mut found = Vec::new();
    let mut add = |file, imported| found.push((file, imported));
    each_by(&mut open, path, (format, &StateChoice::default()), &mut add)?;
    Ok(found)
}

/// Passes each file of a path to `take` as soon as it has been read.
fn each_by(
    open: Opener<'_>,
    path: &Path,
    (format, choice): (Option<Format>, &StateChoice),
    take: &mut dyn FnMut(PathBuf, Imported),
) -> Result<()> {
    if !path.is_dir() {
        take(path.to_owned(), read_one(open, path, (format, choice))?);
        return Ok(());
    }
    let (files, mut others) = entries(path)?;
    let mut any = false;
    for file in files {
        if is_description(&file)? {
            continue;
        }
        match read_any(open, &file, (format, choice)).with_context(|| how_to_go_on(&file, path))? {
            Some(imported) => {
                take(file, imported);
                any = true;
            }
            None => others.push(file),
        }
    }
    if !others.is_empty() {
        output::warning(&format!("{}: {}", shown_path(path), left_out(&others)));
    }
    if !any {
        bail!("{} contains no constellation file", shown_path(path));
    }
    Ok(())
}

/// The contents of a file; `None` if its format is not supported.
fn read_any(
    open: Opener<'_>,
    file: &Path,
    (format, choice): (Option<Format>, &StateChoice),
) -> Result<Option<Imported>> {
    let format = match format {
        Some(format) => Some(format),
        None => format_of(file)?,
    };
    let read = |format| read_one(open, file, (Some(format), choice));
    format.map(read).transpose()
}

/// A damaged file of a directory is not skipped: a constellation without some of its satellites would pass for the whole.
fn how_to_go_on(file: &Path, directory: &Path) -> String {
    let (file, directory) = (shown_path(file), shown_path(directory));
    format!(
        "{directory} is read whole or not at all: repair {file} (`navwalker lint {file}` lists its errors), or move it \
         out of {directory} to leave it out"
    )
}

/// Warns of the parts of a file that are not read.
pub(crate) fn warn_left_out(file: &Path, left_out: &LeftOut) {
    if !left_out.is_empty() {
        output::warning(&format!("{}: {left_out}", shown_path(file)));
    }
}

fn read_one(
    open: Opener<'_>,
    file: &Path,
    (format, choice): (Option<Format>, &StateChoice),
) -> Result<Imported> {
    let mut read = || -> Result<Imported> {
        let input = open(file)?;
        let name = file.file_name().map(|name| name.to_string_lossy());
        Ok(Fleet::read_chosen(input, format, name.as_deref(), choice)?)
    };
    let imported = read().with_context(|| format!("cannot read {}", shown_path(file)))?;
    warn_left_out(file, &imported.left_out);
    Ok(imported)
}

/// The format of a file; `None` if it is not supported.
fn format_of(file: &Path) -> Result<Option<Format>> {
    let look = || -> std::io::Result<Option<Format>> {
        let input = BufReader::new(File::open(file)?);
        let name = file.file_name().map(|name| name.to_string_lossy());
        Ok(recognise(input, name.as_deref())?.content.ok())
    };
    look().with_context(|| format!("cannot read {}", shown_path(file)))
}

/// The files of a directory in the order of their names, and what else is in it.
fn entries(path: &Path) -> Result<(Vec<PathBuf>, Vec<PathBuf>)> {
    let listed = || -> std::io::Result<Vec<PathBuf>> {
        let entries = fs::read_dir(path)?.map(|entry| Ok(entry?.path()));
        let mut entries: Vec<PathBuf> = entries.collect::<std::io::Result<_>>()?;
        entries.sort();
        Ok(entries)
    };
    let entries = listed().with_context(|| format!("cannot list {}", shown_path(path)))?;
    Ok(entries.into_iter().partition(|entry| entry.is_file()))
}

/// Whether this program wrote the file to describe the directory that it is in: by its name, and by having no satellites.
fn is_description(file: &Path) -> Result<bool> {
    let named = [MANIFEST, PROVENANCE].map(|name| file.file_name() == Some(name.as_ref()));
    Ok(named.contains(&true) && format_of(file)?.is_none())
}

/// `left out: 2 (notes.txt, picture.png)`.
fn left_out(others: &[PathBuf]) -> String {
    let name = |path: &PathBuf| {
        let name = shown_path(Path::new(path.file_name().unwrap_or_default()));
        let end = if path.is_dir() { "/" } else { "" };
        format!("{name}{end}")
    };
    let names: Vec<String> = others.iter().take(MOST_NAMES).map(name).collect();
    let more = match others.len() - names.len() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!("left out: {} ({}{more})", others.len(), names.join(", "))
}
