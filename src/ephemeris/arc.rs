//! Interpolation between the samples of a file, by the method that the file gives.
//!
//! An arc is a run of samples that may be interpolated: a segment of a message, or the samples between two gaps.
//! Nothing is interpolated across its ends, and nothing is extrapolated.

use crate::ephemeris::derivative::GAP;
use crate::ephemeris::hermite::hermite_state;
use crate::frames::{Frame, Position, State};
use crate::time::Epoch;
use nalgebra::Vector3;

/// Tolerance within which a sample is taken to be at an instant, s: 7 mm along a low orbit, and coarser than
/// the 10 ns of SP3 and the microseconds of some programs.
pub const SAME_INSTANT_S: f64 = 1e-6;

/// Largest difference, km, in each coordinate of a position that two open arcs give at an instant they share, if they
/// continue each other: both are rounded to the six decimals of SP3, the one format whose arcs are open.
const SAME_POSITION_KM: f64 = 1.001e-6;

/// Maximum number of nodes of a polynomial: with more equidistant nodes, rounding costs more than they gain.
const MOST_NODES: usize = 24;

/// Number of points at which the error of an arc is estimated.
const PLACES: usize = 200;

/// The polynomial between samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// Through positions alone, of this degree.
    Lagrange(usize),
    /// Through positions and velocities, of this degree: (degree + 1) / 2 samples.
    Hermite(usize),
}

impl Interpolation {
    /// The default for a file with velocities: four samples.
    pub const OF_STATES: Self = Self::Hermite(7);

    /// Number of samples that the polynomial passes through.
    #[must_use]
    pub fn nodes(self) -> usize {
        let nodes = match self {
            Self::Lagrange(degree) => degree + 1,
            Self::Hermite(degree) => degree.div_ceil(2),
        };
        nodes.clamp(2, MOST_NODES)
    }

    /// Its name and its degree, as `Hermite, degree 7`.
    #[must_use]
    pub fn describe(self) -> String {
        match self {
            Self::Lagrange(1) => "linear".to_owned(),
            Self::Lagrange(degree) => format!("Lagrange, degree {degree}"),
            Self::Hermite(degree) => format!("Hermite, degree {degree}"),
        }
    }

    /// Order of convergence: the power of the spacing in its error.
    #[must_use]
    pub fn order(self) -> u32 {
        match self {
            Self::Lagrange(_) => self.nodes() as u32,
            Self::Hermite(_) => 2 * self.nodes() as u32,
        }
    }

    fn state(self, nodes: &[(f64, State<Frame>)], at_s: f64) -> State<Frame> {
        match self {
            Self::Lagrange(_) => {
                let (position_km, velocity_km_s) = lagrange(nodes, at_s);
                State::new(position_km, velocity_km_s)
            }
            Self::Hermite(_) => hermite_state(nodes, at_s),
        }
    }
}

/// Samples that may be interpolated.
#[derive(Debug, Clone, PartialEq)]
pub struct Arc {
    /// Frame of the states, and of the interpolation.
    pub frame: Frame,
    /// The interpolation between them.
    pub interpolation: Interpolation,
    /// The first and last valid instants of the arc, both included; samples outside only support the
    /// interpolation.
    pub useable: (Epoch, Epoch),
    /// Whether an arc that begins at its last sample, or one sample interval later, continues this one, as in daily SP3
    /// files.
    pub is_open: bool,
    /// The samples in time order, without repeated instants.
    pub nodes: Vec<(Epoch, State<Frame>)>,
}

impl Arc {
    /// An arc valid from its first sample to its last; `None` without samples.
    #[must_use]
    pub fn new(
        frame: Frame,
        interpolation: Interpolation,
        nodes: Vec<(Epoch, State<Frame>)>,
    ) -> Option<Self> {
        let useable = (nodes.first()?.0, nodes.last()?.0);
        Some(Self {
            frame,
            interpolation,
            useable,
            is_open: false,
            nodes,
        })
    }

