//! Ctrl-C: partial output is removed, and a search stops after the current generation.

use crate::cli::{Status, output};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// Files and directories that are still being staged.
static STAGED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
/// Whether the command stops by itself when [`SEEN`] is set.
static ENDS_ITSELF: AtomicBool = AtomicBool::new(false);
/// Whether Ctrl-C was pressed.
static SEEN: AtomicBool = AtomicBool::new(false);

/// Installs the Ctrl-C handler; if that fails, Ctrl-C ends the program as usual.
pub(crate) fn install() {
    let _ = ctrlc::set_handler(|| {
        if ENDS_ITSELF.load(Ordering::Relaxed) && !SEEN.swap(true, Ordering::Relaxed) {
            output::hint("stopping after this generation; Ctrl-C again stops at once");
            return;
        }
        let staged = STAGED.lock().unwrap_or_else(PoisonError::into_inner);
        for path in staged.iter() {
            // If removal fails, the next process that writes there removes it as stale.
            let _ = fs::remove_file(path).or_else(|_| fs::remove_dir_all(path));
        }
        std::process::exit(Status::Interrupted as i32);
    });
}

/// The flag that Ctrl-C sets, for a command that then stops by itself; a second Ctrl-C ends the
/// program at once.
pub(crate) fn flag() -> &'static AtomicBool {
    ENDS_ITSELF.store(true, Ordering::Relaxed);
    &SEEN
}

/// A guard: while it exists, Ctrl-C removes its path.
pub(crate) struct Removed(PathBuf);

impl Removed {
    pub(crate) fn new(path: &Path) -> Self {
        let mut staged = STAGED.lock().unwrap_or_else(PoisonError::into_inner);
        staged.insert(path.to_owned());
        Self(path.to_owned())
    }
}

impl Drop for Removed {
    fn drop(&mut self) {
        let mut staged = STAGED.lock().unwrap_or_else(PoisonError::into_inner);
        staged.remove(&self.0);
    }
}
