//! One pass over the samples: PDOP with all satellites, and without each of some sets.
//!
//! The lanes of the kernel do nearly all of it; what they leave open, and LEO clocks of their own, take the plain path.

use super::sight::{Reach, SightTree};
use crate::dop::ClockGroup;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::evaluate::Evaluator;
use crate::evaluate::fixed::{self, PlainGnssSample};
use crate::evaluate::kernel::{
    ChangedSample, DoubtAbout, LossDoubt, LossDoubts, LossTally, SampleLosses, WholeSample,
    at_most_u16,
};
use nalgebra::Vector3;
use rayon::prelude::*;
use std::ops::Range;

/// PDOP above which a sample is summed anew: below, downdated sums agree with these to 1e-12.
const DOWNDATED_UP_TO: f64 = 5.0;

/// Relative distance from a threshold within which a sample is summed anew.
const NEAR: f64 = 1e-9;

/// What a pass needs to know of the satellites.
pub(super) struct Sets<'a> {
    ephemeris: &'a Ephemeris,
    count: usize,
    /// The sets that each satellite is in, rising.
    of_satellite: Vec<Vec<u32>>,
    /// The clock of each satellite.
    clocks: Vec<usize>,
    clock_count: usize,
    /// Whether samples that stay solved are tallied where the lanes decide them, and not kept.
    is_tallied: bool,
}

impl<'a> Sets<'a> {
    pub(super) fn new(
        evaluator: &Evaluator,
        ephemeris: &'a Ephemeris,
        sets: &[Vec<usize>],
    ) -> Self {
        let satellites = ephemeris.satellites().len();
        let mut of_satellite = vec![Vec::new(); satellites];
        for (number, set) in (0..).zip(sets) {
            for &satellite in set {
                of_satellite[satellite].push(number);
            }
        }
        let several = evaluator.setup().has_several_leo_clocks(ephemeris);
        let (clocks, clock_count) = match several {
            true => (ephemeris.parts().to_vec(), ephemeris.part_count()),
            false => (vec![0; satellites], 1),
        };
        Self {
            ephemeris,
            count: sets.len(),
            of_satellite,
            clocks,
            clock_count,
            is_tallied: false,
        }
    }

    /// The same for the worst of each set only: samples that stay solved are tallied.
    pub(super) fn tallied(self) -> Self {
        Self {
            is_tallied: true,
            ..self
        }
    }
}

impl Sets<'_> {
    /// About how many of so many samples change without a set: room to begin with.
    fn changes_of(&self, samples: usize) -> usize {
        if self.is_tallied {
            return 0;
        }
        /// A little more than the share of the Earth that sees a satellite at 1000 km.
        const SHARE: f64 = 0.05;
        let members: usize = self.of_satellite.iter().map(Vec::len).sum();
        let share = (SHARE * members as f64 / self.count.max(1) as f64).min(1.0);
        (share * samples as f64) as usize
    }
}

/// A satellite in view.
#[derive(Clone, Copy)]
pub(super) struct Sighted {
    satellite: u32,
    unit: Vector3<f64>,
    weight: f64,
}

/// What a piece of a pass works with.
pub(super) struct Worker<'a> {
    evaluator: &'a Evaluator,
    tree: &'a SightTree,
    sets: &'a Sets<'a>,
    /// The satellites in view of each point.
    sky: Vec<Vec<Sighted>>,
    /// The sums of each LEO clock at a sample.
    groups: Vec<ClockGroup>,
    /// Those of all satellites, while sets of them are taken away.
    whole: Vec<ClockGroup>,
    /// Set and place in the sky of the satellites of a sample.
    touched: Vec<(u32, u32)>,
}

