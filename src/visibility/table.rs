//! Elevation masks by azimuth: the skyline around a receiver.

use super::MaskError;
use crate::frames::LocalFrame;
use nalgebra::Vector3;
use thiserror::Error;

/// Why vertices do not define a mask around the whole horizon.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum MaskTableError {
    /// No vertex.
    #[error("the mask table is empty; it must cover azimuths 0 to 360 degrees")]
    Empty,
    /// The first azimuth is not 0.
    #[error("the mask table starts at azimuth {0} degrees; it must start at 0")]
    Start(f64),
    /// The last azimuth is not 360.
    #[error("the mask table ends at azimuth {0} degrees; it must end at 360")]
    End(f64),
    /// Azimuths that do not increase.
    #[error("azimuth {after} degrees follows {before} in the mask table; azimuths must increase")]
    Order {
        /// Azimuth before, degrees.
        before: f64,
        /// Azimuth that is not larger, degrees.
        after: f64,
    },
    /// The masks at 0° and 360°, the same direction, differ.
    #[error("the mask is {at_0} degrees at azimuth 0 but {at_360} at 360; both are north")]
    Seam {
        /// Mask at azimuth 0, degrees.
        at_0: f64,
        /// Mask at azimuth 360, degrees.
        at_360: f64,
    },
    /// A mask outside its range.
    #[error("at azimuth {azimuth_deg} degrees: {source}")]
    Mask {
        /// Azimuth, degrees.
        azimuth_deg: f64,
        /// What is wrong.
        source: MaskError,
    },
}

/// An elevation mask by azimuth, linear between vertices from 0° to 360°
/// ([M-23](crate::models#m-23)).
#[derive(Debug, Clone, PartialEq)]
pub struct MaskTable {
    /// (azimuth, mask), degrees; azimuths increase from 0 to 360.
    pub(super) vertices: Vec<(f64, f64)>,
}

impl MaskTable {
    /// The mask through vertices (azimuth from north through east, elevation mask), degrees.
    ///
    /// # Errors
    /// If the azimuths do not cover 0 to 360, with the gap, or a vertex is invalid.
    pub fn new(vertices: Vec<(f64, f64)>) -> Result<Self, MaskTableError> {
        let (Some(&first), Some(&last)) = (vertices.first(), vertices.last()) else {
            return Err(MaskTableError::Empty);
        };
        for &(azimuth_deg, mask_deg) in &vertices {
            if !(0.0..90.0).contains(&mask_deg) {
                let source = MaskError(mask_deg);
                return Err(MaskTableError::Mask {
                    azimuth_deg,
                    source,
                });
            }
        }
        if first.0 != 0.0 {
            return Err(MaskTableError::Start(first.0));
        }
        for pair in vertices.windows(2) {
            let (before, after) = (pair[0].0, pair[1].0);
            if after.is_nan() || after <= before {
                return Err(MaskTableError::Order { before, after });
            }
        }
        if last.0 != 360.0 {
            return Err(MaskTableError::End(last.0));
        }
        if first.1 != last.1 {
            let (at_0, at_360) = (first.1, last.1);
            return Err(MaskTableError::Seam { at_0, at_360 });
        }
        Ok(Self { vertices })
    }

    /// The vertices (azimuth, mask), degrees; azimuths increase from 0 to 360.
    #[must_use]
    pub fn vertices(&self) -> &[(f64, f64)] {
        &self.vertices
    }

    /// The mask at an azimuth from 0 to 360 degrees, degrees.
    #[must_use]
    pub fn degrees_at(&self, azimuth_deg: f64) -> f64 {
        let behind = self
            .vertices
            .partition_point(|vertex| vertex.0 <= azimuth_deg)
            .clamp(1, self.vertices.len() - 1);
        let ((from_deg, from), (to_deg, to)) = (self.vertices[behind - 1], self.vertices[behind]);
        from + (to - from) * (azimuth_deg - from_deg) / (to_deg - from_deg)
    }

    /// The least and the greatest mask from one azimuth eastwards to another, degrees, which may be beyond 0 and 360.
    #[must_use]
    pub(crate) fn bounds_deg(&self, from_deg: f64, to_deg: f64) -> (f64, f64) {
        let span_deg = (to_deg - from_deg).min(360.0);
        let from_deg = from_deg.rem_euclid(360.0);
        let ends =
            [from_deg, (from_deg + span_deg).rem_euclid(360.0)].map(|end| self.degrees_at(end));
        let between = |from_deg: f64| {
            let first = self.vertices.partition_point(|vertex| vertex.0 < from_deg);
            let last = self
                .vertices
                .partition_point(|vertex| vertex.0 <= from_deg + span_deg);
            self.vertices[first..last].iter().map(|vertex| vertex.1)
        };
        let inside = between(from_deg).chain(between(from_deg - 360.0));
        let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        inside.fold((low, high), |(low, high), mask| {
            (low.min(mask), high.max(mask))
        })
    }

