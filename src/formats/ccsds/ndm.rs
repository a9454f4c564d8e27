//! Navigation Data Messages in XML (CCSDS 505.0-B-2): a single message, or a combined instantiation of
//! messages of any type.

use super::oem::{self, Oem, SegmentChoice};
use super::omm::{self, Omm};
use super::opm::{self, Opm};
use super::xml::{Nodes, XmlNode};
use crate::formats::kept_states::KeptStates;
use crate::formats::text::finding::FindingList;
use std::io::{self, BufRead};

/// Message types (505.0-B-2 and its successors).
const KINDS: [&str; 10] = [
    "acm", "aem", "apm", "cdm", "ocm", "oem", "omm", "opm", "rdm", "tdm",
];

/// Supported message types.
pub const READ: &[&str] = &["oem", "omm", "opm"];

/// A message of a supported type.
#[derive(Debug, Clone, PartialEq)]
pub enum NdmMessage {
    /// Ephemeris.
    Oem(Oem),
    /// Mean elements.
    Omm(Omm),
    /// Parameters.
    Opm(Box<Opm>),
}

/// A message being read.
enum OpenMessage {
    Oem(Box<oem::OemXmlMessage>),
    Omm(Box<omm::OmmXmlMessage>),
    Opm(Box<opm::OpmXmlMessage>),
}

/// The element that the next node belongs to.
enum OpenElement {
    Message(OpenMessage),
    /// A message of an unsupported type, at this depth.
    Other(usize),
}

impl OpenMessage {
    /// A message of one of the types to read.
    fn begin(
        name: &str,
        version: Option<&str>,
        place: (usize, usize),
        findings: &mut FindingList,
    ) -> Option<Self> {
        match name {
            "oem" => {
                let message = oem::OemXmlMessage::new(version, place, findings);
                Some(Self::Oem(Box::new(message)))
            }
            "omm" => {
                let message = omm::OmmXmlMessage::new(version, place, findings);
                Some(Self::Omm(Box::new(message)))
            }
            "opm" => {
                let message = opm::OpmXmlMessage::new(version, place, findings);
                Some(Self::Opm(Box::new(message)))
            }
            _ => None,
        }
    }

    fn name(&self) -> &'static str {
        match self {
            Self::Oem(_) => "oem",
            Self::Omm(_) => "omm",
            Self::Opm(_) => "opm",
        }
    }

    fn node(
        &mut self,
        node: &XmlNode,
        place: (usize, usize),
        choice: SegmentChoice<'_>,
        findings: &mut FindingList,
    ) {
        match self {
            Self::Oem(message) => message.node(node, place, choice, findings),
            Self::Omm(message) => message.node(node, place, findings),
            Self::Opm(message) => message.node(node, place, findings),
        }
    }

    /// The message, if it is valid. In a combined instantiation, parameters without a theory to propagate them are left
    /// out; alone, they make a file that cannot be read.
    fn end(
        self,
        place: (usize, usize),
        is_combined: bool,
        findings: &mut FindingList,
    ) -> Option<NdmMessage> {
        match self {
            Self::Oem(message) => message.end(place, findings).map(NdmMessage::Oem),
            Self::Omm(message) => message.end(place, findings).map(NdmMessage::Omm),
            Self::Opm(message) => {
                let (message, unsupported) = message.end(place, findings)?;
                match unsupported {
                    Some(_) if is_combined => {
                        let name =
                            format!("opm of {} that cannot be propagated", message.object_name);
                        findings.leave_out(place, "message", &name);
                        return None;
                    }
                    Some((at, reason)) => findings.unsupported(at, reason),
                    None => {}
                }
                Some(NdmMessage::Opm(Box::new(message)))
            }
        }
    }
}

/// Passes the messages of a file to `take`, until the list of findings is full. `wanted` lists the types to read, of
/// which the file must contain at least one; messages of other types are skipped and listed, and so are, in a combined
/// instantiation, parameter messages that cannot be propagated.
///
/// # Errors
/// A failure of the input.
pub fn parse(
    input: impl BufRead,
    wanted: &[&str],
    findings: &mut FindingList,
    take: impl FnMut(NdmMessage),
) -> io::Result<()> {
    parse_kept(input, wanted, findings, &|_| KeptStates::All, take)
}

/// The same, with the states that `choice` keeps of each segment of an ephemeris.
///
/// # Errors
/// A failure of the input.
pub fn parse_kept(
    input: impl BufRead,
    wanted: &[&str],
    findings: &mut FindingList,
    choice: SegmentChoice<'_>,
    mut take: impl FnMut(NdmMessage),
) -> io::Result<()> {
    let mut nodes = Nodes::new(input);
    let mut open: Option<OpenElement> = None;
    let (mut depth, mut any) = (0, false);
    while let Some((place, node)) = nodes.next(findings)? {
        match (&node, &mut open) {
            (XmlNode::Open(name, version), None) if name != "ndm" || depth > 0 => {
                let is_wanted = wanted.contains(&name.as_str());
                let begun = is_wanted
                    .then(|| OpenMessage::begin(name, version.as_deref(), place, findings))
                    .flatten();
                // A root of an unknown type is not a message.
                if begun.is_none() && (depth > 0 || KINDS.contains(&name.as_str())) {
                    findings.leave_out(place, "message", name);
                }
                open = Some(begun.map_or(OpenElement::Other(depth), OpenElement::Message));
            }
            (XmlNode::Leaf(leaf), None) if KINDS.contains(&leaf.name.as_str()) => {
                findings.leave_out(place, "message", &leaf.name);
            }
            (XmlNode::Close(name), Some(OpenElement::Message(message)))
                if name == message.name() =>
            {
                if let Some(OpenElement::Message(message)) = open.take() {
                    let message = message.end(place, depth > 1, findings);
                    any |= message.is_some();
                    message.into_iter().for_each(&mut take);
                }
            }
            (XmlNode::Close(_), Some(OpenElement::Other(at))) if *at + 1 == depth => open = None,
            (_, Some(OpenElement::Message(message))) => {
                message.node(&node, place, choice, findings);
            }
            _ => {}
        }
        match node {
            XmlNode::Open(..) => depth += 1,
            XmlNode::Close(_) => depth = depth.saturating_sub(1),
            XmlNode::Leaf(_) => {}
        }
        if findings.is_full() {
            return Ok(());
        }
    }
    if !any && !findings.has_errors() {
        let message = format!(
            "the file contains no supported message ({})",
            wanted.join(", ")
        );
        findings.error(nodes.place(), "ndm-empty", message);
    }
    Ok(())
}
