//! The files of each product.

use super::source::{ExportSource, failed};
use super::{Contents, Files, Product, ProductVersion};
use crate::constellation::gnss::Preset;
use crate::ephemeris::hermite::Hermite;
use crate::ephemeris::sampled::Sampled;
use crate::ephemeris::{Ephemeris, EphemerisSatellite};
use crate::exchange::manifest::{FileEntry, GNSS_DIRECTORY, Loss};
use crate::exchange::members::ConstellationMember;
use crate::formats::ccsds::omm::OmmSyntax;
use crate::formats::ccsds::opm::Opm;
use crate::formats::ccsds::{oem, omm};
use crate::formats::metadata::{Metadata, Object, Theory, distance_from_itrf};
use crate::formats::sp3::Sp3Error;
use crate::formats::text::timestamp::TimeSystem;
use crate::formats::{WriteError, csv};
use crate::formats::{sp3, stk, tle};
use crate::frames::{EarthFixed, Frame, from_teme};
use crate::keyword::Keyword;
use crate::orbit::sgp4::Sgp4Orbit;
use crate::orbit::{MeanElements, Model};
use rayon::prelude::*;

/// The files of a product, or why one is not written.
pub(super) type ProductFiles = Result<Vec<FileEntry>, WriteError>;

/// The warning for CCSDS messages in a time system that the standard does not define.
fn bdt_note(time_system: TimeSystem) -> Option<&'static str> {
    (time_system == TimeSystem::Bdt).then_some(oem::BDT_NOTE)
}

/// The notes that there are, as one.
fn joined<const N: usize>(notes: [Option<&'static str>; N]) -> Option<String> {
    let notes: Vec<&str> = notes.into_iter().flatten().collect();
    (!notes.is_empty()).then(|| notes.join("; "))
}

/// The contents of one SP3 file.
struct Sp3Part<'a> {
    letter: char,
    metadata: &'a Metadata,
    sampled: &'a Sampled<'a, EarthFixed>,
    satellites: &'a [(&'a EphemerisSatellite, &'a Object)],
    note: Option<String>,
}

