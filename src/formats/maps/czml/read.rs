//! Reads the satellites of a CZML document: packets with sampled positions, in one interval or several, in one
//! packet or several.

use super::packet::{Packet, PositionPacket, Samples};
use crate::earth::Surface;
use crate::ephemeris::arc::{Arc, Interpolation, still};
use crate::ephemeris::derivative::velocities;
use crate::formats::ReadError;
use crate::formats::text::finding::FindingList;
use crate::formats::text::json::{JsonObject, Objects};
use crate::formats::text::timestamp;
use crate::formats::trajectory::Trajectory;
use crate::frames::{Frame, State};
use crate::orbit::earth_orbit::check_position;
use crate::time::Epoch;
use nalgebra::Vector3;
use std::collections::HashMap;
use std::io::{self, BufRead};

/// Longest packet, bytes: a year of one satellite has some tens of MB.
const MAX_PACKET: usize = 1 << 30;

/// Most references from one position to the next.
const MOST_REFERENCES: usize = 8;

/// Reads the satellites; those of a GNSS that `navwalker` wrote beside a design are passed over.
///
/// # Errors
/// The first finding, or a failure of the input.
pub fn read(input: impl BufRead) -> Result<Vec<Trajectory>, ReadError> {
    let mut findings = FindingList::of_reader();
    let trajectories = parse(input, &mut findings)?;
    findings.unless_error(trajectories)
}

/// Reads the satellites; what the document breaks goes to the list of findings.
///
/// # Errors
/// A failure of the input.
pub fn parse(input: impl BufRead, findings: &mut FindingList) -> io::Result<Vec<Trajectory>> {
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
            document.add(packet, &object, findings).err()
        };
        if let Some((rule, key, message)) = fault {
            findings.error(object.place_of(key), rule, message);
        }
    }
    if first && !findings.is_full() {
        findings.error((1, 1), "czml-document", "there is no packet");
    }
    Ok(document.trajectories(findings))
}

/// The rule that is broken, the key at which, and how.
type PacketFault = (&'static str, &'static str, String);

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

/// What the packets of a document have said of its objects so far.
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
}

/// Samples in one interval, or in all.
struct Piece {
    interval: Option<(Epoch, Epoch)>,
    frame: Frame,
    algorithm: Option<Algorithm>,
    degree: Option<usize>,
    has_velocities: bool,
    nodes: Vec<(Epoch, State<Frame>)>,
}

#[derive(Clone, Copy, PartialEq)]
enum Algorithm {
    Linear,
    Lagrange,
    Hermite,
}

impl CzmlDocument {
    fn add(
        &mut self,
        packet: Packet,
        object: &JsonObject,
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
            let message = format!("{}: the position has no value that is read", self.name);
            return Err(("czml-position", "position", message));
        };
        if samples.numbers.len() == kind.numbers() {
            findings.pass_over("place that does not move", &self.name);
            return Ok(());
        }
        let frame = frame(position, kind)?;
        let nodes = nodes(key, samples, kind, position.epoch.as_deref())?;
        for (at, state) in &nodes {
            if let Err(fault) = check_position(&state.position_km.km()) {
                let message = format!("{} at {at}: {fault}", self.name);
                return Err(("implausible-state", key, message));
            }
        }
        let algorithm = algorithm(position)?;
        let degree = position
            .interpolation_degree
            .map(|degree| degree.clamp(1, 50) as usize);
        let has_velocities = kind == Kind::CartesianVelocity;
        let same = self.pieces.iter_mut().find(|piece| {
            (piece.interval, piece.frame, piece.has_velocities) == (interval, frame, has_velocities)
        });
        match same {
            Some(piece) => {
                piece.algorithm = algorithm.or(piece.algorithm);
                piece.degree = degree.or(piece.degree);
                piece.nodes.extend(nodes);
            }
            None => self.pieces.push(Piece {
                interval,
                frame,
                algorithm,
                degree,
                has_velocities,
                nodes,
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
        if !self.has_velocities {
            let positions: Vec<_> = self
                .nodes
                .iter()
                .map(|(at, s)| (*at, s.position_km))
                .collect();
            let derived = velocities(&positions).unwrap_or_default();
            for ((_, state), velocity_km_s) in self.nodes.iter_mut().zip(derived) {
                state.velocity_km_s = velocity_km_s;
            }
        }
        // The nodes of CesiumJS: `LagrangePolynomialApproximation`, `HermitePolynomialApproximation`,
        // the latter without velocities being the former.
        let degree = self.degree.unwrap_or(1);
        let interpolation = match self.algorithm.unwrap_or(Algorithm::Linear) {
            Algorithm::Linear => Interpolation::Lagrange(1),
            Algorithm::Hermite if self.has_velocities => Interpolation::Hermite(degree),
            Algorithm::Hermite | Algorithm::Lagrange => Interpolation::Lagrange(degree),
        };
        let arc = Arc::new(self.frame, interpolation, self.nodes)?;
        match self.interval {
            Some(interval) => arc.within(interval),
            None => Some(arc),
        }
    }
}

/// The arcs where the object is available; everywhere if nothing is said.
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

/// What the numbers of a position mean.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Cartesian,
    CartesianVelocity,
    Degrees,
    Radians,
}

impl Kind {
    /// Numbers of a sample, without the time.
    fn numbers(self) -> usize {
        match self {
            Self::CartesianVelocity => 6,
            _ => 3,
        }
    }

