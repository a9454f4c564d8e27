//! Satellites read from a file of any format, propagated by the theory that the file implies.
//!
//! Element sets (TLE, OMM) propagate by SGP4; tables of mean elements, and parameter messages that hold
//! them, by the model of the study; sampled states are used as they are, at their samples.
//!
//! Three rules hold for every format, each in one place: which descriptions are of the same object
//! ([`crate::constellation::identity`]), which states can belong to an Earth orbit
//! ([`crate::orbit::earth_orbit`]), and that everything left out is counted and named
//! ([`crate::formats::text::finding::LeftOut`]). `docs/formats.md` describes them for users.

mod choice;
mod gathered;
mod inclusion;
mod merged;
mod names;
mod objects;
mod propagation;
mod sampling;

pub use choice::StateChoice;
use gathered::GatheredFleet;
pub use merged::{Merged, MergedFiles};
use names::stem;
pub use objects::{NoSuchSatellite, SatelliteFilter};
pub use propagation::FleetError;
pub use sampling::SamplingNote;

use crate::ephemeris::arc::{Arc, Interpolation};
use crate::ephemeris::derivative::velocities;
use crate::exchange::lint::{Format, xml_kinds};
use crate::exchange::recognise::{Unread, recognise, unpacked};
use crate::formats::ccsds::ndm::{self, NdmMessage};
use crate::formats::ccsds::omm::OmmSyntax;
use crate::formats::ccsds::{oem, omm, opm};
use crate::formats::csv::ElementsRow;
use crate::formats::kept_states::KeptStates;
use crate::formats::maps::czml;
use crate::formats::text::finding::{FindingList, LeftOut};
use crate::formats::trajectory::{
    Trajectory, TrajectoryError, frame_of_sp3_name, time_system_of_name,
};
use crate::formats::yuma::Almanac;
use crate::formats::{ReadError, csv, sem, sp3, stk, tle, yuma};
use crate::frames::{Frame, State};
use crate::printable::printable;
use std::io::{self, BufRead};
use thiserror::Error;

/// The usual interpolation for SP3, which names none: eleven positions (M. Schenewerk, *A brief review of basic GPS orbit
/// interpolation strategies*, GPS Solutions 6 (2003) 265).
const SP3_INTERPOLATION: Interpolation = Interpolation::Lagrange(10);

/// Satellites as read from files.
#[derive(Debug, Clone, PartialEq)]
pub enum Fleet {
    /// Element sets for SGP4.
    Sets(Vec<sgp4::Elements>),
    /// Mean elements of secular J2.
    Elements(Vec<ElementsRow>),
    /// States.
    Sampled(Vec<Trajectory>),
    /// Almanacs of navigation satellites.
    Almanacs(Vec<Almanac>),
    /// Parts of different kinds, each of one of the kinds above.
    Mixed(Vec<Fleet>),
}

/// The contents of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// Its format.
    pub format: Format,
    /// Its satellites.
    pub fleet: Fleet,
    /// The parts that are not read.
    pub left_out: LeftOut,
}