    /// An arc whose samples are not kept: it only tells when it is valid.
    #[must_use]
    pub fn without_states(
        frame: Frame,
        interpolation: Interpolation,
        useable: (Epoch, Epoch),
    ) -> Self {
        Self {
            frame,
            interpolation,
            useable,
            is_open: false,
            nodes: Vec::new(),
        }
    }

    /// The part within an interval, with its nodes; `None` if there is none.
    #[must_use]
    pub fn within(mut self, (first, last): (Epoch, Epoch)) -> Option<Self> {
        self.useable = (self.useable.0.max(first), self.useable.1.min(last));
        (self.useable.0 <= self.useable.1).then_some(self)
    }

    /// Whether two arcs have more than an instant in common.
    #[must_use]
    pub fn overlaps(&self, other: &Self) -> bool {
        let is_before = |one: Epoch, other: Epoch| other.seconds_since(one) > SAME_INSTANT_S;
        is_before(self.useable.0, other.useable.1) && is_before(other.useable.0, self.useable.1)
    }

    /// Appends the samples of an arc that continues this one, or returns that arc. At an instant that both have, the
    /// sample of this one is kept.
    ///
    /// # Errors
    /// The other arc, if it does not follow at the spacing of this one, or has another position at the instant that
    /// they share.
    pub fn continued_by(&mut self, next: Self) -> Result<(), Self> {
        let shared = match self.seam_km(&next) {
            Some(apart_km) if apart_km.amax() <= SAME_POSITION_KM => 1,
            None if self.is_followed_by(&next) => 0,
            _ => return Err(next),
        };
        self.nodes.extend(next.nodes.into_iter().skip(shared));
        self.useable.1 = next.useable.1;
        Ok(())
    }

    /// Position of an arc minus that of this one at the instant where this one ends and the other begins, km. `None` if
    /// there is no such instant, or one of them cannot be continued by the other.
    #[must_use]
    pub fn seam_km(&self, next: &Self) -> Option<Vector3<f64>> {
        let ((end, last), (start, first)) = (self.nodes.last()?, next.nodes.first()?);
        let is_shared = start.seconds_since(*end).abs() <= SAME_INSTANT_S;
        (is_shared && self.is_like(next)).then(|| first.position_km - last.position_km)
    }

    /// Whether an arc begins one sample interval after this one.
    fn is_followed_by(&self, next: &Self) -> bool {
        let ([.., (before, _), (end, _)], Some((start, _))) =
            (self.nodes.as_slice(), next.nodes.first())
        else {
            return false;
        };
        let between_s = start.seconds_since(*end);
        let most_s = GAP * end.seconds_since(*before);
        self.is_like(next) && between_s > SAME_INSTANT_S && between_s < most_s
    }

    /// Whether both are open, and interpolate alike.
    fn is_like(&self, next: &Self) -> bool {
        let alike = (self.frame, self.interpolation) == (next.frame, next.interpolation);
        alike && self.is_open && next.is_open
    }

    /// Whether the arc is valid at an instant.
    #[must_use]
    pub fn covers(&self, at: Epoch) -> bool {
        let (first, last) = self.useable;
        at.seconds_since(first) >= -SAME_INSTANT_S && last.seconds_since(at) >= -SAME_INSTANT_S
    }

    /// The samples within the valid span.
    pub fn samples(&self) -> impl Iterator<Item = &(Epoch, State<Frame>)> {
        self.nodes.iter().filter(|(at, _)| self.covers(*at))
    }

    /// The state at an instant, and whether it is interpolated; `None` outside the span.
    #[must_use]
    pub fn state(&self, at: Epoch) -> Option<(State<Frame>, bool)> {
        if !self.covers(at) {
            return None;
        }
        let since = |node: &(Epoch, State<Frame>)| node.0.seconds_since(at);
        let next = self
            .nodes
            .partition_point(|node| since(node) < -SAME_INSTANT_S);
        let node = self.nodes.get(next)?;
        if since(node) <= SAME_INSTANT_S {
            return Some((node.1, false));
        }
        if next == 0 || !self.carries_interpolation() {
            return None;
        }
        let table: Vec<_> = window(&self.nodes, next, self.interpolation.nodes())
            .iter()
            .map(|node| (since(node), node.1))
            .collect();
        Some((self.interpolation.state(&table, 0.0), true))
    }

