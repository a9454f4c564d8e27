//! One sample: all points, all satellites. The code that is compiled for each instruction set.

use super::candidates::{Block, Candidates, bits};
use super::flight::{PatternFlight, Positions, Turn};
use super::lanes::{FixedTile, LANES, Lanes, MaskTerms, Real, Solution, Sums};
use super::tiles::{Tile, Tiles};
use multiversion::multiversion;

/// Stands for an unsolved sample among the values of PDOP.
pub(super) const UNSOLVED: f32 = f32::INFINITY;

/// Least surplus of satellites over clock states: one satellite for each component of position.
const POSITION_STATES: u8 = 3;

/// The vector instructions that the kernel runs on.
///
/// All give the same bits; [`InstructionSet::detect`] finds the fastest one that there is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InstructionSet {
    /// AVX-512 of Ice Lake and later: sixteen points at once.
    Avx512,
    /// AVX2: eight points at once.
    Avx2,
    /// What every processor of the target has; SSE2 on x86-64: four points at once.
    Baseline,
}

impl std::fmt::Display for InstructionSet {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.pad(match self {
            Self::Avx512 => "AVX-512",
            Self::Avx2 => "AVX2",
            Self::Baseline => "baseline",
        })
    }
}

impl InstructionSet {
    /// Every instruction set, the widest first.
    pub const ALL: [Self; 3] = [Self::Avx512, Self::Avx2, Self::Baseline];

    /// Whether the processor has it.
    #[must_use]
    pub fn is_available(self) -> bool {
        #[cfg(target_arch = "x86_64")]
        match self {
            Self::Avx512 => {
                is_x86_feature_detected!("avx512bw")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("avx512vbmi2")
            }
            Self::Avx2 => is_x86_feature_detected!("avx2"),
            Self::Baseline => true,
        }
        #[cfg(not(target_arch = "x86_64"))]
        matches!(self, Self::Baseline)
    }

    /// The widest one that the processor has.
    #[must_use]
    pub fn detect() -> Self {
        Self::ALL
            .into_iter()
            .find(|set| set.is_available())
            .unwrap_or(Self::Baseline)
    }
}

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

/// The input of one sample.
#[derive(Clone, Copy)]
pub(super) struct Instant<'a> {
    /// The pattern to fly; without one the positions are there already.
    pub(super) pattern: Option<(&'a PatternFlight, Turn)>,
    /// The GNSS part, one for each tile; none without GNSS.
    pub(super) fixed: &'a [FixedTile],
}

/// Evaluates one sample with the given instructions.
pub(super) fn evaluate(
    instructions: InstructionSet,
    scene: &Scene,
    instant: Instant<'_>,
    work: &mut Workspace,
    outcome: &mut Outcome,
) {
    match instructions {
        InstructionSet::Avx512 => evaluate_avx512(scene, instant, work, outcome),
        InstructionSet::Avx2 => evaluate_avx2(scene, instant, work, outcome),
        InstructionSet::Baseline => evaluate_here(scene, instant, work, outcome),
    }
}

#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl+bmi1+bmi2+lzcnt"))]
fn evaluate_avx512(scene: &Scene, instant: Instant<'_>, work: &mut Workspace, out: &mut Outcome) {
    evaluate_here(scene, instant, work, out);
}

#[multiversion(targets("x86_64+avx2+bmi1+bmi2+lzcnt"))]
fn evaluate_avx2(scene: &Scene, instant: Instant<'_>, work: &mut Workspace, out: &mut Outcome) {
    evaluate_here(scene, instant, work, out);
}

#[inline(always)]
fn evaluate_here(scene: &Scene, instant: Instant<'_>, work: &mut Workspace, out: &mut Outcome) {
    if let Some((pattern, turn)) = instant.pattern {
        pattern.fly(turn, &mut work.positions);
    }
    let horizon = &scene.tiles.horizon;
    let extent = work.all.fill(&work.positions, horizon);
    let (slack_km, sine_slack) = (extent.cap_slack_km(), extent.sine_slack(horizon));
    (out.visible, out.available, out.doubled) = (0, 0, 0);
    out.doubts.clear();
    for group in &scene.tiles.groups {
        work.near.select(&work.all, &group.cap, slack_km);
        for number in group.tiles.clone() {
            let tile = &scene.tiles.tiles[number];
            let fixed = instant.fixed.get(number).unwrap_or(&FixedTile::NONE);
            let sums = single_sums(scene, tile, slack_km, work);
            let verdict = Verdict::new(&sums, fixed, &scene.limits, sine_slack);
            out.pdop[number] = verdict.pdop;
            out.visible += u64::from(verdict.visible);
            out.available += u64::from(verdict.available);
            if verdict.any_doubtful {
                doubt(number, &verdict, work, out);
            }
            if verdict.any_coarse {
                compute_again(scene, number, fixed, &verdict, work, out);
            }
        }
    }
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

/// What f32 says about the points of a tile.
struct Verdict {
    pdop: Lanes<f32>,
    /// Too close to the mask for f32.
    doubtful: [bool; LANES],
    /// PDOP too large for f32, or too close to a threshold.
    coarse: [bool; LANES],
    any_doubtful: bool,
    any_coarse: bool,
    visible: u32,
    available: u32,
}

impl Verdict {
    #[inline(always)]
    fn new(sums: &Sums<f32>, fixed: &FixedTile, limits: &Limits, sine_slack: f32) -> Self {
        let solution = Solution::new(sums, fixed);
        let mut verdict = Self {
            pdop: Lanes([UNSOLVED; LANES]),
            doubtful: [false; LANES],
            coarse: [false; LANES],
            any_doubtful: false,
            any_coarse: false,
            visible: 0,
            available: 0,
        };
        let enough = f32::from(POSITION_STATES);
        for l in 0..LANES {
            let pdop = solution.pdop.0[l];
            let doubtful = sums.margin.0[l] <= sine_slack;
            let counted = solution.surplus.0[l] >= enough;
            let fine = limits.holds_in_single(pdop);
            let coarse = counted & !fine & !doubtful;
            verdict.pdop.0[l] = if counted { pdop } else { UNSOLVED };
            verdict.doubtful[l] = doubtful;
            verdict.coarse[l] = coarse;
            verdict.any_doubtful |= doubtful;
            verdict.any_coarse |= coarse;
            verdict.visible += if doubtful { 0 } else { sums.count.0[l] as u32 };
            let available = counted & fine & !doubtful & (pdop <= limits.available as f32);
            verdict.available += u32::from(available);
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
    for lane in (0..LANES).filter(|&lane| verdict.doubtful[lane]) {
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

/// Takes the tile again in f64, for the points that f32 is too coarse for.
#[inline(always)]
fn compute_again(
    scene: &Scene,
    number: usize,
    fixed: &FixedTile,
    verdict: &Verdict,
    work: &Workspace,
    out: &mut Outcome,
) {
    let mut sums = Sums::<f64>::zero();
    for (block, &word) in work.near.blocks().iter().zip(&work.words) {
        for n in bits(word) {
            let position = work.positions.at(block.index(n));
            sums.add(&scene.tiles.tiles[number].double, position, &scene.double);
        }
    }
    let solution = Solution::new(&sums, fixed);
    for lane in (0..LANES).filter(|&lane| verdict.coarse[lane]) {
        let pdop = solution.pdop.0[lane];
        let solved = pdop < f64::NO_SOLUTION && pdop <= scene.limits.cap;
        out.pdop[number].0[lane] = if solved { pdop as f32 } else { UNSOLVED };
        out.available += u64::from(solved && pdop <= scene.limits.available);
        out.doubled += 1;
    }
}
