//! One sample: all points, all satellites. The code that is compiled for each instruction set.

use super::candidates::{Block, Candidates, bits};
use super::fixed::FixedSample;
use super::flight::{PatternFlight, Positions, Turn};
use super::instructions::Work;
use super::lanes::{FixedTile, LANES, Lanes, MaskTerms, Real, Solution, Sums};
use super::tiles::{Horizon, Tile, Tiles};

/// Stands for an unsolved sample among the values of PDOP.
pub(super) const UNSOLVED: f32 = f32::INFINITY;

/// Least surplus of satellites over clock states: one satellite for each component of position.
pub(super) const POSITION_STATES: u32 = 3;

/// Where f32 is good enough.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// PDOP above this is computed again in f64.
    pub(super) single_below: f32,
    /// PDOP above which a sample is unsolved.
    pub(super) cap: f64,
    /// PDOP up to which a sample is available.
    pub(super) available: f64,
}

impl Limits {
    /// Relative distance from a threshold within which f32 does not decide.
    const BAND: f32 = 1e-5;

    #[inline(always)]
    fn holds_in_single(&self, pdop: f32) -> bool {
        let available = self.available as f32;
        (pdop <= self.single_below) & ((pdop - available).abs() > available * Self::BAND)
    }
}

/// What all samples share.
pub(super) struct Scene {
    pub(super) tiles: Tiles,
    pub(super) single: MaskTerms<f32>,
    pub(super) double: MaskTerms<f64>,
    pub(super) limits: Limits,
}

/// Memory of one evaluation that is used again for each sample.
pub(super) struct Workspace {
    pub(super) positions: Positions,
    all: Candidates,
    near: Candidates,
    words: Vec<u64>,
}

impl Workspace {
    pub(super) fn new(satellites: usize) -> Self {
        let all = Candidates::with_capacity(satellites);
        Self {
            positions: Positions::new(satellites),
            near: all.clone(),
            words: vec![0; satellites.div_ceil(super::flight::BLOCK)],
            all,
        }
    }
}

/// A decision that f32 cannot take: the point in a lane of a tile, and the satellites that it may
/// see.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Doubt {
    pub(super) tile: usize,
    pub(super) lane: usize,
    pub(super) satellites: Vec<u32>,
}

/// What one sample gives.
#[derive(Debug, Clone)]
pub(super) struct Outcome {
    /// PDOP of each slot, tile by tile; [`UNSOLVED`] where there is none.
    pub(super) pdop: Vec<Lanes<f32>>,
    /// Visible satellites, summed over the points without doubt.
    pub(super) visible: u64,
    /// Points without doubt that are available.
    pub(super) available: u64,
    /// Points whose PDOP was computed again in f64.
    pub(super) doubled: u64,
    /// Points to look at again.
    pub(super) doubts: Vec<Doubt>,
}

impl Outcome {
    pub(super) fn new(tiles: usize) -> Self {
        Self {
            pdop: vec![Lanes([UNSOLVED; LANES]); tiles],
            visible: 0,
            available: 0,
            doubled: 0,
            doubts: Vec::new(),
        }
    }
}

/// One sample to be evaluated.
pub(super) struct Sample<'a> {
    pub(super) scene: &'a Scene,
    /// The pattern to fly; without one the positions are there already.
    pub(super) pattern: Option<(&'a PatternFlight, Turn)>,
    /// The GNSS part.
    pub(super) fixed: FixedSample<'a>,
    pub(super) work: &'a mut Workspace,
    pub(super) outcome: &'a mut Outcome,
}

impl Work for Sample<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        if let Some((pattern, turn)) = &self.pattern {
            pattern.fly(turn, &mut self.work.positions);
        }
        evaluate(self.scene, &self.fixed, self.work, self.outcome);
    }
}

#[inline(always)]
fn evaluate(scene: &Scene, fixed: &FixedSample<'_>, work: &mut Workspace, out: &mut Outcome) {
    let horizon = &scene.tiles.horizon;
    work.all.fill(&work.positions, horizon);
    let slack_km = Horizon::cap_slack_km(&work.positions);
    let sine_slack = horizon.sine_slack(&work.positions);
    out.doubled = 0;
    out.doubts.clear();
    let (mut visible, mut available) = ([0; LANES], [0; LANES]);
    for group in &scene.tiles.groups {
        work.near.select(&work.all, &group.cap, slack_km);
        for number in group.tiles.clone() {
            let tile = &scene.tiles.tiles[number];
            let fixed = fixed.tile(number);
            let sums = single_sums(scene, tile, slack_km, work);
            let verdict = Verdict::new(&sums, &fixed, &scene.limits, sine_slack);
            for l in 0..LANES {
                visible[l] += verdict.visible.0[l];
                available[l] += verdict.available.0[l];
            }
            out.pdop[number] = verdict.pdop;
            if any(&verdict.doubtful) {
                doubt(number, &verdict, work, out);
            }
            if any(&verdict.coarse) {
                available[0] += compute_again(scene, number, &fixed, &verdict, work, out);
            }
        }
    }
    out.visible = visible.into_iter().map(u64::from).sum();
    out.available = available.into_iter().map(u64::from).sum();
}

