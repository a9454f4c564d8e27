//! Osculating elements of a state.

use crate::frames::State;
use crate::units::wrap_360;
use nalgebra::Vector3;

/// Eccentricity below which a state in doubles has no perigee: angles count from the node then.
const CIRCULAR: f64 = 1e-11;

/// Sine of the inclination below which there is no node: the node is the x axis then.
const EQUATORIAL: f64 = 1e-11;

/// Osculating Keplerian elements, degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Keplerian {
    /// Semi-major axis, km.
    pub semi_major_axis_km: f64,
    /// Eccentricity.
    pub eccentricity: f64,
    /// Inclination.
    pub inclination_deg: f64,
    /// Right ascension of the ascending node.
    pub raan_deg: f64,
    /// Argument of perigee.
    pub arg_perigee_deg: f64,
    /// True anomaly.
    pub true_anomaly_deg: f64,
    /// Gravitational parameter, km³/s².
    pub gm_km3_s2: f64,
}

impl Keplerian {
    /// The elements of a bound state; none for one that is not on an ellipse.
    ///
    /// D. Vallado, *Fundamentals of Astrodynamics and Applications*, algorithm RV2COE.
    #[must_use]
    pub fn of_state<F>(state: &State<F>, gm_km3_s2: f64) -> Option<Self> {
        let (r, v) = (state.position_km.km(), state.velocity_km_s);
        let momentum = r.cross(&v);
        let (distance, normal) = (r.norm(), momentum.try_normalize(0.0)?);
        let semi_major_axis_km = 1.0 / (2.0 / distance - v.norm_squared() / gm_km3_s2);
        if !(semi_major_axis_km.is_finite() && semi_major_axis_km > 0.0) {
            return None;
        }
        let node = Vector3::z().cross(&normal);
        let node = if node.norm() < EQUATORIAL {
            Vector3::x()
        } else {
            node.normalize()
        };
        let perigee = v.cross(&momentum) / gm_km3_s2 - r / distance;
        let eccentricity = perigee.norm();
        let apse = if eccentricity < CIRCULAR {
            node
        } else {
            perigee
        };
        let ahead_deg = |from: Vector3<f64>, to: Vector3<f64>| {
            let angle = normal.dot(&from.cross(&to)).atan2(from.dot(&to));
            wrap_360(angle.to_degrees())
        };
        let inclination = normal.x.hypot(normal.y).atan2(normal.z);
        Some(Self {
            semi_major_axis_km,
            eccentricity,
            inclination_deg: inclination.to_degrees(),
            raan_deg: wrap_360(node.y.atan2(node.x).to_degrees()),
            arg_perigee_deg: ahead_deg(node, apse),
            true_anomaly_deg: ahead_deg(apse, r),
            gm_km3_s2,
        })
    }

    /// The keywords of table 3-3 and their values.
    pub(super) fn pairs(&self) -> [(&'static str, String); 7] {
        [
            ("SEMI_MAJOR_AXIS", format!("{:.9}", self.semi_major_axis_km)),
            ("ECCENTRICITY", format!("{:.12}", self.eccentricity)),
            ("INCLINATION", format!("{:.9}", self.inclination_deg)),
            ("RA_OF_ASC_NODE", format!("{:.9}", self.raan_deg)),
            ("ARG_OF_PERICENTER", format!("{:.9}", self.arg_perigee_deg)),
            ("TRUE_ANOMALY", format!("{:.9}", self.true_anomaly_deg)),
            ("GM", format!("{:.9}", self.gm_km3_s2)),
        ]
    }
}
