//! J2 with first-order short-period terms: mean elements in, osculating TEME states out.
//!
//! The mean elements advance as in [`super::j2`]; the periodic part of Brouwer's first-order
//! theory (*Astron. J.* 64 (1959) 378) is added in polar-nodal variables: radius r, argument of
//! latitude θ, node Ω and angular momentum G (Izsak, *SAO Special Report* 129 (1963); Aksnes,
//! *Astrophys. Norv.* 10 (1965) 69). The corrections are the Poisson brackets of the variables
//! with Brouwer's generating function
//!
//! ```text
//! W = ε G { (3/2 s² - 1)(f - M + σ) - 3/4 s² [(1 + 4/3 κ) sin 2θ - 2/3 σ cos 2θ] }
//! ε = J2 R² / (2 p²),  s = sin i,  c = cos i,  κ = e cos f = p/r - 1,  σ = e sin f
//! ```
//!
//! and contain neither 1/e nor 1/sin i, so circular and equatorial orbits are not special
//! cases (the aim of Lyddane, *Astron. J.* 68 (1963) 555). For e = 0 they are the short-period
//! terms of SGP4. There are no long-period terms: those of J2 are of order e J2 and singular at
//! the critical inclination. The neglected terms are of second order: some metres in position
//! immediately and, through the mean motion, some 100 m a day in-track.

use super::j2::{SecularOrbit, SecularRates};
use super::kepler::eccentric_anomaly;
use super::{MeanElements, PropagationError, Propagator};
use crate::earth::{J2, J3, RADIUS_KM};
use crate::frames::{OrbitPlane, State, Teme};
use nalgebra::Vector3;

/// A satellite whose mean elements advance under secular J2 and whose states osculate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OsculatingOrbit {
    secular: SecularOrbit,
    terms: ShortPeriod,
}

impl OsculatingOrbit {
    /// Propagates mean `elements` under J2.
    #[must_use]
    pub fn new(elements: &MeanElements) -> Self {
        Self {
            secular: SecularOrbit::j2(elements),
            terms: ShortPeriod::new(elements),
        }
    }

    /// The TEME state `elapsed_s` seconds after the epoch; defined for every instant.
    ///
    /// The velocity is the time derivative of the position.
    #[must_use]
    pub fn state(&self, elapsed_s: f64) -> State<Teme> {
        let mean = self.secular.elements_at(elapsed_s);
        let rates = self.secular.rates();
        let place = EllipsePosition::new(&mean, &rates, self.terms.eta);
        let polar = self.terms.osculating(&mean, &rates, &place);
        polar.state()
    }
}

impl Propagator for OsculatingOrbit {
    fn state_at(&self, elapsed_s: f64) -> Result<State<Teme>, PropagationError> {
        Ok(self.state(elapsed_s))
    }
}

/// Part of the osculating radius that does not depend on the argument of latitude, minus that of
/// the mean ellipse, km ([M-15](crate::models#m-15)): ¾ J2 (R²/a)(1 - 3 cos² i) for e = 0.
///
/// For e > 0 the mean over time of the terms without θ in [M-12](crate::models#m-12), from the
/// means r̄ = a (1 + e²/2) and -e² of κ.
#[must_use]
pub fn radius_shift_km(elements: &MeanElements) -> f64 {
    let e2 = elements.eccentricity * elements.eccentricity;
    let eta = (1.0 - e2).sqrt();
    let parameter_km = elements.semi_major_axis_km * eta * eta;
    let cos_i = elements.inclination_rad.cos();
    // 3/2 s² - 1 = (1 - 3 c²)/2
    let zonal = 0.5 * (1.0 - 3.0 * cos_i * cos_i);
    0.5 * J2 * RADIUS_KM * RADIUS_KM / parameter_km * zonal * (eta + (2.0 + e2) / eta)
}

/// Eccentricity maintained by J3 at ω = 90°, to first order: |J3 / (2 J2)| (R/a) sin i
/// ([M-16](crate::models#m-16)).
///
/// Source: Cook, *Planet. Space Sci.* 14 (1966) 433, without the harmonics above J3. Not valid
/// within about a degree of the critical inclinations, 63.4° and 116.6°.
#[must_use]
pub fn frozen_eccentricity(elements: &MeanElements) -> f64 {
    let scale = (J3 / (2.0 * J2)).abs() * RADIUS_KM / elements.semi_major_axis_km;
    scale * elements.inclination_rad.sin()
}

/// The satellite's position on its mean ellipse, with rates per second.
struct EllipsePosition {
    /// e cos f.
    kappa: f64,
    /// e sin f.
    sigma: f64,
    /// Equation of the centre f - M, radians.
    centre: f64,
    /// Argument of latitude ω + f, radians.
    argument: f64,
    /// Rate of the true anomaly, rad/s.
    anomaly_rate: f64,
    /// Rate of the equation of the centre, rad/s.
    centre_rate: f64,
    /// Rate of the argument of latitude, rad/s.
    argument_rate: f64,
}

