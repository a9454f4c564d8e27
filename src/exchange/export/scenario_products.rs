//! The products with which another program reproduces the study: STK, GMAT, almanacs.

use super::products::ProductFiles;
use super::source::ExportSource;
use super::{Contents, Files, Product, ProductVersion};
use crate::constellation::gnss::{GnssOrbit, GnssSatellite, System};
use crate::constellation::shell_letters;
use crate::ephemeris::sampled::Sampled;
use crate::ephemeris::{Ephemeris, EphemerisSatellite};
use crate::exchange::manifest::{FileEntry, Loss, STK_SCENARIO_DIRECTORY};
use crate::exchange::members::{ConstellationMember, Origin};
use crate::formats::maps::palette::Palette;
use crate::formats::maps::scene::Scene;
use crate::formats::metadata::Theory;
use crate::formats::stk::connect::{ConnectItem, ConnectScenario, Setting, WalkerShell, by_hand};
use crate::formats::yuma::{self, Almanac, Applicability, NoAlmanac, radius_shift_km};
use crate::formats::{WriteError, gmat, stk};
use crate::frames::{Eme2000, Frame, from_teme};
use crate::keyword::Keyword;
use crate::orbit::{MeanElements, Model};
use std::io::Write;

/// A GNSS satellite in STK: its name there and its setting, and its ephemeris if it needs one.
struct InStk {
    name: String,
    setting: Setting,
    propagated: Option<EphemerisSatellite>,
}

