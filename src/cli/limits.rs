//! Bounds on what is started; beyond some of them only with `--allow-large`.

use crate::cli::output;
use crate::evaluate::Setup;
use crate::exchange::export::ExportSize;
use crate::units::counted;
use anyhow::{Result, bail};
use std::fs;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::available_parallelism;

/// Threads for each core: more of them only take memory.
const THREADS_PER_CORE: usize = 4;
/// Size of an export that needs `--allow-large`, bytes.
const LARGE_EXPORT_BYTES: u64 = 10_000_000_000;
/// Size of an export from which its size and time are printed, bytes.
const TOLD_EXPORT_BYTES: u64 = 100_000_000;
/// Speed of writing an export, bytes per second: measured at 16 to 60 MB/s on two cores.
const WRITTEN_PER_S: u64 = 30_000_000;
/// Designs of a search for the fewest satellites that need `--allow-large`.
const LARGE_SEARCH: f64 = 1e9;
/// Samples of one evaluation that need `--allow-large`, unless it is in tiles.
const LARGE_EVALUATION: f64 = 1e9;
/// Time of a sweep from which it is printed, seconds.
const TOLD_SEARCH_S: f64 = 10.0;
/// Speed of full evaluations on one thread, samples per second: the paper's 205 920 in about 6 ms.
const SAMPLES_PER_S: f64 = 35e6;
/// Size of a design in the table of a sweep, bytes: some sixty numbers and its notation.
const SWEPT_DESIGN_BYTES: f64 = 500.0;
/// Memory taken for granted where the system does not say what is available, bytes.
const ASSUMED_MEMORY_BYTES: u64 = 8 << 30;

/// Whether `--allow-large` was given; set once, from the command line.
static ALLOW_LARGE: AtomicBool = AtomicBool::new(false);

pub(crate) fn set_allow_large(allow: bool) {
    ALLOW_LARGE.store(allow, Ordering::Relaxed);
}

fn allows_large() -> bool {
    ALLOW_LARGE.load(Ordering::Relaxed)
}

/// Refuses more threads than are of use.
pub(crate) fn check_threads(threads: NonZeroUsize) -> Result<()> {
    let cores = available_parallelism().map_or(1, NonZeroUsize::get);
    let most = THREADS_PER_CORE * cores;
    if threads.get() > most {
        bail!(
            "--threads {threads}: expected at most {most}, which is {THREADS_PER_CORE} for each core"
        );
    }
    Ok(())
}

/// Fails before starting if one evaluation has very many samples, which an evaluation in tiles may have.
fn check_samples(setup: &Setup) -> Result<()> {
    let samples = setup.sample_count() as f64;
    if samples > LARGE_EVALUATION && !allows_large() {
        let threads = rayon::current_num_threads() as f64;
        // A stream is computed twice.
        let time_s = 2.0 * samples / (SAMPLES_PER_S * threads);
        bail!(
            "{} points x {} instants are {} samples; one evaluation of 200 satellites takes about {} here and {} of memory. \
             More than {LARGE_EVALUATION:.0e} need --allow-large, or evaluate --tile I/N, or use a coarser region.step-deg \
             or time.step-s",
            setup.sites.len(),
            setup.grid.len(),
            shown_count(samples),
            shown_time(time_s as u64),
            shown_bytes(setup.memory_bytes(rayon::current_num_threads(), 1))
        );
    }
    Ok(())
}

/// Fails before starting if a search in a scenario, an evaluation on each thread, is very large.
pub(crate) fn check_search(setup: &Setup) -> Result<()> {
    check_samples(setup)?;
    let threads = rayon::current_num_threads();
    check_fits(setup, setup.memory_bytes(threads, threads))
}

/// The same for one constellation at a time.
pub(crate) fn check_whole(setup: &Setup) -> Result<()> {
    check_samples(setup)?;
    check_memory_of_tables(setup, false, false)
}

/// Fails before starting if one evaluation with all dilutions or the series needs more memory than is available.
pub(crate) fn check_memory_of_tables(setup: &Setup, dops: bool, series: bool) -> Result<()> {
    let threads = rayon::current_num_threads();
    let dops = if dops { setup.dops_bytes(threads) } else { 0 };
    let series = if series { setup.series_bytes() } else { 0 };
    check_fits(setup, setup.memory_bytes(threads, 1) + dops + series)
}

fn check_fits(setup: &Setup, needed: u64) -> Result<()> {
    let available = available_memory().unwrap_or(ASSUMED_MEMORY_BYTES);
    if needed > available && !allows_large() {
        let gib = |bytes: u64| bytes as f64 / f64::from(1 << 30);
        bail!(
            "{} points x {} instants need {:.1} GiB of memory, but {:.1} GiB are available; \
             use a coarser region.step-deg or time.step-s, or fewer --threads, or start it anyway with \
             --allow-large",
            setup.sites.len(),
            setup.grid.len(),
            gib(needed),
            gib(available)
        );
    }
    Ok(())
}

/// Available memory, bytes; `None` if unknown (other than Linux).
fn available_memory() -> Option<u64> {
    let text = fs::read_to_string("/proc/meminfo").ok()?;
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib * 1024)
}

