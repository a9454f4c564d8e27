//! Propagators for conventions beyond other elements: mislabelled states, another pole, integration.

use super::{OtherPropagator, propagate_each};
use crate::frames::{
    Eme2000, Frame, FromTeme, Position, State, Teme, from_teme, teme_to_eme2000, to_teme,
};
use crate::orbit::j2::SecularOrbit;
use crate::orbit::{MeanElements, PropagationError, Propagator};
use crate::time::Epoch;
use crate::units::wrap_two_pi;
use crate::validate::Subject;
use crate::validate::numerical::integrator::ZonalField;

/// A propagation whose states are labelled with another clock or frame.
struct Mislabelled<P> {
    propagation: P,
    epoch: Epoch,
    late_s: f64,
    /// The frame of the states, which are taken as TEME.
    frame: Frame,
    /// Whether it is the other way round: TEME states taken as that frame.
    inverse: bool,
}

impl<P: Propagator> Propagator for Mislabelled<P> {
    fn state_at(&self, elapsed_s: f64) -> Result<State<Teme>, PropagationError> {
        let state = self.propagation.state_at(elapsed_s + self.late_s)?;
        Ok(if self.inverse {
            to_teme(taken_for(state), self.frame, self.epoch, elapsed_s)
        } else {
            taken_for(from_teme(state, self.frame, self.epoch, elapsed_s))
        })
    }
}

/// The components of a state taken as those of another frame: the mistake itself.
fn taken_for<F, G>(state: State<F>) -> State<G> {
    State {
        position_km: Position::new(state.position_km.km()),
        velocity_km_s: state.velocity_km_s,
    }
}

pub(super) fn mislabelled(
    subject: &Subject<'_>,
    late_s: f64,
    frame: Frame,
    inverse: bool,
) -> Vec<(String, OtherPropagator)> {
    let epoch = subject.epoch();
    propagate_each(&subject.nominal_satellites(), |elements| {
        Some(Mislabelled {
            propagation: SecularOrbit::j2(elements),
            epoch,
            late_s,
            frame,
            inverse,
        })
    })
}

/// Leap seconds between GPS time and UTC.
pub(super) fn gps_minus_utc_s(subject: &Subject<'_>) -> f64 {
    subject.epoch().leap_seconds() - 19.0
}

/// Secular J2 about the pole of J2000: the same orbit at the epoch, with its elements referred to
/// the equator of J2000, along which the node regresses.
struct AboutJ2000 {
    orbit: SecularOrbit,
    from_teme: FromTeme<Eme2000>,
}

impl Propagator for AboutJ2000 {
    fn state_at(&self, elapsed_s: f64) -> Result<State<Teme>, PropagationError> {
        let state = self.orbit.state(elapsed_s);
        Ok(self.from_teme.undo(taken_for(state)))
    }
}

pub(super) fn about_j2000(subject: &Subject<'_>) -> Vec<(String, OtherPropagator)> {
    let to_j2000 = teme_to_eme2000(subject.epoch());
    propagate_each(&subject.nominal_satellites(), |elements| {
        let plane = crate::frames::OrbitPlane::new(elements.raan_rad, elements.inclination_rad);
        let normal = to_j2000 * plane.node.cross(&plane.ahead);
        let node = to_j2000 * plane.node;
        let inclination_rad = normal.z.clamp(-1.0, 1.0).acos();
        let raan_rad = normal.x.atan2(-normal.y);
        let turned = crate::frames::OrbitPlane::new(raan_rad, inclination_rad);
        // The angle from the new node to the old one, within the plane.
        let moved = node.dot(&turned.ahead).atan2(node.dot(&turned.node));
        let elements = MeanElements {
            inclination_rad,
            raan_rad: wrap_two_pi(raan_rad),
            arg_perigee_rad: wrap_two_pi(elements.arg_perigee_rad + moved),
            ..*elements
        };
        Some(AboutJ2000 {
            orbit: SecularOrbit::j2(&elements),
            from_teme: FromTeme::to(Eme2000, subject.epoch(), 0.0),
        })
    })
}

/// The elements taken as osculating at the epoch, and J2 integrated.
struct Integrated {
    /// One state every [`INTEGRATED_STEP_S`].
    states: Vec<State<Teme>>,
    step_s: f64,
}

impl Propagator for Integrated {
    fn state_at(&self, elapsed_s: f64) -> Result<State<Teme>, PropagationError> {
        let last = self.states.len().saturating_sub(1);
        let before = ((elapsed_s / self.step_s).floor().max(0.0) as usize).min(last);
        let start = before
            .saturating_sub(3)
            .min(self.states.len().saturating_sub(8));
        let table: Vec<(f64, State<Teme>)> = (start..self.states.len().min(start + 8))
            .map(|k| (k as f64 * self.step_s, self.states[k]))
            .collect();
        let position_km = crate::ephemeris::hermite::hermite_position(&table, elapsed_s);
        Ok(State {
            position_km,
            ..self.states[before]
        })
    }
}

pub(super) fn taken_as_osculating(subject: &Subject<'_>) -> Vec<(String, OtherPropagator)> {
    let step_s = 60.0;
    let grid = subject.grid();
    let count = (grid.elapsed_s(grid.len() - 1) / step_s).ceil() as usize + 2;
    let times: Vec<f64> = (0..count).map(|k| k as f64 * step_s).collect();
    propagate_each(&subject.nominal_satellites(), |elements| {
        let start = SecularOrbit::two_body(elements).state(0.0);
        let states = ZonalField::J2
            .integrate(ZonalField::acceleration, &start, &times)
            .ok()?;
        Some(Integrated { states, step_s })
    })
}
