//! Alternatives to what the paper does not state, one change at a time.

use super::PaperError;
use crate::constellation::gnss::{GnssOrbit, GnssSatellite, System};
use crate::dop::Clocks;
use crate::earth::Surface;
use crate::evaluate::Setup;
use crate::ground::Site;
use crate::time::TimeGrid;
use crate::visibility::Mask;

/// Masks that are tried, degrees.
const MASKS_DEG: [f64; 4] = [0.0, 5.0, 7.0, 10.0];

/// Shift of the GEO and IGSO slots, degrees: a sixth of the 60° spanned by the GEO, a plausible error.
const SLOT_TURN_DEG: f64 = 10.0;

/// Shifts of the epoch, hours: each rotates the Earth under the constellations.
const EPOCH_SHIFTS_H: [f64; 2] = [6.0, 12.0];

/// Relative difference below which two area weights count as equal.
const SAME: f64 = 1e-12;

/// A setup that differs from the scenario's in one assumption.
pub(super) struct Alternative {
    /// The difference, in words.
    pub(super) name: String,
    /// The setup.
    pub(super) setup: Setup,
}

/// Every alternative to `base`, without those that `base` assumes already.
pub(super) fn alternatives(base: &Setup) -> Result<Vec<Alternative>, PaperError> {
    let mut found = Vec::new();
    let mut add = |name: String, setup: Setup| found.push(Alternative { name, setup });
    for mask_deg in MASKS_DEG {
        if mask_deg != base.mask.degrees() {
            let mask = Mask::from_degrees(mask_deg)?;
            let masks = |setup: Setup| Setup {
                mask,
                gnss_mask: mask,
                ..setup
            };
            add(format!("mask {mask_deg}°"), masks(base.clone()));
        }
    }
    for surface in [Surface::Sphere, Surface::Wgs84] {
        let sites = resited(base, |site| (surface, site.latitude_deg, site.weight))?;
        if sites != base.sites {
            add(format!("surface {surface}"), with_sites(base, sites));
        }
    }
    let clocks = match base.clocks {
        Clocks::PerSystem => Clocks::Shared,
        Clocks::Shared => Clocks::PerSystem,
    };
    add(
        format!("clocks {clocks}"),
        Setup {
            clocks,
            ..base.clone()
        },
    );
    for (name, keeps) in SUBSETS {
        add(
            name.to_owned(),
            with_gnss(base, |satellite| {
                keeps(satellite).then(|| satellite.clone())
            }),
        );
    }
    for (name, turned) in TURNS {
        add(
            format!("{name} {SLOT_TURN_DEG}° further east"),
            with_gnss(base, |satellite| Some(turned(satellite))),
        );
    }
    for hours in EPOCH_SHIFTS_H {
        let grid = shifted(base.grid, hours)?;
        add(
            format!("epoch {hours} h later"),
            Setup {
                grid,
                ..base.clone()
            },
        );
    }
    let weighted = reweighted(base)?;
    if let Some((name, sites)) = weighted {
        add(name.to_owned(), with_sites(base, sites));
    }
    Ok(found)
}

type Keeps = fn(&GnssSatellite) -> bool;

/// Parts of BeiDou-3 that may have been meant.
const SUBSETS: [(&str, Keeps); 2] = [
    ("GNSS: MEO only", |s| {
        matches!(s.orbit, GnssOrbit::Secular(_))
    }),
    ("GNSS: MEO and IGSO", |s| {
        !matches!(s.orbit, GnssOrbit::Geostationary { .. })
    }),
];

type Turned = fn(&GnssSatellite) -> GnssSatellite;

/// Slots that may be elsewhere.
const TURNS: [(&str, Turned); 2] = [
    ("GEO", |satellite| {
        let mut satellite = satellite.clone();
        if let GnssOrbit::Geostationary { longitude_rad, .. } = &mut satellite.orbit {
            *longitude_rad += SLOT_TURN_DEG.to_radians();
        }
        satellite
    }),
    ("IGSO", |satellite| {
        let mut satellite = satellite.clone();
        if let GnssOrbit::Geosynchronous(orbit) = &mut satellite.orbit {
            orbit.raan_rad += SLOT_TURN_DEG.to_radians();
        }
        satellite
    }),
];

/// The setup with each GNSS satellite changed, or left out.
fn with_gnss(base: &Setup, change: impl Fn(&GnssSatellite) -> Option<GnssSatellite>) -> Setup {
    let epoch = base.grid.epoch();
    let changed = |system: &System| System::Listed {
        name: system.name().to_owned(),
        satellites: system
            .satellites(epoch)
            .iter()
            .filter_map(&change)
            .collect(),
    };
    Setup {
        gnss: base.gnss.iter().map(changed).collect(),
        ..base.clone()
    }
}

fn with_sites(base: &Setup, sites: Vec<Site>) -> Setup {
    Setup {
        sites,
        ..base.clone()
    }
}

/// The sites with another surface, latitude or weight.
fn resited(
    base: &Setup,
    change: impl Fn(&Site) -> (Surface, f64, f64),
) -> Result<Vec<Site>, PaperError> {
    let site = |site: &Site| {
        let (surface, latitude_deg, weight) = change(site);
        Ok(Site::new(
            surface,
            latitude_deg,
            site.longitude_deg,
            weight,
        )?)
    };
    base.sites.iter().map(site).collect()
}

/// Weights by area where all were equal, and the other way round; `None` for other weights.
fn reweighted(base: &Setup) -> Result<Option<(&'static str, Vec<Site>)>, PaperError> {
    let area = |site: &Site| site.latitude_deg.to_radians().cos();
    let by = |weight: fn(&Site) -> f64| {
        let site = |site: &Site| Site {
            weight: weight(site),
            ..site.clone()
        };
        base.sites.iter().map(site).collect::<Vec<_>>()
    };
    if base.has_equal_weights() {
        let positive = base.sites.iter().all(|site| area(site) > 0.0);
        let sites = || by(|site| site.latitude_deg.to_radians().cos());
        return Ok(positive.then(|| ("points weighted by area", sites())));
    }
    let scale = base.sites.first().map(|site| site.weight / area(site));
    let like_area = |site: &Site| {
        scale.is_some_and(|scale| (site.weight - scale * area(site)).abs() <= SAME * site.weight)
    };
    let is_area = base.sites.iter().all(like_area);
    Ok(is_area.then(|| ("points weighted equally", by(|_| 1.0))))
}

fn shifted(grid: TimeGrid, hours: f64) -> Result<TimeGrid, PaperError> {
    let seconds = hours * crate::units::SECONDS_PER_HOUR;
    let duration_s = grid.len() as f64 * grid.step_s();
    Ok(TimeGrid::new(
        grid.epoch().plus_seconds(seconds),
        duration_s,
        grid.step_s(),
    )?)
}
