//! Reads the satellites of a CZML document: packets with sampled positions, in one interval or several, in one
//! packet or several.

use super::packet::{Packet, PositionPacket};
use super::value::{PositionKind, algorithm, each_node, frame, interval, samples};
use crate::ephemeris::arc::{Arc, Interpolation};
use crate::ephemeris::derivative::velocities;
use crate::formats::ReadError;
use crate::formats::kept_states::{KeptStates, StateKeeper};
use crate::formats::text::finding::FindingList;
use crate::formats::text::json::{JsonObject, Objects};
use crate::formats::trajectory::Trajectory;
use crate::frames::{Frame, State};
use crate::orbit::earth_orbit::check_position;
use crate::time::Epoch;
use std::collections::HashMap;
use std::io::{self, BufRead};

/// Longest packet, bytes: a year of one satellite has some tens of MB.
const MAX_PACKET: usize = 1 << 30;

/// Maximum length of a chain of position references.
const MOST_REFERENCES: usize = 8;

/// Reads the satellites; those of a GNSS that `navwalker` wrote in addition to a design are skipped.
///
/// # Errors
/// The first finding, or a failure of the input.
pub fn read(input: impl BufRead) -> Result<Vec<Trajectory>, ReadError> {
    let mut findings = FindingList::of_reader();
    let trajectories = parse(input, &mut findings)?;
    findings.unless_error(trajectories)
}

/// Reads the satellites; errors are added to the list of findings.
///
/// # Errors
/// A failure of the input.
pub fn parse(input: impl BufRead, findings: &mut FindingList) -> io::Result<Vec<Trajectory>> {
    parse_kept(input, findings, &|_| KeptStates::All)
}

/// Says which states of the object of an id are kept.
pub(super) type CzmlChoice<'a> = &'a dyn Fn(&str) -> KeptStates<Epoch>;

/// The same, with the states that `choice` keeps of each object.
///
/// # Errors
/// A failure of the input.
pub fn parse_kept(
    input: impl BufRead,
    findings: &mut FindingList,
    choice: CzmlChoice<'_>,
) -> io::Result<Vec<Trajectory>> {
    let mut objects = Objects::new(input).up_to(MAX_PACKET);
    let mut document = CzmlDocument::default();
    let mut first = true;
    while let Some(object) = objects.next(findings)? {
        let Some(packet) = object.parsed::<Packet>(findings) else {
            break;
        };
        let fault = if std::mem::take(&mut first) {
            document_fault(&packet)
        } else {
            document.add(packet, &object, choice, findings).err()
        };
        if let Some((rule, key, message)) = fault {
            findings.error(object.place_of(key), rule, message);
        }
    }
    if first && !findings.is_full() {
        findings.error((1, 1), "czml-document", "the document has no packets");
    }
    Ok(document.trajectories(findings))
}

/// The rule that is broken, the key at which, and how.
pub(super) type PacketFault = (&'static str, &'static str, String);

/// *CZML Guide*, "CZML Structure": the first packet has the id `document` and the version.
fn document_fault(packet: &Packet) -> Option<PacketFault> {
    if packet.id.as_deref() != Some("document") {
        let message = "the first packet must have the id \"document\"".to_owned();
        return Some(("czml-document", "id", message));
    }
    let version = packet.version.as_ref().and_then(serde_json::Value::as_str);
    let version = version.unwrap_or_default();
    (version != super::FORMAT_VERSION).then(|| {
        let message = format!("version {version:?} is not {:?}", super::FORMAT_VERSION);
        ("czml-version", "version", message)
    })
}

/// The objects of a document, from the packets read so far.
#[derive(Default)]
struct CzmlDocument {
    objects: Vec<CzmlObject>,
    places: HashMap<String, usize>,
}

/// An object, by the packets of one id.
struct CzmlObject {
    name: String,
    place: (usize, usize),
    pieces: Vec<Piece>,
    /// The position that it shares.
    reference: Option<String>,
    availability: Vec<(Epoch, Epoch)>,
    kept: KeptStates<Epoch>,
}

/// ArraySamples in one interval, or in all.
struct Piece {
    interval: Option<(Epoch, Epoch)>,
    frame: Frame,
    algorithm: Option<CzmlAlgorithm>,
    degree: Option<usize>,
    has_velocities: bool,
    /// The first and the last instant of all samples.
    span: (Epoch, Epoch),
    /// The samples that are kept.
    nodes: Vec<(Epoch, State<Frame>)>,
    kept: KeptStates<Epoch>,
}

