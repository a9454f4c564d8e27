//! The metrics without a set of satellites, from those of the whole constellation and the samples that change.
//!
//! PDOP is counted once in buckets of its leading bits. Without a set, the samples that change move to other buckets; then
//! only the values in buckets that hold a wanted rank are sorted.

use crate::evaluate::counts::{LongestOutage, Outages};
use crate::evaluate::histograms::ViewBins;
use crate::evaluate::kernel::{ChangedSample, SampleLosses, WholeSample, quantile_rank};
use crate::evaluate::metrics::Evaluated;
use crate::evaluate::{Evaluator, Metrics};
use crate::stats::Summary;
use std::cmp::Ordering;
use std::sync::OnceLock;

/// Bits of an f64 that a bucket ignores: it uses 10 of the 52 bits of the fraction.
const TRAILING_BITS: u32 = 42;

/// Wanted order statistics: median, 95 %, 99 %, maximum, value-at-risk.
const WANTED: usize = 5;
const VALUE_AT_RISK: usize = 4;

/// Marks the buckets beyond that of the value-at-risk.
const BEYOND: u8 = 1 << WANTED;

/// A weight in f64. That of a signed number is one instruction everywhere; a weight is below 2⁶².
#[inline(always)]
fn real(weight: u64) -> f64 {
    weight as i64 as f64
}

/// All samples with all satellites.
pub(super) struct Whole<'a> {
    evaluator: &'a Evaluator,
    pieces: &'a [SampleLosses],
    samples: Vec<WholeSample>,
    leo: ViewBins,
    all: ViewBins,
    buckets: Buckets,
    totals: Totals,
    /// Whether a sample is unsolved or above the availability threshold, point by point.
    is_out: Vec<bool>,
    outages: Vec<Outages>,
}

/// Sums over samples.
#[derive(Debug, Clone, Copy, Default)]
struct Totals {
    /// Number of solved samples.
    number: u64,
    /// Weight of the solved samples.
    solved: u64,
    /// Weight of the available samples.
    available: u64,
    /// Weight times PDOP of the solved samples.
    sum: f64,
}

/// The solved samples by the leading bits of their PDOP.
struct Buckets {
    /// Leading bits of the first bucket.
    first: u64,
    /// Weight of the samples in each bucket.
    weights: Vec<u64>,
    /// Weight times PDOP of the samples in each bucket and all later ones.
    sums_from: Vec<f64>,
    /// The samples, bucket by bucket, and where those of each bucket begin.
    members: Vec<u32>,
    begins: Vec<usize>,
    /// Those of a bucket in rising order, once it is wanted.
    ordered: Vec<OnceLock<Vec<BucketValue>>>,
}

/// A value of PDOP in a bucket.
#[derive(Debug, Clone, Copy)]
struct BucketValue {
    pdop: f64,
    sample: u32,
    weight: u64,
}

impl BucketValue {
    /// By the value, and of equal ones by the sample.
    fn order(&self, other: &Self) -> Ordering {
        let by_value = self.pdop.total_cmp(&other.pdop);
        by_value.then(self.sample.cmp(&other.sample))
    }
}

fn leading_bits(pdop: f64) -> u64 {
    pdop.to_bits() >> TRAILING_BITS
}

impl Buckets {
    /// The bucket of a solved value. Without satellites PDOP rises, but for rounding.
    #[inline(always)]
    fn of(&self, pdop: f64) -> usize {
        leading_bits(pdop).saturating_sub(self.first) as usize
    }

    /// Of the values of the whole constellation, with room for values up to the largest of others.
    fn new(
        samples: &[WholeSample],
        mut largest: f64,
        weight: impl Fn(&WholeSample) -> u64,
    ) -> Self {
        let solved = || (0..).zip(samples).filter(|(_, one)| one.pdop.is_finite());
        let mut least = f64::INFINITY;
        for (_, one) in solved() {
            (least, largest) = (least.min(one.pdop), largest.max(one.pdop));
        }
        if least > largest {
            (least, largest) = (1.0, 1.0);
        }
        let first = leading_bits(least);
        let count = (leading_bits(largest) - first) as usize + 1;
        let mut buckets = Self {
            first,
            weights: vec![0; count],
            sums_from: vec![0.0; count + 1],
            members: vec![0; solved().count()],
            begins: vec![0; count + 1],
            ordered: vec![OnceLock::new(); count],
        };
        for (_, one) in solved() {
            let bucket = buckets.of(one.pdop);
            buckets.weights[bucket] += weight(one);
            buckets.sums_from[bucket] += weight(one) as f64 * one.pdop;
            buckets.begins[bucket + 1] += 1;
        }
        for bucket in 0..count {
            buckets.begins[bucket + 1] += buckets.begins[bucket];
        }
        for bucket in (0..count).rev() {
            buckets.sums_from[bucket] += buckets.sums_from[bucket + 1];
        }
        let mut next = buckets.begins.clone();
        for (sample, one) in solved() {
            let place = &mut next[buckets.of(one.pdop)];
            buckets.members[*place] = sample;
            *place += 1;
        }
        buckets
    }
}

