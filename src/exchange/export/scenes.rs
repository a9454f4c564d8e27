//! The products that show or reproduce a complete scenario.

use super::products::ProductFiles;
use super::source::ExportSource;
use super::{Contents, Files, Product, ProductVersion};
use crate::exchange::manifest::Loss;
use crate::formats::maps::scene::{MAX_SHOWN_POINTS, Scene};
use crate::formats::maps::tracks::Ground;
use crate::formats::maps::{czml, geojson, kml};
use crate::formats::{WriteError, csv};
use crate::frames::Frame;
use crate::keyword::Keyword;

impl ExportSource<'_> {
    pub(super) fn metrics(&self, files: &Files<'_>, scene: &Scene<'_>) -> ProductFiles {
        let metadata = self.propagated_metadata(Frame::EarthFixed);
        let contents = Contents {
            objects: 0,
            metadata: &metadata,
        };
        let format = ProductVersion {
            product: Product::Metrics,
            version: "1",
        };
        let series = scene.series()?;
        let points = files.add("metrics/points.csv", format, contents, |out| {
            csv::write_records(out, &series.points)?;
            Ok(Loss::default())
        })?;
        let epochs = files.add("metrics/epochs.csv", format, contents, |out| {
            csv::write_records(out, &series.epochs)?;
            Ok(Loss::default())
        })?;
        let entries = [points, epochs].into_iter();
        Ok(entries
            .map(|entry| entry.assuming(scene.assumptions()))
            .collect())
    }

    pub(super) fn czml(&self, files: &Files<'_>, scene: &Scene<'_>) -> ProductFiles {
        check_points(Product::Czml, scene)?;
        let metadata = self.propagated_metadata(Frame::EarthFixed);
        let contents = Contents {
            objects: self.objects.len(),
            metadata: &metadata,
        };
        let format = ProductVersion {
            product: Product::Czml,
            version: czml::FORMAT_VERSION,
        };
        let entry = files.add("scene.czml", format, contents, |out| {
            let error_km = czml::write(out, scene)?;
            Ok(Loss {
                interpolation_max_km: Some(error_km),
                note: Some(
                    "positions to a decimetre; the file also has the GNSS satellites".to_owned(),
                ),
                ..Loss::default()
            })
        })?;
        Ok(vec![entry.assuming(scene.assumptions())])
    }

    pub(super) fn geojson(&self, files: &Files<'_>, scene: &Scene<'_>) -> ProductFiles {
        let metadata = self.propagated_metadata(Frame::EarthFixed);
        let format = ProductVersion {
            product: Product::Geojson,
            version: geojson::FORMAT_VERSION,
        };
        let noted = |note: &str| Loss {
            note: Some(note.to_owned()),
            ..Loss::default()
        };
        let region = files.add(
            "geojson/region.geojson",
            format,
            Contents {
                objects: 0,
                metadata: &metadata,
            },
            |out| {
                geojson::write_region(out, scene)?;
                Ok(noted(
                    "metrics over the full time span; PDOP over the solved samples",
                ))
            },
        )?;
        let ground = Ground::of(scene)?;
        let contents = Contents {
            objects: ground.len(),
            metadata: &metadata,
        };
        let tracks = files.add("geojson/ground-tracks.geojson", format, contents, |out| {
            geojson::write_tracks(out, &ground)?;
            Ok(noted("one revolution from the epoch"))
        })?;
        let footprints = files.add("geojson/footprints.geojson", format, contents, |out| {
            geojson::write_footprints(out, &ground)?;
            Ok(noted(
                "where each satellite is above visibility.mask-deg at the epoch",
            ))
        })?;
        let entries = [region, tracks, footprints].into_iter();
        Ok(entries
            .map(|entry| entry.assuming(scene.assumptions()))
            .collect())
    }

    pub(super) fn kml(&self, files: &Files<'_>, scene: &Scene<'_>) -> ProductFiles {
        check_points(Product::Kml, scene)?;
        let metadata = self.propagated_metadata(Frame::EarthFixed);
        let ground = Ground::of(scene)?;
        let contents = Contents {
            objects: ground.len(),
            metadata: &metadata,
        };
        let format = ProductVersion {
            product: Product::Kml,
            version: kml::FORMAT_VERSION,
        };
        let entry = files.add("scene.kml", format, contents, |out| {
            kml::write(out, scene, &ground)?;
            Ok(Loss {
                note: Some(
                    "ground tracks are one revolution from the epoch, footprints those of the epoch"
                        .to_owned(),
                ),
                ..Loss::default()
            })
        })?;
        Ok(vec![entry.assuming(scene.assumptions())])
    }
}

fn check_points(product: Product, scene: &Scene<'_>) -> Result<(), WriteError> {
    let points = scene.setup().sites.len();
    if points <= MAX_SHOWN_POINTS {
        return Ok(());
    }
    Err(WriteError::TooManyPoints {
        product: product.keyword(),
        points,
    })
}
