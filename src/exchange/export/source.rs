//! The data from which the products of an export are made.

use super::{Choices, ExportError, ExportSubject, Product, ShownScenario, Sink, write};
use crate::constellation::{Design, shell_letters};
use crate::earth::RADIUS_KM;
use crate::ephemeris::{Ephemeris, EphemerisError, EphemerisSatellite};
use crate::exchange::identities::{changed, plain_ascii, stems};
use crate::exchange::manifest::{ChangedIdentity, Conventions, FileEntry, Manifest};
use crate::exchange::members::{ConstellationMember, Origin};
use crate::formats::maps::scene::{Scene, ShownConstellation};
use crate::formats::metadata::{Metadata, Object, Theory, distance_from_itrf};
use crate::formats::text::timestamp::TimeSystem;
use crate::frames::Frame;
use crate::orbit::PropagationError;
use crate::units::counted;

/// Longest name of a constellation or a file in a comment.
const LONGEST_NAME: usize = 120;

/// A constellation that is ready for export: propagated, and with the identities under which it goes out.
pub struct ExportSource<'a> {
    pub(super) subject: &'a ExportSubject,
    pub(super) choices: Choices,
    /// The satellites, in the order of the ephemeris.
    pub(in crate::exchange) members: Vec<ConstellationMember<'a>>,
    pub(in crate::exchange) objects: Vec<Object>,
    changed: Vec<ChangedIdentity>,
    /// Names of files for each satellite.
    pub(super) stems: Vec<String>,
    pub(super) ephemeris: Ephemeris,
    /// Largest distance of a satellite from the centre of the Earth, km: of shells, their semi-major axes.
    radius_km: f64,
}

impl<'a> ExportSource<'a> {
    /// Propagates a constellation and names its satellites.
    ///
    /// # Errors
    /// If a satellite cannot be propagated or named, or has no state at a sample.
    pub fn new(subject: &'a ExportSubject, choices: Choices) -> Result<Self, ExportError> {
        let (grid, constellation) = (subject.grid, &subject.constellation);
        let members = constellation.members(grid.epoch());
        let objects = subject.naming.objects(&members, grid.epoch());
        let objects = objects.map_err(crate::formats::WriteError::from)?;
        let stems = subject.left(stems(&objects));
        let (members, objects) = (subject.left(members), subject.left(objects));
        let ephemeris = constellation.continuous_ephemeris(grid, subject.model)?;
        let mut ephemeris = ephemeris.without(&subject.down);
        for (satellite, object) in ephemeris.satellites_mut().iter_mut().zip(&objects) {
            satellite.name.clone_from(&object.name);
        }
        let mut source = Self {
            subject,
            choices,
            stems,
            changed: changed(&members, &objects),
            members,
            objects,
            ephemeris,
            radius_km: 0.0,
        };
        source.require_states()?;
        source.radius_km = source.largest_radius_km()?;
        Ok(source)
    }

    /// The satellites under the names that they go out with.
    #[must_use]
    pub fn ephemeris(&self) -> &Ephemeris {
        &self.ephemeris
    }

    /// Whether every satellite has mean elements that the model of the study propagates.
    #[must_use]
    pub fn has_mean_elements(&self) -> bool {
        let (epoch, model) = (self.subject.grid.epoch(), self.subject.model);
        let mut origins = self.members.iter().map(|member| member.origin);
        origins.all(|origin| origin.mean_elements(epoch, model).is_some())
    }

    /// Writes the products in their order and then the manifest, which it also returns. `shown` is the scenario around
    /// the constellation, for the products that show it.
    ///
    /// # Errors
    /// If an element, the constellation or the scenario cannot be expressed in a format, a file cannot be written, or a
    /// product needs the scenario. What a product cannot express is an error before anything is written.
    pub fn export(
        &self,
        products: &[Product],
        shown: Option<ShownScenario<'_>>,
        sink: &impl Sink,
    ) -> Result<Manifest, ExportError> {
        for product in products {
            self.require_expressible(*product)?;
        }
        let scene = shown.map(|shown| self.scene(shown));
        Ok(write(self, products, scene.as_ref(), sink)?)
    }

    /// Sampled satellites need a state at every instant: no format here writes gaps.
    fn require_states(&self) -> Result<(), ExportError> {
        let sampled = self.satellites().filter_map(|(satellite, member)| {
            matches!(member.origin, Origin::Sampled).then_some(satellite)
        });
        for satellite in sampled {
            for elapsed_s in self.subject.grid.iter() {
                if self.ephemeris.state_or_gap(satellite, elapsed_s)?.is_none() {
                    return Err(ExportError::Gap {
                        name: satellite.name.clone(),
                        at: self.subject.grid.epoch().plus_seconds(elapsed_s),
                    });
                }
            }
        }
        Ok(())
    }

    fn largest_radius_km(&self) -> Result<f64, EphemerisError> {
        let design = self.subject.constellation.design.as_ref();
        let highest_km = design.map(Design::highest_altitude_km);
        let mut radius_km = highest_km.map_or(0.0, |altitude_km| RADIUS_KM + altitude_km);
        for (satellite, _) in self
            .satellites()
            .filter(|(_, member)| member.slot.is_none())
        {
            let state = self.ephemeris.state(satellite, 0.0)?;
            radius_km = radius_km.max(state.position_km.km().norm());
        }
        Ok(radius_km)
    }

    /// The satellites with what describes them.
    pub(super) fn satellites(
        &self,
    ) -> impl Iterator<Item = (&EphemerisSatellite, &ConstellationMember<'a>)> {
        self.ephemeris.satellites().iter().zip(&self.members)
    }

