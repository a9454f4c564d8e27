//! GeoJSON: the region with its metrics, ground tracks and footprints, for a GIS or a browser.
//!
//! Source: RFC 7946. Coordinates are [longitude, latitude] in degrees of WGS 84 (4); rings are
//! counterclockwise (3.1.6) and cut at the antimeridian (3.1.9). A file is one feature a line within a
//! `FeatureCollection`.

use crate::evaluate::PointMetrics;
use crate::formats::WriteError;
use crate::formats::maps::scene::{ColourScale, Scene, colour_of, point_place, shown};
use crate::formats::maps::tracks::Ground;
use crate::ground::shapes::{LonLat, cell_rings, lines};
use serde_json::{Value, json};
use std::io::{self, Write};

/// The standard that the files follow.
pub const FORMAT_VERSION: &str = "RFC 7946";

/// Writes the ground points with their metrics, the cells of a grid or the points of a list, and the borders of an area.
///
/// # Errors
/// If a satellite has no state, or the output fails.
pub fn write_region(out: &mut impl Write, scene: &Scene<'_>) -> Result<(), WriteError> {
    let points = scene.points()?;
    let scale = ColourScale::of(points);
    let features = points.iter().map(|point| {
        let geometry = match scene.cell(point) {
            Some(corners) => areas(&cell_rings(corners)),
            None => json!({"type": "Point", "coordinates": point_place(point)}),
        };
        feature(&geometry, &point_properties(point, scale.as_ref()))
    });
    let borders: Vec<_> = scene
        .borders()
        .iter()
        .flat_map(|line| lines(line))
        .collect();
    let border = (!borders.is_empty()).then(|| {
        let geometry = json!({"type": "MultiLineString", "coordinates": borders});
        feature(
            &geometry,
            &json!({"name": "border of the region", "stroke": "#303030"}),
        )
    });
    collection(out, features.chain(border))?;
    Ok(())
}

/// Writes the ground track of each satellite over its first revolution.
///
/// # Errors
/// If writing fails.
pub fn write_tracks(out: &mut impl Write, ground: &[Ground]) -> Result<(), WriteError> {
    let features = ground.iter().map(|one| {
        let geometry = json!({"type": "MultiLineString", "coordinates": one.track});
        feature(&geometry, &one.properties())
    });
    collection(out, features)?;
    Ok(())
}

/// Writes the footprint of each satellite at the epoch: where it is above the mask.
///
/// # Errors
/// If writing fails.
pub fn write_footprints(out: &mut impl Write, ground: &[Ground]) -> Result<(), WriteError> {
    let features = ground
        .iter()
        .map(|one| feature(&areas(&one.footprint), &one.properties()));
    collection(out, features)?;
    Ok(())
}

fn feature(geometry: &Value, properties: &Value) -> Value {
    json!({"type": "Feature", "geometry": geometry, "properties": properties})
}

/// One ring a polygon: no area has a hole.
fn areas(rings: &[Vec<LonLat>]) -> Value {
    match rings {
        [ring] => json!({"type": "Polygon", "coordinates": [ring]}),
        _ => {
            let polygons: Vec<[&Vec<LonLat>; 1]> = rings.iter().map(|ring| [ring]).collect();
            json!({"type": "MultiPolygon", "coordinates": polygons})
        }
    }
}

/// `fill` is the colour by mean PDOP, as viewers that follow simplestyle show it.
fn point_properties(point: &PointMetrics, scale: Option<&ColourScale>) -> Value {
    let [red, green, blue] = colour_of(scale, point.mean_pdop);
    let mut properties = json!({
        "latitude_deg": point.latitude_deg,
        "longitude_deg": point.longitude_deg,
        "mean_visible": shown(point.mean_visible),
        "mean_pdop": point.mean_pdop.map(shown),
        "p95_pdop": point.p95_pdop.map(shown),
        "max_pdop": point.max_pdop.map(shown),
        "solved_fraction": shown(point.solved_fraction),
        "availability": shown(point.availability),
        "fill": format!("#{red:02x}{green:02x}{blue:02x}"),
        "fill-opacity": 0.5,
    });
    if let Some(name) = &point.name {
        properties["name"] = Value::from(&**name);
    }
    properties
}

fn collection(out: &mut impl Write, features: impl Iterator<Item = Value>) -> io::Result<()> {
    out.write_all(b"{\"type\": \"FeatureCollection\", \"features\": [\n")?;
    for (n, feature) in features.enumerate() {
        if n > 0 {
            out.write_all(b",\n")?;
        }
        serde_json::to_writer(&mut *out, &feature)?;
    }
    out.write_all(b"\n]}\n")
}