    /// Whether the state at an instant is interpolated; `None` outside the span.
    #[must_use]
    pub fn is_interpolated(&self, at: Epoch) -> Option<bool> {
        let since = |node: &(Epoch, State<Frame>)| node.0.seconds_since(at);
        let next = self
            .nodes
            .partition_point(|node| since(node) < -SAME_INSTANT_S);
        let node = self.nodes.get(next).filter(|_| self.covers(at))?;
        let interpolated = since(node) > SAME_INSTANT_S;
        let holds = !interpolated || (next > 0 && self.carries_interpolation());
        holds.then_some(interpolated)
    }

    /// Whether there are enough nodes for the polynomial. Between gaps, if the file gives no method, all are needed.
    fn carries_interpolation(&self) -> bool {
        !self.is_open || self.nodes.len() >= self.interpolation.nodes()
    }

    /// Largest distance, km, between every other sample and the interpolation through the rest: the error at twice
    /// the spacing, and so an upper estimate of the actual error. `None` if there are too few samples.
    #[must_use]
    pub fn left_out_error_km(&self) -> Option<f64> {
        let count = self.interpolation.nodes();
        let kept = self.nodes.len().div_ceil(2);
        if kept < count {
            return None;
        }
        // Those between two that are kept.
        let dropped = kept - 1;
        let stride = dropped.div_ceil(PLACES).max(1);
        (0..dropped)
            .step_by(stride)
            .map(|place| {
                let (at, state) = &self.nodes[2 * place + 1];
                let first = window_start(kept, place + 1, count);
                let table: Vec<_> = (first..first + count)
                    .map(|k| &self.nodes[2 * k])
                    .map(|(t, state)| (t.seconds_since(*at), *state))
                    .collect();
                let found = self.interpolation.state(&table, 0.0);
                (found.position_km - state.position_km).norm()
            })
            .reduce(f64::max)
    }
}

/// The `count` nodes around the interval before `next`, the same number on each side, shifted at the ends.
fn window<T>(nodes: &[T], next: usize, count: usize) -> &[T] {
    let count = count.min(nodes.len());
    let first = window_start(nodes.len(), next, count);
    &nodes[first..first + count]
}

/// The first of the `count` nodes around the interval before `next`, of `len` at least as many.
fn window_start(len: usize, next: usize, count: usize) -> usize {
    next.saturating_sub(count.div_ceil(2)).min(len - count)
}

/// Value and time derivative of the Lagrange polynomial through the positions.
pub(crate) fn lagrange<F>(nodes: &[(f64, State<F>)], t: f64) -> (Vector3<f64>, Vector3<f64>) {
    let (mut value, mut slope) = (Vector3::zeros(), Vector3::zeros());
    for (j, (tj, state)) in nodes.iter().enumerate() {
        // The product of the factors and its derivative, factor by factor.
        let (mut weight, mut change) = (1.0, 0.0);
        for (m, (tm, _)) in nodes.iter().enumerate() {
            if m != j {
                let scale = 1.0 / (tj - tm);
                change = change * (t - tm) * scale + weight * scale;
                weight *= (t - tm) * scale;
            }
        }
        value += state.position_km.km() * weight;
        slope += state.position_km.km() * change;
    }
    (value, slope)
}

/// A state without a velocity in the file.
pub(crate) fn still<F>(position_km: Vector3<f64>) -> State<F> {
    State {
        position_km: Position::new(position_km),
        velocity_km_s: Vector3::zeros(),
    }
}

#[cfg(test)]
mod tests;
