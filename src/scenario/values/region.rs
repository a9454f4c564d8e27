//! The points where the receivers are: a grid, cells of equal area, an area, or a file.

use super::count;
use crate::earth::RADIUS_KM;
use crate::ground::{AreaPoints, Country, EqualAreaCells, Grid};
use crate::scenario::PointWeights;
use crate::scenario::keys::{KeyPath, Section, Walk, key, section};
use crate::scenario::problem::Fault;
use crate::scenario::reader::Reader;
use crate::scenario::rule::{Countries, Eastward, Interval, Number, OneOf, Optional, Steps, Text};

/// Maximum points of a grid: the globe at every quarter of a degree.
const MAX_POINTS: u64 = 1_040_000;

/// The points where the receivers are.
#[derive(Debug, Clone, PartialEq)]
pub enum Region {
    /// A grid in latitude and longitude.
    Grid(Grid),
    /// Cells of equal area over a rectangle of latitude and longitude.
    Cells(EqualAreaCells),
    /// The points inside polygons.
    Area {
        /// Where the polygons come from.
        source: AreaSource,
        /// Which points inside them.
        points: AreaPoints,
    },
    /// The points of a CSV file.
    Points {
        /// The path as written; relative to the scenario file.
        file: String,
    },
}

/// Where the polygons of an area come from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum AreaSource {
    /// A GeoJSON file, by its path as written.
    Polygon {
        /// The path as written; relative to the scenario file.
        file: String,
    },
    /// Countries of the built-in data.
    Countries(Vec<Country>),
}

section! {
    /// The keys of a region; those that belong to another kind of region have no value.
    #[derive(Debug, Clone)]
    pub(in crate::scenario) struct RegionKeys in "region" {
        /// Southern and northern limit.
        pub latitude_deg: Option<[f64; 2]> = Optional(Interval { of: Number::from_to(-90.0, 90.0), or_single: false }),
            unit "deg", default Some([3.0, 54.0]);
        /// Western and eastern limit; [160, -155] crosses the date line.
        pub longitude_deg: Option<[f64; 2]> = Optional(Eastward), unit "deg", default Some([73.0, 136.0]);
        /// Step of the grid from its south-western corner; in a polygon or country, points are at its multiples.
        pub step_deg: Option<[f64; 2]> = Optional(Steps(Number::above_to(0.0, 360.0))), unit "deg",
            default Some([5.0, 5.0]);
        /// Weights of the points of the grid in means and quantiles.
        pub weights: Option<PointWeights> = Optional(OneOf::new()), default Some(PointWeights::Equal);
        /// Side of cells of equal area, whose middles are the points, instead of a step and weights.
        pub spacing_km: Option<f64> = Optional(Number::from_to(0.1, 20_000.0)), unit "km",
            follows "step-deg", example Some(200.0);
        /// GeoJSON file with Polygons or MultiPolygons, instead of the limits; path relative to this file.
        pub polygon: Option<String> = Optional(Text::Any), follows "the limits", example Some("area.geojson".to_owned());
        /// One or more countries of Natural Earth 1:110m by their English names, instead of the limits.
        pub country: Option<Vec<Country>> = Optional(Countries), follows "the limits", example Some(Countries::example());
        /// CSV file of sites with the columns latitude_deg, longitude_deg and, optionally, name, weight, height_m over the
        /// surface and skyline (a file of azimuth_deg and elevation_deg), instead of the limits; path relative to this file.
        pub points: Option<String> = Optional(Text::Any), follows "the grid", example Some("points.csv".to_owned());
    }
}

