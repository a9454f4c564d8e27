//! Work that Ctrl-C ends.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// How often signals are looked at.
const EVERY: Duration = Duration::from_millis(50);

/// Whether work that is asked to stop goes on; looked at between designs and generations.
#[derive(Clone, Default)]
pub(crate) struct Stop(Arc<AtomicBool>);

impl Stop {
    pub(crate) fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Does some work in a thread of its own, on at most `threads` cores, without the lock of the interpreter. At Ctrl-C the
/// exception is raised at once; the work is asked to stop, and what it finds is dropped.
pub(crate) fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    threads: Option<usize>,
    on_stop: fn(),
    work: impl FnOnce(&Stop) -> T + Send + 'static,
) -> PyResult<T> {
    let stop = Stop::default();
    let own = stop.clone();
    let (sender, receiver) = sync_channel(1);
    let pool = threads.map(pool).transpose()?;
    let run = move || match pool {
        Some(pool) => pool.install(|| work(&own)),
        None => work(&own),
    };
    // If nobody waits any more, the result is of no use.
    thread::spawn(move || sender.send(run()));
    let receiver = Mutex::new(receiver);
    let wait = || {
        let receiver = receiver.lock().unwrap_or_else(PoisonError::into_inner);
        receiver.recv_timeout(EVERY)
    };
    loop {
        match py.detach(wait) {
            Ok(found) => return Ok(found),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err(PyRuntimeError::new_err("the work ended without a result"));
            }
        }
        if let Err(signal) = py.check_signals() {
            stop.0.store(true, Ordering::Relaxed);
            on_stop();
            return Err(signal);
        }
    }
}

fn pool(threads: usize) -> PyResult<rayon::ThreadPool> {
    let most = 4 * thread::available_parallelism().map_or(1, usize::from);
    if !(1..=most).contains(&threads) {
        let why = format!("threads is {threads}, expected 1 to {most}, four for each core");
        return Err(super::errors::NavwalkerError::new_err(why));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| PyRuntimeError::new_err(error.to_string()))
}
