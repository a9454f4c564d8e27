//! One pass over the samples: PDOP with all satellites, and without each of some sets.

use super::sight::{Reach, SightTree};
use crate::dop::ClockGroup;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::evaluate::Evaluator;
use crate::evaluate::fixed::PlainGnssSample;
use nalgebra::Vector3;
use rayon::prelude::*;
use std::ops::Range;

/// A sample without some satellites. Sixteen bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ChangedSample {
    /// Instant times points plus point.
    pub(super) sample: u32,
    /// Visible satellites that are missing.
    pub(super) missing: u32,
    /// PDOP without them; infinite if unsolved.
    pub(super) pdop: f64,
}

/// The samples of some instants, instant by instant and point by point.
#[derive(Default)]
pub(super) struct PassPiece {
    /// PDOP with all satellites; infinite if unsolved.
    pub(super) pdop: Vec<f64>,
    /// Visible LEO satellites.
    pub(super) visible: Vec<u32>,
    /// Visible GNSS satellites.
    pub(super) gnss_visible: Vec<u32>,
    /// Of each set, what changes without it, by rising sample.
    pub(super) changed: Vec<Vec<ChangedSample>>,
}

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
        }
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
    piece: PassPiece,
}

/// Evaluates the instants piece by piece, on all threads; the pieces are in the order of time.
pub(super) fn pass(
    evaluator: &Evaluator,
    tree: &SightTree,
    sets: &Sets<'_>,
) -> Result<Vec<PassPiece>, EphemerisError> {
    // Made before the threads ask for it.
    evaluator.fixed()?;
    let instants = evaluator.setup().grid.len();
    let length = instants.div_ceil(4 * rayon::current_num_threads()).max(1);
    let starts: Vec<usize> = (0..instants).step_by(length).collect();
    let piece = |start: &usize| {
        let mut worker = Worker::new(evaluator, tree, sets);
        worker.run(*start..(*start + length).min(instants))?;
        Ok(worker.piece)
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
            piece: PassPiece {
                changed: vec![Vec::new(); sets.count],
                ..PassPiece::default()
            },
        }
    }

    fn run(&mut self, instants: Range<usize>) -> Result<(), EphemerisError> {
        let fixed = self.evaluator.fixed()?;
        for instant in instants {
            self.look(instant)?;
            let first = instant * self.sky.len();
            for (site, gnss) in fixed.at(instant).iter().enumerate() {
                self.sample((first + site) as u32, site, gnss);
            }
        }
        Ok(())
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
                    weight: setup.observation_weight(&setup.sites[site].local, unit),
                });
            };
            self.tree
                .visit(setup, target_km, (direction, reach), &mut see);
        }
        Ok(())
    }

    /// One sample with all satellites and without each set.
    fn sample(&mut self, sample: u32, site: usize, gnss: &PlainGnssSample) {
        let seen = std::mem::take(&mut self.sky[site]);
        let pdop = self.start(&seen, gnss);
        self.piece.pdop.push(pdop);
        self.piece.visible.push(seen.len() as u32);
        self.piece.gnss_visible.push(gnss.visible);
        self.touched.clear();
        for (place, one) in (0..).zip(&seen) {
            let sets = self.sets.of_satellite[one.satellite as usize].iter();
            self.touched.extend(sets.map(|set| (*set, place)));
        }
        let mut touched = std::mem::take(&mut self.touched);
        if !touched.is_sorted() {
            touched.sort_unstable();
        }
        let mut places = Vec::new();
        for together in touched.chunk_by(|a, b| a.0 == b.0) {
            places.clear();
            places.extend(together.iter().map(|(_, place)| *place as usize));
            let pdop = self.without(&seen, &places, gnss);
            self.piece.changed[together[0].0 as usize].push(ChangedSample {
                sample,
                missing: together.len() as u32,
                pdop,
            });
        }
        self.touched = touched;
        self.sky[site] = seen;
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
