//! Rasters from files, of heights or of weights: ESRI ASCII grids, GeoTIFF, and CSV tables.

mod ascii_grid;
mod geotiff;
mod table;

use crate::ground::{Raster, RasterError, Terrain, TerrainError, WeightingError};
use thiserror::Error;

/// Why a file is not a raster, or not of what it should be.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum RasterFileError {
    /// None of the formats.
    #[error(
        "the format is unknown: expected GeoTIFF, an ESRI ASCII grid (begins with ncols) or CSV with the columns latitude_deg, \
         longitude_deg and {0}"
    )]
    Unknown(&'static str),
    /// A line that cannot be read.
    #[error("line {line}: {reason}")]
    Line {
        /// Line, from 1.
        line: usize,
        /// What is wrong with it.
        reason: String,
    },
    /// A GeoTIFF that is not one of numbers over latitude and longitude.
    #[error("GeoTIFF: {0}")]
    GeoTiff(String),
    /// Nodes that are not those of a lattice.
    #[error("the points are not a regular lattice of latitude and longitude: {0}")]
    Irregular(String),
    /// The values are not on the globe.
    #[error(transparent)]
    Raster(#[from] RasterError),
    /// What the file describes is not a terrain.
    #[error(transparent)]
    Terrain(#[from] TerrainError),
    /// What the file describes does not weight the region.
    #[error(transparent)]
    Weighting(#[from] WeightingError),
}

/// A terrain, and a note on the heights of a file over another surface than the ellipsoid.
#[derive(Debug, Clone, PartialEq)]
pub struct TerrainFile {
    /// The terrain.
    pub terrain: Terrain,
    /// What the reader should know.
    pub note: Option<String>,
}

/// The terrain of a file, by its content: GeoTIFF (EPSG:4326), ESRI ASCII grid or CSV.
///
/// # Errors
/// If the format is unknown, the file cannot be read, its coordinates are not latitude and longitude of WGS 84, or its values
/// are not heights in m.
pub fn terrain(bytes: &[u8]) -> Result<TerrainFile, RasterFileError> {
    let (raster, note) = raster(bytes, "height_m")?;
    let terrain = Terrain::new(raster)?;
    Ok(TerrainFile { terrain, note })
}

/// The raster of a file of weights, in the same formats with the column `weight`.
///
/// # Errors
/// If the format is unknown, the file cannot be read, or its coordinates are not latitude and longitude of WGS 84.
pub fn weights(bytes: &[u8]) -> Result<Raster, RasterFileError> {
    Ok(raster(bytes, "weight")?.0)
}

/// The raster of a file, whose values a table has in a column, and a note on its reference.
fn raster(bytes: &[u8], column: &'static str) -> Result<(Raster, Option<String>), RasterFileError> {
    if geotiff::is_tiff(bytes) {
        return geotiff::read(bytes);
    }
    let unknown = RasterFileError::Unknown(column);
    let Ok(text) = std::str::from_utf8(bytes) else {
        return Err(unknown);
    };
    let text = text.trim_start_matches('\u{feff}');
    let raster = if ascii_grid::is_ascii_grid(text) {
        ascii_grid::read(text)?
    } else if text.lines().next().is_some_and(table::is_header) {
        table::read(text, column)?
    } else {
        return Err(unknown);
    };
    Ok((raster, None))
}

/// Rows from the north, as files have them, turned round.
fn from_the_south(values: &[f32], columns: usize) -> Vec<f32> {
    let rows = values.chunks_exact(columns.max(1)).rev();
    rows.flatten().copied().collect()
}

#[cfg(test)]
mod tests;