/// Says what an export comes to if it is large, and fails before starting if it is very large.
pub(crate) fn check_export(size: ExportSize) -> Result<()> {
    let told = told(size);
    if size.bytes > LARGE_EXPORT_BYTES && !allows_large() {
        bail!(
            "the export would be {told}; more than {} needs --allow-large, or use a larger time.step-s",
            shown_bytes(LARGE_EXPORT_BYTES)
        );
    }
    if size.bytes >= TOLD_EXPORT_BYTES {
        output::hint(&format!("writing {told}"));
    }
    Ok(())
}

/// Says how many designs a search for the fewest satellites would try if none kept the constraints and what an
/// evaluation of all would take, and refuses very many.
pub(crate) fn check_designs(designs: f64, samples: f64) -> Result<()> {
    let threads = rayon::current_num_threads() as f64;
    let sweep_s = samples / (SAMPLES_PER_S * threads);
    let told = format!(
        "{} designs; evaluating all of them in full would take about {}, of which rejecting early takes a small part",
        shown_count(designs),
        shown_time(sweep_s as u64)
    );
    if designs > LARGE_SEARCH && !allows_large() {
        bail!(
            "the grid of the search has {told}; more than {LARGE_SEARCH:.0e} need --allow-large, or use larger steps \
             or intervals in [search]"
        );
    }
    if sweep_s > TOLD_SEARCH_S {
        output::hint(&format!("the grid of the search has at most {told}"));
    }
    Ok(())
}

/// Says how large a sweep is and what it would take, and refuses a very large one.
pub(crate) fn check_sweep(designs: f64, one_thread_s: f64) -> Result<()> {
    let bytes = (designs * SWEPT_DESIGN_BYTES) as u64;
    let time_s = one_thread_s / rayon::current_num_threads() as f64;
    let told = format!(
        "{} designs, a table of about {}, in about {} here",
        shown_count(designs),
        shown_bytes(bytes),
        shown_time(time_s as u64)
    );
    if bytes > LARGE_EXPORT_BYTES && !allows_large() {
        bail!(
            "the sweep would have {told}; more than {} needs --allow-large, or use larger steps or intervals in [search]",
            shown_bytes(LARGE_EXPORT_BYTES)
        );
    }
    if time_s > TOLD_SEARCH_S {
        output::hint(&format!("sweep of {told}"));
    }
    Ok(())
}

/// Says what the tiles of an evaluation come to.
pub(crate) fn say_of_tiles(setup: &Setup, size: &TileSize) {
    let threads = rayon::current_num_threads();
    let seconds = size.one_thread_s / threads as f64;
    output::hint(&format!(
        "{} points x {} instants are {} samples in {}: one takes {} here, {} of memory and a file of {}",
        setup.sites.len(),
        setup.grid.len(),
        shown_count(setup.sample_count() as f64),
        counted(size.tiles, "tile"),
        shown_time(seconds as u64),
        shown_bytes(setup.memory_of_tile_bytes(threads)),
        shown_bytes(size.all_bytes / size.tiles as u64),
    ));
}

/// What a tile of an evaluation comes to.
pub(crate) struct TileSize {
    /// Number of tiles.
    pub(crate) tiles: usize,
    /// Bytes of the files of all tiles.
    pub(crate) all_bytes: u64,
    /// Time of a tile on one thread, seconds.
    pub(crate) one_thread_s: f64,
}

/// All digits of a count up to a million, then a power of ten.
fn shown_count(count: f64) -> String {
    if count < 1e6 {
        return format!("{count:.0}");
    }
    let exponent = count.log10().floor();
    format!("{:.1}e{exponent:.0}", count / 10_f64.powf(exponent))
}

/// Number, size and time of an export.
fn told(size: ExportSize) -> String {
    let ExportSize { files, bytes } = size;
    let time = shown_time(bytes / WRITTEN_PER_S);
    format!(
        "about {} of {} in all, in about {time}",
        counted(usize::try_from(files).unwrap_or(usize::MAX), "file"),
        shown_bytes(bytes)
    )
}

fn shown_bytes(bytes: u64) -> String {
    let [mega, giga, tera] = [1e6, 1e9, 1e12].map(|unit| bytes as f64 / unit);
    if mega < 1.0 {
        "less than 1 MB".to_owned()
    } else if tera >= 1.0 {
        format!("{tera:.1} TB")
    } else if giga >= 1.0 {
        format!("{giga:.1} GB")
    } else {
        format!("{mega:.0} MB")
    }
}

/// A time in the unit of its order.
pub(crate) fn shown_time(seconds: u64) -> String {
    match seconds {
        0 => "less than 1 s".to_owned(),
        1..120 => format!("{seconds} s"),
        120..7200 => format!("{} min", seconds / 60),
        7200..259_200 => format!("{} h", seconds / 3600),
        259_200..63_072_000 => format!("{} days", seconds / 86_400),
        _ => format!("{} years", seconds / 31_536_000),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_times_are_told_in_units_of_their_order() {
        let told = |files, bytes| told(ExportSize { files, bytes });
        assert_eq!(
            told(182, 150_000_000),
            "about 182 files of 150 MB in all, in about 5 s"
        );
        assert_eq!(
            told(1, 12_000_000_000),
            "about 1 file of 12.0 GB in all, in about 6 min"
        );
        assert_eq!(
            told(2, 2_000_000_000_000),
            "about 2 files of 2.0 TB in all, in about 18 h"
        );
    }
}
