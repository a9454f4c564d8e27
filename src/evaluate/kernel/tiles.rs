//! Ground points in tiles of neighbours, and tiles in groups.
//!
//! A tile fills the lanes. Points are split in two until a tile is left, so that any set of points,
//! a grid or not, gives compact tiles, and all tiles but the last of each group are full. Many
//! points are split across the longest side of their bounding box; few are split where this leaves the
//! fewest tests, because a satellite that any point of a tile may see is tested for all of them.
//!
//! A satellite at r sees the points within the angle ψ(r) = acos(k / r) - m of the point below it,
//! k = g cos m, for points at distance g from the centre and an elevation m over the horizon of
//! the sphere through them. It can see part of a cap of angular radius ρ around the unit vector c only
//! if r·c >= |r| cos(ψ + ρ), which written out contains no angles:
//!
//! ```text
//! r·c + sin(ρ - m) q >= k cos(ρ - m),   q = sqrt(|r|² - k²)
//! ```
//!
//! With the smallest g of all points, and the mask minus the largest angle between a vertical and the
//! radius, this is valid for points on an ellipsoid too; it never misses a visible satellite.

use super::super::weights::WholeWeights;
use super::lanes::{LANES, Lanes, MaskTerms, SightLine, SiteLanes};
use super::propagation::Positions;
use super::skylines::{SightSlack, SkyTables, Skyward, TileSky, lowest_deg};
use crate::ground::Site;
use crate::visibility::Mask;
use nalgebra::Vector3;
use std::f64::consts::{FRAC_PI_2, PI};

/// Tiles that are culled together first.
pub(super) const TILES_IN_GROUP: usize = 32;

/// The test of a cap against a satellite: `x`, `y`, `z`, `q` coefficients and the bound.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cap {
    pub(super) centre: [f32; 3],
    pub(super) sine: f32,
    pub(super) bound: f32,
}

/// Points that are processed side by side.
#[derive(Debug, Clone)]
pub(super) struct Tile {
    /// Index of the point in each lane; shorter than the lanes in the last tile.
    pub(super) members: Vec<u32>,
    /// The middle of the points, Earth-fixed, km: a place that is exact in f32.
    pub(super) middle: [f32; 3],
    /// Half of the unit vector to there: the place that weighted sums are about.
    pub(super) centre: [f32; 3],
    /// The points from there.
    pub(super) single: SiteLanes<f32>,
    pub(super) double: SiteLanes<f64>,
    pub(super) cap: Cap,
    /// The same for the GNSS, which may have its own mask.
    pub(super) fixed_cap: Cap,
    pub(super) weights: TileWeights,
    /// The skylines of the points, if one has any.
    pub(super) sky: Option<TileSky>,
}

/// The weights of the points of a tile; a lane without a point weighs nothing.
#[derive(Debug, Clone)]
pub(super) struct TileWeights {
    pub(super) whole: Lanes<u64>,
    /// The same numbers.
    pub(super) real: Lanes<f64>,
    /// 1 where there is a point, otherwise 0.
    pub(super) member: Lanes<u32>,
}

impl TileWeights {
    fn new(weights: &WholeWeights, members: &[u32]) -> Self {
        let weight = |l: usize| members.get(l).map_or(0, |&site| weights.of(site as usize));
        Self {
            whole: Lanes(std::array::from_fn(weight)),
            real: Lanes(std::array::from_fn(|l| weight(l) as f64)),
            member: Lanes(std::array::from_fn(|l| u32::from(l < members.len()))),
        }
    }
}

/// Tiles next to each other.
#[derive(Debug, Clone)]
pub(super) struct Group {
    pub(super) tiles: std::ops::Range<usize>,
    pub(super) cap: Cap,
}

/// All the points.
#[derive(Debug, Clone)]
pub(super) struct Tiles {
    pub(super) tiles: Vec<Tile>,
    pub(super) groups: Vec<Group>,
    pub(super) horizon: Horizon,
    /// That of the GNSS.
    pub(super) fixed_horizon: Horizon,
}

/// Bounds on visibility from all points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Horizon {
    /// Largest distance of a point from the centre of the Earth, km.
    farthest_km: f64,
    /// Smallest elevation above the spherical horizon of a satellite at the mask, radians; and sine and
    /// cosine of the largest.
    least_mask_rad: f64,
    sin_most: f64,
    cos_most: f64,
    /// k², km²: a satellite closer to the centre than k is visible nowhere.
    pub(super) reach2: f64,
    /// Largest distance of a point from the middle of its tile, km.
    widest_km: f64,
}