#[derive(Clone, Copy, PartialEq)]
pub(super) enum CzmlAlgorithm {
    Linear,
    Lagrange,
    Hermite,
}

impl CzmlDocument {
    fn add(
        &mut self,
        packet: Packet,
        object: &JsonObject,
        choice: CzmlChoice<'_>,
        findings: &mut FindingList,
    ) -> Result<(), PacketFault> {
        let place = object.place_of("position");
        let name = packet
            .id
            .unwrap_or_else(|| format!("packet at line {}", place.0));
        if packet.delete {
            if let Some(index) = self.places.remove(&name) {
                self.objects[index].pieces.clear();
                self.objects[index].reference = None;
            }
            return Ok(());
        }
        if packet.position.is_empty() && packet.availability.is_empty() {
            return Ok(());
        }
        let gnss = packet
            .parent
            .is_some_and(|parent| parent.starts_with("gnss:"));
        if gnss {
            if !packet.position.is_empty() {
                findings.pass_over("satellite of a GNSS beside the design", &name);
            }
            return Ok(());
        }
        let index = self.places.get(&name).copied().unwrap_or_else(|| {
            self.places.insert(name.clone(), self.objects.len());
            self.objects.push(CzmlObject {
                name: name.clone(),
                place,
                pieces: Vec::new(),
                reference: None,
                availability: Vec::new(),
                kept: choice(&name),
            });
            self.objects.len() - 1
        });
        let entry = &mut self.objects[index];
        if !packet.availability.is_empty() {
            let intervals = packet
                .availability
                .iter()
                .map(|text| interval("availability", text));
            entry.availability = intervals.collect::<Result<_, _>>()?;
        }
        for position in packet.position {
            entry.add(&position, findings)?;
        }
        Ok(())
    }

    fn trajectories(mut self, findings: &mut FindingList) -> Vec<Trajectory> {
        let mut found = Vec::new();
        for at in 0..self.objects.len() {
            let mut of = at;
            for _ in 0..MOST_REFERENCES {
                let Some(target) = self.objects[of].reference.as_deref() else {
                    break;
                };
                let known = target.strip_suffix("#position");
                let Some(next) = known.and_then(|id| self.places.get(id)) else {
                    break;
                };
                of = *next;
            }
            if let Some(target) = &self.objects[of].reference {
                let CzmlObject { name, place, .. } = &self.objects[at];
                let message = format!("{name}: its position refers to {target}, which has none");
                findings.error(*place, "czml-reference", message);
                continue;
            }
            let arcs = match of == at {
                true if self.is_referred_to(at) => self.objects[at].arcs(),
                true => std::mem::take(&mut self.objects[at].pieces)
                    .into_iter()
                    .filter_map(Piece::arc)
                    .collect(),
                false => self.objects[of].arcs(),
            };
            let CzmlObject {
                name, availability, ..
            } = &self.objects[at];
            let mut arcs = within(arcs, availability);
            arcs.sort_by_key(|arc| arc.useable.0);
            if !arcs.is_empty() {
                found.push(Trajectory {
                    name: name.clone(),
                    id: name.clone(),
                    arcs,
                });
            }
        }
        found
    }

    fn is_referred_to(&self, at: usize) -> bool {
        let name = &self.objects[at].name;
        let refers = |reference: &String| reference.strip_suffix("#position") == Some(name);
        let mut references = self.objects.iter().filter_map(|one| one.reference.as_ref());
        references.any(refers)
    }
}

