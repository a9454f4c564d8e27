//! Mean elements and the theories that turn them into TEME states.

mod elements;
pub mod j2;
pub mod kepler;
pub mod osculating;
pub mod sgp4;

pub use elements::{ElementsError, MeanElements};

use crate::frames::State;
use crate::time::Epoch;
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// A theory bound to one satellite: seconds since the epoch in, TEME state out.
pub trait Propagator: Send + Sync {
    /// The TEME state `elapsed_s` seconds after the epoch of the elements.
    ///
    /// # Errors
    /// When the theory has no state for that instant.
    fn state_at(&self, elapsed_s: f64) -> Result<State, PropagationError>;
}

/// Why a theory gives no state.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PropagationError {
    /// SGP4 refuses the elements at their epoch.
    #[error("SGP4 does not take these elements: {reason}")]
    Sgp4Elements {
        /// What SGP4 says.
        reason: String,
    },
    /// SGP4 gives up at a later time, as for a decayed orbit.
    #[error("SGP4 stops {elapsed_s} s after the epoch: {reason}")]
    Sgp4State {
        /// Seconds since the epoch of the elements.
        elapsed_s: f64,
        /// What SGP4 says.
        reason: String,
    },
}

/// The theories that a scenario can fly its LEO design with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Model {
    /// Point-mass Earth.
    TwoBody,
    /// Secular J2 on the node, the perigee and the mean anomaly.
    J2,
    /// Secular J2 with its first-order short-period terms.
    J2Osculating,
    /// SGP4 without drag, in AFSPC mode (WGS-72), from the J2 mean elements.
    Sgp4,
}

/// A name that is no propagation model.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("unknown propagation model '{0}'")]
pub struct UnknownModel(pub String);

impl Model {
    /// Every model, in the order of the documentation.
    pub const ALL: [Self; 4] = [Self::TwoBody, Self::J2, Self::J2Osculating, Self::Sgp4];

    /// The name in scenario files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::TwoBody => "two-body",
            Self::J2 => "j2",
            Self::J2Osculating => "j2-osculating",
            Self::Sgp4 => "sgp4",
        }
    }

    /// The propagator of this model for mean elements given at `epoch`.
    ///
    /// # Errors
    /// When SGP4 refuses the elements.
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

impl fmt::Display for Model {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

impl FromStr for Model {
    type Err = UnknownModel;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Self::ALL
            .into_iter()
            .find(|model| model.name() == text)
            .ok_or_else(|| UnknownModel(text.to_owned()))
    }
}
