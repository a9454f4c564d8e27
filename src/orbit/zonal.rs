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

    /// Of the argument of latitude, rad/s.
    #[must_use]
    pub fn arg_latitude_rad_s(&self) -> f64 {
        self.arg_perigee_rad_s + self.mean_anomaly_rad_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::earth::MU_KM3_S2;
    use crate::orbit::Propagator;
    use crate::orbit::sgp4::{MeanMotionSlot, Sgp4Orbit, Sgp4Theory};
    use crate::time::Epoch;
    use crate::units::{SECONDS_PER_DAY, wrap_pi};
    use nalgebra::Vector3;

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

    /// SGP4's angles advance by the same rates; its other terms average out over 20 days. Eccentric orbits test what the
    /// integrations leave out.
    #[test]
    fn validate_zonal_rates_against_sgp4() {
        let theory = Sgp4Theory {
            geopotential: sgp4::Geopotential {
                j3: 0.0,
                j4: J4,
                ..Sgp4Theory::with_design_constants().geopotential
            },
            ..Sgp4Theory::STANDARD
        };
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        for (eccentricity, inclination_deg) in [(0.05, 40.0), (0.1, 70.0), (0.2, 98.0)] {
            let mean = elements(
                1500.0 + 6000.0 * eccentricity,
                eccentricity,
                inclination_deg,
            );
            let slot = MeanMotionSlot::Kozai;
            let orbit = Sgp4Orbit::from_mean_elements_with(&mean, epoch, slot, theory).unwrap();
            let [node, perigee] = fitted_rates(&orbit);
            let zonal = SecularRates::zonal(&mean);
            let first_order = SecularRates::j2(&mean);
            for (found, expected, without) in [
                (node, zonal.raan_rad_s, first_order.raan_rad_s),
                (
                    perigee,
                    zonal.arg_perigee_rad_s,
                    first_order.arg_perigee_rad_s,
                ),
            ] {
                // Kozai's mean motion is that of the elements to J2², some 1e-6, and with it the rates to some 3e-6; terms with the
                // period of the perigee leave some 1e-5. What first order leaves out is 1e-3.
                let off = found / expected - 1.0;
                assert!(off.abs() < 5e-5, "{eccentricity}: {off}");
                let left_out = without / expected - 1.0;
                assert!(left_out.abs() > 2e-4, "{eccentricity}: {left_out}");
            }
        }
    }

    /// Slopes of lines through the node and the argument of perigee over 20 days, rad/s.
    fn fitted_rates(orbit: &Sgp4Orbit) -> [f64; 2] {
        let times: Vec<f64> = (0..14_400).map(|n| f64::from(n) * 120.0).collect();
        let mut angles: [Vec<f64>; 2] = [Vec::new(), Vec::new()];
        for time in &times {
            let state = orbit.state_at(*time).unwrap();
            let (r, v) = (state.position_km.km(), state.velocity_km_s);
            let normal = r.cross(&v);
            let towards_node = Vector3::new(-normal.y, normal.x, 0.0).normalize();
            let towards_perigee = v.cross(&normal) / MU_KM3_S2 - r.normalize();
            let across = normal.normalize().cross(&towards_node);
            let perigee = towards_perigee
                .dot(&across)
                .atan2(towards_perigee.dot(&towards_node));
            angles[0].push(towards_node.y.atan2(towards_node.x));
            angles[1].push(perigee);
        }
        angles.map(|of| slope(&times, &of))
    }

    fn slope(times: &[f64], angles: &[f64]) -> f64 {
        let middle = times.iter().sum::<f64>() / times.len() as f64;
        let mut unwrapped = angles[0];
        let (mut xy, mut xx) = (0.0, 0.0);
        for (n, time) in times.iter().enumerate() {
            unwrapped += wrap_pi(angles[n] - unwrapped);
            xy += (time - middle) * unwrapped;
            xx += (time - middle).powi(2);
        }
        xy / xx
    }
}
