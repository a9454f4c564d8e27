//! The terrain on which points stand.

use crate::scenario::keys::{key, section};
use crate::scenario::problem::Fault;
use crate::scenario::reader::Reader;
use crate::scenario::rule::{Number, Optional, Text};

/// Height of an antenna over the terrain without a key, m: a receiver on a pole.
const ANTENNA_M: f64 = 2.0;

section! {
    /// The terrain on which the points of a region stand, if any.
    #[derive(Debug, Clone, PartialEq)]
    pub struct RegionTerrain in "region", finish finish_terrain {
        /// File of heights on latitude and longitude (GeoTIFF, ESRI ASCII grid or CSV), from which every point without a skyline
        /// of its own gets one, and every point without a height its height; path relative to this file.
        pub terrain: Option<String> = Optional(Text::Any), follows "none", example Some("terrain.tif".to_owned());
        /// Height over the terrain of the points that have none of their own.
        pub antenna_height_m: Option<f64> = Optional(Number::from_to(0.0, 1000.0)), unit "m",
            follows "2 m with a terrain", example Some(ANTENNA_M);
    }
}

fn finish_terrain(keys: &mut RegionTerrain, reader: &mut Reader<'_>) {
    let (terrain, antenna) = (
        key!(RegionTerrain.terrain),
        key!(RegionTerrain.antenna_height_m),
    );
    if reader.is_given(terrain) {
        if !reader.is_given(antenna) {
            keys.antenna_height_m = Some(ANTENNA_M);
        }
        return;
    }
    keys.terrain = None;
    if reader.is_given(antenna) {
        let (quantity, needs) = (
            "a height over the terrain".to_owned(),
            format!("`{terrain}`"),
        );
        reader.refuse(&[antenna], Fault::Needs { quantity, needs });
    }
    keys.antenna_height_m = None;
}
