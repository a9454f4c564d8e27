//! Some tiles of some instants, with the values that an evaluation of all of them gives, bit for bit.

use super::Kernel;
use super::fixed::{FixedSample, FixedTiles, SampleInstant};
use super::instructions::Work;
use super::limits::Limits;
use super::propagation::{PatternPropagator, Propagation};
use super::sample::{Begun, SampleContext, SampleOutcome};
use super::settle::Settling;
use super::tiles::Tiles;
use super::weighting::{SeveralClocks, SineWeights, UnitWeights, Weighting};
use super::workspace::Workspace;
use crate::dop::ObservationWeights;
use crate::ephemeris::{Ephemeris, EphemerisError};
use std::ops::ControlFlow;

/// Neighbouring ground points at one instant: a sample in each place.
#[derive(Debug, Clone, Copy)]
pub struct SampleTile<'a> {
    /// The instant, an index into the grid.
    pub instant: usize,
    /// The tile.
    pub tile: usize,
    /// The points, indices into the sites; shorter than the rest in the last tile.
    pub points: &'a [u32],
    /// Their weights, in the unit of [`SampleTiles::total_weight`]; 0 in a place without a point.
    pub weights: &'a [u64],
    /// PDOP; infinite where it is unsolved.
    pub pdop: &'a [f32],
    /// LEO satellites in view.
    pub leo: &'a [u32],
    /// GNSS satellites in view.
    pub gnss: &'a [u16],
}

/// How the samples of a setup are divided into tiles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampleTiles {
    /// Tiles of each instant.
    pub tiles: usize,
    /// Instants.
    pub instants: usize,
    /// Weight of all samples, in whole units.
    pub total_weight: u64,
    /// PDOP up to which a sample is available, as the values of a tile are compared with it.
    pub available_up_to: f32,
}

impl Kernel {
    pub(in crate::evaluate) fn sample_tiles(&self) -> SampleTiles {
        SampleTiles {
            tiles: self.scene.tiles.tiles.len(),
            instants: self.setup.grid.len(),
            total_weight: self.total,
            available_up_to: self.scene.limits.available.single(),
        }
    }

    /// Evaluates some tiles (in ascending order) at each of some instants until `see` breaks.
    pub(in crate::evaluate) fn probe<'t>(
        &self,
        ephemeris: &Ephemeris,
        instants: impl Iterator<Item = (usize, &'t [u32])>,
        see: impl FnMut(SampleTile<'_>) -> ControlFlow<()>,
    ) -> Result<(), EphemerisError> {
        let propagation = self.propagation(ephemeris);
        self.probe_within(&propagation, self.scene.limits, instants, see)
    }

    /// The same within narrower limits, or wider ones.
    pub(super) fn probe_within<'t>(
        &self,
        propagation: &Propagation<'_>,
        limits: Limits,
        instants: impl Iterator<Item = (usize, &'t [u32])>,
        mut see: impl FnMut(SampleTile<'_>) -> ControlFlow<()>,
    ) -> Result<(), EphemerisError> {
        let ephemeris = propagation.ephemeris;
        let mut work = Workspace::new(propagation);
        let mut outcome = SampleOutcome::new(self.scene.tiles.tiles.len());
        let mut scratch = FixedTiles::default();
        for (number, tiles) in instants {
            let instant = SampleInstant {
                number,
                elapsed_s: self.setup.grid.elapsed_s(number),
                rotation: self.rotations[number],
            };
            let fixed = self.fixed.at(&self.scene.tiles, instant, &mut scratch)?;
            let (positions, turns) = (&mut work.positions, &mut work.turns);
            propagation.start(instant.elapsed_s, instant.rotation, positions, turns)?;
            self.instructions.run(SomeTiles {
                scene: &self.scene,
                limits,
                patterns: &propagation.patterns,
                tiles,
                fixed,
                work: &mut work,
                outcome: &mut outcome,
            });
            let settling = Settling::new(&self.setup, &self.scene, instant, fixed);
            settling.settle(ephemeris, &self.fixed.systems, &mut outcome)?;
            for &tile in tiles {
                let seen = self.seen(number, tile as usize, &outcome, fixed);
                if see(seen).is_break() {
                    return Ok(());
                }
            }
        }
        Ok(())
    }

    fn seen<'a>(
        &'a self,
        instant: usize,
        tile: usize,
        outcome: &'a SampleOutcome,
        fixed: FixedSample<'a>,
    ) -> SampleTile<'a> {
        let of = &self.scene.tiles.tiles[tile];
        SampleTile {
            instant,
            tile,
            points: &of.members,
            weights: &of.weights.whole.0,
            pdop: &outcome.pdop[tile].0,
            leo: &outcome.visible[tile].0,
            gnss: fixed.tile(tile).visible,
        }
    }
}

