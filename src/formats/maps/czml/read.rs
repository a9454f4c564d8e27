//! Reads the satellites of a CZML document: packets with sampled positions.

use super::{lagrange, window};
use crate::formats::ReadError;
use crate::formats::text::finding::FindingList;
use crate::formats::text::json::Objects;
use crate::formats::text::timestamp;
use crate::formats::trajectory::Trajectory;
use crate::frames::{Frame, State};
use crate::time::Epoch;
use nalgebra::Vector3;
use serde_json::Value;
use std::io::{self, BufRead};

/// A satellite of a document: positions, and the polynomial between them.
#[derive(Debug, Clone, PartialEq)]
pub struct CzmlTrack {
    /// The id of its packet.
    pub name: String,
    /// Origin of the times.
    pub epoch: Epoch,
    /// Frame of the positions.
    pub frame: Frame,
    /// Degree of the polynomial between the positions.
    pub degree: usize,
    /// Seconds since the epoch, increasing, and positions, km; two or more.
    pub nodes: Vec<(f64, Vector3<f64>)>,
}

impl CzmlTrack {
    /// The state `elapsed_s` after the epoch of the track, as a viewer interpolates it, with the
    /// derivative of the polynomial as velocity; none outside the samples.
    #[must_use]
    pub fn state(&self, elapsed_s: f64) -> Option<State<Frame>> {
        let (first, last) = (self.nodes.first()?.0, self.nodes.last()?.0);
        if !(first..=last).contains(&elapsed_s) {
            return None;
        }
        let nodes = window(&self.nodes, elapsed_s, self.degree);
        let (position_km, velocity_km_s) = lagrange(nodes, elapsed_s);
        Some(State::new(position_km, velocity_km_s))
    }

    /// The states at the instants of `wanted` that the samples cover.
    #[must_use]
    pub fn trajectory(&self, wanted: impl Iterator<Item = Epoch>) -> Trajectory {
        let state = |at: Epoch| Some((at, self.state(at.seconds_since(self.epoch))?));
        Trajectory {
            name: self.name.clone(),
            id: self.name.clone(),
            frame: self.frame,
            states: wanted.filter_map(state).collect(),
        }
    }

    /// The states at its own samples.
    #[must_use]
    pub fn sampled(&self) -> Trajectory {
        let nodes = self.nodes.iter();
        self.trajectory(nodes.map(|(elapsed_s, _)| self.epoch.plus_seconds(*elapsed_s)))
    }
}

/// Reads the satellites; those of a GNSS that `navwalker` wrote in addition to a design are skipped.
///
/// # Errors
/// The first finding, or a failure of the input.
pub fn read(input: impl BufRead) -> Result<Vec<CzmlTrack>, ReadError> {
    let mut findings = FindingList::of_reader();
    let mut tracks = Vec::new();
    parse(input, &mut findings, |track| tracks.push(track))?;
    findings.unless_error(tracks)
}

/// Reads the satellites one by one; what the document breaks goes to the list of findings.
///
/// # Errors
/// A failure of the input.
pub fn parse(
    input: impl BufRead,
    findings: &mut FindingList,
    mut each: impl FnMut(CzmlTrack),
) -> io::Result<()> {
    let mut objects = Objects::new(input);
    let mut first = true;
    while let Some(object) = objects.next(findings)? {
        let Some(packet) = object.value(findings) else {
            return Ok(());
        };
        let problem = if std::mem::take(&mut first) {
            document_problem(&packet)
        } else {
            let found = track(&packet);
            found
                .map(|track| track.into_iter().for_each(&mut each))
                .err()
        };
        if let Some((rule, key, message)) = problem {
            findings.error(object.place_of(key), rule, message);
        }
    }
    if first && !findings.is_full() {
        findings.error((1, 1), "czml-document", "the document has no packets");
    }
    Ok(())
}

/// The rule that is broken, the key at which, and how.
type PacketFault = (&'static str, &'static str, String);

/// *CZML Guide*, "CZML Structure": the first packet has the id `document` and the version.
fn document_problem(packet: &Value) -> Option<PacketFault> {
    if packet["id"] != "document" {
        let message = "the first packet must have the id \"document\"".to_owned();
        return Some(("czml-document", "id", message));
    }
    let version = packet["version"].as_str().unwrap_or_default();
    (version != super::FORMAT_VERSION).then(|| {
        let message = format!("version {version:?} is not {:?}", super::FORMAT_VERSION);
        ("czml-version", "version", message)
    })
}

/// The satellite of a packet; none if its position is not sampled, or it is of a GNSS.
fn track(packet: &Value) -> Result<Option<CzmlTrack>, PacketFault> {
    let position = &packet["position"];
    let of_gnss = packet["parent"]
        .as_str()
        .is_some_and(|parent| parent.starts_with("gnss:"));
    let Some(cartesian) = position["cartesian"]
        .as_array()
        .filter(|values| values.len() > 3)
    else {
        return Ok(None);
    };
    if of_gnss {
        return Ok(None);
    }
    let algorithm = position["interpolationAlgorithm"]
        .as_str()
        .unwrap_or("LINEAR");
    if !["LAGRANGE", "LINEAR"].contains(&algorithm) {
        let message =
            format!("interpolation {algorithm} is not supported, only LAGRANGE and LINEAR");
        return Err(("czml-interpolation", "interpolationAlgorithm", message));
    }
    let degree = match algorithm {
        "LINEAR" => 1,
        _ => position["interpolationDegree"]
            .as_u64()
            .unwrap_or(1)
            .clamp(1, 50) as usize,
    };
    Ok(Some(CzmlTrack {
        name: packet["id"].as_str().unwrap_or("satellite").to_owned(),
        epoch: epoch(position)?,
        frame: frame(position)?,
        degree,
        nodes: nodes(cartesian)?,
    }))
}

fn epoch(position: &Value) -> Result<Epoch, PacketFault> {
    let text = position["epoch"].as_str().unwrap_or_default();
    match timestamp::parse(text) {
        Some(at) => Ok(Epoch::from_utc(at.and_utc())),
        None => {
            let message = format!("epoch {text:?} is not a UTC date and time");
            Err(("czml-epoch", "epoch", message))
        }
    }
}

fn frame(position: &Value) -> Result<Frame, PacketFault> {
    match position["referenceFrame"].as_str() {
        None | Some("FIXED") => Ok(Frame::EarthFixed),
        Some("INERTIAL") => Ok(Frame::Gcrf),
        Some(other) => {
            let message = format!("frame {other:?} is neither FIXED nor INERTIAL");
            Err(("czml-frame", "referenceFrame", message))
        }
    }
}

/// Seconds and metres, four numbers a sample.
fn nodes(cartesian: &[Value]) -> Result<Vec<(f64, Vector3<f64>)>, PacketFault> {
    let broken = |message: &str| ("czml-samples", "cartesian", message.to_owned());
    let numbers: Option<Vec<f64>> = cartesian.iter().map(Value::as_f64).collect();
    let numbers = numbers.ok_or_else(|| broken("a sample is not a number"))?;
    if numbers.len() % 4 != 0 || numbers.len() < 8 {
        return Err(broken("samples are [seconds, x, y, z, ...], two or more"));
    }
    let nodes: Vec<_> = numbers
        .chunks_exact(4)
        .map(|s| (s[0], Vector3::new(s[1], s[2], s[3]) / 1000.0))
        .collect();
    if nodes.windows(2).any(|pair| pair[1].0 <= pair[0].0) {
        return Err(broken("the times of the samples do not increase"));
    }
    Ok(nodes)
}
