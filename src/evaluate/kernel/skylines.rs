//! Skylines in lanes.
//!
//! A table gives, for each bin of azimuth, bounds of the sine of the elevation: a satellite above the upper one clears the
//! skyline, one below the lower one does not. What is between them, one satellite in a hundred, is decided alone in f64.
//! Bins are equal parts not of the azimuth but of the position on the square |e| + |n| = 1, which needs no
//! trigonometric function.

use super::lanes::{LANES, Lanes, LineLanes, MaskTerms, Real, SightLine, SiteLanes, Sums};
use super::weighting::Weighting;
use crate::frames::Position;
use crate::ground::Site;
use crate::visibility::{Mask, MaskTable};
use nalgebra::Vector3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The bins of a skyline.
type BinTable = Arc<[SineBounds; BINS]>;

/// Bins of a table.
const BINS: usize = 2048;

/// Length of a bin on the square, whose four sides have the length 1 each.
const BIN: f64 = 4.0 / BINS as f64;

/// How far a satellite may be beyond the ends of its bin, on the square.
const MARGIN: f64 = BIN / 4.0;

/// Bounds are stored in units of this sine.
const QUANTUM: f64 = 1.0 / u16::MAX as f64;

/// Bounds of the sine of the elevation in a bin: 16 bits each.
type SineBounds = u32;

/// How far positions computed in two ways may be apart, km.
const APART_KM: f64 = 1e-6;

/// The same for angles computed in two ways, radians.
const APART_RAD: f64 = 1e-11;

/// Error bounds of what lanes compute of a line of sight.
#[derive(Debug, Clone, Copy)]
pub(super) struct SightSlack {
    /// Of the sine of an elevation.
    pub(super) sine: f32,
    /// |e| + |n| below which the azimuth is not good enough, km.
    pub(super) least_level_km: f32,
}

impl SightSlack {
    /// For lines of sight up to `longest_km`, whose direction may be off by `rotation_rad` and whose end by `rounding_km`.
    pub(super) fn new(rotation_rad: f64, rounding_km: f64, longest_km: f64) -> Self {
        let epsilon = f64::from(f32::EPSILON);
        let sine = rotation_rad + 4.0 * epsilon;
        // Both components of the displacement, and six roundings of a component along the horizon.
        let level_km = 2.0 * rounding_km + 6.0 * epsilon * longest_km;
        Self {
            sine: sine.min(2.0) as f32,
            least_level_km: (level_km / (MARGIN / 2.0)) as f32,
        }
    }
}

/// The tables of all skylines.
#[derive(Debug)]
pub(super) struct SkyTables {
    /// That of points without a skyline.
    open: BinTable,
    /// The others, by the address of the skyline.
    tables: BTreeMap<usize, BinTable>,
}

fn address(skyline: &Arc<MaskTable>) -> usize {
    Arc::as_ptr(skyline).addr()
}

impl SkyTables {
    pub(super) fn new(sites: &[Site]) -> Self {
        let mut tables = BTreeMap::new();
        for skyline in sites.iter().filter_map(|site| site.skyline.as_ref()) {
            tables
                .entry(address(skyline))
                .or_insert_with(|| Arc::new(std::array::from_fn(|bin| bounds_of(skyline, bin))));
        }
        Self {
            open: Arc::new([0; BINS]),
            tables,
        }
    }

    /// Memory of the tables and skylines of all points, bytes.
    pub(super) fn bytes(sites: &[Site]) -> usize {
        let with = sites.iter().filter_map(|site| site.skyline.as_ref());
        let mut known: Vec<_> = with.map(address).collect();
        let points = known.len();
        known.sort_unstable();
        known.dedup();
        let tables = known.len() * BINS * size_of::<SineBounds>();
        tables + points * (size_of::<Site>() + size_of::<TileSky>() / LANES)
    }

    fn table(&self, site: &Site) -> &BinTable {
        let own = |skyline| self.tables.get(&address(skyline));
        site.skyline.as_ref().and_then(own).unwrap_or(&self.open)
    }

