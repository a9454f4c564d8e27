//! The parts of a scenario other than the satellites of the design: the region with its
//! metrics, the GNSS, masks and conventions, for the programs that rebuild or show it.

use crate::constellation::gnss::{GnssSatellite, System};
use crate::earth::Surface;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::evaluate::{Evaluator, PointMetrics, Series};
use crate::ground::shapes::LonLat;
use crate::units::round_decimal;
use std::sync::OnceLock;

/// Most ground points of a file that a viewer loads whole.
pub const MAX_SHOWN_POINTS: usize = 20_000;

/// The constellation that a scene shows.
pub struct ShownConstellation<'a> {
    /// Its satellites.
    pub ephemeris: &'a Ephemeris,
    /// Its notation, or its name.
    pub title: String,
    /// Whether the title is the notation of a design.
    pub is_design: bool,
    /// What it is and how it is propagated, in a sentence.
    pub told: String,
}

/// A scenario around a constellation.
pub struct Scene<'a> {
    evaluator: &'a Evaluator,
    constellation: ShownConstellation<'a>,
    surface: Surface,
    points: OnceLock<Vec<PointMetrics>>,
}

impl<'a> Scene<'a> {
    /// The scenario of an evaluator around a constellation.
    #[must_use]
    pub fn new(
        evaluator: &'a Evaluator,
        constellation: ShownConstellation<'a>,
        surface: Surface,
    ) -> Self {
        Self {
            evaluator,
            constellation,
            surface,
            points: OnceLock::new(),
        }
    }

    /// What the evaluations depend on.
    #[must_use]
    pub fn setup(&self) -> &'a crate::evaluate::Setup {
        self.evaluator.setup()
    }

    /// The satellites of the constellation.
    #[must_use]
    pub fn ephemeris(&self) -> &'a Ephemeris {
        self.constellation.ephemeris
    }

    /// The notation or the name of the constellation.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.constellation.title
    }

    /// What the title is: `design` or `constellation`.
    pub(crate) fn title_key(&self) -> &'static str {
        match self.constellation.is_design {
            true => "design",
            false => "constellation",
        }
    }

    /// The surface that ground points lie on.
    #[must_use]
    pub fn surface(&self) -> Surface {
        self.surface
    }

    /// The metrics of each ground point, in the order of the setup.
    pub(crate) fn points(&self) -> Result<&[PointMetrics], EphemerisError> {
        if let Some(points) = self.points.get() {
            return Ok(points);
        }
        let points = self.series()?.points;
        Ok(self.points.get_or_init(|| points))
    }

    /// The metrics by ground point and by instant.
    pub(crate) fn series(&self) -> Result<Series, EphemerisError> {
        self.evaluator.series(self.ephemeris())
    }

    /// The satellites of each system.
    pub(crate) fn systems(&self) -> Vec<(&'a System, Vec<GnssSatellite>)> {
        self.setup().gnss_in_service()
    }

    /// The corners of the cell of a point; none if points are a list.
    pub(crate) fn cell(&self, point: &PointMetrics) -> Option<[LonLat; 2]> {
        let map = &self.evaluator.setup().map;
        map.cell([point.longitude_deg, point.latitude_deg])
    }

    /// The borders of the area that the points are in, as closed lines; none of a grid or a list.
    pub(crate) fn borders(&self) -> &'a [Vec<LonLat>] {
        &self.evaluator.setup().map.outlines
    }

    /// The settings another program needs to get the same numbers, one sentence each.
    #[must_use]
    pub fn assumptions(&self) -> Vec<String> {
        let setup = self.setup();
        let grid = setup.grid;
        let span_s = grid.step_s() * grid.len() as f64;
        let mut told = vec![
            format!(
                "time: {} samples from {}, every {} s, over {span_s} s",
                grid.len(),
                grid.epoch(),
                grid.step_s()
            ),
            self.constellation.told.clone(),
        ];
        told.extend(self.region_assumptions());
        told.push(format!(
            "masks: {}° for the {}, {}° for the GNSS{}",
            setup.mask.degrees(),
            self.title_key(),
            setup.gnss_mask.degrees(),
            if setup.has_skylines() {
                ", and the skylines of points (visibility.mask-table, region.terrain, or of sites)"
            } else {
                ""
            }
        ));
        for (system, satellites) in self.systems() {
            told.push(format!(
                "GNSS: {}, {} satellites",
                system.name(),
                satellites.len()
            ));
        }
        told.push(format!(
            "PDOP: clocks {}, observation weights {}, unsolved above {}",
            setup.clocks, setup.observation_weights, setup.pdop_cap
        ));
        told
    }

    /// The heights of the points, if they have any.
    fn heights(&self) -> String {
        let heights = || self.setup().sites.iter().map(|site| site.height_m);
        let (low, high) = (
            heights().fold(f64::INFINITY, f64::min),
            heights().fold(f64::NEG_INFINITY, f64::max),
        );
        if low == 0.0 && high == 0.0 {
            return String::new();
        }
        format!(", {low} to {high} m over the surface (maps and points.pnt show them at height 0)")
    }

    fn region_assumptions(&self) -> Vec<String> {
        let points = self.setup().sites.len();
        let mut told = Vec::new();
        told.push(match self.setup().map.told.as_str() {
            "" => format!("region: {points} points from a list{}", self.heights()),
            what => format!("region: {points} points, {what}"),
        });
        told.push(match self.surface {
            Surface::Wgs84 => {
                "ground: WGS 84, geodetic latitudes, vertical normal to the ellipsoid".to_owned()
            }
            Surface::Sphere => {
                "ground: a sphere of the equatorial radius with geocentric latitudes, \
                 written unchanged: a program with an ellipsoid places them up to 21 km away"
                    .to_owned()
            }
        });
        told
    }
}

