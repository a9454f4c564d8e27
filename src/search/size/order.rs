//! The order in which the samples of a design are evaluated: those first in which the designs before it failed.

use crate::evaluate::SampleTiles;
use serde::{Deserialize, Serialize};

/// What the share of bad samples of a tile is pulled towards, in visits: the mean share of all.
const PRIOR_VISITS: f64 = 4.0;

/// Tiles that are sorted by instant at first, so that the satellites are propagated once for several of them; each
/// next stage is as long as all before it.
const FIRST_STAGE: usize = 32;

/// The bad samples of each tile at each instant, among the designs so far. Older designs count less.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Hardness {
    tiles: usize,
    visits: Vec<u32>,
    bad: Vec<u32>,
}

/// A tile that a design has bad samples in: its place in the order, and their number.
pub(super) type BadTile = (u32, u16);

/// An order of all tiles at all instants.
pub(super) struct SampleOrder {
    /// Instants, each with the end of its tiles.
    instants: Vec<(usize, usize)>,
    /// Tiles of the instants, one after the other.
    tiles: Vec<u32>,
    /// Instant times tiles plus tile, in the same places.
    units: Vec<u32>,
}

impl SampleOrder {
    /// Instants with some of their tiles, in the order of the evaluation.
    pub(super) fn instants(&self) -> impl Iterator<Item = (usize, &[u32])> {
        let mut start = 0;
        self.instants.iter().map(move |&(instant, end)| {
            let tiles = &self.tiles[start..end];
            start = end;
            (instant, tiles)
        })
    }

    /// Tiles at all instants.
    pub(super) fn len(&self) -> usize {
        self.units.len()
    }
}

impl Hardness {
    /// Nothing is known.
    pub(super) fn new(shape: &SampleTiles) -> Self {
        let units = shape.tiles * shape.instants;
        Self {
            tiles: shape.tiles,
            visits: vec![0; units],
            bad: vec![0; units],
        }
    }

    pub(super) fn suits(&self, shape: &SampleTiles) -> bool {
        let units = shape.tiles * shape.instants;
        (self.tiles, self.visits.len(), self.bad.len()) == (shape.tiles, units, units)
    }

    /// The tiles with the largest share of bad samples first.
    pub(super) fn order(&self) -> SampleOrder {
        let sum = |of: &[u32]| of.iter().map(|n| u64::from(*n)).sum::<u64>() as f64;
        let (visits, bad) = (sum(&self.visits), sum(&self.bad));
        let prior = PRIOR_VISITS * if visits > 0.0 { bad / visits } else { 0.0 };
        let score = |unit: u32| {
            let n = unit as usize;
            (f64::from(self.bad[n]) + prior) / (f64::from(self.visits[n]) + PRIOR_VISITS)
        };
        let mut units = self.spread();
        // Stable: what is equal stays spread over the span.
        units.sort_by(|a, b| score(*b).total_cmp(&score(*a)));
        let mut start = 0;
        while start < units.len() {
            let end = units.len().min((2 * start).max(FIRST_STAGE));
            units[start..end].sort_unstable();
            start = end;
        }
        self.ordered(units)
    }

    /// All tiles, at instants far from each other: every next one is about 0.618 of the span later.
    fn spread(&self) -> Vec<u32> {
        let tiles = self.tiles.max(1);
        let instants = self.visits.len() / tiles;
        let mut stride = ((instants as f64) * 0.618_034).round().max(1.0) as usize;
        while gcd(stride, instants) > 1 {
            stride += 1;
        }
        let unit = |n: usize| {
            let instant = (n / tiles * stride) % instants;
            (instant * tiles + n % tiles) as u32
        };
        (0..self.visits.len()).map(unit).collect()
    }

    fn ordered(&self, units: Vec<u32>) -> SampleOrder {
        let mut order = SampleOrder {
            instants: Vec::new(),
            tiles: Vec::with_capacity(units.len()),
            units,
        };
        for &unit in &order.units {
            let (instant, tile) = (unit as usize / self.tiles, unit as usize % self.tiles);
            order.tiles.push(tile as u32);
            let end = order.tiles.len();
            // A tile after a larger one of the same instant is of another stage.
            let is_next = end < 2 || order.tiles[end - 2] < tile as u32;
            match order.instants.last_mut() {
                Some(last) if last.0 == instant && is_next => last.1 = end,
                _ => order.instants.push((instant, end)),
            }
        }
        order
    }

    /// Learns from designs, each with the number of tiles that were evaluated and those with bad samples, by place
    /// in the order.
    pub(super) fn learn<'a>(
        &mut self,
        order: &SampleOrder,
        designs: impl Iterator<Item = (usize, &'a [BadTile])>,
    ) {
        // Designs whose evaluation ended before a place.
        let mut ended = vec![0_u32; order.len() + 1];
        let mut bad = vec![0_u32; order.len()];
        let mut begun = 0;
        for (visited, tiles) in designs {
            begun += 1;
            ended[visited] += 1;
            for &(place, samples) in tiles {
                bad[place as usize] += u32::from(samples);
            }
        }
        for (place, &unit) in order.units.iter().enumerate() {
            begun -= ended[place];
            if begun == 0 {
                break;
            }
            let unit = unit as usize;
            self.visits[unit] = self.visits[unit] / 2 + begun;
            self.bad[unit] = self.bad[unit] / 2 + bad[place];
        }
    }
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn shape(tiles: usize, instants: usize) -> SampleTiles {
        SampleTiles {
            tiles,
            instants,
            total_weight: 1,
            available_up_to: 6.0,
        }
    }

    fn visited(order: &SampleOrder) -> Vec<(usize, u32)> {
        let each = order.instants();
        each.flat_map(|(instant, tiles)| tiles.iter().map(move |tile| (instant, *tile)))
            .collect()
    }

    /// Whatever was learnt, every tile has its turn once, and those of an instant ascend.
    #[test]
    fn an_order_visits_everything_once() {
        for (tiles, instants) in [(1, 1), (1, 12), (9, 100), (40, 7), (3, 1440)] {
            let mut hardness = Hardness::new(&shape(tiles, instants));
            for round in 0..3 {
                let order = hardness.order();
                let all = visited(&order);
                assert_eq!(all.len(), tiles * instants);
                assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), all.len());
                assert!(order.instants().all(|(_, tiles)| tiles.is_sorted()));
                let bad: Vec<BadTile> = (0..all.len() as u32)
                    .filter(|place| place % 5 == round)
                    .map(|place| (place, 3))
                    .collect();
                hardness.learn(&order, [(all.len(), bad.as_slice())].into_iter());
            }
        }
    }

    /// What was bad most often comes first, and what ended before a place says nothing about it.
    #[test]
    fn hard_tiles_come_first() {
        let mut hardness = Hardness::new(&shape(2, 200));
        let order = hardness.order();
        let hard = order.units[150];
        let unknown = order.units[390];
        let designs: Vec<(usize, Vec<BadTile>)> =
            vec![(300, vec![(150, 9)]), (160, vec![(150, 16)])];
        let designs = designs.iter().map(|(n, bad)| (*n, bad.as_slice()));
        hardness.learn(&order, designs);
        assert_eq!(hardness.visits[hard as usize], 2);
        assert_eq!(hardness.bad[hard as usize], 25);
        assert_eq!(hardness.visits[unknown as usize], 0);
        let next = hardness.order();
        assert!(next.units[..FIRST_STAGE].contains(&hard));
        // Unknown ones are before those that were good.
        let place = |unit: u32| next.units.iter().position(|one| *one == unit).unwrap();
        assert!(place(unknown) < place(order.units[200]));
    }
}
