//! Areas bounded by polygons, and the ground points inside.
//!
//! Edges are straight in longitude and latitude (RFC 7946, 3.1.1). A point on a border shared by two
//! polygons is inside one of them: a polygon includes its western and southern borders.

mod check;
mod geojson;
mod points;

pub use points::AreaPoints;
pub(super) use points::FINEST_STEP_DEG;

use super::authalic::Authalic;
use super::shapes::LonLat;
use crate::earth::Surface;
use thiserror::Error;

/// Most positions of an area.
pub(super) const MAX_POSITIONS: usize = 1_000_000;

/// Why polygons are not an area. Each place is that of a member of the GeoJSON.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum AreaError {
    /// Not JSON, or not an object.
    #[error("not GeoJSON: {0}")]
    Json(String),
    /// A member that is missing or of another kind.
    #[error("{place}: expected {expected}")]
    Member {
        /// The member.
        place: String,
        /// What belongs there.
        expected: &'static str,
    },
    /// An object that has no area.
    #[error(
        "{place}: found {kind:?}, expected a Polygon or a MultiPolygon, alone or in features and collections"
    )]
    Kind {
        /// The object.
        place: String,
        /// Its type.
        kind: String,
    },
    /// Coordinates of another reference system.
    #[error(
        "crs: the coordinates are in {0}, expected WGS 84 longitude and latitude (RFC 7946, 4)"
    )]
    ReferenceSystem(String),
    /// A ring of fewer than four positions.
    #[error(
        "{place}: found {positions} positions, expected at least 4, of which the last repeats the first"
    )]
    Short {
        /// The ring.
        place: String,
        /// Its positions.
        positions: usize,
    },
    /// A ring whose last position is not its first.
    #[error("{place}: the ring is not closed: its last position must repeat its first")]
    Open {
        /// The ring.
        place: String,
    },
    /// A position out of range.
    #[error(
        "{place}: longitude {longitude_deg}, latitude {latitude_deg} is out of range: longitude comes first, from -360 to 720, \
         then latitude from -90 to 90 degrees"
    )]
    Position {
        /// The position.
        place: String,
        /// East longitude, degrees.
        longitude_deg: f64,
        /// Latitude, degrees.
        latitude_deg: f64,
    },
    /// An edge that goes around the Earth the long way.
    #[error(
        "{place}: the edge from longitude {from_deg} to {to_deg} spans more than 180 degrees: across the antimeridian write \
         [179, 181] rather than [179, -179], or give a position in between"
    )]
    LongEdge {
        /// Its first position.
        place: String,
        /// Longitude where it begins, degrees.
        from_deg: f64,
        /// Longitude where it ends, degrees.
        to_deg: f64,
    },
    /// Two edges of one polygon that cross.
    #[error("{place}: the border crosses itself near longitude {:.4}, latitude {:.4} degrees", .at[0], .at[1])]
    Crossing {
        /// The polygon.
        place: String,
        /// Where: longitude and latitude, degrees.
        at: [f64; 2],
    },
    /// A hole that is not within its polygon.
    #[error("{place}: the hole reaches outside its polygon")]
    Hole {
        /// The hole.
        place: String,
    },
    /// No polygon at all.
    #[error("there is no polygon in it")]
    Empty,
    /// More positions than are read.
    #[error("found more than {MAX_POSITIONS} positions; simplify the polygons")]
    TooMany,
}

/// A closed ring of [longitude, latitude], degrees; the last position repeats the first.
pub(super) type Ring = Vec<LonLat>;

/// Degrees of latitude in which edges are looked up.
const BANDS: usize = 180;

/// The union of polygons with holes.
#[derive(Debug, Clone)]
pub struct ServiceArea {
    /// For each polygon, the outer ring and the holes.
    polygons: Vec<Vec<Ring>>,
    /// The edges that pass through each degree of latitude, from the south.
    bands: Vec<Vec<Edge>>,
}

/// An edge that is not along a parallel.
#[derive(Debug, Clone, Copy)]
struct Edge {
    polygon: u32,
    south: LonLat,
    north: LonLat,
}

impl Edge {
    /// Where it crosses a parallel; the same for both directions in which a border can be written.
    fn longitude_deg(&self, latitude_deg: f64) -> Option<f64> {
        let ([x0, y0], [x1, y1]) = (self.south, self.north);
        let crosses = (y0..y1).contains(&latitude_deg);
        crosses.then(|| x0 + (x1 - x0) * ((latitude_deg - y0) / (y1 - y0)))
    }
}

impl ServiceArea {
    /// The polygons of a GeoJSON object (RFC 7946): a Polygon, a MultiPolygon, or features and collections of them.
    ///
    /// # Errors
    /// If it is something else, or a ring is not closed, out of range or crosses itself; with the place.
    pub fn from_geojson(bytes: &[u8]) -> Result<Self, AreaError> {
        let polygons = geojson::polygons(bytes)?;
        for polygon in &polygons {
            check::polygon(&polygon.place, &polygon.rings)?;
        }
        let rings = polygons.into_iter().map(|polygon| polygon.rings);
        Ok(Self::of_polygons(rings.collect()))
    }

    /// What is wrong with the polygons of an area, for tests of built-in data.
    #[cfg(test)]
    pub(super) fn check(&self) -> Result<(), AreaError> {
        let mut polygons = self.polygons.iter();
        polygons.try_for_each(|rings| check::polygon("", rings))
    }