/// A longitude in [-180°, 180°).
pub(crate) fn wrapped(longitude_deg: f64) -> f64 {
    round_decimal((longitude_deg + 180.0).rem_euclid(360.0) - 180.0, 9)
}

/// Where a point lies on a map.
pub(crate) fn point_place(point: &PointMetrics) -> LonLat {
    [wrapped(point.longitude_deg), point.latitude_deg]
}

/// A point's metric with the digits that a map needs.
pub(crate) fn shown(value: f64) -> f64 {
    round_decimal(value, 4)
}

/// The colours of mean PDOP over the points of a region.
pub(crate) struct ColourScale {
    low: f64,
    high: f64,
}

/// Colour of a point without a solution.
pub(crate) const UNSOLVED: [u8; 3] = [128, 128, 128];

/// Five colours of equal distance on the map *viridis* (van der Walt and Smith, CC0), from low to high.
const COLOURS: [[u8; 3]; 5] = [
    [68, 1, 84],
    [59, 82, 139],
    [33, 145, 140],
    [94, 201, 98],
    [253, 231, 37],
];

impl ColourScale {
    /// The scale from the least to the greatest mean PDOP; none if no point is solved.
    pub(crate) fn of(points: &[PointMetrics]) -> Option<Self> {
        let values = || points.iter().filter_map(|point| point.mean_pdop);
        let low = values().reduce(f64::min)?;
        let high = values().reduce(f64::max)?;
        Some(Self { low, high })
    }

    /// The colour of a PDOP: red, green, blue.
    pub(crate) fn colour(&self, pdop: f64) -> [u8; 3] {
        let range = self.high - self.low;
        let share = if range > 0.0 {
            ((pdop - self.low) / range).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let at = share * (COLOURS.len() - 1) as f64;
        let below = (at as usize).min(COLOURS.len() - 2);
        let rest = at - below as f64;
        let mix = |c: usize| {
            let (a, b) = (COLOURS[below][c], COLOURS[below + 1][c]);
            (f64::from(a) * (1.0 - rest) + f64::from(b) * rest).round() as u8
        };
        [mix(0), mix(1), mix(2)]
    }

    /// Values from low to high for a legend, with their colours.
    pub(crate) fn legend(&self) -> Vec<(f64, [u8; 3])> {
        let steps = if self.high > self.low { 4 } else { 0 };
        let value = |k: usize| match k {
            0 => self.low,
            _ => self.low + (self.high - self.low) * k as f64 / steps as f64,
        };
        (0..=steps)
            .map(value)
            .map(|x| (x, self.colour(x)))
            .collect()
    }
}

/// The colour of a mean PDOP, or that of a point without one.
pub(crate) fn colour_of(scale: Option<&ColourScale>, pdop: Option<f64>) -> [u8; 3] {
    match (scale, pdop) {
        (Some(scale), Some(pdop)) => scale.colour(pdop),
        _ => UNSOLVED,
    }
}

/// The colour of group `k` of `groups`: equal steps around the circle of hues.
pub(crate) fn group_colour(k: usize, groups: usize) -> [u8; 3] {
    let hue = 6.0 * k as f64 / groups.max(1) as f64;
    let channel = |offset: f64| {
        let at = (hue + offset) % 6.0;
        let level = (at.min(4.0 - at)).clamp(0.0, 1.0);
        (255.0 * (1.0 - 0.75 * level)).round() as u8
    };
    [channel(5.0), channel(3.0), channel(1.0)]
}
