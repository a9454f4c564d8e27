//! One design on its way through the samples.

use super::order::BadTile;
use super::rules::{BadSample, Proof, RuleSet, SUM_MARGIN, SampleRule};
use super::tail::TailCounts;
use crate::evaluate::SampleTile;

/// Tiles between two looks at the tail, which takes as long as several tiles.
const TAIL_EVERY: usize = 64;

/// The proof that a design violates a constraint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rejection {
    /// Place of the constraint.
    pub(super) constraint: usize,
    /// The sample that proves it alone: point and instant.
    pub(super) sample: Option<(usize, usize)>,
    /// Share of the samples, by weight, that were bad by then.
    pub(super) bad_share: Option<f64>,
    /// What the quantity is at best.
    pub(super) value: Option<f64>,
}

/// The samples of a design so far.
pub(super) struct Trial<'a> {
    set: &'a RuleSet,
    /// Weight of the bad samples of each rule.
    bad: Vec<u64>,
    seen: u64,
    unsolved: u64,
    sum: f64,
    tail: Option<TailCounts>,
    runs: Option<Runs>,
    /// The least PDOP that a sample can have.
    least: f64,
    tiles: usize,
    rejection: Option<Rejection>,
    /// Tiles seen when it was rejected.
    tiles_at_rejection: usize,
    /// Where the bad samples are.
    pub(super) bad_tiles: Vec<BadTile>,
}

impl<'a> Trial<'a> {
    /// Nothing seen of a design of so many satellites, GNSS not included.
    pub(super) fn new(set: &'a RuleSet, satellites: usize) -> Self {
        let runs = set.has_runs().then(|| Runs::new(set));
        let most = (satellites + set.gnss).max(1) as f64;
        let mut trial = Self {
            set,
            bad: vec![0; set.rules.len()],
            seen: 0,
            unsolved: 0,
            sum: 0.0,
            tail: set.has_tail().then(TailCounts::new),
            runs,
            least: set.least_pdop / most.sqrt(),
            tiles: 0,
            rejection: None,
            tiles_at_rejection: 0,
            bad_tiles: Vec::new(),
        };
        trial.rejection = trial.beforehand();
        trial
    }

    /// The first proof, if there is one.
    pub(super) fn rejection(&self) -> Option<Rejection> {
        self.rejection
    }

    /// Tiles seen.
    pub(super) fn tiles(&self) -> usize {
        self.tiles
    }

    /// Tiles seen when the proof was found.
    pub(super) fn tiles_at_rejection(&self) -> usize {
        self.tiles_at_rejection
    }

    /// What follows from the number of satellites alone, since no geometry of them is good enough.
    fn beforehand(&self) -> Option<Rejection> {
        let least = self.least as f32;
        let none_is_good = |rule: &&SampleRule| match rule.proof {
            Proof::Count { bad, allowed } => {
                let too_large = match bad {
                    BadSample::Unavailable(up_to) => least.next_down() > up_to,
                    BadSample::Above(above) => least.next_down() > above,
                    _ => false,
                };
                too_large && allowed < self.set.shape.total_weight
            }
            Proof::Quantile { above, .. } => {
                matches!(above, BadSample::Above(above) if least.next_down() > above)
            }
            Proof::Mean { bound } | Proof::Tail { bound } => self.least > beyond(bound, SUM_MARGIN),
            Proof::MeanAndTail { bound, weight } => {
                self.least * (1.0 + weight) > beyond(bound, SUM_MARGIN)
            }
            Proof::Run { .. } => false,
        };
        let rule = self.set.rules.iter().find(none_is_good)?;
        Some(Rejection {
            constraint: rule.constraint,
            sample: None,
            bad_share: None,
            value: None,
        })
    }

    /// Takes the samples of a tile.
    pub(super) fn see(&mut self, tile: &SampleTile<'_>) {
        let place = self.tiles as u32;
        self.tiles += 1;
        let mut worst = 0;
        self.seen += tile.weights.iter().sum::<u64>();
        if self.set.sums_pdop() {
            self.add_pdop(tile);
        }
        for number in 0..self.set.rules.len() {
            let rule = self.set.rules[number];
            let bad = self.bad_samples(number, tile);
            worst = worst.max(bad);
            if self.rejection.is_none() {
                self.rejection = self.proof(number, rule, tile);
                self.tiles_at_rejection = self.tiles;
            }
        }
        if worst > 0 {
            self.bad_tiles.push((place, worst));
        }
    }

