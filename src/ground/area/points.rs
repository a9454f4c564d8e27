//! The ground points inside an area.

use super::ServiceArea;
use crate::earth::Surface;
use crate::ground::cells::EqualAreaCells;
use crate::ground::{GroundError, MAX_POINTS, PointWeights, Site, row_weight};
use crate::units::round_decimal;

/// Decimals of a degree to which lattice points are multiples of their step: a tenth of a millimetre.
const DECIMALS: usize = 9;

/// Finest step in an area, degrees: 55 m.
pub(in crate::ground) const FINEST_STEP_DEG: f64 = 0.0005;

/// Finest spacing that an error suggests: degrees, and km.
const FINEST: [f64; 2] = [0.001, 0.1];

/// Most spacings that are tried for a suggestion.
const MOST_TRIED: usize = 14;

/// Which points inside an area are those of a region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AreaPoints {
    /// Those whose latitude and longitude are multiples of a step.
    Lattice {
        /// Steps in latitude and longitude, degrees.
        step_deg: [f64; 2],
        /// How points are weighted.
        weights: PointWeights,
    },
    /// The middles of the cells of equal area that cover the globe.
    Cells {
        /// Spacing, km.
        spacing_km: f64,
    },
}

/// Latitude, longitude and weight of a point.
type WeightedPlace = (f64, f64, f64);

impl AreaPoints {
    /// The points inside an area, row by row from the south, each row from the west. The rows of an area across the
    /// antimeridian continue beyond it, so that the area is in one piece.
    ///
    /// # Errors
    /// If there is none, with the largest spacing that gives some, or too many.
    pub fn sites(&self, area: &ServiceArea, surface: Surface) -> Result<Vec<Site>, GroundError> {
        let mut places = self.places(area, surface)?;
        if places.is_empty() {
            return Err(self.no_point(area, surface));
        }
        join(&mut places);
        let site = |(latitude_deg, longitude_deg, weight)| {
            Site::new(surface, latitude_deg, longitude_deg, weight)
        };
        places.into_iter().map(site).collect()
    }

    fn places(
        &self,
        area: &ServiceArea,
        surface: Surface,
    ) -> Result<Vec<WeightedPlace>, GroundError> {
        match *self {
            Self::Lattice { step_deg, weights } => lattice(area, step_deg, weights),
            Self::Cells { spacing_km } => cells(area, spacing_km, surface),
        }
    }

    /// The error for an area between the points.
    fn no_point(&self, area: &ServiceArea, surface: Surface) -> GroundError {
        let (spacing, finest) = match *self {
            Self::Lattice { step_deg, .. } => (step_deg[0].min(step_deg[1]), FINEST[0]),
            Self::Cells { spacing_km } => (spacing_km, FINEST[1]),
        };
        let mut tried = finer(spacing)
            .take_while(|one| *one >= finest)
            .take(MOST_TRIED);
        let suggested = tried.find_map(|spacing| {
            let points = self.with_spacing(spacing).places(area, surface).ok()?.len();
            (points > 0).then_some((spacing, points))
        });
        GroundError::NoPoint {
            points: *self,
            area_km2: area.area_km2(surface),
            suggested,
        }
    }

    fn with_spacing(&self, spacing: f64) -> Self {
        match *self {
            Self::Lattice { weights, .. } => Self::Lattice {
                step_deg: [spacing; 2],
                weights,
            },
            Self::Cells { .. } => Self::Cells {
                spacing_km: spacing,
            },
        }
    }

    /// The key of the spacing, with its value and unit.
    pub(in crate::ground) fn spacing(&self) -> (&'static str, String, &'static str) {
        match *self {
            Self::Lattice {
                step_deg: [a, b], ..
            } if a == b => ("step-deg", a.to_string(), "degrees"),
            Self::Lattice {
                step_deg: [a, b], ..
            } => ("step-deg", format!("[{a}, {b}]"), "degrees"),
            Self::Cells { spacing_km } => ("spacing-km", spacing_km.to_string(), "km"),
        }
    }
}

