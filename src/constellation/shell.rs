//! Walker delta and star patterns and two-dimensional lattice flower constellations.

use super::{Satellite, Slot};
use crate::earth::RADIUS_KM;
use crate::keyword::keywords;
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

/// Why numbers do not describe a design.
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
    /// More satellites than [`Design::MAX_SATELLITES`].
    #[error("{satellites} satellites exceed the limit of {limit}")]
    TooMany {
        /// T.
        satellites: usize,
        /// Maximum number of satellites of a design.
        limit: usize,
    },
    /// Altitude not a positive number below [`Design::MAX_ALTITUDE_KM`].
    #[error("altitude {0} km is outside 0 to {max} km", max = Design::MAX_ALTITUDE_KM)]
    Altitude(f64),
    /// An orbit that cannot be propagated.
    #[error(transparent)]
    Orbit(#[from] ElementsError),
}

/// The parameters of a circular design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DesignParameters {
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

/// A LEO constellation design: a pattern and the orbit that its satellites share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Design {
    parameters: DesignParameters,
    eccentricity: f64,
    arg_perigee_deg: f64,
}

impl Design {
    /// Maximum number of satellites of a design.
    pub const MAX_SATELLITES: usize = 100_000;

    /// Largest altitude over the equatorial radius, km.
    pub const MAX_ALTITUDE_KM: f64 = 100_000.0;

    /// A circular design.
    ///
    /// # Errors
    /// Names the quantity that is out of range.
    pub fn new(parameters: DesignParameters) -> Result<Self, DesignError> {
        let DesignParameters {
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

    /// The same design on an ellipse: the semi-major axis stays R + altitude.
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

    fn checked(self) -> Result<Self, DesignError> {
        self.elements(Slot { plane: 0, index: 0 }).checked()?;
        Ok(self)
    }

    /// Everything except the ellipse.
    #[must_use]
    pub fn parameters(&self) -> DesignParameters {
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

    /// The slots, plane by plane.
    pub fn slots(&self) -> impl Iterator<Item = Slot> + use<> {
        let per_plane = self.parameters.satellites_per_plane;
        (0..self.satellite_count()).map(move |n| Slot {
            plane: n / per_plane,
            index: n % per_plane,
        })
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
        let raan_turns = match self.parameters.pattern {
            Pattern::Delta | Pattern::Lattice => k / p,
            Pattern::Star => 0.5 * k / p,
        };
        let anomaly_turns = match self.parameters.pattern {
            Pattern::Delta | Pattern::Star => j / s + f * k / (p * s),
            Pattern::Lattice => (j - f * k / p) / s,
        };
        MeanElements {
            semi_major_axis_km: RADIUS_KM + self.parameters.altitude_km,
            eccentricity: self.eccentricity,
            inclination_rad: self.parameters.inclination_deg.to_radians(),
            raan_rad: raan_turns * std::f64::consts::TAU,
            arg_perigee_rad: self.arg_perigee_deg.to_radians(),
            mean_anomaly_rad: wrap_two_pi(anomaly_turns * std::f64::consts::TAU),
        }
    }
}

fn check_count(satellites: usize) -> Result<(), DesignError> {
    let limit = Design::MAX_SATELLITES;
    if satellites > limit {
        return Err(DesignError::TooMany { satellites, limit });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn design(pattern: Pattern, [planes, satellites_per_plane, phasing]: [usize; 3]) -> Design {
        Design::new(DesignParameters {
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
        let satellites = design(Pattern::Delta, [3, 8, 1]).satellites();
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
        let e = design(Pattern::Star, [6, 11, 2]).elements(Slot { plane: 1, index: 0 });
        assert!((e.raan_rad.to_degrees() - 30.0).abs() < 1e-12);
        assert!((e.mean_anomaly_rad.to_degrees() - 720.0 / 66.0).abs() < 1e-12);
    }

    #[test]
    fn lattice_is_delta_with_the_opposite_phasing() {
        for f in 0..13 {
            let delta = design(Pattern::Delta, [13, 14, f]).satellites();
            let lattice = design(Pattern::Lattice, [13, 14, (13 - f) % 13]).satellites();
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

    #[test]
    fn bad_designs_are_named() {
        let good = design(Pattern::Delta, [13, 14, 1]).parameters();
        let error = |parameters| Design::new(parameters).unwrap_err().to_string();
        assert_eq!(
            error(DesignParameters { planes: 0, ..good }),
            "planes P = 0; at least one plane is needed"
        );
        assert_eq!(
            error(DesignParameters {
                satellites_per_plane: 0,
                ..good
            }),
            "satellites T = 0; at least one satellite is needed"
        );
        assert_eq!(
            error(DesignParameters {
                satellites_per_plane: usize::MAX,
                ..good
            }),
            format!("{} satellites exceed the limit of 100000", usize::MAX)
        );
        assert_eq!(
            error(DesignParameters {
                phasing: 13,
                ..good
            }),
            "phasing F = 13 is outside 0 to P - 1 = 12"
        );
        assert_eq!(
            error(DesignParameters {
                altitude_km: -5.0,
                ..good
            }),
            "altitude -5 km is outside 0 to 100000 km"
        );
        assert_eq!(
            error(DesignParameters {
                inclination_deg: 181.0,
                ..good
            }),
            "inclination 181° is outside [0°, 180°]"
        );
        let low = design(Pattern::Delta, [2, 2, 1])
            .with_ellipse(0.2, 90.0)
            .unwrap_err();
        assert!(low.to_string().contains("is not above the ground"));
    }
}
