//! Ctrl-C: partial output is removed, and a search stops after the current generation.
//!
//! Whenever it is pressed, the exit status is 130: either the program ends at once, or the search that
//! it asked to stop reports it.

use crate::cli::{Status, output};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Files and directories that are still being staged.
static STAGED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
/// What Ctrl-C does next: one of the three values below.
static STATE: AtomicU8 = AtomicU8::new(ENDS);
/// It ends the program at once.
const ENDS: u8 = 0;
/// It asks a search to stop.
const ASKS: u8 = 1;
/// It has asked, and ends the program at once if pressed again.
const ASKED: u8 = 2;

/// Times that a directory is emptied which other threads fill.
const MOST_ATTEMPTS: usize = 100;

/// Installs the Ctrl-C handler; if that fails, Ctrl-C ends the program as usual.
pub(crate) fn install() {
    let _ = ctrlc::set_handler(|| {
        let (order, otherwise) = (Ordering::SeqCst, Ordering::SeqCst);
        let asks = STATE.compare_exchange(ASKS, ASKED, order, otherwise);
        if asks.is_ok() {
            output::hint("stopping and keeping what is done; Ctrl-C again stops at once");
            return;
        }
        let staged = held();
        staged.iter().for_each(|path| remove(path));
        std::process::exit(Status::Interrupted as i32);
    });
}

/// Removes a staged file or directory. Other threads may still create files in the directory while it is emptied; once it is gone
/// they cannot.
fn remove(path: &Path) {
    for _ in 0..MOST_ATTEMPTS {
        let removed = fs::remove_file(path).or_else(|_| fs::remove_dir_all(path));
        if removed.is_ok() || !path.exists() {
            return;
        }
    }
    // The next process that writes there removes it as stale.
}

/// Asks a search to stop after the current generation, as the first Ctrl-C does; without one it does nothing.
pub(crate) fn ask_to_stop() {
    let (order, otherwise) = (Ordering::SeqCst, Ordering::SeqCst);
    // If there is none, there is nothing to stop.
    let _ = STATE.compare_exchange(ASKS, ASKED, order, otherwise);
}

/// Work that can stop by itself and keep what it has: the first Ctrl-C only asks it to, a second one
/// ends the program at once. Afterwards Ctrl-C does what it did before.
pub(crate) struct Stoppable(());

impl Stoppable {
    pub(crate) fn begin() -> Self {
        STATE.store(ASKS, Ordering::SeqCst);
        Self(())
    }

    /// Whether Ctrl-C was pressed.
    pub(crate) fn is_asked_to_stop(&self) -> bool {
        STATE.load(Ordering::SeqCst) == ASKED
    }

    /// Ends the work; returns whether Ctrl-C was pressed before. None is lost: a later one ends the
    /// program.
    pub(crate) fn end(self) -> bool {
        STATE.swap(ENDS, Ordering::SeqCst) == ASKED
    }
}

impl Drop for Stoppable {
    fn drop(&mut self) {
        STATE.store(ENDS, Ordering::SeqCst);
    }
}

/// Keeps Ctrl-C from removing staged files while it is held, as when one of them is moved to its
/// destination.
pub(crate) fn held() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    STAGED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A guard: while it exists, Ctrl-C removes its path.
pub(crate) struct Removed(PathBuf);

impl Removed {
    pub(crate) fn new(path: &Path) -> Self {
        held().insert(path.to_owned());
        Self(path.to_owned())
    }
}

impl Drop for Removed {
    fn drop(&mut self) {
        held().remove(&self.0);
    }
}
