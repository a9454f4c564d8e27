//! Reads messages strictly, line by line.

use super::open_segment::{OpenSegment, SegmentChoice};
use super::rules::{MessageRules, SegmentLines};
use super::{Oem, Segment, SegmentMetadata, StateLine, VERSION};
use crate::formats::ReadError;
use crate::formats::ccsds::keywords::{KvnKeyword, may, must, named};
use crate::formats::ccsds::kvn::{
    CcsdsHeader, Item, KvnBlock, Pair, item, lines, read_number, read_stamp, words,
};
use crate::formats::kept_states::KeptStates;
use crate::formats::text::finding::FindingList;
use crate::formats::text::lines::{Line, keep_comment};
use crate::frames::State;
use nalgebra::Vector3;
use std::io::{self, BufRead};

/// Table 5-2.
pub(super) const HEADER: &[KvnKeyword] = &[
    must(VERSION),
    may("CLASSIFICATION"),
    must("CREATION_DATE"),
    must("ORIGINATOR"),
    may("MESSAGE_ID"),
];

/// Table 5-3.
pub(super) const METADATA: &[KvnKeyword] = &[
    named("OBJECT_NAME"),
    named("OBJECT_ID"),
    must("CENTER_NAME"),
    must("REF_FRAME"),
    may("REF_FRAME_EPOCH"),
    must("TIME_SYSTEM"),
    must("START_TIME"),
    may("USEABLE_START_TIME"),
    may("USEABLE_STOP_TIME"),
    must("STOP_TIME"),
    may("INTERPOLATION"),
    may("INTERPOLATION_DEGREE"),
];

/// Table 5-4, between its markers.
const COVARIANCE: &[KvnKeyword] = &[must("EPOCH"), may("COV_REF_FRAME")];

/// Reads a message; the first broken rule ends it.
///
/// # Errors
/// The first finding, or a failure of the input.
pub fn read(input: impl BufRead) -> Result<Oem, ReadError> {
    let mut findings = FindingList::of_reader();
    let mut segments = Vec::new();
    let header = parse(input, &mut findings, |segment| segments.push(segment))?;
    let message = header.map(|header| Oem { header, segments });
    let read = findings.unless_error(message)?;
    // Without a finding there is a header.
    read.ok_or_else(|| io::Error::from(io::ErrorKind::UnexpectedEof).into())
}

/// Passes every valid segment to `take`, until the list of findings is full.
/// The header, if it keeps them too.
///
/// # Errors
/// A failure of the input.
pub fn parse(
    input: impl BufRead,
    findings: &mut FindingList,
    take: impl FnMut(Segment),
) -> io::Result<Option<CcsdsHeader>> {
    parse_kept(input, findings, &|_| KeptStates::All, take)
}

/// The same, with the states that `choice` keeps of each segment.
///
/// # Errors
/// A failure of the input.
pub fn parse_kept(
    input: impl BufRead,
    findings: &mut FindingList,
    choice: SegmentChoice<'_>,
    mut take: impl FnMut(Segment),
) -> io::Result<Option<CcsdsHeader>> {
    let mut lines = lines(input);
    let mut parser = OemParser::new(choice);
    while let Some(line) = lines.next(findings)? {
        parser.line(&line, findings, &mut take);
    }
    Ok(parser.end(lines.number().max(1), findings, &mut take))
}

/// The part of the message that the next line belongs to.
enum OemSection {
    Header,
    Metadata(KvnBlock),
    Ephemeris,
    Covariance(Covariance),
    /// After a covariance only a new segment may follow.
    BetweenSegments,
}

struct OemParser<'a> {
    choice: SegmentChoice<'a>,
    part: OemSection,
    header_block: KvnBlock,
    header: Option<CcsdsHeader>,
    rules: MessageRules,
    segment: Option<OpenSegment>,
    /// Line of the last `META_START`.
    segment_line: usize,
    segments: usize,
}

impl<'a> OemParser<'a> {
    fn new(choice: SegmentChoice<'a>) -> Self {
        Self {
            choice,
            part: OemSection::Header,
            header_block: KvnBlock::new(&[HEADER]),
            header: None,
            rules: MessageRules::default(),
            segment: None,
            segment_line: 0,
            segments: 0,
        }
    }

    fn line(&mut self, line: &Line, findings: &mut FindingList, take: &mut impl FnMut(Segment)) {
        match item(line, findings) {
            Item::Blank => {}
            Item::Comment(text) => self.comment(line.number, text, findings),
            Item::Pair(pair) => self.pair(&pair, findings),
            Item::Other("META_START") => self.meta_start(line.number, findings, take),
            Item::Other("META_STOP") => self.meta_stop(line.number, findings),
            Item::Other("COVARIANCE_START") => self.covariance_start(line.number, findings),
            Item::Other("COVARIANCE_STOP") => self.covariance_stop(line.number, findings),
            Item::Other(_) => self.data(line, findings),
        }
    }

