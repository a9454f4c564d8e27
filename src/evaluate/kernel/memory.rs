//! What may be stored in memory, and how much is.

use super::super::Setup;
use super::super::dops::CLOCKS_FROM;
use super::CHUNK_VALUES;
use super::dilutions::largest_dilution;
use super::fixed::FixedTiles;
use super::lanes::{LANES, Lanes};
use super::normal::SharedClock;
use super::order_statistics::{Found, Places};
use super::skylines::SkyTables;
use super::tally::TileTally;
use super::tiles::{Tile, Tiles};
use crate::dop::Clocks;
use crate::frames::EarthRotation;
use crate::ground::Site;

/// What may be stored in memory. Beyond this, values are recomputed when needed, so memory does not
/// grow with points times instants.
#[derive(Debug, Clone, Copy)]
pub(super) struct Keep {
    /// Values of PDOP between the two passes of the statistics of one design.
    pub(super) values: usize,
    /// Bytes of the GNSS sums between designs.
    pub(super) fixed_bytes: usize,
}

impl Default for Keep {
    fn default() -> Self {
        Self {
            values: 4 << 20,
            fixed_bytes: 256 << 20,
        }
    }
}

/// Size of the counts of one pass up to which threads have several, bytes.
const SMALL_TALLY_BYTES: usize = 2 << 20;
/// How many then, so that a slow thread does not keep the others waiting.
const SMALL_TALLIES: usize = 4;

/// Number of points, sixteen at a time.
fn site_tiles(setup: &Setup) -> usize {
    setup.sites.len().div_ceil(LANES)
}

/// Tiles of all instants.
fn tiles(setup: &Setup) -> usize {
    site_tiles(setup) * setup.grid.len()
}

/// Maximum number of accumulators of a pass over the instants on so many threads.
pub(super) fn accumulators(threads: usize, tiles: &Tiles) -> usize {
    accumulators_of(threads, tiles.tiles.len())
}

fn accumulators_of(threads: usize, site_tiles: usize) -> usize {
    let is_small = site_tiles * size_of::<TileTally>() <= SMALL_TALLY_BYTES;
    threads.max(1) * if is_small { SMALL_TALLIES } else { 1 }
}

/// Memory of what is the same for all designs, bytes.
fn kernel_bytes(setup: &Setup) -> usize {
    let (points, instants) = (setup.sites.len(), setup.grid.len());
    let lists = points * (size_of::<Site>() + size_of::<u64>());
    let own_tiles = site_tiles(setup) * (size_of::<Tile>() + LANES * size_of::<u32>());
    let rotations = instants * size_of::<EarthRotation>();
    let fixed = if keeps_fixed(setup) {
        tiles(setup) * FixedTiles::bytes(setup.clocks)
    } else {
        0
    };
    lists + own_tiles + rotations + fixed + SkyTables::bytes(&setup.sites)
}

fn keeps_fixed(setup: &Setup) -> bool {
    let bytes = tiles(setup) * FixedTiles::bytes(setup.clocks);
    !setup.gnss.is_empty() && bytes <= Keep::default().fixed_bytes
}

/// Memory of one thread at an instant, bytes: what is found there, and the GNSS sums if they are not kept.
fn instant_bytes(setup: &Setup) -> usize {
    let found = size_of::<Lanes<f32>>() + size_of::<Lanes<u32>>();
    let fixed = if setup.gnss.is_empty() || keeps_fixed(setup) {
        0
    } else {
        FixedTiles::bytes(setup.clocks)
    };
    site_tiles(setup) * (found + fixed)
}

/// Memory of the counts over some instants, bytes.
fn tally_bytes(setup: &Setup) -> usize {
    site_tiles(setup) * size_of::<TileTally>()
}

/// Memory of a kernel and of so many evaluations at a time on `threads` threads, bytes.
pub(in super::super) fn memory_bytes(setup: &Setup, threads: usize, evaluations: usize) -> usize {
    let values = tiles(setup) * LANES;
    let counts = Places::new(setup.pdop_cap).bytes() + Found::BYTES;
    let accumulator = counts + tally_bytes(setup);
    let needed = if values <= Keep::default().values {
        evaluations * (accumulator + values * size_of::<f32>())
    } else {
        let each = accumulators_of(threads, site_tiles(setup));
        // Halves of the instants are merged one after the other: of many evaluations, each on one thread, one is kept at
        // each level while the other half is made.
        let merged = evaluations * (each.ilog2() as usize + 1);
        accumulator * merged.max(each)
    };
    kernel_bytes(setup) + needed + threads * instant_bytes(setup)
}

/// Memory of a kernel and of a tile of time evaluated on `threads` threads, bytes.
pub(in super::super) fn memory_of_tile_bytes(setup: &Setup, threads: usize) -> usize {
    let slots = site_tiles(setup) * LANES;
    // The values of a piece, once more as it is collected, and as the bytes that are written.
    let values = 3 * slots.max(CHUNK_VALUES) * size_of::<f32>();
    kernel_bytes(setup) + threads * (tally_bytes(setup) + instant_bytes(setup) + values)
}

/// Memory of the clocks of the GNSS at all instants, bytes.
fn clock_bytes(setup: &Setup) -> usize {
    let systems = match setup.clocks {
        Clocks::PerSystem => setup.gnss.len(),
        Clocks::Shared => 0,
    };
    match tiles(setup) * systems * size_of::<SharedClock>() {
        bytes if bytes > Keep::default().fixed_bytes => 0,
        bytes => bytes,
    }
}

/// Memory of all dilutions of one evaluation, bytes.
pub(in super::super) fn dops_bytes(setup: &Setup, threads: usize) -> usize {
    let rows = CLOCKS_FROM + setup.clock_states();
    let places = Places::new(largest_dilution(setup, 1));
    let counts = rows * (places.bytes() + Found::BYTES);
    let values = match tiles(setup) * LANES {
        values if values <= Keep::default().values => rows * values * size_of::<f32>() + counts,
        _ => threads * counts,
    };
    values + clock_bytes(setup)
}
