//! Writes a scenario as CZML, packet by packet.

use super::spacing::{ShownSpan, Spacing};
use super::{DEGREE, FORMAT_VERSION};
use crate::ephemeris::sampled::Sampled;
use crate::ephemeris::{Ephemeris, EphemerisError, EphemerisSatellite};
use crate::evaluate::PointMetrics;
use crate::formats::WriteError;
use crate::formats::maps::palette::{Palette, period_s, place_text};
use crate::formats::maps::scene::{ColourScale, Scene, colour_of, point_place, shown, wrapped};
use crate::frames::EarthFixed;
use crate::ground::shapes::LonLat;
use crate::ground::{RegionMap, Tiling};
use crate::units::round_decimal;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::io::{self, Write};

/// Satellites whose packets are made at once.
const CHUNK: usize = 64;

/// Largest number of satellites outside shells whose orbits are drawn.
const ORBITS: usize = 100;

/// Opacity of the cells of the region, of 255.
const CELL_OPACITY: u8 = 130;

/// Writes the scenario around a constellation; the largest error of the interpolation, km, of a satellite of
/// each constellation.
///
/// # Errors
/// If a satellite has no state, or the output fails.
pub fn write(out: &mut impl Write, scene: &Scene<'_>) -> Result<f64, WriteError> {
    let mut packets = Packets { out, any: false };
    let shown = ShownSpan::of(scene);
    let ephemeris = scene.ephemeris();
    packets.add(&shown.document(scene.title()))?;
    packets.add(&study(scene))?;
    for packet in region(scene)? {
        packets.add(&packet)?;
    }
    packets.add(&json!({"id": "constellation", "name": scene.title()}))?;
    let looks = LeoLooks::of(ephemeris);
    let mut worst_km =
        packets.satellites(&shown, ephemeris, &|satellite| looks.of_one(satellite))?;
    let mut ids = std::collections::BTreeMap::new();
    for (system, satellites) in scene.systems() {
        // Two files of one name are two systems.
        let count = ids.entry(system.name().to_owned()).or_insert(0_usize);
        *count += 1;
        let parent = match *count {
            1 => format!("gnss:{}", system.name()),
            n => format!("gnss:{}:{n}", system.name()),
        };
        packets.add(&json!({"id": parent, "name": system.name()}))?;
        let propagated = Ephemeris::of_gnss(satellites, ephemeris.grid());
        let look = |satellite: &EphemerisSatellite| {
            Ok(Appearance {
                id: format!("{parent}:{}", satellite.name),
                parent: parent.clone(),
                colour: [255, 255, 255],
                description: String::new(),
                period_s: None,
            })
        };
        worst_km = worst_km.max(packets.satellites(&shown, &propagated, &look)?);
    }
    packets.end()?;
    Ok(worst_km)
}

/// The packets of a document, one a line.
struct Packets<'a, W> {
    out: &'a mut W,
    any: bool,
}

impl<W: Write> Packets<'_, W> {
    fn add(&mut self, packet: &Value) -> io::Result<()> {
        self.out.write_all(if self.any { b",\n" } else { b"[\n" })?;
        self.any = true;
        serde_json::to_writer(&mut *self.out, packet)?;
        Ok(())
    }

    fn end(self) -> io::Result<()> {
        self.out.write_all(b"\n]\n")
    }

    /// The packets of satellites.
    fn satellites(
        &mut self,
        shown: &ShownSpan,
        ephemeris: &Ephemeris,
        look: &(impl Fn(&EphemerisSatellite) -> Result<Appearance, EphemerisError> + Sync),
    ) -> Result<f64, WriteError> {
        let sampled = Sampled::new(ephemeris, EarthFixed);
        let spacings = shown.spacings(&sampled, ephemeris)?;
        let satellites: Vec<(&EphemerisSatellite, &Spacing)> =
            ephemeris.satellites().iter().zip(&spacings).collect();
        for chunk in satellites.chunks(CHUNK) {
            let packets: Vec<Value> = chunk
                .par_iter()
                .map(|(propagated, spacing)| {
                    shown.satellite(&sampled, propagated, **spacing, look(propagated)?)
                })
                .collect::<Result<_, EphemerisError>>()?;
            for packet in &packets {
                self.add(packet)?;
            }
        }
        let errors = spacings.iter().map(|spacing| spacing.error_km);
        Ok(errors.fold(0.0, f64::max))
    }
}

