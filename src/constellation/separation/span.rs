//! The closest approach of two shells within a span of time.

use crate::constellation::{Design, Shell, Slot};
use crate::frames::{State, Teme};
use crate::orbit::j2::SecularOrbit;
use crate::orbit::separation::passing;
use rayon::prelude::*;
use thiserror::Error;

/// The closest approach of satellites within a span.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Approach {
    /// The satellites.
    pub slots: [Slot; 2],
    /// Seconds after the epoch.
    pub elapsed_s: f64,
    /// Distance, km.
    pub distance_km: f64,
}

/// Too many pairs and instants.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error(
    "{pairs} pairs of satellites over {duration_h} h are more than the {limit:.0e} distances that are computed; give a span of at most {most_h:.2} h"
)]
pub struct SpanTooLarge {
    pairs: f64,
    duration_h: f64,
    limit: f64,
    most_h: f64,
}

/// Between instants satellites are taken to move straight on, s.
const STEP_S: f64 = 20.0;

/// Within half a step two satellites leave their straight lines by at most this, km: half the largest relative
/// acceleration, twice the 9.8 m/s² at the ground, times the square of 10 s.
const BEND_KM: f64 = 0.99;

/// Distances that are computed at most.
const MOST_DISTANCES: f64 = 2e10;

impl Approach {
    /// The closest approach of a satellite of one shell to one of another within a span from the epoch.
    ///
    /// # Errors
    /// If there are too many satellites for the span.
    pub fn between(
        design: &Design,
        [one, other]: [usize; 2],
        duration_s: f64,
    ) -> Result<Option<Self>, SpanTooLarge> {
        let orbits = [one, other].map(|n| orbits(&design.shells()[n]));
        let count = (duration_s / STEP_S).ceil().max(1.0);
        let pairs = orbits[0].len() as f64 * orbits[1].len() as f64;
        if pairs * count > MOST_DISTANCES {
            return Err(SpanTooLarge {
                pairs,
                duration_h: duration_s / 3600.0,
                limit: MOST_DISTANCES,
                most_h: MOST_DISTANCES / pairs * STEP_S / 3600.0,
            });
        }
        let windows = (0..count as usize).map(|n| {
            let from_s = n as f64 * STEP_S;
            [from_s, (from_s + STEP_S).min(duration_s)]
        });
        let windows: Vec<[f64; 2]> = windows.collect();
        let bound = windows.par_iter().map(|window| {
            let mut least = f64::INFINITY;
            straight(&orbits, *window, |_, distance_km| {
                least = least.min(distance_km)
            });
            least
        });
        let bound = bound.reduce(|| f64::INFINITY, f64::min) + 2.0 * BEND_KM;
        let close = windows.par_iter().map(|window| {
            let mut found: Option<Self> = None;
            straight(&orbits, *window, |[n, m], distance_km| {
                if distance_km <= bound {
                    let (distance_km, elapsed_s) =
                        passing(&orbits[0][n].1, &orbits[1][m].1, *window);
                    let [mut a, mut b] = [orbits[0][n].0, orbits[1][m].0];
                    (a.shell, b.shell) = (Some(one), Some(other));
                    let approach = Self {
                        slots: [a, b],
                        elapsed_s,
                        distance_km,
                    };
                    found = Some(found.map_or(approach, |found| found.closer(approach)));
                }
            });
            found
        });
        let found: Vec<Self> = close.flatten().collect();
        Ok(found.into_iter().reduce(Self::closer))
    }

    /// The closer, or else the earlier of two.
    fn closer(self, other: Self) -> Self {
        let order = self.distance_km.total_cmp(&other.distance_km);
        let order = order.then(self.elapsed_s.total_cmp(&other.elapsed_s));
        if order.then(self.slots.cmp(&other.slots)).is_le() {
            self
        } else {
            other
        }
    }
}

fn orbits(shell: &Shell) -> Vec<(Slot, SecularOrbit)> {
    let satellites = shell.satellites().into_iter();
    let orbit = satellites.map(|one| (one.slot, SecularOrbit::j2(&one.elements)));
    orbit.collect()
}

/// The least distances of all pairs in a window, as if they moved straight on from its middle.
fn straight(
    orbits: &[Vec<(Slot, SecularOrbit)>; 2],
    [from_s, to_s]: [f64; 2],
    mut take: impl FnMut([usize; 2], f64),
) {
    let (middle_s, half_s) = (0.5 * (from_s + to_s), 0.5 * (to_s - from_s));
    let states = |of: &Vec<(Slot, SecularOrbit)>| -> Vec<State<Teme>> {
        of.iter().map(|(_, orbit)| orbit.state(middle_s)).collect()
    };
    let [ones, others] = [0, 1].map(|n: usize| states(&orbits[n]));
    for (n, one) in ones.iter().enumerate() {
        for (m, other) in others.iter().enumerate() {
            let apart = other.position_km.km() - one.position_km.km();
            let rate = other.velocity_km_s - one.velocity_km_s;
            let speed2 = rate.norm_squared().max(f64::MIN_POSITIVE);
            let at_s = (-apart.dot(&rate) / speed2).clamp(-half_s, half_s);
            take([n, m], (apart + rate * at_s).norm());
        }
    }
}
