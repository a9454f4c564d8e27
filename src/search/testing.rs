//! A shell of a search for tests.

use super::{ShellSpace, SweepSteps};
use crate::constellation::Pattern;

/// Circular delta patterns.
pub(crate) fn shell() -> ShellSpace {
    ShellSpace {
        pattern: vec![Pattern::Delta],
        planes: [3, 15],
        satellites_per_plane: [11, 15],
        inclination_deg: [40.0, 60.0].into(),
        altitude_km: [400.0, 1000.0].into(),
        phasing: [0, 14],
        eccentricity: [0.0, 0.0],
        arg_perigee_deg: [0.0, 0.0],
        raan_deg: None,
        arg_latitude_deg: None,
        node_step_deg: None,
        steps: SweepSteps {
            inclination_step_deg: 0.5,
            altitude_step_km: 50.0,
            eccentricity_step: 0.1,
            arg_perigee_step_deg: 30.0,
            raan_step_deg: None,
            arg_latitude_step_deg: None,
            node_step_step_deg: None,
        },
    }
}
