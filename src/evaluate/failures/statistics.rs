//! The metrics without a set of satellites, from those of the whole constellation and the samples that change.
//!
//! PDOP is counted once in buckets of its leading bits. Without a set, the samples that change move to other buckets; then
//! only the values in buckets that hold a wanted rank are sorted.

use super::pass::{ChangedSample, PassPiece};
use crate::ephemeris::Ephemeris;
use crate::evaluate::counts::{LongestOutage, Outages, Views};
use crate::evaluate::kernel::quantile_rank;
use crate::evaluate::metrics::Evaluated;
use crate::evaluate::{Evaluator, Metrics};
use crate::stats::Summary;

/// Bits of an f64 that a bucket ignores: it uses 10 of the 52 bits of the fraction.
const TRAILING_BITS: u32 = 42;

/// Wanted order statistics: median, 95 %, 99 %, maximum, value-at-risk.
const WANTED: usize = 5;
const VALUE_AT_RISK: usize = 4;

/// All samples with all satellites.
pub(super) struct Whole<'a> {
    evaluator: &'a Evaluator,
    pieces: &'a [PassPiece],
    /// PDOP, infinite if unsolved, and what is visible.
    pdop: Vec<f64>,
    visible: Vec<u32>,
    gnss_visible: Vec<u32>,
    leo: Views,
    all: Views,
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
}

fn leading_bits(pdop: f64) -> u64 {
    pdop.to_bits() >> TRAILING_BITS
}

impl Buckets {
    fn of(&self, pdop: f64) -> usize {
        (leading_bits(pdop) - self.first) as usize
    }

    /// Of the values of the whole constellation, with room for all others.
    fn new(pdop: &[f64], others: impl Iterator<Item = f64>, weight: impl Fn(usize) -> u64) -> Self {
        let solved = || pdop.iter().copied().filter(|value| value.is_finite());
        let (mut least, mut largest) = (f64::INFINITY, 0.0_f64);
        for value in solved().chain(others.filter(|value| value.is_finite())) {
            (least, largest) = (least.min(value), largest.max(value));
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
        };
        for (sample, &value) in pdop
            .iter()
            .enumerate()
            .filter(|(_, value)| value.is_finite())
        {
            let bucket = buckets.of(value);
            buckets.weights[bucket] += weight(sample);
            buckets.sums_from[bucket] += weight(sample) as f64 * value;
            buckets.begins[bucket + 1] += 1;
        }
        for bucket in 0..count {
            buckets.begins[bucket + 1] += buckets.begins[bucket];
        }
        for bucket in (0..count).rev() {
            buckets.sums_from[bucket] += buckets.sums_from[bucket + 1];
        }
        let mut next = buckets.begins.clone();
        for (sample, &value) in (0..).zip(pdop).filter(|(_, value)| value.is_finite()) {
            let place = &mut next[buckets.of(value)];
            buckets.members[*place] = sample;
            *place += 1;
        }
        buckets
    }
}

/// Memory for one set after the other.
pub(super) struct Scratch {
    weights: Vec<u64>,
    /// The mark of the set without which a sample changes.
    changed_by: Vec<u32>,
    mark: u32,
    /// Samples whose availability changes, and whether one does, point by point.
    turned: Vec<u32>,
    is_turned: Vec<bool>,
    /// Values and weights of a bucket.
    values: Vec<(f64, u64)>,
}

impl Scratch {
    pub(super) fn new(whole: &Whole<'_>) -> Self {
        Self {
            weights: Vec::new(),
            changed_by: vec![0; whole.pdop.len()],
            mark: 0,
            turned: Vec::new(),
            is_turned: vec![false; whole.pdop.len()],
            values: Vec::new(),
        }
    }
}

/// A wanted rank, the bucket that holds it, and the weight of the buckets before.
#[derive(Debug, Clone, Copy, Default)]
struct WantedRank {
    rank: u64,
    bucket: usize,
    before: u64,
}