/// Why a file gives no satellites.
#[derive(Debug, Error)]
pub enum ReadFleetError {
    /// It violates its format.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// Its format is not supported.
    #[error(transparent)]
    Unread(#[from] Unread),
    /// Its states cannot be transformed to a known frame.
    #[error(transparent)]
    Trajectory(#[from] TrajectoryError),
    /// A parameter message of another program: one state, and no theory to propagate it.
    #[error("{name}: the message has a state at one instant but no mean elements to propagate")]
    NoTheory {
        /// The satellite.
        name: String,
    },
    /// A satellite whose file has a single sample without a velocity, or two at one instant.
    #[error("{name}: there are no velocities, and too few positions to derive them")]
    NoVelocity {
        /// The satellite.
        name: String,
    },
}

impl Fleet {
    /// Reads a file in `format`, or in the format detected from its beginning and its name. Names are as they can be
    /// shown ([`printable`]).
    ///
    /// # Errors
    /// If the file violates its format, or its states are in an unknown frame or time system.
    pub fn read(
        input: impl BufRead,
        format: Option<Format>,
        file_name: Option<&str>,
    ) -> Result<Imported, ReadFleetError> {
        Self::read_chosen(input, format, file_name, &StateChoice::default())
    }

    /// The same, in which OEM, SP3, STK and CZML keep the states of `choice`.
    ///
    /// # Errors
    /// As of [`Self::read`].
    pub fn read_chosen(
        input: impl BufRead,
        format: Option<Format>,
        file_name: Option<&str>,
        choice: &StateChoice,
    ) -> Result<Imported, ReadFleetError> {
        let kinds = xml_kinds(format);
        let (format, input) = match format {
            Some(format) => (format, unpacked(input).map_err(ReadError::Io)?),
            None => {
                let recognised = recognise(input, file_name).map_err(ReadError::Io)?;
                (recognised.content?, recognised.input)
            }
        };
        let file_name = file_name.map(|name| name.strip_suffix(".gz").unwrap_or(name));
        let mut findings = FindingList::of_reader();
        let mut fleet = Self::read_as((format, kinds), input, (file_name, choice), &mut findings)?;
        fleet.name_after_file(file_name);
        fleet.make_names_printable();
        Ok(Imported {
            format,
            fleet,
            left_out: findings.left_out().clone(),
        })
    }

    fn read_as(
        (format, kinds): (Format, &[&str]),
        input: impl BufRead,
        (file_name, choice): (Option<&str>, &StateChoice),
        findings: &mut FindingList,
    ) -> Result<Self, ReadFleetError> {
        let of_segment = |metadata: &oem::SegmentMetadata| choice.of_segment(metadata, file_name);
        let omm = |input, syntax, findings: &mut FindingList| {
            let messages = all(findings, |findings, take| {
                omm::parse(input, syntax, findings, take)
            })?;
            Ok(Self::of_omm(messages))
        };
        match format {
            Format::Tle => {
                let records = all(findings, |findings, take| tle::parse(input, findings, take))?;
                let sets = records.into_iter().map(|record| record.set);
                Ok(Self::Sets(sets.collect()))
            }
            Format::Omm => omm(input, OmmSyntax::Kvn, findings),
            Format::OmmXml | Format::OemXml | Format::OpmXml => {
                Self::of_ndm(kinds, input, findings, &of_segment)
            }
            Format::OmmJson => omm(input, OmmSyntax::Json, findings),
            Format::OmmCsv => omm(input, OmmSyntax::Csv, findings),
            Format::Oem => Self::of_oem(input, findings, &of_segment),
            Format::Opm => Self::of_opm(opm::read(input)?),
            Format::Sp3 => {
                let kept = |name: &str| choice.kept((name, name), file_name);
                let file = whole(findings, |findings| sp3::parse_kept(input, findings, &kept))?;
                Self::of_sp3(file, &kept)
            }
            Format::Stk => {
                // The file does not name its satellite, which gets the name of the file.
                let name = stem(file_name.unwrap_or("satellite"));
                let kept = choice.kept((name, name), file_name);
                let file = whole(findings, |findings| stk::parse_kept(input, findings, kept))?;
                Ok(Self::of_stk(file, name))
            }
            Format::ElementsCsv => Ok(Self::Elements(csv::read_elements(input)?)),
            Format::Czml => {
                let kept = |name: &str| choice.kept((name, name), file_name);
                let read = whole(findings, |findings| {
                    czml::parse_kept(input, findings, &kept)
                })?;
                Ok(Self::Sampled(read))
            }
            Format::Yuma => {
                let almanacs = whole(findings, |findings| yuma::parse(input, findings))?;
                Ok(Self::of_almanacs(almanacs))
            }
            Format::Sem => {
                let almanacs = whole(findings, |findings| sem::parse(input, findings))?;
                Ok(Self::of_almanacs(almanacs))
            }
            Format::StatesCsv => Ok(Self::Sampled(csv::read_states(input)?)),
        }
    }

    /// Messages of a kind go together; the first message's kind comes first.
    fn of_ndm(
        kinds: &[&str],
        input: impl BufRead,
        findings: &mut FindingList,
        choice: oem::SegmentChoice<'_>,
    ) -> Result<Self, ReadFleetError> {
        let fleet = gathered(
            GatheredFleet::default(),
            findings,
            |findings, take| ndm::parse_kept(input, kinds, findings, choice, take),
            |fleet, message| {
                fleet.add(match message {
                    NdmMessage::Oem(message) => Self::of_segments(message.segments)?,
                    NdmMessage::Omm(message) => Self::Sets(vec![message.set]),
                    NdmMessage::Opm(message) => Self::of_opm(*message)?,
                });
                Ok(())
            },
        )?;
        Ok(fleet.finish())
    }

    fn of_omm(messages: Vec<omm::Omm>) -> Self {
        Self::Sets(messages.into_iter().map(|message| message.set).collect())
    }

    /// Satellites that are unhealthy are not used; the reader has counted them.
    fn of_almanacs(almanacs: Vec<Almanac>) -> Self {
        Self::Almanacs(almanacs.into_iter().filter(Almanac::is_healthy).collect())
    }

    /// Each segment is turned into a trajectory as soon as it has been read.
    fn of_oem(
        input: impl BufRead,
        findings: &mut FindingList,
        choice: oem::SegmentChoice<'_>,
    ) -> Result<Self, ReadFleetError> {
        let fleet = gathered(
            GatheredFleet::from(Self::Sampled(Vec::new())),
            findings,
            |findings, take| oem::parse_kept(input, findings, choice, take).map(drop),
            |fleet, segment: oem::Segment| {
                fleet.add(Self::Sampled(vec![segment.into_trajectory()?]));
                Ok(())
            },
        )?;
        Ok(fleet.finish())
    }

    /// The segments of one satellite follow each other.
    fn of_segments(segments: Vec<oem::Segment>) -> Result<Self, ReadFleetError> {
        let mut fleet = GatheredFleet::from(Self::Sampled(Vec::new()));
        for segment in segments {
            fleet.add(Self::Sampled(vec![segment.into_trajectory()?]));
        }
        Ok(fleet.finish())
    }

    fn of_opm(message: opm::Opm) -> Result<Self, ReadFleetError> {
        if !message.is_about_earth() {
            return Err(ReadFleetError::Trajectory(TrajectoryError::Center {
                name: printable(&message.object_name).into_owned(),
                center: printable(&message.center_name).into_owned(),
            }));
        }
        let system = time_system_of_name(&message.time_system).map_err(TrajectoryError::Name)?;
        match message.mean_elements() {
            Some(elements) => Ok(Self::Elements(vec![ElementsRow {
                name: message.object_name,
                epoch: system.epoch(message.epoch),
                elements,
            }])),
            None => Err(ReadFleetError::NoTheory {
                name: printable(&message.object_name).into_owned(),
            }),
        }
    }

    fn of_sp3(mut file: sp3::Sp3, choice: sp3::Sp3Choice<'_>) -> Result<Self, ReadFleetError> {
        let frame = frame_of_sp3_name(&file.frame).map_err(TrajectoryError::Name)?;
        let mut trajectories = Vec::new();
        let states = std::mem::take(&mut file.states);
        for ((id, samples), span) in file.ids.iter().zip(states).zip(&file.spans) {
            let Some(span) = span else { continue };
            let name = file.name_of(id).unwrap_or(id);
            if choice(name) == KeptStates::None {
                trajectories.push(Trajectory {
                    name: name.to_owned(),
                    id: name.to_owned(),
                    arcs: vec![Arc::without_states(frame, SP3_INTERPOLATION, *span)],
                });
                continue;
            }
            if samples.is_empty() {
                continue;
            }
            let runs = file.split_at_gaps(samples).into_iter();
            let arcs = runs.map(|run| sp3_arc(frame, run));
            let arcs = arcs.collect::<Option<Vec<Arc>>>();
            trajectories.push(Trajectory {
                name: name.to_owned(),
                // Ids start again in each file: across files only names distinguish satellites.
                id: name.to_owned(),
                arcs: arcs.ok_or_else(|| ReadFleetError::NoVelocity {
                    name: printable(id).into_owned(),
                })?,
            });
        }
        Ok(Self::Sampled(trajectories))
    }

    /// Without a finding there is a file.
    fn of_stk(file: Option<stk::StkEphemeris>, name: &str) -> Self {
        let trajectory = |file: stk::StkEphemeris| Trajectory {
            name: name.to_owned(),
            id: name.to_owned(),
            arcs: file.into_arcs(),
        };
        Self::Sampled(file.map(trajectory).into_iter().collect())
    }

    /// Adds the satellites of another file. Sampled states of a known satellite continue its states if their
    /// spans do not overlap. [`MergedFiles`] does the same for many files.
    pub fn append(&mut self, other: Self) {
        let mut gathered = GatheredFleet::from(std::mem::replace(self, Self::Mixed(Vec::new())));
        gathered.add(other);
        *self = gathered.finish();
    }

    /// Its content, in words.
    #[must_use]
    pub fn content(&self) -> String {
        match self {
            Self::Sets(_) => "SGP4 element sets".to_owned(),
            Self::Elements(_) => "mean elements".to_owned(),
            Self::Sampled(_) => "sampled states".to_owned(),
            Self::Almanacs(_) => "almanacs".to_owned(),
            Self::Mixed(parts) => {
                let contents: Vec<String> = parts.iter().map(Self::content).collect();
                contents.join(", ")
            }
        }
    }

    /// Number of satellites.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Sets(sets) => sets.len(),
            Self::Elements(rows) => rows.len(),
            Self::Sampled(trajectories) => trajectories.len(),
            Self::Almanacs(almanacs) => almanacs.len(),
            Self::Mixed(parts) => parts.iter().map(Self::len).sum(),
        }
    }

