//! An evaluation in tiles of time: the samples of some instants, and the statistics of all from what the tiles give.
//!
//! No sample depends on another, so that the values of a tile are those of the whole evaluation. What follows from them is
//! computed from the values of all tiles in the pieces and the order of the whole evaluation, so that it has the same
//! bits, however the instants are cut.

use super::super::histograms::ViewBins;
use super::super::metrics::Evaluated;
use super::Kernel;
use super::lanes::{LANES, Lanes};
use super::order_statistics::{Counts, Found, RankSearch};
use super::propagation::Propagation;
use super::sample::UNSOLVED;
use super::tally::ViewTally;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::stats::Summary;
use rayon::prelude::*;
use std::io;
use std::ops::Range;

/// Reads the values of an instant and those after it, as [`Kernel::tile`] gave them.
type ReadValues<'r> = dyn FnMut(usize, &mut [u8]) -> io::Result<()> + 'r;

/// The values of some instants, and the satellites in view, LEO and all.
type TilePiece = (Vec<Lanes<f32>>, [ViewBins; 2]);

/// Bytes of a value.
const VALUE_BYTES: usize = size_of::<f32>();

impl Kernel {
    /// Bytes of the values of an instant.
    pub(in crate::evaluate) fn bytes_of_instant(&self) -> usize {
        self.scene.tiles.slots() * VALUE_BYTES
    }

    /// Evaluates some instants: passes their values to `put`, in order, and gives the satellites in view.
    pub(in crate::evaluate) fn tile<E: From<EphemerisError> + From<io::Error>>(
        &self,
        ephemeris: &Ephemeris,
        instants: Range<usize>,
        mut put: impl FnMut(&[u8]) -> io::Result<()>,
    ) -> Result<[ViewBins; 2], E> {
        let propagation = &self.propagation(ephemeris);
        let mut bins = [ViewBins::default(), ViewBins::default()];
        // A piece for each thread is in memory; their number moves no byte.
        for together in self.pieces(instants).chunks(rayon::current_num_threads()) {
            let pieces = together.par_iter();
            let pieces = pieces.map(|piece| self.piece(propagation, piece.clone()));
            for (values, of_piece) in pieces.collect::<Result<Vec<_>, _>>()? {
                let numbers = values.iter().flat_map(|lanes| lanes.0);
                let bytes: Vec<u8> = numbers.flat_map(f32::to_le_bytes).collect();
                put(&bytes)?;
                for (all, more) in bins.iter_mut().zip(&of_piece) {
                    all.merge(more);
                }
            }
        }
        Ok(bins)
    }

    fn piece(
        &self,
        propagation: &Propagation<'_>,
        instants: Range<usize>,
    ) -> Result<TilePiece, EphemerisError> {
        let mut values = Vec::with_capacity(instants.len() * self.scene.tiles.tiles.len());
        let mut tally = self.tally(true);
        self.run(propagation, instants, self.scene.limits, |instant| {
            values.extend_from_slice(&instant.outcome.pdop);
            self.tally_instant(instant, &mut tally);
            Ok(())
        })?;
        Ok((values, tally.bins.unwrap_or_default()))
    }

    /// The evaluation of satellites whose values are read, with the satellites in view of all tiles.
    pub(in crate::evaluate) fn merged<E: From<EphemerisError> + From<io::Error>>(
        &self,
        ephemeris: &Ephemeris,
        bins: [ViewBins; 2],
        read: &mut ReadValues<'_>,
    ) -> Result<Evaluated, E> {
        let mut tally = self.tally(false);
        let mut counts = Counts::new(self.places);
        let summary = if self.keeps_values() {
            let mut values = Vec::new();
            let sums = self.by_chunk(read, |chunk| {
                values.extend_from_slice(chunk);
                self.tally_chunk(chunk, &mut tally);
                self.count(chunk, &mut counts)
            })?;
            let sum = sums.iter().sum();
            self.summary_of_kept(&self.propagation(ephemeris), &values, (&counts, sum))?
        } else {
            let sums = self.by_chunk(read, |chunk| {
                self.tally_chunk(chunk, &mut tally);
                self.by_instant(chunk, |values| self.count(values, &mut counts))
            })?;
            self.summary_of_read(&counts, sums.iter().sum(), read)?
        };
        Ok(Evaluated {
            leo: bins[0].views(),
            all: bins[1].views(),
            bins: Some(bins),
            ..self.evaluated(&mut tally, &counts, summary)
        })
    }

    /// The statistics of values that are read a second time; `None` if none is solved.
    fn summary_of_read(
        &self,
        counts: &Counts,
        sum: f64,
        read: &mut ReadValues<'_>,
    ) -> io::Result<Option<Summary>> {
        let Some(search) = RankSearch::new(counts, self.setup.metrics.cvar_level) else {
            return Ok(None);
        };
        let mut found = Found::new();
        let tails = self.by_chunk(read, |chunk| {
            self.by_instant(chunk, |values| self.find(values, &search, &mut found))
        })?;
        let tail = tails.iter().sum();
        Ok(Some(search.summary(&found, sum, tail)))
    }

    /// A sum for each chunk of the whole evaluation, whose values are read.
    fn by_chunk(
        &self,
        read: &mut ReadValues<'_>,
        mut sum: impl FnMut(&[Lanes<f32>]) -> f64,
    ) -> io::Result<Vec<f64>> {
        let (mut bytes, mut sums) = (Vec::new(), Vec::new());
        for chunk in self.chunks(self.setup.grid.len()) {
            bytes.resize(chunk.len() * self.bytes_of_instant(), 0);
            read(chunk.start, &mut bytes)?;
            sums.push(sum(&self.values_of(&bytes)?));
        }
        Ok(sums)
    }

    /// The sum over the instants of a chunk, one after the other.
    fn by_instant(&self, chunk: &[Lanes<f32>], mut sum: impl FnMut(&[Lanes<f32>]) -> f64) -> f64 {
        let instants = chunk.chunks_exact(self.scene.tiles.tiles.len());
        instants.fold(0.0, |part, values| part + sum(values))
    }

    fn tally_chunk(&self, chunk: &[Lanes<f32>], tally: &mut ViewTally<'_>) {
        let instants = chunk.chunks_exact(self.scene.tiles.tiles.len());
        instants.for_each(|values| self.tally_values(values, tally));
    }

    /// The values in some bytes, if they can be those of samples.
    fn values_of(&self, bytes: &[u8]) -> io::Result<Vec<Lanes<f32>>> {
        let mut values = Vec::with_capacity(bytes.len() / (LANES * VALUE_BYTES));
        let tiles = self.scene.tiles.tiles.iter().cycle();
        for (bytes, tile) in bytes.chunks_exact(LANES * VALUE_BYTES).zip(tiles) {
            let mut lanes = Lanes([UNSOLVED; LANES]);
            let members = lanes.0.iter_mut().take(tile.members.len());
            let (numbers, _) = bytes.as_chunks::<VALUE_BYTES>();
            for (value, number) in members.zip(numbers) {
                *value = f32::from_le_bytes(*number);
            }
            if !lanes.0.iter().all(|value| self.places.admits(*value)) {
                let message = "a value is not that of a sample";
                return Err(io::Error::new(io::ErrorKind::InvalidData, message));
            }
            values.push(lanes);
        }
        Ok(values)
    }
}
