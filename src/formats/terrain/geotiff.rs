//! GeoTIFF: the first image of a TIFF with the keys of OGC GeoTIFF 1.1, over latitude and longitude of WGS 84.

use super::{RasterFileError, from_the_south};
use crate::ground::Raster;
use crate::printable::printable;
use std::io::Cursor;
use tiff::TiffError;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

/// Most bytes of the heights.
const MOST_BYTES: usize = 1 << 30;

// Keys of the directory, OGC 19-008r4, 7.4 and annex B.
const MODEL_TYPE: u16 = 1024;
const RASTER_TYPE: u16 = 1025;
const GEODETIC_CRS: u16 = 2048;
const VERTICAL_CRS: u16 = 4096;
const VERTICAL_UNITS: u16 = 4099;
/// Model type: latitude and longitude.
const GEOGRAPHIC: u16 = 2;
/// Raster type: heights at points, and not the mean of areas.
const PIXEL_IS_POINT: u16 = 2;
/// WGS 84, two- and three-dimensional.
const WGS_84: [u16; 2] = [4326, 4979];
/// Metre.
const METRE: u16 = 9001;
/// Vertical references that are the ellipsoid of WGS 84: its three-dimensional code, and the old one of its heights.
const ELLIPSOIDAL: [u16; 2] = [4979, 5030];

/// Whether a file begins as TIFF or BigTIFF.
pub(super) fn is_tiff(bytes: &[u8]) -> bool {
    [&b"II*\0"[..], b"MM\0*", b"II+\0", b"MM\0+"]
        .iter()
        .any(|magic| bytes.starts_with(magic))
}

fn error(reason: impl Into<String>) -> RasterFileError {
    RasterFileError::GeoTiff(reason.into())
}

fn unreadable(failure: &TiffError) -> RasterFileError {
    error(printable(&failure.to_string()).into_owned())
}

/// The image and what its tags say about it.
struct Image<'a> {
    decoder: Decoder<Cursor<&'a [u8]>>,
    /// Key and value of the short keys.
    keys: Vec<(u16, u16)>,
}

/// The raster, and a note on heights over a geoid.
pub(super) fn read(bytes: &[u8]) -> Result<(Raster, Option<String>), RasterFileError> {
    let mut limits = Limits::default();
    limits.decoding_buffer_size = MOST_BYTES;
    limits.intermediate_buffer_size = MOST_BYTES;
    let decoder = Decoder::new(Cursor::new(bytes)).map_err(|failure| unreadable(&failure))?;
    let mut image = Image {
        decoder: decoder.with_limits(limits),
        keys: Vec::new(),
    };
    image.keys = image.short_keys()?;
    let note = image.check_reference()?;
    let (corner, step) = image.lattice()?;
    let (width, _) = image
        .decoder
        .dimensions()
        .map_err(|failure| unreadable(&failure))?;
    let heights = image.heights()?;
    let columns = width as usize;
    let raster = Raster::new(corner, step, columns, from_the_south(&heights, columns))?;
    Ok((raster, note))
}

