//! A shell: a Walker delta, a Walker star or a two-dimensional lattice flower.

use super::{Design, Satellite, Slot};
use crate::earth::RADIUS_KM;
use crate::keyword::keywords;
use crate::orbit::relations::RelationError;
use crate::orbit::{ElementsError, MeanElements};
use crate::units::{wrap_360, wrap_two_pi};
use thiserror::Error;

keywords! {
    /// How planes and phases are laid out.
    Pattern {
        /// Walker delta: nodes over 360°, phase step 360° F/T between planes.
        Delta = "delta",
        /// Walker star: nodes over 180°, the same phase step (as in Orekit, TAT-C and brahe;
        /// lox steps by half of it).
        Star = "star",
        /// Two-dimensional lattice flower: nodes over 360°, phase step -360° `N_c`/T.
        Lattice = "lattice",
    }
}

/// Why numbers do not describe a shell, or shells a design.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum DesignError {
    /// No plane.
    #[error("planes P = 0; at least one plane is needed")]
    NoPlane,
    /// No satellite.
    #[error("satellites T = 0; at least one satellite is needed")]
    NoSatellite,
    /// T is not a multiple of P.
    #[error(
        "satellites T = {satellites} is not a multiple of planes P = {planes}; nearest: {below} or {above}"
    )]
    NotAMultiple {
        /// T.
        satellites: usize,
        /// P.
        planes: usize,
        /// The multiple below (at least P).
        below: usize,
        /// The multiple above.
        above: usize,
    },
    /// F outside [0, P - 1].
    #[error("phasing F = {phasing} is outside 0 to P - 1 = {}", planes - 1)]
    Phasing {
        /// F, or `N_c` of a lattice.
        phasing: usize,
        /// P.
        planes: usize,
    },
    /// A design without a shell.
    #[error("a design has at least one shell")]
    NoShell,
    /// An orientation that is not a finite angle, or a node step of more than a turn.
    #[error("{name} {value}° is outside {min}° to {max}°")]
    Angle {
        /// The angle.
        name: &'static str,
        /// Its value, degrees.
        value: f64,
        /// Least value, degrees.
        min: f64,
        /// Largest value, degrees.
        max: f64,
    },
    /// A node step in a pattern whose nodes follow from its phases.
    #[error("node-step does not apply to lattice: its phases follow from nodes 360°/P apart")]
    NodeStepOfLattice,
    /// More satellites than [`Design::MAX_SATELLITES`](super::Design::MAX_SATELLITES).
    #[error("{satellites} satellites exceed the limit of {limit}")]
    TooMany {
        /// T.
        satellites: usize,
        /// Maximum number of satellites of a design.
        limit: usize,
    },
    /// Altitude not a positive number below [`Shell::MAX_ALTITUDE_KM`].
    #[error("altitude {0} km is outside 0 to {max} km", max = Shell::MAX_ALTITUDE_KM)]
    Altitude(f64),
    /// No orbit has the altitude or the inclination that is to follow.
    #[error(transparent)]
    Relation(#[from] RelationError),
    /// An orbit that cannot be propagated.
    #[error(transparent)]
    Orbit(#[from] ElementsError),
}

/// The parameters of a circular shell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShellParameters {
    /// The layout of planes and phases.
    pub pattern: Pattern,
    /// Number of planes P (`N_o` of a lattice).
    pub planes: usize,
    /// Satellites per plane S (`N_so` of a lattice); T = P S.
    pub satellites_per_plane: usize,
    /// Phasing F, or `N_c` of a lattice.
    pub phasing: usize,
    /// Inclination, degrees.
    pub inclination_deg: f64,
    /// Semi-major axis minus the equatorial radius, km.
    pub altitude_km: f64,
}

/// The angles at the epoch that a pattern leaves free.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Orientation {
    /// Right ascension of the node of the first plane in TEME, degrees.
    pub raan_deg: f64,
    /// Mean argument of latitude ω + M of the first satellite of the first plane, degrees; `None` for M = 0.
    pub arg_latitude_deg: Option<f64>,
    /// From the node of one plane to that of the next, degrees; `None` for the pattern's own, 360°/P or 180°/P.
    pub node_step_deg: Option<f64>,
}

