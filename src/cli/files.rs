//! Atomic writes: files and directories are written to a sibling and then renamed.

mod guard;
mod replace;
mod staging;

pub(crate) use guard::{refuse_foreign, refuse_inputs};
pub(crate) use staging::{is_staged, lock, shared_lock};

use crate::cli::interrupt::{self, Removed};
use crate::cli::output;
use crate::run::{PROVENANCE, ResultProvenance};
use anyhow::{Context, Result, bail};
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use tempfile::{NamedTempFile, PersistError, TempDir};

/// Maximum bytes of a file that is read into memory at once: a scenario, or a file it names.
pub(crate) const MOST_BYTES: u64 = 64 << 20;

/// Maximum bytes of a file that this program wrote: a million generations, and a factor of two.
const MOST_RUN_BYTES: u64 = 1 << 30;

/// Maximum number of chained links to follow, as in the system.
const MOST_LINKS: usize = 40;

/// The bytes of an input that is not too long to be kept.
pub(crate) fn read_whole(path: &Path) -> io::Result<Vec<u8>> {
    read_at_most(path, MOST_BYTES)
}

/// The same of a file that this program wrote, as in a run directory.
pub(crate) fn read_run(path: &Path) -> io::Result<Vec<u8>> {
    read_at_most(path, MOST_RUN_BYTES)
}

fn read_at_most(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let file = File::open(path)?;
    let mut length = file.metadata()?.len();
    let mut bytes = Vec::new();
    if length <= most {
        // The length of a pipe is known only at its end.
        file.take(most + 1).read_to_end(&mut bytes)?;
        length = bytes.len() as u64;
    }
    if length > most {
        let message = format!("the file is larger than {} MiB", most >> 20);
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, message));
    }
    Ok(bytes)
}

/// Writes a file to a sibling and renames it.
pub(crate) fn write_atomically(path: &Path, bytes: &[u8]) -> Result<()> {
    StagedFile::new(path)?.commit(bytes)
}

/// A file that replaces its destination when complete. For a link, the target is replaced; a device
/// or other special file is written to directly.
pub(crate) struct StagedFile {
    place: PathBuf,
    /// `None` if the destination is not a regular file.
    staged: Option<(NamedTempFile, Removed)>,
    /// Directories made for it, which go with it if it is dropped before it is complete.
    made: MadeDirectories,
}

impl StagedFile {
    /// An empty file next to `path`; fails if the destination could not be replaced.
    pub(crate) fn new(path: &Path) -> Result<Self> {
        Self::beside(path, false)
    }

    /// The same, in directories that are made for it.
    pub(crate) fn with_directories(path: &Path) -> Result<Self> {
        Self::beside(path, true)
    }

    fn beside(path: &Path, are_made: bool) -> Result<Self> {
        let beside = || -> Result<Self> {
            let place = resolved(path)?;
            let found = match place.metadata() {
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error.into()),
                found => found.ok(),
            };
            if found.as_ref().is_some_and(fs::Metadata::is_dir) {
                bail!("it is a directory, and a file is needed");
            }
            let mut made = MadeDirectories(Vec::new());
            match place.parent() {
                Some(parent) if found.is_none() && are_made => {
                    make_directories(parent, &mut made.0)?;
                }
                Some(parent) if found.is_none() && !parent.is_dir() => {
                    bail!("there is no directory {}", parent.display());
                }
                _ => {}
            }
            let is_stream = found.is_some_and(|found| !found.is_file());
            let staged = (!is_stream).then(|| staging::file(&place)).transpose()?;
            Ok(Self {
                place,
                staged,
                made,
            })
        };
        beside().with_context(|| format!("cannot write {}", path.display()))
    }

    /// Moves the file with these contents to its destination. If that fails, the staged file is kept
    /// and the error names it.
    pub(crate) fn commit(self, bytes: &[u8]) -> Result<()> {
        self.commit_written(|file| file.write_all(bytes))
    }

    /// The same with what `write` writes, piece by piece.
    pub(crate) fn commit_written<T>(
        mut self,
        write: impl FnOnce(&mut File) -> io::Result<T>,
    ) -> Result<T> {
        let cannot = format!("cannot write {}", self.place.display());
        let Some((mut file, _removed)) = self.staged else {
            let stream = File::options().write(true).open(&self.place);
            return stream
                .and_then(|mut stream| write(&mut stream))
                .context(cannot);
        };
        let written = write(file.as_file_mut());
        let written = written.and_then(|of| file.as_file().sync_all().map(|()| of));
        let written = written.with_context(|| cannot.clone())?;
        let persisted = {
            let _held = interrupt::held();
            file.persist(&self.place)
        };
        match persisted {
            Ok(_) => {
                self.made.0.clear();
                Ok(written)
            }
            Err(PersistError { error, file }) => {
                self.made.0.clear();
                let kept = file.into_temp_path().keep();
                let kept = kept.map_err(io::Error::from).map(|path| kept_beside(&path));
                let kept = kept.map_or_else(|_| String::new(), |path| said(&path));
                Err(error).context(cannot + &kept)
            }
        }
    }
}