    /// Whether a direction (Earth-fixed unit vector) is at or above the mask of its azimuth.
    #[must_use]
    pub fn clears(&self, site: &LocalFrame, unit: Vector3<f64>) -> bool {
        let (elevation_rad, azimuth_rad) = site.look_angles(site.origin_km + unit);
        elevation_rad.to_degrees() >= self.degrees_at(azimuth_rad.to_degrees())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::earth::Surface;

    fn street() -> MaskTable {
        MaskTable::new(vec![
            (0.0, 10.0),
            (90.0, 50.0),
            (180.0, 10.0),
            (360.0, 10.0),
        ])
        .unwrap()
    }

    #[test]
    fn masks_are_straight_between_vertices() {
        for (azimuth_deg, mask_deg) in [
            (0.0, 10.0),
            (45.0, 30.0),
            (90.0, 50.0),
            (135.0, 30.0),
            (180.0, 10.0),
            (270.0, 10.0),
            (360.0, 10.0),
        ] {
            assert_eq!(street().degrees_at(azimuth_deg), mask_deg, "{azimuth_deg}");
        }
    }

    /// Within a segment, across a vertex, across north, and all around.
    #[test]
    fn bounds_are_over_all_azimuths_between() {
        for (from_deg, to_deg, low, high) in [
            (0.0, 45.0, 10.0, 30.0),
            (81.0, 108.0, 42.0, 50.0),
            (-90.0, 9.0, 10.0, 14.0),
            (351.0, 369.0, 10.0, 14.0),
            (200.0, 560.0, 10.0, 50.0),
            (100.0, 2000.0, 10.0, 50.0),
            (250.0, 250.0, 10.0, 10.0),
        ] {
            let (found_low, found_high) = street().bounds_deg(from_deg, to_deg);
            let apart = (found_low - low).abs().max((found_high - high).abs());
            assert!(
                apart < 1e-12,
                "{from_deg} {to_deg}: {found_low} {found_high}"
            );
        }
    }

    #[test]
    fn directions_clear_the_mask_of_their_azimuth() {
        let site = LocalFrame::new(Surface::Wgs84, 0.6, 1.9);
        for azimuth_deg in [5.0_f64, 45.0, 100.0, 300.0] {
            let mask_deg = street().degrees_at(azimuth_deg);
            for (offset_deg, clear) in [(1e-6, true), (-1e-6, false)] {
                let (s, c) = (mask_deg + offset_deg).to_radians().sin_cos();
                let (sin_az, cos_az) = azimuth_deg.to_radians().sin_cos();
                let unit = site.up * s + (site.east * sin_az + site.north * cos_az) * c;
                assert_eq!(street().clears(&site, unit), clear, "{azimuth_deg}");
            }
        }
    }

    #[test]
    fn gaps_are_named() {
        let error = |vertices: &[(f64, f64)]| MaskTable::new(vertices.to_vec()).unwrap_err();
        assert_eq!(error(&[]), MaskTableError::Empty);
        assert_eq!(
            error(&[(10.0, 5.0), (360.0, 5.0)]).to_string(),
            "the mask table starts at azimuth 10 degrees; it must start at 0"
        );
        assert_eq!(
            error(&[(0.0, 5.0), (350.0, 5.0)]),
            MaskTableError::End(350.0)
        );
        assert_eq!(error(&[(0.0, 5.0)]), MaskTableError::End(0.0));
        let order = error(&[(0.0, 5.0), (90.0, 5.0), (90.0, 6.0), (360.0, 5.0)]);
        assert!(matches!(order, MaskTableError::Order { .. }));
        let lost = error(&[(0.0, 5.0), (f64::NAN, 5.0), (360.0, 5.0)]);
        assert!(matches!(lost, MaskTableError::Order { .. }));
        let seam = error(&[(0.0, 5.0), (360.0, 6.0)]);
        assert!(matches!(seam, MaskTableError::Seam { .. }));
        assert_eq!(
            error(&[(0.0, 5.0), (120.0, 95.0), (360.0, 5.0)]).to_string(),
            "at azimuth 120 degrees: mask 95 degrees is outside 0 to 90 (exclusive)"
        );
    }
}