/// Memory for one set after the other.
pub(super) struct Scratch {
    weights: Vec<u64>,
    /// A bit for each rank that is wanted of a bucket, and [`BEYOND`]; none for the place after all buckets.
    wanted: Vec<u8>,
    /// The buckets that each sample that changes leaves and arrives in; the place after all buckets if it is unsolved.
    moved: Vec<(u32, u32)>,
    /// Samples whose availability changes, and whether one does, point by point.
    turned: Vec<u32>,
    is_turned: Vec<bool>,
    /// The values of a bucket.
    values: Vec<BucketValue>,
}

impl Scratch {
    pub(super) fn new(whole: &Whole<'_>) -> Self {
        Self {
            weights: Vec::new(),
            wanted: vec![0; whole.buckets.weights.len() + 1],
            moved: Vec::new(),
            turned: Vec::new(),
            is_turned: vec![false; whole.samples.len()],
            values: Vec::new(),
        }
    }
}

/// What leaves a bucket and what arrives there without a set.
#[derive(Default)]
struct BucketMoves {
    gone: Vec<BucketValue>,
    arrived: Vec<BucketValue>,
}

/// A wanted rank, the bucket that holds it, and the weight of the buckets before.
#[derive(Debug, Clone, Copy, Default)]
struct WantedRank {
    rank: u64,
    bucket: usize,
    before: u64,
}

impl<'a> Whole<'a> {
    pub(super) fn new(evaluator: &'a Evaluator, pieces: &'a [SampleLosses]) -> Self {
        let setup = evaluator.setup();
        let samples: Vec<WholeSample> = pieces
            .iter()
            .flat_map(|piece| &piece.whole)
            .copied()
            .collect();
        let (mut leo, mut all) = (ViewBins::default(), ViewBins::default());
        let weight = |one: &WholeSample| evaluator.weights.of(one.site as usize);
        let available_up_to = setup.metrics.availability_pdop;
        let mut totals = Totals::default();
        let mut is_out = vec![false; samples.len()];
        let instants = setup.grid.len();
        for (instant, points) in samples.chunks(setup.sites.len()).enumerate() {
            for one in points {
                let weight = weight(one);
                let visible = u32::from(one.visible);
                leo.add(visible, weight);
                all.add(visible + u32::from(one.gnss_visible), weight);
                let is_available = one.pdop <= available_up_to;
                totals.available += if is_available { weight } else { 0 };
                is_out[one.site as usize * instants + instant] = !is_available;
                if one.pdop.is_finite() {
                    totals.number += 1;
                    totals.solved += weight;
                    totals.sum += weight as f64 * one.pdop;
                }
            }
        }
        let largest = pieces.iter().map(|piece| piece.largest);
        let buckets = Buckets::new(&samples, largest.fold(0.0, f64::max), weight);
        let points = is_out.chunks(instants);
        Self {
            outages: points
                .map(|point| Outages::of(point.iter().copied()))
                .collect(),
            evaluator,
            pieces,
            samples,
            leo,
            all,
            buckets,
            totals,
            is_out,
        }
    }

