//! Atomic writes: files and directories are written to a sibling and then renamed.

use anyhow::{Context, Result, bail};
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

/// Maximum bytes of a file that is read into memory at once: a scenario, or a file it names.
const MOST_BYTES: u64 = 64 << 20;

/// The bytes of a file, if it is not too long.
pub(crate) fn read_whole(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?
        .take(MOST_BYTES + 1)
        .read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MOST_BYTES {
        let message = format!("the file is larger than {} MiB", MOST_BYTES >> 20);
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, message));
    }
    Ok(bytes)
}

/// Writes a file to a sibling and renames it.
pub(crate) fn write_atomically(path: &Path, bytes: &[u8]) -> Result<()> {
    let partial = beside(path);
    let written = File::create(&partial)
        .and_then(|mut file| file.write_all(bytes).and_then(|()| file.sync_all()))
        .and_then(|()| fs::rename(&partial, path));
    if written.is_err() {
        // If it cannot be removed either, the error below names it.
        let _ = fs::remove_file(&partial);
    }
    written.with_context(|| format!("cannot write {}", path.display()))
}

/// Writes files, each atomically, at paths relative to `directory`.
pub(crate) fn write_all(directory: &Path, files: &[(String, Vec<u8>)]) -> Result<()> {
    for (path, bytes) in files {
        let path = directory.join(path);
        let parent = path.parent().unwrap_or(directory);
        fs::create_dir_all(parent)
            .with_context(|| format!("cannot create {}", parent.display()))?;
        write_atomically(&path, bytes)?;
    }
    Ok(())
}

/// A sibling of `path` that no other process of this program uses.
fn beside(path: &Path) -> PathBuf {
    let name = path
        .file_name()
        .map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    path.with_file_name(format!(".{name}.partial-{}", std::process::id()))
}

/// A directory that is moved into place when complete, and removed if dropped before.
pub(crate) struct StagedDirectory {
    staging: PathBuf,
    place: PathBuf,
}

impl StagedDirectory {
    /// An empty sibling of `place`.
    pub(crate) fn new(place: &Path) -> Result<Self> {
        let place = absolute(place)?;
        let staging = beside(&place);
        fs::create_dir_all(&staging)
            .with_context(|| format!("cannot create a directory next to {}", place.display()))?;
        Ok(Self { staging, place })
    }

    /// Where to write.
    pub(crate) fn path(&self) -> &Path {
        &self.staging
    }

    /// Moves the directory into place, replacing what is there.
    pub(crate) fn commit(self) -> Result<()> {
        self.commit_keeping(&[])
    }

    /// The same, but keeps the entries with these names from what is replaced.
    pub(crate) fn commit_keeping(self, kept: &[OsString]) -> Result<()> {
        let replace = || -> io::Result<()> {
            if self.place.exists() {
                let old = beside(&self.place.with_extension("old"));
                fs::rename(&self.place, &old)?;
                if let Err(error) = fs::rename(&self.staging, &self.place) {
                    fs::rename(&old, &self.place)?;
                    return Err(error);
                }
                for name in kept.iter().filter(|name| old.join(name).exists()) {
                    fs::rename(old.join(name), self.place.join(name))?;
                }
                fs::remove_dir_all(old)
            } else {
                fs::rename(&self.staging, &self.place)
            }
        };
        replace().with_context(|| format!("cannot write {}", self.place.display()))
    }
}

impl Drop for StagedDirectory {
    fn drop(&mut self) {
        // After a commit nothing is left to remove.
        let _ = fs::remove_dir_all(&self.staging);
    }
}

fn absolute(path: &Path) -> Result<PathBuf> {
    std::path::absolute(path).with_context(|| format!("no directory '{}'", path.display()))
}

/// Whether a directory is missing or empty.
pub(crate) fn is_vacant(path: &Path) -> Result<bool> {
    match fs::read_dir(path) {
        Ok(mut entries) => Ok(entries.next().is_none()),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(true),
        Err(error) => Err(error).with_context(|| format!("cannot use {}", path.display())),
    }
}

/// Rejects a directory that is not empty.
pub(crate) fn require_vacant(path: &Path, force: bool) -> Result<()> {
    if !force && !is_vacant(path)? {
        bail!(
            "{} is not empty; choose another directory, or replace it with --force",
            path.display()
        );
    }
    Ok(())
}
