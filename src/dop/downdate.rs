//! Sums from which observations are taken away again ([M-56](crate::models#m-56)).

use super::{ClockGroup, Geometry, Symmetric3};
use nalgebra::Vector3;

/// A geometry is good where the determinant of its normal matrix exceeds this share of its cubed trace: there the minors of
/// downdated sums keep the digits that they need.
const GOOD_DETERMINANT: f64 = 1.0 / 256.0;

impl ClockGroup {
    /// Takes away an observation that was [added](ClockGroup::add).
    pub(crate) fn remove(&mut self, unit: Vector3<f64>, weight: f64) {
        if weight > 0.0 {
            self.squares += Symmetric3::outer(unit, -weight);
            self.sum -= unit * weight;
            self.weight -= weight;
            self.count -= 1;
        }
    }
}

impl Geometry {
    /// Whether there are too few satellites for a position, which numbers alone decide.
    pub(crate) fn lacks_satellites(&self) -> bool {
        self.satellites < 3 + self.clocks
    }

    /// PDOP up to `limit` of a good geometry, where rounding decides nothing; `None` for others, solved or not.
    ///
    /// PDOP² is the sum of the principal minors over the determinant ([M-25](crate::models#m-25)).
    pub(crate) fn good_pdop(&self, limit: f64) -> Option<f64> {
        let Symmetric3 {
            xx,
            yy,
            zz,
            xy,
            xz,
            yz,
        } = self.normal;
        let (minor_x, minor_y, minor_z) = (yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy);
        let determinant = xx * minor_x - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
        let trace = xx + yy + zz;
        let is_good = determinant > GOOD_DETERMINANT * trace * trace * trace;
        if !is_good || self.lacks_satellites() {
            return None;
        }
        let pdop = ((minor_x + minor_y + minor_z) / determinant).sqrt();
        (pdop <= limit).then_some(pdop)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn direction(elevation_deg: f64, azimuth_deg: f64) -> Vector3<f64> {
        let (sin_e, cos_e) = elevation_deg.to_radians().sin_cos();
        let (sin_a, cos_a) = azimuth_deg.to_radians().sin_cos();
        Vector3::new(cos_e * sin_a, cos_e * cos_a, sin_e)
    }

    const SKY: [(f64, f64); 6] = [
        (10.0, 0.0),
        (40.0, 100.0),
        (70.0, 200.0),
        (20.0, 290.0),
        (15.0, 150.0),
        (33.0, 40.0),
    ];

    fn group(sky: &[(f64, f64)]) -> ClockGroup {
        let mut group = ClockGroup::default();
        for (n, &(elevation, azimuth)) in sky.iter().enumerate() {
            group.add(direction(elevation, azimuth), 1.0 + 0.25 * n as f64);
        }
        group
    }

    #[test]
    fn what_is_taken_away_was_never_there() {
        let mut ours = group(&SKY);
        ours.remove(direction(33.0, 40.0), 2.25);
        ours.remove(direction(50.0, 40.0), 0.0);
        let expected = group(&SKY[..5]);
        let pdop = |group: &ClockGroup| {
            let mut geometry = Geometry::default();
            geometry.add(group);
            [
                geometry.pdop(100.0).unwrap(),
                geometry.good_pdop(100.0).unwrap(),
            ]
        };
        let ([a, b], [c, d]) = (pdop(&ours), pdop(&expected));
        for value in [a, b, d] {
            assert!((value / c - 1.0).abs() < 1e-13, "{value} {c}");
        }
        assert_eq!((ours.count, ours.weight), (5, expected.weight));
    }

    /// Directions in a cone leave one component to rounding: no minors are trusted, whatever their ratio.
    #[test]
    fn minors_are_trusted_only_far_from_a_singular_geometry() {
        let geometry = |sky: &[(f64, f64)]| {
            let mut geometry = Geometry::default();
            geometry.add(&group(sky));
            geometry
        };
        let cone = [
            (30.0, 0.0),
            (30.0, 72.0),
            (30.0, 144.0),
            (30.0, 216.0),
            (30.0, 288.0),
        ];
        let line = [(30.0, 0.0); 5];
        assert!(geometry(&cone).good_pdop(f64::INFINITY).is_none());
        assert!(geometry(&line).good_pdop(f64::INFINITY).is_none());
        assert!(geometry(&SKY[..3]).good_pdop(f64::INFINITY).is_none());
        let pdop = geometry(&SKY).pdop(100.0).unwrap();
        assert!(geometry(&SKY).good_pdop(pdop * 0.999).is_none());
        assert!(geometry(&SKY).good_pdop(pdop * 1.001).is_some());
    }
}