impl EllipsePosition {
    fn new(mean: &MeanElements, rates: &SecularRates, eta: f64) -> Self {
        let e = mean.eccentricity;
        let (sin_e, cos_e) = eccentric_anomaly(mean.mean_anomaly_rad, e).sin_cos();
        let range = 1.0 - e * cos_e;
        let kappa = e * (cos_e - e) / range;
        // f - M = (f - E) + (E - M), tan((f - E)/2) = e sin E / (1 + η - e cos E)
        let centre = 2.0 * (e * sin_e).atan2(1.0 + eta - e * cos_e) + e * sin_e;
        let anomaly_rate = rates.mean_anomaly_rad_s * (1.0 + kappa).powi(2) / eta.powi(3);
        Self {
            kappa,
            sigma: e * eta * sin_e / range,
            centre,
            argument: mean.arg_perigee_rad + mean.mean_anomaly_rad + centre,
            anomaly_rate,
            centre_rate: anomaly_rate - rates.mean_anomaly_rad_s,
            argument_rate: anomaly_rate + rates.arg_perigee_rad_s,
        }
    }
}

/// A value and its rate per second.
#[derive(Clone, Copy)]
struct Moving {
    value: f64,
    rate: f64,
}

/// Osculating polar-nodal variables.
struct Polar {
    radius_km: Moving,
    argument_rad: Moving,
    node_rad: Moving,
    inclination_rad: Moving,
}

impl Polar {
    fn state(&self) -> State<Teme> {
        let plane = OrbitPlane::new(self.node_rad.value, self.inclination_rad.value);
        let (sin, cos) = self.argument_rad.value.sin_cos();
        let radial = plane.vector(cos, sin);
        let along = plane.vector(-sin, cos);
        let normal = plane.node.cross(&plane.ahead);
        let position_km = radial * self.radius_km.value;
        // The node rotates the plane about the pole, the inclination about the node.
        let turning = along * self.argument_rad.rate
            + Vector3::z().cross(&radial) * self.node_rad.rate
            + normal * (sin * self.inclination_rad.rate);
        let velocity_km_s = radial * self.radius_km.rate + turning * self.radius_km.value;
        State::new(position_km, velocity_km_s)
    }
}

/// Quantities shared by the short-period terms of one orbit.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ShortPeriod {
    /// p = a (1 - e²), km.
    parameter_km: f64,
    /// sqrt(1 - e²).
    eta: f64,
    /// ε = J2 R² / (2 p²).
    epsilon: f64,
    sin_i: f64,
    cos_i: f64,
}

impl ShortPeriod {
    fn new(elements: &MeanElements) -> Self {
        let eta2 = 1.0 - elements.eccentricity * elements.eccentricity;
        let parameter_km = elements.semi_major_axis_km * eta2;
        let (sin_i, cos_i) = elements.inclination_rad.sin_cos();
        Self {
            parameter_km,
            eta: eta2.sqrt(),
            epsilon: 0.5 * J2 * (RADIUS_KM / parameter_km).powi(2),
            sin_i,
            cos_i,
        }
    }

    fn osculating(
        &self,
        mean: &MeanElements,
        rates: &SecularRates,
        place: &EllipsePosition,
    ) -> Polar {
        let double = DoubleArgument::new(place);
        let argument = self.argument(place, &double);
        let node = self.node(place, &double);
        Polar {
            radius_km: self.radius_km(place, &double),
            argument_rad: Moving {
                value: place.argument + argument.value,
                rate: place.argument_rate + argument.rate,
            },
            node_rad: Moving {
                value: mean.raan_rad + node.value,
                rate: rates.raan_rad_s + node.rate,
            },
            inclination_rad: self.inclination(place, &double),
        }
    }

    /// r + Δr ([M-12](crate::models#m-12)), Δr = ∂W/∂ṙ.
    fn radius_km(&self, place: &EllipsePosition, double: &DoubleArgument) -> Moving {
        let (eta, s2) = (self.eta, self.sin_i * self.sin_i);
        let zonal = 1.5 * s2 - 1.0;
        let conic = 1.0 + place.kappa;
        // Δr = ε p {(3/2 s² - 1)(1 + 2η/(1 + κ) + κ/(1 + η)) + ½ s² cos 2θ}
        let even = 1.0 + 2.0 * eta / conic + place.kappa / (1.0 + eta);
        let even_rate = double.kappa_rate * (1.0 / (1.0 + eta) - 2.0 * eta / (conic * conic));
        let scale = self.epsilon * self.parameter_km;
        Moving {
            value: self.parameter_km / conic + scale * (zonal * even + 0.5 * s2 * double.cos),
            rate: -self.parameter_km * double.kappa_rate / (conic * conic)
                + scale * (zonal * even_rate + 0.5 * s2 * double.cos_rate),
        }
    }

