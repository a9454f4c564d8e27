//! The orbit of an almanac: the user algorithm of IS-GPS-200, table 20-IV, with the almanac's subset of parameters.

use super::{Almanac, Applicability, WEEKS};
use crate::earth::{GPS_EARTH_RATE_RAD_S, GPS_MU_M3_S2};
use crate::formats::text::finding::FindingList;
use crate::frames::{EarthFixed, EarthRotation, OrbitPlane, Position, State, Teme};
use crate::orbit::earth_orbit::check_position;
use crate::orbit::kepler::eccentric_anomaly;
use crate::orbit::{PropagationError, Propagator};
use crate::time::Epoch;
use crate::units::wrap_two_pi;
use nalgebra::Vector3;

impl Almanac {
    /// The name of the satellite: `PRN-01`, as in the header of its block.
    #[must_use]
    pub fn name(&self) -> String {
        format!("PRN-{:02}", self.prn)
    }

    /// Whether the satellite may be used.
    #[must_use]
    pub fn is_healthy(&self) -> bool {
        self.health == 0
    }

    /// The instant of the elements: ten-bit weeks are resolved to the nearest `near`, larger ones are used unchanged.
    #[must_use]
    pub fn applicability(&self, near: Epoch) -> Epoch {
        let of = |week: i64| {
            let start = Applicability { week, toa_s: 0.0 };
            start.epoch().plus_seconds(self.toa_s)
        };
        let week = i64::from(self.week);
        if week >= WEEKS {
            return of(week);
        }
        let apart_s = |at: &Epoch| at.seconds_since(near).abs();
        let candidates = (0..8).map(|turn| of(week + turn * WEEKS));
        let nearest = candidates.min_by(|a, b| apart_s(a).total_cmp(&apart_s(b)));
        nearest.unwrap_or_else(|| of(week))
    }

    /// Reports values out of range, and repeated satellites.
    pub(crate) fn check(&self, place: (usize, usize), before: &[Self], findings: &mut FindingList) {
        let name = self.name();
        if before.iter().any(|other| other.prn == self.prn) {
            let message = format!("{name} is given twice");
            findings.error(place, "almanac-repeated", message);
        }
        for (fits, value, range) in [
            (
                (1..=999).contains(&self.prn),
                f64::from(self.prn),
                "number is outside 1 to 999",
            ),
            (
                (0.0..1.0).contains(&self.eccentricity),
                self.eccentricity,
                "eccentricity is outside 0 to 1 (exclusive)",
            ),
            (
                (0.0..=604_800.0).contains(&self.toa_s),
                self.toa_s,
                "time of applicability is outside 0 to 604800 s",
            ),
            (
                self.inclination_rad.abs() <= std::f64::consts::PI,
                self.inclination_rad,
                "inclination is outside 0 to pi rad",
            ),
            (
                self.week <= 9_999,
                f64::from(self.week),
                "week is outside 0 to 9999",
            ),
        ] {
            if !fits {
                let message = format!("{name}: {value}: the {range}");
                findings.error(place, "almanac-range", message);
            }
        }
        let a_km = self.sqrt_a * self.sqrt_a / 1000.0;
        for radius_km in [1.0 - self.eccentricity, 1.0 + self.eccentricity].map(|x| x * a_km) {
            if let Err(fault) = check_position(&Vector3::new(radius_km, 0.0, 0.0)) {
                let message = format!("{name}: by SQRT(A), {fault}");
                findings.error(place, "implausible-state", message);
                break;
            }
        }
        if !self.is_healthy() {
            findings.pass_over("unhealthy satellite", &name);
        }
    }

    /// The position at a time after the time of applicability.
    #[must_use]
    pub fn position_km(&self, since_toa_s: f64) -> Position<EarthFixed> {
        self.state(since_toa_s).position_km
    }

    /// The Earth-fixed state at a time after the time of applicability.
    #[must_use]
    pub fn state(&self, since_toa_s: f64) -> State<EarthFixed> {
        let e = self.eccentricity;
        let a_km = self.sqrt_a * self.sqrt_a / 1000.0;
        let n = (GPS_MU_M3_S2 / self.sqrt_a.powi(6)).sqrt();
        let anomaly = eccentric_anomaly(self.mean_anomaly_rad + n * since_toa_s, e);
        let (sin, cos) = anomaly.sin_cos();
        let root = (1.0 - e * e).sqrt();
        let u = (root * sin).atan2(cos - e) + self.arg_perigee_rad;
        let radius_km = a_km * (1.0 - e * cos);
        let anomaly_rate = n / (1.0 - e * cos);
        let radial_km_s = a_km * e * sin * anomaly_rate;
        let u_rate = root * anomaly_rate / (1.0 - e * cos);
        let node_rate = self.raan_rate_rad_s - GPS_EARTH_RATE_RAD_S;
        let node =
            self.raan_at_week_rad + node_rate * since_toa_s - GPS_EARTH_RATE_RAD_S * self.toa_s;
        let plane = OrbitPlane::new(wrap_two_pi(node), self.inclination_rad);
        let (along, across) = (
            plane.vector(u.cos(), u.sin()),
            plane.vector(-u.sin(), u.cos()),
        );
        let position_km = along * radius_km;
        let turning = Vector3::new(0.0, 0.0, node_rate).cross(&position_km);
        State::new(
            position_km,
            along * radial_km_s + across * (radius_km * u_rate) + turning,
        )
    }
}

/// The orbit of an almanac, with time counted from the epoch of a study.
#[derive(Debug, Clone)]
pub struct AlmanacOrbit {
    almanac: Almanac,
    epoch: Epoch,
    /// Seconds from the time of applicability to the epoch.
    ahead_s: f64,
}

impl AlmanacOrbit {
    /// The orbit of a study that starts at `epoch`.
    #[must_use]
    pub fn new(almanac: Almanac, epoch: Epoch) -> Self {
        Self {
            almanac,
            epoch,
            ahead_s: epoch.seconds_since(almanac.applicability(epoch)),
        }
    }
}

impl Propagator for AlmanacOrbit {
    fn state_at(&self, elapsed_s: f64) -> Result<State<Teme>, PropagationError> {
        let fixed = self.almanac.state(self.ahead_s + elapsed_s);
        let rotation = EarthRotation::from_gmst(self.epoch.gmst_rad(elapsed_s));
        Ok(rotation.state_to_teme(fixed))
    }
}
