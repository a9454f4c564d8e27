//! The horizon of a point on a terrain, by scanning rays over it.

use super::Terrain;
use crate::earth::{RADIUS_KM, Surface};
use crate::ground::Site;
use nalgebra::Vector3;

/// Rays around a point; the horizon is linear in azimuth between them.
const RAYS: usize = 720;

/// Length of the pieces of a ray that are straight in latitude and longitude, km: they leave the vertical plane by
/// L² tan φ/(8 R), 2 cm at a latitude of 45°.
const PIECE_KM: f64 = 1.0;

/// Terrain nearer than that has no direction, km.
const NEAREST_KM: f64 = 1e-9;

/// The view from a point.
pub(super) struct Scan<'a> {
    terrain: &'a Terrain,
    site: &'a Site,
    /// The point in steps of the terrain.
    place: [f64; 2],
    /// The square of b/a of the surface.
    squared_ratio: f64,
    /// The foot of the point on the surface, km.
    foot_km: Vector3<f64>,
}

/// A horizon.
pub(super) struct TerrainHorizon {
    /// (azimuth, elevation), degrees; azimuths from 0 to 360, elevations at least 0.
    pub(super) vertices_deg: Vec<(f64, f64)>,
    /// The shortest distance at which a ray ended with the terrain, while higher ground could still have been seen, km.
    pub(super) end_km: Option<f64>,
}

impl TerrainHorizon {
    pub(super) fn highest_deg(&self) -> f64 {
        let elevations = self.vertices_deg.iter().map(|vertex| vertex.1);
        elevations.fold(0.0, f64::max)
    }
}

/// A place on the surface below a ray.
#[derive(Clone, Copy)]
struct Foot {
    /// Distance along the horizontal of the point, km.
    along_km: f64,
    /// In steps of the terrain.
    place: [f64; 2],
    /// The vertical there along the ray and along the vertical of the point.
    normal: [f64; 2],
}

/// A vertical plane through the point.
struct Ray<'a> {
    scan: &'a Scan<'a>,
    direction: Vector3<f64>,
    /// Coefficients of the section of the surface: t² dd + 2 t z du + z² uu + 2 z of foot and vertical = 0.
    along: f64,
    mixed: f64,
    vertical: f64,
    drop: f64,
    /// Tangent of the highest elevation so far.
    highest: f64,
}

impl<'a> Scan<'a> {
    pub(super) fn new(
        terrain: &'a Terrain,
        site: &'a Site,
        place: [f64; 2],
        surface: Surface,
    ) -> Self {
        let ratio = 1.0 - surface.flattening();
        let foot_km = site.local.origin_km.km() - site.local.up * (site.height_m / 1000.0);
        Self {
            terrain,
            site,
            place,
            squared_ratio: ratio * ratio,
            foot_km,
        }
    }

    /// The horizon all around, or the place, in steps, of a hole in sight.
    pub(super) fn horizon(&self) -> Result<TerrainHorizon, [f64; 2]> {
        let mut vertices_deg = Vec::with_capacity(RAYS + 1);
        let mut end_km: Option<f64> = None;
        for n in 0..RAYS {
            let azimuth_deg = 360.0 * n as f64 / RAYS as f64;
            let mut ray = self.ray(azimuth_deg.to_radians());
            if let Some(end) = ray.follow()? {
                end_km = Some(end_km.map_or(end, |nearest| nearest.min(end)));
            }
            vertices_deg.push((azimuth_deg, ray.highest.atan().to_degrees()));
        }
        vertices_deg.push((360.0, vertices_deg[0].1));
        Ok(TerrainHorizon {
            vertices_deg,
            end_km,
        })
    }

    fn ray(&self, azimuth_rad: f64) -> Ray<'_> {
        let local = &self.site.local;
        let (sin, cos) = azimuth_rad.sin_cos();
        let direction = local.east * sin + local.north * cos;
        Ray {
            scan: self,
            direction,
            along: self.product(direction, direction),
            mixed: self.product(direction, local.up),
            vertical: self.product(local.up, local.up),
            drop: self.product(self.foot_km, local.up),
            // Below the horizon is the horizon.
            highest: 0.0,
        }
    }

    /// The quadratic form of the surface, which is R² on it.
    fn product(&self, a: Vector3<f64>, b: Vector3<f64>) -> f64 {
        a.x * b.x + a.y * b.y + a.z * b.z / self.squared_ratio
    }
}

