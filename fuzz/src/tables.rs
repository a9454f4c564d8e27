//! Tables and outlines that describe a study, which are read and not written.

use navwalker::dop::{Clocks, ObservationWeights, SkyRule};
use navwalker::earth::Surface;
use navwalker::formats::{deployment, outages, skies};
use navwalker::ground::{ServiceArea, sites_from_csv};
use navwalker::keyword::Keyword;
use navwalker::visibility::MaskTable;

/// Skies by azimuth and elevation: each satellite is used or below the mask, and dilutions are finite and belong together.
pub fn skies(bytes: &[u8]) {
    let Ok(table) = skies::read_skies("fuzz", bytes) else {
        return;
    };
    assert!(!table.skies.is_empty());
    for sky in table.skies.iter().take(100) {
        for clocks in Clocks::ALL {
            for mask_deg in [0.0, 7.0] {
                let found = sky.dops(SkyRule {
                    mask_deg,
                    clocks: *clocks,
                    weights: ObservationWeights::Unit,
                });
                assert_eq!(found.satellites + found.below_mask, sky.satellites.len());
                assert_eq!(found.dops.is_none(), found.unsolved().is_some());
                let Some(dops) = found.dops else { continue };
                assert!(found.satellites >= 3 + found.clocks.iter().filter(|clock| clock.satellites > 0).count());
                assert!(dops.pdop.is_finite() && dops.pdop > 0.0);
                let squared = dops.hdop * dops.hdop + dops.vdop * dops.vdop;
                assert!((squared / (dops.pdop * dops.pdop) - 1.0).abs() < 1e-9);
            }
        }
    }
}

/// The others: skylines, sites, areas, intervals out of service and phases.
pub fn tables(bytes: &[u8]) {
    if let Ok(skyline) = MaskTable::from_csv(bytes) {
        assert!((0.0..90.0).contains(&skyline.highest_deg()));
        let again = MaskTable::from_pairs(&skyline.to_pairs());
        assert_eq!(again.as_ref(), Ok(&skyline));
    }
    if let Ok(sites) = sites_from_csv(bytes, Surface::Wgs84) {
        assert!(sites.iter().all(|site| site.weight.is_finite() && site.height_m.is_finite()));
    }
    if let Ok(area) = ServiceArea::from_geojson(bytes) {
        let places = area.outlines().into_iter().flatten();
        assert!(places.flatten().all(f64::is_finite));
    }
    for interval in outages::read(bytes).unwrap_or_default() {
        assert!(interval.start < interval.end);
    }
    if let Ok(steps) = deployment::read(bytes) {
        assert!(!steps.is_empty());
    }
}
