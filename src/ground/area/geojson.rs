//! Polygons from GeoJSON (RFC 7946), with the place of each in the file.

use super::{AreaError, MAX_POSITIONS, Ring};
use crate::ground::shapes::LonLat;
use crate::printable::printable;
use serde_json::{Map, Value};

/// Longest name of a foreign type or reference system in an error.
const LONGEST_NAME: usize = 60;

/// A polygon and where it is in its file.
pub(super) struct PolygonFound {
    pub(super) place: String,
    pub(super) rings: Vec<Ring>,
}

/// The polygons of a file.
pub(super) fn polygons(bytes: &[u8]) -> Result<Vec<PolygonFound>, AreaError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let root: Value =
        serde_json::from_slice(bytes).map_err(|error| AreaError::Json(error.to_string()))?;
    if let Some(name) = foreign_system(&root) {
        return Err(AreaError::ReferenceSystem(shortened(&name)));
    }
    let mut reading = GeoJsonReading::default();
    reading.object("", &root)?;
    if reading.found.is_empty() {
        return Err(AreaError::Empty);
    }
    Ok(reading.found)
}

/// The name of a reference system other than WGS 84, as files before RFC 7946 could have.
fn foreign_system(root: &Value) -> Option<String> {
    let system = root.get("crs").filter(|system| !system.is_null())?;
    let name = system.pointer("/properties/name").and_then(Value::as_str);
    let is_known = |name: &str| {
        let name = name.to_uppercase();
        ["CRS84", "EPSG::4326", "EPSG:4326"]
            .iter()
            .any(|known| name.ends_with(known))
    };
    match name {
        Some(name) if is_known(name) => None,
        Some(name) => Some(name.to_owned()),
        None => Some("a reference system without a name".to_owned()),
    }
}

fn shortened(text: &str) -> String {
    printable(text).chars().take(LONGEST_NAME).collect()
}

/// A member of an object as a place.
fn member(place: &str, name: &str) -> String {
    match place {
        "" => name.to_owned(),
        _ => format!("{place}.{name}"),
    }
}

#[derive(Default)]
struct GeoJsonReading {
    found: Vec<PolygonFound>,
    positions: usize,
}

impl GeoJsonReading {
    fn object(&mut self, place: &str, value: &Value) -> Result<(), AreaError> {
        let expected = |expected| AreaError::Member {
            place: if place.is_empty() {
                "the file".to_owned()
            } else {
                place.to_owned()
            },
            expected,
        };
        let object = value
            .as_object()
            .ok_or_else(|| expected("a GeoJSON object"))?;
        let kind = object.get("type").and_then(Value::as_str);
        match kind.ok_or_else(|| expected("a GeoJSON object with a \"type\""))? {
            "FeatureCollection" => self.each(place, object, "features"),
            "GeometryCollection" => self.each(place, object, "geometries"),
            // A feature may be without a place (3.2).
            "Feature" => match object.get("geometry") {
                None | Some(Value::Null) => Ok(()),
                Some(geometry) => self.object(&member(place, "geometry"), geometry),
            },
            "Polygon" => {
                let place = member(place, "coordinates");
                self.polygon(&place, object.get("coordinates").unwrap_or(&Value::Null))
            }
            "MultiPolygon" => {
                let place = member(place, "coordinates");
                let all = list(&place, object.get("coordinates"), "a list of polygons")?;
                let mut all = all.iter().enumerate();
                all.try_for_each(|(n, polygon)| self.polygon(&format!("{place}[{n}]"), polygon))
            }
            kind => Err(AreaError::Kind {
                place: if place.is_empty() {
                    "the file".to_owned()
                } else {
                    place.to_owned()
                },
                kind: shortened(kind),
            }),
        }
    }

    fn each(
        &mut self,
        place: &str,
        object: &Map<String, Value>,
        name: &str,
    ) -> Result<(), AreaError> {
        let place = member(place, name);
        let all = list(&place, object.get(name), "a list of GeoJSON objects")?;
        let mut all = all.iter().enumerate();
        all.try_for_each(|(n, one)| self.object(&format!("{place}[{n}]"), one))
    }

    fn polygon(&mut self, place: &str, value: &Value) -> Result<(), AreaError> {
        let rings = list(place, Some(value), "a list of rings")?;
        let read = |(n, ring): (usize, &Value)| {
            let place = format!("{place}[{n}]");
            let positions = list(&place, Some(ring), "a list of positions")?;
            self.positions += positions.len();
            if self.positions > MAX_POSITIONS {
                return Err(AreaError::TooMany);
            }
            let position = |(n, one): (usize, &Value)| position(&format!("{place}[{n}]"), one);
            positions.iter().enumerate().map(position).collect()
        };
        let rings: Vec<Ring> = rings
            .iter()
            .enumerate()
            .map(read)
            .collect::<Result<_, _>>()?;
        if !rings.is_empty() {
            self.found.push(PolygonFound {
                place: place.to_owned(),
                rings,
            });
        }
        Ok(())
    }
}

fn list<'v>(
    place: &str,
    value: Option<&'v Value>,
    expected: &'static str,
) -> Result<&'v Vec<Value>, AreaError> {
    let found = value.and_then(Value::as_array);
    found.ok_or_else(|| AreaError::Member {
        place: place.to_owned(),
        expected,
    })
}

/// Longitude and latitude of a position, whose height is ignored.
fn position(place: &str, value: &Value) -> Result<LonLat, AreaError> {
    let numbers = value.as_array().map(Vec::as_slice);
    match numbers {
        Some([longitude, latitude, ..]) => longitude.as_f64().zip(latitude.as_f64()),
        _ => None,
    }
    .map(|(longitude, latitude)| [longitude, latitude])
    .ok_or_else(|| AreaError::Member {
        place: place.to_owned(),
        expected: "a position [longitude, latitude], in degrees",
    })
}
