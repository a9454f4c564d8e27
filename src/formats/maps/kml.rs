//! KML: the region with its metrics, ground tracks and footprints, for Google Earth and a GIS.
//!
//! Source: OGC 07-147r2, *KML 2.2*: placemarks in folders (9.1, 9.6), coordinates as
//! `longitude,latitude` in degrees of WGS 84 (16.10), outer boundaries counterclockwise (10.8), colours
//! as `aabbggrr` (16.5). Areas and lines are cut at the antimeridian, since viewers differ in how they do it.

use crate::constellation::Design;
use crate::evaluate::PointMetrics;
use crate::formats::WriteError;
use crate::formats::maps::scene::{
    ColourScale, Scene, UNSOLVED, colour_of, plane_colour, point_place, shown,
};
use crate::formats::maps::tracks::Ground;
use crate::ground::shapes::{LonLat, cell_rings};
use quick_xml::escape::escape;
use std::fmt::Write as _;
use std::io::{self, Write};

/// Version of the format.
pub const FORMAT_VERSION: &str = "2.2";

/// Opacity of the cells of the region, of 255.
const CELL_OPACITY: u8 = 0x90;

/// Writes the document.
///
/// # Errors
/// If a satellite has no state, or the output fails.
pub fn write(
    out: &mut impl Write,
    scene: &Scene<'_>,
    design: &Design,
    ground: &[Ground],
) -> Result<(), WriteError> {
    writeln!(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>")?;
    writeln!(
        out,
        "<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>"
    )?;
    writeln!(
        out,
        "<name>{}</name>",
        escape(format!("navwalker {design}"))
    )?;
    let points = scene.points()?;
    let scale = ColourScale::of(points);
    description(out, scene, scale.as_ref())?;
    for plane in 0..design.planes() {
        let colour = hex(plane_colour(plane, design.planes()), 0xff);
        writeln!(
            out,
            "<Style id=\"plane{}\"><LineStyle><color>{colour}</color><width>1</width></LineStyle>\
             <PolyStyle><fill>0</fill></PolyStyle></Style>",
            plane + 1
        )?;
    }
    folder(out, "Mean PDOP", true, points, |out, point| {
        place(out, scene, scale.as_ref(), point)
    })?;
    folder(
        out,
        "Ground tracks of the first revolution",
        false,
        ground,
        |out, one| {
            let lines = one.track.iter().map(|line| {
                format!(
                    "<LineString><tessellate>1</tessellate>{}</LineString>",
                    coordinates(line)
                )
            });
            satellite(out, one, &lines.collect::<String>())
        },
    )?;
    folder(out, "Footprints at the epoch", false, ground, |out, one| {
        let areas: String = one.footprint.iter().map(|ring| polygon(ring)).collect();
        satellite(out, one, &areas)
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

fn satellite(out: &mut impl Write, one: &Ground, geometry: &str) -> io::Result<()> {
    let [plane, index] = one.slot.unwrap_or([1, 1]);
    write!(
        out,
        "<Placemark><name>{}</name><visibility>0</visibility><styleUrl>#plane{plane}</styleUrl>",
        escape(one.name.as_str())
    )?;
    extended(
        out,
        &[("plane", plane.to_string()), ("slot", index.to_string())],
    )?;
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