impl ExportSource<'_> {
    /// The ephemerides, and with a scenario the commands that build it.
    pub(super) fn stk_with(&self, files: &Files<'_>, scene: Option<&Scene<'_>>) -> ProductFiles {
        let mut entries = self.stk(files)?;
        if let Some(scene) = scene {
            entries.extend(self.stk_scenario(files, scene)?);
        }
        Ok(entries)
    }

    fn stk_scenario(&self, files: &Files<'_>, scene: &Scene<'_>) -> ProductFiles {
        let setup = scene.setup();
        let mut gnss = Vec::new();
        for (system, satellites) in scene.systems() {
            gnss.extend(satellites.into_iter().map(|one| in_stk(system, one)));
        }
        let mut entries = self.gnss_files(files, &gnss)?;
        let mut items = self.connect_items();
        let of_constellation = items.len();
        items.extend(
            gnss.iter()
                .map(|one| ConnectItem::Satellite(one.name.clone(), one.setting.clone())),
        );
        let scenario = ConnectScenario {
            grid: self.subject.grid,
            items: &items,
            sites: &setup.sites,
            step_deg: setup.map.step_deg(),
            mask_deg: setup.mask.degrees(),
        };
        let metadata = self.propagated_metadata(Frame::Teme);
        let format = ProductVersion {
            product: Product::Stk,
            version: stk::FORMAT_VERSION,
        };
        let noted = |note: &str| Loss {
            note: Some(note.to_owned()),
            ..Loss::default()
        };
        let contents = Contents {
            objects: self.objects.len() + gnss.len(),
            metadata: &metadata,
        };
        let commands = files.add(&in_scenario("connect.txt"), format, contents, |out| {
            scenario.write(out)?;
            Ok(noted("STK Connect commands; not tested in STK"))
        })?;
        let one_mask = setup.mask == setup.gnss_mask && !setup.has_skylines();
        let with_files = items
            .iter()
            .any(|item| matches!(item, ConnectItem::Satellite(_, Setting::File(_))));
        let mut told = scene.assumptions();
        told.extend(by_hand(one_mask, with_files, &items[..of_constellation]));
        entries.push(commands.assuming(told));
        entries.push(files.add(
            &in_scenario("points.pnt"),
            format,
            Contents {
                objects: 0,
                metadata: &metadata,
            },
            |out| {
                scenario.write_points(out)?;
                Ok(noted("STK point file"))
            },
        )?);
        Ok(entries)
    }

    /// The constellation in STK: a shell by one command where STK has one, otherwise every satellite.
    fn connect_items(&self) -> Vec<ConnectItem> {
        let theory = match self.subject.model {
            Model::J2 => Some(Setting::J2 as fn(MeanElements) -> Setting),
            Model::TwoBody => Some(Setting::TwoBody as fn(MeanElements) -> Setting),
            Model::J2Osculating | Model::Sgp4 => None,
        };
        let single = |k: usize| {
            let stem = &self.stems[k];
            let setting = self.setting(&self.members[k], stem, theory);
            ConnectItem::Satellite(stem.clone(), setting)
        };
        let mut items = Vec::new();
        let shells = self.ephemeris.shells();
        for span in shells {
            let prefix = &self.subject.naming.prefix;
            let slot = self.members[span.first].slot;
            let name = match slot.and_then(|slot| slot.shell) {
                None => prefix.clone(),
                Some(shell) => format!("{prefix}-{}", shell_letters(shell)),
            };
            let walker = theory.and_then(|theory| WalkerShell::new(name, &span.shell, theory));
            match walker {
                Some(walker) => items.push(ConnectItem::Walker(walker)),
                None => items.extend(span.places().map(single)),
            }
        }
        items.extend(self.ephemeris.outside_shells().into_iter().map(single));
        items
    }

    /// A satellite by itself: elements if STK has the theory, otherwise its ephemeris.
    fn setting(
        &self,
        member: &ConstellationMember<'_>,
        stem: &str,
        theory: Option<fn(MeanElements) -> Setting>,
    ) -> Setting {
        let epoch = self.subject.grid.epoch();
        let elements = member.origin.mean_elements(epoch, self.subject.model);
        match theory.zip(elements) {
            Some((theory, elements)) => theory(elements),
            None => Setting::File(format!("../stk/{stem}.e")),
        }
    }

    /// The ephemerides of the GNSS satellites for which STK has no theory.
    fn gnss_files(&self, files: &Files<'_>, gnss: &[InStk]) -> ProductFiles {
        let mut entries = Vec::new();
        let theory = Theory::Propagated(self.subject.model);
        let mut metadata = self.metadata(self.choices.frame, theory);
        metadata
            .subject
            .push("GNSS satellite of the scenario".to_owned());
        let empty = Ephemeris::new(self.subject.grid, Vec::new());
        let sampled = Sampled::new(&empty, self.choices.frame);
        for one in gnss {
            if let Some(propagated) = &one.propagated {
                let path = in_scenario(&format!("gnss/{}.e", one.name));
                let format = ProductVersion {
                    product: Product::Stk,
                    version: stk::FORMAT_VERSION,
                };
                entries.push(files.add(
                    &path,
                    format,
                    Contents {
                        objects: 1,
                        metadata: &metadata,
                    },
                    |out| {
                        let hermite =
                            crate::ephemeris::hermite::Hermite::measured(&sampled, propagated)?;
                        stk::write(out, &one.name, &metadata, &sampled, propagated, hermite)?;
                        Ok(Loss {
                            interpolation_max_km: hermite.map(|hermite| hermite.max_error_km),
                            ..Loss::default()
                        })
                    },
                )?);
            }
        }
        Ok(entries)
    }

    pub(super) fn gmat(&self, files: &Files<'_>) -> ProductFiles {
        let cannot = |what: String, instead| WriteError::CannotSay {
            product: Product::Gmat.keyword(),
            what,
            instead,
        };
        let (model, grid) = (self.subject.model, self.subject.grid);
        let is_mean =
            |member: &ConstellationMember<'_>| matches!(member.origin, Origin::Mean { .. });
        if model == Model::Sgp4 && self.members.iter().any(is_mean) {
            let what = "propagation.model = \"sgp4\": the script integrates J2".to_owned();
            return Err(cannot(
                what,
                "use --as oem or stk, which contain the states",
            ));
        }
        let Some(start) = gmat::calendar(grid.epoch()) else {
            let what = format!(
                "the epoch {}: GMAT reads milliseconds at most",
                grid.epoch()
            );
            return Err(cannot(what, "use an epoch of whole milliseconds"));
        };
        let metadata = self.propagated_metadata(Frame::Eme2000);
        let contents = Contents {
            objects: self.objects.len(),
            metadata: &metadata,
        };
        let format = ProductVersion {
            product: Product::Gmat,
            version: gmat::FORMAT_VERSION,
        };
        let spacecraft = self.gmat_spacecraft()?;
        let integrated = match self.subject.constellation.design {
            Some(_) => model,
            // The theories of files are none of GMAT's: it integrates J2 from their first states.
            None => Model::J2,
        };
        let script = files.add("gmat/navwalker.script", format, contents, |out| {
            gmat::write_script(
                out,
                &metadata.comments(),
                &spacecraft,
                integrated,
                grid,
                &start,
            )?;
            Ok(Loss::default())
        })?;
        let field = files.add(
            &format!("gmat/{}", gmat::FIELD_NAME),
            format,
            Contents {
                objects: 0,
                metadata: &metadata,
            },
            |out| {
                gmat::write_field(out)?;
                Ok(Loss::default())
            },
        )?;
        let mut told = Vec::new();
        if self.members.iter().any(is_mean) {
            told.push(gmat_start(integrated).to_owned());
        }
        if !self.members.iter().all(is_mean) {
            told.push(format!(
                "satellites of files start from their osculating state at the epoch; the theory of the states ({}) is \
                 not that of GMAT, which differs from it afterwards",
                metadata.theory
            ));
        }
        told.extend(GMAT_ASSUMPTIONS.map(str::to_owned));
        Ok(vec![script.assuming(told), field])
    }

    /// The satellites with their states at the epoch; the shells of several in colours of their own.
    fn gmat_spacecraft(&self) -> Result<Vec<gmat::Spacecraft>, WriteError> {
        let (model, epoch) = (self.subject.model, self.subject.grid.epoch());
        let several = self.ephemeris.shells().len() > 1;
        let palette = Palette::of(&self.ephemeris);
        let mut spacecraft = Vec::with_capacity(self.members.len());
        for ((satellite, member), stem) in self.satellites().zip(&self.stems) {
            let state = match member.origin.mean_elements(epoch, model) {
                Some(elements) => gmat::start(&elements, model, epoch),
                None => from_teme(self.ephemeris.state(satellite, 0.0)?, Eme2000, epoch, 0.0),
            };
            spacecraft.push(gmat::Spacecraft {
                name: gmat::script_name(stem),
                state,
                colour: several.then(|| palette.colour(member.slot)),
            });
        }
        Ok(spacecraft)
    }

    pub(super) fn yuma(&self, files: &Files<'_>, scene: &Scene<'_>) -> ProductFiles {
        let cannot = |what: String, instead| WriteError::CannotSay {
            product: Product::Yuma.keyword(),
            what,
            instead,
        };
        let systems = scene.systems();
        if systems.is_empty() {
            let what = "a study without GNSS: gnss.constellations is empty, and a LEO design has no almanac".to_owned();
            return Err(cannot(what, "use --as sp3 or tle for the design"));
        }
        let epoch = self.subject.grid.epoch();
        let at = Applicability::next_to(epoch);
        let mut entries: Vec<FileEntry> = Vec::new();
        for (system, satellites) in systems {
            let almanacs = almanacs(&satellites, epoch, at).map_err(|(name, why)| {
                let what = format!("{name} of {}, which {}", system.name(), reason(why));
                cannot(what, "take its operator's almanac, or use --as tle")
            })?;
            entries.push(self.almanac_file(files, system, &satellites, &almanacs)?);
        }
        Ok(entries)
    }

    fn almanac_file(
        &self,
        files: &Files<'_>,
        system: &System,
        satellites: &[GnssSatellite],
        almanacs: &[Almanac],
    ) -> Result<FileEntry, WriteError> {
        let metadata = self.propagated_metadata(Frame::EarthFixed);
        let path = format!("yuma/{}.alm", system.name());
        let contents = Contents {
            objects: almanacs.len(),
            metadata: &metadata,
        };
        let entry = files.add(
            &path,
            ProductVersion {
                product: Product::Yuma,
                version: yuma::FORMAT_VERSION,
            },
            contents,
            |out| {
                for almanac in almanacs {
                    almanac.write(out)?;
                    writeln!(out)?;
                }
                let shifts = satellites.iter().zip(almanacs);
                let shift = |(one, almanac): (&GnssSatellite, &Almanac)| {
                    radius_shift_km(almanac, &one.orbit).abs()
                };
                Ok(Loss {
                    theory_max_km: shifts.map(shift).reduce(f64::max),
                    ..Loss::default()
                })
            },
        )?;
        let names: Vec<String> = (1..)
            .zip(satellites)
            .map(|(prn, one)| format!("PRN-{prn:02} = {}", one.name))
            .collect();
        Ok(entry.assuming(vec![
            "nominal satellites, not the real ones; the LEO design is not included".to_owned(),
            "A is chosen to give the rate of the argument of latitude under J2, so the radius is off by up to theory_max_km"
                .to_owned(),
            "week modulo 1024, time of applicability in GPS time".to_owned(),
            names.join(", "),
        ]))
    }
}