impl ExportSource<'_> {
    fn sgp4_metadata(&self) -> Metadata {
        self.metadata(Frame::Teme, self.theory_of_sets())
    }

    pub(super) fn propagated_metadata(&self, frame: Frame) -> Metadata {
        self.metadata(frame, self.theory_of_all())
    }

    /// The metadata of a file of one satellite, from those of the files of all.
    fn of_one(&self, metadata: &Metadata, member: &ConstellationMember<'_>) -> Metadata {
        Metadata {
            theory: self.theory(member),
            ..metadata.clone()
        }
    }

    /// Version of a CCSDS message and its notation: `2.0 KVN`.
    fn ccsds_version(&self, notation: &str) -> String {
        let version = self.choices.ccsds_version;
        format!("{version} {}", notation.to_uppercase())
    }

    /// One file for each satellite, given by its place, by several threads concurrently.
    fn each(
        &self,
        write: impl Fn(usize) -> Result<FileEntry, WriteError> + Send + Sync,
    ) -> ProductFiles {
        (0..self.objects.len()).into_par_iter().map(write).collect()
    }

    pub(super) fn tle(&self, files: &Files<'_>) -> ProductFiles {
        let metadata = self.sgp4_metadata();
        let contents = Contents {
            objects: self.objects.len(),
            metadata: &metadata,
        };
        let sets = self.tle_sets()?;
        let entry = files.add(
            "constellation.tle",
            ProductVersion {
                product: Product::Tle,
                version: "3LE",
            },
            contents,
            |out| {
                sets.iter().try_for_each(|set| tle::write(out, set))?;
                self.loss_of_sets(&sets, true)
            },
        )?;
        Ok(vec![entry])
    }

    pub(super) fn omm(&self, files: &Files<'_>) -> ProductFiles {
        let notation = self.choices.omm;
        let metadata = self.sgp4_metadata();
        let header = omm::header(self.choices.ccsds_version, &metadata);
        let version = self.ccsds_version(notation.keyword());
        let format = ProductVersion {
            product: Product::Omm,
            version: version.as_str(),
        };
        let sets = self.element_sets(|epoch| epoch)?;
        let loss = self.loss_of_sets(&sets, false)?;
        if notation == OmmSyntax::Kvn {
            return self.each(|k| {
                let path = format!("omm/{}.omm", self.stems[k]);
                let metadata = Metadata {
                    theory: self.theory_of_set(&self.members[k]),
                    ..metadata.clone()
                };
                let header = omm::header(self.choices.ccsds_version, &metadata);
                let contents = Contents {
                    objects: 1,
                    metadata: &metadata,
                };
                files.add(&path, format, contents, |out| {
                    omm::write_kvn(out, &header, &sets[k])?;
                    Ok(loss.clone())
                })
            });
        }
        let path = format!("omm.{notation}");
        let entry = files.add(
            &path,
            format,
            Contents {
                objects: sets.len(),
                metadata: &metadata,
            },
            |out| {
                match notation {
                    OmmSyntax::Xml | OmmSyntax::Kvn => omm::write_xml(out, &header, &sets)?,
                    OmmSyntax::Json => omm::write_json(out, &sets)?,
                    OmmSyntax::Csv => omm::write_csv(out, &sets)?,
                }
                Ok(loss.clone())
            },
        )?;
        Ok(vec![entry])
    }

    pub(super) fn tle_states(&self, files: &Files<'_>) -> ProductFiles {
        let metadata = self.sgp4_metadata();
        let contents = Contents {
            objects: self.objects.len(),
            metadata: &metadata,
        };
        let format = ProductVersion {
            product: Product::TleStates,
            version: "1",
        };
        let grid = self.subject.grid;
        let entry = files.add("tle-states.csv", format, contents, |out| {
            let mut satellites = Vec::new();
            for (set, propagated) in self.tle_sets()?.iter().zip(self.ephemeris.satellites()) {
                let orbit = Sgp4Orbit::from_element_set(&tle::as_written(set)?, grid.epoch())
                    .map_err(|source| failed(propagated, source))?;
                satellites.push(EphemerisSatellite {
                    name: propagated.name.clone(),
                    slot: propagated.slot,
                    propagator: Box::new(orbit),
                });
            }
            csv::write_states(out, &Ephemeris::new(grid, satellites))?;
            Ok(Loss::default())
        })?;
        Ok(vec![entry])
    }

    pub(super) fn oem(&self, files: &Files<'_>) -> ProductFiles {
        let choices = self.choices;
        let mut metadata = self.propagated_metadata(choices.frame);
        metadata.time_system = choices.time_system;
        let sampled = Sampled::new(&self.ephemeris, choices.frame);
        let hermites = Hermite::of_each(&sampled)?;
        let loss = |hermite: Option<Hermite>| Loss {
            interpolation_max_km: hermite.map(|hermite| hermite.max_error_km),
            note: joined([
                (choices.frame == Frame::Teme).then_some(oem::TEME_NOTE),
                bdt_note(choices.time_system),
            ]),
            ..Loss::default()
        };
        let version = self.ccsds_version(choices.oem.keyword());
        let format = ProductVersion {
            product: Product::Oem,
            version: version.as_str(),
        };
        if choices.oem == oem::OemSyntax::Xml && choices.oem_combined {
            let contents = Contents {
                objects: self.objects.len(),
                metadata: &metadata,
            };
            let satellites = self.satellites().zip(&self.objects).zip(&hermites);
            let messages = satellites.map(|(((satellite, member), object), hermite)| {
                let metadata = self.of_one(&metadata, member);
                oem::OemMessage {
                    satellite,
                    object,
                    metadata,
                    hermite: *hermite,
                }
            });
            let entry = files.add("oem.xml", format, contents, |out| {
                oem::write_combined_xml(out, choices.ccsds_version, &sampled, messages)?;
                let measured = hermites.iter().flatten().copied();
                let worst = measured.max_by(|a, b| a.max_error_km.total_cmp(&b.max_error_km));
                Ok(loss(worst))
            })?;
            return Ok(vec![entry]);
        }
        self.each(|k| {
            let (satellite, object) = (&self.ephemeris.satellites()[k], &self.objects[k]);
            let extension = match choices.oem {
                oem::OemSyntax::Kvn => "oem",
                oem::OemSyntax::Xml => "xml",
            };
            let path = format!("oem/{}.{extension}", self.stems[k]);
            let metadata = self.of_one(&metadata, &self.members[k]);
            let writer = oem::OemWriter {
                version: choices.ccsds_version,
                metadata: &metadata,
                sampled: &sampled,
                hermite: hermites[k],
            };
            files.add(
                &path,
                format,
                Contents {
                    objects: 1,
                    metadata: &metadata,
                },
                |out| {
                    match choices.oem {
                        oem::OemSyntax::Kvn => writer.kvn(out, satellite, object)?,
                        oem::OemSyntax::Xml => writer.xml(out, satellite, object)?,
                    }
                    Ok(loss(hermites[k]))
                },
            )
        })
    }

    pub(super) fn opm(&self, files: &Files<'_>) -> ProductFiles {
        let choices = self.choices;
        let mut metadata = self.propagated_metadata(choices.frame);
        metadata.time_system = choices.time_system;
        let version = self.ccsds_version(choices.opm.keyword());
        let epoch = self.subject.grid.epoch();
        self.each(|k| {
            let object = &self.objects[k];
            let path = format!("opm/{}.{}", self.stems[k], choices.opm.extension());
            let format = ProductVersion {
                product: Product::Opm,
                version: version.as_str(),
            };
            let metadata = self.of_one(&metadata, &self.members[k]);
            let contents = Contents {
                objects: 1,
                metadata: &metadata,
            };
            files.add(&path, format, contents, |out| {
                let teme = self.ephemeris.state(&self.ephemeris.satellites()[k], 0.0)?;
                let state = from_teme(teme, choices.frame, epoch, 0.0);
                let elements = self.members[k]
                    .origin
                    .mean_elements(epoch, self.subject.model);
                let version = choices.ccsds_version;
                Opm::new(version, &metadata, object, elements.as_ref(), epoch, state)
                    .write_as(choices.opm, out)?;
                let state_only =
                    "the state at the epoch, without mean elements: the source has none of J2";
                Ok(Loss {
                    note: joined([
                        bdt_note(choices.time_system),
                        elements.is_none().then_some(state_only),
                    ]),
                    ..Loss::default()
                })
            })
        })
    }

    pub(super) fn stk(&self, files: &Files<'_>) -> ProductFiles {
        let frame = self.choices.frame;
        let metadata = self.propagated_metadata(frame);
        let sampled = Sampled::new(&self.ephemeris, frame);
        let hermites = Hermite::of_each(&sampled)?;
        self.each(|k| {
            let path = format!("stk/{}.e", self.stems[k]);
            let format = ProductVersion {
                product: Product::Stk,
                version: stk::FORMAT_VERSION,
            };
            let metadata = self.of_one(&metadata, &self.members[k]);
            let contents = Contents {
                objects: 1,
                metadata: &metadata,
            };
            files.add(&path, format, contents, |out| {
                let satellite = &self.ephemeris.satellites()[k];
                let (name, hermite) = (&satellite.name, hermites[k]);
                stk::write(out, name, &metadata, &sampled, satellite, hermite)?;
                Ok(Loss {
                    interpolation_max_km: hermite.map(|hermite| hermite.max_error_km),
                    ..Loss::default()
                })
            })
        })
    }

    pub(super) fn sp3(&self, files: &Files<'_>) -> ProductFiles {
        let (version, letter) = (self.choices.sp3_version, self.choices.sp3_letter);
        let mut metadata = self.propagated_metadata(Frame::EarthFixed);
        metadata.time_system = TimeSystem::Gps;
        let sampled = Sampled::new(&self.ephemeris, EarthFixed);
        let satellites: Vec<_> = self
            .ephemeris
            .satellites()
            .iter()
            .zip(&self.objects)
            .collect();
        let note = |part: &[(&EphemerisSatellite, &Object)]| {
            let ((_, first), (_, last)) = part.first().zip(part.last())?;
            let count = part.len();
            Some(format!(
                "{letter}01 = {} to {letter}{count:02} = {}",
                first.name, last.name
            ))
        };
        let one = |(index, part): (usize, &[(&EphemerisSatellite, &Object)])| {
            let path = format!("sp3/part-{:02}.sp3", index + 1);
            self.sp3_file(
                files,
                &path,
                Sp3Part {
                    letter,
                    metadata: &metadata,
                    sampled: &sampled,
                    satellites: part,
                    note: note(part),
                },
            )
        };
        let parts = satellites.par_chunks(version.most_satellites());
        let mut entries: Vec<FileEntry> = parts.enumerate().map(one).collect::<Result<_, _>>()?;
        for (preset, _) in Preset::ALL
            .iter()
            .zip(self.choices.sp3_gnss)
            .filter(|(_, chosen)| *chosen)
        {
            entries.push(self.sp3_of_gnss(files, *preset)?);
        }
        Ok(entries)
    }

    /// A nominal constellation under the letter of its system, in a separate file, since readers that
    /// accept several files merge them.
    fn sp3_of_gnss(&self, files: &Files<'_>, preset: Preset) -> Result<FileEntry, WriteError> {
        let letter = sp3::letter_of(preset);
        if letter == self.choices.sp3_letter {
            return Err(Sp3Error::LetterOfGnss { letter, preset }.into());
        }
        let grid = self.subject.grid;
        let ephemeris = Ephemeris::of_gnss(preset.satellites(grid.epoch()), grid);
        let objects = Object::all(ephemeris.satellites(), grid.epoch())?;
        let satellites: Vec<_> = ephemeris.satellites().iter().zip(&objects).collect();
        let sampled = Sampled::new(&ephemeris, EarthFixed);
        let mut metadata = self.metadata(Frame::EarthFixed, Theory::Propagated(Model::J2));
        metadata.time_system = TimeSystem::Gps;
        let note = format!("nominal {preset}: slots, not the satellites in orbit");
        metadata.subject.insert(0, note.clone());
        let mut radius_km = 0.0_f64;
        for satellite in ephemeris.satellites() {
            radius_km = radius_km.max(ephemeris.state(satellite, 0.0)?.position_km.km().norm());
        }
        metadata.frame_note = Some(distance_from_itrf(grid.epoch(), radius_km));
        let path = format!("{GNSS_DIRECTORY}{preset}.sp3");
        self.sp3_file(
            files,
            &path,
            Sp3Part {
                letter,
                metadata: &metadata,
                sampled: &sampled,
                satellites: &satellites,
                note: Some(note),
            },
        )
    }

    fn sp3_file(
        &self,
        files: &Files<'_>,
        path: &str,
        part: Sp3Part<'_>,
    ) -> Result<FileEntry, WriteError> {
        let version = self.choices.sp3_version;
        let Sp3Part {
            letter,
            metadata,
            sampled,
            satellites,
            note,
        } = part;
        files.add(
            path,
            ProductVersion {
                product: Product::Sp3,
                version: version.keyword(),
            },
            Contents {
                objects: satellites.len(),
                metadata,
            },
            |out| {
                sp3::write(out, version, letter, metadata, sampled, satellites)?;
                Ok(Loss {
                    note,
                    ..Loss::default()
                })
            },
        )
    }

    pub(super) fn csv(&self, files: &Files<'_>) -> ProductFiles {
        let metadata = self.propagated_metadata(Frame::Teme);
        let contents = Contents {
            objects: self.objects.len(),
            metadata: &metadata,
        };
        let format = ProductVersion {
            product: Product::Csv,
            version: "1",
        };
        let (epoch, model) = (self.subject.grid.epoch(), self.subject.model);
        let elements = self
            .members
            .iter()
            .map(|one| one.origin.mean_elements(epoch, model));
        let elements: Option<Vec<MeanElements>> = elements.collect();
        let mut entries = Vec::new();
        if let Some(elements) = &elements {
            let rows = self.members.iter().zip(elements).zip(&self.objects);
            let rows = rows.map(|((member, elements), object)| csv::ElementsOf {
                slot: member.slot,
                elements: *elements,
                object,
            });
            entries.push(files.add("elements.csv", format, contents, |out| {
                csv::write_elements(out, &rows.collect::<Vec<_>>(), epoch)?;
                Ok(Loss::default())
            })?);
        }
        let none =
            "there is no table of elements: the source has no mean elements of J2 at the epoch";
        entries.push(files.add("states.csv", format, contents, |out| {
            csv::write_states(out, &self.ephemeris)?;
            Ok(Loss {
                note: elements.is_none().then(|| none.to_owned()),
                ..Loss::default()
            })
        })?);
        Ok(entries)
    }
}