impl Horizon {
    /// For satellites above a mask that are above `lowest_deg` from all points.
    fn new(sites: &[Site], mask: Mask, lowest_deg: f64) -> Self {
        let mut tilt: f64 = 0.0;
        let (mut nearest_km, mut farthest_km) = (f64::INFINITY, 0.0_f64);
        for site in sites {
            let radius = site.local.origin_km.norm();
            nearest_km = nearest_km.min(radius);
            farthest_km = farthest_km.max(radius);
            tilt = tilt.max(site.local.origin_km.km().cross(&site.local.up).norm() / radius);
        }
        let mask_deg = mask.degrees().max(lowest_deg);
        let (mask_rad, tilt_rad) = (mask_deg.to_radians(), tilt.min(1.0).asin());
        let (sin_most, cos_most) = (mask_rad + tilt_rad).min(FRAC_PI_2).sin_cos();
        Self {
            farthest_km,
            least_mask_rad: mask_rad - tilt_rad,
            sin_most,
            cos_most,
            reach2: (nearest_km * (mask_rad - tilt_rad).cos()).powi(2),
            widest_km: 0.0,
        }
    }

    /// How far a line of sight in f32 of this length may be displaced, km: two roundings of the satellite from the middle of
    /// the tile, one of the point from there, and one of the line.
    fn rounding_km(&self, range_km: f64) -> f64 {
        1.5 * f64::from(f32::EPSILON) * (range_km + self.widest_km)
    }

    /// Largest distance at which a point sees a satellite, km.
    fn longest_km(&self, positions: &Positions) -> f64 {
        let level_km = (positions.farthest_km.powi(2) - self.reach2)
            .max(0.0)
            .sqrt();
        level_km + self.farthest_km * (-self.least_mask_rad).max(0.0).sin()
    }

    /// Smallest distance from a point to a satellite at the mask that is `radius_km` from the
    /// centre; 0 for one that is not above all points.
    fn range_at_mask_km(&self, radius_km: f64) -> f64 {
        let beyond = radius_km.powi(2) - (self.farthest_km * self.cos_most).powi(2);
        (beyond.max(0.0).sqrt() - self.farthest_km * self.sin_most).max(0.0)
    }

    /// Error bound of the sine of an elevation at the mask in f32: that of the line over the shortest range, plus eight
    /// roundings of the sine itself.
    #[inline(always)]
    pub(super) fn sine_slack(&self, positions: &Positions) -> f32 {
        let range_km = self.range_at_mask_km(positions.nearest_km);
        let slack = self.rounding_km(range_km) / range_km + 4.0 * f64::from(f32::EPSILON);
        // For satellites on the ground f32 cannot decide anything.
        slack.min(2.0) as f32
    }

    /// Error bounds of lines of sight in f32.
    #[inline(always)]
    pub(super) fn single_slack(&self, positions: &Positions) -> SightSlack {
        let range_km = (positions.nearest_km - self.farthest_km).max(0.0);
        let longest_km = self.longest_km(positions);
        SightSlack::new(
            self.rounding_km(range_km) / range_km,
            self.rounding_km(longest_km),
            longest_km,
        )
    }

    /// The same of lines in f64.
    pub(super) fn double_slack(&self, positions: &Positions) -> SightSlack {
        SightSlack::new(0.0, 0.0, self.longest_km(positions))
    }

    /// PDOP up to which f32 gives six digits. A line of sight is rotated by its displacement divided by the range, most at
    /// the zenith, and PDOP magnifies this at most by its square; the constant was found by trial, with a margin of two.
    #[inline(always)]
    pub(super) fn single_below(&self, positions: &Positions) -> f32 {
        let range_km = (positions.nearest_km - self.farthest_km).max(0.0);
        // For satellites on the ground that is 0, also over points without extent.
        (5e-6 * range_km / self.rounding_km(range_km))
            .max(0.0)
            .sqrt() as f32
    }

    /// Error bound of a cap test in f32, km: eight roundings of the largest number in it, times two.
    #[inline(always)]
    pub(super) fn cap_slack_km(positions: &Positions) -> f32 {
        positions.farthest_km as f32 * (16.0 * f32::EPSILON)
    }

