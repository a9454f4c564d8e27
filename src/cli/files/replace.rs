//! Replaces one directory with another, so that one of them exists even if the process is killed.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Swaps the directories at `new` and `place`.
pub(super) fn exchange(new: &Path, place: &Path) -> io::Result<()> {
    match at_once(new, place) {
        Err(error) if is_unable(&error) => one_after_the_other(new, place),
        done => done,
    }
}

#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
fn at_once(new: &Path, place: &Path) -> io::Result<()> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    Ok(renameat_with(CWD, new, CWD, place, RenameFlags::EXCHANGE)?)
}

#[cfg(not(any(target_os = "linux", target_os = "android", target_vendor = "apple")))]
fn at_once(_: &Path, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

/// Whether the system or the file system does not support the call for these directories.
fn is_unable(error: &io::Error) -> bool {
    use io::ErrorKind::{CrossesDevices, InvalidInput, Unsupported};
    matches!(error.kind(), CrossesDevices | InvalidInput | Unsupported)
}

/// If the process is killed between the two renames, [`recover`] restores the old directory.
fn one_after_the_other(new: &Path, place: &Path) -> io::Result<()> {
    let aside = aside(place);
    if aside.exists() {
        fs::remove_dir_all(&aside)?;
    }
    fs::rename(place, &aside)?;
    if let Err(error) = fs::rename(new, place) {
        fs::rename(&aside, place)?;
        return Err(error);
    }
    fs::rename(&aside, new)
}

/// The temporary path of a directory while it is being replaced.
fn aside(place: &Path) -> PathBuf {
    let mut name = std::ffi::OsString::from(".");
    name.push(place.file_name().unwrap_or_default());
    name.push(".navwalker-old");
    place.with_file_name(name)
}

/// Restores a directory if the process was killed while replacing it; returns whether it did.
pub(super) fn recover(place: &Path) -> io::Result<bool> {
    let aside = aside(place);
    let is_lost = place.symlink_metadata().is_err() && aside.is_dir() && !aside.is_symlink();
    if is_lost {
        fs::rename(&aside, place)?;
    }
    Ok(is_lost)
}

/// Duplicates the entry at `from` to `to`: files as hard links if possible, otherwise as copies.
pub(super) fn carry_over(from: &Path, to: &Path) -> io::Result<()> {
    let kind = from.symlink_metadata()?.file_type();
    if kind.is_dir() {
        fs::create_dir_all(to)?;
        for entry in fs::read_dir(from)? {
            let entry = entry?;
            carry_over(&entry.path(), &to.join(entry.file_name()))?;
        }
        return fs::set_permissions(to, from.metadata()?.permissions());
    }
    if fs::hard_link(from, to).is_ok() {
        return Ok(());
    }
    #[cfg(unix)]
    if kind.is_symlink() {
        return std::os::unix::fs::symlink(fs::read_link(from)?, to);
    }
    fs::copy(from, to).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::TempDir;

    fn two() -> (TempDir, PathBuf, PathBuf) {
        let directory = TempDir::new().unwrap();
        let (new, place) = (directory.path().join("new"), directory.path().join("place"));
        for (path, text) in [(&new, "new"), (&place, "old")] {
            fs::create_dir(path).unwrap();
            fs::write(path.join("text"), text).unwrap();
        }
        (directory, new, place)
    }

    fn text(directory: &Path) -> String {
        fs::read_to_string(directory.join("text")).unwrap()
    }

    #[test]
    fn directories_change_places_either_way() {
        for exchange in [exchange, one_after_the_other] {
            let (directory, new, place) = two();
            exchange(&new, &place).unwrap();
            assert_eq!(
                (text(&place), text(&new)),
                ("new".to_owned(), "old".to_owned())
            );
            assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 2);
        }
    }

    #[test]
    fn what_a_kill_left_aside_is_put_back() {
        let (_directory, _, place) = two();
        assert!(!recover(&place).unwrap());
        // The state between the two renames.
        fs::rename(&place, aside(&place)).unwrap();
        assert!(recover(&place).unwrap());
        assert_eq!(text(&place), "old");
    }

    #[cfg(unix)]
    #[test]
    fn trees_are_carried_over_whole() {
        let (directory, _, place) = two();
        fs::create_dir(place.join("sub")).unwrap();
        fs::write(place.join("sub/note"), "mine").unwrap();
        std::os::unix::fs::symlink("nowhere", place.join("sub/link")).unwrap();
        let to = directory.path().join("to");
        carry_over(&place, &to).unwrap();
        fs::remove_dir_all(&place).unwrap();
        assert_eq!(text(&to), "old");
        assert_eq!(fs::read_to_string(to.join("sub/note")).unwrap(), "mine");
        assert_eq!(
            fs::read_link(to.join("sub/link")).unwrap(),
            Path::new("nowhere")
        );
    }
}