impl Image<'_> {
    fn short_keys(&mut self) -> Result<Vec<(u16, u16)>, RasterFileError> {
        let directory = self
            .decoder
            .find_tag_unsigned_vec::<u16>(Tag::GeoKeyDirectoryTag);
        let directory = directory.map_err(|failure| unreadable(&failure))?;
        let directory = directory.ok_or_else(|| {
            error("it has no keys (GeoKeyDirectoryTag), so that its coordinates are unknown; write EPSG:4326 into it (gdal_edit -a_srs EPSG:4326)")
        })?;
        let entries = directory.chunks_exact(4).skip(1);
        // Values in other tags are numbers and texts, none of which is needed.
        let short = entries.filter(|entry| entry[1] == 0);
        Ok(short.map(|entry| (entry[0], entry[3])).collect())
    }

    fn key(&self, wanted: u16) -> Option<u16> {
        let found = self.keys.iter().find(|(key, _)| *key == wanted);
        found.map(|(_, value)| *value)
    }

    /// Refuses other coordinates than latitude and longitude of WGS 84, and other units than the metre; a note on heights over
    /// a geoid.
    fn check_reference(&self) -> Result<Option<String>, RasterFileError> {
        let crs = self.key(GEODETIC_CRS);
        if self.key(MODEL_TYPE) != Some(GEOGRAPHIC) || !crs.is_some_and(|crs| WGS_84.contains(&crs))
        {
            let found = match (self.key(MODEL_TYPE), crs, self.key(3072)) {
                (Some(1), _, Some(projected)) => format!("the projection EPSG:{projected}"),
                (_, Some(crs), _) => format!("EPSG:{crs}"),
                _ => "coordinates without a code".to_owned(),
            };
            return Err(error(format!(
                "found {found}, expected latitude and longitude of WGS 84, EPSG:4326 (gdalwarp -t_srs EPSG:4326 converts it)"
            )));
        }
        if let Some(units) = self.key(VERTICAL_UNITS).filter(|units| *units != METRE) {
            return Err(error(format!(
                "heights are in the unit EPSG:{units}, expected metres (EPSG:{METRE})"
            )));
        }
        let vertical = self
            .key(VERTICAL_CRS)
            .filter(|vertical| !ELLIPSOIDAL.contains(vertical));
        Ok(vertical.map(|vertical| {
            let name = match vertical {
                5773 => "the geoid EGM96, ",
                3855 => "the geoid EGM2008, ",
                _ => "",
            };
            format!(
                "its heights are over {name}EPSG:{vertical}, and are taken as heights over the ellipsoid: points are off by the \
                 height of the geoid, up to 107 m, their skylines by less than 0.01°"
            )
        }))
    }

    fn numbers(&mut self, tag: Tag) -> Result<Option<Vec<f64>>, RasterFileError> {
        let value = self
            .decoder
            .find_tag(tag)
            .map_err(|failure| unreadable(&failure))?;
        let numbers = value.map(|value| value.into_f64_vec()).transpose();
        numbers.map_err(|failure| unreadable(&failure))
    }

    /// The middle of the south-western cell and the steps, northwards and eastwards, degrees.
    fn lattice(&mut self) -> Result<([f64; 2], [f64; 2]), RasterFileError> {
        let (scale, tie) = (
            self.numbers(Tag::ModelPixelScaleTag)?,
            self.numbers(Tag::ModelTiepointTag)?,
        );
        let (Some([east_step, north_step, ..]), Some([column, row, _, east, north, ..])) =
            (scale.as_deref(), tie.as_deref())
        else {
            return Err(error(
                "it has no ModelPixelScaleTag and ModelTiepointTag; a rotated image is not supported",
            ));
        };
        let (_, height) = self
            .decoder
            .dimensions()
            .map_err(|failure| unreadable(&failure))?;
        // The tie point is a corner of an area, or a point.
        let half = if self.key(RASTER_TYPE) == Some(PIXEL_IS_POINT) {
            0.0
        } else {
            0.5
        };
        let west = east + (half - column) * east_step;
        let south = north - (f64::from(height) - 1.0 + half - row) * north_step;
        Ok(([south, west], [*north_step, *east_step]))
    }

    /// Row by row from the north, m; NaN in a hole.
    fn heights(&mut self) -> Result<Vec<f32>, RasterFileError> {
        let nodata = self.decoder.find_tag(Tag::GdalNodata);
        let nodata = nodata.map_err(|failure| unreadable(&failure))?;
        let nodata = nodata.and_then(|text| text.into_string().ok());
        let nodata = nodata.and_then(|text| text.trim_end_matches('\0').trim().parse::<f64>().ok());
        let (width, height) = self
            .decoder
            .dimensions()
            .map_err(|failure| unreadable(&failure))?;
        let read = self
            .decoder
            .read_image()
            .map_err(|failure| unreadable(&failure))?;
        let metres: Vec<f64> = match read {
            DecodingResult::U8(values) => values.into_iter().map(f64::from).collect(),
            DecodingResult::U16(values) => values.into_iter().map(f64::from).collect(),
            DecodingResult::U32(values) => values.into_iter().map(f64::from).collect(),
            DecodingResult::I8(values) => values.into_iter().map(f64::from).collect(),
            DecodingResult::I16(values) => values.into_iter().map(f64::from).collect(),
            DecodingResult::I32(values) => values.into_iter().map(f64::from).collect(),
            DecodingResult::F32(values) => values.into_iter().map(f64::from).collect(),
            DecodingResult::F64(values) => values,
            _ => return Err(error("its numbers are of a kind that is not supported")),
        };
        if metres.len() as u64 != u64::from(width) * u64::from(height) {
            return Err(error("it has several bands, expected one"));
        }
        // Files of single precision name the value in more digits.
        let is_hole = |metre: f64| {
            !metre.is_finite()
                || nodata.is_some_and(|nodata| metre == nodata || metre as f32 == nodata as f32)
        };
        let height = |metre: f64| {
            if is_hole(metre) {
                f32::NAN
            } else {
                metre as f32
            }
        };
        Ok(metres.into_iter().map(height).collect())
    }
}