/// A shell: a pattern and the orbit that its satellites share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shell {
    parameters: ShellParameters,
    eccentricity: f64,
    arg_perigee_deg: f64,
    orientation: Orientation,
}

impl Shell {
    /// Largest altitude over the equatorial radius, km.
    pub const MAX_ALTITUDE_KM: f64 = 100_000.0;

    /// A circular shell with its first node and its first mean anomaly at 0.
    ///
    /// # Errors
    /// Names the quantity that is out of range.
    pub fn new(parameters: ShellParameters) -> Result<Self, DesignError> {
        let ShellParameters {
            planes,
            satellites_per_plane,
            phasing,
            altitude_km,
            ..
        } = parameters;
        if planes == 0 {
            return Err(DesignError::NoPlane);
        }
        if satellites_per_plane == 0 {
            return Err(DesignError::NoSatellite);
        }
        check_count(planes.saturating_mul(satellites_per_plane))?;
        if phasing >= planes {
            return Err(DesignError::Phasing { phasing, planes });
        }
        if !(altitude_km > 0.0 && altitude_km <= Self::MAX_ALTITUDE_KM) {
            return Err(DesignError::Altitude(altitude_km));
        }
        Self {
            parameters,
            eccentricity: 0.0,
            arg_perigee_deg: 0.0,
            orientation: Orientation::default(),
        }
        .checked()
    }

    /// Satellites per plane, from Walker's T and P.
    pub(super) fn per_plane(satellites: usize, planes: usize) -> Result<usize, DesignError> {
        if planes == 0 {
            return Err(DesignError::NoPlane);
        }
        check_count(satellites)?;
        if !satellites.is_multiple_of(planes) {
            let below = (satellites / planes).max(1) * planes;
            let above = (satellites / planes + 1) * planes;
            return Err(DesignError::NotAMultiple {
                satellites,
                planes,
                below,
                above,
            });
        }
        Ok(satellites / planes)
    }

    /// The same shell on an ellipse: the semi-major axis stays R + altitude.
    ///
    /// # Errors
    /// If the eccentricity is outside [0, 0.9) or the perigee not above ground.
    pub fn with_ellipse(
        self,
        eccentricity: f64,
        arg_perigee_deg: f64,
    ) -> Result<Self, DesignError> {
        Self {
            eccentricity,
            arg_perigee_deg: wrap_360(arg_perigee_deg),
            ..self
        }
        .checked()
    }

    /// The same shell with other angles at the epoch; those of nodes and satellites are reduced to [0°, 360°).
    ///
    /// # Errors
    /// If an angle is not finite, the node step is beyond a turn either way, or the pattern has none.
    pub fn with_orientation(self, orientation: Orientation) -> Result<Self, DesignError> {
        let Orientation {
            raan_deg,
            arg_latitude_deg,
            node_step_deg,
        } = orientation;
        within("raan", raan_deg, LARGEST_ANGLE_DEG)?;
        if let Some(u) = arg_latitude_deg {
            within("u", u, LARGEST_ANGLE_DEG)?;
        }
        if let Some(step) = node_step_deg {
            within("node-step", step, 360.0)?;
            if self.pattern() == Pattern::Lattice {
                return Err(DesignError::NodeStepOfLattice);
            }
        }
        Ok(Self {
            orientation: Orientation {
                // 0 is added so that -0 becomes 0, which is written in one way.
                raan_deg: wrap_360(raan_deg) + 0.0,
                arg_latitude_deg: arg_latitude_deg.map(|u| wrap_360(u) + 0.0),
                node_step_deg: node_step_deg.map(|step| step + 0.0),
            },
            ..self
        })
    }

    fn checked(self) -> Result<Self, DesignError> {
        self.elements(Slot::FIRST).checked()?;
        Ok(self)
    }

