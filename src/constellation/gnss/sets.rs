//! A navigation system from SGP4 element sets.

use super::{GnssOrbit, GnssSatellite};
use crate::constellation::identity::{ObjectIdentity, first_repeated, unique_labels};
use crate::orbit::PropagationError;
use crate::orbit::sgp4::Sgp4Orbit;
use crate::time::{Epoch, TimeGrid};
use crate::units::SECONDS_PER_DAY;
use std::fmt;
use thiserror::Error;

/// Why element sets do not form a system.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ElementSetError {
    /// No set.
    #[error("{system}: there is no element set")]
    Empty {
        /// The system.
        system: String,
    },
    /// A satellite with more than one set, which would be propagated twice.
    #[error("{system}: satellite {satellite} has more than one element set; keep one")]
    Duplicate {
        /// The system.
        system: String,
        /// The satellite.
        satellite: String,
    },
    /// A set that SGP4 rejects.
    #[error("{system}: satellite {satellite}: {source}")]
    Refused {
        /// The system.
        system: String,
        /// The satellite.
        satellite: String,
        /// The message of SGP4.
        source: PropagationError,
    },
}

/// A satellite and its set, with the epoch of the set as time origin.
#[derive(Debug, Clone)]
struct ElementSetMember {
    name: String,
    epoch: Epoch,
    orbit: Sgp4Orbit,
}

/// The satellites of one navigation system, each from one element set, propagated by SGP4.
#[derive(Debug, Clone)]
pub struct ElementSets {
    name: String,
    members: Vec<ElementSetMember>,
}

/// Element sets that are old, or not yet valid, for a study: a warning, not an error.
///
/// The error of SGP4 for a navigation satellite grows to kilometres in days and to tens of
/// kilometres in-track in weeks (Vallado et al., AIAA 2006-6753).
#[derive(Debug, Clone, PartialEq)]
pub struct StaleElements {
    /// The system.
    pub system: String,
    /// The satellite whose set is farthest from the study.
    pub satellite: String,
    /// Largest distance in time between the set and an instant of the study, days.
    pub age_days: f64,
}

impl fmt::Display for StaleElements {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            formatter,
            "{}: the element set of {} is {:.1} days from the study",
            self.system, self.satellite, self.age_days
        )
    }
}

impl ElementSets {
    /// The system `name` from the sets of its satellites.
    ///
    /// A satellite is named as in its set, or by its catalogue number or designator.
    ///
    /// # Errors
    /// If there is no set, a satellite has two, or SGP4 rejects one.
    pub fn new(name: &str, sets: &[::sgp4::Elements]) -> Result<Self, ElementSetError> {
        let system = || name.to_owned();
        if sets.is_empty() {
            return Err(ElementSetError::Empty { system: system() });
        }
        let mut members = Vec::with_capacity(sets.len());
        let identities: Vec<_> = sets.iter().map(ObjectIdentity::of_set).collect();
        let names = unique_labels(&identities);
        if let Some((first, _)) = first_repeated(&identities) {
            return Err(ElementSetError::Duplicate {
                system: system(),
                satellite: names[first].clone(),
            });
        }
        for (satellite, set) in names.into_iter().zip(sets) {
            let epoch = Epoch::from_utc(set.datetime.and_utc());
            match Sgp4Orbit::from_element_set(set, epoch) {
                Ok(orbit) => members.push(ElementSetMember {
                    name: satellite,
                    epoch,
                    orbit,
                }),
                Err(source) => {
                    return Err(ElementSetError::Refused {
                        system: system(),
                        satellite,
                        source,
                    });
                }
            }
        }
        Ok(Self {
            name: system(),
            members,
        })
    }

    /// Name of the system.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The satellites, with time from `origin`.
    #[must_use]
    pub fn satellites(&self, origin: Epoch) -> Vec<GnssSatellite> {
        let propagate = |member: &ElementSetMember| {
            let ahead_s = origin.seconds_since(member.epoch);
            GnssSatellite {
                name: member.name.clone(),
                orbit: GnssOrbit::Sgp4(Box::new(member.orbit.with_origin_moved(ahead_s))),
            }
        };
        self.members.iter().map(propagate).collect()
    }

    /// The set that is farthest from an instant of `grid`, if that is more than
    /// [`StaleElements::MAX_AGE_DAYS`].
    #[must_use]
    pub fn stale(&self, grid: TimeGrid) -> Option<StaleElements> {
        let members = self.members.iter();
        let members = members.map(|member| (member.name.clone(), member.epoch));
        StaleElements::among(&self.name, members, grid)
    }
}

