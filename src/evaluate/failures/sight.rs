//! Which satellites the points see at an instant: the plain definition, on the few satellites that a point may see.

use crate::evaluate::Setup;
use crate::frames::{EarthFixed, Position};
use nalgebra::Vector3;

/// Points of a leaf.
const LEAF: usize = 8;

/// Widens every cap, radians: more than the rounding of all angles.
const SLACK_RAD: f64 = 1e-6;

/// How far a satellite at some distance may be from a point that sees it is kept for distances up to this much larger.
const REUSED: f64 = 1.001;

/// The points as a tree of caps: those of a node lie within an angle of its centre.
pub(super) struct SightTree {
    nodes: Vec<SightNode>,
    /// The points, leaf by leaf.
    sites: Vec<usize>,
    /// Least distance of a point from the centre of the Earth, km.
    least_radius_km: f64,
    /// Lowest elevation over the sphere through a point at which a satellite may clear the mask, radians.
    least_elevation_rad: f64,
}

/// The points of a node: a range, and the nodes of its halves, which are the next one and another.
struct SightNode {
    centre: Vector3<f64>,
    sin_radius: f64,
    cos_radius: f64,
    sites: std::ops::Range<usize>,
    second_half: Option<usize>,
}

/// The cap of points that may see satellites up to a distance.
#[derive(Clone, Copy, Default)]
pub(super) struct Reach {
    up_to_km: f64,
    sin: f64,
    cos: f64,
}

impl SightTree {
    pub(super) fn new(setup: &Setup) -> Self {
        let directions: Vec<Vector3<f64>> = setup
            .sites
            .iter()
            .map(|site| site.local.origin_km.km().normalize())
            .collect();
        let radii = setup
            .sites
            .iter()
            .map(|site| site.local.origin_km.km().norm());
        // The vertical of an ellipsoid leans against the direction from the centre.
        let leans = setup.sites.iter().zip(&directions);
        let leans = leans.map(|(site, direction)| site.local.up.angle(direction));
        let mut tree = Self {
            nodes: Vec::new(),
            sites: (0..setup.sites.len()).collect(),
            least_radius_km: radii.fold(f64::INFINITY, f64::min),
            least_elevation_rad: setup.mask.degrees().to_radians()
                - leans.fold(0.0, f64::max)
                - SLACK_RAD,
        };
        tree.divide(0..setup.sites.len(), &directions);
        tree
    }

