//! A study for tests.

use super::Setup;
use crate::constellation::gnss::Preset;
use crate::ground::Site;
use crate::time::TimeGrid;
use crate::visibility::Mask;

/// The paper's assumptions with given points and instants, and one mask for all satellites.
pub(crate) fn setup(grid: TimeGrid, sites: Vec<Site>, mask_deg: f64) -> Setup {
    Setup::new(grid, sites)
        .with_mask(Mask::from_degrees(mask_deg).unwrap())
        .with_gnss(vec![Preset::Beidou3.into()])
}
