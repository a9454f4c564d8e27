//! PDOP without some of the satellites, in lanes of f64 ([M-56](crate::models#m-56)).
//!
//! A satellite of weight w along v, taken out of a clock group of weight G with the mean m, takes g δ δᵀ off the normal
//! matrix A, where δ = v - m and g = w G / (G - w). So the trace of the inverse grows by g |A⁻¹δ|² / (1 - g δᵀA⁻¹δ)
//! (Sherman and Morrison), and a satellite costs one division and one root at sixteen points. Where the geometry is not good
//! without the satellite, PDOP is large or close to a threshold, the plain path decides.

use super::Kernel;
use super::fixed::{FixedSample, FixedTiles, SampleInstant, at_most_u16};
use super::instructions::Work;
use super::lanes::{LANES, Lanes, Sums};
use super::losses::downdate::{LossLimits, TileGeometry};
use super::losses::sky::{LaneSky, OpenSky};
use super::losses::worst::BegunTile;
use super::normal::FixedTile;
use super::propagation::{PatternPropagator, Propagation};
use super::sample::SampleContext;
use super::tiles::{Group, Tile};
use super::weighting::{SineWeights, UnitWeights, Weighting};
use super::workspace::Workspace;
use crate::dop::ObservationWeights;
use crate::ephemeris::{Ephemeris, EphemerisError};
use std::ops::Range;

mod downdate;
mod sky;
mod worst;

pub(in crate::evaluate) use worst::LossTally;

/// Distance of the sine of an elevation from that of the mask within which the plain path decides: a thousand times what
/// the angles of the two paths differ by over ten days.
const NEAR_MASK: f64 = 1e-9;

/// A sample with all satellites. Sixteen bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::evaluate) struct WholeSample {
    /// PDOP; infinite if unsolved.
    pub(in crate::evaluate) pdop: f64,
    /// The point, an index into the sites.
    pub(in crate::evaluate) site: u32,
    /// Visible LEO satellites.
    pub(in crate::evaluate) visible: u16,
    /// Visible GNSS satellites.
    pub(in crate::evaluate) gnss_visible: u16,
}

/// A sample without some satellites. Sixteen bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::evaluate) struct ChangedSample {
    /// Its place among the samples with all satellites.
    pub(in crate::evaluate) sample: u32,
    /// Visible satellites that are missing.
    pub(in crate::evaluate) missing: u32,
    /// PDOP without them; infinite if unsolved.
    pub(in crate::evaluate) pdop: f64,
}

/// The samples of some instants, instant by instant: every point once in each, in an order of its own.
#[derive(Debug, Default)]
pub(in crate::evaluate) struct SampleLosses {
    /// Place of the first sample among those of the grid.
    pub(in crate::evaluate) first: u32,
    /// The samples with all satellites.
    pub(in crate::evaluate) whole: Vec<WholeSample>,
    /// Of each set of satellites, the samples that change without it, but for those that are tallied.
    pub(in crate::evaluate) changed: Vec<Vec<ChangedSample>>,
    /// Of each set, what the samples come to that stay solved without it; empty if all samples are kept.
    pub(in crate::evaluate) tallies: Vec<LossTally>,
    /// The largest solved PDOP of these.
    pub(in crate::evaluate) largest: f64,
}

impl SampleLosses {
    /// Takes note of a PDOP without a set; it is NaN where it is not yet known, infinite where it is unsolved.
    #[inline(always)]
    pub(in crate::evaluate) fn note(&mut self, pdop: f64) {
        if pdop < f64::INFINITY && pdop > self.largest {
            self.largest = pdop;
        }
    }
}

/// What the lanes leave to the plain path at an instant.
#[derive(Debug, Default)]
pub(in crate::evaluate) struct LossDoubts {
    pub(in crate::evaluate) samples: Vec<LossDoubt>,
    /// The tiles of these, each with the satellites that it may see.
    pub(in crate::evaluate) tiles: Vec<(u32, Vec<u32>)>,
}