#[inline(always)]
fn any(lanes: &Lanes<u32>) -> bool {
    lanes.0.iter().fold(0, |all, lane| all | lane) != 0
}

/// The sums of a tile in f32. Keeps which satellites were looked at.
#[inline(always)]
fn single_sums(scene: &Scene, tile: &Tile, slack_km: f32, work: &mut Workspace) -> Sums<f32> {
    let mut sums = Sums::zero();
    for (block, word) in work.near.blocks().iter().zip(&mut work.words) {
        *word = block.inside(&tile.cap, slack_km);
        for n in bits(*word) {
            sums.add(&tile.single, block.position(n), &scene.single);
        }
    }
    sums
}

/// What f32 says about the points of a tile; 0 or 1 where it is yes or no.
struct Verdict {
    pdop: Lanes<f32>,
    /// Too close to the mask for f32.
    doubtful: Lanes<u32>,
    /// PDOP too large for f32, or too close to a threshold.
    coarse: Lanes<u32>,
    /// Visible satellites where there is no doubt.
    visible: Lanes<u32>,
    /// Available, and neither doubtful nor coarse.
    available: Lanes<u32>,
}

impl Verdict {
    #[inline(always)]
    fn new(sums: &Sums<f32>, fixed: &FixedTile<'_>, limits: &Limits, sine_slack: f32) -> Self {
        let solution = Solution::new(sums, fixed);
        let zero = Lanes([0; LANES]);
        let mut verdict = Self {
            pdop: Lanes([UNSOLVED; LANES]),
            doubtful: zero,
            coarse: zero,
            visible: zero,
            available: zero,
        };
        for l in 0..LANES {
            let pdop = solution.pdop.0[l];
            let sure = u32::from(sums.margin.0[l] > sine_slack);
            let counted = u32::from(solution.surplus.0[l] >= POSITION_STATES);
            let fine = u32::from(limits.holds_in_single(pdop));
            let reached = u32::from(pdop <= limits.available as f32);
            verdict.pdop.0[l] = if counted != 0 { pdop } else { UNSOLVED };
            verdict.doubtful.0[l] = 1 - sure;
            verdict.coarse.0[l] = counted & (1 - fine) & sure;
            verdict.visible.0[l] = sums.count.0[l] * sure;
            verdict.available.0[l] = counted & fine & sure & reached;
        }
        verdict
    }
}

/// Leaves the doubtful points of a tile to be looked at again.
#[inline(never)]
fn doubt(number: usize, verdict: &Verdict, work: &Workspace, out: &mut Outcome) {
    let satellites: Vec<u32> = looked_at(work)
        .map(|(block, n)| block.index(n) as u32)
        .collect();
    for lane in (0..LANES).filter(|&lane| verdict.doubtful.0[lane] != 0) {
        out.pdop[number].0[lane] = UNSOLVED;
        out.doubts.push(Doubt {
            tile: number,
            lane,
            satellites: satellites.clone(),
        });
    }
}

fn looked_at(work: &Workspace) -> impl Iterator<Item = (&Block, usize)> {
    let blocks = work.near.blocks().iter().zip(&work.words);
    blocks.flat_map(|(block, &word)| bits(word).map(move |n| (block, n)))
}

/// Takes the tile again in f64, for the points that f32 is too coarse for. Returns how many of
/// them are available.
#[inline(always)]
fn compute_again(
    scene: &Scene,
    number: usize,
    fixed: &FixedTile<'_>,
    verdict: &Verdict,
    work: &Workspace,
    out: &mut Outcome,
) -> u32 {
    let mut sums = Sums::<f64>::zero();
    for (block, &word) in work.near.blocks().iter().zip(&work.words) {
        for n in bits(word) {
            let position = work.positions.at(block.index(n));
            sums.add(&scene.tiles.tiles[number].double, position, &scene.double);
        }
    }
    let solution = Solution::new(&sums, fixed);
    let mut available = 0;
    for lane in (0..LANES).filter(|&lane| verdict.coarse.0[lane] != 0) {
        let pdop = solution.pdop.0[lane];
        let solved = pdop < f64::NO_SOLUTION && pdop <= scene.limits.cap;
        out.pdop[number].0[lane] = if solved { pdop as f32 } else { UNSOLVED };
        available += u32::from(solved && pdop <= scene.limits.available);
        out.doubled += 1;
    }
    available
}
