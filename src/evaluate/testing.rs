//! A study for the tests of this crate.

use super::Setup;
use crate::constellation::gnss::Preset;
use crate::ground::Site;
use crate::time::TimeGrid;
use crate::visibility::Mask;

/// The paper's assumptions over any points and instants, with one mask for all satellites.
pub(crate) fn setup(grid: TimeGrid, sites: Vec<Site>, mask_deg: f64) -> Setup {
    Setup::new(grid, sites)
        .with_mask(Mask::from_degrees(mask_deg).unwrap())
        .with_gnss(vec![Preset::Beidou3.into()])
}