    /// Kilometres from metres, or from longitude, latitude and height on the ellipsoid.
    fn state(self, numbers: &[f64]) -> State<Frame> {
        let vector = |from: usize| Vector3::from_row_slice(&numbers[from..from + 3]) / 1000.0;
        let geodetic = |longitude_rad: f64, latitude_rad: f64| {
            let surface = Surface::Wgs84;
            let foot_km = surface.position_km(latitude_rad, longitude_rad);
            let up = surface.vertical(latitude_rad, longitude_rad);
            still(foot_km + up * (numbers[2] / 1000.0))
        };
        match self {
            Self::Cartesian => still(vector(0)),
            Self::CartesianVelocity => State::new(vector(0), vector(3)),
            Self::Degrees => geodetic(numbers[0].to_radians(), numbers[1].to_radians()),
            Self::Radians => geodetic(numbers[0], numbers[1]),
        }
    }
}

fn samples(position: &PositionPacket) -> Option<(&'static str, &Samples, Kind)> {
    let given = [
        (
            "cartesianVelocity",
            &position.cartesian_velocity,
            Kind::CartesianVelocity,
        ),
        ("cartesian", &position.cartesian, Kind::Cartesian),
        (
            "cartographicDegrees",
            &position.cartographic_degrees,
            Kind::Degrees,
        ),
        (
            "cartographicRadians",
            &position.cartographic_radians,
            Kind::Radians,
        ),
    ];
    let mut given = given.into_iter();
    given.find_map(|(key, samples, kind)| Some((key, samples.as_ref()?, kind)))
}

fn algorithm(position: &PositionPacket) -> Result<Option<Algorithm>, PacketFault> {
    match position.interpolation_algorithm.as_deref() {
        None => Ok(None),
        Some("LINEAR") => Ok(Some(Algorithm::Linear)),
        Some("LAGRANGE") => Ok(Some(Algorithm::Lagrange)),
        Some("HERMITE") => Ok(Some(Algorithm::Hermite)),
        Some(other) => {
            let message = format!("interpolation {other} is not LINEAR, LAGRANGE or HERMITE");
            Err(("czml-interpolation", "interpolationAlgorithm", message))
        }
    }
}

/// Cartographic positions are Earth-fixed whatever the frame.
fn frame(position: &PositionPacket, kind: Kind) -> Result<Frame, PacketFault> {
    match position.reference_frame.as_deref() {
        _ if matches!(kind, Kind::Degrees | Kind::Radians) => Ok(Frame::EarthFixed),
        None | Some("FIXED") => Ok(Frame::EarthFixed),
        Some("INERTIAL") => Ok(Frame::Gcrf),
        Some(other) => {
            let message = format!("frame {other:?} is neither FIXED nor INERTIAL");
            Err(("czml-frame", "referenceFrame", message))
        }
    }
}

/// The samples, their times being texts or seconds since the epoch.
fn nodes(
    key: &'static str,
    samples: &Samples,
    kind: Kind,
    epoch: Option<&str>,
) -> Result<Vec<(Epoch, State<Frame>)>, PacketFault> {
    let broken = |message: String| ("czml-samples", key, message);
    let length = kind.numbers() + 1;
    if !samples.numbers.len().is_multiple_of(length) || samples.numbers.is_empty() {
        let message = format!("samples are a time and {} numbers each", length - 1);
        return Err(broken(message));
    }
    if samples
        .texts
        .iter()
        .any(|(place, _)| !place.is_multiple_of(length))
    {
        return Err(broken("a sample is not of numbers".to_owned()));
    }
    let texts: HashMap<usize, &String> = samples
        .texts
        .iter()
        .map(|(place, text)| (*place, text))
        .collect();
    let origin = match epoch {
        Some(text) => Some(instant(text).ok_or_else(|| {
            let message = format!("epoch {text:?} is not an ISO 8601 date and time");
            ("czml-epoch", "epoch", message)
        })?),
        None => None,
    };
    let mut nodes: Vec<(Epoch, State<Frame>)> = Vec::with_capacity(samples.numbers.len() / length);
    for (k, sample) in samples.numbers.chunks_exact(length).enumerate() {
        let at = match (texts.get(&(k * length)), origin) {
            (Some(text), _) => instant(text)
                .ok_or_else(|| broken(format!("{text:?} is not an ISO 8601 date and time")))?,
            (None, Some(origin)) => origin.plus_seconds(sample[0]),
            (None, None) => {
                let message = "samples in seconds need an epoch".to_owned();
                return Err(("czml-epoch", key, message));
            }
        };
        if nodes.last().is_some_and(|(before, _)| *before > at) {
            return Err(broken(
                "the times of the samples do not increase".to_owned(),
            ));
        }
        nodes.push((at, kind.state(&sample[1..])));
    }
    Ok(nodes)
}

/// The two instants of `2025-01-01T00:00:00Z/2025-01-02T00:00:00Z`.
fn interval(key: &'static str, text: &str) -> Result<(Epoch, Epoch), PacketFault> {
    let ends = text.split_once('/');
    let ends = ends.and_then(|(first, last)| Some((instant(first)?, instant(last)?)));
    ends.filter(|(first, last)| first <= last).ok_or_else(|| {
        let message = format!("{text:?} is not an interval of ISO 8601 dates and times");
        ("czml-interval", key, message)
    })
}

/// An instant in UTC or with an offset from it.
fn instant(text: &str) -> Option<Epoch> {
    timestamp::parse_with_offset(text).map(|at| Epoch::from_utc(at.and_utc()))
}
