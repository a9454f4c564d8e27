//! Ground points in tiles of neighbours, and tiles in groups.
//!
//! A tile fills the lanes. Points are split in two along the longest side of their bounding box
//! until a tile is left, so that any set of points, a grid or not, gives compact tiles, and all
//! tiles but the last are full.
//!
//! A satellite at r sees the points within the angle ψ(r) = acos(k / r) - m of the point below it,
//! k = g cos m, for points at distance g from the centre and an elevation m over the horizon of
//! the sphere through them. It can see something of a cap of angular radius ρ around the unit
//! vector c only if r·c >= |r| cos(ψ + ρ), which is free of angles when written out:
//!
//! ```text
//! r·c + sin(ρ - m) q >= k cos(ρ - m),   q = sqrt(|r|² - k²)
//! ```
//!
//! Taking the smallest g of all points, and the mask less the largest angle between a vertical and
//! the radius, makes this hold for points of an ellipsoid too; it never leaves out a satellite
//! that is visible.

use super::flight::Positions;
use super::lanes::{LANES, Lanes, SiteLanes};
use crate::ground::Site;
use crate::visibility::Mask;
use nalgebra::Vector3;
use std::f64::consts::FRAC_PI_2;

/// Tiles that are culled together first.
const TILES_IN_GROUP: usize = 32;

/// The test of a cap against a satellite: `x`, `y`, `z`, `q` coefficients and the bound.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cap {
    pub(super) centre: [f32; 3],
    pub(super) sine: f32,
    pub(super) bound: f32,
}

/// Points that are worked on side by side.
#[derive(Debug, Clone)]
pub(super) struct Tile {
    /// Index of the point in each lane; shorter than the lanes in the last tile.
    pub(super) members: Vec<u32>,
    pub(super) single: SiteLanes<f32>,
    pub(super) double: SiteLanes<f64>,
    pub(super) cap: Cap,
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
}

/// What bounds the sight of all points together.
#[derive(Debug, Clone, Copy)]
pub(super) struct Horizon {
    /// Largest distance of a point from the centre of the Earth, km.
    farthest_km: f64,
    /// Least elevation over the horizon of the sphere of what is at the mask, radians; and sine
    /// and cosine of the largest.
    least_mask_rad: f64,
    sin_most: f64,
    cos_most: f64,
    /// k², km²: what is nearer to the centre than k is nowhere visible.
    pub(super) reach2: f64,
}

impl Horizon {
    fn new(sites: &[Site], mask: Mask) -> Self {
        let mut tilt: f64 = 0.0;
        let (mut nearest_km, mut farthest_km) = (f64::INFINITY, 0.0_f64);
        for site in sites {
            let radius = site.local.origin_km.norm();
            nearest_km = nearest_km.min(radius);
            farthest_km = farthest_km.max(radius);
            tilt = tilt.max(site.local.origin_km.cross(&site.local.up).norm() / radius);
        }
        let (mask_rad, tilt_rad) = (mask.degrees().to_radians(), tilt.min(1.0).asin());
        let (sin_most, cos_most) = (mask_rad + tilt_rad).min(FRAC_PI_2).sin_cos();
        Self {
            farthest_km,
            least_mask_rad: mask_rad - tilt_rad,
            sin_most,
            cos_most,
            reach2: (nearest_km * (mask_rad - tilt_rad).cos()).powi(2),
        }
    }

    /// Smallest distance from a point to a satellite at the mask that is `radius_km` from the
    /// centre; 0 for one that is not above all points.
    fn range_at_mask_km(&self, radius_km: f64) -> f64 {
        let beyond = radius_km.powi(2) - (self.farthest_km * self.cos_most).powi(2);
        (beyond.max(0.0).sqrt() - self.farthest_km * self.sin_most).max(0.0)
    }

    /// By how much the sine of an elevation at the mask may be wrong in f32: two positions that
    /// were rounded by half a unit in each of three components, over the shortest range; and
    /// eight roundings of the sine itself.
    #[inline(always)]
    pub(super) fn sine_slack(&self, positions: &Positions) -> f32 {
        const ROOT_3: f64 = 1.732_050_807_568_877_2;
        let rounding_km = positions.farthest_km * f64::from(f32::EPSILON) * ROOT_3;
        let range_km = self.range_at_mask_km(positions.nearest_km);
        let slack = rounding_km / range_km + 4.0 * f64::from(f32::EPSILON);
        // Satellites on the ground leave nothing to f32.
        slack.min(2.0) as f32
    }

