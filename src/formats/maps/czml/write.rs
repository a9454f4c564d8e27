//! Writes a scenario as CZML, packet by packet.

use super::{DEGREE, FORMAT_VERSION, TARGET_KM};
use crate::constellation::Design;
use crate::ephemeris::arc::lagrange;
use crate::ephemeris::sampled::Sampled;
use crate::ephemeris::{Ephemeris, EphemerisError, EphemerisSatellite};
use crate::evaluate::PointMetrics;
use crate::formats::WriteError;
use crate::formats::maps::scene::{
    ColourScale, Scene, colour_of, plane_colour, point_place, shown, wrapped,
};
use crate::frames::{EarthFixed, State};
use crate::ground::Grid;
use crate::ground::shapes::LonLat;
use crate::units::round_decimal;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::io::{self, Write};

/// Spacings of samples that are tried, s.
const SPACINGS_S: [f64; 9] = [
    3600.0, 1800.0, 1200.0, 600.0, 300.0, 120.0, 60.0, 30.0, 10.0,
];

/// Maximum number of intervals between samples that are checked for the error of a spacing.
const INTERVALS: usize = 500;

/// Samples beyond each end.
const BEYOND: i64 = DEGREE as i64 / 2;

/// Satellites whose packets are made at once.
const CHUNK: usize = 64;

/// Opacity of the cells of the region, of 255.
const CELL_OPACITY: u8 = 130;