    fn cap(&self, circle: Option<EnclosingCircle>) -> Cap {
        // Caps close to a hemisphere or larger are not worth a test.
        let Some(circle) = circle.filter(|circle| circle.radius_rad < 1.2) else {
            return Cap::EVERYTHING;
        };
        let angle = circle.radius_rad - self.least_mask_rad;
        Cap {
            centre: circle.centre.map(|x| x as f32).into(),
            sine: angle.sin() as f32,
            bound: (self.reach2.sqrt() * angle.cos()) as f32,
        }
    }
}

/// A circle on the sphere around some points.
#[derive(Debug, Clone, Copy)]
struct EnclosingCircle {
    centre: Vector3<f64>,
    radius_rad: f64,
}

impl EnclosingCircle {
    /// Nearly the smallest: the centre is moved towards the farthest point by smaller and smaller
    /// steps (Bădoiu and Clarkson, *SODA* 2003, p. 801). `None` for points all around the Earth.
    fn around(sites: &[Site], members: &[u32]) -> Option<Self> {
        let units: Vec<_> = members
            .iter()
            .map(|&m| sites[m as usize].local.origin_km.km().normalize())
            .collect();
        let sum: Vector3<f64> = units.iter().sum();
        let mut centre = sum.try_normalize(1e-6)?;
        let mut best: Option<Self> = None;
        for step in 2..64 {
            let nearness = |unit: &&Vector3<f64>| unit.dot(&centre);
            let farthest = units
                .iter()
                .min_by(|a, b| nearness(a).total_cmp(&nearness(b)))?;
            let radius_rad = farthest.angle(&centre);
            if best.is_none_or(|best| radius_rad < best.radius_rad) {
                best = Some(Self { centre, radius_rad });
            }
            centre = (centre + (farthest - centre) / f64::from(step)).try_normalize(1e-6)?;
        }
        best
    }

    /// A measure of the number of satellites that see part of the circle: the area in which they can be,
    /// if each sees a circle of 0.4 rad (as at 1000 km and 7°).
    fn cost(circle: Option<Self>) -> f64 {
        circle.map_or(2.0, |circle| 1.0 - (circle.radius_rad + 0.4).min(PI).cos())
    }
}

impl Cap {
    const EVERYTHING: Self = Self {
        centre: [0.0; 3],
        sine: 0.0,
        bound: f32::MIN,
    };
}

impl Tiles {
    pub(super) fn new(
        sites: &[Site],
        weights: &WholeWeights,
        mask: Mask,
        fixed_mask: Mask,
    ) -> Self {
        let mut members: Vec<u32> = (0..sites.len() as u32).collect();
        let lowest_deg = lowest_deg(sites);
        let mut tiles = Self {
            tiles: Vec::with_capacity(sites.len().div_ceil(LANES)),
            groups: Vec::new(),
            horizon: Horizon::new(sites, mask, lowest_deg),
            fixed_horizon: Horizon::new(sites, fixed_mask, lowest_deg),
        };
        tiles.split(sites, weights, &mut members);
        let widest_km = tiles.tiles.iter().map(Tile::widest_km).fold(0.0, f64::max);
        (tiles.horizon.widest_km, tiles.fixed_horizon.widest_km) = (widest_km, widest_km);
        let tables = SkyTables::new(sites);
        for tile in &mut tiles.tiles {
            tile.sky = tables.tile(sites, &tile.members);
        }
        tiles
    }

    /// Points of all tiles, including lanes without a point.
    pub(super) fn slots(&self) -> usize {
        self.tiles.len() * LANES
    }

    fn split(&mut self, sites: &[Site], weights: &WholeWeights, members: &mut [u32]) {
        if members.len() > TILES_IN_GROUP * LANES {
            sort_along(&keys(sites, members)[longest_side(sites, members)], members);
            let (left, right) = members.split_at_mut(middle(members.len()));
            self.split(sites, weights, left);
            self.split(sites, weights, right);
            return;
        }
        let first = self.tiles.len();
        self.split_group(sites, weights, members);
        self.groups.push(Group {
            tiles: first..self.tiles.len(),
            cap: self.horizon.cap(EnclosingCircle::around(sites, members)),
        });
    }

