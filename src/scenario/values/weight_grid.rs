//! What the points of a region count for, from a grid of values.

use crate::scenario::keys::{key, section};
use crate::scenario::reader::Reader;
use crate::scenario::rule::{Optional, Text};

section! {
    /// Weights of the points of a region from a file, if any.
    #[derive(Debug, Clone, PartialEq)]
    pub struct RegionWeightGrid in "region", finish finish_weight_grid {
        /// File of counts, such as people, on latitude and longitude (GeoTIFF, ESRI ASCII grid or CSV with the column weight),
        /// instead of weights: a point counts for what lies in the cell around it, and one without any is left out; path
        /// relative to this file.
        pub weight_grid: Option<String> = Optional(Text::Any), follows "none", example Some("population.tif".to_owned());
    }
}

fn finish_weight_grid(keys: &mut RegionWeightGrid, reader: &mut Reader<'_>) {
    if !reader.is_given(key!(RegionWeightGrid.weight_grid)) {
        keys.weight_grid = None;
    }
}