    /// Δθ = ∂W/∂G ([M-13](crate::models#m-13)).
    fn argument(&self, place: &EllipsePosition, double: &DoubleArgument) -> Moving {
        let (s2, c2) = (self.sin_i * self.sin_i, self.cos_i * self.cos_i);
        let one_eta = 1.0 + self.eta;
        let zonal = 1.5 * s2 - 1.0;
        let (kappa, sigma) = (place.kappa, place.sigma);
        // Δθ = ε {3/2 (4 - 5 s²)(f - M) + [3 c² - (3/2 s² - 1)(2 + (2 + κ)/(1 + η))] σ
        //         + [¼ s² - 3/2 c² + (s² - 2 c²) κ] sin 2θ + (c² - s²) σ cos 2θ}
        let centre = 1.5 * (4.0 - 5.0 * s2);
        let odd = 3.0 * c2 - zonal * (2.0 + (2.0 + kappa) / one_eta);
        let odd_rate = -zonal * double.kappa_rate / one_eta;
        let sine = 0.25 * s2 - 1.5 * c2 + (s2 - 2.0 * c2) * kappa;
        let sine_rate = (s2 - 2.0 * c2) * double.kappa_rate;
        let cosine = c2 - s2;
        let value =
            centre * place.centre + odd * sigma + sine * double.sin + cosine * sigma * double.cos;
        let rate = centre * place.centre_rate
            + odd * double.sigma_rate
            + odd_rate * sigma
            + sine * double.sin_rate
            + sine_rate * double.sin
            + cosine * (sigma * double.cos_rate + double.sigma_rate * double.cos);
        Moving {
            value: self.epsilon * value,
            rate: self.epsilon * rate,
        }
    }

    /// ΔΩ = ∂W/∂H, H = G cos i ([M-14](crate::models#m-14)).
    fn node(&self, place: &EllipsePosition, double: &DoubleArgument) -> Moving {
        // ΔΩ = -ε c {3 (f - M + σ) - (3/2 + 2κ) sin 2θ + σ cos 2θ}
        let sine = 1.5 + 2.0 * place.kappa;
        let value =
            3.0 * (place.centre + place.sigma) - sine * double.sin + place.sigma * double.cos;
        let rate = 3.0 * (place.centre_rate + double.sigma_rate)
            - sine * double.sin_rate
            - 2.0 * double.kappa_rate * double.sin
            + place.sigma * double.cos_rate
            + double.sigma_rate * double.cos;
        Moving {
            value: -self.epsilon * self.cos_i * value,
            rate: -self.epsilon * self.cos_i * rate,
        }
    }

    /// i from G + ΔG, ΔG = -∂W/∂θ, and G cos i, which is constant ([M-14](crate::models#m-14)).
    fn inclination(&self, place: &EllipsePosition, double: &DoubleArgument) -> Moving {
        let s2 = self.sin_i * self.sin_i;
        // ΔG/G = s² y, y = ε {(3/2 + 2κ) cos 2θ + σ sin 2θ}
        let cosine = 1.5 + 2.0 * place.kappa;
        let y = self.epsilon * (cosine * double.cos + place.sigma * double.sin);
        let y_rate = self.epsilon
            * (cosine * double.cos_rate
                + 2.0 * double.kappa_rate * double.cos
                + place.sigma * double.sin_rate
                + double.sigma_rate * double.sin);
        // cos i' = c / (1 + s² y); the sine with its factor s taken out keeps i = 0 regular
        let growth = 1.0 + s2 * y;
        let root = (1.0 + 2.0 * y + s2 * y * y).sqrt();
        Moving {
            value: (self.sin_i * root).atan2(self.cos_i),
            rate: self.cos_i * self.sin_i * y_rate / (growth * root),
        }
    }
}

/// Functions of the position that all terms use, with rates per second.
struct DoubleArgument {
    /// sin 2θ.
    sin: f64,
    /// cos 2θ.
    cos: f64,
    sin_rate: f64,
    cos_rate: f64,
    /// Of e cos f.
    kappa_rate: f64,
    /// Of e sin f.
    sigma_rate: f64,
}

impl DoubleArgument {
    fn new(place: &EllipsePosition) -> Self {
        let (sin, cos) = (2.0 * place.argument).sin_cos();
        Self {
            sin,
            cos,
            sin_rate: 2.0 * cos * place.argument_rate,
            cos_rate: -2.0 * sin * place.argument_rate,
            kappa_rate: -place.sigma * place.anomaly_rate,
            sigma_rate: place.kappa * place.anomaly_rate,
        }
    }
}

#[cfg(test)]
mod tests;