    /// Everything except the ellipse and the orientation.
    #[must_use]
    pub fn parameters(&self) -> ShellParameters {
        self.parameters
    }

    /// The layout of planes and phases.
    #[must_use]
    pub fn pattern(&self) -> Pattern {
        self.parameters.pattern
    }

    /// Number of planes P (`N_o` of a lattice).
    #[must_use]
    pub fn planes(&self) -> usize {
        self.parameters.planes
    }

    /// Satellites per plane S (`N_so` of a lattice).
    #[must_use]
    pub fn satellites_per_plane(&self) -> usize {
        self.parameters.satellites_per_plane
    }

    /// Satellites T = P S.
    #[must_use]
    pub fn satellite_count(&self) -> usize {
        self.parameters.planes * self.parameters.satellites_per_plane
    }

    /// Phasing F, or `N_c` of a lattice.
    #[must_use]
    pub fn phasing(&self) -> usize {
        self.parameters.phasing
    }

    /// Inclination, degrees.
    #[must_use]
    pub fn inclination_deg(&self) -> f64 {
        self.parameters.inclination_deg
    }

    /// Semi-major axis minus the equatorial radius, km.
    #[must_use]
    pub fn altitude_km(&self) -> f64 {
        self.parameters.altitude_km
    }

    /// Eccentricity.
    #[must_use]
    pub fn eccentricity(&self) -> f64 {
        self.eccentricity
    }

    /// Argument of perigee, degrees.
    #[must_use]
    pub fn arg_perigee_deg(&self) -> f64 {
        self.arg_perigee_deg
    }

    /// The angles at the epoch that the pattern leaves free.
    #[must_use]
    pub fn orientation(&self) -> Orientation {
        self.orientation
    }

    /// Mean argument of latitude ω + M of the first satellite at the epoch, degrees.
    #[must_use]
    pub fn arg_latitude_deg(&self) -> f64 {
        self.orientation
            .arg_latitude_deg
            .unwrap_or(self.arg_perigee_deg)
    }

    /// From the node of one plane to that of the next, degrees.
    #[must_use]
    pub fn node_step_deg(&self) -> f64 {
        let planes = self.parameters.planes as f64;
        match (self.orientation.node_step_deg, self.parameters.pattern) {
            (Some(step_deg), _) => step_deg,
            (None, Pattern::Delta | Pattern::Lattice) => 360.0 / planes,
            (None, Pattern::Star) => 180.0 / planes,
        }
    }

    /// Mean anomaly of the first satellite at the epoch, in turns.
    fn first_anomaly_turns(&self) -> f64 {
        let arg_latitude_deg = self.orientation.arg_latitude_deg;
        arg_latitude_deg.map_or(0.0, |u| (u - self.arg_perigee_deg) / 360.0)
    }

    /// The slots, plane by plane.
    pub fn slots(&self) -> impl Iterator<Item = Slot> + use<> {
        let per_plane = self.parameters.satellites_per_plane;
        (0..self.satellite_count()).map(move |n| Slot::new(n / per_plane, n % per_plane))
    }

    /// The satellites at the epoch, plane by plane.
    #[must_use]
    pub fn satellites(&self) -> Vec<Satellite> {
        self.slots()
            .map(|slot| Satellite {
                slot,
                elements: self.elements(slot),
            })
            .collect()
    }