    fn split_group(&mut self, sites: &[Site], weights: &WholeWeights, members: &mut [u32]) {
        if members.len() > LANES {
            cut_well(sites, members);
            let (left, right) = members.split_at_mut(middle(members.len()));
            self.split_group(sites, weights, left);
            self.split_group(sites, weights, right);
            return;
        }
        let circle = EnclosingCircle::around(sites, members);
        let middle = middle_of(sites, members);
        let single = |x: f64| x as f32;
        let lanes = site_lanes(sites, members, middle.map(f64::from), single, f32::NAN);
        self.tiles.push(Tile {
            middle,
            centre: centre_of(middle),
            single: lanes,
            double: site_lanes(sites, members, [0.0; 3], |x| x, f64::NAN),
            cap: self.horizon.cap(circle),
            fixed_cap: self.fixed_horizon.cap(circle),
            weights: TileWeights::new(weights, members),
            members: members.to_vec(),
            sky: None,
        });
    }
}

/// The points on the left of a cut: a whole number of tiles.
fn middle(points: usize) -> usize {
    points.div_ceil(LANES).div_ceil(2) * LANES
}

/// Keys for ordering points: x, y, z and the longitude relative to the central one.
fn keys(sites: &[Site], members: &[u32]) -> [Vec<(u32, f64)>; 4] {
    let origin = |m: u32| sites[m as usize].local.origin_km.km();
    let sum: Vector3<f64> = members.iter().map(|&m| origin(m)).sum();
    let along =
        |key: &dyn Fn(Vector3<f64>) -> f64| members.iter().map(|&m| (m, key(origin(m)))).collect();
    let eastwards = |p: Vector3<f64>| (sum.x * p.y - sum.y * p.x).atan2(sum.x * p.x + sum.y * p.y);
    [
        along(&|p| p.x),
        along(&|p| p.y),
        along(&|p| p.z),
        along(&eastwards),
    ]
}

/// The axis along which the bounding box of the points is longest.
fn longest_side(sites: &[Site], members: &[u32]) -> usize {
    let points = members
        .iter()
        .map(|&m| sites[m as usize].local.origin_km.km());
    let low = points.clone().reduce(|a, b| a.inf(&b));
    let high = points.reduce(|a, b| a.sup(&b));
    low.zip(high).map_or(0, |(low, high)| (high - low).imax())
}

/// Orders points by a key; ties by the order of the points, so the result does not depend on the sort.
fn sort_along(key: &[(u32, f64)], members: &mut [u32]) {
    let mut ordered = key.to_vec();
    ordered.sort_unstable_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
    for (member, (m, _)) in members.iter_mut().zip(ordered) {
        *member = m;
    }
}

/// Orders points so that the two halves have the smallest circles.
fn cut_well(sites: &[Site], members: &mut [u32]) {
    let cut = middle(members.len());
    let cost = |members: &[u32]| {
        let (left, right) = members.split_at(cut);
        left.len() as f64 * EnclosingCircle::cost(EnclosingCircle::around(sites, left))
            + right.len() as f64 * EnclosingCircle::cost(EnclosingCircle::around(sites, right))
    };
    let orders = keys(sites, members).map(|key| {
        let mut order = members.to_vec();
        sort_along(&key, &mut order);
        order
    });
    let best = orders.iter().min_by(|a, b| cost(a).total_cmp(&cost(b)));
    if let Some(best) = best {
        members.copy_from_slice(best);
    }
}

/// The middle of the box around some points, rounded to f32.
fn middle_of(sites: &[Site], members: &[u32]) -> [f32; 3] {
    let origins = members
        .iter()
        .map(|&m| sites[m as usize].local.origin_km.km());
    let low = origins.clone().reduce(|a, b| a.inf(&b));
    let high = origins.reduce(|a, b| a.sup(&b));
    let middle = low.zip(high).map(|(low, high)| (low + high) / 2.0);
    middle.unwrap_or_default().map(|x| x as f32).into()
}

/// Half of the unit vector to the middle of a tile: about the mean line of sight of satellites weighted by elevation.
fn centre_of(middle: [f32; 3]) -> [f32; 3] {
    let unit = Vector3::from(middle).cast::<f64>().try_normalize(1.0);
    let centre = unit.unwrap_or_default() * 0.5;
    centre.map(|x| x as f32).into()
}