/// Evaluates the instants piece by piece, on all threads; the pieces are in the order of time.
pub(super) fn pass(
    evaluator: &Evaluator,
    tree: &SightTree,
    sets: &Sets<'_>,
) -> Result<Vec<SampleLosses>, EphemerisError> {
    // The lanes that lose satellites have one LEO clock.
    let lanes = (sets.clock_count == 1).then_some(&evaluator.kernel);
    if lanes.is_none() {
        // Made before the threads ask for it.
        evaluator.fixed()?;
    }
    let setup = evaluator.setup();
    let instants = setup.grid.len();
    let length = instants.div_ceil(4 * rayon::current_num_threads()).max(1);
    let starts: Vec<usize> = (0..instants).step_by(length).collect();
    let piece = |start: &usize| {
        let mut worker = Worker::new(evaluator, tree, sets);
        let range = *start..(*start + length).min(instants);
        let capacity = sets.changes_of(range.len() * setup.sites.len());
        let mut losses = SampleLosses {
            first: (start * setup.sites.len()) as u32,
            whole: Vec::with_capacity(range.len() * setup.sites.len()),
            changed: (0..sets.count)
                .map(|_| Vec::with_capacity(capacity))
                .collect(),
            tallies: match sets.is_tallied {
                true => vec![LossTally::NOTHING; sets.count],
                false => Vec::new(),
            },
            largest: 0.0,
        };
        match lanes {
            Some(kernel) => {
                let of_satellite = &sets.of_satellite;
                let settle = |instant, doubts: &mut _, losses: &mut _| {
                    worker.settle(instant, doubts, losses)
                };
                kernel.losses(sets.ephemeris, of_satellite, range, &mut losses, settle)?;
            }
            None => worker.run(range, &mut losses)?,
        }
        Ok(losses)
    };
    starts.par_iter().map(piece).collect()
}

impl<'a> Worker<'a> {
    pub(super) fn new(evaluator: &'a Evaluator, tree: &'a SightTree, sets: &'a Sets<'a>) -> Self {
        Self {
            evaluator,
            tree,
            sets,
            sky: vec![Vec::new(); evaluator.setup().sites.len()],
            groups: Vec::new(),
            whole: Vec::new(),
            touched: Vec::new(),
        }
    }

    /// Adds the samples of some instants by the plain path.
    fn run(
        &mut self,
        instants: Range<usize>,
        losses: &mut SampleLosses,
    ) -> Result<(), EphemerisError> {
        let fixed = self.evaluator.fixed()?;
        for instant in instants {
            self.look(instant)?;
            for (site, gnss) in fixed.at(instant).iter().enumerate() {
                let seen = self.take_sky(site);
                let place = losses.whole.len() as u32;
                losses.whole.push(WholeSample {
                    pdop: self.start(&seen, gnss),
                    site: site as u32,
                    visible: at_most_u16(seen.len() as u32),
                    gnss_visible: at_most_u16(gnss.visible),
                });
                self.lose(place, &seen, gnss, losses);
                self.give_sky(site, seen);
            }
        }
        Ok(())
    }

    /// Decides what the lanes leave open at an instant.
    fn settle(
        &mut self,
        instant: usize,
        doubts: &mut LossDoubts,
        losses: &mut SampleLosses,
    ) -> Result<(), EphemerisError> {
        let setup = self.evaluator.setup();
        let elapsed_s = setup.grid.elapsed_s(instant);
        let rotation = self.evaluator.rotations[instant];
        let systems = fixed::positions(self.evaluator.kernel.systems(), elapsed_s, rotation)?;
        let ephemeris = self.sets.ephemeris;
        let mut known = vec![None; ephemeris.satellites().len()];
        let mut seen = Vec::new();
        doubts.samples.sort_by_key(|doubt| doubt.place);
        for of_sample in doubts.samples.chunk_by(|a, b| a.place == b.place) {
            let LossDoubt { place, tile, .. } = of_sample[0];
            let number = losses.whole[place as usize].site as usize;
            let site = &setup.sites[number];
            let of_tile = doubts.tiles.iter().find(|(known, _)| *known == tile);
            seen.clear();
            for &satellite in of_tile.iter().flat_map(|(_, satellites)| satellites) {
                let position = match known[satellite as usize] {
                    Some(position) => position,
                    None => {
                        let one = &ephemeris.satellites()[satellite as usize];
                        let state = ephemeris.state_or_gap(one, elapsed_s)?;
                        let position =
                            state.map(|state| rotation.to_earth_fixed(state.position_km));
                        *known[satellite as usize].insert(position)
                    }
                };
                let unit = position.and_then(|target| site.line_of_sight(setup.mask, target));
                seen.extend(unit.map(|unit| Sighted {
                    satellite,
                    unit,
                    weight: setup.observation_weight(site, unit),
                }));
            }
            let gnss = PlainGnssSample::new(setup, site, &systems);
            let pdop = self.start(&seen, &gnss);
            for doubt in of_sample {
                self.decide(doubt.about, (place, pdop), &seen, &gnss, losses);
            }
        }
        Ok(())
    }

