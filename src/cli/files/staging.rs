//! Staging: files and directories are written next to their destination, under unpredictable names.
//!
//! Each is created exclusively and locked while it is written. One that is not locked was left by a
//! process that was killed; the next process that writes to the same destination removes it.

use crate::cli::interrupt::Removed;
use std::ffi::OsStr;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::Path;
use std::time::Duration;
use tempfile::{Builder, NamedTempFile, TempDir};

/// Part of every staging name.
const MARK: &str = ".navwalker-";
/// Random characters at the end of a name.
const RANDOM: usize = 12;
/// Maximum bytes of the destination's name in a staging name.
const SHOWN: usize = 64;
/// Maximum time between the creation of a staging entry and its lock.
const UNTIL_LOCKED: Duration = Duration::from_millis(100);

/// Prefix of all staging names for a destination.
pub(super) fn prefix(place: &Path) -> String {
    let name = place.file_name().unwrap_or_default().to_string_lossy();
    let shown: String = name
        .char_indices()
        .take_while(|(at, _)| *at < SHOWN)
        .map(|(_, c)| c)
        .collect();
    format!(".{shown}{MARK}")
}

/// Whether a name is a staging name rather than that of a user's file.
pub(crate) fn is_staged(name: &OsStr) -> bool {
    let name = name.to_string_lossy();
    name.starts_with('.')
        && name.rsplit_once(MARK).is_some_and(|(_, end)| {
            end.len() == RANDOM && end.chars().all(|c| c.is_ascii_alphanumeric())
        })
}

/// A staging file next to `place`, open and locked.
pub(super) fn file(place: &Path) -> io::Result<(NamedTempFile, Removed)> {
    let parent = place.parent().unwrap_or(place);
    remove_stale(parent, place);
    let mut builder = Builder::new();
    let prefix = prefix(place);
    builder.prefix(&prefix).rand_bytes(RANDOM);
    permit(&mut builder, 0o666);
    let file = builder.tempfile_in(parent);
    let file = file.map_err(|error| unnamed(&error, parent))?;
    // Without locks, nothing is considered stale either.
    let _ = file.as_file().lock();
    let removed = Removed::new(file.path());
    Ok((file, removed))
}

/// A staging directory next to `place`, and its lock if locks are supported.
pub(super) fn directory(place: &Path) -> io::Result<(TempDir, Option<File>, Removed)> {
    let parent = place.parent().unwrap_or(place);
    remove_stale(parent, place);
    let mut builder = Builder::new();
    let prefix = prefix(place);
    builder.prefix(&prefix).rand_bytes(RANDOM);
    permit(&mut builder, 0o777);
    let directory = builder.tempdir_in(parent);
    let directory = directory.map_err(|error| unnamed(&error, parent))?;
    let lock = File::open(directory.path()).ok();
    let lock = lock.filter(|lock| lock.lock().is_ok());
    let removed = Removed::new(directory.path());
    Ok((directory, lock, removed))
}

/// An error with the directory in place of the staging name, which `tempfile` adds to its text and means nothing to a user.
fn unnamed(error: &io::Error, parent: &Path) -> io::Error {
    let text = error.to_string();
    let cause = text.split(" at path \"").next().unwrap_or_default();
    let message = format!("nothing can be created in {}: {cause}", parent.display());
    io::Error::new(error.kind(), message)
}

/// The usual permissions, before the umask is applied.
fn permit(builder: &mut Builder<'_, '_>, mode: u32) {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(mode));
    }
    #[cfg(not(unix))]
    let _ = (builder, mode);
}

/// Locks a file or a directory; the lock ends with the handle.
pub(crate) fn lock(path: &Path) -> Result<File, TryLockError> {
    let file = File::open(path).map_err(TryLockError::Error)?;
    file.try_lock()?;
    Ok(file)
}

/// A lock that several processes may have, which keeps the directory from being replaced meanwhile.
pub(crate) fn shared_lock(path: &Path) -> Option<File> {
    let file = File::open(path).ok()?;
    file.lock_shared().ok()?;
    Some(file)
}

/// Removes what a killed process left next to `place`, as far as possible.
fn remove_stale(parent: &Path, place: &Path) {
    let prefix = prefix(place);
    let Ok(entries) = fs::read_dir(parent) else {
        return;
    };
    for entry in entries.filter_map(Result::ok) {
        let name = entry.file_name();
        let path = entry.path();
        let is_ours = is_staged(&name) && name.to_string_lossy().starts_with(&prefix);
        // This program never creates links.
        if is_ours && !path.is_symlink() && is_abandoned(&path) {
            let _ = if path.is_dir() {
                fs::remove_dir_all(&path)
            } else {
                fs::remove_file(&path)
            };
        }
    }
}

/// Whether a staging entry is stale: it is not locked and was not created just now.
fn is_abandoned(path: &Path) -> bool {
    let is_free = || lock(path).is_ok();
    is_free() && {
        std::thread::sleep(UNTIL_LOCKED);
        is_free()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A user knows neither the staging name nor where it comes from.
    #[test]
    fn errors_name_the_directory_and_not_the_staging_name() {
        let directory = tempfile::TempDir::new().unwrap();
        let place = directory.path().join("missing/result");
        let errors = [
            file(&place).err().unwrap(),
            super::directory(&place).err().unwrap(),
        ];
        for error in errors {
            assert_eq!(error.kind(), io::ErrorKind::NotFound);
            let text = error.to_string();
            assert!(!text.contains(MARK), "{text}");
            assert!(text.contains("missing: No such file"), "{text}");
        }
    }
}