fn in_scenario(name: &str) -> String {
    format!("{STK_SCENARIO_DIRECTORY}{name}")
}

/// What the starting states of mean elements are.
fn gmat_start(model: Model) -> &'static str {
    match model {
        Model::TwoBody => "states follow from the elements around a point mass",
        _ => {
            "states are osculating: the mean elements with first-order short-period terms; GMAT's \
             trajectory includes those terms (some kilometres from secular J2) and drifts in-track by \
             the second order of J2, 1 to 3 km a day"
        }
    }
}

/// What holds for every script.
const GMAT_ASSUMPTIONS: [&str; 3] = [
    "mu, R and J2 are in navwalker-j2.cof, which must be in the same directory as the script",
    "GMAT orients the field with its own precession, nutation and Earth-orientation data",
    "the constellation alone: GMAT has no region, mask or PDOP, and the GNSS is left out",
];

fn reason(why: NoAlmanac) -> &'static str {
    match why {
        NoAlmanac::Sgp4 => "is propagated by SGP4",
        NoAlmanac::Eccentric => "is on an ellipse, whose perigee moves",
    }
}

fn almanacs(
    satellites: &[GnssSatellite],
    epoch: crate::time::Epoch,
    at: Applicability,
) -> Result<Vec<Almanac>, (String, NoAlmanac)> {
    let numbered = (1..).zip(satellites);
    numbered
        .map(|(prn, one)| Almanac::of(one, prn, epoch, at).map_err(|why| (one.name.clone(), why)))
        .collect()
}

fn in_stk(system: &System, satellite: GnssSatellite) -> InStk {
    let plain = |c: char| {
        if c.is_ascii_alphanumeric() || c == '-' {
            c
        } else {
            '_'
        }
    };
    let name: String = format!("{}-{}", system.name(), satellite.name)
        .chars()
        .map(plain)
        .collect();
    if let GnssOrbit::Secular(orbit) = &satellite.orbit {
        return InStk {
            setting: Setting::J2(orbit.elements_at(0.0)),
            propagated: None,
            name,
        };
    }
    InStk {
        setting: Setting::File(format!("gnss/{name}.e")),
        propagated: Some(EphemerisSatellite {
            name: name.clone(),
            slot: None,
            propagator: Box::new(satellite.orbit),
        }),
        name,
    }
}
