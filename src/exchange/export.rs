//! An export: the files of the products that are asked for, and the manifest that names them.

mod products;
mod rebuilt;
mod scenes;
mod source;

use crate::constellation::Design;
use crate::constellation::gnss::Preset;
use crate::exchange::manifest::{
    ExportedStudy, FILE_NAME, FileEntry, HashingWriter, Loss, Manifest,
};
use crate::formats::WriteError;
use crate::formats::ccsds::CcsdsVersion;
use crate::formats::ccsds::{oem, omm};
use crate::formats::maps::scene::Scene;
use crate::formats::metadata::{ElementChoice, Metadata};
use crate::formats::sp3;
use crate::formats::text::timestamp::TimeSystem;
use crate::frames::Frame;
use crate::keyword::{Keyword, keywords};
use crate::orbit::Model;
use crate::time::{Epoch, TimeGrid};
use source::ExportSource;
use std::io::{self, BufWriter, Write};

keywords! {
    /// What can be asked of an export.
    Product {
        /// Two-line element sets with names, one file.
        Tle = "tle",
        /// CCSDS Orbit Mean-Elements Messages in the notation of the choice.
        Omm = "omm",
        /// States that SGP4 gives for the element sets as written, for comparing another SGP4.
        TleStates = "tle-states",
        /// CCSDS Orbit Ephemeris Messages, one file for each satellite or one of all.
        Oem = "oem",
        /// CCSDS Orbit Parameter Messages, one file for each satellite: the state at the epoch.
        Opm = "opm",
        /// SP3 in GPS time, files of up to 99 satellites (85 in SP3-c), and of GNSS by choice.
        Sp3 = "sp3",
        /// STK ephemerides, one file for each satellite, and with a scenario its Connect commands.
        Stk = "stk",
        /// Tables of mean elements and of states.
        Csv = "csv",
        /// Tables of the metrics by ground point and by instant.
        Metrics = "metrics",
        /// CZML: satellites, orbits and region for CesiumJS.
        Czml = "czml",
        /// GeoJSON: region with metrics, ground tracks, footprints.
        Geojson = "geojson",
        /// KML: the same for Google Earth.
        Kml = "kml",
        /// GMAT: a script that propagates the design under J2 alone.
        Gmat = "gmat",
        /// YUMA almanacs of the nominal GNSS.
        Yuma = "yuma",
    }
}

/// Where the files of an export go: gives a writer for a path relative to the manifest, with `/`.
///
/// Files are written by several threads at once.
pub trait Sink: Sync {
    /// What takes the bytes of a file.
    type File: Write;

    /// Begins a file.
    ///
    /// # Errors
    /// When the file cannot be begun.
    fn create(&self, path: &str) -> io::Result<Self::File>;
}

impl<W: Write, F: Fn(&str) -> io::Result<W> + Sync> Sink for F {
    type File = W;

    fn create(&self, path: &str) -> io::Result<W> {
        self(path)
    }
}

/// The study that is exported.
#[derive(Debug, Clone)]
pub struct ExportSubject {
    /// The design.
    pub design: Design,
    /// What it propagates by.
    pub model: Model,
    /// The instants of sampled products; its epoch is that of the elements.
    pub grid: TimeGrid,
    /// The scenario.
    pub study: ExportedStudy,
    /// Who makes the files.
    pub originator: String,
    /// When the files say that they were made.
    pub creation: Epoch,
}

/// What the products leave open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Choices {
    /// Frame of the OEM, the OPM and the STK ephemerides.
    pub frame: Frame,
    /// Time system of the OEM and the OPM.
    pub time_system: TimeSystem,
    /// Version of the CCSDS messages.
    pub ccsds_version: CcsdsVersion,
    /// Notation of the OMM.
    pub omm: omm::OmmSyntax,
    /// Notation of the OEM.
    pub oem: oem::OemSyntax,
    /// Whether the OEM of all satellites make one file, which XML allows.
    pub oem_combined: bool,
    /// How element sets are made from the design.
    pub elements: ElementChoice,
    /// Version of SP3.
    pub sp3_version: sp3::Sp3Version,
    /// Letter of the SP3 ids.
    pub sp3_letter: char,
    /// For each of [`Preset::ALL`], whether SP3 gets a file of that constellation too.
    pub sp3_gnss: [bool; Preset::ALL.len()],
}

