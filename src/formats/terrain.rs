//! Terrain from files: ESRI ASCII grids, GeoTIFF, and CSV tables of heights.

mod ascii_grid;
mod geotiff;
mod table;

use crate::ground::{Terrain, TerrainError};
use thiserror::Error;

/// Why a file is not a terrain.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TerrainFileError {
    /// None of the formats.
    #[error(
        "the format is unknown: expected GeoTIFF, an ESRI ASCII grid (begins with ncols) or CSV with the columns latitude_deg, \
         longitude_deg and height_m"
    )]
    Unknown,
    /// A line that cannot be read.
    #[error("line {line}: {reason}")]
    Line {
        /// Line, from 1.
        line: usize,
        /// What is wrong with it.
        reason: String,
    },
    /// A GeoTIFF that is not one of heights over latitude and longitude.
    #[error("GeoTIFF: {0}")]
    GeoTiff(String),
    /// Nodes that are not those of a lattice.
    #[error("the points are not a regular lattice of latitude and longitude: {0}")]
    Irregular(String),
    /// What the file describes is not a terrain.
    #[error(transparent)]
    Terrain(#[from] TerrainError),
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
/// If the format is unknown, the file cannot be read, or its coordinates are not latitude and longitude of WGS 84.
pub fn terrain(bytes: &[u8]) -> Result<TerrainFile, TerrainFileError> {
    if geotiff::is_tiff(bytes) {
        return geotiff::read(bytes);
    }
    let text = std::str::from_utf8(bytes).map_err(|_| TerrainFileError::Unknown)?;
    let text = text.trim_start_matches('\u{feff}');
    let terrain = if ascii_grid::is_ascii_grid(text) {
        ascii_grid::read(text)?
    } else if text.lines().next().is_some_and(table::is_header) {
        table::read(text)?
    } else {
        return Err(TerrainFileError::Unknown);
    };
    let note = None;
    Ok(TerrainFile { terrain, note })
}

/// Rows from the north, as files have them, turned round.
fn from_the_south(heights_m: &[f32], columns: usize) -> Vec<f32> {
    let rows = heights_m.chunks_exact(columns.max(1)).rev();
    rows.flatten().copied().collect()
}

#[cfg(test)]
mod tests;