/// Something that the plain path decides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::evaluate) struct LossDoubt {
    /// Place of the sample within its piece.
    pub(in crate::evaluate) place: u32,
    pub(in crate::evaluate) tile: u32,
    pub(in crate::evaluate) about: DoubtAbout,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::evaluate) enum DoubtAbout {
    /// Which satellites are visible, and so everything: no set has the sample yet.
    Sky,
    /// PDOP with all satellites.
    Whole,
    /// PDOP without a set, in this place of its changed samples.
    Set { set: u32, at: u32 },
}

impl Kernel {
    /// The GNSS in service.
    pub(in crate::evaluate) fn systems(&self) -> &[Ephemeris] {
        &self.fixed.systems
    }

    /// Adds the samples of some instants, with the sets that each satellite is in; what the lanes leave open of an instant
    /// goes to `settle`.
    pub(in crate::evaluate) fn losses(
        &self,
        ephemeris: &Ephemeris,
        of_satellite: &[Vec<u32>],
        instants: Range<usize>,
        losses: &mut SampleLosses,
        mut settle: impl FnMut(usize, &mut LossDoubts, &mut SampleLosses) -> Result<(), EphemerisError>,
    ) -> Result<(), EphemerisError> {
        let propagation = Propagation::new(ephemeris);
        let mut work = Workspace::new(&propagation);
        let mut scratch = FixedTiles::default();
        let (mut sky, mut touched) = (LaneSky::default(), Vec::new());
        let mut doubts = LossDoubts::default();
        for number in instants {
            let instant = SampleInstant {
                number,
                elapsed_s: self.setup.grid.elapsed_s(number),
                rotation: self.rotations[number],
            };
            let fixed = self.fixed.at(&self.scene.tiles, instant, &mut scratch)?;
            let (positions, turns) = (&mut work.positions, &mut work.turns);
            propagation.start(instant.elapsed_s, instant.rotation, positions, turns)?;
            self.instructions.run(LossesAt {
                scene: &self.scene,
                patterns: &propagation.patterns,
                fixed,
                limits: LossLimits::new(
                    self.scene.limits.cap,
                    self.setup.metrics.availability_pdop,
                ),
                of_satellite,
                work: &mut work,
                sky: &mut sky,
                touched: &mut touched,
                losses,
                doubts: &mut doubts,
            });
            if !doubts.samples.is_empty() {
                settle(number, &mut doubts, losses)?;
                doubts.samples.clear();
                doubts.tiles.clear();
            }
        }
        Ok(())
    }
}

/// One instant.
struct LossesAt<'a> {
    scene: &'a SampleContext,
    patterns: &'a [PatternPropagator],
    fixed: FixedSample<'a>,
    limits: LossLimits,
    /// The sets that each satellite is in, rising.
    of_satellite: &'a [Vec<u32>],
    work: &'a mut Workspace,
    sky: &'a mut LaneSky,
    /// Sets and places in the sky of their satellites.
    touched: &'a mut Vec<(u32, u32)>,
    losses: &'a mut SampleLosses,
    doubts: &'a mut LossDoubts,
}

impl Work for LossesAt<'_> {
    type Output = ();

    #[inline(always)]
    fn run(mut self) {
        for (pattern, turn) in self.patterns.iter().zip(&self.work.turns) {
            pattern.place_at(turn, &mut self.work.positions);
        }
        let scene = self.scene;
        self.work.begin(&scene.tiles.horizon);
        for group in &scene.tiles.groups {
            self.work.select(scene, group);
            for number in group.tiles.clone() {
                match scene.weights {
                    ObservationWeights::Unit => self.tile::<UnitWeights>(number, group),
                    ObservationWeights::SineElevation => self.tile::<SineWeights>(number, group),
                }
            }
        }
    }
}

