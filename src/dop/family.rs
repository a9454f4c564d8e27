//! All DOPs of one geometry: position, its horizontal and vertical parts, and the clocks.
//!
//! Weighted least squares ([M-27](crate::models#m-27)). The position block of the inverse normal
//! matrix is projected on east, north and up, so that the horizontal and vertical parts refer to
//! the local horizon.

use super::{ClockGroup, Geometry};
use crate::frames::LocalFrame;
use crate::keyword::keywords;

keywords! {
    /// How observations are weighted in least squares.
    ObservationWeights {
        /// Equally.
        Unit = "unit",
        /// sin² of the elevation: the standard deviation of an observation is that at the zenith
        /// divided by sin(elevation), as in Dach et al., *Bernese GNSS Software Version 5.2* (2015),
        /// where the weight is written as cos² of the zenith angle.
        SineElevation = "sine-elevation",
    }
}

impl ObservationWeights {
    /// The weight of an observation whose elevation has this sine.
    #[must_use]
    pub fn weight(self, sin_elevation: f64) -> f64 {
        match self {
            Self::Unit => 1.0,
            Self::SineElevation => sin_elevation * sin_elevation,
        }
    }
}

/// The dilutions of precision at one point and instant, dimensionless: standard deviations relative
/// to that of an observation of unit weight.
#[derive(Debug, Clone, PartialEq)]
pub struct DopFamily {
    /// Of position and all clocks.
    pub gdop: f64,
    /// Of position.
    pub pdop: f64,
    /// Of the horizontal position.
    pub hdop: f64,
    /// Of the height.
    pub vdop: f64,
    /// Of each clock, as a length, in the order of the groups; `None` for an empty group, which has
    /// no clock state.
    pub tdop: Vec<Option<f64>>,
}