/// Renames a staged result that could not be moved, so that no later command treats it as stale.
fn kept_beside(staged: &Path) -> PathBuf {
    let name = staged.file_name().unwrap_or_default().to_string_lossy();
    let kept = staged.with_file_name(name.trim_start_matches('.'));
    match fs::rename(staged, &kept) {
        Ok(()) => kept,
        Err(_) => staged.to_owned(),
    }
}

fn said(kept: &Path) -> String {
    format!("; the result is in {}", kept.display())
}

/// The target of a path, existing or not, with links at its end followed.
fn resolved(path: &Path) -> io::Result<PathBuf> {
    let mut path = std::path::absolute(path)?;
    for _ in 0..MOST_LINKS {
        let Ok(target) = fs::read_link(&path) else {
            return Ok(path);
        };
        path = std::path::absolute(path.with_file_name("").join(target))?;
    }
    Err(io::Error::other("too many links"))
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

/// Writes [`PROVENANCE`] in a directory.
pub(crate) fn write_provenance(directory: &Path, provenance: &ResultProvenance) -> Result<()> {
    let json = crate::printable::json(provenance)? + "\n";
    write_atomically(&directory.join(PROVENANCE), json.as_bytes())
}

/// A directory that replaces its place when it is complete, and is gone when it is dropped before.
pub(crate) struct StagedDirectory {
    staging: TempDir,
    place: PathBuf,
    /// Parent directories created for the destination, deepest first.
    made: Vec<PathBuf>,
    lock: Option<File>,
    _removed: Removed,
}

impl StagedDirectory {
    /// An empty directory next to `place`; fails if the destination could not be replaced.
    pub(crate) fn new(place: &Path) -> Result<Self> {
        Self::beside(place).with_context(|| format!("cannot write to {}", place.display()))
    }

    fn beside(place: &Path) -> Result<Self> {
        let place = resolved(place)?;
        recovered(&place)?;
        let mut made = Vec::new();
        let parent = place
            .parent()
            .context("it is the root of the file system")?;
        make_directories(parent, &mut made)?;
        let staged = check_place(&place, parent).and_then(|()| Ok(staging::directory(&place)?));
        match staged {
            Ok((staging, lock, removed)) => Ok(Self {
                staging,
                place,
                made,
                lock,
                _removed: removed,
            }),
            Err(error) => {
                unmake(&made);
                Err(error)
            }
        }
    }

    /// Where to write.
    pub(crate) fn path(&self) -> &Path {
        self.staging.path()
    }

    /// Moves the directory, with where it comes from, into place unless another process has put one there
    /// meanwhile, which is kept.
    pub(crate) fn commit_if_vacant(mut self, provenance: &ResultProvenance) -> Result<()> {
        write_provenance(self.path(), provenance)?;
        let (staging, place) = (self.staging.path(), self.place.as_path());
        let _held = interrupt::held();
        // An empty directory is replaced, any other is not.
        match fs::rename(staging, place) {
            Ok(()) => self.made.clear(),
            Err(_) if !is_vacant(place)? => {}
            Err(error) => {
                return Err(error).with_context(|| format!("cannot write {}", place.display()));
            }
        }
        Ok(())
    }

    /// Moves the directory, with where it comes from, into place, replacing what is there.
    pub(crate) fn commit(self, provenance: &ResultProvenance) -> Result<()> {
        self.commit_keeping(&[], provenance).map(drop)
    }

    /// The same, but keeps the entries with these names from the directory being replaced. Returns the
    /// lock of the directory. If the move fails, the staged directory is kept and the error names it.
    pub(crate) fn commit_keeping(
        mut self,
        kept: &[OsString],
        provenance: &ResultProvenance,
    ) -> Result<Option<File>> {
        write_provenance(self.path(), provenance)?;
        let (staging, place) = (self.staging.path(), self.place.as_path());
        let replace = || -> io::Result<()> {
            for name in kept {
                replace::carry_over(&place.join(name), &staging.join(name))?;
            }
            let _held = interrupt::held();
            if place.is_dir() {
                replace::exchange(staging, place)
            } else {
                fs::rename(staging, place)
            }
        };
        if let Err(error) = replace() {
            let kept = said(&kept_beside(staging));
            self.staging.disable_cleanup(true);
            self.made.clear();
            let place = self.place.display();
            return Err(error).with_context(|| format!("cannot write {place}{kept}"));
        }
        self.made.clear();
        Ok(self.lock.take())
    }
}

impl Drop for StagedDirectory {
    fn drop(&mut self) {
        // Directories that were made for the place go if nothing is in them; the staging directory
        // is still in the deepest.
        if !self.made.is_empty() {
            let _ = fs::remove_dir_all(self.staging.path());
            unmake(&self.made);
        }
    }
}

fn make_directories(path: &Path, made: &mut Vec<PathBuf>) -> Result<()> {
    if path.is_dir() {
        return Ok(());
    }
    if let Some(parent) = path.parent() {
        make_directories(parent, made)?;
    }
    match fs::create_dir(path) {
        Ok(()) => made.insert(0, path.to_owned()),
        Err(_) if path.is_dir() => {}
        Err(error) => {
            unmake(made);
            return Err(error).with_context(|| format!("cannot create {}", path.display()));
        }
    }
    Ok(())
}

/// Directories made for a result, deepest first, which go when they are dropped.
struct MadeDirectories(Vec<PathBuf>);

impl Drop for MadeDirectories {
    fn drop(&mut self) {
        unmake(&self.0);
    }
}

fn unmake(made: &[PathBuf]) {
    for path in made {
        // A directory that is in use by now is not empty and is kept.
        let _ = fs::remove_dir(path);
    }
}

/// Refuses destinations that a directory cannot replace: a file, a mount point, a name that is too long.
fn check_place(place: &Path, parent: &Path) -> Result<()> {
    match place.symlink_metadata() {
        Ok(found) if !found.is_dir() => bail!("it is a file, and a directory is needed"),
        Ok(found) if is_mount_point(&found, &parent.metadata()?) => {
            bail!("it is a mount point, which cannot be replaced; choose a directory in it")
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(error.into()),
        Ok(_) => guard::refuse_ground(place),
    }
}

#[cfg(unix)]
fn is_mount_point(place: &fs::Metadata, parent: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    place.dev() != parent.dev()
}

#[cfg(not(unix))]
fn is_mount_point(_: &fs::Metadata, _: &fs::Metadata) -> bool {
    false
}

/// Restores a directory if the program was killed while replacing it.
pub(crate) fn recovered(place: &Path) -> Result<()> {
    let is_recovered =
        replace::recover(place).with_context(|| format!("cannot restore {}", place.display()))?;
    if is_recovered {
        output::warning(&format!(
            "{} was being replaced when the program was killed; what it held is back",
            place.display()
        ));
    }
    Ok(())
}

/// Whether a directory is missing or empty.
pub(crate) fn is_vacant(path: &Path) -> Result<bool> {
    match fs::read_dir(path) {
        Ok(entries) => {
            let names = entries.filter_map(|entry| Some(entry.ok()?.file_name()));
            let mut own = names.filter(|name| !is_staged(name));
            Ok(own.next().is_none())
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(true),
        Err(error) if error.kind() == io::ErrorKind::NotADirectory => {
            bail!(
                "{} is a file or lies in one, and a directory is needed",
                path.display()
            )
        }
        Err(error) => Err(error).with_context(|| format!("cannot use {}", path.display())),
    }
}

/// The names of a directory's entries that are not in `own`, sorted; those of a directory in `own` end
/// in `/`.
pub(crate) fn others(directory: &Path, own: &BTreeSet<String>) -> Result<Vec<OsString>> {
    if is_vacant(directory)? {
        return Ok(Vec::new());
    }
    let cannot = || format!("cannot read {}", directory.display());
    let mut names = Vec::new();
    for entry in fs::read_dir(directory).with_context(cannot)? {
        names.push(entry.with_context(cannot)?.file_name());
    }
    let is_own =
        |name: &str| name == PROVENANCE || own.contains(name) || own.contains(&format!("{name}/"));
    names.retain(|name| !is_staged(name) && !is_own(&name.to_string_lossy()));
    names.sort();
    Ok(names)
}

/// Refuses a directory that holds something; with `force` only where that is more than `own`, what
/// this program writes there, as [`refuse_foreign`] has it.
pub(crate) fn require_replaceable(path: &Path, force: bool, own: &BTreeSet<String>) -> Result<()> {
    if is_vacant(path)? {
        return Ok(());
    }
    if !force {
        bail!(
            "{} is not empty; choose another directory, or replace it with --force",
            path.display()
        );
    }
    refuse_foreign(path, own)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// If the destination is taken by the end, the result is kept under a name that the error gives, and
    /// the destination is not touched.
    #[test]
    fn a_result_that_cannot_be_placed_is_kept() {
        let directory = TempDir::new().unwrap();
        let place = directory.path().join("run");
        let staged = StagedDirectory::new(&place).unwrap();
        fs::write(staged.path().join("result"), "ours").unwrap();
        fs::write(&place, "mine").unwrap();
        let error = staged
            .commit(&ResultProvenance::new(None, Vec::new()))
            .unwrap_err()
            .to_string();
        let (_, kept) = error.split_once("; the result is in ").unwrap();
        assert_eq!(
            fs::read_to_string(Path::new(kept).join("result")).unwrap(),
            "ours"
        );
        assert!(!is_staged(Path::new(kept).file_name().unwrap()));
        assert_eq!(fs::read_to_string(&place).unwrap(), "mine");

        let place = directory.path().join("page");
        let staged = StagedFile::new(&place).unwrap();
        fs::create_dir(&place).unwrap();
        let error = staged.commit(b"ours").unwrap_err().to_string();
        let (_, kept) = error.split_once("; the result is in ").unwrap();
        assert_eq!(fs::read_to_string(kept).unwrap(), "ours");
        assert!(place.is_dir());
    }

    /// Directories above a place that were made for it go with it.
    #[test]
    fn nothing_is_left_of_a_directory_that_is_dropped() {
        let directory = TempDir::new().unwrap();
        let staged = StagedDirectory::new(&directory.path().join("a/b/run")).unwrap();
        fs::write(staged.path().join("half"), "").unwrap();
        drop(staged);
        assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 0);
    }

    /// A destination that cannot be replaced at the end is refused at the start.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_mount_point_and_a_file_are_no_places() {
        let refused = |place: &Path| StagedDirectory::new(place).err().map(|e| format!("{e:#}"));
        let mounted = refused(Path::new("/proc")).unwrap();
        assert!(mounted.contains("mount point"), "{mounted}");
        let directory = TempDir::new().unwrap();
        let file = directory.path().join("file");
        fs::write(&file, "mine").unwrap();
        let refused = refused(&file).unwrap();
        assert!(refused.contains("a directory is needed"), "{refused}");
        let names = fs::read_dir(directory.path()).unwrap();
        assert_eq!(names.count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn permissions_are_those_of_any_file() {
        use std::os::unix::fs::PermissionsExt;
        let directory = TempDir::new().unwrap();
        let (ours, any) = (directory.path().join("ours"), directory.path().join("any"));
        write_atomically(&ours, b"").unwrap();
        fs::write(&any, "").unwrap();
        let staged = StagedDirectory::new(&directory.path().join("run")).unwrap();
        let any_directory = directory.path().join("any-directory");
        fs::create_dir(&any_directory).unwrap();
        let mode = |path: &Path| path.metadata().unwrap().permissions().mode();
        assert_eq!(mode(&ours), mode(&any));
        assert_eq!(mode(staged.path()), mode(&any_directory));
    }
}