impl LossesAt<'_> {
    #[inline(always)]
    fn tile<W: Weighting>(&mut self, number: usize, group: &Group) {
        let tile = &self.scene.tiles.tiles[number];
        let fixed = self.fixed.tile(number);
        let (sums, near_mask) = match tile.sky {
            None => self.look::<W, false>(number, group),
            Some(_) => self.look::<W, true>(number, group),
        };
        let all = TileGeometry::new::<W>(&sums, &fixed);
        let doubts = self.doubts.samples.len();
        let first = self.losses.whole.len() as u32;
        self.push_whole(tile, &sums, &fixed, &all.pdop(&self.limits));
        let members = (1_u32 << tile.members.len()) - 1;
        let sure = members & !near_mask;
        for l in lanes_of(members & near_mask) {
            self.doubt(first + l as u32, number, DoubtAbout::Sky);
        }
        for l in lanes_of(sure) {
            if self.losses.whole[first as usize + l].pdop.is_nan() {
                self.doubt(first + l as u32, number, DoubtAbout::Whole);
            }
        }
        let begun = self.begin(number, first, sure);
        self.lose_sets(&all, &begun);
        if self.doubts.samples.len() > doubts {
            let satellites = self.sky.seen().iter().map(|one| one.satellite).collect();
            self.doubts.tiles.push((number as u32, satellites));
        }
    }

    /// The satellites in view of a tile, their sums, and a bit for each point with one close to the mask.
    #[inline(always)]
    fn look<W: Weighting, const UNDER_SKYLINES: bool>(
        &mut self,
        number: usize,
        group: &Group,
    ) -> (Sums<f64>, u32) {
        let tile = &self.scene.tiles.tiles[number];
        let mask = &self.scene.double;
        let sine = mask.sine();
        let slack = self.scene.tiles.horizon.double_slack(&self.work.positions);
        let mut sums = Sums::<f64>::zero();
        let mut all_near = 0;
        self.sky.clear();
        for n in self.work.candidates(number, group).satellites() {
            let satellite = self.work.positions.at(n);
            let one = self.sky.next_to_fill();
            let (mut seen_bits, mut near_bits) = (Lanes([0_u32; LANES]), Lanes([0_u32; LANES]));
            let open = match &tile.sky {
                Some(sky) if UNDER_SKYLINES => {
                    OpenSky::over(sky, tile, self.scene, satellite, slack)
                }
                _ => OpenSky::EVERYWHERE,
            };
            for l in 0..LANES {
                let (line, _, _) = tile.double.line(satellite, mask, l);
                let above = line.sine >= sine + NEAR_MASK;
                let possible = line.sine >= sine - NEAR_MASK;
                let (seen, near) = if UNDER_SKYLINES {
                    let seen = above & (open.surely >> l & 1 != 0);
                    (
                        seen,
                        possible & (!above | !seen & (open.perhaps >> l & 1 != 0)),
                    )
                } else {
                    (above, possible & !above)
                };
                seen_bits.0[l] = if seen { 1 << l } else { 0 };
                near_bits.0[l] = if near { 1 << l } else { 0 };
                one.set::<W>(l, &line, seen);
                sums.add_line::<W>(&line, seen, seen, l);
            }
            (one.satellite, one.seen) = (n as u32, joined(&seen_bits));
            let near = joined(&near_bits);
            all_near |= near;
            if one.seen | near != 0 {
                self.sky.keep();
            }
        }
        (sums, all_near)
    }

    #[inline(always)]
    fn push_whole(
        &mut self,
        tile: &Tile,
        sums: &Sums<f64>,
        fixed: &FixedTile<'_>,
        pdop: &Lanes<f64>,
    ) {
        let whole = |(l, &site): (usize, &u32)| WholeSample {
            pdop: pdop.0[l],
            site,
            visible: at_most_u16(sums.count.0[l]),
            gnss_visible: fixed.visible[l],
        };
        let members = tile.members.iter().enumerate();
        self.losses.whole.extend(members.map(whole));
    }

    /// Takes each set out of the points that see a satellite of it.
    #[inline(always)]
    fn lose_sets(&mut self, all: &TileGeometry, begun: &BegunTile) {
        self.touched.clear();
        for (place, one) in (0..).zip(self.sky.seen()) {
            let sets = self.of_satellite[one.satellite as usize].iter();
            self.touched.extend(sets.map(|set| (*set, place)));
        }
        if !self.touched.is_sorted() {
            self.touched.sort_unstable();
        }
        let touched = std::mem::take(self.touched);
        for together in touched.chunk_by(|a, b| a.0 == b.0) {
            let last = together[together.len() - 1].1 as usize;
            match &together[..together.len() - 1] {
                [] => self.lose(all, last, together, begun),
                others => {
                    let mut left = all.clone();
                    // Not a closure, which would not be compiled for the instruction set.
                    for (_, place) in others {
                        left.remove(self.sky.at(*place as usize));
                    }
                    self.lose(&left, last, together, begun);
                }
            }
        }
        *self.touched = touched;
    }

    /// Takes the last satellite of a set out of a geometry without the others.
    #[inline(always)]
    fn lose(
        &mut self,
        left: &TileGeometry,
        last: usize,
        together: &[(u32, u32)],
        begun: &BegunTile,
    ) {
        let of = |(_, place): &(u32, u32)| self.sky.at(*place as usize);
        let seen = together.iter().fold(0, |all, one| all | of(one).seen) & begun.sure;
        let set = together[0].0;
        let tallied = match self.losses.tallies.get_mut(set as usize) {
            Some(tally) => {
                let squares = left.square_without(self.sky.at(last), &self.limits);
                tally.take(&squares, seen, begun, &self.limits)
            }
            None => 0,
        };
        if seen & !tallied != 0 {
            let pdop = left.pdop_without(self.sky.at(last), &self.limits);
            self.keep(&pdop, together, seen & !tallied, begun);
        }
    }

    /// Keeps the samples at some points of a tile.
    #[inline(always)]
    fn keep(&mut self, pdop: &Lanes<f64>, together: &[(u32, u32)], points: u32, begun: &BegunTile) {
        let of = |(_, place): &(u32, u32)| self.sky.at(*place as usize);
        let set = together[0].0;
        for l in lanes_of(points) {
            let missing = match together {
                [_] => 1,
                _ => together.iter().map(|one| of(one).seen >> l & 1).sum(),
            };
            let changed = &mut self.losses.changed[set as usize];
            if pdop.0[l].is_nan() {
                let at = changed.len() as u32;
                self.doubts.samples.push(LossDoubt {
                    place: begun.first + l as u32,
                    tile: begun.number as u32,
                    about: DoubtAbout::Set { set, at },
                });
            }
            changed.push(ChangedSample {
                sample: self.losses.first + begun.first + l as u32,
                missing,
                pdop: pdop.0[l],
            });
            self.losses.note(pdop.0[l]);
        }
    }

    /// What the losses of a tile need to know of it with all satellites.
    #[inline(always)]
    fn begin(&self, number: usize, first: u32, sure: u32) -> BegunTile {
        let weights = self.scene.tiles.tiles[number].weights.whole;
        let mut begun = BegunTile::new(number, first, sure, weights);
        if !self.losses.tallies.is_empty() {
            let whole = &self.losses.whole[first as usize..];
            begun.know(whole, &self.limits);
        }
        begun
    }

    #[inline(always)]
    fn doubt(&mut self, place: u32, tile: usize, about: DoubtAbout) {
        let tile = tile as u32;
        self.doubts.samples.push(LossDoubt { place, tile, about });
    }
}

#[inline(always)]
fn joined(bits: &Lanes<u32>) -> u32 {
    bits.0.iter().fold(0, |all, bit| all | bit)
}

/// The numbers of the bits that are set.
#[inline(always)]
fn lanes_of(bits: u32) -> impl Iterator<Item = usize> {
    super::candidates::bits(u64::from(bits)).map(|l| l % LANES)
}