    fn comment(&mut self, number: usize, text: &str, findings: &mut FindingList) {
        let kept = match (&mut self.part, &mut self.segment) {
            (OemSection::Header, _) if !self.header_block.is_empty() => {
                &mut self.header_block.comments
            }
            (OemSection::Metadata(block), _) if block.is_empty() => &mut block.comments,
            (OemSection::Ephemeris, Some(open)) if self.rules.lines().count == 0 => {
                &mut open.segment.comments
            }
            (OemSection::Covariance(covariance), _) if covariance.is_untouched() => return,
            _ => {
                let message = "a comment is allowed only at the beginning of a section (7.8.9)";
                findings.warning((number, 1), "oem-comment", message);
                return;
            }
        };
        keep_comment(kept, text);
    }

    fn pair(&mut self, pair: &Pair<'_>, findings: &mut FindingList) {
        match &mut self.part {
            OemSection::Header => self.header_block.accept(pair, findings),
            OemSection::Metadata(block) => block.accept(pair, findings),
            OemSection::Covariance(covariance) => covariance.pair(pair, findings),
            OemSection::Ephemeris | OemSection::BetweenSegments => {
                let message = format!("keyword {} is not allowed here", pair.key);
                findings.error(pair.key_place, "ccsds-keyword", message);
            }
        }
    }

    fn meta_start(
        &mut self,
        number: usize,
        findings: &mut FindingList,
        take: &mut impl FnMut(Segment),
    ) {
        match &self.part {
            OemSection::Header => self.header = header(&self.header_block, number, findings),
            OemSection::Ephemeris | OemSection::BetweenSegments => self.end_segment(findings, take),
            OemSection::Metadata(_) | OemSection::Covariance(_) => {
                misplaced_marker("META_START", number, findings);
            }
        }
        self.segment_line = number;
        self.part = OemSection::Metadata(KvnBlock::new(&[METADATA]));
    }

    fn meta_stop(&mut self, number: usize, findings: &mut FindingList) {
        let OemSection::Metadata(block) = &self.part else {
            misplaced_marker("META_STOP", number, findings);
            return;
        };
        let metadata = metadata(block, number, findings);
        if let Some(metadata) = &metadata {
            self.rules.check_metadata(metadata, block, findings);
        }
        self.segments += 1;
        self.segment = metadata.map(|metadata| OpenSegment::new(metadata, self.choice));
        self.part = OemSection::Ephemeris;
    }

    fn covariance_start(&mut self, number: usize, findings: &mut FindingList) {
        if !matches!(self.part, OemSection::Ephemeris) {
            misplaced_marker("COVARIANCE_START", number, findings);
        }
        self.part = OemSection::Covariance(Covariance::default());
    }

    fn covariance_stop(&mut self, number: usize, findings: &mut FindingList) {
        match &self.part {
            OemSection::Covariance(covariance) => covariance.end(number, findings),
            _ => misplaced_marker("COVARIANCE_STOP", number, findings),
        }
        self.part = OemSection::BetweenSegments;
    }

    fn data(&mut self, line: &Line, findings: &mut FindingList) {
        match &mut self.part {
            OemSection::Ephemeris => {
                let state = state_line(line, findings);
                if let (Some(open), Some(state)) = (&mut self.segment, state) {
                    let metadata = &open.segment.metadata;
                    if self.rules.admit(metadata, &state, line.number, findings) {
                        open.push(state);
                    }
                }
            }
            OemSection::Covariance(covariance) => covariance.row(line, findings),
            OemSection::Header | OemSection::Metadata(_) | OemSection::BetweenSegments => {
                let message = "neither a keyword = value pair nor a marker of this section";
                findings.error((line.number, 1), "oem-line", message);
            }
        }
    }

    fn end_segment(&mut self, findings: &mut FindingList, take: &mut impl FnMut(Segment)) {
        if let Some(OpenSegment { segment, .. }) = self.segment.take() {
            let place = (self.segment_line, 1);
            check_segment(&segment.metadata, self.rules.lines(), place, findings);
            take(segment);
        }
    }

    fn end(
        mut self,
        number: usize,
        findings: &mut FindingList,
        take: &mut impl FnMut(Segment),
    ) -> Option<CcsdsHeader> {
        match &self.part {
            OemSection::Ephemeris | OemSection::BetweenSegments => self.end_segment(findings, take),
            OemSection::Header => {
                self.header = header(&self.header_block, number, findings);
                findings.error((number, 1), "oem-truncated", "the message has no segments");
            }
            OemSection::Metadata(_) => {
                findings.error((number, 1), "oem-truncated", "META_STOP is missing");
            }
            OemSection::Covariance(_) => {
                findings.error((number, 1), "oem-truncated", "COVARIANCE_STOP is missing");
            }
        }
        self.header
    }
}

/// What must hold for a segment as a whole.
pub(super) fn check_segment(
    metadata: &SegmentMetadata,
    SegmentLines { count, last, .. }: SegmentLines,
    place: (usize, usize),
    findings: &mut FindingList,
) {
    let needed = match &metadata.interpolation {
        Some((method, degree)) if method.eq_ignore_ascii_case("HERMITE") => degree / 2 + 1,
        Some((_, degree)) => degree.saturating_add(1),
        None => 1,
    };
    if count == 0 {
        findings.error(place, "oem-empty", "the segment has no ephemeris lines");
    } else if count < needed {
        let message =
            format!("{count} lines are too few for the interpolation, which needs {needed}");
        findings.warning(place, "oem-interpolation", message);
    }
    if last.is_some_and(|last| last < metadata.stop_time) {
        let message = "the last line is before STOP_TIME: is the file cut short?";
        findings.warning(place, "oem-span", message);
    }
}