    /// Adds the node of a range of points and those below it.
    fn divide(&mut self, range: std::ops::Range<usize>, directions: &[Vector3<f64>]) {
        let members = &mut self.sites[range.clone()];
        let sum: Vector3<f64> = members.iter().map(|site| directions[*site]).sum();
        let centre = sum.try_normalize(1e-9).unwrap_or_else(Vector3::z);
        let radii = members.iter().map(|site| directions[*site].angle(&centre));
        let (sin_radius, cos_radius) = (radii.fold(0.0, f64::max) + SLACK_RAD).sin_cos();
        let number = self.nodes.len();
        if members.len() > LEAF {
            let spread = |axis: usize| {
                let values = || members.iter().map(|site| directions[*site][axis]);
                values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min)
            };
            let axis = (0..3).fold(0, |best, axis| {
                if spread(axis) > spread(best) {
                    axis
                } else {
                    best
                }
            });
            members.sort_by(|a, b| directions[*a][axis].total_cmp(&directions[*b][axis]));
        }
        self.nodes.push(SightNode {
            centre,
            sin_radius,
            cos_radius,
            sites: range.clone(),
            second_half: None,
        });
        if range.len() > LEAF {
            let middle = range.start + range.len() / 2;
            self.divide(range.start..middle, directions);
            self.nodes[number].second_half = Some(self.nodes.len());
            self.divide(middle..range.end, directions);
        }
    }

    /// The cap of a satellite at this distance from the centre of the Earth, from that of the last satellite if it holds.
    pub(super) fn reach(&self, last: Reach, distance_km: f64) -> Reach {
        if distance_km <= last.up_to_km && distance_km * REUSED * REUSED >= last.up_to_km {
            return last;
        }
        let up_to_km = distance_km * REUSED;
        let elevation = self.least_elevation_rad;
        let cosine = (self.least_radius_km * elevation.cos() / up_to_km).min(1.0);
        let (sin, cos) = (cosine.acos() - elevation + SLACK_RAD).sin_cos();
        Reach { up_to_km, sin, cos }
    }

    /// The share of a sphere from which satellites up to this distance may be seen.
    pub(super) fn share_of_sphere(&self, distance_km: f64) -> f64 {
        if distance_km.is_finite() {
            (1.0 - self.reach(Reach::default(), distance_km).cos) / 2.0
        } else {
            0.5
        }
    }

    /// Calls `see` for each point that sees a satellite, with the unit vector to it.
    pub(super) fn visit(
        &self,
        setup: &Setup,
        target_km: Position<EarthFixed>,
        (direction, reach): (Vector3<f64>, Reach),
        see: &mut impl FnMut(usize, Vector3<f64>),
    ) {
        let mut waiting = [0_usize; usize::BITS as usize];
        let mut count = usize::from(!self.sites.is_empty());
        while count > 0 {
            count -= 1;
            let number = waiting[count];
            let cap = &self.nodes[number];
            // Of the sum of both angles, which is below a half turn unless a node is wider than what is seen of it.
            let widest = reach.cos * cap.cos_radius - reach.sin * cap.sin_radius;
            let is_wide = reach.sin * cap.cos_radius + reach.cos * cap.sin_radius < 0.0;
            if !is_wide && direction.dot(&cap.centre) < widest {
                continue;
            }
            if let Some(second_half) = cap.second_half {
                waiting[count] = second_half;
                waiting[count + 1] = number + 1;
                count += 2;
                continue;
            }
            for &site in &self.sites[cap.sites.clone()] {
                let unit = setup.sites[site].line_of_sight(setup.mask, target_km);
                if let Some(unit) = unit {
                    see(site, unit);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::earth::Surface;
    use crate::evaluate::testing::setup;
    use crate::ground::Site;
    use crate::time::{Epoch, TimeGrid};

    fn tree() -> SightTree {
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let grid = TimeGrid::new(epoch, 600.0, 60.0).unwrap();
        let places = (0..60).map(|n| (f64::from(n % 2), f64::from(n)));
        let site = |(latitude, longitude)| Site::new(Surface::Sphere, latitude, longitude, 1.0);
        let sites = places.map(|place| site(place).unwrap()).collect();
        SightTree::new(&setup(grid, sites, 0.0))
    }

    /// Points along 59° of the equator: a half is a strip of half the length, so that most halves lie beyond the reach of a
    /// satellite. Divided across the strip, both would be as long as the whole.
    #[test]
    fn points_are_divided_along_the_longest_side() {
        let tree = tree();
        let radius_deg = |node: usize| tree.nodes[node].cos_radius.acos().to_degrees();
        assert!((radius_deg(0) - 29.5).abs() < 0.1, "{}", radius_deg(0));
        for half in [1, tree.nodes[0].second_half.unwrap()] {
            // 29 steps of a degree, the rows of the latitudes 0 and 1, and the slack.
            assert!(
                (radius_deg(half) - 14.5).abs() < 0.1,
                "{}",
                radius_deg(half)
            );
        }
    }

    /// A satellite at the radius r is seen from the horizon of a sphere of the radius R at the angle acos(R/r): the cap has
    /// the share (1 - R/r)/2 of the sphere. From afar it is a half.
    #[test]
    fn validate_the_share_of_a_sphere_from_which_a_point_is_seen() {
        let tree = tree();
        let radius_km = 6378.137;
        for distance_km in [7000.0, 10_000.0, 26_560.0] {
            // The cap is that of a distance larger by REUSED, and wider by the slack.
            let least = (1.0 - radius_km / (distance_km * REUSED)) / 2.0;
            let found = tree.share_of_sphere(distance_km);
            let range = least..least + 2.0 * SLACK_RAD;
            assert!(range.contains(&found), "{found} in {range:?}");
        }
        assert_eq!(tree.share_of_sphere(f64::INFINITY), 0.5);
    }
}