/// The numbers 1, 2 and 5 times powers of ten below a spacing, from the largest.
fn finer(spacing: f64) -> impl Iterator<Item = f64> {
    let decade = spacing.log10().floor() as i32;
    let powers = (0..).map(move |n| decade - n);
    let numbers = powers.flat_map(|power| {
        [5.0, 2.0, 1.0].map(|digit| round_decimal(digit * 10_f64.powi(power), DECIMALS))
    });
    numbers.filter(move |number| *number < spacing)
}

/// The multiples of a step from `low` on.
fn multiples(low: f64, step: f64) -> impl Iterator<Item = f64> {
    let first = (low / step).floor() as i64;
    let values = (first..).map(move |k| round_decimal(k as f64 * step, DECIMALS));
    values.skip_while(move |value| *value < low)
}

fn lattice(
    area: &ServiceArea,
    [rows_deg, columns_deg]: [f64; 2],
    weights: PointWeights,
) -> Result<Vec<WeightedPlace>, GroundError> {
    let finest = rows_deg.min(columns_deg);
    if finest < FINEST_STEP_DEG {
        return Err(GroundError::FineStep(finest));
    }
    let [south, north] = area.latitudes_deg();
    let mut places = Vec::new();
    let rows = multiples(south, rows_deg).take_while(|latitude| *latitude <= north);
    for latitude in rows {
        let weight = row_weight(weights, latitude, rows_deg);
        for [west, east] in area.row(latitude) {
            let row = multiples(west, columns_deg).take_while(|longitude| *longitude < east);
            places.extend(row.map(|longitude| (latitude, longitude, weight)));
            require_few(places.len())?;
        }
    }
    Ok(places)
}

fn cells(
    area: &ServiceArea,
    spacing_km: f64,
    surface: Surface,
) -> Result<Vec<WeightedPlace>, GroundError> {
    let globe = EqualAreaCells::globe(spacing_km);
    let [south, north] = area.latitudes_deg();
    let mut places = Vec::new();
    for row in globe.rows(surface)? {
        let latitude = row.latitude_deg;
        if !(south..=north).contains(&latitude) {
            continue;
        }
        for [west, east] in area.row(latitude) {
            let first =
                (((west - row.west_deg) / row.width_deg).floor() as usize).saturating_sub(1);
            let longitudes = (first..row.cells).map(|k| row.longitude_deg(k));
            let inside = longitudes
                .skip_while(|longitude| *longitude < west)
                .take_while(|longitude| *longitude < east);
            places.extend(inside.map(|longitude| (latitude, longitude, 1.0)));
            require_few(places.len())?;
        }
    }
    Ok(places)
}

fn require_few(points: usize) -> Result<(), GroundError> {
    if points > MAX_POINTS {
        let points = points as f64;
        return Err(GroundError::TooMany { points });
    }
    Ok(())
}

/// Moves the points west of the widest gap in longitude beyond the antimeridian, so that the gap is outside; each row keeps
/// its order from the west.
fn join(places: &mut [WeightedPlace]) {
    let mut longitudes: Vec<f64> = places.iter().map(|place| place.1).collect();
    longitudes.sort_by(f64::total_cmp);
    longitudes.dedup();
    let (Some(&first), Some(&last)) = (longitudes.first(), longitudes.last()) else {
        return;
    };
    let across = first + 360.0 - last;
    let gaps = longitudes
        .windows(2)
        .map(|pair| (pair[1] - pair[0], pair[1]));
    let widest = gaps.max_by(|a, b| a.0.total_cmp(&b.0));
    let Some((gap, west)) = widest.filter(|(gap, _)| *gap > across + 1e-6) else {
        return;
    };
    // The gap's eastern end is the area's western one.
    let east = west - gap + 360.0;
    let shift = if west + east >= 360.0 {
        [-360.0, 0.0]
    } else {
        [0.0, 360.0]
    };
    for place in places.iter_mut() {
        place.1 += if place.1 >= west { shift[0] } else { shift[1] };
    }
    places.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
}