    /// Whether satellites come from files.
    pub(super) fn has_files(&self) -> bool {
        self.subject.constellation.files.is_some()
    }

    /// The theory of the states of one satellite.
    pub(super) fn theory(&self, member: &ConstellationMember<'_>) -> Theory {
        member.origin.theory(self.subject.model)
    }

    /// The theory of a file with the states of all satellites.
    pub(super) fn theory_of_all(&self) -> Theory {
        Theory::of_all(self.members.iter().map(|member| self.theory(member)))
    }

    pub(super) fn metadata(&self, frame: Frame, theory: Theory) -> Metadata {
        let study = &self.subject.study;
        let mut subject = self.description();
        subject.push(format!("Scenario: {}, hash {}", study.name, study.hash));
        Metadata {
            originator: self.subject.originator.clone(),
            creation: self.subject.creation,
            frame,
            time_system: TimeSystem::Utc,
            theory,
            subject,
            frame_note: (frame == Frame::EarthFixed).then(|| self.distance_from_itrf()),
            from_files: self.has_files(),
        }
    }

    /// What the constellation is, in lines of a comment.
    fn description(&self) -> Vec<String> {
        let constellation = &self.subject.constellation;
        let mut lines = Vec::new();
        if let Some(down) = self.subject.told_down() {
            lines.push(format!("Out of service, and not here: {down}"));
        }
        match constellation.only_design() {
            Some(design) if design.only_shell().is_some() => {
                lines.push(format!("Design: {design}"))
            }
            Some(_) => {}
            None => lines.push(format!("Constellation: {}", short(&constellation.name))),
        }
        let shells = constellation.design.iter().flat_map(Design::shells);
        let several = constellation
            .design
            .as_ref()
            .is_some_and(|design| design.only_shell().is_none());
        for (n, shell) in shells.enumerate() {
            if several {
                lines.push(format!("Shell {}: {shell}", shell_letters(n)));
            } else if self.has_files() {
                lines.push(format!("Design: {shell}"));
            }
        }
        if let Some(files) = &constellation.files {
            let names = short(&files.names.join(", "));
            lines.push(format!("Source: {names} ({})", files.format()));
        }
        lines
    }

    /// The distance of the satellites from their positions in an ITRF.
    fn distance_from_itrf(&self) -> String {
        distance_from_itrf(self.subject.grid.epoch(), self.radius_km)
    }

    /// The constellation in its scenario.
    pub(super) fn scene<'s>(&'s self, shown: ShownScenario<'s>) -> Scene<'s> {
        let constellation = &self.subject.constellation;
        let notation = constellation.only_design().map(Design::to_string);
        let propagated = format!("propagated by {}", self.subject.model);
        let told = match &notation {
            Some(notation) => {
                format!(
                    "design: {notation}, mean elements in TEME at the first sample, {propagated}"
                )
            }
            None => {
                let design = constellation.design.as_ref();
                let shells = design.map(|design| format!("; shells: {design}, {propagated}"));
                let converted = self.converted().unwrap_or_default();
                format!("constellation: {converted}{}", shells.unwrap_or_default())
            }
        };
        let of = ShownConstellation {
            ephemeris: &self.ephemeris,
            title: notation
                .clone()
                .unwrap_or_else(|| constellation.name.clone()),
            is_design: notation.is_some(),
            told,
        };
        Scene::new(shown.evaluator, of, shown.surface)
    }

    /// Where satellites come from that are no slots of a shell, and what was made of them.
    fn converted(&self) -> Option<String> {
        let files = self.subject.constellation.files.as_ref()?;
        let of_files = || self.members.iter().filter(|member| member.slot.is_none());
        let theory = Theory::of_all(of_files().map(|member| self.theory(member)));
        Some(format!(
            "{} from {} ({}: {}); theory of their states: {theory}",
            counted(of_files().count(), "satellite"),
            files.names.join(", "),
            files.format(),
            files.fleet.content(),
        ))
    }

    pub(super) fn manifest(&self, files: Vec<FileEntry>) -> Manifest {
        let ExportSubject {
            grid,
            study,
            constellation,
            provenance,
            ..
        } = self.subject;
        let is_design = constellation.only_design().is_some();
        Manifest {
            program: env!("CARGO_PKG_NAME").to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            provenance: provenance.clone(),
            scenario: study.clone(),
            design: constellation.design.as_ref().map(Design::to_string),
            out_of_service: self.subject.down.len(),
            constellation: (!is_design).then(|| constellation.name.clone()),
            converted: self.converted(),
            changed_identities: self.changed.clone(),
            epoch: grid.epoch().to_string(),
            step_s: grid.step_s(),
            samples: grid.len(),
            conventions: Conventions::new(self.distance_from_itrf()),
            files,
        }
    }
}

impl ExportSubject {
    /// What there is one of for each satellite, without those that are down.
    fn left<T>(&self, of_all: Vec<T>) -> Vec<T> {
        let numbered = of_all.into_iter().enumerate();
        let left = numbered.filter(|(place, _)| !self.down.contains(place));
        left.map(|(_, one)| one).collect()
    }

    /// How many satellites are down, in words, if any are.
    fn told_down(&self) -> Option<String> {
        let of = self.constellation.satellite_count();
        let down = self.down.len();
        (down > 0).then(|| format!("{} of {of}", counted(down, "satellite")))
    }
}

/// The first characters of a name, in printable ASCII.
fn short(name: &str) -> String {
    let first: String = name.chars().take(LONGEST_NAME).collect();
    plain_ascii(&first)
}

pub(super) fn failed(satellite: &EphemerisSatellite, source: PropagationError) -> EphemerisError {
    EphemerisError {
        name: satellite.name.clone(),
        source,
    }
}