impl Ray<'_> {
    /// Raises the horizon to what is seen along the ray; the distance at which the terrain ended in sight, if it did.
    fn follow(&mut self) -> Result<Option<f64>, [f64; 2]> {
        let mut from = Foot {
            along_km: 0.0,
            place: self.scan.place,
            normal: [0.0, 1.0],
        };
        while from.along_km < RADIUS_KM {
            if self.elevation(from.along_km, self.scan.terrain.highest_m, from.normal)
                <= self.highest
            {
                return Ok(None);
            }
            let to = self.foot(from.along_km + PIECE_KM);
            self.cross(0, from, to)?;
            self.cross(1, from, to)?;
            if !self.scan.terrain.contains(to.place) {
                return Ok(Some(from.along_km));
            }
            from = to;
        }
        Ok(None)
    }

    /// How far the surface is above the horizontal of the foot, km: it falls away.
    fn above_km(&self, along_km: f64) -> f64 {
        let half = self.drop + along_km * self.mixed;
        let squared = along_km * along_km * self.along;
        -squared / (half + (half * half - squared * self.vertical).max(0.0).sqrt())
    }

    /// The surface under the ray.
    fn foot(&self, along_km: f64) -> Foot {
        let scan = self.scan;
        let local = &scan.site.local;
        let at = scan.foot_km + self.direction * along_km + local.up * self.above_km(along_km);
        let normal = Vector3::new(at.x, at.y, at.z / scan.squared_ratio).normalize();
        let latitude_deg = normal.z.atan2(normal.x.hypot(normal.y)).to_degrees();
        // Longitude from that of the point, so that it does not jump.
        let start = scan.foot_km;
        let (sin, cos) = (
            start.x * at.y - start.y * at.x,
            start.x * at.x + start.y * at.y,
        );
        let eastwards_deg = sin.atan2(cos).to_degrees();
        let terrain = scan.terrain;
        Foot {
            along_km,
            place: [
                (latitude_deg - terrain.raster.south_west_deg[0]) / terrain.raster.step_deg[0],
                scan.place[1] + eastwards_deg / terrain.raster.step_deg[1],
            ],
            normal: [normal.dot(&self.direction), normal.dot(&local.up)],
        }
    }

    /// Raises the horizon to the terrain where a piece of the ray crosses lines of the lattice: rows (axis 0) or columns.
    fn cross(&mut self, axis: usize, from: Foot, to: Foot) -> Result<(), [f64; 2]> {
        let terrain = self.scan.terrain;
        let (start, end) = (from.place[axis], to.place[axis]);
        let lines = [terrain.raster.rows, terrain.raster.columns];
        let low = start.min(end).ceil().max(0.0) as usize;
        let high = start.max(end).floor().min((lines[axis] - 1) as f64);
        if high < 0.0 || start == end {
            return Ok(());
        }
        let mix = |a: f64, b: f64, share: f64| a + (b - a) * share;
        for line in low..=high as usize {
            let share = (line as f64 - start) / (end - start);
            let across = mix(from.place[1 - axis], to.place[1 - axis], share);
            if !(0.0..=(lines[1 - axis] - 1) as f64).contains(&across) {
                continue;
            }
            let along_km = mix(from.along_km, to.along_km, share);
            if along_km < NEAREST_KM {
                continue;
            }
            let node = (across as usize).min(lines[1 - axis] - 2);
            let [first_m, second_m] = [node, node + 1].map(|node| match axis {
                0 => terrain.node_m(line, node),
                _ => terrain.node_m(node, line),
            });
            let height_m = mix(first_m, second_m, across - node as f64);
            if height_m.is_nan() {
                let (line, across) = (line as f64, across);
                return Err(if axis == 0 {
                    [line, across]
                } else {
                    [across, line]
                });
            }
            let normal = [0, 1].map(|n| mix(from.normal[n], to.normal[n], share));
            let elevation = self.elevation(along_km, height_m, normal);
            self.highest = self.highest.max(elevation);
        }
        Ok(())
    }

    /// Tangent of the elevation at which a height over the surface is seen.
    fn elevation(&self, along_km: f64, height_m: f64, normal: [f64; 2]) -> f64 {
        let height_km = height_m / 1000.0;
        let across_km = along_km + height_km * normal[0];
        let up_km =
            self.above_km(along_km) + height_km * normal[1] - self.scan.site.height_m / 1000.0;
        // At the point itself anything above it is at the zenith.
        if across_km > 0.0 {
            up_km / across_km
        } else {
            up_km.signum() * f64::INFINITY
        }
    }
}
