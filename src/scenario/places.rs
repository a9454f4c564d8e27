//! The points of a scenario: where they are, what they stand on, and their skylines.

use super::setup::SetupError;
use super::{AreaSource, Region, Scenario};
use crate::formats::terrain::{terrain, weights};
use crate::ground::{
    Country, GroundError, RegionMap, ServiceArea, Site, sites_from_csv, with_inline_skylines,
};
use std::io;

/// A path relative to the directory of a file.
fn beside(file: &str, path: &str) -> String {
    match file.rsplit_once('/') {
        Some((directory, _)) if !path.starts_with('/') => format!("{directory}/{path}"),
        _ => path.to_owned(),
    }
}

impl Scenario {
    /// The contents of a file, among [`Scenario::files`], that stand alone: the sites of a points file with the skylines
    /// that they name by paths relative to it, which `read` takes relative to the scenario.
    ///
    /// # Errors
    /// If a skyline cannot be read.
    pub fn standing_alone(
        &self,
        file: &str,
        bytes: Vec<u8>,
        read: &dyn Fn(&str) -> io::Result<Vec<u8>>,
    ) -> Result<Vec<u8>, SetupError> {
        match &self.region {
            Region::Points { file: points } if points == file => {}
            _ => return Ok(bytes),
        }
        let inline = with_inline_skylines(&bytes, &|skyline| read(&beside(file, skyline)));
        let inline = inline.map_err(|source| SetupError::Points {
            file: file.to_owned(),
            source,
        })?;
        Ok(inline.unwrap_or(bytes))
    }

    /// The ground points, and what they look like on a map.
    pub(super) fn region(
        &self,
        read: &dyn Fn(&str) -> io::Result<Vec<u8>>,
    ) -> Result<(Vec<Site>, RegionMap), SetupError> {
        let surface = self.earth.surface;
        match &self.region {
            Region::Grid(grid) => Ok((grid.sites(surface)?, RegionMap::of_grid(grid))),
            Region::Cells(cells) => {
                Ok((cells.sites(surface)?, RegionMap::of_cells(cells, surface)?))
            }
            Region::Area {
                source: AreaSource::Countries(countries),
                points,
            } => {
                let area = Country::area(countries);
                let map = RegionMap::of_area(&self.region.told(), &area, points, surface)?;
                Ok((points.sites(&area, surface)?, map))
            }
            Region::Area {
                source: AreaSource::Polygon { file },
                points,
            } => {
                let bytes = read(file).map_err(|source| self.unreadable(file, source))?;
                let within = || -> Result<_, GroundError> {
                    let area = ServiceArea::from_geojson(&bytes)?;
                    // No result contains a path.
                    let map = RegionMap::of_area("polygons", &area, points, surface)?;
                    Ok((points.sites(&area, surface)?, map))
                };
                within().map_err(|source| SetupError::Polygon {
                    file: file.clone(),
                    source,
                })
            }
            Region::Points { file } => {
                let bytes = read(file).map_err(|source| self.unreadable(file, source))?;
                let bytes = self.standing_alone(file, bytes, read)?;
                let sites = sites_from_csv(bytes.as_slice(), surface);
                let sites = sites.map_err(|source| SetupError::Points {
                    file: file.clone(),
                    source,
                })?;
                Ok((sites, RegionMap::default()))
            }
        }
    }

    /// Weights the points by a grid of counts, if there is one; a note on those that are left out for want of any.
    pub(super) fn weigh(
        &self,
        sites: &mut Vec<Site>,
        map: &mut RegionMap,
        read: &dyn Fn(&str) -> io::Result<Vec<u8>>,
    ) -> Result<Option<String>, SetupError> {
        let Some(file) = &self.weighting.weight_grid else {
            return Ok(None);
        };
        let bytes = read(file).map_err(|source| self.unreadable(file, source))?;
        let all = sites.len();
        let weighed = weights(&bytes).and_then(|raster| Ok(raster.weigh(sites, map)?));
        let left_out = weighed.map_err(|source| SetupError::WeightGrid {
            file: file.clone(),
            source,
        })?;
        let told = map.told.trim_end_matches("; point weights equal");
        map.told = format!("{told}; weighted by a grid of counts");
        Ok((left_out > 0).then(|| {
            format!("region.weight-grid: {file}: {left_out} of {all} points have no weight and are left out")
        }))
    }

    /// Puts the points on the terrain, if there is one, and returns what there is to know about it.
    pub(super) fn stand_on_terrain(
        &self,
        sites: &mut [Site],
        read: &dyn Fn(&str) -> io::Result<Vec<u8>>,
    ) -> Result<Option<String>, SetupError> {
        let Some(file) = &self.terrain.terrain else {
            return Ok(None);
        };
        let bytes = read(file).map_err(|source| self.unreadable(file, source))?;
        let antenna_m = self.terrain.antenna_height_m.unwrap_or_default();
        let error = |source| SetupError::Terrain {
            file: file.clone(),
            source,
        };
        let found = terrain(&bytes).map_err(error)?;
        let carried = found.terrain.carry(sites, self.earth.surface, antenna_m);
        let end_km = carried.map_err(|source| error(source.into()))?;
        let end = end_km.map(|end_km| {
            format!(
                "it ends {end_km:.0} km from a point, where higher ground could still be in sight"
            )
        });
        let notes: Vec<String> = found.note.into_iter().chain(end).collect();
        Ok((!notes.is_empty()).then(|| format!("region.terrain: {file}: {}", notes.join("; "))))
    }
}
