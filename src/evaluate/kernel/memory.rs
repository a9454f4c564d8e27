//! What may be stored in memory, and how much is.

use super::super::Setup;
use super::super::dops::CLOCKS_FROM;
use super::dilutions::largest_dilution;
use super::fixed::FixedTiles;
use super::lanes::LANES;
use super::normal::SharedClock;
use super::order_statistics::{Found, Places};
use super::skylines::SkyTables;
use super::tally::TileTally;
use crate::dop::Clocks;

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

/// Tiles of all instants.
fn tiles(setup: &Setup) -> usize {
    setup.sites.len().div_ceil(LANES) * setup.grid.len()
}

/// Memory of a kernel and of `threads` evaluations at a time, bytes.
pub(in super::super) fn memory_bytes(setup: &Setup, threads: usize) -> usize {
    let keep = Keep::default();
    let tiles = tiles(setup);
    let values = (tiles * LANES).min(keep.values) * size_of::<f32>();
    let fixed = match tiles * FixedTiles::bytes(setup.clocks) {
        bytes if setup.gnss.is_empty() || bytes > keep.fixed_bytes => 0,
        bytes => bytes,
    };
    let tallies = setup.sites.len().div_ceil(LANES) * size_of::<TileTally>();
    let counts = Places::new(setup.pdop_cap).bytes() + Found::BYTES;
    fixed + SkyTables::bytes(&setup.sites) + threads * (values + counts + tallies)
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
    let places = Places::new(largest_dilution(setup));
    let counts = rows * (places.bytes() + Found::BYTES);
    let values = match tiles(setup) * LANES {
        values if values <= Keep::default().values => rows * values * size_of::<f32>() + counts,
        _ => threads * counts,
    };
    values + clock_bytes(setup)
}