    /// Mean elements of a slot at the epoch ([M-1](crate::models#m-1) to [M-3](crate::models#m-3)).
    ///
    /// Sources: Walker (1984), *J. Brit. Interplanet. Soc.* 37:559, for delta and star; Avendaño,
    /// Davis and Mortari (2013), *Celest. Mech. Dyn. Astron.* 116:325, for the lattice.
    #[must_use]
    pub fn elements(&self, slot: Slot) -> MeanElements {
        let (p, s) = (
            self.parameters.planes as f64,
            self.parameters.satellites_per_plane as f64,
        );
        let (k, j) = (slot.plane as f64, slot.index as f64);
        let f = self.parameters.phasing as f64;
        let raan_turns = match self.orientation.node_step_deg {
            Some(step_deg) => k * step_deg / 360.0,
            None if self.parameters.pattern == Pattern::Star => 0.5 * k / p,
            None => k / p,
        };
        let anomaly_turns = match self.parameters.pattern {
            Pattern::Delta | Pattern::Star => j / s + f * k / (p * s),
            Pattern::Lattice => (j - f * k / p) / s,
        };
        MeanElements {
            semi_major_axis_km: RADIUS_KM + self.parameters.altitude_km,
            eccentricity: self.eccentricity,
            inclination_rad: self.parameters.inclination_deg.to_radians(),
            raan_rad: self.orientation.raan_deg.to_radians() + raan_turns * std::f64::consts::TAU,
            arg_perigee_rad: self.arg_perigee_deg.to_radians(),
            mean_anomaly_rad: wrap_two_pi(
                (self.first_anomaly_turns() + anomaly_turns) * std::f64::consts::TAU,
            ),
        }
    }
}

/// Angles beyond this have no digits of a degree left to speak of.
const LARGEST_ANGLE_DEG: f64 = 1e6;

fn within(name: &'static str, value: f64, limit: f64) -> Result<(), DesignError> {
    if value.abs() <= limit {
        return Ok(());
    }
    Err(DesignError::Angle {
        name,
        value,
        min: -limit,
        max: limit,
    })
}

