//! Lines and areas on the ground for maps: footprints, grid cells and ground tracks, cut at the
//! antimeridian.
//!
//! Points are [longitude, latitude] in degrees, as in RFC 7946, 3.1.1; areas are closed rings
//! within ±180°, counterclockwise seen from above (3.1.6), one on each side of the antimeridian
//! (3.1.9).

use crate::earth::Surface;
use crate::frames::{EarthFixed, LocalFrame, Position};
use crate::units::round_decimal;
use nalgebra::Vector3;
use std::f64::consts::{FRAC_PI_2, TAU};

/// A place on the map: longitude and latitude, degrees.
pub(crate) type LonLat = [f64; 2];

/// Corners of a footprint.
const CORNERS: usize = 72;

/// Decimals of a degree in maps: a decimetre.
const DECIMALS: usize = 6;

/// The circle of ground points from which a satellite is at the mask, counterclockwise,
/// not closed ([M-38](crate::models#m-38)).
pub(crate) fn footprint(
    surface: Surface,
    satellite_km: Position<EarthFixed>,
    mask_rad: f64,
) -> Vec<LonLat> {
    let centre = satellite_km.km().normalize();
    // A horizontal direction, from an axis that is not close to the vertical.
    let axis = if centre.z.abs() < 0.9 {
        Vector3::z()
    } else {
        Vector3::x()
    };
    let east = axis.cross(&centre).normalize();
    let north = centre.cross(&east);
    (0..CORNERS)
        .map(|k| {
            let (sin, cos) = (TAU * k as f64 / CORNERS as f64).sin_cos();
            let towards = east * cos + north * sin;
            edge(
                surface,
                satellite_km,
                BoundaryArc { centre, towards },
                mask_rad,
            )
        })
        .collect()
}

/// A great circle through two perpendicular unit vectors.
#[derive(Clone, Copy)]
struct BoundaryArc {
    centre: Vector3<f64>,
    towards: Vector3<f64>,
}

impl BoundaryArc {
    /// The unit vector at an angle from the centre.
    fn direction(self, angle_rad: f64) -> Vector3<f64> {
        let (sin, cos) = angle_rad.sin_cos();
        self.centre * cos + self.towards * sin
    }
}

/// The point in a direction from the sub-satellite point at which the elevation equals the mask.
fn edge(
    surface: Surface,
    satellite_km: Position<EarthFixed>,
    arc: BoundaryArc,
    mask_rad: f64,
) -> LonLat {
    let at = |angle: f64| surface.below_rad(foot(surface, arc.direction(angle)));
    let (mut seen, mut hidden) = (0.0, FRAC_PI_2);
    // 2⁻⁴⁰ of a quarter of the Earth's circumference is 10 micrometres.
    for _ in 0..40 {
        let middle = 0.5 * (seen + hidden);
        let (latitude, longitude) = at(middle);
        let local = LocalFrame::new(surface, latitude, longitude);
        if local.look_angles(satellite_km).0 >= mask_rad {
            seen = middle;
        } else {
            hidden = middle;
        }
    }
    degrees(at(seen))
}

/// The point of the surface in a direction from the centre of the Earth, km.
fn foot(surface: Surface, direction: Vector3<f64>) -> Vector3<f64> {
    let squash = 1.0 - surface.flattening();
    let axis = direction.x.hypot(direction.y);
    let latitude = direction.z.atan2(axis * squash * squash);
    surface.position_km(latitude, direction.y.atan2(direction.x))
}

/// The sub-satellite point of a position, degrees.
pub(crate) fn place_below(surface: Surface, position_km: Position<EarthFixed>) -> LonLat {
    degrees(surface.below_rad(position_km.km()))
}

fn degrees((latitude_rad, longitude_rad): (f64, f64)) -> LonLat {
    [longitude_rad.to_degrees(), latitude_rad.to_degrees()]
}

/// South-west and north-east corner of the cell around a point of a lattice with these steps in latitude and
/// longitude, degrees: half a step to each side, not past the poles, and at most a full turn.
pub(crate) fn cell(step_deg: [f64; 2], [longitude, latitude]: LonLat) -> [LonLat; 2] {
    let half = step_deg.map(|step| 0.5 * step);
    let half_width = half[1].min(180.0);
    [
        [longitude - half_width, (latitude - half[0]).max(-90.0)],
        [longitude + half_width, (latitude + half[0]).min(90.0)],
    ]
}

/// The rings of a cell.
pub(crate) fn cell_rings([[west, south], [east, north]]: [LonLat; 2]) -> Vec<Vec<LonLat>> {
    cut(&[[west, south], [east, south], [east, north], [west, north]])
}

/// The rings of an area with counterclockwise corners less than half a turn of longitude apart. An
/// area around a pole is closed along the edge of the map at 90°.
pub(crate) fn rings(corners: &[LonLat]) -> Vec<Vec<LonLat>> {
    let Some(&first) = corners.first() else {
        return Vec::new();
    };
    let mut unwrapped: Vec<LonLat> = Vec::with_capacity(corners.len() + 3);
    let mut longitude = first[0];
    for &[next, latitude] in corners.iter().chain([&first]) {
        longitude = next + 360.0 * ((longitude - next) / 360.0).round();
        unwrapped.push([longitude, latitude]);
    }
    let turns = ((longitude - first[0]) / 360.0).round();
    if turns == 0.0 {
        unwrapped.pop();
        return cut(&unwrapped);
    }
    cut(&around_pole(&unwrapped, turns))
}