impl RegionKeys {
    /// The keys of a region, and no others.
    fn of(region: &Region) -> Self {
        let nothing = Self {
            latitude_deg: None,
            longitude_deg: None,
            step_deg: None,
            weights: None,
            spacing_km: None,
            polygon: None,
            country: None,
            points: None,
        };
        match region {
            Region::Grid(grid) => Self {
                latitude_deg: Some(grid.latitude_deg),
                longitude_deg: Some(grid.longitude_deg),
                step_deg: Some(grid.step_deg),
                weights: Some(grid.weights),
                ..nothing
            },
            Region::Cells(cells) => Self {
                latitude_deg: Some(cells.latitude_deg),
                longitude_deg: Some(cells.longitude_deg),
                spacing_km: Some(cells.spacing_km),
                ..nothing
            },
            Region::Area { source, points } => nothing.with_source(source).with_points(points),
            Region::Points { file } => Self {
                points: Some(file.clone()),
                ..nothing
            },
        }
    }

    fn with_source(self, source: &AreaSource) -> Self {
        match source {
            AreaSource::Polygon { file } => Self {
                polygon: Some(file.clone()),
                ..self
            },
            AreaSource::Countries(countries) => Self {
                country: Some(countries.clone()),
                ..self
            },
        }
    }

    fn with_points(self, points: &AreaPoints) -> Self {
        match *points {
            AreaPoints::Lattice { step_deg, weights } => Self {
                step_deg: Some(step_deg),
                weights: Some(weights),
                ..self
            },
            AreaPoints::Cells { spacing_km } => Self {
                spacing_km: Some(spacing_km),
                ..self
            },
        }
    }

    /// The region of the keys that were given, with the defaults of the others.
    fn region(self, reader: &Reader<'_>) -> Region {
        let given = |key| reader.is_given(key);
        let file = |file: Option<String>| file.unwrap_or_default();
        if given(key!(RegionKeys.points)) {
            return Region::Points {
                file: file(self.points),
            };
        }
        let by_area = given(key!(RegionKeys.spacing_km));
        let spacing_km = self.spacing_km.unwrap_or_default();
        let (step_deg, weights) = (
            self.step_deg.unwrap_or_default(),
            self.weights.unwrap_or(PointWeights::Equal),
        );
        let source = if given(key!(RegionKeys.polygon)) {
            Some(AreaSource::Polygon {
                file: file(self.polygon),
            })
        } else if given(key!(RegionKeys.country)) {
            Some(AreaSource::Countries(self.country.unwrap_or_default()))
        } else {
            None
        };
        let (latitude_deg, longitude_deg) = (
            self.latitude_deg.unwrap_or_default(),
            self.longitude_deg.unwrap_or_default(),
        );
        match (source, by_area) {
            (Some(source), true) => Region::Area {
                source,
                points: AreaPoints::Cells { spacing_km },
            },
            (Some(source), false) => Region::Area {
                source,
                points: AreaPoints::Lattice { step_deg, weights },
            },
            (None, true) => Region::Cells(EqualAreaCells {
                latitude_deg,
                longitude_deg,
                spacing_km,
            }),
            (None, false) => Region::Grid(Grid {
                latitude_deg,
                longitude_deg,
                step_deg,
                weights,
            }),
        }
    }
}

/// The keys of a region that exclude one of them: limits, polygon, country and points exclude each other, as do steps
/// and spacing, and points exclude both.
pub(in crate::scenario) fn rivals(key: KeyPath) -> Vec<KeyPath> {
    let limits = [
        key!(RegionKeys.latitude_deg),
        key!(RegionKeys.longitude_deg),
    ];
    let steps = [key!(RegionKeys.step_deg), key!(RegionKeys.weights)];
    let spacing = key!(RegionKeys.spacing_km);
    let (polygon, country) = (key!(RegionKeys.polygon), key!(RegionKeys.country));
    let points = key!(RegionKeys.points);
    if key == points {
        [&limits[..], &steps, &[spacing, polygon, country]].concat()
    } else if limits.contains(&key) {
        vec![polygon, country, points]
    } else if steps.contains(&key) {
        vec![spacing, points]
    } else if key == spacing {
        [&steps[..], &[points]].concat()
    } else if key == polygon {
        [&limits[..], &[country, points]].concat()
    } else if key == country {
        [&limits[..], &[polygon, points]].concat()
    } else {
        Vec::new()
    }
}

