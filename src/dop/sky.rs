//! The dilution of precision of a sky: satellites by azimuth and elevation, without orbits.

use super::{ClockGroup, Clocks, DopFamily, MOST_PDOP_CAP, ObservationWeights};
use crate::earth::Surface;
use crate::frames::LocalFrame;

/// A satellite as seen from a point.
#[derive(Debug, Clone, PartialEq)]
pub struct SkySatellite {
    /// Azimuth, from north through east, degrees.
    pub azimuth_deg: f64,
    /// Elevation over the horizon, degrees.
    pub elevation_deg: f64,
    /// The system whose time it keeps.
    pub system: String,
}

/// The satellites that are seen from a point at an instant.
#[derive(Debug, Clone, PartialEq)]
pub struct SkyView {
    /// Its name, if there are several.
    pub name: Option<String>,
    /// The satellites.
    pub satellites: Vec<SkySatellite>,
}

/// How a sky is used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SkyRule {
    /// Least elevation of a satellite that is used, degrees.
    pub mask_deg: f64,
    /// Which systems share a clock state.
    pub clocks: Clocks,
    /// How observations are weighted.
    pub weights: ObservationWeights,
}

impl Default for SkyRule {
    /// All satellites that are not below the horizon, a clock for each system, equal weights.
    fn default() -> Self {
        Self {
            mask_deg: 0.0,
            clocks: Clocks::PerSystem,
            weights: ObservationWeights::Unit,
        }
    }
}

/// A clock of a sky.
#[derive(Debug, Clone, PartialEq)]
pub struct SkyClock {
    /// The system; `shared` for one clock of all.
    pub system: String,
    /// Satellites used with it.
    pub satellites: usize,
    /// Its dilution of precision; `None` if unsolved, or if no satellite is used.
    pub tdop: Option<f64>,
}

/// The dilutions of precision of a sky.
#[derive(Debug, Clone, PartialEq)]
pub struct SkyDops {
    /// Satellites used.
    pub satellites: usize,
    /// Satellites below the mask.
    pub below_mask: usize,
    /// The clocks, by first appearance of their systems.
    pub clocks: Vec<SkyClock>,
    /// The dilutions; `None` if unsolved.
    pub dops: Option<DopFamily>,
}

impl SkyView {
    /// The dilutions of precision of the satellites above the mask.
    #[must_use]
    pub fn dops(&self, rule: SkyRule) -> SkyDops {
        // Only the local axes matter.
        let site = LocalFrame::new(Surface::Sphere, 0.0, 0.0);
        let mut clocks: Vec<SkyClock> = Vec::new();
        let mut groups: Vec<ClockGroup> = Vec::new();
        let mut below_mask = 0;
        for satellite in &self.satellites {
            let system = match rule.clocks {
                Clocks::PerSystem => satellite.system.as_str(),
                Clocks::Shared => "shared",
            };
            let known = clocks.iter().position(|clock| clock.system == system);
            let place = known.unwrap_or_else(|| {
                clocks.push(SkyClock {
                    system: system.to_owned(),
                    satellites: 0,
                    tdop: None,
                });
                groups.push(ClockGroup::default());
                clocks.len() - 1
            });
            if satellite.elevation_deg < rule.mask_deg {
                below_mask += 1;
                continue;
            }
            let (sin_e, cos_e) = satellite.elevation_deg.to_radians().sin_cos();
            let (sin_a, cos_a) = satellite.azimuth_deg.to_radians().sin_cos();
            let unit = (site.east * sin_a + site.north * cos_a) * cos_e + site.up * sin_e;
            let weight = rule.weights.weight(sin_e);
            groups[place].add(unit, weight);
            clocks[place].satellites += usize::from(weight > 0.0);
        }
        let dops = DopFamily::of(&groups, &site, MOST_PDOP_CAP);
        if let Some(dops) = &dops {
            for (clock, tdop) in clocks.iter_mut().zip(&dops.tdop) {
                clock.tdop = *tdop;
            }
        }
        SkyDops {
            satellites: clocks.iter().map(|clock| clock.satellites).sum(),
            below_mask,
            clocks,
            dops,
        }
    }
}

impl SkyDops {
    /// Unknowns of the position and of the clocks with satellites.
    #[must_use]
    pub fn states(&self) -> usize {
        3 + self.used_clocks().count()
    }