pub(super) fn check_count(satellites: usize) -> Result<(), DesignError> {
    let limit = Design::MAX_SATELLITES;
    if satellites > limit {
        return Err(DesignError::TooMany { satellites, limit });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(pattern: Pattern, [planes, satellites_per_plane, phasing]: [usize; 3]) -> Shell {
        Shell::new(ShellParameters {
            pattern,
            planes,
            satellites_per_plane,
            phasing,
            inclination_deg: 55.0,
            altitude_km: 925.0,
        })
        .unwrap()
    }

    /// Galileo's 24/3/1 at 56°: planes 120° apart, satellites 45° apart, planes 15° ahead of
    /// each other (Galileo OS SIS ICD, issue 2.0: 24 slots, phase step 15°).
    #[test]
    fn validate_delta_against_galileo_slots() {
        let satellites = shell(Pattern::Delta, [3, 8, 1]).satellites();
        let angles = |n: usize| {
            let e = satellites[n].elements;
            (
                e.raan_rad.to_degrees().round(),
                e.mean_anomaly_rad.to_degrees().round(),
            )
        };
        assert_eq!(angles(0), (0.0, 0.0));
        assert_eq!(angles(1), (0.0, 45.0));
        assert_eq!(angles(8), (120.0, 15.0));
        assert_eq!(angles(23), (240.0, 345.0));
        assert_eq!(satellites[23].slot.to_string(), "P03-S08");
    }

    /// Iridium, 66/6/2 star: nodes 30° apart and phase step 360° × 2/66.
    #[test]
    fn validate_star_spacing() {
        let e = shell(Pattern::Star, [6, 11, 2]).elements(Slot::new(1, 0));
        assert!((e.raan_rad.to_degrees() - 30.0).abs() < 1e-12);
        assert!((e.mean_anomaly_rad.to_degrees() - 720.0 / 66.0).abs() < 1e-12);
    }

    #[test]
    fn lattice_is_delta_with_the_opposite_phasing() {
        for f in 0..13 {
            let delta = shell(Pattern::Delta, [13, 14, f]).satellites();
            let lattice = shell(Pattern::Lattice, [13, 14, (13 - f) % 13]).satellites();
            // The same positions in each plane; the numbering within a plane may start elsewhere.
            for d in &delta {
                let same_place = lattice.iter().any(|l| {
                    let apart = l.elements.mean_anomaly_rad - d.elements.mean_anomaly_rad;
                    l.slot.plane == d.slot.plane && crate::units::wrap_pi(apart).abs() < 1e-12
                });
                assert!(same_place, "F = {f}, {}", d.slot);
            }
        }
    }

    /// Iridium as it flew: nodes 31.6° apart (Fossa et al. (1998), *Proc. IEEE NAECON*, 152).
    #[test]
    fn the_orientation_is_added_to_the_pattern() {
        let iridium = shell(Pattern::Star, [6, 11, 3])
            .with_orientation(Orientation {
                raan_deg: 370.0,
                arg_latitude_deg: Some(-30.0),
                node_step_deg: Some(31.6),
            })
            .unwrap();
        let plain = shell(Pattern::Star, [6, 11, 3]);
        for (turned, given) in iridium.satellites().iter().zip(plain.satellites()) {
            let nodes_deg = 10.0 + 31.6 * turned.slot.plane as f64;
            assert!((turned.elements.raan_rad.to_degrees() - nodes_deg).abs() < 1e-12);
            let ahead = turned.elements.mean_anomaly_rad - given.elements.mean_anomaly_rad;
            let off = crate::units::wrap_pi(ahead + 30.0_f64.to_radians());
            assert!(off.abs() < 1e-12, "{off}");
        }
        // u = ω + M, so an ellipse with the perigee at u starts at its perigee.
        let ellipse = shell(Pattern::Delta, [3, 2, 1])
            .with_ellipse(0.05, 40.0)
            .unwrap();
        let at_u = |u| Orientation {
            arg_latitude_deg: Some(u),
            ..Orientation::default()
        };
        let first = |u| {
            let turned = ellipse.with_orientation(at_u(u)).unwrap();
            turned.elements(Slot::FIRST).mean_anomaly_rad.to_degrees()
        };
        assert!(first(40.0).abs() < 1e-12 && (first(100.0) - 60.0).abs() < 1e-12);
    }

    #[test]
    fn orientations_out_of_range_are_named() {
        let error = |pattern, orientation| {
            let turned = shell(pattern, [3, 2, 1]).with_orientation(orientation);
            turned.unwrap_err().to_string()
        };
        let step = |step| Orientation {
            node_step_deg: Some(step),
            ..Orientation::default()
        };
        assert_eq!(
            error(Pattern::Delta, step(361.0)),
            "node-step 361° is outside -360° to 360°"
        );
        assert!(error(Pattern::Lattice, step(30.0)).starts_with("node-step does not apply"));
        let nowhere = Orientation {
            raan_deg: f64::NAN,
            ..Orientation::default()
        };
        assert!(error(Pattern::Delta, nowhere).starts_with("raan NaN° is outside"));
    }

    #[test]
    fn bad_shells_are_named() {
        let good = shell(Pattern::Delta, [13, 14, 1]).parameters();
        let error = |parameters| Shell::new(parameters).unwrap_err().to_string();
        assert_eq!(
            error(ShellParameters { planes: 0, ..good }),
            "planes P = 0; at least one plane is needed"
        );
        assert_eq!(
            error(ShellParameters {
                satellites_per_plane: 0,
                ..good
            }),
            "satellites T = 0; at least one satellite is needed"
        );
        assert_eq!(
            error(ShellParameters {
                satellites_per_plane: usize::MAX,
                ..good
            }),
            format!("{} satellites exceed the limit of 100000", usize::MAX)
        );
        assert_eq!(
            error(ShellParameters {
                phasing: 13,
                ..good
            }),
            "phasing F = 13 is outside 0 to P - 1 = 12"
        );
        assert_eq!(
            error(ShellParameters {
                altitude_km: -5.0,
                ..good
            }),
            "altitude -5 km is outside 0 to 100000 km"
        );
        assert_eq!(
            error(ShellParameters {
                inclination_deg: 181.0,
                ..good
            }),
            "inclination 181° is outside [0°, 180°]"
        );
        let low = shell(Pattern::Delta, [2, 2, 1])
            .with_ellipse(0.2, 90.0)
            .unwrap_err();
        assert!(low.to_string().contains("is not above the ground"));
    }
}