    fn add_pdop(&mut self, tile: &SampleTile<'_>) {
        for (&pdop, &weight) in tile.pdop.iter().zip(tile.weights) {
            if pdop < f32::INFINITY {
                self.sum += weight as f64 * f64::from(pdop);
                if let Some(tail) = &mut self.tail {
                    tail.add(pdop, weight);
                }
            }
        }
    }

    /// Counts what is bad for a rule, and returns the number of samples.
    fn bad_samples(&mut self, number: usize, tile: &SampleTile<'_>) -> u16 {
        let bad = match self.set.rules[number].proof {
            Proof::Count { bad, .. } => bad,
            Proof::Quantile { above, .. } => above,
            Proof::Mean { bound } | Proof::Tail { bound } | Proof::MeanAndTail { bound, .. } => {
                BadSample::Above(bound as f32)
            }
            Proof::Run { .. } => BadSample::Unavailable(self.set.shape.available_up_to),
        };
        let (weight, samples) = bad.count(tile);
        self.bad[number] += weight;
        if bad == BadSample::Unsolved {
            self.unsolved = self.bad[number];
        }
        samples
    }

    /// Whether a rule rejects the design by now.
    fn proof(
        &mut self,
        number: usize,
        rule: SampleRule,
        tile: &SampleTile<'_>,
    ) -> Option<Rejection> {
        let total = self.set.shape.total_weight;
        let bad = self.bad[number];
        let rejection = Rejection {
            constraint: rule.constraint,
            sample: None,
            bad_share: None,
            value: None,
        };
        let share = bad as f64 / total as f64;
        match rule.proof {
            Proof::Count { bad: kind, allowed } => (bad > allowed).then(|| Rejection {
                sample: (allowed == 0).then(|| kind.first(tile)).flatten(),
                bad_share: Some(share),
                value: kind.value(tile, allowed, 1.0 - share),
                ..rejection
            }),
            Proof::Quantile { level, .. } => {
                // The most that a quantile of the solved samples leaves above it; its rank has a slack of 1e-9 of a
                // sample.
                let solved = (total - self.unsolved) as f64;
                let spare = (1.0 - level + SUM_MARGIN) * solved;
                (bad as f64 > spare).then_some(Rejection {
                    bad_share: Some(share),
                    ..rejection
                })
            }
            Proof::Mean { bound } => {
                let mean = self.least_mean();
                (mean > beyond(bound, SUM_MARGIN)).then_some(Rejection {
                    value: Some(mean),
                    ..rejection
                })
            }
            Proof::Tail { .. } | Proof::MeanAndTail { .. } => {
                let value = self.least_of_tail(rule.proof)?;
                Some(Rejection {
                    value: Some(value),
                    ..rejection
                })
            }
            Proof::Run { samples } => {
                let (site, run) = self.runs.as_mut()?.see(tile, self.set, samples)?;
                Some(Rejection {
                    sample: Some((site, tile.instant)),
                    value: Some(f64::from(run) * self.set.step_s),
                    ..rejection
                })
            }
        }
    }

    /// The mean PDOP if the rest is as good as it can be.
    fn least_mean(&self) -> f64 {
        let total = self.set.shape.total_weight;
        let rest = (total - self.seen) as f64;
        (self.sum + rest * self.least) / total as f64
    }

    /// The tail, alone or with the mean, if it is beyond its bound already.
    fn least_of_tail(&self, proof: Proof) -> Option<f64> {
        let tail = self.tail.as_ref()?;
        if !self.tiles.is_multiple_of(TAIL_EVERY) {
            return None;
        }
        let share = (1.0 - self.set.tail_level) * self.set.shape.total_weight as f64;
        let least = tail.mean_of_worst(share, self.least);
        let (value, bound) = match proof {
            Proof::Tail { bound } => (least, bound),
            Proof::MeanAndTail { bound, weight } => (self.least_mean() + weight * least, bound),
            _ => return None,
        };
        (value > beyond(bound, SUM_MARGIN)).then_some(value)
    }
}

/// A bound with a margin, relative to its size.
fn beyond(bound: f64, margin: f64) -> f64 {
    bound + bound.abs() * margin
}

