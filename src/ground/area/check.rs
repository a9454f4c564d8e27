//! Whether the rings of a polygon bound an area.

use super::{AreaError, Ring};
use crate::ground::is_longitude;
use crate::ground::shapes::LonLat;

/// Distance by which two edges must reach beyond each other to cross rather than touch, degrees: a tenth of a millimetre.
const TOUCH_DEG: f64 = 1e-9;

/// Checks the rings of one polygon: first the outer one, then the holes.
pub(super) fn polygon(place: &str, rings: &[Ring]) -> Result<(), AreaError> {
    for (n, ring) in rings.iter().enumerate() {
        closed(&format!("{place}[{n}]"), ring)?;
    }
    holes(place, rings)?;
    match crossing(rings) {
        None => Ok(()),
        Some(at) => Err(AreaError::Crossing {
            place: place.to_owned(),
            at,
        }),
    }
}

fn closed(place: &str, ring: &[LonLat]) -> Result<(), AreaError> {
    for (n, &[longitude_deg, latitude_deg]) in ring.iter().enumerate() {
        if !(is_longitude(longitude_deg) && (-90.0..=90.0).contains(&latitude_deg)) {
            return Err(AreaError::Position {
                place: format!("{place}[{n}]"),
                longitude_deg,
                latitude_deg,
            });
        }
    }
    if ring.len() < 4 {
        return Err(AreaError::Short {
            place: place.to_owned(),
            positions: ring.len(),
        });
    }
    if ring.first() != ring.last() {
        return Err(AreaError::Open {
            place: place.to_owned(),
        });
    }
    let is_long = |pair: &[LonLat]| {
        let span = (pair[1][0] - pair[0][0]).abs();
        // A whole turn is the edge of a map of the world.
        span > 180.0 && span != 360.0
    };
    match ring.windows(2).position(is_long) {
        None => Ok(()),
        Some(n) => Err(AreaError::LongEdge {
            place: format!("{place}[{n}]"),
            from_deg: ring[n][0],
            to_deg: ring[n + 1][0],
        }),
    }
}

/// South-west and north-east corner of the box around a ring.
fn corners(ring: &[LonLat]) -> [LonLat; 2] {
    let nothing = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    ring.iter().fold(nothing, |[low, high], [x, y]| {
        [
            [low[0].min(*x), low[1].min(*y)],
            [high[0].max(*x), high[1].max(*y)],
        ]
    })
}

/// Holes within the box of their polygon; that they do not cross its border is checked with all edges.
fn holes(place: &str, rings: &[Ring]) -> Result<(), AreaError> {
    let Some((outer, holes)) = rings.split_first() else {
        return Ok(());
    };
    let [low, high] = corners(outer);
    let outside = |hole: &Ring| {
        let [a, b] = corners(hole);
        (0..2).any(|axis| a[axis] < low[axis] || b[axis] > high[axis])
    };
    match holes.iter().position(outside) {
        None => Ok(()),
        Some(n) => Err(AreaError::Hole {
            place: format!("{place}[{}]", n + 1),
        }),
    }
}

/// An edge and the box around it.
#[derive(Clone, Copy)]
struct BorderEdge {
    from: LonLat,
    to: LonLat,
    south: f64,
    north: f64,
    west: f64,
    east: f64,
}

impl BorderEdge {
    fn new(from: LonLat, to: LonLat) -> Self {
        Self {
            from,
            to,
            south: from[1].min(to[1]),
            north: from[1].max(to[1]),
            west: from[0].min(to[0]),
            east: from[0].max(to[0]),
        }
    }

    /// Distance of a place to the left of the line through the edge, degrees.
    fn left(&self, [x, y]: LonLat) -> f64 {
        let (dx, dy) = (self.to[0] - self.from[0], self.to[1] - self.from[1]);
        let cross = dx * (y - self.from[1]) - dy * (x - self.from[0]);
        cross / dx.hypot(dy)
    }

    /// Whether the ends of another edge are on both sides of the line.
    fn parts(&self, other: &Self) -> bool {
        let (a, b) = (self.left(other.from), self.left(other.to));
        a.min(b) < -TOUCH_DEG && a.max(b) > TOUCH_DEG
    }

    fn crosses(&self, other: &Self) -> Option<LonLat> {
        if self.west > other.east || other.west > self.east {
            return None;
        }
        if !(self.parts(other) && other.parts(self)) {
            return None;
        }
        let (a, b) = (other.left(self.from), other.left(self.to));
        let share = a / (a - b);
        let along = |axis: usize| self.from[axis] + share * (self.to[axis] - self.from[axis]);
        Some([along(0), along(1)])
    }
}

/// A place where two edges cross, by a sweep from south to north over those that a parallel meets.
fn crossing(rings: &[Ring]) -> Option<LonLat> {
    let edges = rings.iter().flat_map(|ring| ring.windows(2));
    let edges = edges.filter(|pair| pair[0] != pair[1]);
    let mut segments: Vec<BorderEdge> = edges
        .map(|pair| BorderEdge::new(pair[0], pair[1]))
        .collect();
    segments.sort_by(|a, b| a.south.total_cmp(&b.south));
    let mut active: Vec<BorderEdge> = Vec::new();
    for segment in segments {
        active.retain(|other| other.north >= segment.south);
        if let Some(at) = active.iter().find_map(|other| segment.crosses(other)) {
            return Some(at);
        }
        active.push(segment);
    }
    None
}