    /// Whether there are no satellites.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// The result of a parser, or the first violation in the file.
fn whole<T>(
    findings: &mut FindingList,
    parse: impl FnOnce(&mut FindingList) -> io::Result<T>,
) -> Result<T, ReadError> {
    let parsed = parse(findings)?;
    match findings.first_error() {
        Some(first) => Err(first.clone().into()),
        None => Ok(parsed),
    }
}

/// Everything that a parser reads, or the first violation in the file.
fn all<T>(
    findings: &mut FindingList,
    parse: impl FnOnce(&mut FindingList, &mut dyn FnMut(T)) -> io::Result<()>,
) -> Result<Vec<T>, ReadError> {
    let mut taken = Vec::new();
    parse(findings, &mut |one| taken.push(one))?;
    match findings.first_error() {
        Some(first) => Err(first.clone().into()),
        None => Ok(taken),
    }
}

/// Everything that a parser reads, added to `kept` part by part; or the first violation in the file, or else the first
/// part that cannot be added.
fn gathered<K, T>(
    mut kept: K,
    findings: &mut FindingList,
    parse: impl FnOnce(&mut FindingList, &mut dyn FnMut(T)) -> io::Result<()>,
    add: impl Fn(&mut K, T) -> Result<(), ReadFleetError>,
) -> Result<K, ReadFleetError> {
    let mut failed = Ok(());
    parse(findings, &mut |part| {
        if failed.is_ok() {
            failed = add(&mut kept, part);
        }
    })
    .map_err(ReadError::Io)?;
    match findings.first_error() {
        Some(first) => Err(ReadError::from(first.clone()).into()),
        None => failed.map(|()| kept),
    }
}

/// The arc of a run without gaps; velocities that are not given follow from the positions of the run.
fn sp3_arc(frame: Frame, run: Vec<sp3::Sp3Sample>) -> Option<Arc> {
    let derived = match run.iter().all(|sample| sample.velocity_km_s.is_some()) {
        true => Vec::new(),
        false => velocities(run.len(), |place| (run[place].at, run[place].position_km))?,
    };
    let mut derived = derived.into_iter();
    let node = |sample: sp3::Sp3Sample| {
        let derived = derived.next();
        let state = State {
            position_km: sample.position_km,
            velocity_km_s: sample.velocity_km_s.or(derived).unwrap_or_default(),
        };
        (sample.at, state)
    };
    // In the memory of the samples, of which the rest is given back.
    let mut nodes: Vec<_> = run.into_iter().map(node).collect();
    nodes.shrink_to_fit();
    let arc = Arc::new(frame, SP3_INTERPOLATION, nodes)?;
    Some(Arc {
        is_open: true,
        ..arc
    })
}

#[cfg(test)]
mod tests;
