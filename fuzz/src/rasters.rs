//! Rasters of heights and weights, which are read and not written.

use navwalker::earth::Surface;
use navwalker::formats::terrain;
use navwalker::ground::{Grid, PointWeights, RegionMap, Site};

/// The globe in steps of 30°, on which a raster is put.
const GRID: Grid = Grid {
    latitude_deg: [-90.0, 90.0],
    longitude_deg: [-180.0, 180.0],
    step_deg: [30.0, 30.0],
    weights: PointWeights::Equal,
};

/// What is accepted carries a point and weights a region, or says why not; no height, skyline or weight is not a number.
pub fn terrain(bytes: &[u8]) {
    if let Ok(file) = terrain::terrain(bytes) {
        let Ok(site) = Site::new(Surface::Wgs84, 10.5, 20.2, 1.0) else {
            return;
        };
        let mut sites = [site];
        if file.terrain.carry(&mut sites, Surface::Wgs84, 2.0).is_ok() {
            assert!(sites[0].height_m.is_finite());
            let highest = sites[0].skyline.as_ref().map(|skyline| skyline.highest_deg());
            assert!(highest.is_none_or(|degrees| (0.0..90.0).contains(&degrees)));
        }
    }
    if let (Ok(raster), Ok(mut sites)) = (terrain::weights(bytes), GRID.sites(Surface::Wgs84)) {
        if raster.weigh(&mut sites, &RegionMap::of_grid(&GRID)).is_ok() {
            assert!(sites.iter().all(|site| site.weight > 0.0 && site.weight.is_finite()));
        }
    }
}
