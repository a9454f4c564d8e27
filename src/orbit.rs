//! Mean elements and the theories that turn them into TEME states.

pub mod atmosphere;
pub mod drag;
pub mod earth_orbit;
mod elements;
pub mod fit;
pub mod ground_track;
pub mod injection;
pub mod j2;
pub mod kepler;
pub mod osculating;
pub mod relations;
pub mod separation;
pub mod sgp4;
mod spread;
pub mod zonal;

pub use elements::{ElementsError, MeanElements};
pub use spread::PropagatorDistance;

use crate::frames::{State, Teme};
use crate::keyword::keywords;
use crate::time::Epoch;
use earth_orbit::ImplausibleState;
use thiserror::Error;

/// A theory bound to one satellite: seconds since the epoch in, TEME state out.
pub trait Propagator: Send + Sync {
    /// The TEME state `elapsed_s` seconds after the epoch of the elements.
    ///
    /// # Errors
    /// If the theory has no state for that instant.
    fn state_at(&self, elapsed_s: f64) -> Result<State<Teme>, PropagationError>;
}

/// Why a theory has no state.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PropagationError {
    /// SGP4 rejects the elements at their epoch.
    #[error("SGP4 rejects these elements: {reason}")]
    Sgp4Elements {
        /// The message of SGP4.
        reason: String,
    },
    /// SGP4 fails at a later time, for example because drag drives the eccentricity out of range.
    #[error("SGP4 fails at {at}: {reason}")]
    Sgp4State {
        /// The instant.
        at: Epoch,
        /// The message of SGP4.
        reason: String,
    },
    /// SGP4 puts the satellite below the ground.
    #[error(
        "the orbit has decayed at {at}: SGP4 gives a radius of {radius_km:.3} km, below the {least_km} km of the Earth"
    )]
    Decayed {
        /// The instant.
        at: Epoch,
        /// The radius, km.
        radius_km: f64,
        /// Equatorial radius of the theory, km.
        least_km: f64,
    },
    /// A theory gives a state that is impossible for an Earth orbit.
    #[error("at {at} {problem}")]
    Implausible {
        /// The instant.
        at: Epoch,
        /// What is impossible about it.
        problem: ImplausibleState,
    },
    /// A sampled trajectory has no sample at this instant.
    #[error("there is no sample {elapsed_s} s after the epoch")]
    NotSampled {
        /// Seconds since the epoch.
        elapsed_s: f64,
    },
}

keywords! {
    /// The theories with which a scenario can propagate its LEO design.
    Model {
        /// Secular J2 on the node, the perigee and the mean anomaly.
        J2 = "j2",
        /// Point-mass Earth.
        TwoBody = "two-body",
        /// Secular J2 with its first-order short-period terms.
        J2Osculating = "j2-osculating",
        /// SGP4 without drag, in AFSPC mode (WGS-72), from the J2 mean elements.
        Sgp4 = "sgp4",
    }
}

impl Model {
    /// The propagator of this model for mean elements given at `epoch`.
    ///
    /// # Errors
    /// If SGP4 rejects the elements.
    pub fn propagator(
        self,
        elements: &MeanElements,
        epoch: Epoch,
    ) -> Result<Box<dyn Propagator>, PropagationError> {
        Ok(match self {
            Self::TwoBody => Box::new(j2::SecularOrbit::two_body(elements)),
            Self::J2 => Box::new(j2::SecularOrbit::j2(elements)),
            Self::J2Osculating => Box::new(osculating::OsculatingOrbit::new(elements)),
            Self::Sgp4 => Box::new(sgp4::Sgp4Orbit::from_mean_elements(
                elements,
                epoch,
                sgp4::MeanMotionSlot::Kozai,
                sgp4::ZonalHarmonics::Full,
            )?),
        })
    }
}