impl Section for Region {
    const SECTION: &'static str = RegionKeys::SECTION;

    fn walk(walk: &mut impl Walk, values: Option<&Self>) -> Self {
        let keys = RegionKeys::walk(walk, values.map(RegionKeys::of).as_ref());
        let unread = Self::Points {
            file: String::new(),
        };
        walk.finish(unread, |region, reader| {
            refuse_rivals(reader);
            *region = keys.region(reader);
            region.check(reader);
        })
    }
}

/// Rejects keys that exclude each other, each at the first one.
fn refuse_rivals(reader: &mut Reader<'_>) {
    let keys = crate::scenario::keys::paths::<RegionKeys>();
    for (n, key) in keys.iter().enumerate() {
        let rivals = rivals(*key);
        let mut later = keys[n + 1..].iter().rev();
        let other = later.find(|other| rivals.contains(other) && reader.is_given(**other));
        if let Some(other) = other.filter(|_| reader.is_given(*key)) {
            let other = other.to_string();
            reader.refuse(&[*key], Fault::Excluded { other });
        }
    }
}

impl Region {
    /// Number of points of a grid, before a closing meridian is dropped, or about that of cells; `None` if it depends on a
    /// file or polygons.
    pub(in crate::scenario) fn count(&self) -> Option<f64> {
        match self {
            Self::Grid(grid) => Some(points(grid)),
            Self::Cells(cells) => {
                let [south, north] = cells.latitude_deg.map(|edge| edge.to_radians().sin());
                let [west, east] = cells.longitude_deg;
                let span = if east >= west {
                    east - west
                } else {
                    east - west + 360.0
                };
                let side = cells.spacing_km / RADIUS_KM;
                Some(span.to_radians() * (north - south) / (side * side))
            }
            Self::Area { .. } | Self::Points { .. } => None,
        }
    }

    fn check(&self, reader: &mut Reader<'_>) {
        let (latitude, longitude) = (
            key!(RegionKeys.latitude_deg),
            key!(RegionKeys.longitude_deg),
        );
        let keys = [
            key!(RegionKeys.step_deg),
            key!(RegionKeys.spacing_km),
            latitude,
            longitude,
        ];
        let Some(count) = self.count() else {
            return;
        };
        match self {
            Self::Grid(grid) => {
                reader.at_most(MAX_POINTS, count, "grid points", &keys);
                if grid.weights == PointWeights::CosLatitude && has_only_poles(grid) {
                    reader.refuse(&[latitude, key!(RegionKeys.weights)], Fault::Weightless);
                }
            }
            _ => reader.at_most(MAX_POINTS, count, "cells", &keys),
        }
    }

    /// What a region is, to follow "over": `China and Japan`, `the points in sites.csv`.
    #[must_use]
    pub fn told(&self) -> String {
        match self {
            Self::Grid(_) => "a grid".to_owned(),
            Self::Cells(_) => "cells of equal area".to_owned(),
            Self::Area {
                source: AreaSource::Polygon { file },
                ..
            } => format!("the polygons in {file}"),
            Self::Area {
                source: AreaSource::Countries(countries),
                ..
            } => {
                let names: Vec<&str> = countries.iter().map(|country| country.name()).collect();
                match names.as_slice() {
                    [] => String::new(),
                    [one] => (*one).to_owned(),
                    [others @ .., last] => format!("{} and {last}", others.join(", ")),
                }
            }
            Self::Points { file } => format!("the points in {file}"),
        }
    }
}

/// Number of points of a grid, before a closing meridian is dropped.
pub(in crate::scenario) fn points(grid: &Grid) -> f64 {
    count(grid.latitude_deg, grid.step_deg[0]) * count(grid.longitude_deg, grid.step_deg[1])
}

/// Whether every latitude of the grid is a pole.
fn has_only_poles(grid: &Grid) -> bool {
    let step = grid.step_deg[0];
    let one_row = count(grid.latitude_deg, step) < 2.0;
    grid.latitude_deg[0].abs() == 90.0 && (one_row || step >= 180.0)
}
