//! Messages in XML (CCSDS 502.0-B-3, section 8; 505.0-B-2), written and read.

use super::open_segment::{OpenSegment, SegmentChoice};
use super::read::{HEADER, METADATA, check_segment, header, metadata};
use super::rules::MessageRules;
use super::{Oem, Segment, SegmentMetadata, StateLine, VERSION};
use crate::formats::ReadError;
use crate::formats::ccsds::keywords::{KvnKeyword, may, must};
use crate::formats::ccsds::kvn::KvnBlock;
use crate::formats::ccsds::ndm::{self, NdmMessage};
use crate::formats::ccsds::xml::{
    XmlLeaf, XmlNode, begin_file, write_comments, write_header, write_leaves,
};
use crate::formats::text::finding::FindingList;
use crate::formats::text::fixed::FixedDecimals;
use crate::formats::text::lines::keep_comment;
use crate::formats::text::timestamp::{SecondDigits, calendar};
use crate::frames::State;
use nalgebra::Vector3;
use std::io::{self, BufRead, Write};

/// Elements of a `stateVector`.
const STATE: &[KvnKeyword] = &[
    must("EPOCH"),
    must("X").unit("km"),
    must("Y").unit("km"),
    must("Z").unit("km"),
    must("X_DOT").unit("km/s"),
    must("Y_DOT").unit("km/s"),
    must("Z_DOT").unit("km/s"),
    may("X_DDOT").unit("km/s**2"),
    may("Y_DDOT").unit("km/s**2"),
    may("Z_DDOT").unit("km/s**2"),
];

impl Oem {
    /// Writes the message as an XML file.
    ///
    /// # Errors
    /// If writing fails.
    pub fn write_xml(&self, out: &mut impl Write) -> io::Result<()> {
        begin_file(out, "oem", VERSION, self.header.version)?;
        write_header(out, &self.header)?;
        writeln!(out, "<body>")?;
        for segment in &self.segments {
            let digits = segment.digits();
            begin_segment(out, &segment.metadata, &segment.comments, digits)?;
            for line in &segment.states {
                write_state(out, line, digits)?;
            }
            end_segment(out)?;
        }
        writeln!(out, "</body>\n</oem>")
    }
}

/// Writes the part of a segment before its states.
pub(super) fn begin_segment(
    out: &mut impl Write,
    metadata: &SegmentMetadata,
    comments: &[String],
    digits: SecondDigits,
) -> io::Result<()> {
    writeln!(out, "<segment>\n<metadata>")?;
    write_comments(out, &metadata.comments)?;
    for (key, value) in metadata.pairs(digits) {
        write_leaves(out, [(key, value.as_str())])?;
    }
    writeln!(out, "</metadata>\n<data>")?;
    write_comments(out, comments)
}

/// Ends a segment.
pub(super) fn end_segment(out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "</data>\n</segment>")
}

/// Writes a state with the digits of the other notation.
pub(super) fn write_state(
    out: &mut impl Write,
    line: &StateLine,
    digits: SecondDigits,
) -> io::Result<()> {
    let (r, v) = (line.state.position_km.km(), line.state.velocity_km_s);
    writeln!(
        out,
        "<stateVector><EPOCH>{}</EPOCH>",
        calendar(line.epoch, digits)
    )?;
    for (tag, x) in [("X", r.x), ("Y", r.y), ("Z", r.z)] {
        writeln!(out, "<{tag}>{}</{tag}>", FixedDecimals::<9>(x))?;
    }
    for (tag, x) in [("X_DOT", v.x), ("Y_DOT", v.y), ("Z_DOT", v.z)] {
        writeln!(out, "<{tag}>{}</{tag}>", FixedDecimals::<12>(x))?;
    }
    if let Some(a) = line.acceleration_km_s2 {
        for (tag, x) in [("X_DDOT", a.x), ("Y_DDOT", a.y), ("Z_DDOT", a.z)] {
            writeln!(out, "<{tag}>{}</{tag}>", FixedDecimals::<12>(x))?;
        }
    }
    writeln!(out, "</stateVector>")
}

/// Reads the messages of an XML file; the first broken rule ends it.
///
/// # Errors
/// The first finding, or a failure of the input.
pub fn read_xml(input: impl BufRead) -> Result<Vec<Oem>, ReadError> {
    let mut findings = FindingList::of_reader();
    let mut messages = Vec::new();
    parse_xml(input, &mut findings, |message| messages.push(message))?;
    findings.unless_error(messages)
}

/// Passes every valid message to `take`: the one of the file, or those of a
/// combined instantiation, whose messages of other kinds are left out by name.
///
/// # Errors
/// A failure of the input.
pub fn parse_xml(
    input: impl BufRead,
    findings: &mut FindingList,
    mut take: impl FnMut(Oem),
) -> io::Result<()> {
    ndm::parse(input, &["oem"], findings, |message| {
        if let NdmMessage::Oem(message) = message {
            take(message);
        }
    })
}

/// The innermost part of a message that the next leaf belongs to.
enum OemXmlSection {
    Header,
    Body,
    Metadata(KvnBlock),
    Data,
    State(KvnBlock),
    /// A covariance, which is not kept.
    Covariance,
}

/// A message while it is read.
pub(in crate::formats::ccsds) struct OemXmlMessage {
    part: OemXmlSection,
    header: KvnBlock,
    rules: MessageRules,
    segment_place: (usize, usize),
    segment: Option<OpenSegment>,
    segments: Vec<Segment>,
}