    /// The skylines of the points of a tile; `None` if none has one.
    pub(super) fn tile(&self, sites: &[Site], members: &[u32]) -> Option<TileSky> {
        let points: Vec<Site> = members.iter().map(|&m| sites[m as usize].clone()).collect();
        points.iter().find(|site| site.skyline.is_some())?;
        let lanes = |axis: fn(&Site) -> Vector3<f64>| {
            [0, 1, 2].map(|n| {
                let component = |l: usize| points.get(l).map_or(0.0, |site| axis(site)[n] as f32);
                Lanes(std::array::from_fn(component))
            })
        };
        let bins = points.iter().flat_map(|site| self.table(site).iter());
        let bounds = bins.map(|&bounds| sines_of(bounds));
        let (lowest, highest) = bounds.fold((1.0, 0.0), |(lowest, highest), (low, high)| {
            (low.min(lowest), high.max(highest))
        });
        let table = |l: usize| points.get(l).map_or(&self.open, |site| self.table(site));
        Some(TileSky {
            east: lanes(|site| site.local.east),
            north: lanes(|site| site.local.north),
            tables: std::array::from_fn(|l| Arc::clone(table(l))),
            lowest,
            highest,
            points,
        })
    }
}

/// The smallest mask of a skyline at any azimuth and point, degrees; 0 if a point has none.
pub(super) fn lowest_deg(sites: &[Site]) -> f64 {
    let lowest = |site: &Site| match &site.skyline {
        Some(skyline) => skyline.bounds_deg(0.0, 360.0).0,
        None => 0.0,
    };
    sites.iter().map(lowest).reduce(f64::min).unwrap_or(0.0)
}

/// The azimuth at a place on the square, degrees: 0 in the north, 1 in the east.
fn azimuth_deg(place: f64) -> f64 {
    let corner = place.floor();
    let along = place - corner;
    90.0 * corner + along.atan2(1.0 - along).to_degrees()
}

fn bounds_of(skyline: &MaskTable, bin: usize) -> SineBounds {
    let centre = bin as f64 * BIN;
    let reach = BIN / 2.0 + MARGIN;
    let (low, high) = skyline.bounds_deg(azimuth_deg(centre - reach), azimuth_deg(centre + reach));
    let steps = |mask_deg: f64| mask_deg.to_radians().sin() / QUANTUM;
    let low = (steps(low).floor() - 1.0).max(0.0) as u32;
    let high = (steps(high).ceil() + 1.0).min(f64::from(u16::MAX)) as u32;
    low << 16 | high
}

/// The bounds as they are compared with a sine.
#[inline(always)]
fn sines_of(bounds: SineBounds) -> (f32, f32) {
    let sine = |steps: u32| steps as i32 as f32 * QUANTUM as f32;
    (sine(bounds >> 16), sine(bounds % (1 << 16)))
}

/// The skylines of the points of a tile.
#[derive(Debug, Clone)]
pub(super) struct TileSky {
    east: [Lanes<f32>; 3],
    north: [Lanes<f32>; 3],
    /// The bins of each point.
    tables: [BinTable; LANES],
    /// Bounds of all bins.
    lowest: f32,
    highest: f32,
    points: Vec<Site>,
}

impl TileSky {
    /// The bin of a line of sight, and whether its azimuth is good enough for that.
    #[inline(always)]
    fn bin<R: Real>(&self, line: &SightLine<R>, slack: SightSlack, l: usize) -> (u32, bool) {
        // Adding this leaves a whole number in the last bits of the fraction, also of negative numbers.
        const WHOLE: f32 = 1.5 * (1_u32 << 23) as f32;
        let [dx, dy, dz] = line.to;
        let (dx, dy, dz) = (dx.single(), dy.single(), dz.single());
        let along =
            |axis: &[Lanes<f32>; 3]| dx * axis[0].0[l] + dy * axis[1].0[l] + dz * axis[2].0[l];
        let (east, north) = (along(&self.east), along(&self.north));
        let level = east.abs() + north.abs();
        let side = east / level;
        let place = if north >= 0.0 { side } else { 2.0 - side };
        let bin = (place * (BINS as f32 / 4.0) + WHOLE).to_bits() % BINS as u32;
        (bin, level >= slack.least_level_km)
    }

    /// Puts the bounds in the bins of each satellite among `sights` where their numbers were.
    ///
    /// For itself, because what comes next in one place would gather them into a vector one by one.
    #[inline(never)]
    fn fetch<R>(&self, sights: &mut [Sight<R>]) {
        for sight in sights.iter_mut().filter(|sight| sight.among) {
            for l in 0..LANES {
                sight.bins.0[l] = self.tables[l][sight.bins.0[l] as usize % BINS];
            }
        }
    }

