//! Constellations from files.

use crate::cli::output;
use crate::exchange::import::Fleet;
use crate::exchange::lint::Format;
use crate::formats::text::finding::LeftOut;
use anyhow::{Context, Result, bail};
use std::fs::{self, File};
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// The satellites of files and directories, in the order of the names, and the first format.
pub(crate) fn read(paths: &[PathBuf]) -> Result<(Format, Fleet)> {
    let mut whole: Option<(Format, Fleet)> = None;
    for path in paths {
        for file in files_of(path)? {
            let read = || -> Result<(Format, Fleet)> {
                let input = BufReader::new(File::open(&file)?);
                let name = file.file_name().map(|name| name.to_string_lossy());
                let read = Fleet::read(input, None, name.as_deref())?;
                warn_left_out(&file, &read.left_out);
                Ok((read.format, read.fleet))
            };
            let (format, fleet) =
                read().with_context(|| format!("cannot read {}", file.display()))?;
            match &mut whole {
                None => whole = Some((format, fleet)),
                Some((_, whole)) => whole.append(fleet),
            }
        }
    }
    match whole {
        Some(whole) => Ok(whole),
        None => bail!("no file to read"),
    }
}

/// Says what of a file is not read.
pub(crate) fn warn_left_out(file: &Path, left_out: &LeftOut) {
    if !left_out.is_empty() {
        output::warning(&format!("{}: {left_out}", file.display()));
    }
}

fn files_of(path: &Path) -> Result<Vec<PathBuf>> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let listed = || -> std::io::Result<Vec<PathBuf>> {
        let entries = fs::read_dir(path)?.map(|entry| Ok(entry?.path()));
        let mut files: Vec<PathBuf> = entries.collect::<std::io::Result<_>>()?;
        files.retain(|file| file.is_file());
        files.sort();
        Ok(files)
    };
    listed().with_context(|| format!("cannot list {}", path.display()))
}
