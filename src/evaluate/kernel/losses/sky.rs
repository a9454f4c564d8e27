//! The satellites in view of the points of a tile.

use super::super::lanes::SightLine;
use super::super::sample::SampleContext;
use super::super::skylines::{SightSlack, Skyward, TileSky};
use super::super::tiles::Tile;
use super::super::weighting::Weighting;
use super::{LANES, Lanes};

/// A satellite that some points of a tile see.
pub(super) struct LaneSight {
    pub(super) satellite: u32,
    /// A bit for each point that sees it.
    pub(super) seen: u32,
    /// Unit vector to it.
    pub(super) unit: [Lanes<f64>; 3],
    /// Weight of its observation; 0 where it is not seen.
    pub(super) weight: Lanes<f64>,
}

impl LaneSight {
    const NOWHERE: Self = Self {
        satellite: 0,
        seen: 0,
        unit: [Lanes([0.0; LANES]); 3],
        weight: Lanes([0.0; LANES]),
    };

    #[inline(always)]
    pub(super) fn set<W: Weighting>(&mut self, l: usize, line: &SightLine<f64>, seen: bool) {
        let unit = line.unit();
        for (lanes, value) in self.unit.iter_mut().zip(unit) {
            lanes.0[l] = value;
        }
        let weight = if W::BY_SINE {
            line.sine * line.sine
        } else {
            1.0
        };
        self.weight.0[l] = if seen { weight } else { 0.0 };
    }
}

/// The satellites that some points of a tile see. They are filled where they stay, as a copy of each is large.
#[derive(Default)]
pub(super) struct LaneSky {
    sights: Vec<LaneSight>,
    count: usize,
}

impl LaneSky {
    #[inline(always)]
    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// The next one, to be filled.
    #[inline(always)]
    pub(super) fn next_to_fill(&mut self) -> &mut LaneSight {
        if self.count == self.sights.len() {
            self.sights.push(LaneSight::NOWHERE);
        }
        &mut self.sights[self.count]
    }

    /// Keeps the one that was filled last.
    #[inline(always)]
    pub(super) fn keep(&mut self) {
        self.count += 1;
    }

    #[inline(always)]
    pub(super) fn seen(&self) -> &[LaneSight] {
        &self.sights[..self.count]
    }

    #[inline(always)]
    pub(super) fn at(&self, place: usize) -> &LaneSight {
        &self.sights[place]
    }
}

/// A bit for each point of a tile whose skyline does not hide a satellite above the mask.
pub(super) struct OpenSky {
    pub(super) surely: u32,
    /// The same, and where the plain path decides.
    pub(super) perhaps: u32,
}

impl OpenSky {
    pub(super) const EVERYWHERE: Self = Self {
        surely: u32::MAX,
        perhaps: u32::MAX,
    };

    #[inline(always)]
    pub(super) fn over(
        sky: &TileSky,
        tile: &Tile,
        scene: &SampleContext,
        satellite: [f64; 3],
        slack: SightSlack,
    ) -> Self {
        let points = Skyward {
            sites: &tile.double,
            sky,
            mask: &scene.double,
            slack,
        };
        let decide = |lane: usize| sky.surely_sees(lane, satellite, scene.mask);
        let (mut surely, mut perhaps) = (0, 0);
        points.look(satellite, decide, |l, _, seen, possible| {
            surely |= u32::from(seen) << l;
            perhaps |= u32::from(possible) << l;
        });
        Self { surely, perhaps }
    }
}