impl Default for Choices {
    fn default() -> Self {
        Self {
            frame: Frame::Eme2000,
            time_system: TimeSystem::Utc,
            ccsds_version: CcsdsVersion::V2,
            omm: omm::OmmSyntax::Kvn,
            oem: oem::OemSyntax::Kvn,
            oem_combined: false,
            elements: ElementChoice::Kozai,
            sp3_version: sp3::Sp3Version::D,
            sp3_letter: 'L',
            sp3_gnss: [false; Preset::ALL.len()],
        }
    }
}

/// Writes the products and then the manifest, which it also returns.
///
/// # Errors
/// When a satellite cannot be propagated or named, an element does not fit its format, a file
/// cannot be written, or a product needs the scenario.
pub fn export(
    subject: &ExportSubject,
    products: &[Product],
    choices: Choices,
    sink: &impl Sink,
) -> Result<Manifest, WriteError> {
    export_scene(subject, None, (products, choices), sink)
}

/// Like [`export`], with the scenario around the design for the products that show it.
///
/// # Errors
/// As [`export`], and when the scenario does not fit a format.
pub fn export_scene(
    subject: &ExportSubject,
    scene: Option<&Scene<'_>>,
    (products, choices): (&[Product], Choices),
    sink: &impl Sink,
) -> Result<Manifest, WriteError> {
    let source = ExportSource::new(subject, choices)?;
    let files = Files { sink };
    let mut entries = Vec::new();
    for product in products {
        let lacking = || WriteError::NoScene(product.keyword());
        entries.extend(match product {
            Product::Tle => source.tle(&files)?,
            Product::Omm => source.omm(&files)?,
            Product::TleStates => source.tle_states(&files)?,
            Product::Oem => source.oem(&files)?,
            Product::Opm => source.opm(&files)?,
            Product::Sp3 => source.sp3(&files)?,
            Product::Stk => source.stk_with(&files, scene)?,
            Product::Csv => source.csv(&files)?,
            Product::Metrics => source.metrics(&files, scene.ok_or_else(lacking)?)?,
            Product::Czml => source.czml(&files, scene.ok_or_else(lacking)?)?,
            Product::Geojson => source.geojson(&files, scene.ok_or_else(lacking)?)?,
            Product::Kml => source.kml(&files, scene.ok_or_else(lacking)?)?,
            Product::Gmat => source.gmat(&files)?,
            Product::Yuma => source.yuma(&files, scene.ok_or_else(lacking)?)?,
        });
    }
    let manifest = source.manifest(entries);
    let mut out = BufWriter::new(sink.create(FILE_NAME)?);
    manifest.write(&mut out)?;
    out.flush()?;
    Ok(manifest)
}

/// Where the products of an export write to.
struct Files<'a, S> {
    sink: &'a S,
}

/// What a product writes to: every byte is hashed on its way.
type Out<S> = BufWriter<HashingWriter<<S as Sink>::File>>;

impl<S: Sink> Files<'_, S> {
    /// Writes one file; its entry has the loss that `write` finds.
    fn add(
        &self,
        path: &str,
        (product, version): (Product, &str),
        (objects, metadata): (usize, &Metadata),
        write: impl FnOnce(&mut Out<S>) -> Result<Loss, WriteError>,
    ) -> Result<FileEntry, WriteError> {
        let mut out = BufWriter::new(HashingWriter::new(self.sink.create(path)?));
        let loss = write(&mut out)?;
        let hashing = out.into_inner().map_err(io::IntoInnerError::into_error)?;
        let sha256 = hashing.finish()?;
        let format = (product.keyword(), version);
        Ok(FileEntry::new(
            path, format, objects, metadata, loss, sha256,
        ))
    }
}

#[cfg(test)]
pub(crate) mod testing;
#[cfg(test)]
mod tests;