/// How a satellite is shown.
struct Appearance {
    id: String,
    parent: String,
    colour: [u8; 3],
    description: String,
    /// Draws the orbit for half a period to each side.
    period_s: Option<f64>,
}

/// How the satellites of the constellation are shown.
struct LeoLooks<'a> {
    ephemeris: &'a Ephemeris,
    palette: Palette,
    /// Whether satellites outside shells have orbits.
    draws_others: bool,
}

impl<'a> LeoLooks<'a> {
    fn of(ephemeris: &'a Ephemeris) -> Self {
        let satellites = ephemeris.satellites().iter();
        let others = satellites.filter(|satellite| satellite.slot.is_none());
        Self {
            ephemeris,
            palette: Palette::of(ephemeris),
            draws_others: others.count() <= ORBITS,
        }
    }

    fn of_one(&self, satellite: &EphemerisSatellite) -> Result<Appearance, EphemerisError> {
        // One orbit a plane: a thousand of them stop a browser.
        let draws = match satellite.slot {
            Some(slot) => slot.index == 0,
            None => self.draws_others,
        };
        let period_s = match draws {
            true => period_s(self.ephemeris, satellite)?,
            false => None,
        };
        Ok(Appearance {
            id: satellite.name.clone(),
            parent: "constellation".to_owned(),
            colour: self.palette.colour(satellite.slot),
            description: satellite.slot.map_or_else(String::new, place_text),
            period_s,
        })
    }
}

impl ShownSpan {
    fn of(scene: &Scene<'_>) -> Self {
        let grid = scene.setup().grid;
        let span_s = grid.step_s() * grid.len() as f64;
        Self {
            start: grid.epoch().to_string(),
            end: grid.epoch().plus_seconds(span_s).to_string(),
            span_s,
        }
    }

    fn interval(&self) -> String {
        format!("{}/{}", self.start, self.end)
    }

    fn document(&self, title: &str) -> Value {
        json!({
            "id": "document",
            "name": format!("navwalker {title}"),
            "version": FORMAT_VERSION,
            "clock": {
                "interval": self.interval(),
                "currentTime": self.start,
                "multiplier": 60,
                "range": "LOOP_STOP",
                "step": "SYSTEM_CLOCK_MULTIPLIER",
            },
        })
    }

    fn satellite(
        &self,
        sampled: &Sampled<'_, EarthFixed>,
        propagated: &EphemerisSatellite,
        spacing: Spacing,
        look: Appearance,
    ) -> Result<Value, EphemerisError> {
        let nodes = self.nodes(sampled, propagated, spacing.step_s)?;
        let last_s = nodes.last().map_or(0.0, |(t, _)| *t);
        let availability = match last_s < self.span_s {
            true => {
                let last = sampled.grid().epoch().plus_seconds(last_s);
                format!("{}/{last}", self.start)
            }
            false => self.interval(),
        };
        let metres = |km: f64| round_decimal(km * 1000.0, 1);
        let cartesian: Vec<f64> = nodes
            .iter()
            .map(|(t, state)| (t, state.position_km.km()))
            .flat_map(|(t, p)| [*t, metres(p.x), metres(p.y), metres(p.z)])
            .collect();
        let mut packet = json!({
            "id": look.id,
            "name": propagated.name,
            "parent": look.parent,
            "availability": availability,
            "description": look.description,
            "position": {
                "epoch": self.start,
                "interpolationAlgorithm": "LAGRANGE",
                "interpolationDegree": DEGREE,
                "referenceFrame": "FIXED",
                "cartesian": cartesian,
            },
            "point": {"pixelSize": 5, "color": rgba(look.colour, 255)},
        });
        if let Some(period_s) = look.period_s {
            packet["path"] = json!({
                "leadTime": (period_s / 2.0).round(),
                "trailTime": (period_s / 2.0).round(),
                "resolution": 120,
                "width": 1,
                "material": {"solidColor": {"color": rgba(look.colour, 160)}},
            });
        }
        Ok(packet)
    }
}

