//! The least separation of the satellites of a design, under secular J2.

mod span;

pub use span::{Approach, SpanTooLarge};

use super::{Design, Shell, Slot};
use crate::orbit::MeanElements;
use crate::orbit::separation::{first_closest_s, mates_approach};
use rayon::prelude::*;
use std::cmp::Ordering;

/// Two shells, or one and the same, and how close their satellites come to each other.
#[derive(Debug, Clone, PartialEq)]
pub struct ShellSeparation {
    /// Their places in the design, the lower first.
    pub shells: [usize; 2],
    /// The least distance over all time, km.
    pub least_km: f64,
    /// The satellites that come so close; `None` where those of other rates do, sooner or later all of them.
    pub pair: Option<ClosestPair>,
}

/// Two satellites that keep their places with respect to each other, and come closest of all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosestPair {
    /// The satellites.
    pub slots: [Slot; 2],
    /// Geocentric latitude, north and south, at which both are then, degrees; `None` on ellipses.
    pub latitude_deg: Option<f64>,
    /// When they are for the first time, seconds after the epoch; `None` on ellipses.
    pub first_s: Option<f64>,
}

impl ShellSeparation {
    /// The separations of all shells of a design, each by itself and then each two.
    #[must_use]
    pub fn all_of(design: &Design) -> Vec<Self> {
        let count = design.shells().len();
        let alone = (0..count).map(|n| [n, n]);
        let pairs = (0..count).flat_map(|n| (n + 1..count).map(move |m| [n, m]));
        let of = |shells| Self::of(design, shells);
        alone.chain(pairs).filter_map(of).collect()
    }

    /// The separation within a shell, or of two; `None` for a shell of one satellite.
    fn of(design: &Design, shells: [usize; 2]) -> Option<Self> {
        let [one, other] = shells.map(|n| &design.shells()[n]);
        if !are_mates(one, other) {
            return Some(Self {
                shells,
                least_km: gap_km(one, other),
                pair: None,
            });
        }
        let pairs = candidates(one, (shells[0] != shells[1]).then_some(other));
        let least = pairs.into_par_iter().map(|slots| {
            let elements = [one.elements(slots[0]), other.elements(slots[1])];
            (mates_approach(&elements[0], &elements[1]), slots)
        });
        // The first of equal ones, whatever the order in which threads find them.
        let (approach, slots) = least.reduce_with(|a, b| {
            let by_distance = a.0.distance_km.total_cmp(&b.0.distance_km);
            match by_distance.then(a.1.cmp(&b.1)) {
                Ordering::Greater => b,
                _ => a,
            }
        })?;
        let elements = [one.elements(slots[0]), other.elements(slots[1])];
        let is_circular = approach.latitude_rad.is_some();
        let several = design.shells().len() > 1;
        let named = |n: usize| Slot {
            shell: several.then_some(shells[n]),
            ..slots[n]
        };
        Some(Self {
            shells,
            least_km: approach.distance_km,
            pair: Some(ClosestPair {
                slots: [named(0), named(1)],
                latitude_deg: approach.latitude_rad.map(f64::to_degrees),
                first_s: is_circular.then(|| first_closest_s(&elements[0], &elements[1])),
            }),
        })
    }
}

/// The least distance of any two satellites of a design over all time, km ([M-65](crate::models#m-65)); `None` for one
/// satellite.
#[must_use]
pub fn least_separation_km(design: &Design) -> Option<f64> {
    let all = ShellSeparation::all_of(design).into_iter();
    all.map(|one| one.least_km).reduce(f64::min)
}

/// Whether satellites of two shells keep their places with respect to each other: all their rates are the same, and
/// ellipses have one shape and one direction.
fn are_mates(one: &Shell, other: &Shell) -> bool {
    let orbit = |of: &Shell| MeanElements {
        raan_rad: 0.0,
        mean_anomaly_rad: 0.0,
        // Circular orbits have no perigee.
        arg_perigee_rad: if of.eccentricity() == 0.0 {
            0.0
        } else {
            of.arg_perigee_deg()
        },
        ..of.elements(Slot::FIRST)
    };
    orbit(one) == orbit(other)
}

/// The pairs of satellites among which the closest is.
///
/// Differences in node and phase between two satellites of a shell are those between the first one and another. Of two
/// shells, each satellite of one with the two of every plane of the other that are next in argument of latitude to where they would meet.
fn candidates(one: &Shell, other: Option<&Shell>) -> Vec<[Slot; 2]> {
    let Some(other) = other else {
        let rest = one.slots().skip(1);
        return rest.map(|slot| [Slot::FIRST, slot]).collect();
    };
    if one.eccentricity() > 0.0 {
        let both = one.slots().flat_map(|a| other.slots().map(move |b| [a, b]));
        return both.collect();
    }
    let mut pairs = Vec::new();
    for a in one.slots() {
        for plane in 0..other.planes() {
            pairs.extend(next_to(one, a, other, plane).map(|b| [a, b]));
        }
    }
    pairs
}

/// The satellites of a plane that are next, before and behind, to the one that would meet a satellite of another.
fn next_to(one: &Shell, slot: Slot, other: &Shell, plane: usize) -> [Slot; 2] {
    let elements = one.elements(slot);
    let first = other.elements(Slot::new(plane, 0));
    let cos_i = elements.inclination_rad.cos();
    let (sin_half, cos_half) = (0.5 * (first.raan_rad - elements.raan_rad)).sin_cos();
    let ahead = first.mean_argument_of_latitude_rad() - elements.mean_argument_of_latitude_rad()
        + 2.0 * (sin_half * cos_i).atan2(cos_half);
    let count = other.satellites_per_plane();
    let place = -ahead / std::f64::consts::TAU * count as f64;
    [place.floor(), place.ceil()].map(|n| Slot::new(plane, n.rem_euclid(count as f64) as usize))
}

/// The gap between the distances of two shells from the centre of the Earth, km: what satellites of other rates leave
/// between them sooner or later.
fn gap_km(one: &Shell, other: &Shell) -> f64 {
    let radii = |of: &Shell| {
        let elements = of.elements(Slot::FIRST);
        let (a, e) = (elements.semi_major_axis_km, elements.eccentricity);
        [a * (1.0 - e), a * (1.0 + e)]
    };
    let ([low, high], [other_low, other_high]) = (radii(one), radii(other));
    (other_low - high).max(low - other_high).max(0.0)
}

#[cfg(test)]
mod tests;
