//! Navigation Data Messages in XML (CCSDS 505.0-B-2): a single message, or a combined instantiation of
//! messages of any type.

use super::oem::{self, Oem};
use super::omm::{self, Omm};
use super::xml::{Nodes, XmlNode};
use crate::formats::text::finding::FindingList;
use std::io::{self, BufRead};

/// Message types (505.0-B-2 and its successors).
const KINDS: [&str; 10] = [
    "acm", "aem", "apm", "cdm", "ocm", "oem", "omm", "opm", "rdm", "tdm",
];

/// Supported message types.
pub const READ: &[&str] = &["oem", "omm"];

/// A message of a supported type.
#[derive(Debug, Clone, PartialEq)]
pub enum NdmMessage {
    /// Ephemeris.
    Oem(Oem),
    /// Mean elements.
    Omm(Omm),
}

/// A message being read.
enum OpenMessage {
    Oem(Box<oem::OemXmlMessage>),
    Omm(Box<omm::OmmXmlMessage>),
    /// A message of an unsupported type, at this depth.
    Other(usize),
}

/// Passes the messages of a file to `take`, until the list of findings is full. `wanted` lists the types to read, of
/// which the file must contain at least one; messages of other types are skipped and listed.
///
/// # Errors
/// A failure of the input.
pub fn parse(
    input: impl BufRead,
    wanted: &[&str],
    findings: &mut FindingList,
    mut take: impl FnMut(NdmMessage),
) -> io::Result<()> {
    let mut nodes = Nodes::new(input);
    let mut open: Option<OpenMessage> = None;
    let (mut depth, mut any) = (0, false);
    while let Some((place, node)) = nodes.next(findings)? {
        match (&node, &mut open) {
            (XmlNode::Open(name, version), None) if name != "ndm" || depth > 0 => {
                let version = version.as_deref();
                open = Some(match name.as_str() {
                    "oem" if wanted.contains(&"oem") => {
                        any = true;
                        OpenMessage::Oem(Box::new(oem::OemXmlMessage::new(
                            version, place, findings,
                        )))
                    }
                    "omm" if wanted.contains(&"omm") => {
                        any = true;
                        OpenMessage::Omm(Box::new(omm::OmmXmlMessage::new(
                            version, place, findings,
                        )))
                    }
                    name => {
                        // A root of an unknown type is not a message.
                        if depth > 0 || KINDS.contains(&name) {
                            findings.leave_out(place, "message", name);
                        }
                        OpenMessage::Other(depth)
                    }
                });
            }
            (XmlNode::Leaf(leaf), None) if KINDS.contains(&leaf.name.as_str()) => {
                findings.leave_out(place, "message", &leaf.name);
            }
            (XmlNode::Close(name), Some(OpenMessage::Oem(_))) if name == "oem" => {
                if let Some(OpenMessage::Oem(message)) = open.take() {
                    let message = message.end(place, findings);
                    message.map(NdmMessage::Oem).into_iter().for_each(&mut take);
                }
            }
            (XmlNode::Close(name), Some(OpenMessage::Omm(_))) if name == "omm" => {
                if let Some(OpenMessage::Omm(message)) = open.take() {
                    let message = message.end(nodes.place(), findings);
                    message.map(NdmMessage::Omm).into_iter().for_each(&mut take);
                }
            }
            (XmlNode::Close(_), Some(OpenMessage::Other(at))) if *at + 1 == depth => open = None,
            (_, Some(OpenMessage::Oem(message))) => message.node(&node, place, findings),
            (_, Some(OpenMessage::Omm(message))) => message.node(&node, place, findings),
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
    if !any {
        let message = format!(
            "the file contains no supported message ({})",
            wanted.join(", ")
        );
        findings.error(nodes.place(), "ndm-empty", message);
    }
    Ok(())
}