impl<'a> Whole<'a> {
    pub(super) fn new(
        evaluator: &'a Evaluator,
        ephemeris: &Ephemeris,
        pieces: &'a [PassPiece],
    ) -> Self {
        let setup = evaluator.setup();
        let sites = setup.sites.len();
        let joined = |of: fn(&PassPiece) -> &Vec<u32>| -> Vec<u32> {
            pieces.iter().flat_map(of).copied().collect()
        };
        let pdop: Vec<f64> = pieces
            .iter()
            .flat_map(|piece| &piece.pdop)
            .copied()
            .collect();
        let (visible, gnss_visible) = (
            joined(|piece| &piece.visible),
            joined(|piece| &piece.gnss_visible),
        );
        let satellites = ephemeris.satellites().len();
        let (mut leo, mut all) = (
            Views::new(satellites),
            Views::new(satellites + evaluator.gnss_count()),
        );
        let weight = |sample: usize| evaluator.weights.of(sample % sites);
        let available_up_to = setup.metrics.availability_pdop;
        let mut totals = Totals::default();
        let mut is_out = vec![false; pdop.len()];
        let instants = setup.grid.len();
        for (sample, &value) in pdop.iter().enumerate() {
            let weight = weight(sample);
            leo.add(visible[sample], weight);
            all.add(visible[sample] + gnss_visible[sample], weight);
            let is_available = value <= available_up_to;
            totals.available += if is_available { weight } else { 0 };
            is_out[sample % sites * instants + sample / sites] = !is_available;
            if value.is_finite() {
                totals.number += 1;
                totals.solved += weight;
                totals.sum += weight as f64 * value;
            }
        }
        let changed = pieces.iter().flat_map(|piece| &piece.changed).flatten();
        let buckets = Buckets::new(&pdop, changed.map(|one| one.pdop), weight);
        let points = is_out.chunks(instants);
        Self {
            outages: points
                .map(|point| Outages::of(point.iter().copied()))
                .collect(),
            evaluator,
            pieces,
            pdop,
            visible,
            gnss_visible,
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

    fn weight(&self, sample: u32) -> u64 {
        let sites = self.evaluator.setup().sites.len();
        self.evaluator.weights.of(sample as usize % sites)
    }

    /// The metrics without a set, of so many satellites that are left.
    pub(super) fn without(&self, set: usize, satellites: usize, scratch: &mut Scratch) -> Metrics {
        let setup = self.evaluator.setup();
        let available_up_to = setup.metrics.availability_pdop;
        let (mut leo, mut all) = (self.leo.clone(), self.all.clone());
        let mut totals = self.totals;
        scratch.mark += 1;
        scratch.weights.clone_from(&self.buckets.weights);
        for one in self.changed(set) {
            let sample = one.sample as usize;
            let weight = self.weight(one.sample);
            let (old, visible) = (self.pdop[sample], self.visible[sample]);
            let in_all = visible + self.gnss_visible[sample];
            leo.shift(visible, visible - one.missing, weight);
            all.shift(in_all, in_all - one.missing, weight);
            scratch.changed_by[sample] = scratch.mark;
            if old.is_finite() {
                scratch.weights[self.buckets.of(old)] -= weight;
                totals.number -= 1;
                totals.solved -= weight;
                totals.sum -= weight as f64 * old;
            }
            if one.pdop.is_finite() {
                scratch.weights[self.buckets.of(one.pdop)] += weight;
                totals.number += 1;
                totals.solved += weight;
                totals.sum += weight as f64 * one.pdop;
            }
            match (old <= available_up_to, one.pdop <= available_up_to) {
                (true, false) => totals.available -= weight,
                (false, true) => totals.available += weight,
                _ => continue,
            }
            scratch.turned.push(one.sample);
        }
        let share = |weight: u64| weight as f64 / self.evaluator.weights.total() as f64;
        let evaluated = Evaluated {
            leo,
            all,
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
        let place = |sample: u32| sample as usize % sites * instants + sample as usize / sites;
        let mut affected = vec![false; sites];
        for &sample in turned.iter() {
            is_turned[place(sample)] = true;
            affected[sample as usize % sites] = true;
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
        // Of the buckets beyond that of the value-at-risk.
        let mut tail = self.buckets.sums_from[at_risk.bucket + 1];
        let mut arrived: [Vec<(f64, u64)>; WANTED] = Default::default();
        for one in self.changed(set) {
            let weight = self.weight(one.sample);
            let old = self.pdop[one.sample as usize];
            if old.is_finite() && self.buckets.of(old) > at_risk.bucket {
                tail -= weight as f64 * old;
            }
            if !one.pdop.is_finite() {
                continue;
            }
            let bucket = self.buckets.of(one.pdop);
            if bucket > at_risk.bucket {
                tail += weight as f64 * one.pdop;
            }
            for (arrived, wanted) in arrived.iter_mut().zip(&wanted) {
                if wanted.bucket == bucket {
                    arrived.push((one.pdop, weight));
                }
            }
        }
        let mut found = [0.0; WANTED];
        for (number, arrived) in arrived.into_iter().enumerate() {
            let wanted = wanted[number];
            scratch.fill(self, wanted.bucket, arrived);
            found[number] = pick(&scratch.values, wanted);
        }
        // The values of the bucket of the value-at-risk are the last.
        let value_at_risk = found[VALUE_AT_RISK];
        let in_bucket: u64 = scratch.values.iter().map(|(_, weight)| weight).sum();
        let beyond = totals.solved - at_risk.before - in_bucket;
        let nearby = scratch
            .values
            .iter()
            .map(|(value, weight)| (value - value_at_risk).max(0.0) * *weight as f64);
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
}

impl Scratch {
    /// Takes the values of a bucket that do not change, and those that arrive, in rising order.
    fn fill(&mut self, whole: &Whole<'_>, bucket: usize, arrived: Vec<(f64, u64)>) {
        self.values.clear();
        self.values.extend(arrived);
        let buckets = &whole.buckets;
        let members = &buckets.members[buckets.begins[bucket]..buckets.begins[bucket + 1]];
        for &sample in members {
            if self.changed_by[sample as usize] != self.mark {
                let value = whole.pdop[sample as usize];
                self.values.push((value, whole.weight(sample)));
            }
        }
        self.values.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    }
}

/// The value of a rank among those of its bucket, in rising order.
fn pick(values: &[(f64, u64)], wanted: WantedRank) -> f64 {
    let mut reached = wanted.before;
    let found = values.iter().find(|(_, weight)| {
        reached += weight;
        reached >= wanted.rank
    });
    found.map_or(f64::NAN, |(value, _)| *value)
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
