//! Formats that viewers and geographic information systems draw, and the scene that they share.

pub mod czml;
pub mod geojson;
pub mod kml;
pub(crate) mod palette;
pub mod scene;
pub mod tracks;
