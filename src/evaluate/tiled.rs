//! One evaluation in tiles of time, each evaluated anywhere, to the bits of the whole.

use super::histograms::ViewBins;
use super::{Evaluator, Metrics, ViewHistograms};
use crate::ephemeris::{Ephemeris, EphemerisError};
use serde::{Deserialize, Serialize};
use std::io::{self, Write};
use std::ops::Range;
use thiserror::Error;

/// What is counted over the samples of a tile: the satellites in view.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TileCounts {
    leo: ViewBins,
    all: ViewBins,
}

/// Why a tile cannot be evaluated or merged.
#[derive(Debug, Error)]
pub enum TileError {
    /// The setup asks for what is not computed from the values of PDOP and the satellites in view.
    #[error("an evaluation with {what} cannot be cut into tiles")]
    Indivisible {
        /// What it asks for.
        what: &'static str,
    },
    /// The counts of the tiles are not those of these samples.
    #[error("the counts are not those of these points and instants")]
    Counts,
    /// A satellite cannot be propagated.
    #[error(transparent)]
    Ephemeris(#[from] EphemerisError),
    /// Values cannot be written or read.
    #[error(transparent)]
    Io(#[from] io::Error),
}

impl TileCounts {
    /// Adds those of another tile.
    pub fn merge(&mut self, other: &Self) {
        self.leo.merge(&other.leo);
        self.all.merge(&other.all);
    }

    /// Whether they may be those of samples of this weight.
    fn are_of(&self, weight: u64) -> bool {
        match (self.leo.totals(), self.all.totals()) {
            (Some(leo), Some(all)) => leo.0 == weight && all.0 == weight && leo.1 <= all.1,
            _ => false,
        }
    }
}

impl Evaluator {
    /// Bytes of the values of an instant in a tile.
    #[must_use]
    pub fn bytes_of_instant(&self) -> usize {
        self.kernel.bytes_of_instant()
    }

    /// Refuses what cannot be cut into tiles.
    ///
    /// # Errors
    /// If the setup asks for more than PDOP and satellites in view.
    pub fn require_divisible(&self) -> Result<(), TileError> {
        let setup = self.setup();
        let asked = [
            (setup.accuracy.is_some(), "the accuracy in metres"),
            (setup.window_s.is_some(), "the PDOP of windows"),
            (setup.metrics.asks_for_hdop, "quantiles of HDOP and VDOP"),
            (setup.metrics.asks_for_n1, "the loss of each satellite"),
            (
                setup.metrics.expects_up.is_some(),
                "the expected availability",
            ),
        ];
        match asked.into_iter().find(|(is_asked, _)| *is_asked) {
            Some((_, what)) => Err(TileError::Indivisible { what }),
            None => Ok(()),
        }
    }

    /// Evaluates the samples of some instants, writes their values, [`Evaluator::bytes_of_instant`] each, and gives the
    /// satellites in view.
    ///
    /// # Errors
    /// If the evaluation cannot be cut, a satellite cannot be propagated, or the values cannot be written.
    pub fn evaluate_tile(
        &self,
        ephemeris: &Ephemeris,
        instants: Range<usize>,
        values: &mut impl Write,
    ) -> Result<TileCounts, TileError> {
        self.require_divisible()?;
        let end = instants.end.min(self.setup().grid.len());
        let put = |bytes: &[u8]| values.write_all(bytes);
        let [leo, all] = self
            .kernel
            .tile::<TileError>(ephemeris, instants.start..end, put)?;
        Ok(TileCounts { leo, all })
    }

    /// The metrics of some satellites and the histograms of those in view, as [`Evaluator::evaluate_views`] gives them to the
    /// bit, from the tiles of all instants: their counts together, and their values, which `read` reads from an instant on.
    ///
    /// Those of no satellites, the GNSS alone, are kept for the gain and the histograms of what is merged after them.
    ///
    /// # Errors
    /// If the evaluation cannot be cut, the counts or the values are not those of its samples, or they cannot be read.
    pub fn merge_tiles(
        &self,
        ephemeris: &Ephemeris,
        counts: TileCounts,
        read: &mut dyn FnMut(usize, &mut [u8]) -> io::Result<()>,
    ) -> Result<(Metrics, ViewHistograms), TileError> {
        self.require_divisible()?;
        if !counts.are_of(self.weights.total()) {
            return Err(TileError::Counts);
        }
        let TileCounts { leo, all } = counts;
        let evaluated =
            self.kernel
                .merged::<TileError>(ephemeris, [leo.clone(), all.clone()], read)?;
        let metrics = self.metrics(&evaluated, ephemeris)?;
        if ephemeris.satellites().is_empty() && !self.setup().gnss.is_empty() {
            let alone = metrics.with_gain_over(&metrics);
            self.gnss_only.get_or_init(|| (alone, all.clone()));
        }
        Ok((metrics, self.histograms([leo, all])?))
    }
}