fn misplaced_marker(marker: &str, number: usize, findings: &mut FindingList) {
    let message = format!("{marker} is not allowed here");
    findings.error((number, 1), "oem-marker", message);
}

pub(super) fn header(
    block: &KvnBlock,
    number: usize,
    findings: &mut FindingList,
) -> Option<CcsdsHeader> {
    block.finish((number, 1), findings);
    CcsdsHeader::read(block, VERSION, findings)
}

pub(super) fn metadata(
    block: &KvnBlock,
    number: usize,
    findings: &mut FindingList,
) -> Option<SegmentMetadata> {
    block.finish((number, 1), findings);
    let interpolation = match block.text("INTERPOLATION") {
        Some(method) => {
            let degree = block.count("INTERPOLATION_DEGREE", findings);
            if block.text("INTERPOLATION_DEGREE").is_none() {
                let message = "INTERPOLATION_DEGREE must be given with INTERPOLATION";
                findings.error(block.place("INTERPOLATION"), "ccsds-missing", message);
            }
            degree.map(|degree| (method, degree as usize))
        }
        None => None,
    };
    let start_time = block.stamp("START_TIME", findings);
    let stop_time = block.stamp("STOP_TIME", findings);
    if stop_time < start_time {
        let message = "STOP_TIME is before START_TIME";
        findings.error(block.place("STOP_TIME"), "oem-span", message);
    }
    Some(SegmentMetadata {
        comments: block.comments.clone(),
        object_name: block.text_or_unknown("OBJECT_NAME"),
        object_id: block.text_or_unknown("OBJECT_ID"),
        center_name: block.text("CENTER_NAME")?,
        ref_frame: block.text("REF_FRAME")?,
        ref_frame_epoch: block.stamp("REF_FRAME_EPOCH", findings),
        time_system: block.text("TIME_SYSTEM")?,
        start_time: start_time?,
        useable_start_time: block.stamp("USEABLE_START_TIME", findings),
        useable_stop_time: block.stamp("USEABLE_STOP_TIME", findings),
        stop_time: stop_time?,
        interpolation,
    })
}

/// Reads the seven or ten fields of an ephemeris line.
fn state_line(line: &Line, findings: &mut FindingList) -> Option<StateLine> {
    let fields: Vec<_> = words(&line.text).take(11).collect();
    let [(column, epoch), numbers @ ..] = fields.as_slice() else {
        return None;
    };
    if !matches!(numbers.len(), 6 | 9) {
        let message = format!(
            "the line has {} fields; an ephemeris line has 7, or 10 with accelerations",
            fields.len()
        );
        findings.error((line.number, *column), "oem-fields", message);
        return None;
    }
    let epoch = read_stamp(epoch, (line.number, *column), findings);
    let mut values = [0.0; 9];
    for (value, (column, text)) in values.iter_mut().zip(numbers) {
        *value = read_number(text, (line.number, *column), findings)?;
    }
    let vector = |from: usize| Vector3::new(values[from], values[from + 1], values[from + 2]);
    Some(StateLine {
        epoch: epoch?,
        state: State::new(vector(0), vector(3)),
        acceleration_km_s2: (numbers.len() == 9).then(|| vector(6)),
    })
}

/// A covariance section: for each matrix its keywords and six rows.
#[derive(Default)]
struct Covariance {
    block: Option<KvnBlock>,
    rows: usize,
}

impl Covariance {
    fn is_untouched(&self) -> bool {
        self.block.is_none()
    }

    fn pair(&mut self, pair: &Pair<'_>, findings: &mut FindingList) {
        // After its six rows, the next matrix begins.
        if self.rows == 6 {
            *self = Self::default();
        }
        self.block
            .get_or_insert_with(|| KvnBlock::new(&[COVARIANCE]))
            .accept(pair, findings);
    }

    fn row(&mut self, line: &Line, findings: &mut FindingList) {
        self.rows += 1;
        let fields: Vec<_> = words(&line.text).take(8).collect();
        if self.rows > 6 || fields.len() != self.rows || self.block.is_none() {
            let message = "not the next row of a lower triangular 6x6 matrix after its EPOCH";
            findings.error((line.number, 1), "oem-covariance", message);
            return;
        }
        for (column, text) in fields {
            read_number(text, (line.number, column), findings);
        }
    }

    fn end(&self, number: usize, findings: &mut FindingList) {
        if self.rows != 6 {
            let message = "the covariance ends before its sixth row";
            findings.error((number, 1), "oem-covariance", message);
        }
        match &self.block {
            Some(block) => {
                block.finish((number, 1), findings);
                block.stamp("EPOCH", findings);
            }
            None => findings.error(
                (number, 1),
                "ccsds-missing",
                "EPOCH is mandatory and missing",
            ),
        }
    }
}
