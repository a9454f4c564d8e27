//! An export: the files of the requested products, and the manifest that lists them.

mod products;
mod scenario_products;
mod scenes;
mod sets;
mod size;
mod source;
mod table;

use crate::constellation::gnss::Preset;
use crate::earth::Surface;
use crate::ephemeris::EphemerisError;
use crate::evaluate::Evaluator;
use crate::exchange::constellation::{Constellation, ConstellationError};
use crate::exchange::manifest::{
    ExportedStudy, FILE_NAME, FileEntry, HashingWriter, Loss, Manifest,
};
use crate::formats::WriteError;
use crate::formats::ccsds::CcsdsVersion;
use crate::formats::ccsds::{oem, omm, opm};
use crate::formats::maps::scene::Scene;
use crate::formats::metadata::{ElementChoice, Metadata};
use crate::formats::sp3;
use crate::formats::text::timestamp::TimeSystem;
use crate::frames::Frame;
use crate::keyword::Keyword;
use crate::orbit::Model;
use crate::time::{Epoch, TimeGrid};
use std::io::{self, BufWriter, Write};
use thiserror::Error;

pub use crate::exchange::identities::Naming;
pub use size::{ExportSize, export_size};
pub use source::ExportSource;
pub use table::{Product, ProductRow};

/// The destination of an export: gives a writer for a path relative to the manifest, with `/`.
///
/// Files are written by several threads at once.
pub trait Sink: Sync {
    /// The writer of a file.
    type File: Write;

    /// Starts a file.
    ///
    /// # Errors
    /// If the file cannot be created.
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
    /// The constellation.
    pub constellation: Constellation,
    /// Places of its satellites that are out of service throughout; no file has them, and the others are called as if they were there.
    pub down: Vec<usize>,
    /// How its satellites are called that have no names or numbers of their own.
    pub naming: Naming,
    /// The model that propagates its shells and mean elements.
    pub model: Model,
    /// The instants of sampled products; its epoch is that of the elements.
    pub grid: TimeGrid,
    /// The scenario.
    pub study: ExportedStudy,
    /// The originator of the files.
    pub originator: String,
    /// The creation date in the files.
    pub creation: Epoch,
    /// Name of the file beside the manifest that says which build and command made the files, if one is written.
    pub provenance: Option<String>,
}

/// Options of the products.
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
    /// Notation of the OPM.
    pub opm: opm::OpmSyntax,
    /// Whether the OEMs of all satellites are combined in one file, which XML allows.
    pub oem_combined: bool,
    /// How element sets are derived from the design.
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
            opm: opm::OpmSyntax::Kvn,
            oem_combined: false,
            elements: ElementChoice::Kozai,
            sp3_version: sp3::Sp3Version::D,
            sp3_letter: 'L',
            sp3_gnss: [false; Preset::ALL.len()],
        }
    }
}

/// The parts of a scenario that a constellation is shown in.
#[derive(Clone, Copy)]
pub struct ShownScenario<'a> {
    /// Evaluates it.
    pub evaluator: &'a Evaluator,
    /// The surface that ground points lie on.
    pub surface: Surface,
}

/// Why there is no export.
#[derive(Debug, Error)]
pub enum ExportError {
    /// The constellation cannot be propagated.
    #[error(transparent)]
    Constellation(#[from] ConstellationError),
    /// A satellite whose file does not cover the study.
    #[error(
        "{name} has no state at {at}: leave it out with --exclude, or export a span that its file covers"
    )]
    Gap {
        /// The satellite.
        name: String,
        /// The first instant without a state.
        at: Epoch,
    },
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

impl From<EphemerisError> for ExportError {
    fn from(error: EphemerisError) -> Self {
        Self::Write(error.into())
    }
}

/// The request for an export.
#[derive(Clone, Copy)]
pub struct Request<'a> {
    /// The study.
    pub subject: &'a ExportSubject,
    /// The scenario around the constellation, for the products that show it.
    pub shown: Option<ShownScenario<'a>>,
    /// The products, in the order in which they are written.
    pub products: &'a [Product],
    /// Their options.
    pub choices: Choices,
}

/// Sets the constellation up and writes its products: [`ExportSource::new`] and [`ExportSource::export`].
///
/// # Errors
/// As of these.
pub fn export(request: &Request<'_>, sink: &impl Sink) -> Result<Manifest, ExportError> {
    let source = ExportSource::new(request.subject, request.choices)?;
    source.export(request.products, request.shown, sink)
}

fn write(
    source: &ExportSource<'_>,
    products: &[Product],
    scene: Option<&Scene<'_>>,
    sink: &impl Sink,
) -> Result<Manifest, WriteError> {
    let files = Files { sink };
    let mut entries = Vec::new();
    for product in products {
        entries.extend(product.write(source, &files, scene)?);
    }
    let manifest = source.manifest(entries);
    let mut out = BufWriter::new(sink.create(FILE_NAME)?);
    manifest.write(&mut out)?;
    out.flush()?;
    Ok(manifest)
}

/// A [`Sink`] behind a pointer, so that the writers in the table of products have one type.
trait Open: Sync {
    fn open(&self, path: &str) -> io::Result<Box<dyn Write + '_>>;
}

impl<S: Sink> Open for S {
    fn open(&self, path: &str) -> io::Result<Box<dyn Write + '_>> {
        Ok(Box::new(self.create(path)?))
    }
}

/// The destination that the products write to.
struct Files<'a> {
    sink: &'a dyn Open,
}

/// The destination of a product, which hashes every byte.
type Out<'a> = BufWriter<HashingWriter<Box<dyn Write + 'a>>>;

/// A product in the version of its format.
#[derive(Clone, Copy)]
struct ProductVersion<'a> {
    product: Product,
    version: &'a str,
}

/// The content of a file.
#[derive(Clone, Copy)]
struct Contents<'a> {
    objects: usize,
    metadata: &'a Metadata,
}

impl Files<'_> {
    /// Writes one file; its entry has the loss returned by `write`.
    fn add(
        &self,
        path: &str,
        format: ProductVersion<'_>,
        contents: Contents<'_>,
        write: impl FnOnce(&mut Out<'_>) -> Result<Loss, WriteError>,
    ) -> Result<FileEntry, WriteError> {
        let mut out = BufWriter::new(HashingWriter::new(self.sink.open(path)?));
        let loss = write(&mut out)?;
        let hashing = out.into_inner().map_err(io::IntoInnerError::into_error)?;
        let sha256 = hashing.finish()?;
        Ok(FileEntry::new(
            path,
            format.product.keyword(),
            format.version,
            contents.objects,
            contents.metadata,
            loss,
            sha256,
        ))
    }
}

#[cfg(test)]
pub(crate) mod testing;
#[cfg(test)]
mod tests;