    /// The samples that change without a set, in order.
    fn changed(&self, set: usize) -> impl Iterator<Item = &'a ChangedSample> {
        self.pieces
            .iter()
            .flat_map(move |piece| &piece.changed[set])
    }

    fn weight(&self, one: &WholeSample) -> u64 {
        self.evaluator.weights.of(one.site as usize)
    }

    /// The metrics without a set, of so many satellites that are left.
    pub(super) fn without(&self, set: usize, satellites: usize, scratch: &mut Scratch) -> Metrics {
        let setup = self.evaluator.setup();
        let available_up_to = setup.metrics.availability_pdop;
        let (mut leo, mut all) = (self.leo.clone(), self.all.clone());
        let mut totals = self.totals;
        scratch.weights.clone_from(&self.buckets.weights);
        let unsolved = scratch.weights.len() as u32;
        scratch.moved.clear();
        // Sums in variables of their own stay in registers.
        let (mut sum, mut number, mut solved) = (totals.sum, totals.number, totals.solved);
        let weights = scratch.weights.as_mut_slice();
        for one in self.changed(set) {
            let whole = &self.samples[one.sample as usize];
            let (weight, old, new) = (self.weight(whole), whole.pdop, one.pdop);
            let visible = u32::from(whole.visible);
            let in_all = visible + u32::from(whole.gnss_visible);
            leo.shift(visible, visible.saturating_sub(one.missing), weight);
            all.shift(in_all, in_all.saturating_sub(one.missing), weight);
            let (mut from, mut to) = (unsolved, unsolved);
            if old < f64::INFINITY {
                let bucket = self.buckets.of(old);
                weights[bucket] -= weight;
                from = bucket as u32;
                number -= 1;
                solved -= weight;
                sum -= real(weight) * old;
            }
            if new < f64::INFINITY {
                let bucket = self.buckets.of(new);
                weights[bucket] += weight;
                to = bucket as u32;
                number += 1;
                solved += weight;
                sum += real(weight) * new;
            }
            scratch.moved.push((from, to));
            let (was_available, is_available) = (old <= available_up_to, new <= available_up_to);
            if was_available != is_available {
                scratch.turned.push(one.sample);
                match is_available {
                    true => totals.available += weight,
                    false => totals.available -= weight,
                }
            }
        }
        (totals.sum, totals.number, totals.solved) = (sum, number, solved);
        let share = |weight: u64| weight as f64 / self.evaluator.weights.total() as f64;
        let evaluated = Evaluated {
            leo: leo.views(),
            all: all.views(),
            bins: None,
            solved: share(totals.solved),
            available: share(totals.available),
            longest_outage: self.longest_outage(scratch),
            summary: self.summary(set, &totals, scratch),
        };
        Metrics::new(&evaluated, setup.metrics, satellites, setup.grid.step_s())
    }

    /// The longest outage where the availability of some samples turns; they are cleared.
    fn longest_outage(&self, scratch: &mut Scratch) -> LongestOutage {
        let setup = self.evaluator.setup();
        let (sites, instants) = (setup.sites.len(), setup.grid.len());
        let Scratch {
            turned, is_turned, ..
        } = scratch;
        let site = |sample: u32| self.samples[sample as usize].site as usize;
        let place = |sample: u32| site(sample) * instants + sample as usize / sites;
        let mut affected = vec![false; sites];
        for &sample in turned.iter() {
            is_turned[place(sample)] = true;
            affected[site(sample)] = true;
        }
        let points = self.outages.iter().zip(affected).enumerate();
        let longest = LongestOutage::of(points.map(|(site, (known, is_affected))| {
            if !is_affected {
                return *known;
            }
            let own = site * instants..(site + 1) * instants;
            let samples = self.is_out[own.clone()].iter().zip(&is_turned[own]);
            Outages::of(samples.map(|(is_out, is_turned)| is_out ^ is_turned))
        }));
        for sample in turned.drain(..) {
            is_turned[place(sample)] = false;
        }
        longest
    }

    fn summary(&self, set: usize, totals: &Totals, scratch: &mut Scratch) -> Option<Summary> {
        if totals.number == 0 {
            return None;
        }
        let level = self.evaluator.setup().metrics.cvar_level.get();
        let ranked = |q: f64| quantile_rank(q, totals.solved, totals.number);
        let ranks = [
            ranked(0.50),
            ranked(0.95),
            ranked(0.99),
            totals.solved,
            ranked(level),
        ];
        let wanted = locate(ranks, &scratch.weights);
        let at_risk = wanted[VALUE_AT_RISK];
        let (moves, tail) = self.moves(set, &wanted, scratch);
        let mut found = [0.0; WANTED];
        for ((found, moves), wanted) in found.iter_mut().zip(moves).zip(&wanted) {
            scratch.fill(self.ordered(wanted.bucket), moves);
            *found = pick(&scratch.values, *wanted);
        }
        // The values of the bucket of the value-at-risk are the last.
        let value_at_risk = found[VALUE_AT_RISK];
        let in_bucket: u64 = scratch.values.iter().map(|one| one.weight).sum();
        let beyond = totals.solved - at_risk.before - in_bucket;
        let nearby = scratch
            .values
            .iter()
            .map(|one| (one.pdop - value_at_risk).max(0.0) * one.weight as f64);
        let excess = tail - beyond as f64 * value_at_risk + nearby.sum::<f64>();
        let [p50, p95, p99, max, _] = found;
        Some(Summary {
            mean: totals.sum / totals.solved as f64,
            p50,
            p95,
            p99,
            max,
            cvar: value_at_risk + excess / ((1.0 - level) * totals.solved as f64),
        })
    }

    /// What leaves the wanted buckets and arrives there without a set, and the sum of weight times PDOP beyond the bucket of the
    /// value-at-risk.
    fn moves(
        &self,
        set: usize,
        wanted: &[WantedRank; WANTED],
        scratch: &mut Scratch,
    ) -> ([BucketMoves; WANTED], f64) {
        let mut moves: [BucketMoves; WANTED] = Default::default();
        let at_risk = wanted[VALUE_AT_RISK].bucket;
        let (marks, moved) = (&mut scratch.wanted, &scratch.moved);
        let beyond = at_risk + 1..marks.len() - 1;
        marks[beyond.clone()].fill(BEYOND);
        for (number, one) in wanted.iter().enumerate() {
            marks[one.bucket] |= 1 << number;
        }
        let mut tail = self.buckets.sums_from[at_risk + 1];
        for (one, (from, to)) in self.changed(set).zip(moved) {
            let (from, to) = (marks[*from as usize], marks[*to as usize]);
            // Most samples stay among those that nothing asks for.
            if from | to == 0 {
                continue;
            }
            let whole = &self.samples[one.sample as usize];
            let weight = self.weight(whole);
            let value = |pdop| BucketValue {
                pdop,
                sample: one.sample,
                weight,
            };
            if from & BEYOND != 0 {
                tail -= real(weight) * whole.pdop;
            }
            for_bits(from, |n| moves[n].gone.push(value(whole.pdop)));
            if to & BEYOND != 0 {
                tail += real(weight) * one.pdop;
            }
            for_bits(to, |n| moves[n].arrived.push(value(one.pdop)));
        }
        marks[beyond].fill(0);
        wanted.iter().for_each(|one| marks[one.bucket] = 0);
        (moves, tail)
    }

    /// The values of a bucket with all satellites, in rising order.
    fn ordered(&self, bucket: usize) -> &[BucketValue] {
        self.buckets.ordered[bucket].get_or_init(|| {
            let begins = &self.buckets.begins;
            let members = &self.buckets.members[begins[bucket]..begins[bucket + 1]];
            let value = |&sample: &u32| {
                let one = &self.samples[sample as usize];
                BucketValue {
                    pdop: one.pdop,
                    sample,
                    weight: self.weight(one),
                }
            };
            let mut values: Vec<BucketValue> = members.iter().map(value).collect();
            values.sort_unstable_by(BucketValue::order);
            values
        })
    }
}

