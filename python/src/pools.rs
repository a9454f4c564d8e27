//! The threads of parallel work, which stay from call to call.

use crate::errors::NavwalkerError;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::{Arc, Mutex, PoisonError};
use std::{mem, process, thread};

/// Threads for each number of them that was asked for; `None` is one for each core.
struct Pools {
    /// The process that has the threads: one that is forked off has none of them.
    process: u32,
    known: Vec<(Option<usize>, Arc<ThreadPool>)>,
}

/// The threads of this process, so many if a number is given, or else one for each core.
pub(crate) fn pool(threads: Option<usize>) -> PyResult<Arc<ThreadPool>> {
    static POOLS: Mutex<Pools> = Mutex::new(Pools {
        process: 0,
        known: Vec::new(),
    });
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    if pools.process != process::id() {
        pools.process = process::id();
        // Threads that are not there cannot be told to end.
        mem::forget(mem::take(&mut pools.known));
    }
    let known = pools.known.iter().find(|(number, _)| *number == threads);
    if let Some((_, pool)) = known {
        return Ok(Arc::clone(pool));
    }
    // Last, since it reads files of the kernel, which takes longer than the metrics of a small study.
    let most = 4 * thread::available_parallelism().map_or(1, usize::from);
    if let Some(threads) = threads.filter(|threads| !(1..=most).contains(threads)) {
        let why = format!("threads is {threads}, expected 1 to {most}, four for each core");
        return Err(NavwalkerError::new_err(why));
    }
    let builder = ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0));
    // Work that panics ends without a result, which its caller reports.
    let builder = builder.panic_handler(|_| {});
    let built = builder.build();
    let built = Arc::new(built.map_err(|error| PyRuntimeError::new_err(error.to_string()))?);
    pools.known.push((threads, Arc::clone(&built)));
    Ok(built)
}
