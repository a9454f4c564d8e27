//! Coastlines from Natural Earth, which is in the public domain; see `data/MANIFEST.toml`.

/// 1:110 million, for the globe.
const WORLD: &str = include_str!("../../data/coastline/world-110m.txt");

/// 1:50 million, for regions.
const DETAILED: &str = include_str!("../../data/coastline/world-50m.txt");

/// A part of the map; longitudes may be outside [-180°, 180°].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// South and north, degrees.
    pub latitude_deg: [f64; 2],
    /// West and east, degrees.
    pub longitude_deg: [f64; 2],
}

impl Bounds {
    /// The smallest bounds around points (latitude, longitude), widened by `margin_deg`; `None`
    /// without points.
    #[must_use]
    pub fn around(points: impl Iterator<Item = (f64, f64)>, margin_deg: f64) -> Option<Self> {
        let grow = |[lo, hi]: [f64; 2], x: f64| [lo.min(x - margin_deg), hi.max(x + margin_deg)];
        let empty = [f64::INFINITY, f64::NEG_INFINITY];
        let mut bounds = Self {
            latitude_deg: empty,
            longitude_deg: empty,
        };
        for (latitude, longitude) in points {
            bounds.latitude_deg = grow(bounds.latitude_deg, latitude);
            bounds.longitude_deg = grow(bounds.longitude_deg, longitude);
        }
        let [south, north] = bounds.latitude_deg;
        bounds.latitude_deg = [south.max(-90.0), north.min(90.0)];
        (south <= north).then_some(bounds)
    }

    fn holds(&self, [longitude, latitude]: [f64; 2]) -> bool {
        let within = |[lo, hi]: [f64; 2], x: f64| (lo..=hi).contains(&x);
        within(self.longitude_deg, longitude) && within(self.latitude_deg, latitude)
    }
}

/// Polylines of [longitude, latitude], degrees.
fn lines(text: &str) -> impl Iterator<Item = Vec<[f64; 2]>> {
    text.lines().map(|line| {
        let hundredths = line
            .split_ascii_whitespace()
            .filter_map(|x| x.parse::<f64>().ok());
        let degrees: Vec<f64> = hundredths.map(|x| x / 100.0).collect();
        degrees.chunks_exact(2).map(|p| [p[0], p[1]]).collect()
    })
}

/// The coasts of the world.
#[must_use]
pub fn world() -> Vec<Vec<[f64; 2]>> {
    lines(WORLD).collect()
}

/// The coasts within some bounds, at the longitudes of the bounds; lines end at the first point
/// outside.
#[must_use]
pub fn within(bounds: &Bounds) -> Vec<Vec<[f64; 2]>> {
    let coasts: Vec<Vec<[f64; 2]>> = lines(DETAILED).collect();
    lines_within(&coasts, bounds)
}

/// The parts of lines within some bounds, at the longitudes of the bounds; they end at the first point outside.
#[must_use]
pub fn lines_within(lines: &[Vec<[f64; 2]>], bounds: &Bounds) -> Vec<Vec<[f64; 2]>> {
    let mut found = Vec::new();
    for line in lines {
        // A line that crosses the antimeridian continues beyond it.
        for turn in [-720.0, -360.0, 0.0, 360.0, 720.0] {
            let turned = line.iter().map(|[x, y]| [x + turn, *y]);
            clip(turned, bounds, &mut found);
        }
    }
    found
}

fn clip(line: impl Iterator<Item = [f64; 2]>, bounds: &Bounds, found: &mut Vec<Vec<[f64; 2]>>) {
    let mut run: Vec<[f64; 2]> = Vec::new();
    let mut before: Option<[f64; 2]> = None;
    for point in line {
        let inside = bounds.holds(point);
        if inside && run.is_empty() {
            run.extend(before);
        }
        if inside || !run.is_empty() {
            run.push(point);
        }
        if !inside && !run.is_empty() {
            found.push(std::mem::take(&mut run));
        }
        before = Some(point);
    }
    if run.len() > 1 {
        found.push(run);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coasts_are_on_earth_and_pass_known_places() {
        for line in lines(WORLD).chain(lines(DETAILED)) {
            assert!(line.len() >= 2);
            assert!(
                line.iter()
                    .all(|[x, y]| x.abs() <= 540.0 && y.abs() <= 90.0)
            );
        }
        // Cape Agulhas, the southern end of Africa, is at 34.83° S, 20.00° E; the data are
        // accurate to a few hundredths of a degree here, and simplified by 0.05°.
        let cape = Bounds {
            latitude_deg: [-35.5, -34.0],
            longitude_deg: [18.5, 21.5],
        };
        let southern = within(&cape).concat().into_iter().map(|[_, y]| y);
        assert!((southern.fold(0.0, f64::min) + 34.83).abs() < 0.1);
    }

    #[test]
    fn clipping_follows_the_bounds_across_the_antimeridian() {
        let fiji = |west: f64| Bounds {
            latitude_deg: [-20.0, -15.0],
            longitude_deg: [west, west + 8.0],
        };
        let east = within(&fiji(176.0)).concat();
        let west = within(&fiji(-184.0)).concat();
        assert!(!east.is_empty());
        assert_eq!(east.len(), west.len());
        assert!(east.iter().all(|[x, _]| (170.0..190.0).contains(x)));
    }

    #[test]
    fn bounds_grow_around_points() {
        let bounds = Bounds::around([(10.0, 20.0), (88.0, -5.0)].into_iter(), 3.0).unwrap();
        assert_eq!(bounds.latitude_deg, [7.0, 90.0]);
        assert_eq!(bounds.longitude_deg, [-8.0, 23.0]);
        assert!(Bounds::around(std::iter::empty(), 3.0).is_none());
    }
}