fn rgba([red, green, blue]: [u8; 3], opacity: u8) -> Value {
    json!({"rgba": [red, green, blue, opacity]})
}

/// What the study assumes, for programs and, as a description, for people.
fn study(scene: &Scene<'_>) -> Value {
    let assumptions = scene.assumptions();
    let items: Vec<String> = assumptions
        .iter()
        .map(|told| format!("<li>{}</li>", quick_xml::escape::escape(told.as_str())))
        .collect();
    json!({
        "id": "study",
        "name": "Study",
        "description": format!("<ul>{}</ul>", items.concat()),
        "properties": {
            scene.title_key(): scene.title(),
            "mask_deg": scene.setup().mask.degrees(),
            "gnss_mask_deg": scene.setup().gnss_mask.degrees(),
        },
    })
}

/// The cells or points of the region, its outline and the legend of its colours.
fn region(scene: &Scene<'_>) -> Result<Vec<Value>, WriteError> {
    let points = scene.points()?;
    let scale = ColourScale::of(points);
    let mut packets = vec![json!({"id": "region", "name": "Mean PDOP"})];
    for (n, point) in points.iter().enumerate() {
        packets.push(place(scene, scale.as_ref(), (n, point)));
    }
    let map = &scene.setup().map;
    if let Some(tiling) = &map.tiling {
        if map.outlines.is_empty() {
            packets.push(outline(scene, points));
        }
        packets.extend(map.outlines.iter().enumerate().map(border));
        packets.extend(legend(map, tiling, points, scale.as_ref()));
    }
    Ok(packets)
}

/// A point of the region as a cell, or as a dot if there is no grid.
fn place(
    scene: &Scene<'_>,
    scale: Option<&ColourScale>,
    (n, point): (usize, &PointMetrics),
) -> Value {
    let text = |value: Option<f64>| value.map_or("unsolved".to_owned(), |x| format!("{x:.3}"));
    let colour = colour_of(scale, point.mean_pdop);
    let mut packet = json!({
        "id": format!("point:{}", n + 1),
        "name": point.label(),
        "parent": "region",
        "description": format!(
            "<table><tr><td>mean PDOP</td><td>{}</td></tr><tr><td>95 % quantile of PDOP</td><td>{}</td></tr>\
             <tr><td>mean visible</td><td>{:.2}</td></tr><tr><td>availability</td><td>{:.4}</td></tr>\
             </table>",
            text(point.mean_pdop), text(point.p95_pdop), point.mean_visible, point.availability
        ),
        "properties": {
            "mean_visible": shown(point.mean_visible),
            "mean_pdop": point.mean_pdop.map(shown),
            "p95_pdop": point.p95_pdop.map(shown),
            "availability": shown(point.availability),
        },
    });
    match scene.cell(point) {
        Some([[west, south], [east, north]]) => {
            packet["rectangle"] = json!({
                "coordinates": {"wsenDegrees": rectangle([[west, south], [east, north]])},
                "material": {"solidColor": {"color": rgba(colour, CELL_OPACITY)}},
                "height": 0,
            });
        }
        None => {
            let [longitude, latitude] = point_place(point);
            packet["position"] = json!({"cartographicDegrees": [longitude, latitude, 0.0]});
            packet["point"] = json!({"pixelSize": 8, "color": rgba(colour, 255)});
        }
    }
    packet
}

/// West, south, east and north of a cell within ±180°; across the antimeridian east is less than west.
fn rectangle([[west, south], [east, north]]: [LonLat; 2]) -> [f64; 4] {
    if east - west >= 360.0 {
        return [-180.0, south, 180.0, north];
    }
    let from = wrapped(west);
    let to = from + (east - west);
    let to = if to > 180.0 { to - 360.0 } else { to };
    [from, south, round_decimal(to, 9), north]
}