    /// Visibility from the point in a lane by the definition.
    #[inline(never)]
    pub(super) fn sees(&self, lane: usize, satellite: [f64; 3], mask: Mask) -> bool {
        let target = Position::new(satellite.into());
        let site = self.points.get(lane);
        site.is_some_and(|site| site.line_of_sight(mask, target).is_some())
    }

    /// The same, where it does not depend on how the position was computed.
    #[inline(never)]
    pub(super) fn surely_sees(&self, lane: usize, satellite: [f64; 3], mask: Mask) -> Option<bool> {
        let Some(site) = self.points.get(lane) else {
            return Some(false);
        };
        let target = Position::new(satellite.into());
        let (elevation_rad, azimuth_rad) = site.local.look_angles(target);
        let apart_rad = APART_KM / (target - site.local.origin_km).norm() + APART_RAD;
        let apart_deg = apart_rad.to_degrees();
        let turned_deg = (apart_deg / elevation_rad.cos()).min(180.0);
        let azimuth_deg = azimuth_rad.to_degrees();
        let bounds = |skyline: &Arc<MaskTable>| {
            skyline.bounds_deg(azimuth_deg - turned_deg, azimuth_deg + turned_deg)
        };
        let (low, high) = site.skyline.as_ref().map_or((0.0, 0.0), bounds);
        let above = |bound: f64| elevation_rad.to_degrees() - bound.max(mask.degrees());
        if above(high) > apart_deg {
            Some(true)
        } else if above(low) < -apart_deg {
            Some(false)
        } else {
            None
        }
    }
}

/// A satellite seen from the points of a tile; flags are 0 or 1.
#[derive(Debug, Clone)]
pub(super) struct Sight<R> {
    lines: LineLanes<R>,
    /// The sines of the elevations as they are compared with the tables.
    sines: Lanes<f32>,
    seen: Lanes<u32>,
    possible: Lanes<u32>,
    /// Whether it is above the lowest skyline of a point.
    above: bool,
    /// Whether it is neither below nor above all skylines.
    among: bool,
    /// Numbers of the bins, and then the bounds in them.
    bins: Lanes<u32>,
    /// Whether the azimuth is good enough for that.
    firm: Lanes<u32>,
}

impl<R: Real> Sight<R> {
    pub(super) fn nowhere() -> Self {
        let zero = Lanes([0; LANES]);
        Self {
            lines: LineLanes::nowhere(),
            sines: Lanes([0.0; LANES]),
            seen: zero,
            possible: zero,
            above: false,
            among: false,
            bins: zero,
            firm: zero,
        }
    }

    /// Decides for the lanes that the tables leave open, where `decide` can.
    #[inline(always)]
    fn settle(&mut self, decide: impl Fn(usize) -> Option<bool>) {
        let (seen, possible) = (&mut self.seen.0, &mut self.possible.0);
        let open = (0..LANES).fold(0, |open, l| open | (possible[l] & (1 - seen[l])));
        if open == 0 {
            return;
        }
        for l in 0..LANES {
            let is_open = possible[l] > seen[l];
            if let Some(is_seen) = is_open.then(|| decide(l)).flatten() {
                (seen[l], possible[l]) = (u32::from(is_seen), u32::from(is_seen));
            }
        }
    }

    /// Passes the lines to `add`, lane by lane, with whether the satellite is visible and whether it may be, unless it is
    /// visible nowhere.
    #[inline(always)]
    fn pass(&self, mut add: impl FnMut(usize, &SightLine<R>, bool, bool)) {
        if self.above {
            for l in 0..LANES {
                let (seen, possible) = (self.seen.0[l], self.possible.0[l]);
                add(l, &self.lines.get(l), seen != 0, possible != 0);
            }
        }
    }

    /// Adds the satellite where it is visible, once `decide` has decided, and returns where that is.
    #[inline(always)]
    pub(super) fn add<W: Weighting>(
        &mut self,
        sums: &mut Sums<R>,
        decide: impl Fn(usize) -> Option<bool>,
    ) -> Lanes<u32> {
        if self.among {
            self.settle(decide);
        }
        self.pass(|l, line, seen, possible| sums.add_line::<W>(line, seen, possible, l));
        self.seen
    }
}

