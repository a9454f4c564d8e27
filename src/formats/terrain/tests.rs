use super::*;
use crate::earth::Surface;
use crate::ground::{Grid, PointWeights, RegionMap, Site};
use std::io::Cursor;
use tiff::encoder::{TiffEncoder, colortype::Gray32Float};
use tiff::tags::Tag;

/// Three rows from the north, two columns, cells of 0.5°, the south-western middle at 10° N 20° E.
const HEIGHTS: [f32; 6] = [1.0, 2.0, 3.0, 4.5, 5.0, -6.0];

const GRID: &str = "ncols 2\nNROWS 3\nxllcorner 19.75\nyllcorner 9.75\ncellsize 0.5\nNODATA_value -9999\n1 2\n3 4.5\n5 -6\n";

fn expected() -> Terrain {
    let heights = vec![5.0, -6.0, 3.0, 4.5, 1.0, 2.0];
    let raster = Raster::new([10.0, 20.0], [0.5, 0.5], 2, heights);
    Terrain::new(raster.unwrap()).unwrap()
}

fn read(text: &str) -> Result<Terrain, String> {
    let found = terrain(text.as_bytes()).map(|file| file.terrain);
    found.map_err(|error| error.to_string())
}

#[test]
fn grids_and_tables_are_the_same_terrain() {
    assert_eq!(read(GRID), Ok(expected()));
    let centres = GRID
        .replace("xllcorner 19.75", "xllcenter 20")
        .replace("yllcorner 9.75", "YLLCENTER 10");
    assert_eq!(read(&centres), Ok(expected()));
    let steps = GRID
        .replace("cellsize 0.5", "dx 0.5\ndy 0.5")
        .replace("1 2\n3 4.5\n", "1 2 3\n4.5\n");
    assert_eq!(read(&steps), Ok(expected()));
    let table = "\u{feff}height_m, latitude_deg,longitude_deg\r\n4.5,10.5,20.5\r\n5,10,20\r\n-6,10,20.5\r\n3,10.5,20\r\n\r\n1,11,20\r\n2,11,20.5\r\n";
    assert_eq!(read(table), Ok(expected()));
    // A hole is a hole in each.
    let on = |terrain: Terrain| {
        let mut sites = [Site::new(Surface::Wgs84, 10.9, 20.1, 1.0).unwrap()];
        terrain
            .carry(&mut sites, Surface::Wgs84, 2.0)
            .unwrap_err()
            .to_string()
    };
    for text in [
        GRID.replace("1 2", "-9999 2"),
        table.replace("1,11,20", ",11,20"),
    ] {
        assert!(on(read(&text).unwrap()).contains("has a hole (NODATA)"));
    }
}

#[test]
fn what_is_no_terrain_is_told() {
    let table = "latitude_deg,longitude_deg,height_m\n0,0,1\n0,1,1\n1,0,1\n1,1,1\n";
    for (text, expected) in [
        ("", "the format is unknown"),
        ("a,b\n", "the format is unknown"),
        (
            &GRID.replace("4.5", "x"),
            "line 8: found \"x\", expected a number",
        ),
        (
            &GRID.replace("5 -6\n", "5\n"),
            "line 9: the file ends after 5 heights, expected 3 x 2",
        ),
        (
            &GRID.replace("5 -6", "5 -6 7"),
            "line 9: more than 3 x 2 heights",
        ),
        (
            &GRID.replace("cellsize 0.5\n", ""),
            "line 8: cellsize is missing from the header",
        ),
        (
            &GRID.replace("ncols 2\n", ""),
            "line 6: ncols is missing from the header",
        ),
        (
            &GRID.replace("ncols 2", "ncols 1e9"),
            "line 7: ncols: 1000000000 is not a whole number from 2 to 1000000",
        ),
        (
            &GRID.replace("cellsize", "cells"),
            "line 5: unknown key cells",
        ),
        (
            &GRID.replace("19.75", "399960"),
            "latitudes 10 to 11 and longitudes 399960.25 to 399960.75 are not degrees on the globe",
        ),
        (
            &GRID
                .replace("NODATA_value -9999\n", "")
                .replace("1 2", "1 -9999"),
            "height -9999 m at latitude 11, longitude 20.5 is outside",
        ),
        (
            &table.replace("1,1,1", "1,0,1"),
            "the points are not a regular lattice of latitude and longitude: latitude 1, longitude 0 is given twice",
        ),
        (
            &table.replace("1,1,1", "1,0.7,1"),
            "the points are not a regular lattice",
        ),
        (
            &table.replace("1,1,1\n", ""),
            "the points are not a regular lattice of latitude and longitude: found 3 points, expected 2 x 2",
        ),
        (
            &table.replace("1,0,1", "1,,1"),
            "line 4: longitude_deg: found \"\", expected a number",
        ),
        (
            &table.replace("height_m", "height"),
            "line 1: there is no column height_m",
        ),
        (
            "latitude_deg,longitude_deg,height_m\n1,1,1\n",
            "the points are not a regular lattice of latitude and longitude: there is one latitude_deg only, 1",
        ),
    ] {
        let found = read(text).unwrap_err();
        assert!(found.starts_with(expected), "{found}");
    }
}

/// A GeoTIFF with some keys (after the version), and perhaps a value of missing heights.
fn geotiff(keys: &[[u16; 4]], tie: [f64; 6], nodata: Option<&str>) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes).unwrap();
    let mut image = encoder.new_image::<Gray32Float>(2, 3).unwrap();
    let mut directory = vec![1, 1, 0, keys.len() as u16];
    directory.extend(keys.iter().flatten());
    let tags = image.encoder();
    tags.write_tag(Tag::GeoKeyDirectoryTag, directory.as_slice())
        .unwrap();
    tags.write_tag(Tag::ModelPixelScaleTag, [0.5, 0.5, 0.0].as_slice())
        .unwrap();
    tags.write_tag(Tag::ModelTiepointTag, tie.as_slice())
        .unwrap();
    if let Some(nodata) = nodata {
        tags.write_tag(Tag::GdalNodata, nodata).unwrap();
    }
    image.write_data(&HEIGHTS).unwrap();
    bytes.into_inner()
}