impl BadSample {
    /// Weight and number of the bad samples of a tile.
    fn count(self, tile: &SampleTile<'_>) -> (u64, u16) {
        let pdop = tile.pdop.iter().copied();
        let leo = tile.leo.iter().copied();
        match self {
            Self::Unavailable(up_to) => weigh(tile, pdop.map(|pdop| pdop > up_to)),
            Self::Unsolved => weigh(tile, pdop.map(|pdop| pdop == f32::INFINITY)),
            Self::Above(above) => {
                let is_above = |pdop: f32| (pdop > above) & (pdop < f32::INFINITY);
                weigh(tile, pdop.map(is_above))
            }
            Self::FewerLeo(least) => weigh(tile, leo.map(|seen| seen < least)),
            Self::FewerTotal(least) => {
                let both = leo.zip(tile.gnss.iter().copied());
                weigh(tile, both.map(|(leo, gnss)| leo + u32::from(gnss) < least))
            }
        }
    }

    /// The first point of a tile that is bad, with its instant.
    fn first(self, tile: &SampleTile<'_>) -> Option<(usize, usize)> {
        let is_bad = |lane: usize| {
            let one = SampleTile {
                points: &tile.points[lane..=lane],
                weights: &tile.weights[lane..=lane],
                pdop: &tile.pdop[lane..=lane],
                leo: &tile.leo[lane..=lane],
                gnss: &tile.gnss[lane..=lane],
                ..*tile
            };
            self.count(&one).0 > 0
        };
        let lane = (0..tile.points.len()).find(|lane| is_bad(*lane))?;
        Some((tile.points[lane] as usize, tile.instant))
    }

    /// What the quantity is at best: a share of good samples, or the value in the one sample that is bad.
    fn value(self, tile: &SampleTile<'_>, allowed: u64, good: f64) -> Option<f64> {
        let in_first = |values: &dyn Fn(usize) -> f64| {
            let (site, _) = self.first(tile)?;
            let lane = tile.points.iter().position(|one| *one as usize == site)?;
            Some(values(lane))
        };
        match self {
            Self::Unsolved => None,
            Self::Above(_) => in_first(&|lane| f64::from(tile.pdop[lane])),
            Self::FewerLeo(_) if allowed == 0 => in_first(&|lane| f64::from(tile.leo[lane])),
            _ => Some(good),
        }
    }
}

/// Weight and number of the samples of a tile that are bad; a place without a point weighs nothing.
fn weigh(tile: &SampleTile<'_>, is_bad: impl Iterator<Item = bool>) -> (u64, u16) {
    let mut sum = (0, 0);
    for (is_bad, &weight) in is_bad.zip(tile.weights) {
        sum.0 += if is_bad { weight } else { 0 };
        sum.1 += u16::from(is_bad & (weight > 0));
    }
    sum
}

/// The unavailable samples of each point, one bit an instant.
struct Runs {
    words: usize,
    bits: Vec<u64>,
}

impl Runs {
    fn new(set: &RuleSet) -> Self {
        let words = set.shape.instants.div_ceil(64);
        Self {
            words,
            bits: vec![0; words * set.sites],
        }
    }

    /// Notes a tile, and returns the first point with a run of so many samples, and its length.
    fn see(&mut self, tile: &SampleTile<'_>, set: &RuleSet, samples: u32) -> Option<(usize, u32)> {
        let mut found = None;
        for (&site, &pdop) in tile.points.iter().zip(tile.pdop) {
            if pdop > set.shape.available_up_to {
                let run = self.note(site as usize, tile.instant);
                if run >= samples && found.is_none() {
                    found = Some((site as usize, run));
                }
            }
        }
        found
    }

    /// Notes a sample, and returns the length of the run that it is in.
    fn note(&mut self, site: usize, instant: usize) -> u32 {
        let row = &mut self.bits[site * self.words..(site + 1) * self.words];
        row[instant / 64] |= 1 << (instant % 64);
        let is_out = |n: &usize| {
            row.get(n / 64)
                .is_some_and(|word| word >> (n % 64) & 1 == 1)
        };
        let before = (0..instant).rev().take_while(is_out).count();
        let after = (instant + 1..).take_while(is_out).count();
        (before + 1 + after) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_join_across_words() {
        let mut runs = Runs {
            words: 3,
            bits: vec![0; 6],
        };
        let noted = [62, 64, 63, 130, 61, 128, 65, 129].map(|instant| runs.note(1, instant));
        assert_eq!(noted, [1, 1, 3, 1, 4, 1, 5, 3]);
        assert_eq!(runs.note(0, 63), 1);
    }
}
