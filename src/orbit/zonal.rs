//! Secular rates with J2² and J4: what first-order J2 is off by over years.

use super::MeanElements;
use super::j2::SecularRates;
use crate::earth::{J2, J4, RADIUS_KM};

impl SecularRates {
    /// The secular rates of J2, J2² and J4 ([M-67](crate::models#m-67)): Brouwer, *Astron. J.* 64 (1959) 378, section 5, from
    /// his mean elements. J3 has none, and those of J6 and above are some hundredths of J4's.
    #[must_use]
    pub fn zonal(elements: &MeanElements) -> Self {
        let n = elements.kepler_mean_motion_rad_s();
        let e2 = elements.eccentricity * elements.eccentricity;
        let eta2 = 1.0 - e2;
        let eta = eta2.sqrt();
        let cos_i = elements.inclination_rad.cos();
        let c2 = cos_i * cos_i;
        let c4 = c2 * c2;
        let ratio2 = (RADIUS_KM / (elements.semi_major_axis_km * eta2)).powi(2);
        // Brouwer's γ'₂ and γ'₄.
        let g2 = J2 / 2.0 * ratio2;
        let g4 = -3.0 / 8.0 * J4 * ratio2 * ratio2;
        let squared = 3.0 / 32.0 * g2 * g2;
        let mean_anomaly = 1.5 * g2 * eta * (3.0 * c2 - 1.0)
            + squared
                * eta
                * (-15.0
                    + 16.0 * eta
                    + 25.0 * eta2
                    + (30.0 - 96.0 * eta - 90.0 * eta2) * c2
                    + (105.0 + 144.0 * eta + 25.0 * eta2) * c4)
            + 15.0 / 16.0 * g4 * eta * e2 * (3.0 - 30.0 * c2 + 35.0 * c4);
        let arg_perigee = 1.5 * g2 * (5.0 * c2 - 1.0)
            + squared
                * (-35.0
                    + 24.0 * eta
                    + 25.0 * eta2
                    + (90.0 - 192.0 * eta - 126.0 * eta2) * c2
                    + (385.0 + 360.0 * eta + 45.0 * eta2) * c4)
            + 5.0 / 16.0
                * g4
                * (21.0 - 9.0 * eta2 + (-270.0 + 126.0 * eta2) * c2 + (385.0 - 189.0 * eta2) * c4);
        let raan = -3.0 * g2 * cos_i
            + 4.0
                * squared
                * cos_i
                * (-5.0 + 12.0 * eta + 9.0 * eta2 - (35.0 + 36.0 * eta + 5.0 * eta2) * c2)
            + 1.25 * g4 * (5.0 - 3.0 * eta2) * cos_i * (3.0 - 7.0 * c2);
        Self {
            raan_rad_s: n * raan,
            arg_perigee_rad_s: n * arg_perigee,
            mean_anomaly_rad_s: n * (1.0 + mean_anomaly),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::SECONDS_PER_DAY;

    fn elements(altitude_km: f64, eccentricity: f64, inclination_deg: f64) -> MeanElements {
        MeanElements {
            semi_major_axis_km: RADIUS_KM + altitude_km,
            eccentricity,
            inclination_rad: inclination_deg.to_radians(),
            raan_rad: 0.0,
            arg_perigee_rad: 0.0,
            mean_anomaly_rad: 0.0,
        }
    }

    /// Altitude, km, inclination, degrees, and the rate of the node under J2 to J4 integrated by brahe 1.8.0 over 30 days, deg/day
    /// (`validation/external/make_zonal_rates.py`).
    const INTEGRATED: [(f64, f64, f64); 4] = [
        (925.0, 40.0, -4.762_345_3),
        (925.0, 55.0, -3.557_582_3),
        (600.0, 70.0, -2.482_609_5),
        (500.0, 97.0, 0.929_450_0),
    ];

    #[test]
    fn validate_zonal_rates_by_integration() {
        for (altitude_km, inclination_deg, expected) in INTEGRATED {
            let mean = elements(altitude_km, 0.0, inclination_deg);
            let of = |rates: SecularRates| rates.raan_rad_s.to_degrees() * SECONDS_PER_DAY;
            // The starts are good to some 20 m of the semi-major axis, 1e-5 of the rate.
            let off = of(SecularRates::zonal(&mean)) / expected - 1.0;
            assert!(off.abs() < 2e-5, "{inclination_deg}: {off}");
            // At 55° the parts of J2² and J4 are equal and opposite.
            let left_out = of(SecularRates::j2(&mean)) / expected - 1.0;
            let cancels = inclination_deg == 55.0;
            assert_eq!(
                left_out.abs() < 1e-3,
                cancels,
                "{inclination_deg}: {left_out}"
            );
        }
    }

    /// Semi-major axis, km, eccentricity and inclination, degrees, of SGP4, and its rates of the node, the argument of perigee and the mean
    /// anomaly, rad/s: `a`, `nodedot`, `argpdot` and `mdot` of the PyPI package sgp4 2.27 with the constants of WGS-84.
    const SGP4: [([f64; 3], [f64; 3]); 3] = [
        (
            [8_180.193_190_904_392, 0.05, 40.0],
            [
                -6.497_851_167_846e-7,
                8.198_412_613_131e-7,
                8.536_646_939_983e-4,
            ],
        ),
        (
            [8_476.426_183_622_134, 0.1, 70.0],
            [
                -2.591_996_384_647e-7,
                -1.576_481_843_081e-7,
                8.087_572_904_161e-4,
            ],
        ),
        (
            [9_075.708_883_775_365, 0.2, 98.0],
            [
                8.826_919_832_373e-8,
                -2.865_448_058_758e-7,
                7.299_174_169_868e-4,
            ],
        ),
    ];

    #[test]
    fn validate_zonal_rates_against_sgp4() {
        for ([semi_major_axis_km, eccentricity, inclination_deg], expected) in SGP4 {
            let altitude_km = semi_major_axis_km - RADIUS_KM;
            let mean = elements(altitude_km, eccentricity, inclination_deg);
            let zonal = SecularRates::zonal(&mean);
            let first_order = SecularRates::j2(&mean);
            // Its terms of the second order, 2e-3 of the first, are those of e = 0; WGS-84 has another J4 by 0.5 %, 3e-6 of the rates.
            let tolerance = 5e-6 + 2.5e-3 * eccentricity * eccentricity;
            for (found, without, expected) in [
                (zonal.raan_rad_s, first_order.raan_rad_s, expected[0]),
                (
                    zonal.arg_perigee_rad_s,
                    first_order.arg_perigee_rad_s,
                    expected[1],
                ),
            ] {
                let off = found / expected - 1.0;
                assert!(off.abs() < tolerance, "{eccentricity}: {off}");
                let left_out = without / expected - 1.0;
                assert!(
                    left_out.abs() > 5.0 * tolerance,
                    "{eccentricity}: {left_out}"
                );
            }
            // SGP4's μ is larger by 1.46e-7, so that its mean motion is by 7.3e-8; the terms of the second order are some 1e-6.
            let off = zonal.mean_anomaly_rad_s / expected[2] - 1.0;
            assert!((off + 7.3e-8).abs() < 1e-8, "{eccentricity}: {off}");
        }
    }
}
