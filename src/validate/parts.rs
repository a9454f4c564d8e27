//! The parts under test and the instruments that judge them, which a test can replace.

use super::numerical::integrator::{Acceleration, ZonalField};
use crate::constellation::{Satellite, Shell};
use crate::dop::Clocks;
use crate::earth::Surface;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::evaluate::{Evaluator, Metrics};
use crate::formats::tle::{self, TleFieldError};
use crate::frames::{EarthFixed, LocalFrame, Position};
use crate::orbit::j2::SecularOrbit;
use crate::orbit::sgp4::{MeanMotionSlot, Sgp4Theory};
use crate::orbit::{MeanElements, Model, PropagationError, Propagator};
use crate::time::Epoch;

/// Makes the propagator of a model for mean elements at an epoch.
pub type ModelPropagator =
    fn(Model, &MeanElements, Epoch) -> Result<Box<dyn Propagator>, PropagationError>;

/// The parts of the library that are compared with standards, and of the instruments that judge them.
///
/// Ours by default. A test puts a mistake in the place of one, to see which checks notice it.
#[derive(Debug, Clone, Copy)]
pub struct Parts {
    /// Satellites and their slots.
    pub satellites: fn(&Shell) -> Vec<Satellite>,
    /// The secular J2 theory.
    pub mean_j2: fn(&MeanElements) -> SecularOrbit,
    /// The other models that a study can propagate its design with.
    pub propagator: ModelPropagator,
    /// What SGP4 is run with, as the judge.
    pub sgp4: Sgp4Theory,
    /// The acceleration of a zonal field, km/s², as the judge integrates it.
    pub acceleration: Acceleration,
    /// What the mean motion slot of exported element sets holds.
    pub slot: MeanMotionSlot,
    /// Mean elements at another instant, s later: how element sets are carried to the epoch that they can
    /// write.
    pub carried: fn(&MeanElements, f64) -> MeanElements,
    /// An element set as a reader of a TLE finds it.
    pub written: fn(&::sgp4::Elements) -> Result<::sgp4::Elements, TleFieldError>,
    /// Argument of perigee at which the frozen eccentricity is cancelled in an element set, degrees.
    pub cancelling_perigee_deg: f64,
    /// Greenwich mean sidereal time some seconds after an epoch, radians.
    pub gmst_rad: fn(Epoch, f64) -> f64,
    /// East, north and up at a latitude and longitude, radians.
    pub local_frame: fn(Surface, f64, f64) -> LocalFrame,
    /// The clock states that are solved for, by those that are meant.
    pub clocks: fn(Clocks) -> Clocks,
    /// The metrics of an ephemeris.
    pub evaluate: fn(&Evaluator, &Ephemeris) -> Result<Metrics, EphemerisError>,
    /// Elevation and azimuth of a position, radians.
    pub look_angles: fn(&LocalFrame, Position<EarthFixed>) -> (f64, f64),
}

impl Default for Parts {
    fn default() -> Self {
        Self {
            satellites: Shell::satellites,
            mean_j2: SecularOrbit::j2,
            propagator: Model::propagator,
            sgp4: Sgp4Theory::STANDARD,
            acceleration: ZonalField::acceleration,
            slot: MeanMotionSlot::Kozai,
            carried: |elements, later_s| SecularOrbit::j2(elements).elements_at(later_s),
            written: tle::as_written,
            cancelling_perigee_deg: 270.0,
            gmst_rad: Epoch::gmst_rad,
            local_frame: LocalFrame::new,
            clocks: |meant| meant,
            evaluate: Evaluator::evaluate_ephemeris,
            look_angles: LocalFrame::look_angles,
        }
    }
}
