//! An export: the files of the products that are asked for, and the manifest that names them.

use super::interpolation::Hermite;
use super::manifest::{Conventions, FILE_NAME, FileEntry, HashingWriter, Loss, Manifest, Study};
use super::metadata::{Metadata, Object, Theory};
use super::sampled::Sampled;
use super::stamp::TimeSystem;
use super::{WriteError, csv, oem, tle};
use crate::constellation::{Design, Satellite};
use crate::ephemeris::{Ephemeris, EphemerisError, Flown};
use crate::frames::Frame;
use crate::orbit::sgp4::{MeanMotionSlot, Sgp4Orbit};
use crate::orbit::{Model, PropagationError};
use crate::time::{Epoch, TimeGrid};
use crate::words::{Word, words};
use std::io::{self, BufWriter, Write};

words! {
    /// What can be asked of an export.
    Product {
        /// Two-line element sets with names, one file.
        Tle = "tle",
        /// States that SGP4 gives for the element sets as written, for comparing another SGP4.
        TleStates = "tle-states",
        /// CCSDS Orbit Ephemeris Messages, one file for each satellite.
        Oem = "oem",
        /// Tables of mean elements and of states.
        Csv = "csv",
    }
}

/// Where the files of an export go: gives a writer for a path relative to the manifest, with `/`.
pub trait Sink {
    /// What takes the bytes of a file.
    type File: Write;

    /// Begins a file.
    ///
    /// # Errors
    /// When the file cannot be begun.
    fn create(&mut self, path: &str) -> io::Result<Self::File>;
}

impl<W: Write, F: FnMut(&str) -> io::Result<W>> Sink for F {
    type File = W;

    fn create(&mut self, path: &str) -> io::Result<W> {
        self(path)
    }
}

/// The study that is exported.
#[derive(Debug, Clone)]
pub struct Subject {
    /// The design.
    pub design: Design,
    /// What it flies by.
    pub model: Model,
    /// The instants of sampled products; its epoch is that of the elements.
    pub grid: TimeGrid,
    /// The scenario.
    pub study: Study,
    /// Who makes the files.
    pub originator: String,
    /// When the files say that they were made.
    pub creation: Epoch,
}

/// What the products leave open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Choices {
    /// Frame of the OEM.
    pub frame: Frame,
    /// Version of the OEM.
    pub oem_version: oem::Version,
    /// What stands in the mean motion slot of element sets.
    pub slot: MeanMotionSlot,
}

impl Default for Choices {
    fn default() -> Self {
        Self {
            frame: Frame::Eme2000,
            oem_version: oem::Version::V2,
            slot: MeanMotionSlot::Kozai,
        }
    }
}

/// Writes the products and then the manifest, which it also returns.
///
/// # Errors
/// When a satellite cannot be flown or named, an element does not fit its format, or a file
/// cannot be written.
pub fn export(
    subject: &Subject,
    products: &[Product],
    choices: Choices,
    sink: &mut impl Sink,
) -> Result<Manifest, WriteError> {
    let source = Source::new(subject, choices)?;
    let mut files = Files {
        sink,
        entries: Vec::new(),
    };
    for product in products {
        match product {
            Product::Tle => source.tle(&mut files)?,
            Product::TleStates => source.tle_states(&mut files)?,
            Product::Oem => source.oem(&mut files)?,
            Product::Csv => source.csv(&mut files)?,
        }
    }
    let manifest = source.manifest(files.entries);
    let mut out = BufWriter::new(files.sink.create(FILE_NAME)?);
    manifest.write(&mut out)?;
    out.flush()?;
    Ok(manifest)
}

/// The files of an export so far.
struct Files<'a, S> {
    sink: &'a mut S,
    entries: Vec<FileEntry>,
}

/// What a product writes to: every byte is hashed on its way.
type Out<S> = BufWriter<HashingWriter<<S as Sink>::File>>;

impl<S: Sink> Files<'_, S> {
    /// Writes one file and enters it into the manifest with the loss that `write` finds.
    fn add(
        &mut self,
        path: &str,
        format: (Product, &str),
        (objects, metadata): (usize, &Metadata),
        write: impl FnOnce(&mut Out<S>) -> Result<Loss, WriteError>,
    ) -> Result<(), WriteError> {
        let mut out = BufWriter::new(HashingWriter::new(self.sink.create(path)?));
        let loss = write(&mut out)?;
        let hashing = out.into_inner().map_err(io::IntoInnerError::into_error)?;
        let sha256 = hashing.finish()?;
        let format = (format.0.word(), format.1);
        let entry = FileEntry::new(path, format, objects, metadata, loss, sha256);
        self.entries.push(entry);
        Ok(())
    }
}

/// What an export is made from.
struct Source<'a> {
    subject: &'a Subject,
    choices: Choices,
    satellites: Vec<Satellite>,
    objects: Vec<Object>,
    ephemeris: Ephemeris,
}

impl<'a> Source<'a> {
    fn new(subject: &'a Subject, choices: Choices) -> Result<Self, WriteError> {
        let ephemeris = Ephemeris::of_design(&subject.design, subject.model, subject.grid)?;
        Ok(Self {
            subject,
            choices,
            satellites: subject.design.satellites(),
            objects: Object::all(ephemeris.satellites(), subject.grid.epoch())?,
            ephemeris,
        })
    }