/// A line around all cells, in steps that a viewer cannot take for the shorter way around.
fn outline(scene: &Scene<'_>, points: &[PointMetrics]) -> Value {
    let mut box_deg = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for corners in points.iter().filter_map(|point| scene.cell(point)) {
        for axis in 0..2 {
            box_deg[0][axis] = box_deg[0][axis].min(corners[0][axis]);
            box_deg[1][axis] = box_deg[1][axis].max(corners[1][axis]);
        }
    }
    let [[west, south], [east, north]] = box_deg;
    let corners = [
        [west, south],
        [east, south],
        [east, north],
        [west, north],
        [west, south],
    ];
    let mut degrees = Vec::new();
    for pair in corners.windows(2) {
        let [from, to]: [LonLat; 2] = [pair[0], pair[1]];
        for k in 0..8 {
            let share = f64::from(k) / 8.0;
            let along = |axis: usize| from[axis] + share * (to[axis] - from[axis]);
            degrees.extend([wrapped(along(0)), along(1), 0.0]);
        }
    }
    degrees.extend([wrapped(west), south, 0.0]);
    json!({
        "id": "region-outline",
        "name": "Region",
        "parent": "region",
        "polyline": {
            "positions": {"cartographicDegrees": degrees},
            "arcType": "RHUMB",
            "width": 2,
            "material": {"solidColor": {"color": rgba([255, 255, 255], 255)}},
        },
    })
}

/// A border of an area.
fn border((n, line): (usize, &Vec<LonLat>)) -> Value {
    let degrees = line.iter().flat_map(|[x, y]| [wrapped(*x), *y, 0.0]);
    json!({
        "id": format!("region-border:{}", n + 1),
        "name": "Region",
        "parent": "region",
        "polyline": {
            "positions": {"cartographicDegrees": degrees.collect::<Vec<f64>>()},
            "arcType": "RHUMB",
            "width": 2,
            "material": {"solidColor": {"color": rgba([255, 255, 255], 255)}},
        },
    })
}

/// South-west and north-east corner around points.
fn frame(points: &[PointMetrics]) -> [LonLat; 2] {
    let nothing = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    points.iter().fold(nothing, |[low, high], point| {
        let place = [point.longitude_deg, point.latitude_deg];
        let each =
            |pick: fn(f64, f64) -> f64, of: LonLat| [pick(of[0], place[0]), pick(of[1], place[1])];
        [each(f64::min, low), each(f64::max, high)]
    })
}

/// Labels in the colours of the scale along the southern edge of the region.
fn legend(
    map: &RegionMap,
    tiling: &Tiling,
    points: &[PointMetrics],
    scale: Option<&ColourScale>,
) -> Vec<Value> {
    let Some(scale) = scale else {
        return Vec::new();
    };
    let entries = scale.legend();
    let [[west, south], [east, _]] = map.rectangle.unwrap_or_else(|| frame(points));
    let step_deg = map.step_deg().map_or(tiling.step_deg(), |step| step[0]);
    let latitude = (south - 1.5 * step_deg).max(-85.0);
    let span = if east >= west {
        east - west
    } else {
        east - west + 360.0
    };
    let width = span.clamp(20.0, 240.0) / entries.len() as f64;
    let label = |(k, (value, colour)): (usize, &(f64, [u8; 3]))| {
        let longitude = wrapped(west + (k as f64 + 0.5) * width);
        let text = if k == 0 {
            format!("mean PDOP\n{value:.2}")
        } else {
            format!("{value:.2}")
        };
        json!({
            "id": format!("legend:{}", k + 1),
            "name": "Mean PDOP",
            "parent": "region",
            "position": {"cartographicDegrees": [longitude, latitude, 0.0]},
            "label": {
                "text": text,
                "font": "14px sans-serif",
                "showBackground": true,
                "backgroundColor": rgba(*colour, 255),
                "fillColor": rgba(readable_on(*colour), 255),
            },
        })
    };
    entries.iter().enumerate().map(label).collect()
}

/// Black or white, whichever stands out (luma of ITU-R BT.601).
fn readable_on([red, green, blue]: [u8; 3]) -> [u8; 3] {
    let luma = 0.299 * f64::from(red) + 0.587 * f64::from(green) + 0.114 * f64::from(blue);
    if luma > 140.0 { [0; 3] } else { [255; 3] }
}
