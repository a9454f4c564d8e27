//! KML: the region with its metrics, ground tracks and footprints, for Google Earth and a GIS.
//!
//! Source: OGC 07-147r2, *KML 2.2*: placemarks in folders (9.1, 9.6), coordinates as
//! `longitude,latitude` in degrees of WGS 84 (16.10), outer boundaries counterclockwise (10.8), colours
//! as `aabbggrr` (16.5). Areas and lines are cut at the antimeridian, since viewers differ in how they do it.

use crate::constellation::shell_letters;
use crate::evaluate::PointMetrics;
use crate::formats::WriteError;
use crate::formats::maps::palette::{Palette, place_text};
use crate::formats::maps::scene::{ColourScale, Scene, UNSOLVED, colour_of, point_place, shown};
use crate::formats::maps::tracks::Ground;
use crate::ground::shapes::{LonLat, cell_rings, lines};
use quick_xml::escape::escape;
use std::fmt::Write as _;
use std::io::{self, Write};

/// Version of the format.
pub const FORMAT_VERSION: &str = "2.2";

/// Opacity of the cells of the region, of 255.
const CELL_OPACITY: u8 = 0x90;

/// Colour of the borders of the region: visible on imagery.
const BORDER: [u8; 3] = [255, 255, 255];

/// Writes the document.
///
/// # Errors
/// If a satellite has no state, or the output fails.
pub fn write(out: &mut impl Write, scene: &Scene<'_>, ground: &[Ground]) -> Result<(), WriteError> {
    writeln!(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>")?;
    writeln!(
        out,
        "<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>"
    )?;
    writeln!(
        out,
        "<name>{}</name>",
        escape(format!("navwalker {}", scene.title()))
    )?;
    let points = scene.points()?;
    let scale = ColourScale::of(points);
    description(out, scene, scale.as_ref())?;
    let palette = Palette::of(scene.ephemeris());
    let groups = palette.groups();
    for (id, colour) in &groups {
        let colour = hex(*colour, 0xff);
        writeln!(
            out,
            "<Style id=\"{id}\"><LineStyle><color>{colour}</color><width>1</width></LineStyle>\
             <PolyStyle><fill>0</fill></PolyStyle></Style>"
        )?;
    }
    let group = |one: &Ground| groups[palette.group(one.slot)].0.as_str();
    folder(out, "Mean PDOP", true, points, |out, point| {
        place(out, scene, scale.as_ref(), point)
    })?;
    borders(out, scene)?;
    folder(
        out,
        "Ground tracks of the first revolution",
        false,
        ground,
        |out, one| {
            let track: String = one.track.iter().map(|line| line_string(line)).collect();
            satellite(out, one, group(one), &track)
        },
    )?;
    folder(out, "Footprints at the epoch", false, ground, |out, one| {
        let areas: String = one.footprint.iter().map(|ring| polygon(ring)).collect();
        satellite(out, one, group(one), &areas)
    })?;
    writeln!(out, "</Document>\n</kml>")?;
    Ok(())
}

/// What the study assumes, and the colours of the cells.
fn description(
    out: &mut impl Write,
    scene: &Scene<'_>,
    scale: Option<&ColourScale>,
) -> io::Result<()> {
    let mut html = String::from("<p>Mean PDOP:");
    let swatch = |[red, green, blue]: [u8; 3], text: &str| {
        format!(" <span style=\"color:#{red:02x}{green:02x}{blue:02x}\">&#9632;</span> {text}")
    };
    for (value, colour) in scale.map(ColourScale::legend).unwrap_or_default() {
        html += &swatch(colour, &format!("{value:.2}"));
    }
    html += &swatch(UNSOLVED, "unsolved");
    html += "</p><ul>";
    for told in scene.assumptions() {
        html += &format!("<li>{}</li>", escape(told.as_str()));
    }
    html += "</ul>";
    writeln!(out, "<description>{}</description>", escape(html.as_str()))
}

fn folder<W: Write, T>(
    out: &mut W,
    name: &str,
    visible: bool,
    items: &[T],
    each: impl Fn(&mut W, &T) -> io::Result<()>,
) -> io::Result<()> {
    let visibility = u8::from(visible);
    writeln!(
        out,
        "<Folder><name>{name}</name><visibility>{visibility}</visibility>"
    )?;
    for item in items {
        each(out, item)?;
    }
    writeln!(out, "</Folder>")
}

/// The borders of the area that the points are in, if it is one.
fn borders(out: &mut impl Write, scene: &Scene<'_>) -> io::Result<()> {
    let cut = scene.borders().iter().flat_map(|line| lines(line));
    let geometry: String = cut.map(|line| line_string(&line)).collect();
    if geometry.is_empty() {
        return Ok(());
    }
    let colour = hex(BORDER, 0xff);
    writeln!(
        out,
        "<Placemark><name>Border of the region</name><Style><LineStyle><color>{colour}</color>\
         <width>2</width></LineStyle></Style>{}</Placemark>",
        grouped(&geometry)
    )
}

/// A point of the region: a coloured cell, or a place mark if there is no grid.
fn place(
    out: &mut impl Write,
    scene: &Scene<'_>,
    scale: Option<&ColourScale>,
    point: &PointMetrics,
) -> io::Result<()> {
    let colour = colour_of(scale, point.mean_pdop);
    let geometry: String = match scene.cell(point) {
        Some(corners) => cell_rings(corners)
            .iter()
            .map(|ring| polygon(ring))
            .collect(),
        None => format!("<Point>{}</Point>", coordinates(&[point_place(point)])),
    };
    let (line, area) = (hex(colour, 0xff), hex(colour, CELL_OPACITY));
    write!(
        out,
        "<Placemark><name>{}</name><Style><IconStyle><color>{line}</color></IconStyle>\
         <LineStyle><width>0</width></LineStyle><PolyStyle><color>{area}</color></PolyStyle></Style>",
        escape(point.label())
    )?;
    let number =
        |value: Option<f64>| value.map_or_else(|| "unsolved".to_owned(), |x| shown(x).to_string());
    extended(
        out,
        &[
            ("mean_visible", number(Some(point.mean_visible))),
            ("mean_pdop", number(point.mean_pdop)),
            ("p95_pdop", number(point.p95_pdop)),
            ("availability", number(Some(point.availability))),
        ],
    )?;
    writeln!(out, "{}</Placemark>", grouped(&geometry))
}

fn satellite(out: &mut impl Write, one: &Ground, group: &str, geometry: &str) -> io::Result<()> {
    write!(
        out,
        "<Placemark><name>{}</name><visibility>0</visibility>",
        escape(one.name.as_str())
    )?;
    let shell = one.slot.and_then(|slot| Some((slot, slot.shell?)));
    if let Some((slot, _)) = shell {
        write!(out, "<description>{}</description>", place_text(slot))?;
    }
    write!(out, "<styleUrl>#{group}</styleUrl>")?;
    let shell = shell.map(|(_, shell)| ("shell", shell_letters(shell)));
    let mut data = Vec::from_iter(shell);
    if let Some(slot) = one.slot {
        data.push(("plane", (slot.plane + 1).to_string()));
        data.push(("slot", (slot.index + 1).to_string()));
    }
    if !data.is_empty() {
        extended(out, &data)?;
    }
    writeln!(out, "{}</Placemark>", grouped(geometry))
}

fn extended(out: &mut impl Write, data: &[(&str, String)]) -> io::Result<()> {
    write!(out, "<ExtendedData>")?;
    for (name, value) in data {
        write!(out, "<Data name=\"{name}\"><value>{value}</value></Data>")?;
    }
    write!(out, "</ExtendedData>")
}

fn grouped(geometry: &str) -> String {
    format!("<MultiGeometry>{geometry}</MultiGeometry>")
}

fn polygon(ring: &[LonLat]) -> String {
    format!(
        "<Polygon><tessellate>1</tessellate><outerBoundaryIs><LinearRing>{}</LinearRing></outerBoundaryIs></Polygon>",
        coordinates(ring)
    )
}

fn line_string(line: &[LonLat]) -> String {
    format!(
        "<LineString><tessellate>1</tessellate>{}</LineString>",
        coordinates(line)
    )
}

fn coordinates(places: &[LonLat]) -> String {
    let mut text = String::from("<coordinates>");
    for [longitude, latitude] in places {
        // Writing to a string cannot fail.
        let _ = write!(text, "{longitude},{latitude} ");
    }
    text.truncate(text.trim_end().len());
    text + "</coordinates>"
}

fn hex([red, green, blue]: [u8; 3], opacity: u8) -> String {
    format!("{opacity:02x}{blue:02x}{green:02x}{red:02x}")
}
