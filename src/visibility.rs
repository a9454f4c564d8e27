//! The one definition of visibility.

mod skyline;
mod table;

pub use skyline::SkylineError;
pub(crate) use skyline::is_pairs;
pub use table::{MaskTable, MaskTableError};

use crate::frames::{EarthFixed, LocalFrame, Position};
use nalgebra::Vector3;
use thiserror::Error;

/// An elevation mask that is not in [0°, 90°).
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("mask {0} degrees is outside 0 to 90 (exclusive)")]
pub struct MaskError(pub f64);

/// An elevation mask: a satellite is visible at this elevation or above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mask {
    degrees: f64,
    sin2: f64,
}

impl Default for Mask {
    /// 7°.
    fn default() -> Self {
        Self::unchecked(7.0)
    }
}

impl Mask {
    /// The mask of an elevation in degrees, 0 <= elevation < 90.
    ///
    /// # Errors
    /// If the elevation is outside that range.
    pub fn from_degrees(degrees: f64) -> Result<Self, MaskError> {
        if (0.0..90.0).contains(&degrees) {
            Ok(Self::unchecked(degrees))
        } else {
            Err(MaskError(degrees))
        }
    }

    fn unchecked(degrees: f64) -> Self {
        let sin = degrees.to_radians().sin();
        Self {
            degrees,
            sin2: sin * sin,
        }
    }

    /// The elevation, degrees.
    #[must_use]
    pub fn degrees(self) -> f64 {
        self.degrees
    }

    /// The square of the sine of the elevation, used in the visibility test.
    pub(crate) fn sine_squared(self) -> f64 {
        self.sin2
    }

    /// The unit vector from the site to the satellite (Earth-fixed, km) if the satellite is
    /// visible: its elevation over the local horizon is at least the mask
    /// ([M-22](crate::models#m-22)).
    ///
    /// sin(elevation) = u·d / |d| is compared in squared form, which needs no root for satellites out
    /// of view; u·d >= 0 fixes the sign, because masks are not negative.
    #[must_use]
    pub fn line_of_sight(
        self,
        site: &LocalFrame,
        target_km: Position<EarthFixed>,
    ) -> Option<Vector3<f64>> {
        let line = target_km - site.origin_km;
        let height = site.up.dot(&line);
        if height < 0.0 {
            return None;
        }
        let range2 = line.norm_squared();
        (height * height >= self.sin2 * range2 && range2 > 0.0).then(|| line / range2.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::earth::Surface;

    /// The decision agrees with the elevation in the local frame on both sides of the mask.
    #[test]
    fn decisions_follow_the_elevation() {
        let site = LocalFrame::new(Surface::Wgs84, 0.6, 1.9);
        for mask_deg in [0.0, 5.0, 10.0, 60.0] {
            let mask = Mask::from_degrees(mask_deg).unwrap();
            for azimuth_deg in [0.0_f64, 77.0, 180.0, 300.0] {
                for (offset_deg, seen) in [(1e-7, true), (-1e-7, false)] {
                    let (s, c) = (mask_deg + offset_deg).to_radians().sin_cos();
                    let (sin_az, cos_az) = azimuth_deg.to_radians().sin_cos();
                    let line = site.up * s + (site.east * sin_az + site.north * cos_az) * c;
                    let found = mask.line_of_sight(&site, site.origin_km + line * 2000.0);
                    assert_eq!(
                        found.is_some(),
                        seen,
                        "{mask_deg} {azimuth_deg} {offset_deg}"
                    );
                    assert!(found.is_none_or(|v| (v - line).norm() < 1e-12));
                }
            }
            assert!(
                mask.line_of_sight(&site, Position::new(-site.origin_km.km()))
                    .is_none()
            );
        }
    }

    /// A satellite on the horizon plane is at a mask of 0°, and visible; one a rounding below is not.
    #[test]
    fn at_the_mask_is_visible() {
        let site = LocalFrame::new(Surface::Sphere, 0.0, 0.0);
        let mask = Mask::from_degrees(0.0).unwrap();
        let at = |height_km: f64| {
            let line = Vector3::new(0.0, 300.0, 400.0);
            let origin = site.origin_km.km();
            let target = Vector3::new(origin.x + height_km, line.y, line.z);
            mask.line_of_sight(&site, Position::new(target))
        };
        assert_eq!(at(0.0), Some(Vector3::new(0.0, 0.6, 0.8)));
        assert_eq!(at(-1e-12), None);
    }

    #[test]
    fn masks_are_checked() {
        assert_eq!(Mask::from_degrees(95.0), Err(MaskError(95.0)));
        assert!(Mask::from_degrees(-1.0).is_err() && Mask::from_degrees(f64::NAN).is_err());
    }
}
