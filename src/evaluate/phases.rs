//! The arbitrary phase of nominal GNSS constellations.

use super::Setup;
use crate::constellation::gnss::System;
use thiserror::Error;

/// Why the GNSS of a setup has no other phase.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum PhaseError {
    /// No GNSS.
    #[error("the scenario has no GNSS")]
    NoGnss,
    /// A system whose satellites have the places that files give them.
    #[error(
        "the satellites of {0} have the places that their file gives; only built-in constellations have a phase"
    )]
    Given(String),
}

impl Setup {
    /// The same setup with every GNSS as for an epoch a share of a sidereal day later, 0 <= share < 1, while the Earth and the LEO satellites
    /// stay where they are ([M-52](crate::models#m-52)).
    ///
    /// # Errors
    /// If there is no GNSS, or one is not a nominal constellation.
    pub fn at_gnss_phase(&self, share: f64) -> Result<Self, PhaseError> {
        if self.gnss.is_empty() {
            return Err(PhaseError::NoGnss);
        }
        let epoch = self.grid.epoch();
        let later = |system: &System| match system {
            System::Preset(preset) => Ok(System::Listed {
                name: system.name().to_owned(),
                satellites: preset.satellites_at_phase(epoch, share),
            }),
            System::Sets(_) | System::Listed { .. } => {
                Err(PhaseError::Given(system.name().to_owned()))
            }
        };
        let gnss = self.gnss.iter().map(later).collect::<Result<_, _>>()?;
        Ok(Self {
            gnss,
            ..self.clone()
        })
    }
}
