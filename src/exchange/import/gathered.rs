//! Satellites gathered from messages and files, in time that grows with their number.

use super::Fleet;
use super::objects::{identity, join, overlap};
use crate::constellation::identity::KnownObjects;
use crate::formats::trajectory::Trajectory;

/// The satellites so far, in a part for each kind; those with states are indexed by identity.
#[derive(Debug, Default)]
pub(super) struct GatheredFleet {
    parts: Vec<Fleet>,
    /// The identities of the part with states, in its order.
    known: KnownObjects,
}

impl From<Fleet> for GatheredFleet {
    fn from(first: Fleet) -> Self {
        let parts = match first {
            Fleet::Mixed(parts) => parts,
            other => vec![other],
        };
        let mut known = KnownObjects::default();
        for part in &parts {
            if let Fleet::Sampled(trajectories) = part {
                trajectories.iter().for_each(|one| known.add(identity(one)));
            }
        }
        Self { parts, known }
    }
}

impl GatheredFleet {
    /// Adds satellites. Sampled states of a known satellite continue its states if their spans do not overlap.
    pub(super) fn add(&mut self, more: Fleet) {
        match more {
            Fleet::Mixed(parts) => parts.into_iter().for_each(|part| self.add(part)),
            Fleet::Sampled(trajectories) => {
                let place = self.place(Fleet::Sampled(Vec::new()));
                if let Fleet::Sampled(states) = &mut self.parts[place] {
                    for next in trajectories {
                        unite(states, &mut self.known, next);
                    }
                }
            }
            Fleet::Sets(more) => {
                let place = self.place(Fleet::Sets(Vec::new()));
                if let Fleet::Sets(sets) = &mut self.parts[place] {
                    sets.extend(more);
                }
            }
            Fleet::Elements(more) => {
                let place = self.place(Fleet::Elements(Vec::new()));
                if let Fleet::Elements(rows) = &mut self.parts[place] {
                    rows.extend(more);
                }
            }
            Fleet::Almanacs(more) => {
                let place = self.place(Fleet::Almanacs(Vec::new()));
                if let Fleet::Almanacs(almanacs) = &mut self.parts[place] {
                    almanacs.extend(more);
                }
            }
        }
    }

    /// The place of the part of the same kind as `none`, which becomes that part if there is no such part.
    fn place(&mut self, none: Fleet) -> usize {
        let kind = std::mem::discriminant(&none);
        let is_same = |part: &Fleet| std::mem::discriminant(part) == kind;
        let found = self.parts.iter().position(is_same);
        found.unwrap_or_else(|| {
            self.parts.push(none);
            self.parts.len() - 1
        })
    }

    /// The satellites of each kind.
    pub(super) fn parts(&self) -> &[Fleet] {
        &self.parts
    }

    /// The fleet; one of a single kind as such.
    pub(super) fn finish(mut self) -> Fleet {
        match self.parts.len() {
            0 => Fleet::Sets(Vec::new()),
            1 => self.parts.remove(0),
            _ => Fleet::Mixed(self.parts),
        }
    }
}

/// Adds states: to those of the same satellite if the spans do not overlap, otherwise as a separate satellite.
fn unite(states: &mut Vec<Trajectory>, known: &mut KnownObjects, next: Trajectory) {
    let of_next = identity(&next);
    let continued = known.same(&of_next).into_iter().find(|place| {
        !known.identity(*place).is_named_otherwise(&of_next) && !overlap(&states[*place], &next)
    });
    match continued {
        Some(place) => join(&mut states[place], next),
        None => {
            known.add(of_next);
            states.push(next);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{Frame, State};
    use crate::time::Epoch;
    use nalgebra::Vector3;
    use proptest::prelude::*;

    /// Two states from an hour on, by which the satellite of `label` is told in the place of its arc.
    fn part((name, id, hour): (&str, &str, usize), label: usize) -> Trajectory {
        let start = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let state = |minute: usize| {
            let at = start.plus_seconds(3600.0 * hour as f64 + 60.0 * minute as f64);
            let x_km = 7000.0 + label as f64;
            (at, State::new(Vector3::x() * x_km, Vector3::y()))
        };
        Trajectory::of_states(name, id, Frame::Teme, vec![state(0), state(1)])
    }

    /// The satellites by comparing each part with every one before.
    fn by_comparison(parts: Vec<Trajectory>) -> Vec<Trajectory> {
        let mut known: Vec<Trajectory> = Vec::new();
        for next in parts {
            let of_next = identity(&next);
            let continued = known.iter_mut().find(|before| {
                let of_before = identity(before);
                of_before.is_same(&of_next)
                    && !of_before.is_named_otherwise(&of_next)
                    && !overlap(before, &next)
            });
            match continued {
                Some(before) => join(before, next),
                None => known.push(next),
            }
        }
        known
    }

    proptest! {
        /// The index finds what a comparison with all satellites before finds, also through another spelling and for
        /// spans that overlap.
        #[test]
        fn satellites_are_found_as_by_comparing_with_each(
            parts in prop::collection::vec(
                (
                    prop::sample::select(vec!["A", "a", "B", "UNKNOWN"]),
                    prop::sample::select(vec!["A", "B", "2025-001A", "2025-001a", "2025-001B", "UNKNOWN"]),
                    0_usize..4,
                ),
                1..20,
            ),
        ) {
            let parts: Vec<Trajectory> = parts.into_iter().zip(0..).map(|(part_of, n)| part(part_of, n)).collect();
            let mut one_by_one = GatheredFleet::default();
            for next in parts.clone() {
                one_by_one.add(Fleet::Sampled(vec![next]));
            }
            let expected = Fleet::Sampled(by_comparison(parts.clone()));
            prop_assert_eq!(one_by_one.finish(), expected.clone());
            let mut later = Fleet::Sampled(by_comparison(parts[..1].to_vec()));
            later.append(Fleet::Sampled(parts[1..].to_vec()));
            prop_assert_eq!(later, expected);
        }
    }
}
