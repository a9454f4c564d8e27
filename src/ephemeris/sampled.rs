//! The states of an ephemeris in the frame of a file.

use crate::ephemeris::{Ephemeris, EphemerisError, EphemerisSatellite};
use crate::frames::{FromTeme, ReferenceFrame, State, Teme};
use crate::time::{Epoch, TimeGrid};

/// Maximum number of cached rotations, shared by all satellites; further ones are recomputed.
const KEPT: usize = 100_000;

/// An ephemeris seen in the frame `F`.
pub struct Sampled<'a, F> {
    ephemeris: &'a Ephemeris,
    frame: F,
    /// The rotation of every sample; none for a grid that is too long.
    rotations: Vec<FromTeme<F>>,
}

impl<'a, F: ReferenceFrame> Sampled<'a, F> {
    /// `ephemeris` in `frame`.
    #[must_use]
    pub fn new(ephemeris: &'a Ephemeris, frame: F) -> Self {
        let grid = ephemeris.grid();
        let rotation = |elapsed_s| FromTeme::to(frame, grid.epoch(), elapsed_s);
        let rotations = if grid.len() <= KEPT {
            grid.iter().map(rotation).collect()
        } else {
            Vec::new()
        };
        Self {
            ephemeris,
            frame,
            rotations,
        }
    }

    /// The instants.
    #[must_use]
    pub fn grid(&self) -> TimeGrid {
        self.ephemeris.grid()
    }

    /// The ephemeris.
    #[must_use]
    pub fn ephemeris(&self) -> &'a Ephemeris {
        self.ephemeris
    }

    /// The satellites.
    #[must_use]
    pub fn satellites(&self) -> &'a [EphemerisSatellite] {
        self.ephemeris.satellites()
    }

    /// The frame.
    #[must_use]
    pub fn frame(&self) -> F {
        self.frame
    }

    /// The state of a satellite `elapsed_s` after the epoch of the grid.
    ///
    /// # Errors
    /// Names the satellite whose propagation fails.
    pub fn state(
        &self,
        satellite: &EphemerisSatellite,
        elapsed_s: f64,
    ) -> Result<State<F>, EphemerisError> {
        let teme = self.ephemeris.state(satellite, elapsed_s)?;
        Ok(FromTeme::to(self.frame, self.grid().epoch(), elapsed_s).apply(teme))
    }

    /// The state of a satellite that may have none at an instant, as outside the span of its file.
    ///
    /// # Errors
    /// Names the satellite whose propagation fails.
    pub fn state_or_gap(
        &self,
        satellite: &EphemerisSatellite,
        elapsed_s: f64,
    ) -> Result<Option<State<F>>, EphemerisError> {
        let teme = self.ephemeris.state_or_gap(satellite, elapsed_s)?;
        let rotation = || FromTeme::to(self.frame, self.grid().epoch(), elapsed_s);
        Ok(teme.map(|teme| rotation().apply(teme)))
    }

    /// The TEME state of sample `k` in the frame.
    #[must_use]
    pub fn rotated(&self, k: usize, teme: State<Teme>) -> State<F> {
        let rotation = self.rotations.get(k).copied().unwrap_or_else(|| {
            FromTeme::to(self.frame, self.grid().epoch(), self.grid().elapsed_s(k))
        });
        rotation.apply(teme)
    }

    /// The state of a satellite at sample `k`.
    ///
    /// # Errors
    /// Names the satellite whose propagation fails.
    pub fn state_at(
        &self,
        satellite: &EphemerisSatellite,
        k: usize,
    ) -> Result<State<F>, EphemerisError> {
        let teme = self.ephemeris.state(satellite, self.grid().elapsed_s(k))?;
        Ok(self.rotated(k, teme))
    }

    /// The states of a satellite at every instant of the grid.
    pub fn states(
        &self,
        satellite: &EphemerisSatellite,
    ) -> impl ExactSizeIterator<Item = Result<(Epoch, State<F>), EphemerisError>> {
        let grid = self.grid();
        (0..grid.len()).map(move |k| {
            let at = grid.epoch().plus_seconds(grid.elapsed_s(k));
            Ok((at, self.state_at(satellite, k)?))
        })
    }
}