const GEOGRAPHIC: [u16; 4] = [1024, 0, 1, 2];
const AREA: [u16; 4] = [1025, 0, 1, 1];
const WGS_84: [u16; 4] = [2048, 0, 1, 4326];
const TIE: [f64; 6] = [0.0, 0.0, 0.0, 19.75, 11.25, 0.0];

#[test]
fn geotiff_is_the_same_terrain() {
    let area = terrain(&geotiff(&[GEOGRAPHIC, AREA, WGS_84], TIE, None)).unwrap();
    assert_eq!((area.terrain, area.note), (expected(), None));
    let point = [0.0, 0.0, 0.0, 20.0, 11.0, 0.0];
    let point = geotiff(&[GEOGRAPHIC, [1025, 0, 1, 2], WGS_84], point, None);
    assert_eq!(terrain(&point).unwrap().terrain, expected());
    let middle = [1.0, 2.0, 0.0, 20.25, 10.25, 0.0];
    let middle = geotiff(&[GEOGRAPHIC, AREA, WGS_84], middle, None);
    assert_eq!(terrain(&middle).unwrap().terrain, expected());
    let geoid = geotiff(&[GEOGRAPHIC, AREA, WGS_84, [4096, 0, 1, 3855]], TIE, None);
    let note = terrain(&geoid).unwrap().note.unwrap();
    assert!(
        note.starts_with("its heights are over the geoid EGM2008, EPSG:3855"),
        "{note}"
    );
    let holed = geotiff(&[GEOGRAPHIC, AREA, WGS_84], TIE, Some("-6"));
    assert!(terrain(&holed).unwrap().terrain.told().ends_with("1 hole"));
}

#[test]
fn geotiff_of_another_datum_is_refused() {
    let error = |keys: &[[u16; 4]]| terrain(&geotiff(keys, TIE, None)).unwrap_err().to_string();
    for (keys, expected) in [
        (
            &[GEOGRAPHIC, AREA, [2048, 0, 1, 4269]][..],
            "GeoTIFF: found EPSG:4269, expected latitude and longitude of WGS 84",
        ),
        (
            &[[1024, 0, 1, 1], AREA, [3072, 0, 1, 32632]],
            "GeoTIFF: found the projection EPSG:32632",
        ),
        (&[AREA], "GeoTIFF: found coordinates without a code"),
        (
            &[GEOGRAPHIC, AREA, WGS_84, [4099, 0, 1, 9002]],
            "GeoTIFF: heights are in the unit EPSG:9002, expected metres",
        ),
    ] {
        let found = error(keys);
        assert!(found.starts_with(expected), "{found}");
    }
    let whole = geotiff(&[GEOGRAPHIC, AREA, WGS_84], TIE, None);
    for cut in 0..whole.len() {
        // Cut anywhere it is an error or, where only padding is lost, the terrain; never a panic.
        if let Ok(file) = terrain(&whole[..cut]) {
            assert_eq!(file.terrain, expected());
        }
    }
}

/// Any bytes: what is accepted carries a point and weights a region, or says why not, without a number that is none.
fn survives(bytes: &[u8]) {
    if let Ok(file) = terrain(bytes) {
        let mut sites = [Site::new(Surface::Wgs84, 10.4, 20.2, 1.0).unwrap()];
        if file.terrain.carry(&mut sites, Surface::Wgs84, 2.0).is_ok() {
            assert!(sites[0].height_m.is_finite());
            let highest = sites[0]
                .skyline
                .as_ref()
                .map(|skyline| skyline.highest_deg());
            assert!(highest.is_none_or(|degrees| (0.0..90.0).contains(&degrees)));
        }
    }
    if let Ok(raster) = weights(bytes) {
        let grid = Grid {
            latitude_deg: [-90.0, 90.0],
            longitude_deg: [-180.0, 180.0],
            step_deg: [30.0, 30.0],
            weights: PointWeights::Equal,
        };
        let mut sites = grid.sites(Surface::Wgs84).unwrap();
        if raster.weigh(&mut sites, &RegionMap::of_grid(&grid)).is_ok() {
            assert!(
                sites
                    .iter()
                    .all(|site| site.weight > 0.0 && site.weight.is_finite())
            );
        }
    }
}

/// Files that are cut, and files with a byte exchanged, in all three formats.
#[test]
fn damaged_rasters_are_refused_or_sound() {
    let table =
        "latitude_deg,longitude_deg,height_m,weight\n10,20,1,1\n10,21,2,2\n11,20,3,3\n11,21,,4\n";
    let keys = [[1024, 0, 1, 2], [1025, 0, 1, 1], [2048, 0, 1, 4326]];
    let image = geotiff(&keys, [0.0, 0.0, 0.0, 19.75, 11.25, 0.0], Some("-6"));
    for bytes in [GRID.as_bytes(), table.as_bytes(), &image] {
        assert!(weights(bytes).is_ok());
        for at in 0..bytes.len() {
            survives(&bytes[..at]);
            for byte in *b"\0-9e\n\xff" {
                let mut damaged = bytes.to_vec();
                damaged[at] = byte;
                survives(&damaged);
            }
        }
    }
    // A table has its values in the column of what it is read for.
    assert!(weights(table.replace("weight", "people").as_bytes()).is_err());
    assert!(terrain(table.replace("height_m", "people").as_bytes()).is_err());
}