    /// Decides one of them at a sample that is begun.
    fn decide(
        &mut self,
        about: DoubtAbout,
        (place, pdop): (u32, f64),
        seen: &[Sighted],
        gnss: &PlainGnssSample,
        losses: &mut SampleLosses,
    ) {
        let whole = &mut losses.whole[place as usize];
        match about {
            DoubtAbout::Whole => whole.pdop = pdop,
            DoubtAbout::Sky => {
                (whole.pdop, whole.visible) = (pdop, at_most_u16(seen.len() as u32));
                self.lose(place, seen, gnss, losses);
            }
            DoubtAbout::Set { set, at } => {
                let is_lost = |one: &Sighted| {
                    let sets = &self.sets.of_satellite[one.satellite as usize];
                    sets.binary_search(&set).is_ok()
                };
                let places = seen.iter().enumerate();
                let places = places.filter(|(_, one)| is_lost(one));
                let places: Vec<usize> = places.map(|(place, _)| place).collect();
                let pdop = self.without(seen, &places, gnss);
                losses.changed[set as usize][at as usize].pdop = pdop;
                losses.note(pdop);
            }
        }
    }

    /// Fills the sky of each point, satellite by satellite.
    pub(super) fn look(&mut self, instant: usize) -> Result<(), EphemerisError> {
        let setup = self.evaluator.setup();
        let elapsed_s = setup.grid.elapsed_s(instant);
        let rotation = self.evaluator.rotations[instant];
        self.sky.iter_mut().for_each(Vec::clear);
        let sky = &mut self.sky;
        let mut reach = Reach::default();
        let ephemeris = self.sets.ephemeris;
        for (number, satellite) in (0..).zip(ephemeris.satellites()) {
            let Some(state) = ephemeris.state_or_gap(satellite, elapsed_s)? else {
                continue;
            };
            let target_km = rotation.to_earth_fixed(state.position_km);
            let distance_km = target_km.km().norm();
            reach = self.tree.reach(reach, distance_km);
            let direction = target_km.km() / distance_km;
            let mut see = |site: usize, unit| {
                sky[site].push(Sighted {
                    satellite: number,
                    unit,
                    weight: setup.observation_weight(&setup.sites[site], unit),
                });
            };
            self.tree
                .visit(setup, target_km, (direction, reach), &mut see);
        }
        Ok(())
    }

    /// A sample that is begun, without each set of which it sees a satellite.
    fn lose(
        &mut self,
        place: u32,
        seen: &[Sighted],
        gnss: &PlainGnssSample,
        losses: &mut SampleLosses,
    ) {
        let mut touched = std::mem::take(&mut self.touched);
        touched.clear();
        for (place, one) in (0..).zip(seen) {
            let sets = self.sets.of_satellite[one.satellite as usize].iter();
            touched.extend(sets.map(|set| (*set, place)));
        }
        if !touched.is_sorted() {
            touched.sort_unstable();
        }
        let mut places = Vec::new();
        for together in touched.chunk_by(|a, b| a.0 == b.0) {
            places.clear();
            places.extend(together.iter().map(|(_, place)| *place as usize));
            let pdop = self.without(seen, &places, gnss);
            losses.note(pdop);
            losses.changed[together[0].0 as usize].push(ChangedSample {
                sample: losses.first + place,
                missing: together.len() as u32,
                pdop,
            });
        }
        self.touched = touched;
    }

