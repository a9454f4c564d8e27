//! Work that Ctrl-C ends, and that says how far it is.

use crate::pools::pool;
use navwalker::cli::embedded::{Reached, SharedProgress};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// How often signals and progress are looked at.
const EVERY: Duration = Duration::from_millis(50);

/// What work and the one who waits for it share.
#[derive(Clone, Default)]
pub(crate) struct Shared {
    stop: Arc<AtomicBool>,
    pub(crate) progress: SharedProgress,
}

impl Shared {
    /// Whether the work is asked to stop; looked at between designs and generations.
    pub(crate) fn is_asked_to_stop(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Begins work on so many designs.
    pub(crate) fn begin(&self, designs: usize) {
        self.progress.set(Reached {
            steps: designs as u64,
            ..Reached::default()
        });
    }
}

/// A function of Python that is told how far work is, if there is one: steps done, all steps, evaluations, hypervolume.
pub(crate) type Tick<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

/// Does some work on the threads of the module, at most so many if a number is given, without the interpreter's lock.
/// At Ctrl-C the exception is raised at once; the work is asked to stop, and what it finds is dropped.
///
/// The work may not wait for other work of the module, since it may occupy the thread that is to do it.
pub(crate) fn on_pool<T: Send + 'static>(
    py: Python<'_>,
    threads: Option<usize>,
    tick: Tick<'_, '_>,
    work: impl FnOnce(&Shared) -> T + Send + 'static,
) -> PyResult<T> {
    let shared = Shared::default();
    let own = shared.clone();
    let (sender, receiver) = sync_channel(1);
    // If nobody waits any more, the result is of no use.
    pool(threads)?.spawn(move || drop(sender.send(work(&own))));
    awaited(py, receiver, &shared, tick, || {})
}

/// The same in a thread of its own: for work that calls Python, or that only one does at a time.
pub(crate) fn in_thread<T: Send + 'static>(
    py: Python<'_>,
    tick: Tick<'_, '_>,
    on_stop: fn(),
    work: impl FnOnce(&Shared) -> T + Send + 'static,
) -> PyResult<T> {
    let shared = Shared::default();
    let own = shared.clone();
    let (sender, receiver) = sync_channel(1);
    thread::spawn(move || sender.send(work(&own)));
    awaited(py, receiver, &shared, tick, on_stop)
}

fn awaited<T: Send>(
    py: Python<'_>,
    receiver: Receiver<T>,
    shared: &Shared,
    tick: Tick<'_, '_>,
    on_stop: fn(),
) -> PyResult<T> {
    let receiver = Mutex::new(receiver);
    let wait = || {
        let receiver = receiver.lock().unwrap_or_else(PoisonError::into_inner);
        receiver.recv_timeout(EVERY)
    };
    loop {
        let found = match py.detach(wait) {
            Ok(found) => Some(found),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => {
                return Err(PyRuntimeError::new_err("the work ended without a result"));
            }
        };
        let looked = py
            .check_signals()
            .and_then(|()| told(tick, shared.progress.reached()));
        if let Err(error) = looked {
            shared.stop.store(true, Ordering::Relaxed);
            on_stop();
            return Err(error);
        }
        if let Some(found) = found {
            return Ok(found);
        }
    }
}

fn told(tick: Tick<'_, '_>, reached: Reached) -> PyResult<()> {
    let Some(tick) = tick else { return Ok(()) };
    let Reached {
        step,
        steps,
        evaluations,
        hypervolume,
    } = reached;
    tick.call1((step, steps, evaluations, hypervolume))?;
    Ok(())
}