/// The points of a tile under their skylines.
#[derive(Clone, Copy)]
pub(super) struct Skyward<'a, R> {
    pub(super) sites: &'a SiteLanes<R>,
    pub(super) sky: &'a TileSky,
    pub(super) mask: &'a MaskTerms<R>,
    pub(super) slack: SightSlack,
}

impl<R: Real> Skyward<'_, R> {
    /// Passes the line to a satellite to `add`, lane by lane, with whether it is visible and whether it may be, unless it is
    /// visible nowhere. `decide` decides for a lane, where it can.
    #[inline(always)]
    pub(super) fn look(
        &self,
        satellite: [R; 3],
        decide: impl Fn(usize) -> Option<bool>,
        add: impl FnMut(usize, &SightLine<R>, bool, bool),
    ) {
        let mut sights = [Sight::nowhere()];
        self.look_at([satellite].into_iter(), &mut sights);
        let [sight] = &mut sights;
        if sight.among {
            sight.settle(decide);
        }
        sight.pass(add);
    }

    /// Compares satellites with the skylines.
    ///
    /// In passes over all of them: what one waits for, a root or a table, the next ones hide.
    #[inline(always)]
    pub(super) fn look_at(
        &self,
        satellites: impl Iterator<Item = [R; 3]>,
        sights: &mut [Sight<R>],
    ) {
        for (satellite, sight) in satellites.zip(sights.iter_mut()) {
            self.sight(satellite, sight);
        }
        for sight in sights.iter_mut().filter(|sight| sight.among) {
            self.locate(sight);
        }
        self.sky.fetch(sights);
        for sight in sights.iter_mut().filter(|sight| sight.among) {
            self.compare(sight);
        }
    }

    /// The lines to a satellite, and how it compares with all skylines together.
    #[inline(always)]
    fn sight(&self, satellite: [R; 3], sight: &mut Sight<R>) {
        let (mut above, mut among) = (0, 0);
        for l in 0..LANES {
            let (line, is_seen, is_possible) = self.sites.line(satellite, self.mask, l);
            sight.lines.set(l, &line);
            let sine = line.sine.single();
            let is_above = is_possible & (sine >= self.sky.lowest - self.slack.sine);
            let is_clear = sine >= self.sky.highest + self.slack.sine;
            sight.sines.0[l] = sine;
            sight.seen.0[l] = u32::from(is_seen & is_above);
            sight.possible.0[l] = u32::from(is_above);
            above |= u32::from(is_above);
            among |= u32::from(is_above & !is_clear);
        }
        (sight.above, sight.among) = (above != 0, among != 0);
    }

    /// Finds the bins.
    #[inline(always)]
    fn locate(&self, sight: &mut Sight<R>) {
        for l in 0..LANES {
            let (bin, is_firm) = self.sky.bin(&sight.lines.get(l), self.slack, l);
            (sight.bins.0[l], sight.firm.0[l]) = (bin, u32::from(is_firm));
        }
    }

    /// Compares with the bounds in the bins.
    #[inline(always)]
    fn compare(&self, sight: &mut Sight<R>) {
        for l in 0..LANES {
            let (low, high) = sines_of(sight.bins.0[l]);
            let (sine, firm) = (sight.sines.0[l], sight.firm.0[l]);
            let clear = u32::from(sine >= high + self.slack.sine) & firm;
            let blocked = u32::from(sine < low - self.slack.sine) & firm;
            sight.seen.0[l] &= clear;
            sight.possible.0[l] &= 1 - blocked;
        }
    }
}

impl<R: Real> Sums<R> {
    /// Adds a satellite where it is known to be visible.
    #[inline(always)]
    pub(super) fn add_seen<W: Weighting>(
        &mut self,
        sites: &SiteLanes<R>,
        satellite: [R; 3],
        mask: &MaskTerms<R>,
        seen: &Lanes<u32>,
    ) {
        for l in 0..LANES {
            let (line, ..) = sites.line(satellite, mask, l);
            let is_seen = seen.0[l] != 0;
            self.add_line::<W>(&line, is_seen, is_seen, l);
        }
    }
}