/// Calls `each` with the numbers of the bits that are set.
#[inline(always)]
fn for_bits(bits: u8, each: impl FnMut(usize)) {
    (0..WANTED).filter(|n| bits >> n & 1 == 1).for_each(each);
}

impl Scratch {
    /// Takes the values of a bucket that stay, and those that arrive, in rising order.
    fn fill(&mut self, ordered: &[BucketValue], mut moves: BucketMoves) {
        moves.gone.sort_unstable_by(BucketValue::order);
        moves.arrived.sort_unstable_by(BucketValue::order);
        let mut gone = moves.gone.iter().peekable();
        let mut arrived = moves.arrived.into_iter().peekable();
        self.values.clear();
        for one in ordered {
            if gone.next_if(|gone| gone.sample == one.sample).is_some() {
                continue;
            }
            let is_before = |new: &BucketValue| new.order(one) == Ordering::Less;
            while let Some(new) = arrived.next_if(is_before) {
                self.values.push(new);
            }
            self.values.push(*one);
        }
        self.values.extend(arrived);
    }
}

/// The value of a rank among those of its bucket, in rising order.
fn pick(values: &[BucketValue], wanted: WantedRank) -> f64 {
    let mut reached = wanted.before;
    let found = values.iter().find(|one| {
        reached += one.weight;
        reached >= wanted.rank
    });
    found.map_or(f64::NAN, |one| one.pdop)
}

/// Finds the buckets of some ranks.
fn locate(ranks: [u64; WANTED], weights: &[u64]) -> [WantedRank; WANTED] {
    let mut wanted = ranks.map(|rank| WantedRank {
        rank,
        ..WantedRank::default()
    });
    let mut order: [usize; WANTED] = std::array::from_fn(|number| number);
    order.sort_unstable_by_key(|number| ranks[*number]);
    let mut order = order.into_iter().peekable();
    let mut before = 0;
    for (bucket, weight) in weights.iter().enumerate() {
        while let Some(number) = order.next_if(|number| ranks[*number] <= before + weight) {
            wanted[number].bucket = bucket;
            wanted[number].before = before;
        }
        before += weight;
    }
    wanted
}