    /// Polygons that are sound.
    pub(super) fn of_polygons(polygons: Vec<Vec<Ring>>) -> Self {
        let mut bands = vec![Vec::new(); BANDS];
        for (n, rings) in polygons.iter().enumerate() {
            for pair in rings.iter().flat_map(|ring| ring.windows(2)) {
                let (a, b) = (pair[0], pair[1]);
                if a[1] == b[1] {
                    continue;
                }
                let (south, north) = if a[1] < b[1] { (a, b) } else { (b, a) };
                let edge = Edge {
                    polygon: n as u32,
                    south,
                    north,
                };
                bands[band(south[1])..=band(north[1])]
                    .iter_mut()
                    .for_each(|band| band.push(edge));
            }
        }
        Self { polygons, bands }
    }

    /// The borders, as closed lines of [longitude, latitude], degrees.
    #[must_use]
    pub fn outlines(&self) -> Vec<Vec<[f64; 2]>> {
        self.polygons.iter().flatten().cloned().collect()
    }

    /// The southernmost and northernmost latitude, degrees.
    fn latitudes_deg(&self) -> [f64; 2] {
        let latitudes = self
            .polygons
            .iter()
            .flatten()
            .flatten()
            .map(|place| place[1]);
        latitudes.fold([90.0, -90.0], |[lo, hi], y| [lo.min(y), hi.max(y)])
    }

    /// Whether a place is inside; longitudes a turn apart are the same place.
    #[must_use]
    pub fn contains(&self, latitude_deg: f64, longitude_deg: f64) -> bool {
        let x = wrapped(longitude_deg);
        let row = self.row(latitude_deg);
        row.iter().any(|[west, east]| (*west..*east).contains(&x))
    }

    /// The spans of longitude inside along a parallel, each with its western end, within [-180°, 180°), ascending.
    fn row(&self, latitude_deg: f64) -> Vec<[f64; 2]> {
        // The pole belongs to the areas that reach it, although it is their northern border.
        let latitude_deg = latitude_deg.min(90_f64.next_down());
        let edges = self.bands[band(latitude_deg)].iter();
        let mut crossings: Vec<(u32, f64)> = edges
            .filter_map(|edge| Some((edge.polygon, edge.longitude_deg(latitude_deg)?)))
            .collect();
        crossings.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        // A closed ring crosses a parallel an even number of times, so that no pair has two polygons.
        let spans = crossings.chunks_exact(2).map(|pair| [pair[0].1, pair[1].1]);
        merged(spans.flat_map(within_a_turn).collect())
    }

    /// The area on a surface, km²: of all polygons together, where they overlap more than once ([M-54](crate::models#m-54)).
    #[must_use]
    pub fn area_km2(&self, surface: Surface) -> f64 {
        let authalic = Authalic::new(surface);
        let of_polygon = |rings: &Vec<Ring>| {
            let mut areas = rings.iter().map(|ring| ring_area(authalic, ring).abs());
            let outer = areas.next().unwrap_or(0.0);
            outer - areas.sum::<f64>()
        };
        authalic.radius2_km2() * self.polygons.iter().map(of_polygon).sum::<f64>()
    }
}

/// The index of the degree of latitude that holds a latitude.
fn band(latitude_deg: f64) -> usize {
    ((latitude_deg + 90.0).floor() as usize).min(BANDS - 1)
}

/// A longitude in [-180°, 180°), unchanged if it is there.
pub(super) fn wrapped(longitude_deg: f64) -> f64 {
    if (-180.0..180.0).contains(&longitude_deg) {
        return longitude_deg;
    }
    longitude_deg - 360.0 * ((longitude_deg + 180.0) / 360.0).floor()
}

/// A span of longitude, moved into [-180°, 180°) and cut at its ends.
fn within_a_turn([west, east]: [f64; 2]) -> Vec<[f64; 2]> {
    if east - west >= 360.0 {
        return vec![[-180.0, 180.0]];
    }
    let turns = 360.0 * ((west + 180.0) / 360.0).floor();
    let (west, east) = (west - turns, east - turns);
    if east <= 180.0 {
        vec![[west, east]]
    } else {
        vec![[west, 180.0], [-180.0, east - 360.0]]
    }
}

/// Spans that overlap or touch, joined.
fn merged(mut spans: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    spans.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut joined: Vec<[f64; 2]> = Vec::with_capacity(spans.len());
    for [west, east] in spans {
        match joined.last_mut() {
            Some(last) if west <= last[1] => last[1] = last[1].max(east),
            _ => joined.push([west, east]),
        }
    }
    joined
}

/// Nodes and weights of Gauss and Legendre with eight points on [0, 1].
const GAUSS: [(f64, f64); 8] = [
    (0.019_855_071_751_231_884, 0.050_614_268_145_188_13),
    (0.101_666_761_293_186_63, 0.111_190_517_226_687_24),
    (0.237_233_795_041_835_5, 0.156_853_322_938_943_64),
    (0.408_282_678_752_175_1, 0.181_341_891_689_181),
    (0.591_717_321_247_825, 0.181_341_891_689_181),
    (0.762_766_204_958_164_5, 0.156_853_322_938_943_64),
    (0.898_333_238_706_813_4, 0.111_190_517_226_687_24),
    (0.980_144_928_248_768_1, 0.050_614_268_145_188_13),
];

/// The solid angle of a ring on the sphere of equal area, positive if it is clockwise: the integral of the sine of the
/// authalic latitude over longitude.
fn ring_area(authalic: Authalic, ring: &[LonLat]) -> f64 {
    let edge = |pair: &[LonLat]| {
        let ([x0, y0], [x1, y1]) = (pair[0], pair[1]);
        let sine = |(share, weight): (f64, f64)| {
            weight * authalic.sine((y0 + share * (y1 - y0)).to_radians())
        };
        let mean: f64 = GAUSS.into_iter().map(sine).sum();
        (x1 - x0).to_radians() * mean
    };
    ring.windows(2).map(edge).sum()
}

#[cfg(test)]
mod tests;