    /// The dilution of the clock; of several, that of the first.
    #[must_use]
    pub fn tdop(&self) -> Option<f64> {
        self.used_clocks().next()?.tdop
    }

    fn used_clocks(&self) -> impl Iterator<Item = &SkyClock> {
        self.clocks.iter().filter(|clock| clock.satellites > 0)
    }

    /// Why there are no dilutions of precision; `None` if there are.
    #[must_use]
    pub fn unsolved(&self) -> Option<String> {
        if self.dops.is_some() {
            return None;
        }
        let (found, needed) = (self.satellites, self.states());
        Some(if found < needed {
            let found = crate::units::counted(found, "satellite");
            format!("{found} for {needed} unknowns")
        } else {
            "the directions leave a component of the position undetermined".to_owned()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sky(places: &[(f64, f64, &str)]) -> SkyView {
        let satellite = |&(azimuth_deg, elevation_deg, system): &(f64, f64, &str)| SkySatellite {
            azimuth_deg,
            elevation_deg,
            system: system.to_owned(),
        };
        SkyView {
            name: None,
            satellites: places.iter().map(satellite).collect(),
        }
    }

    const FIVE: [(f64, f64, &str); 5] = [
        (0.0, 5.0, "a"),
        (120.0, 5.0, "a"),
        (240.0, 5.0, "a"),
        (0.0, 90.0, "a"),
        (40.0, 3.0, "b"),
    ];

    /// Three satellites at the elevation E, 120° apart, and one at the zenith: HDOP² = 4/(3 cos² E), and with
    /// k = 1 - sin E, VDOP² = 4/(3 k²), TDOP² = (1 + 3 sin² E)/(3 k²).
    #[test]
    fn validate_a_symmetric_sky_against_its_closed_form() {
        let dops = sky(&FIVE[..4]).dops(SkyRule::default());
        let (sin_e, cos_e) = 5_f64.to_radians().sin_cos();
        let family = dops.dops.as_ref().unwrap();
        let k = 1.0 - sin_e;
        for (ours, squared) in [
            (family.hdop, 4.0 / (3.0 * cos_e * cos_e)),
            (family.vdop, 4.0 / (3.0 * k * k)),
            (
                dops.tdop().unwrap(),
                (1.0 + 3.0 * sin_e * sin_e) / (3.0 * k * k),
            ),
        ] {
            assert!((ours * ours / squared - 1.0).abs() < 1e-13, "{ours}");
        }
    }

    #[test]
    fn masks_clocks_and_weights_count() {
        let five = sky(&FIVE);
        // A satellite of another system brings its own unknown, and so nothing.
        let own = five.dops(SkyRule::default());
        let alone = sky(&FIVE[..4]).dops(SkyRule::default());
        assert_eq!((own.satellites, own.states(), own.clocks.len()), (5, 5, 2));
        assert_eq!(
            own.dops.as_ref().unwrap().pdop,
            alone.dops.as_ref().unwrap().pdop
        );
        let shared = SkyRule {
            clocks: Clocks::Shared,
            ..SkyRule::default()
        };
        let shared = five.dops(shared);
        assert_eq!((shared.clocks.len(), shared.states()), (1, 4));
        assert!(shared.dops.as_ref().unwrap().pdop < alone.dops.as_ref().unwrap().pdop);
        // At the mask is above it.
        let masked = |mask_deg| {
            five.dops(SkyRule {
                mask_deg,
                ..SkyRule::default()
            })
        };
        assert_eq!((masked(5.0).satellites, masked(5.0).below_mask), (4, 1));
        assert_eq!(masked(5.0).clocks[1].tdop, None);
        let few = masked(6.0);
        assert_eq!(
            few.unsolved().as_deref(),
            Some("1 satellite for 4 unknowns")
        );
        let flat = sky(&[
            (0.0, 10.0, "a"),
            (90.0, 10.0, "a"),
            (180.0, 10.0, "a"),
            (270.0, 10.0, "a"),
        ]);
        let told = flat.dops(SkyRule::default()).unsolved().unwrap();
        assert!(told.contains("undetermined"), "{told}");
        let sine = SkyRule {
            weights: ObservationWeights::SineElevation,
            ..SkyRule::default()
        };
        assert!(five.dops(sine).dops.unwrap().pdop > own.dops.unwrap().pdop);
    }
}