    /// By how much a test of a cap may be wrong in f32, km: eight roundings of the largest
    /// number in it, and as much again.
    #[inline(always)]
    pub(super) fn cap_slack_km(positions: &Positions) -> f32 {
        positions.farthest_km as f32 * (16.0 * f32::EPSILON)
    }

    fn cap(&self, sites: &[Site], members: &[u32]) -> Cap {
        let units = members
            .iter()
            .map(|&m| sites[m as usize].local.origin_km.normalize());
        let sum: Vector3<f64> = units.clone().sum();
        let Some(centre) = sum.try_normalize(1e-6) else {
            return Cap::EVERYTHING;
        };
        let radius = units.map(|u| u.angle(&centre)).fold(0.0_f64, f64::max);
        // Caps near a hemisphere and beyond are not worth a test.
        if radius > 1.2 {
            return Cap::EVERYTHING;
        }
        let angle = radius - self.least_mask_rad;
        Cap {
            centre: centre.map(|x| x as f32).into(),
            sine: angle.sin() as f32,
            bound: (self.reach2.sqrt() * angle.cos()) as f32,
        }
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
    pub(super) fn new(sites: &[Site], mask: Mask) -> Self {
        let horizon = Horizon::new(sites, mask);
        let mut members: Vec<u32> = (0..sites.len() as u32).collect();
        let mut tiles = Self {
            tiles: Vec::with_capacity(sites.len().div_ceil(LANES)),
            groups: Vec::new(),
            horizon,
        };
        tiles.split(sites, &mut members);
        tiles
    }

    /// Points of all tiles, lanes without a point included.
    pub(super) fn slots(&self) -> usize {
        self.tiles.len() * LANES
    }

    fn split(&mut self, sites: &[Site], members: &mut [u32]) {
        let count = members.len().div_ceil(LANES);
        if count <= TILES_IN_GROUP {
            let first = self.tiles.len();
            let cap = self.horizon.cap(sites, members);
            self.split_group(sites, members);
            let tiles = first..self.tiles.len();
            self.groups.push(Group { tiles, cap });
            return;
        }
        let (left, right) = halves(sites, members);
        self.split(sites, left);
        self.split(sites, right);
    }

    fn split_group(&mut self, sites: &[Site], members: &mut [u32]) {
        if members.len() <= LANES {
            self.tiles.push(Tile {
                single: site_lanes(sites, members, |x| x as f32, f32::NAN),
                double: site_lanes(sites, members, |x| x, f64::NAN),
                cap: self.horizon.cap(sites, members),
                members: members.to_vec(),
            });
            return;
        }
        let (left, right) = halves(sites, members);
        self.split_group(sites, left);
        self.split_group(sites, right);
    }
}

/// The members on both sides of a cut across the longest side of their bounding box, the left a
/// whole number of tiles.
fn halves<'a>(sites: &[Site], members: &'a mut [u32]) -> (&'a mut [u32], &'a mut [u32]) {
    let position = |m: u32| sites[m as usize].local.origin_km;
    let first = position(members[0]);
    let (mut low, mut high) = (first, first);
    for &m in &*members {
        low = low.inf(&position(m));
        high = high.sup(&position(m));
    }
    let axis = (high - low).imax();
    let cut = members.len().div_ceil(LANES).div_ceil(2) * LANES;
    // Ties are broken by the order of the points, so that the tiles do not depend on the sort.
    members.sort_unstable_by(|&a, &b| {
        position(a)[axis]
            .total_cmp(&position(b)[axis])
            .then(a.cmp(&b))
    });
    members.split_at_mut(cut)
}

fn site_lanes<R: Copy>(
    sites: &[Site],
    members: &[u32],
    convert: impl Fn(f64) -> R,
    empty: R,
) -> SiteLanes<R> {
    let lanes = |part: fn(&Site) -> Vector3<f64>, axis: usize| {
        Lanes(std::array::from_fn(|l| {
            members
                .get(l)
                .map_or(empty, |&m| convert(part(&sites[m as usize])[axis]))
        }))
    };
    SiteLanes {
        origin: [0, 1, 2].map(|axis| lanes(|site| site.local.origin_km, axis)),
        up: [0, 1, 2].map(|axis| lanes(|site| site.local.up, axis)),
    }
}