impl CzmlObject {
    fn add(
        &mut self,
        position: &PositionPacket,
        findings: &mut FindingList,
    ) -> Result<(), PacketFault> {
        if position.delete {
            let message = format!(
                "{}: positions that are deleted again are not read",
                self.name
            );
            return Err(("czml-delete", "delete", message));
        }
        if let Some(reference) = &position.reference {
            self.reference = Some(reference.clone());
            return Ok(());
        }
        let text = position.interval.as_deref();
        let interval = text.map(|text| interval("interval", text)).transpose()?;
        let Some((key, samples, kind)) = samples(position) else {
            let message = format!("{}: the position has no supported value", self.name);
            return Err(("czml-position", "position", message));
        };
        if samples.numbers.len() == kind.numbers() {
            findings.pass_over("place that does not move", &self.name);
            return Ok(());
        }
        let frame = frame(position, kind)?;
        let mut span: Option<(Epoch, Epoch)> = None;
        let mut keeper = StateKeeper::new(self.kept);
        let mut nodes = Vec::new();
        each_node(
            key,
            samples,
            kind,
            position.epoch.as_deref(),
            |at, state| {
                if let Err(fault) = check_position(&state.position_km.km()) {
                    let message = format!("{} at {at}: {fault}", self.name);
                    return Err(("implausible-state", key, message));
                }
                span = Some((span.map_or(at, |(first, _)| first), at));
                keeper.push(&mut nodes, at, (at, state));
                Ok(())
            },
        )?;
        let Some(span) = span else { return Ok(()) };
        let algorithm = algorithm(position)?;
        let degree = position
            .interpolation_degree
            .map(|degree| degree.clamp(1, 50) as usize);
        let has_velocities = kind == PositionKind::CartesianVelocity;
        let same = self.pieces.iter_mut().find(|piece| {
            (piece.interval, piece.frame, piece.has_velocities) == (interval, frame, has_velocities)
        });
        match same {
            Some(piece) => {
                piece.algorithm = algorithm.or(piece.algorithm);
                piece.degree = degree.or(piece.degree);
                piece.span = (piece.span.0.min(span.0), piece.span.1.max(span.1));
                piece.nodes.extend(nodes);
            }
            None => self.pieces.push(Piece {
                interval,
                frame,
                algorithm,
                degree,
                has_velocities,
                span,
                nodes,
                kept: self.kept,
            }),
        }
        Ok(())
    }

    fn arcs(&self) -> Vec<Arc> {
        let copy = |piece: &Piece| Piece {
            nodes: piece.nodes.clone(),
            ..*piece
        };
        self.pieces
            .iter()
            .map(copy)
            .filter_map(Piece::arc)
            .collect()
    }
}

impl Piece {
    /// Its samples in the order of time. A sample that is given again replaces the one before, as in CesiumJS
    /// (`SampledProperty.addSamplesPackedArray`).
    fn arc(mut self) -> Option<Arc> {
        if !self.nodes.is_sorted_by(|one, other| one.0 < other.0) {
            self.nodes.reverse();
            self.nodes.sort_by_key(|(at, _)| *at);
            self.nodes.dedup_by_key(|(at, _)| *at);
        }
        self.kept.cut(&mut self.nodes, |(at, _)| *at);
        if !self.has_velocities {
            let position = |place: usize| {
                let (at, state) = self.nodes[place];
                (at, state.position_km)
            };
            let derived = velocities(self.nodes.len(), position).unwrap_or_default();
            for ((_, state), velocity_km_s) in self.nodes.iter_mut().zip(derived) {
                state.velocity_km_s = velocity_km_s;
            }
        }
        // The nodes of CesiumJS: `LagrangePolynomialApproximation`, `HermitePolynomialApproximation`,
        // the latter without velocities being the former.
        let degree = self.degree.unwrap_or(1);
        let interpolation = match self.algorithm.unwrap_or(CzmlAlgorithm::Linear) {
            CzmlAlgorithm::Linear => Interpolation::Lagrange(1),
            CzmlAlgorithm::Hermite if self.has_velocities => Interpolation::Hermite(degree),
            CzmlAlgorithm::Hermite | CzmlAlgorithm::Lagrange => Interpolation::Lagrange(degree),
        };
        let arc = match self.nodes.is_empty() {
            true => Arc::without_states(self.frame, interpolation, self.span),
            false => Arc::new(self.frame, interpolation, self.nodes)?,
        };
        match self.interval {
            Some(interval) => arc.within(interval),
            None => Some(arc),
        }
    }
}

/// The arcs where the object is available; everywhere if no availability is given.
fn within(arcs: Vec<Arc>, availability: &[(Epoch, Epoch)]) -> Vec<Arc> {
    match availability {
        [] => arcs,
        [only] => arcs
            .into_iter()
            .filter_map(|arc| arc.within(*only))
            .collect(),
        several => {
            let cut = |arc: &Arc| -> Vec<Arc> {
                let each = several.iter().map(|one| arc.clone().within(*one));
                each.flatten().collect()
            };
            arcs.iter().flat_map(cut).collect()
        }
    }
}