/// Writes the scenario around a design; the largest error of the interpolation, km, of a satellite of
/// each constellation.
///
/// # Errors
/// If a satellite has no state, or the output fails.
pub fn write(
    out: &mut impl Write,
    scene: &Scene<'_>,
    design: &Design,
    ephemeris: &Ephemeris,
) -> Result<f64, WriteError> {
    let mut packets = Packets { out, any: false };
    let shown = ShownSpan::of(scene);
    packets.add(&shown.document(design))?;
    packets.add(&study(scene, design))?;
    for packet in region(scene)? {
        packets.add(&packet)?;
    }
    packets.add(&json!({"id": "constellation", "name": design.to_string()}))?;
    let mut worst_km = packets.satellites(&shown, ephemeris, &|satellite| {
        design_look(satellite, design)
    })?;
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
        let look = |satellite: &EphemerisSatellite| Appearance {
            id: format!("{parent}:{}", satellite.name),
            parent: parent.clone(),
            colour: [255, 255, 255],
            description: String::new(),
            period_s: None,
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

    /// The packets of satellites with the same propagation, so that the first determines the spacing of all.
    fn satellites(
        &mut self,
        shown: &ShownSpan,
        ephemeris: &Ephemeris,
        look: &(impl Fn(&EphemerisSatellite) -> Appearance + Sync),
    ) -> Result<f64, WriteError> {
        let sampled = Sampled::new(ephemeris, EarthFixed);
        let mut spacing: Option<Spacing> = None;
        for propagated in ephemeris.satellites() {
            // GNSS of several heights: the spacing that suits the lowest suits all.
            let found = shown.spacing(&sampled, propagated)?;
            if spacing.is_none_or(|known| found.step_s < known.step_s) {
                spacing = Some(found);
            }
            if propagated.slot.is_some() {
                break;
            }
        }
        let Some(spacing) = spacing else {
            return Ok(0.0);
        };
        for chunk in ephemeris.satellites().chunks(CHUNK) {
            let packets: Vec<Value> = chunk
                .par_iter()
                .map(|propagated| shown.satellite(&sampled, propagated, spacing, look(propagated)))
                .collect::<Result<_, _>>()?;
            for packet in &packets {
                self.add(packet)?;
            }
        }
        Ok(spacing.error_km)
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

fn design_look(propagated: &EphemerisSatellite, design: &Design) -> Appearance {
    let slot = propagated.slot;
    let elements = design.satellites().first().map(|first| first.elements);
    let period_s = elements.map(|first| TAU / first.kepler_mean_motion_rad_s());
    Appearance {
        id: propagated.name.clone(),
        parent: "constellation".to_owned(),
        colour: plane_colour(slot.map_or(0, |slot| slot.plane), design.planes()),
        description: slot.map_or_else(String::new, |slot| {
            format!("plane {}, place {}", slot.plane + 1, slot.index + 1)
        }),
        // One orbit a plane: a thousand of them stop a browser.
        period_s: period_s.filter(|_| slot.is_some_and(|slot| slot.index == 0)),
    }
}

/// How far apart samples lie, and what that costs.
#[derive(Clone, Copy)]
struct Spacing {
    step_s: f64,
    error_km: f64,
}

/// The span that is shown.
struct ShownSpan {
    start: String,
    end: String,
    span_s: f64,
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

    fn document(&self, design: &Design) -> Value {
        json!({
            "id": "document",
            "name": format!("navwalker {design}"),
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

    /// The widest spacing within the target, or the best one.
    fn spacing(
        &self,
        sampled: &Sampled<'_, EarthFixed>,
        propagated: &EphemerisSatellite,
    ) -> Result<Spacing, EphemerisError> {
        let mut best: Option<Spacing> = None;
        for step_s in SPACINGS_S {
            let error_km = self.error_km(sampled, propagated, step_s)?;
            if best.is_none_or(|best| error_km < best.error_km) {
                best = Some(Spacing { step_s, error_km });
            }
            if error_km <= TARGET_KM {
                break;
            }
        }
        Ok(best.unwrap_or(Spacing {
            step_s: SPACINGS_S[0],
            error_km: f64::INFINITY,
        }))
    }

    /// Largest distance between the polynomial and the model halfway between samples, km.
    fn error_km(
        &self,
        sampled: &Sampled<'_, EarthFixed>,
        propagated: &EphemerisSatellite,
        step_s: f64,
    ) -> Result<f64, EphemerisError> {
        let intervals = (self.span_s / step_s).ceil().max(1.0) as usize;
        let stride = intervals.div_ceil(INTERVALS);
        let mut worst_km = 0.0_f64;
        for k in (0..intervals).step_by(stride) {
            let nodes = nodes(
                sampled,
                propagated,
                step_s,
                k as i64 - BEYOND..=k as i64 + 1 + BEYOND,
            )?;
            let middle_s = (k as f64 + 0.5) * step_s;
            let exact = sampled.state(propagated, middle_s)?.position_km.km();
            worst_km = worst_km.max((lagrange(&nodes, middle_s).0 - exact).norm());
        }
        Ok(worst_km)
    }

    fn satellite(
        &self,
        sampled: &Sampled<'_, EarthFixed>,
        propagated: &EphemerisSatellite,
        spacing: Spacing,
        look: Appearance,
    ) -> Result<Value, EphemerisError> {
        let step_s = spacing.step_s;
        let intervals = (self.span_s / step_s).ceil() as i64;
        let nodes = nodes(sampled, propagated, step_s, -BEYOND..=intervals + BEYOND)?;
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
            "availability": self.interval(),
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

/// Positions at whole multiples of a spacing, Earth-fixed, km.
fn nodes(
    sampled: &Sampled<'_, EarthFixed>,
    propagated: &EphemerisSatellite,
    step_s: f64,
    range: std::ops::RangeInclusive<i64>,
) -> Result<Vec<(f64, State<EarthFixed>)>, EphemerisError> {
    let node = |k: i64| {
        let t = k as f64 * step_s;
        Ok((t, sampled.state(propagated, t)?))
    };
    range.map(node).collect()
}

fn rgba([red, green, blue]: [u8; 3], opacity: u8) -> Value {
    json!({"rgba": [red, green, blue, opacity]})
}

/// What the study assumes, for programs and, as a description, for people.
fn study(scene: &Scene<'_>, design: &Design) -> Value {
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
            "design": design.to_string(),
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
    if let Some(grid) = scene.grid() {
        packets.push(outline(scene, points));
        packets.extend(legend(grid, scale.as_ref()));
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

/// Labels in the colours of the scale along the southern edge of the region.
fn legend(grid: &Grid, scale: Option<&ColourScale>) -> Vec<Value> {
    let Some(scale) = scale else {
        return Vec::new();
    };
    let entries = scale.legend();
    let [south, _] = grid.latitude_deg;
    let latitude = (south - 1.5 * grid.step_deg[0]).max(-85.0);
    let [west, east] = grid.longitude_deg;
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
