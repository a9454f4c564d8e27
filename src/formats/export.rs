//! An export: the files of the products that are asked for, and the manifest that names them.

use super::fit::{Fit, fit};
use super::interpolation::Hermite;
use super::manifest::{Conventions, FILE_NAME, FileEntry, HashingWriter, Loss, Manifest, Study};
use super::metadata::{ElementChoice, Metadata, Object, Theory};
use super::sampled::Sampled;
use super::spread::Spread;
use super::stamp::TimeSystem;
use super::{CcsdsVersion, WriteError, csv, oem, omm, sp3, stk, tle};
use crate::constellation::{Design, Satellite};
use crate::ephemeris::{Ephemeris, EphemerisError, Flown};
use crate::frames::Frame;
use crate::orbit::j2::SecularOrbit;
use crate::orbit::sgp4::{MeanMotionSlot, Sgp4Orbit};
use crate::orbit::{Model, PropagationError, Propagator};
use crate::time::{Epoch, TimeGrid};
use crate::words::{Word, words};
use std::io::{self, BufWriter, Write};

words! {
    /// What can be asked of an export.
    Product {
        /// Two-line element sets with names, one file.
        Tle = "tle",
        /// CCSDS Orbit Mean-Elements Messages, one file for each satellite.
        Omm = "omm",
        /// The same in one XML file.
        OmmXml = "omm-xml",
        /// The same as one JSON array.
        OmmJson = "omm-json",
        /// The same as one table.
        OmmCsv = "omm-csv",
        /// States that SGP4 gives for the element sets as written, for comparing another SGP4.
        TleStates = "tle-states",
        /// CCSDS Orbit Ephemeris Messages, one file for each satellite.
        Oem = "oem",
        /// SP3 in GPS time, files of up to 99 satellites (85 in SP3-c).
        Sp3 = "sp3",
        /// STK ephemerides, one file for each satellite.
        Stk = "stk",
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
    /// Frame of the OEM and the STK ephemerides.
    pub frame: Frame,
    /// Version of the CCSDS messages.
    pub ccsds_version: CcsdsVersion,
    /// How element sets are made from the design.
    pub elements: ElementChoice,
    /// Version of SP3.
    pub sp3_version: sp3::Version,
    /// Letter of the SP3 ids.
    pub sp3_letter: char,
}

impl Default for Choices {
    fn default() -> Self {
        Self {
            frame: Frame::Eme2000,
            ccsds_version: CcsdsVersion::V2,
            elements: ElementChoice::Kozai,
            sp3_version: sp3::Version::D,
            sp3_letter: 'L',
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
            Product::Omm => source.omm(&mut files)?,
            Product::OmmXml | Product::OmmJson | Product::OmmCsv => {
                source.omm_file(*product, &mut files)?;
            }
            Product::TleStates => source.tle_states(&mut files)?,
            Product::Oem => source.oem(&mut files)?,
            Product::Sp3 => source.sp3(&mut files)?,
            Product::Stk => source.stk(&mut files)?,
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

    /// The unrounded element sets at an epoch, with the satellites that they are of.
    fn element_sets(&self, epoch: Epoch) -> Result<Vec<sgp4::Elements>, WriteError> {
        let since_s = epoch.seconds_since(self.subject.grid.epoch());
        let slot = match self.choices.elements {
            ElementChoice::Kepler => MeanMotionSlot::Kepler,
            ElementChoice::Kozai | ElementChoice::Fit => MeanMotionSlot::Kozai,
        };
        let set = |(satellite, object): (&Satellite, &Object)| {
            let elements = SecularOrbit::j2(&satellite.elements).elements_at(since_s);
            super::element_set(&elements, object, epoch, slot)
        };
        let sets = self.satellites.iter().zip(&self.objects).map(set);
        if self.choices.elements != ElementChoice::Fit {
            return Ok(sets.collect());
        }
        let fitted = |(set, flown): (sgp4::Elements, &Flown)| Ok(self.fit(&set, flown)?.set);
        sets.zip(self.ephemeris.satellites()).map(fitted).collect()
    }

    /// A set fitted to at most 200 samples of the trajectory.
    fn fit(&self, start: &sgp4::Elements, flown: &Flown) -> Result<Fit, EphemerisError> {
        let grid = self.subject.grid;
        let stride = grid.len().div_ceil(200);
        let mut positions = Vec::new();
        for k in (0..grid.len()).step_by(stride) {
            let elapsed_s = grid.elapsed_s(k);
            let state = self.ephemeris.state(flown, elapsed_s)?;
            positions.push((elapsed_s, state.position_km));
        }
        fit(start, &positions, grid.epoch()).map_err(|source| failed(flown, source))
    }

    /// The sets as a TLE rounds them, and before: at the epoch next to that of the study.
    fn tle_sets(&self) -> Result<Vec<sgp4::Elements>, WriteError> {
        self.element_sets(tle::rounded_epoch(self.subject.grid.epoch()))
    }

    fn tle(&self, files: &mut Files<'_, impl Sink>) -> Result<(), WriteError> {
        let metadata = self.metadata(Frame::Teme, Theory::Sgp4Elements(self.choices.elements));
        let about = (self.objects.len(), &metadata);
        let sets = self.tle_sets()?;
        files.add("constellation.tle", (Product::Tle, "3LE"), about, |out| {
            sets.iter().try_for_each(|set| tle::write(out, set))?;
            self.loss_of_sets(&sets, true)
        })
    }

    fn omm(&self, files: &mut Files<'_, impl Sink>) -> Result<(), WriteError> {
        let metadata = self.metadata(Frame::Teme, Theory::Sgp4Elements(self.choices.elements));
        let header = omm::header(self.choices.ccsds_version, &metadata);
        let format = (Product::Omm, self.choices.ccsds_version.word());
        let sets = self.element_sets(self.subject.grid.epoch())?;
        let loss = self.loss_of_sets(&sets, false)?;
        for (set, object) in sets.iter().zip(&self.objects) {
            let path = format!("omm/{}.omm", object.name);
            files.add(&path, format, (1, &metadata), |out| {
                omm::write_kvn(out, &header, set)?;
                Ok(loss.clone())
            })?;
        }
        Ok(())
    }

    fn omm_file(
        &self,
        product: Product,
        files: &mut Files<'_, impl Sink>,
    ) -> Result<(), WriteError> {
        let metadata = self.metadata(Frame::Teme, Theory::Sgp4Elements(self.choices.elements));
        let about = (self.objects.len(), &metadata);
        let header = omm::header(self.choices.ccsds_version, &metadata);
        let path = match product {
            Product::OmmXml => "omm.xml",
            Product::OmmJson => "omm.json",
            _ => "omm.csv",
        };
        let format = (product, self.choices.ccsds_version.word());
        let sets = self.element_sets(self.subject.grid.epoch())?;
        files.add(path, format, about, |out| {
            match product {
                Product::OmmXml => omm::write_xml(out, &header, &sets)?,
                Product::OmmJson => omm::write_json(out, &sets)?,
                _ => omm::write_csv(out, &sets)?,
            }
            self.loss_of_sets(&sets, false)
        })
    }

    /// What the sets cost, looked at about once an hour, by the satellite that loses most: their
    /// digits in a TLE, and SGP4 against the model that is flown.
    fn loss_of_sets(&self, sets: &[sgp4::Elements], tle: bool) -> Result<Loss, WriteError> {
        let grid = self.subject.grid;
        let span_s = grid.elapsed_s(grid.len() - 1) + 1.0;
        let hourly = TimeGrid::new(grid.epoch(), span_s, 3_577.0).unwrap_or(grid);
        let (mut digits, mut theory) = (Spread::default(), Spread::default());
        for (set, flown) in sets.iter().zip(self.ephemeris.satellites()) {
            let of_set = |set: &sgp4::Elements| {
                Sgp4Orbit::from_element_set(set, grid.epoch()).map_err(|e| failed(flown, e))
            };
            let exact = of_set(set)?;
            theory.widen(&self.apart(flown, (&exact, flown.propagator.as_ref()), hourly)?);
            if tle {
                let rounded = of_set(&tle::as_written(set)?)?;
                digits.widen(&self.apart(flown, (&exact, &rounded), hourly)?);
            }
        }
        Ok(Loss {
            quantisation_max_km: tle.then_some(digits.max_km),
            quantisation_rms_km: tle.then_some(digits.rms_km),
            theory_max_km: Some(theory.max_km),
            theory_rms_km: Some(theory.rms_km),
            ..Loss::default()
        })
    }

    fn apart(
        &self,
        flown: &Flown,
        (one, other): (&dyn Propagator, &dyn Propagator),
        grid: TimeGrid,
    ) -> Result<Spread, EphemerisError> {
        Spread::between(one, other, grid).map_err(|source| failed(flown, source))
    }

    fn tle_states(&self, files: &mut Files<'_, impl Sink>) -> Result<(), WriteError> {
        let metadata = self.metadata(Frame::Teme, Theory::Sgp4Elements(self.choices.elements));
        let about = (self.objects.len(), &metadata);
        let format = (Product::TleStates, "1");
        let grid = self.subject.grid;
        files.add("tle-states.csv", format, about, |out| {
            let mut satellites = Vec::new();
            for (set, flown) in self.tle_sets()?.iter().zip(self.ephemeris.satellites()) {
                let orbit = Sgp4Orbit::from_element_set(&tle::as_written(set)?, grid.epoch())
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
            frame,
            ccsds_version,
            ..
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
        let format = (Product::Oem, ccsds_version.word());
        for (satellite, object) in self.ephemeris.satellites().iter().zip(&self.objects) {
            let path = format!("oem/{}.oem", satellite.name);
            files.add(&path, format, (1, &metadata), |out| {
                let states = (&sampled, satellite);
                oem::write(out, ccsds_version, &metadata, object, states, hermite)?;
                Ok(loss.clone())
            })?;
        }
        Ok(())
    }

    fn stk(&self, files: &mut Files<'_, impl Sink>) -> Result<(), WriteError> {
        let frame = self.choices.frame;
        let metadata = self.metadata(frame, Theory::Flown(self.subject.model));
        let sampled = Sampled::new(&self.ephemeris, frame);
        let hermite = match self.ephemeris.satellites() {
            [first, ..] => Hermite::measured(&sampled, first)?,
            [] => None,
        };
        let loss = Loss {
            interpolation_max_km: hermite.map(|hermite| hermite.max_error_km),
            ..Loss::default()
        };
        for satellite in self.ephemeris.satellites() {
            let path = format!("stk/{}.e", satellite.name);
            let format = (Product::Stk, stk::FORMAT_VERSION);
            files.add(&path, format, (1, &metadata), |out| {
                let states = (&sampled, satellite);
                stk::write(out, &satellite.name, &metadata, states, hermite)?;
                Ok(loss.clone())
            })?;
        }
        Ok(())
    }

    fn sp3(&self, files: &mut Files<'_, impl Sink>) -> Result<(), WriteError> {
        let Choices {
            sp3_version,
            sp3_letter,
            ..
        } = self.choices;
        let mut metadata = self.metadata(Frame::EarthFixed, Theory::Flown(self.subject.model));
        metadata.time_system = TimeSystem::Gps;
        let sampled = Sampled::new(&self.ephemeris, Frame::EarthFixed);
        let satellites: Vec<_> = self
            .ephemeris
            .satellites()
            .iter()
            .zip(&self.objects)
            .collect();
        let parts = satellites.chunks(sp3_version.most_satellites());
        for (index, part) in parts.enumerate() {
            let path = format!("sp3/part-{:02}.sp3", index + 1);
            let about = (part.len(), &metadata);
            files.add(&path, (Product::Sp3, sp3_version.word()), about, |out| {
                sp3::write(out, sp3_version, sp3_letter, &metadata, &sampled, part)?;
                let names = part.first().zip(part.last());
                Ok(Loss {
                    note: names.map(|((_, first), (_, last))| {
                        let count = part.len();
                        format!(
                            "{sp3_letter}01 = {} to {sp3_letter}{count:02} = {}",
                            first.name, last.name
                        )
                    }),
                    ..Loss::default()
                })
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
