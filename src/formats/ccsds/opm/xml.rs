//! Messages in XML (CCSDS 502.0-B-3, section 8; 505.0-B-2), written and read.

use super::read::{MANOEUVRE, MESSAGE, end_manoeuvre, message, take_user_defined, unsupported};
use super::{Opm, USER_DEFINED, VERSION};
use crate::formats::ReadError;
use crate::formats::ccsds::keywords::{COVARIANCE, SPACECRAFT};
use crate::formats::ccsds::kvn::KvnBlock;
use crate::formats::ccsds::ndm::{self, NdmMessage};
use crate::formats::ccsds::xml::{
    XmlLeaf, XmlNode, begin_file, write_comments, write_header, write_leaves,
};
use crate::formats::text::finding::FindingList;
use crate::formats::text::lines::keep_comment;
use quick_xml::escape::escape;
use std::io::{self, BufRead, Write};

/// The element of a parameter that a user defines; its name is an attribute (502.0-B-3, 8.10).
const PARAMETER: &str = "USER_DEFINED";

impl Opm {
    /// Writes the message as an XML file.
    ///
    /// # Errors
    /// If writing fails.
    pub fn write_xml(&self, out: &mut impl Write) -> io::Result<()> {
        begin_file(out, "opm", VERSION, self.header.version)?;
        write_header(out, &self.header)?;
        writeln!(out, "<body>\n<segment>\n<metadata>")?;
        write_pairs(out, self.metadata())?;
        writeln!(out, "</metadata>\n<data>\n<stateVector>")?;
        write_pairs(out, self.state_vector())?;
        writeln!(out, "</stateVector>")?;
        if let Some(keplerian) = &self.keplerian {
            writeln!(out, "<keplerianElements>")?;
            write_comments(out, &[super::KEPLERIAN_COMMENT.to_owned()])?;
            write_pairs(out, keplerian.pairs())?;
            writeln!(out, "</keplerianElements>")?;
        }
        if !self.user_defined.is_empty() {
            writeln!(out, "<userDefinedParameters>")?;
            for (key, value) in &self.user_defined {
                let name = key.strip_prefix(super::USER_DEFINED).unwrap_or(key);
                let (name, value) = (escape(name), escape(value));
                writeln!(
                    out,
                    "<{PARAMETER} parameter=\"{name}\">{value}</{PARAMETER}>"
                )?;
            }
            writeln!(out, "</userDefinedParameters>")?;
        }
        writeln!(out, "</data>\n</segment>\n</body>\n</opm>")
    }
}

fn write_pairs<const N: usize>(
    out: &mut impl Write,
    pairs: [(&'static str, String); N],
) -> io::Result<()> {
    let leaves = pairs.iter().map(|(key, value)| (*key, value.as_str()));
    write_leaves(out, leaves)
}

/// Reads the messages of an XML file; the first broken rule ends it.
///
/// # Errors
/// The first finding, or a failure of the input.
pub fn read_xml(input: impl BufRead) -> Result<Vec<Opm>, ReadError> {
    let mut findings = FindingList::of_reader();
    let mut messages = Vec::new();
    ndm::parse(input, &["opm"], &mut findings, |message| {
        if let NdmMessage::Opm(message) = message {
            messages.push(*message);
        }
    })?;
    findings.unless_error(messages)
}

/// A message while it is read.
pub(in crate::formats::ccsds) struct OpmXmlMessage {
    block: KvnBlock,
    in_header: bool,
    manoeuvre: Option<KvnBlock>,
    user_defined: Vec<(String, String)>,
}

/// A message and, if it cannot be propagated, the place of the keyword that is the reason, and the reason.
type ReadOpm = (Opm, Option<((usize, usize), String)>);

impl OpmXmlMessage {
    pub(in crate::formats::ccsds) fn new(
        version: Option<&str>,
        place: (usize, usize),
        findings: &mut FindingList,
    ) -> Self {
        let mut block = KvnBlock::new(&[MESSAGE, SPACECRAFT, COVARIANCE]);
        if let Some(version) = version {
            block.accept_at((VERSION, version), None, place, findings);
        }
        Self {
            block,
            in_header: false,
            manoeuvre: None,
            user_defined: Vec::new(),
        }
    }

    pub(in crate::formats::ccsds) fn node(
        &mut self,
        node: &XmlNode,
        place: (usize, usize),
        findings: &mut FindingList,
    ) {
        match node {
            XmlNode::Open(name, _) if name == "header" => self.in_header = true,
            XmlNode::Close(name) if name == "header" => self.in_header = false,
            XmlNode::Open(name, _) if name == "maneuverParameters" => {
                self.manoeuvre = Some(KvnBlock::new(&[MANOEUVRE]));
            }
            XmlNode::Close(name) if name == "maneuverParameters" => {
                if let Some(manoeuvre) = self.manoeuvre.take() {
                    end_manoeuvre(manoeuvre, place, findings);
                }
            }
            XmlNode::Open(..) | XmlNode::Close(_) => {}
            XmlNode::Leaf(leaf) => self.leaf(leaf, place, findings),
        }
    }

    fn leaf(&mut self, leaf: &XmlLeaf, place: (usize, usize), findings: &mut FindingList) {
        let value = leaf.text.trim();
        match leaf.name.as_str() {
            "COMMENT" if self.in_header => keep_comment(&mut self.block.comments, &leaf.text),
            "COMMENT" => {}
            PARAMETER => {
                let Some(name) = &leaf.parameter else {
                    let message = format!("{PARAMETER} needs the attribute parameter, its name");
                    findings.error(place, "ccsds-missing", message);
                    return;
                };
                let key = format!("{USER_DEFINED}{name}");
                take_user_defined((&key, value), place, &mut self.user_defined, findings);
            }
            name => {
                let block = self.manoeuvre.as_mut().unwrap_or(&mut self.block);
                block.accept_at((name, value), leaf.unit.as_deref(), place, findings);
            }
        }
    }

    pub(in crate::formats::ccsds) fn end(
        self,
        place: (usize, usize),
        findings: &mut FindingList,
    ) -> Option<ReadOpm> {
        let message = message(&self.block, self.user_defined, place, findings)?;
        let unsupported = unsupported(&message, &self.block);
        Some((message, unsupported))
    }
}