    /// Begins a sample: PDOP with all satellites, from which sets are then taken away.
    pub(super) fn start(&mut self, seen: &[Sighted], gnss: &PlainGnssSample) -> f64 {
        self.sum(seen, gnss, |_| true);
        self.whole.clone_from(&self.groups);
        self.solved(gnss)
    }

    /// PDOP of the sample without the satellites at some places of its sky; infinite if unsolved.
    pub(super) fn without(
        &mut self,
        seen: &[Sighted],
        places: &[usize],
        gnss: &PlainGnssSample,
    ) -> f64 {
        match self.downdated(gnss, places.iter().map(|place| &seen[*place])) {
            Downdated::Pdop(pdop) => pdop,
            Downdated::TooFew => f64::INFINITY,
            Downdated::Doubtful => {
                self.sum(seen, gnss, |place| !places.contains(&place));
                self.solved(gnss)
            }
        }
    }

    /// The satellites in view of each point.
    pub(super) fn sky(&self) -> &[Vec<Sighted>] {
        &self.sky
    }

    /// Takes the sky of a point, to be given back.
    pub(super) fn take_sky(&mut self, site: usize) -> Vec<Sighted> {
        std::mem::take(&mut self.sky[site])
    }

    /// Gives the sky of a point back.
    pub(super) fn give_sky(&mut self, site: usize, sky: Vec<Sighted>) {
        self.sky[site] = sky;
    }

    /// The sums of the plain path over the satellites that are left, in its order.
    fn sum(&mut self, seen: &[Sighted], gnss: &PlainGnssSample, is_left: impl Fn(usize) -> bool) {
        self.groups.clear();
        let count = self.sets.clock_count;
        self.groups.resize(count, ClockGroup::default());
        for (place, one) in seen.iter().enumerate() {
            if is_left(place) {
                let clock = self.sets.clocks[one.satellite as usize];
                self.groups[clock].add(one.unit, one.weight);
            }
        }
        self.groups[0] += gnss.shared_clock;
    }

    /// PDOP of the sums; infinite if unsolved.
    fn solved(&self, gnss: &PlainGnssSample) -> f64 {
        let mut geometry = gnss.own_clocks;
        self.groups.iter().for_each(|group| geometry.add(group));
        let cap = self.evaluator.setup().pdop_cap;
        geometry.pdop(cap).unwrap_or(f64::INFINITY)
    }

    /// PDOP of the sums of all satellites minus some.
    fn downdated<'s>(
        &self,
        gnss: &PlainGnssSample,
        missing: impl Iterator<Item = &'s Sighted>,
    ) -> Downdated {
        let setup = self.evaluator.setup();
        let geometry = match self.whole.as_slice() {
            [one] => {
                let mut left = *one;
                missing.for_each(|one| left.remove(one.unit, one.weight));
                let mut geometry = gnss.own_clocks;
                geometry.add(&left);
                geometry
            }
            groups => {
                let mut left = groups.to_vec();
                for one in missing {
                    let clock = self.sets.clocks[one.satellite as usize];
                    left[clock].remove(one.unit, one.weight);
                }
                let mut geometry = gnss.own_clocks;
                left.iter().for_each(|group| geometry.add(group));
                geometry
            }
        };
        if geometry.lacks_satellites() {
            return Downdated::TooFew;
        }
        let limit = DOWNDATED_UP_TO.min(setup.pdop_cap * (1.0 - NEAR));
        let available = setup.metrics.availability_pdop;
        match geometry.good_pdop(limit) {
            Some(pdop) if (pdop - available).abs() > NEAR * available => Downdated::Pdop(pdop),
            _ => Downdated::Doubtful,
        }
    }
}

/// What downdated sums say.
enum Downdated {
    Pdop(f64),
    /// There are too few satellites for a position.
    TooFew,
    /// Rounding may have changed it.
    Doubtful,
}