impl StaleElements {
    /// Age beyond which sets are stale, days.
    pub const MAX_AGE_DAYS: f64 = 14.0;

    /// The set of `system` that is farthest from an instant of `grid`, if that is more than
    /// [`Self::MAX_AGE_DAYS`]; sets by their satellite and epoch.
    pub fn among(
        system: &str,
        sets: impl IntoIterator<Item = (String, Epoch)>,
        grid: TimeGrid,
    ) -> Option<Self> {
        let last_s = grid.elapsed_s(grid.len() - 1);
        let age_days = |epoch: Epoch| {
            let to_first_s = grid.epoch().seconds_since(epoch);
            to_first_s.abs().max((to_first_s + last_s).abs()) / SECONDS_PER_DAY
        };
        sets.into_iter()
            .map(|(satellite, epoch)| Self {
                system: system.to_owned(),
                satellite,
                age_days: age_days(epoch),
            })
            .max_by(|a, b| a.age_days.total_cmp(&b.age_days))
            .filter(|oldest| oldest.age_days > Self::MAX_AGE_DAYS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::Propagator;
    use nalgebra::Vector3;

    /// Case 28129 of the AIAA 2006-6753 verification set: NAVSTAR 53, a GPS satellite, by the
    /// deep-space part of SGP4.
    const NAVSTAR_53: (&str, &str) = (
        "1 28129U 03058A   06175.57071136 -.00000104  00000-0  10000-3 0   459",
        "2 28129  54.7298 324.8098 0048506 266.2640  93.1663  2.00562768 18443",
    );

    fn navstar() -> ::sgp4::Elements {
        let (first, second) = NAVSTAR_53;
        ::sgp4::Elements::from_tle(None, first.as_bytes(), second.as_bytes()).unwrap()
    }

    fn grid_from(set: &::sgp4::Elements, days: f64) -> TimeGrid {
        let epoch = Epoch::from_utc(set.datetime.and_utc());
        TimeGrid::new(epoch.plus_seconds(days * SECONDS_PER_DAY), 86_400.0, 60.0).unwrap()
    }

    /// tcppver.out of the verification set, at 0 and 1440 minutes, seen from a study that starts
    /// an hour after the epoch of the set.
    #[test]
    fn validate_a_published_gps_satellite() {
        let set = navstar();
        let sets = ElementSets::new("gps", std::slice::from_ref(&set)).unwrap();
        let origin = Epoch::from_utc(set.datetime.and_utc()).plus_seconds(3600.0);
        let satellites = sets.satellites(origin);
        assert_eq!(satellites[0].name, "28129");
        let published = [
            (0.0, [21_707.464_123_51, -15_318.617_523_90, 0.135_511_52]),
            (
                1440.0,
                [22_002.200_745_62, -14_879.725_955_93, 774.328_270_99],
            ),
        ];
        for (minutes, position) in published {
            let state = satellites[0]
                .orbit
                .state_at(minutes * 60.0 - 3600.0)
                .unwrap();
            let apart = (state.position_km.km() - Vector3::from(position)).norm();
            // 1e-8 km are printed.
            assert!(apart < 3e-8, "{minutes}: {apart}");
        }
    }

    #[test]
    fn old_sets_are_reported_with_their_age() {
        let set = navstar();
        let sets = ElementSets::new("gps", std::slice::from_ref(&set)).unwrap();
        assert_eq!(sets.stale(grid_from(&set, 10.0)), None);
        assert_eq!(sets.stale(grid_from(&set, -13.0)), None);
        let after = sets.stale(grid_from(&set, 20.0)).unwrap();
        // The last sample is a minute before the end of the day.
        assert!((after.age_days - (21.0 - 1.0 / 1440.0)).abs() < 1e-6);
        assert_eq!(
            after.to_string(),
            "gps: the element set of 28129 is 21.0 days from the study"
        );
        let before = sets.stale(grid_from(&set, -30.0)).unwrap();
        assert!((before.age_days - 30.0).abs() < 1e-6);
    }

    #[test]
    fn sets_that_make_no_system_are_named() {
        let set = navstar();
        let error = |sets: &[::sgp4::Elements]| ElementSets::new("gps", sets).unwrap_err();
        assert_eq!(error(&[]).to_string(), "gps: there is no element set");
        let twice = error(&[set.clone(), set.clone()]);
        assert_eq!(
            twice.to_string(),
            "gps: satellite 28129 has more than one element set; keep one"
        );
        let open = ::sgp4::Elements {
            eccentricity: 1.2,
            ..set
        };
        assert!(matches!(error(&[open]), ElementSetError::Refused { .. }));
    }
}