    fn metadata(&self, frame: Frame, theory: Theory) -> Metadata {
        let study = &self.subject.study;
        Metadata {
            originator: self.subject.originator.clone(),
            creation: self.subject.creation,
            frame,
            time_system: TimeSystem::Utc,
            theory,
            subject: vec![
                format!("Design: {}", self.subject.design),
                format!("Scenario: {}, hash {}", study.name, study.hash),
            ],
        }
    }

    /// The unrounded element sets, at the epoch that a TLE can write.
    fn element_sets(&self) -> impl Iterator<Item = (sgp4::Elements, &Flown)> {
        let (epoch, slot) = (self.subject.grid.epoch(), self.choices.slot);
        self.satellites
            .iter()
            .zip(&self.objects)
            .map(move |(satellite, object)| tle::element_set(satellite, object, epoch, slot))
            .zip(self.ephemeris.satellites())
    }

    fn tle(&self, files: &mut Files<'_, impl Sink>) -> Result<(), WriteError> {
        let metadata = self.metadata(Frame::Teme, Theory::Sgp4Elements(self.choices.slot));
        let about = (self.objects.len(), &metadata);
        files.add("constellation.tle", (Product::Tle, "3LE"), about, |out| {
            for (set, _) in self.element_sets() {
                tle::write(out, &set)?;
            }
            self.quantisation()
        })
    }

    /// The loss of the satellite that loses most, looked at once an hour.
    fn quantisation(&self) -> Result<Loss, WriteError> {
        let grid = self.subject.grid;
        let span_s = grid.elapsed_s(grid.len() - 1) + 1.0;
        let hourly = TimeGrid::new(grid.epoch(), span_s, 3_600.0).unwrap_or(grid);
        let (mut max_km, mut rms_km) = (0.0_f64, 0.0_f64);
        for (set, flown) in self.element_sets() {
            let found = tle::quantisation_loss(&set, &tle::as_written(&set)?, hourly)
                .map_err(|source| failed(flown, source))?;
            max_km = max_km.max(found.max_km);
            rms_km = rms_km.max(found.rms_km);
        }
        Ok(Loss {
            quantisation_max_km: Some(max_km),
            quantisation_rms_km: Some(rms_km),
            ..Loss::default()
        })
    }

    fn tle_states(&self, files: &mut Files<'_, impl Sink>) -> Result<(), WriteError> {
        let metadata = self.metadata(Frame::Teme, Theory::Sgp4Elements(self.choices.slot));
        let about = (self.objects.len(), &metadata);
        let format = (Product::TleStates, "1");
        let grid = self.subject.grid;
        files.add("tle-states.csv", format, about, |out| {
            let mut satellites = Vec::new();
            for (set, flown) in self.element_sets() {
                let orbit = Sgp4Orbit::from_element_set(&tle::as_written(&set)?, grid.epoch())
                    .map_err(|source| failed(flown, source))?;
                satellites.push(Flown {
                    name: flown.name.clone(),
                    slot: flown.slot,
                    propagator: Box::new(orbit),
                });
            }
            csv::write_states(out, &Ephemeris::new(grid, satellites))?;
            Ok(Loss::default())
        })
    }

    fn oem(&self, files: &mut Files<'_, impl Sink>) -> Result<(), WriteError> {
        let Choices {
            frame, oem_version, ..
        } = self.choices;
        let metadata = self.metadata(frame, Theory::Flown(self.subject.model));
        let sampled = Sampled::new(&self.ephemeris, frame);
        // The satellites of a design fly alike, so that the first tells of all.
        let hermite = match self.ephemeris.satellites() {
            [first, ..] => Hermite::measured(&sampled, first)?,
            [] => None,
        };
        let loss = Loss {
            interpolation_max_km: hermite.map(|hermite| hermite.max_error_km),
            note: (frame == Frame::Teme).then(|| oem::TEME_NOTE.to_owned()),
            ..Loss::default()
        };
        let format = (Product::Oem, oem_version.word());
        for (satellite, object) in self.ephemeris.satellites().iter().zip(&self.objects) {
            let path = format!("oem/{}.oem", satellite.name);
            files.add(&path, format, (1, &metadata), |out| {
                let states = (&sampled, satellite);
                oem::write(out, oem_version, &metadata, object, states, hermite)?;
                Ok(loss.clone())
            })?;
        }
        Ok(())
    }

    fn csv(&self, files: &mut Files<'_, impl Sink>) -> Result<(), WriteError> {
        let metadata = self.metadata(Frame::Teme, Theory::Flown(self.subject.model));
        let about = (self.objects.len(), &metadata);
        files.add("elements.csv", (Product::Csv, "1"), about, |out| {
            let rows = self.satellites.iter().zip(&self.objects);
            csv::write_elements(out, rows, self.subject.grid.epoch())?;
            Ok(Loss::default())
        })?;
        files.add("states.csv", (Product::Csv, "1"), about, |out| {
            csv::write_states(out, &self.ephemeris)?;
            Ok(Loss::default())
        })
    }

    fn manifest(&self, files: Vec<FileEntry>) -> Manifest {
        let Subject { grid, study, .. } = self.subject;
        Manifest {
            program: env!("CARGO_PKG_NAME").to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            scenario: study.clone(),
            design: self.subject.design.to_string(),
            epoch: grid.epoch().to_string(),
            step_s: grid.step_s(),
            samples: grid.len(),
            conventions: Conventions::default(),
            files,
        }
    }
}

fn failed(satellite: &Flown, source: PropagationError) -> EphemerisError {
    EphemerisError {
        name: satellite.name.clone(),
        source,
    }
}

#[cfg(test)]
mod tests;