impl OemXmlMessage {
    pub(in crate::formats::ccsds) fn new(
        version: Option<&str>,
        place: (usize, usize),
        findings: &mut FindingList,
    ) -> Self {
        let mut header = KvnBlock::new(&[HEADER]);
        if let Some(version) = version {
            header.accept_at((VERSION, version), None, place, findings);
        }
        Self {
            part: OemXmlSection::Body,
            header,
            rules: MessageRules::default(),
            segment_place: place,
            segment: None,
            segments: Vec::new(),
        }
    }

    pub(in crate::formats::ccsds) fn node(
        &mut self,
        node: &XmlNode,
        place: (usize, usize),
        choice: SegmentChoice<'_>,
        findings: &mut FindingList,
    ) {
        match node {
            XmlNode::Open(name, _) => self.open(name, place),
            XmlNode::Leaf(leaf) => self.leaf(leaf, place, findings),
            XmlNode::Close(name) => self.close(name, place, choice, findings),
        }
    }

    fn open(&mut self, name: &str, place: (usize, usize)) {
        match name {
            "header" => self.part = OemXmlSection::Header,
            "segment" => self.segment_place = place,
            "metadata" => self.part = OemXmlSection::Metadata(KvnBlock::new(&[METADATA])),
            "data" => self.part = OemXmlSection::Data,
            "stateVector" => self.part = OemXmlSection::State(KvnBlock::new(&[STATE])),
            "covarianceMatrix" => self.part = OemXmlSection::Covariance,
            _ => {}
        }
    }

    fn leaf(&mut self, leaf: &XmlLeaf, place: (usize, usize), findings: &mut FindingList) {
        let is_comment = leaf.name == "COMMENT";
        let text = leaf.text.as_str();
        let (pair, unit) = ((leaf.name.as_str(), leaf.text.trim()), leaf.unit.as_deref());
        match (&mut self.part, &mut self.segment) {
            (OemXmlSection::Header, _) if is_comment => {
                keep_comment(&mut self.header.comments, text)
            }
            (OemXmlSection::Header, _) => self.header.accept_at(pair, unit, place, findings),
            (OemXmlSection::Metadata(block), _) if is_comment => {
                keep_comment(&mut block.comments, text)
            }
            (OemXmlSection::Metadata(block) | OemXmlSection::State(block), _) => {
                block.accept_at(pair, unit, place, findings);
            }
            (OemXmlSection::Data, Some(open)) if is_comment => {
                keep_comment(&mut open.segment.comments, text)
            }
            (OemXmlSection::Covariance, _) => {}
            (OemXmlSection::Data, None) if is_comment => {}
            (OemXmlSection::Body | OemXmlSection::Data, _) => {
                let message = format!("element {} is not allowed here", leaf.name);
                findings.error(place, "ccsds-keyword", message);
            }
        }
    }

    fn close(
        &mut self,
        name: &str,
        place: (usize, usize),
        choice: SegmentChoice<'_>,
        findings: &mut FindingList,
    ) {
        match (name, &self.part) {
            ("metadata", OemXmlSection::Metadata(block)) => {
                let metadata = metadata(block, place.0, findings);
                if let Some(metadata) = &metadata {
                    self.rules.check_metadata(metadata, block, findings);
                }
                self.segment = metadata.map(|metadata| OpenSegment::new(metadata, choice));
                self.part = OemXmlSection::Body;
            }
            ("stateVector", OemXmlSection::State(block)) => {
                let line = state(block, place, findings);
                if let (Some(open), Some(line)) = (&mut self.segment, line)
                    && self
                        .rules
                        .admit(&open.segment.metadata, &line, place.0, findings)
                {
                    open.push(line);
                }
                self.part = OemXmlSection::Data;
            }
            ("covarianceMatrix", _) => self.part = OemXmlSection::Data,
            ("segment", _) => {
                if let Some(OpenSegment { segment, .. }) = self.segment.take() {
                    let lines = self.rules.lines();
                    check_segment(&segment.metadata, lines, self.segment_place, findings);
                    self.segments.push(segment);
                }
                self.part = OemXmlSection::Body;
            }
            _ => self.part = OemXmlSection::Body,
        }
    }

    pub(in crate::formats::ccsds) fn end(
        self,
        place: (usize, usize),
        findings: &mut FindingList,
    ) -> Option<Oem> {
        let header = header(&self.header, place.0, findings);
        if self.segments.is_empty() {
            findings.error(place, "oem-empty", "the message has no segments");
        }
        Some(Oem {
            header: header?,
            segments: self.segments,
        })
    }
}

fn state(block: &KvnBlock, place: (usize, usize), findings: &mut FindingList) -> Option<StateLine> {
    block.finish(place, findings);
    let epoch = block.stamp("EPOCH", findings);
    let vector = |keys: [&str; 3]| {
        let [x, y, z] = keys.map(|key| block.number(key));
        Some(Vector3::new(x?, y?, z?))
    };
    let position = vector(["X", "Y", "Z"]);
    let velocity = vector(["X_DOT", "Y_DOT", "Z_DOT"]);
    let acceleration = vector(["X_DDOT", "Y_DDOT", "Z_DDOT"]);
    Some(StateLine {
        epoch: epoch?,
        state: State::new(position?, velocity?),
        acceleration_km_s2: acceleration,
    })
}