/// An area around a pole, from an edge that closes after one turn of longitude: cut open at the
/// antimeridian, it is one ring on the map.
fn around_pole(line: &[LonLat], turns: f64) -> Vec<LonLat> {
    let turn = |place: &LonLat| ((place[0] + 180.0) / 360.0).floor();
    let crosses = |pair: &[LonLat]| turn(&pair[0]) != turn(&pair[1]);
    // A full turn of longitude crosses the antimeridian somewhere.
    let before = line.windows(2).position(crosses).unwrap_or(0);
    let (from, to) = (line[before], line[before + 1]);
    let meridian = 360.0 * turn(&from).max(turn(&to)) - 180.0;
    let latitude = from[1] + (to[1] - from[1]) * (meridian - from[0]) / (to[0] - from[0]);
    let mut area = vec![[meridian, latitude]];
    area.extend(&line[before + 1..line.len() - 1]);
    let later = |place: &LonLat| [place[0] + 360.0 * turns, place[1]];
    area.extend(line[..=before].iter().map(later));
    area.push(later(&[meridian, latitude]));
    // Counterclockwise around the north pole is eastwards, around the south pole westwards.
    let pole = 90.0_f64.copysign(turns);
    area.extend([later(&[meridian, pole]), [meridian, pole]]);
    area
}

/// An area with continuous longitudes, cut into closed rings within ±180°.
fn cut(corners: &[LonLat]) -> Vec<Vec<LonLat>> {
    let longitudes = || corners.iter().map(|corner| corner[0]);
    let low = longitudes().fold(f64::INFINITY, f64::min);
    let high = longitudes().fold(f64::NEG_INFINITY, f64::max);
    let turn = |longitude: f64| ((longitude + 180.0) / 360.0).floor();
    let (first, last) = (turn(low) as i64, turn(high) as i64);
    let mut rings = Vec::new();
    for k in first..=last {
        let shift = 360.0 * k as f64;
        let inside = half_plane(corners, shift - 180.0, 1.0);
        let inside = half_plane(&inside, shift + 180.0, -1.0);
        rings.extend(closed(&inside, shift));
    }
    rings
}

/// The part of an area to one side of a meridian (Sutherland and Hodgman, *Commun. ACM* 17 (1974)
/// 32): to the east for `side` = 1, to the west for -1.
fn half_plane(corners: &[LonLat], meridian: f64, side: f64) -> Vec<LonLat> {
    let mut kept = Vec::with_capacity(corners.len() + 2);
    let beyond = |corner: LonLat| side * (corner[0] - meridian);
    for (n, &to) in corners.iter().enumerate() {
        let from = corners[(n + corners.len() - 1) % corners.len()];
        let (a, b) = (beyond(from), beyond(to));
        if a * b < 0.0 {
            let latitude = from[1] + (to[1] - from[1]) * a / (a - b);
            kept.push([meridian, latitude]);
        }
        if b >= 0.0 {
            kept.push(to);
        }
    }
    kept
}

/// The rounded ring without repeated corners; `None` if no area is left.
fn closed(corners: &[LonLat], shift: f64) -> Option<Vec<LonLat>> {
    let round = |x: f64| round_decimal(x, DECIMALS);
    let mut ring: Vec<LonLat> = Vec::with_capacity(corners.len() + 1);
    for &[longitude, latitude] in corners {
        let place = [round(longitude - shift), round(latitude)];
        if ring.last() != Some(&place) {
            ring.push(place);
        }
    }
    while ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    if ring.len() < 3 || signed_area(&ring) == 0.0 {
        return None;
    }
    ring.push(ring[0]);
    Some(ring)
}

/// Area of a ring on the map, square degrees: positive if counterclockwise.
fn signed_area(ring: &[LonLat]) -> f64 {
    let pairs = ring.iter().zip(ring.iter().cycle().skip(1));
    pairs.map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum::<f64>() / 2.0
}

/// A line with steps of less than half a turn, split where it crosses the antimeridian (RFC 7946,
/// 3.1.9).
pub(crate) fn lines(places: &[LonLat]) -> Vec<Vec<LonLat>> {
    let round = |[longitude, latitude]: LonLat| {
        [
            round_decimal(longitude, DECIMALS),
            round_decimal(latitude, DECIMALS),
        ]
    };
    let mut lines = Vec::new();
    let mut line: Vec<LonLat> = Vec::new();
    for (n, &place) in places.iter().enumerate() {
        if let Some(&before) = n.checked_sub(1).and_then(|n| places.get(n)) {
            let apart = place[0] - before[0];
            if apart.abs() > 180.0 {
                let side = 180.0_f64.copysign(before[0]);
                let way = apart - 360.0_f64.copysign(apart);
                let share = (side - before[0]) / way;
                let latitude = before[1] + share * (place[1] - before[1]);
                line.push(round([side, latitude]));
                lines.push(std::mem::take(&mut line));
                line.push(round([-side, latitude]));
            }
        }
        line.push(round(place));
    }
    lines.push(line);
    lines.retain(|line| line.len() > 1);
    lines
}

#[cfg(test)]
mod tests;