impl DopFamily {
    /// The dilutions of precision of groups of observations, in the local axes of `site`.
    ///
    /// `None` if unsolved, by the rule of [`Geometry::pdop`].
    #[must_use]
    pub fn of(groups: &[ClockGroup], site: &LocalFrame, cap: f64) -> Option<Self> {
        let mut geometry = Geometry::default();
        groups.iter().for_each(|group| geometry.add(group));
        // The normal matrix is the Schur complement of the clocks: its inverse is the position block
        let solution = geometry.solve(cap)?;
        let variance = |v| solution.factor.inverse_form(v);
        // A clock has the variance 1/W + sᵀ Q s / W², s = Σ w v, W = Σ w
        let clock2 = |group: &ClockGroup| {
            let spread = variance(group.sum) / (group.weight * group.weight);
            (group.count > 0).then(|| 1.0 / group.weight + spread)
        };
        let clocks2: Vec<_> = groups.iter().map(clock2).collect();
        let all_clocks2: f64 = clocks2.iter().flatten().sum();
        let horizontal2 = variance(site.east) + variance(site.north);
        Some(Self {
            gdop: (solution.pdop * solution.pdop + all_clocks2).sqrt(),
            pdop: solution.pdop,
            hdop: horizontal2.sqrt(),
            vdop: variance(site.up).sqrt(),
            tdop: clocks2.into_iter().map(|x| x.map(f64::sqrt)).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::earth::Surface;
    use crate::keyword::Keyword;
    use nalgebra::{DMatrix, Vector3};
    use proptest::prelude::*;

    /// Direction from a site by elevation and azimuth.
    fn direction(site: &LocalFrame, (elevation_deg, azimuth_deg): (f64, f64)) -> Vector3<f64> {
        let (sin_e, cos_e) = elevation_deg.to_radians().sin_cos();
        let (sin_a, cos_a) = azimuth_deg.to_radians().sin_cos();
        (site.east * sin_a + site.north * cos_a) * cos_e + site.up * sin_e
    }

    fn groups(
        site: &LocalFrame,
        sky: &[Vec<(f64, f64)>],
        weights: ObservationWeights,
    ) -> Vec<ClockGroup> {
        let group = |satellites: &Vec<(f64, f64)>| {
            let mut group = ClockGroup::default();
            for &place in satellites {
                let unit = direction(site, place);
                group.add(unit, weights.weight(unit.dot(&site.up)));
            }
            group
        };
        sky.iter().map(group).collect()
    }

    /// (Gᵀ W G)⁻¹ with rows (east, north, up, clock ...) in the local frame,
    /// inverted in full: variances of east, north, up and the clocks in view.
    fn variances_by_inversion(
        sky: &[Vec<(f64, f64)>],
        weights: ObservationWeights,
    ) -> Option<Vec<f64>> {
        let in_view: Vec<_> = sky.iter().filter(|group| !group.is_empty()).collect();
        let states = 3 + in_view.len();
        let mut normal = DMatrix::zeros(states, states);
        for (clock, group) in in_view.iter().enumerate() {
            for &(elevation_deg, azimuth_deg) in group.iter() {
                let (sin_e, cos_e) = elevation_deg.to_radians().sin_cos();
                let (sin_a, cos_a) = azimuth_deg.to_radians().sin_cos();
                let mut row = DMatrix::zeros(1, states);
                row[0] = cos_e * sin_a;
                row[1] = cos_e * cos_a;
                row[2] = sin_e;
                row[3 + clock] = 1.0;
                let weight = match weights {
                    ObservationWeights::Unit => 1.0,
                    ObservationWeights::SineElevation => sin_e * sin_e,
                };
                normal += row.transpose() * row * weight;
            }
        }
        Some(normal.try_inverse()?.diagonal().iter().copied().collect())
    }

    /// One satellite at the zenith and three at the horizon, 120° apart: with
    /// A = diag(3/2, 3/2, 3/4), HDOP² = VDOP² = 4/3, and TDOP² = 1/4 + (1/4)² 4/3 = 1/3.
    #[test]
    fn validate_the_classic_four_satellites() {
        let site = LocalFrame::new(Surface::Wgs84, 0.7, 2.0);
        let sky = [vec![(90.0, 0.0), (0.0, 0.0), (0.0, 120.0), (0.0, 240.0)]];
        let groups = groups(&site, &sky, ObservationWeights::Unit);
        let dops = DopFamily::of(&groups, &site, 100.0).unwrap();
        let third = 1.0_f64 / 3.0;
        for (ours, squared) in [
            (dops.hdop, 4.0 * third),
            (dops.vdop, 4.0 * third),
            (dops.pdop, 8.0 * third),
            (dops.tdop[0].unwrap(), third),
            (dops.gdop, 3.0),
        ] {
            assert!((ours * ours - squared).abs() < 1e-14, "{dops:?}");
        }
    }

    #[test]
    fn unsolved_follows_the_rule_of_pdop() {
        let site = LocalFrame::new(Surface::Sphere, 0.1, 0.0);
        let four = vec![(10.0, 0.0), (40.0, 100.0), (70.0, 200.0), (20.0, 290.0)];
        let of = |sky: &[Vec<(f64, f64)>], cap| {
            DopFamily::of(&groups(&site, sky, ObservationWeights::Unit), &site, cap)
        };
        let solved = of(&[four.clone(), vec![]], 100.0).unwrap();
        assert_eq!(solved.tdop[1], None);
        assert!(solved.tdop[0].is_some());
        assert_eq!(of(std::slice::from_ref(&four), solved.pdop * 0.999), None);
        assert_eq!(of(&[four[..2].to_vec(), four[2..].to_vec()], 100.0), None);
        assert_eq!(of(&[vec![four[0]; 4]], 100.0), None);
        assert_eq!(of(&[], 100.0), None);
    }

    /// A satellite on the horizon has zero weight by the sine of its elevation and does not count.
    #[test]
    fn a_satellite_without_weight_is_not_there() {
        let site = LocalFrame::new(Surface::Sphere, 0.0, 0.0);
        let mut group = ClockGroup::default();
        group.add(site.east, ObservationWeights::SineElevation.weight(0.0));
        assert_eq!(group, ClockGroup::default());
    }

    fn sky(n: std::ops::Range<usize>) -> impl Strategy<Value = Vec<(f64, f64)>> {
        prop::collection::vec((5.0..89.0_f64, 0.0..360.0_f64), n)
    }

    proptest! {
        /// Anywhere on Earth and for either weighting, all DOPs equal those of the full matrix.
        #[test]
        fn validate_the_family_against_inversion(
            a in sky(4..12), b in sky(0..8), c in sky(0..3),
            latitude in -1.5..1.5_f64, longitude in -3.0..3.0_f64, sine in any::<bool>(),
        ) {
            let weights = ObservationWeights::ALL[usize::from(sine)];
            let site = LocalFrame::new(Surface::Wgs84, latitude, longitude);
            let sky = [a, b, c];
            let ours = DopFamily::of(&groups(&site, &sky, weights), &site, 20.0);
            // Above PDOP 20 the inversion itself loses the digits that are compared.
            if let (Some(ours), Some(variances)) = (ours, variances_by_inversion(&sky, weights)) {
                let mut expected = vec![
                    (ours.hdop, variances[0] + variances[1]),
                    (ours.vdop, variances[2]),
                    (ours.pdop, variances[..3].iter().sum()),
                    (ours.gdop, variances.iter().sum()),
                ];
                let clocks = ours.tdop.iter().flatten().copied();
                expected.extend(clocks.zip(variances[3..].iter().copied()));
                prop_assert_eq!(ours.tdop.iter().flatten().count(), variances.len() - 3);
                for (ours, variance) in expected {
                    prop_assert!((ours * ours / variance - 1.0).abs() < 1e-8, "{ours} {variance}");
                }
            }
        }

        #[test]
        fn parts_add_up(a in sky(4..12), b in sky(0..8), latitude in -1.5..1.5_f64) {
            let site = LocalFrame::new(Surface::Wgs84, latitude, 1.0);
            let groups = groups(&site, &[a, b], ObservationWeights::SineElevation);
            if let Some(dops) = DopFamily::of(&groups, &site, 20.0) {
                let clocks: f64 = dops.tdop.iter().flatten().map(|t| t * t).sum();
                let (g2, p2) = (dops.gdop * dops.gdop, dops.pdop * dops.pdop);
                prop_assert!((g2 / (p2 + clocks) - 1.0).abs() < 1e-12);
                let (h2, v2) = (dops.hdop * dops.hdop, dops.vdop * dops.vdop);
                prop_assert!((p2 / (h2 + v2) - 1.0).abs() < 1e-12);
            }
        }

        /// With unit weights, PDOP equals that of the evaluator.
        #[test]
        fn unit_weights_are_the_geometry_of_the_evaluator(a in sky(4..12), b in sky(0..8)) {
            let site = LocalFrame::new(Surface::Wgs84, 0.5, 1.0);
            let sky = [a, b];
            let family = DopFamily::of(&groups(&site, &sky, ObservationWeights::Unit), &site, 20.0);
            let mut geometry = Geometry::default();
            for satellites in &sky {
                let mut group = ClockGroup::default();
                satellites.iter().for_each(|&place| group.add(direction(&site, place), 1.0));
                geometry.add(&group);
            }
            let pdop = geometry.pdop(20.0);
            prop_assert_eq!(family.is_some(), pdop.is_some());
            if let (Some(family), Some(pdop)) = (family, pdop) {
                prop_assert!((family.pdop / pdop - 1.0).abs() < 1e-12);
            }
        }
    }
}
