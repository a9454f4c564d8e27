//! The positions of a satellite while they are read: what is checked of all of them, and those that are kept.

use super::Sp3Sample;
use crate::ephemeris::derivative::velocity_fault;
use crate::formats::kept_states::{KeptStates, StateKeeper};
use crate::time::Epoch;
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// Number of positions, the first ones, whose velocities are compared with their derivative.
const PROBED: usize = 512;

/// Maximum number of instants kept of the positions that are as far from their neighbours: more than are ever shown.
const MOST_INSTANTS: usize = 100;

/// The positions of a satellite so far.
#[derive(Default)]
pub(super) struct SatelliteTrack {
    keeper: Option<StateKeeper<Epoch>>,
    /// The last position, whose velocity may follow, and the time since the one before it, s.
    last: Option<(Sp3Sample, f64)>,
    /// The first and the last instant with a position.
    span: Option<(Epoch, Epoch)>,
    count: usize,
    /// Positions without velocity by the bits of the time to their nearest neighbour, s.
    apart: BTreeMap<u64, PositionsApart>,
    probe: Vec<Sp3Sample>,
    kept: Vec<Sp3Sample>,
}

/// Positions at one distance in time from their nearest neighbour.
#[derive(Default)]
struct PositionsApart {
    count: usize,
    /// Instants of the first ones.
    first: Vec<Epoch>,
}

impl SatelliteTrack {
    /// Adds a position; `choice` says once which are kept. False if it is not after the one before.
    pub(super) fn add(
        &mut self,
        sample: Sp3Sample,
        choice: impl FnOnce() -> KeptStates<Epoch>,
    ) -> bool {
        let since_s = match &self.last {
            Some((last, _)) if last.at >= sample.at => return false,
            Some((last, _)) => sample.at.seconds_since(last.at),
            None => f64::INFINITY,
        };
        self.keeper
            .get_or_insert_with(|| StateKeeper::new(choice()));
        self.settle(since_s);
        let first = self.span.map_or(sample.at, |(first, _)| first);
        self.span = Some((first, sample.at));
        self.count += 1;
        self.last = Some((sample, since_s));
        true
    }

    /// Gives the position at an instant its velocity. False if there is no such position.
    pub(super) fn set_velocity(&mut self, at: Epoch, velocity_km_s: Option<Vector3<f64>>) -> bool {
        match &mut self.last {
            Some((last, _)) if last.at == at => {
                last.velocity_km_s = velocity_km_s;
                true
            }
            _ => false,
        }
    }

    /// Puts the last position with the others, once the time until the next one is known.
    fn settle(&mut self, until_s: f64) {
        let Some((sample, since_s)) = self.last.take() else {
            return;
        };
        if sample.velocity_km_s.is_none() {
            let nearest_s = since_s.min(until_s);
            let apart = self.apart.entry(nearest_s.to_bits()).or_default();
            apart.count += 1;
            if apart.first.len() < MOST_INSTANTS {
                apart.first.push(sample.at);
            }
        }
        if self.probe.len() < PROBED {
            self.probe.push(sample);
        }
        if let Some(keeper) = &mut self.keeper {
            keeper.push(&mut self.kept, sample.at, sample);
        }
    }

    /// Ends the track after its last position.
    pub(super) fn end(&mut self) {
        self.settle(f64::INFINITY);
    }

    /// Number of positions.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// The first and the last instant with a position.
    pub(super) fn span(&self) -> Option<(Epoch, Epoch)> {
        self.span
    }

    /// How the velocities differ from the derivative of the positions, if all have one and they do.
    pub(super) fn velocity_fault(&self) -> Option<String> {
        let sample = |place: usize| {
            let sample = &self.probe[place];
            let velocity_km_s = sample.velocity_km_s.unwrap_or_default();
            (sample.at, sample.position_km, velocity_km_s)
        };
        match self.apart.is_empty() {
            true => velocity_fault(self.probe.len(), sample),
            false => None,
        }
    }

    /// The positions without velocity that are farther than `most_s` from both neighbours: their number, and the first
    /// instants in order.
    pub(super) fn lone(&self, most_s: f64) -> (usize, Vec<Epoch>) {
        let is_lone = |bits: &u64| {
            let nearest_s = f64::from_bits(*bits);
            nearest_s > most_s || nearest_s.is_infinite()
        };
        let lone = self.apart.iter().filter(|(bits, _)| is_lone(bits));
        let (mut count, mut instants) = (0, Vec::new());
        for (_, apart) in lone {
            count += apart.count;
            instants.extend_from_slice(&apart.first);
        }
        instants.sort();
        (count, instants)
    }

    /// The positions that are kept.
    pub(super) fn into_kept(self) -> Vec<Sp3Sample> {
        self.kept
    }
}
