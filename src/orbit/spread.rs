//! Distance between two propagations of one satellite.

use crate::orbit::{PropagationError, Propagator};
use crate::time::TimeGrid;

/// Distances over a span.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PropagatorDistance {
    /// Largest distance, km.
    pub max_km: f64,
    /// Root mean square distance, km.
    pub rms_km: f64,
}

impl PropagatorDistance {
    /// The distances between two propagators over the samples of `grid`.
    ///
    /// # Errors
    /// If one of them has no state.
    pub fn between(
        one: &dyn Propagator,
        other: &dyn Propagator,
        grid: TimeGrid,
    ) -> Result<Self, PropagationError> {
        let (mut max_km, mut sum) = (0.0_f64, 0.0);
        for elapsed_s in grid.iter() {
            let apart =
                one.state_at(elapsed_s)?.position_km - other.state_at(elapsed_s)?.position_km;
            max_km = max_km.max(apart.norm());
            sum += apart.norm_squared();
        }
        let rms_km = (sum / grid.len() as f64).sqrt();
        Ok(Self { max_km, rms_km })
    }

    /// The larger of each distance: that of the satellite with the largest loss.
    pub fn widen(&mut self, other: &Self) {
        self.max_km = self.max_km.max(other.max_km);
        self.rms_km = self.rms_km.max(other.rms_km);
    }
}