/// Some tiles of one instant.
struct SomeTiles<'a> {
    scene: &'a SampleContext,
    limits: Limits,
    patterns: &'a [PatternPropagator],
    tiles: &'a [u32],
    fixed: FixedSample<'a>,
    work: &'a mut Workspace,
    outcome: &'a mut SampleOutcome,
}

impl Work for SomeTiles<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for (pattern, turn) in self.patterns.iter().zip(&self.work.turns) {
            pattern.place_at(turn, &mut self.work.positions);
        }
        match (self.scene.weights, self.work.has_several_clocks()) {
            (ObservationWeights::Unit, false) => self.evaluate::<UnitWeights>(),
            (ObservationWeights::SineElevation, false) => self.evaluate::<SineWeights>(),
            (ObservationWeights::Unit, true) => self.evaluate::<SeveralClocks<UnitWeights>>(),
            (ObservationWeights::SineElevation, true) => {
                self.evaluate::<SeveralClocks<SineWeights>>();
            }
        }
    }
}

impl SomeTiles<'_> {
    #[inline(always)]
    fn evaluate<W: Weighting>(self) {
        let (scene, work, out) = (self.scene, self.work, self.outcome);
        let begun = Begun::new::<W>(scene, self.limits, work, out);
        let Tiles { tiles, groups, .. } = &scene.tiles;
        let mut wanted = self.tiles;
        for group in groups {
            let inside = wanted.partition_point(|tile| (*tile as usize) < group.tiles.end);
            let (here, later) = wanted.split_at(inside);
            wanted = later;
            if here.is_empty() {
                continue;
            }
            let slack_km = work.select_near(group);
            for &tile in here {
                let number = tile as usize;
                work.select_tile(&tiles[number], number - group.tiles.start, slack_km);
                begun.evaluate_tile::<W>((number, group), &self.fixed.tile(number), work, out);
            }
            begun.end_group::<W>(group, &self.fixed, work, out);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::UNSOLVED;
    use super::*;
    use crate::evaluate::Evaluator;
    use crate::evaluate::series::Instant;
    use crate::evaluate::testing::setup;
    use crate::ground::{Grid, PointWeights};
    use crate::orbit::Model;
    use crate::time::{Epoch, TimeGrid};

    /// Any tiles at any instants, in any order, have the bits of the whole evaluation; `see` ends it.
    #[test]
    fn some_tiles_equal_the_whole() {
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let grid = TimeGrid::new(epoch, 7_200.0, 300.0).unwrap();
        let region = Grid {
            latitude_deg: [-60.0, 60.0],
            longitude_deg: [-180.0, 170.0],
            step_deg: [6.0, 10.0],
            weights: PointWeights::CosLatitude,
        };
        let sites = region.sites(crate::earth::Surface::Wgs84).unwrap();
        let evaluator = Evaluator::new(setup(grid, sites, 35.0)).unwrap();
        let design = "delta:55:40/5/1@925".parse().unwrap();
        let ephemeris = Ephemeris::of_design(&design, Model::J2, grid).unwrap();
        let kernel = &evaluator.kernel;
        let mut whole: Vec<Instant> = Vec::new();
        kernel
            .visit(&ephemeris, |instant| whole.push(instant.clone()))
            .unwrap();
        let all = kernel.sample_tiles();
        assert!(all.tiles > 40 && all.instants == 24);
        let wanted: [(usize, Vec<u32>); 4] = [
            (13, vec![0, 7, 33]),
            (2, vec![5]),
            (23, (0..all.tiles as u32).collect()),
            (13, vec![40]),
        ];
        let (mut tiles, mut unsolved) = (0, 0);
        let instants = wanted.iter().map(|(at, tiles)| (*at, tiles.as_slice()));
        let compare = |seen: SampleTile<'_>| {
            tiles += 1;
            for (lane, &site) in seen.points.iter().enumerate() {
                let expected = &whole[seen.instant].points[site as usize];
                let pdop = (seen.pdop[lane] < UNSOLVED).then_some(seen.pdop[lane]);
                unsolved += usize::from(pdop.is_none());
                assert_eq!(pdop, expected.pdop);
                assert_eq!(seen.leo[lane], expected.visible);
                assert_eq!(u32::from(seen.gnss[lane]), expected.gnss_visible);
            }
            ControlFlow::Continue(())
        };
        kernel.probe(&ephemeris, instants, compare).unwrap();
        assert_eq!(tiles, 5 + all.tiles);
        assert!(unsolved > 0, "an unsolved sample is among them");
        let mut seen = 0;
        let instants = wanted.iter().map(|(at, tiles)| (*at, tiles.as_slice()));
        let first_two = |_: SampleTile<'_>| {
            seen += 1;
            if seen == 2 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        kernel.probe(&ephemeris, instants, first_two).unwrap();
        assert_eq!(seen, 2);
    }
}
