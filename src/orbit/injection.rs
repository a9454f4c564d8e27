//! How errors of injection spread satellites over their slots.

use super::MeanElements;
use super::j2::SecularRates;
use crate::earth::MU_KM3_S2;

/// How much faster angles advance for an error of the semi-major axis and one of the inclination, both one sigma and independent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InjectionSpread {
    /// One sigma of the rate of the argument of latitude, rad/s.
    pub arg_latitude_rad_s: f64,
    /// One sigma of the rate of the node, rad/s.
    pub raan_rad_s: f64,
    /// What correcting one sigma of the semi-major axis takes, m/s.
    pub semi_major_axis_m_s: f64,
    /// What correcting one sigma of the inclination takes, m/s.
    pub inclination_m_s: f64,
}

impl InjectionSpread {
    /// For errors of `sigma_a_km` and `sigma_i_rad` ([M-70](crate::models#m-70)).
    #[must_use]
    pub fn of(elements: &MeanElements, sigma_a_km: f64, sigma_i_rad: f64) -> Self {
        let a_km = elements.semi_major_axis_km;
        // Steps whose square and rounding are both below 1e-7 of the slope.
        let by_a = slopes(elements, 0.1, |of, step| of.semi_major_axis_km += step);
        let by_i = slopes(elements, 1e-5, |of, step| of.inclination_rad += step);
        let sigma = |n: usize| (by_a[n] * sigma_a_km).hypot(by_i[n] * sigma_i_rad);
        let speed_m_s = (MU_KM3_S2 / a_km).sqrt() * 1e3;
        Self {
            arg_latitude_rad_s: sigma(0),
            raan_rad_s: sigma(1),
            semi_major_axis_m_s: speed_m_s * sigma_a_km / (2.0 * a_km),
            inclination_m_s: speed_m_s * sigma_i_rad,
        }
    }
}

/// Derivatives of the rates of the argument of latitude and of the node.
fn slopes(elements: &MeanElements, step: f64, moved: impl Fn(&mut MeanElements, f64)) -> [f64; 2] {
    let [ahead, behind] = [step, -step].map(|step| {
        let mut at = *elements;
        moved(&mut at, step);
        let rates = SecularRates::j2(&at);
        [rates.arg_latitude_rad_s(), rates.raan_rad_s]
    });
    [0, 1].map(|n| (ahead[n] - behind[n]) / (2.0 * step))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::earth::RADIUS_KM;
    use crate::units::SECONDS_PER_DAY;

    fn spread(sigma_a_km: f64, sigma_i_deg: f64) -> InjectionSpread {
        let elements = MeanElements {
            semi_major_axis_km: RADIUS_KM + 925.0,
            eccentricity: 0.0,
            inclination_rad: 55_f64.to_radians(),
            raan_rad: 0.0,
            arg_perigee_rad: 0.0,
            mean_anomaly_rad: 0.0,
        };
        InjectionSpread::of(&elements, sigma_a_km, sigma_i_deg.to_radians())
    }

    /// A kilometre of the semi-major axis is 1.03° a day of phase at 925 km, -3/2 n/a to 1e-3; the node goes with -7/2 dΩ/dt/a.
    #[test]
    fn validate_the_drift_of_a_kilometre() {
        let of = spread(1.0, 0.0);
        let phase = of.arg_latitude_rad_s.to_degrees() * SECONDS_PER_DAY;
        // Two digits are known; J2's own part is 1e-3 of it.
        assert!((phase - 1.03).abs() < 5e-3, "{phase}");
        let node = of.raan_rad_s.to_degrees() * SECONDS_PER_DAY;
        // 3.557 72° a day at this orbit, by 3.5/7303.137 for each kilometre; the step's cube is left.
        assert!((node - 3.5 * 3.557_715 / 7303.137).abs() < 1e-8, "{node}");
        // v/(2a) = n/2: 0.506 m/s for a kilometre with a period of 103.52 minutes.
        let expected = std::f64::consts::TAU / (103.5199 * 60.0) / 2.0 * 1e3;
        assert!((of.semi_major_axis_m_s - expected).abs() < 1e-5);
    }

    /// dΩ/dt is proportional to cos i, so it changes by -tan i of itself for a radian.
    #[test]
    fn validate_the_drift_of_a_degree() {
        let of = spread(0.0, 1.0);
        let node = of.raan_rad_s.to_degrees() * SECONDS_PER_DAY;
        let expected = 3.557_715 * 55_f64.to_radians().tan() * 1_f64.to_radians();
        assert!((node - expected).abs() < 1e-7, "{node} {expected}");
        assert!((of.inclination_m_s - 7387.8 * 1_f64.to_radians()).abs() < 0.01);
        let both = spread(1.0, 1.0);
        let squares = spread(1.0, 0.0).raan_rad_s.powi(2) + of.raan_rad_s.powi(2);
        assert!((both.raan_rad_s.powi(2) / squares - 1.0).abs() < 1e-12);
    }
}