impl Tile {
    /// Passes the lines in f64 to a satellite to `add`, lane by lane, with whether it is visible.
    #[inline(always)]
    pub(super) fn look(
        &self,
        satellite: [f64; 3],
        (terms, mask): (&MaskTerms<f64>, Mask),
        slack: SightSlack,
        add: &mut impl FnMut(usize, &SightLine<f64>, bool),
    ) {
        let Some(sky) = &self.sky else {
            for l in 0..LANES {
                let (line, seen, _) = self.double.line(satellite, terms, l);
                add(l, &line, seen);
            }
            return;
        };
        let points = Skyward {
            sites: &self.double,
            sky,
            mask: terms,
            slack,
        };
        let decide = |lane: usize| Some(sky.sees(lane, satellite, mask));
        points.look(satellite, decide, |l, line, seen, _| add(l, line, seen));
    }

    /// Largest distance of a point from the middle, km.
    fn widest_km(&self) -> f64 {
        let [x, y, z] = &self.single.origin;
        let distance = |l: usize| Vector3::new(x.0[l], y.0[l], z.0[l]).cast::<f64>().norm();
        (0..self.members.len()).map(distance).fold(0.0, f64::max)
    }
}

/// Points, from some origin.
fn site_lanes<R: Copy>(
    sites: &[Site],
    members: &[u32],
    from: [f64; 3],
    convert: impl Fn(f64) -> R,
    empty: R,
) -> SiteLanes<R> {
    let lanes = |part: fn(&Site) -> Vector3<f64>, from: f64, axis: usize| {
        Lanes(std::array::from_fn(|l| {
            members
                .get(l)
                .map_or(empty, |&m| convert(part(&sites[m as usize])[axis] - from))
        }))
    };
    SiteLanes {
        origin: [0, 1, 2].map(|axis| lanes(|site| site.local.origin_km.km(), from[axis], axis)),
        up: [0, 1, 2].map(|axis| lanes(|site| site.local.up, 0.0, axis)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RADIUS_KM: f64 = 6378.0;

    /// Points whose verticals are tilted by up to an angle, under a mask of 0°.
    fn horizon(tilt_rad: f64, widest_km: f64) -> Horizon {
        Horizon {
            farthest_km: RADIUS_KM,
            least_mask_rad: -tilt_rad,
            sin_most: tilt_rad.sin(),
            cos_most: tilt_rad.cos(),
            reach2: (RADIUS_KM * tilt_rad.cos()).powi(2),
            widest_km,
        }
    }

    fn between(nearest_km: f64, farthest_km: f64) -> Positions {
        Positions {
            nearest_km,
            farthest_km,
            ..Positions::new(1)
        }
    }

    /// By the law of cosines a satellite at r that is t below the horizon of a point at g has the distance d with
    /// r² = g² + d² - 2 g d sin t.
    #[test]
    fn validate_the_longest_line_of_sight() {
        for (tilt_rad, radius_km) in [(0.0, 7300.0), (0.0034, 7300.0), (0.3, 42_164.0)] {
            let longest_km = horizon(tilt_rad, 0.0).longest_km(&between(6500.0, radius_km));
            let below_km = 2.0 * RADIUS_KM * longest_km * f64::sin(tilt_rad);
            let radius2 = RADIUS_KM * RADIUS_KM + longest_km * longest_km - below_km;
            // Twenty roundings.
            let apart = (radius2.sqrt() / radius_km - 1.0).abs();
            assert!(apart < 20.0 * f64::EPSILON, "{tilt_rad}: {apart:e}");
        }
    }

    /// Bounds as wide as they must be and no wider: else samples would be decided again that need not be.
    #[test]
    fn the_slack_of_a_line_is_that_of_its_rounding() {
        let (widest_km, epsilon) = (400.0, f64::from(f32::EPSILON));
        let positions = between(RADIUS_KM + 800.0, RADIUS_KM + 900.0);
        let horizon = horizon(0.0, widest_km);
        // The shortest line is rotated most, the longest one is displaced most.
        let rotation_rad = 1.5 * epsilon * (800.0 + widest_km) / 800.0;
        let longest_km = (900.0 * (900.0 + 2.0 * RADIUS_KM)).sqrt();
        let rounding_km = 1.5 * epsilon * (longest_km + widest_km);
        let expected = SightSlack::new(rotation_rad, rounding_km, longest_km);
        let slack = horizon.single_slack(&positions);
        let are_close = |a: f32, b: f32| (a / b - 1.0).abs() < 4.0 * f32::EPSILON;
        assert!(are_close(slack.sine, expected.sine), "{slack:?}");
        let (level_km, expected_km) = (slack.least_level_km, expected.least_level_km);
        assert!(are_close(level_km, expected_km), "{slack:?}");
    }
}
