//! Rules across the segments and lines of a message, in both notations, and the limits of this reader.

use super::{SegmentMetadata, StateLine};
use crate::constellation::identity::ObjectIdentity;
use crate::formats::ccsds::frame::supported_frame;
use crate::formats::ccsds::kvn::KvnBlock;
use crate::formats::text::finding::FindingList;
use crate::formats::trajectory::time_system_of_name;
use crate::frames::Frame;
use crate::orbit::earth_orbit::check_state;
use chrono::NaiveDateTime;
use std::collections::BTreeMap;

/// The state of the checks after the segments so far.
#[derive(Default)]
pub(super) struct MessageRules {
    /// Name and identifier of the object of the first segment (5.1.3).
    object: Option<(String, String)>,
    /// Time system of the first segment, which the others must share (5.2.4.5).
    time_system: Option<String>,
    /// Usable spans, by start time.
    spans: BTreeMap<NaiveDateTime, NaiveDateTime>,
    /// Frame of the current segment.
    frame: Option<Frame>,
    /// Whether the current segment already has an implausible state or a line with too few fields.
    is_told: bool,
    /// The lines of the current segment.
    lines: SegmentLines,
}

/// The lines of a segment so far, kept or not.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SegmentLines {
    /// Their number.
    pub(super) count: usize,
    /// Instant of the last one.
    pub(super) last: Option<NaiveDateTime>,
    /// Whether the first one has an acceleration.
    have_accelerations: bool,
}

impl MessageRules {
    /// Checks the metadata of the next segment.
    pub(super) fn check_metadata(
        &mut self,
        metadata: &SegmentMetadata,
        block: &KvnBlock,
        findings: &mut FindingList,
    ) {
        self.is_told = false;
        self.lines = SegmentLines::default();
        self.check_object(metadata, block, findings);
        self.check_time_system(metadata, block, findings);
        self.check_frame(metadata, block, findings);
        self.check_span(metadata, block, findings);
    }

    fn check_object(
        &mut self,
        metadata: &SegmentMetadata,
        block: &KvnBlock,
        findings: &mut FindingList,
    ) {
        let (name, id) = (&metadata.object_name, &metadata.object_id);
        let Some((first_name, first_id)) = &self.object else {
            self.object = Some((name.clone(), id.clone()));
            return;
        };
        let first = ObjectIdentity::new(0, first_id, first_name);
        let this = ObjectIdentity::new(0, id, name);
        let is_same = first.is_same(&this) && !first.is_named_otherwise(&this);
        if !is_same && (first_name, first_id) != (name, id) {
            let key = if first_name == name {
                "OBJECT_ID"
            } else {
                "OBJECT_NAME"
            };
            let message = format!(
                "an OEM describes a single object (5.1.3): {first_name} ({first_id}) in the first segment, {name} ({id}) here"
            );
            findings.error(block.place(key), "oem-objects", message);
        }
    }

    fn check_time_system(
        &mut self,
        metadata: &SegmentMetadata,
        block: &KvnBlock,
        findings: &mut FindingList,
    ) {
        let place = block.place("TIME_SYSTEM");
        let system = &metadata.time_system;
        let first = self.time_system.get_or_insert_with(|| system.clone());
        if first != system {
            let message =
                format!("TIME_SYSTEM is {first} in the first segment; it must not change");
            findings.error(place, "oem-time-system", message);
        } else if let Err(unknown) = time_system_of_name(system) {
            findings.error(place, "oem-time-system", format!("TIME_SYSTEM: {unknown}"));
        }
    }

    /// Checks that the frame of an Earth orbit is supported.
    fn check_frame(
        &mut self,
        metadata: &SegmentMetadata,
        block: &KvnBlock,
        findings: &mut FindingList,
    ) {
        self.frame = None;
        if !metadata.center_name.eq_ignore_ascii_case("EARTH") {
            // `Segment::trajectory` refuses it.
            let message = format!(
                "CENTER_NAME: {} is valid, but only orbits about the Earth are read",
                metadata.center_name
            );
            findings.unsupported(block.place("CENTER_NAME"), message);
            return;
        }
        self.frame = supported_frame(block, "oem-frame", findings);
    }

    /// Checks that the usable span is within the full span and shares at most an instant with any other.
    fn check_span(
        &mut self,
        metadata: &SegmentMetadata,
        block: &KvnBlock,
        findings: &mut FindingList,
    ) {
        let (start, stop) = metadata.useable_span();
        let mut problem = |key: &str, message: String| {
            let key = if block.text(key).is_some() {
                key
            } else {
                "START_TIME"
            };
            findings.error(block.place(key), "oem-span", message);
        };
        if metadata.start_time > metadata.stop_time {
            // Reported separately.
            return;
        }
        if stop < start {
            problem(
                "USEABLE_STOP_TIME",
                "USEABLE_STOP_TIME is before USEABLE_START_TIME".to_owned(),
            );
            return;
        }
        for (key, at) in [("USEABLE_START_TIME", start), ("USEABLE_STOP_TIME", stop)] {
            if at < metadata.start_time || at > metadata.stop_time {
                problem(key, format!("{key} is outside START_TIME to STOP_TIME"));
                return;
            }
        }
        let before = self.spans.range(..stop).next_back();
        if let Some((other_start, other_stop)) = before.filter(|(_, other)| **other > start) {
            let message = format!(
                "the usable span overlaps that of another segment, {other_start} to {other_stop} (5.2.4.4)"
            );
            problem("USEABLE_START_TIME", message);
            return;
        }
        self.spans.insert(start, stop);
    }

    /// Checks that a line is later than the one before it, is within the span of its segment, has the same fields as
    /// the first line, and is a plausible state of an Earth orbit.
    pub(super) fn admit(
        &mut self,
        metadata: &SegmentMetadata,
        line: &StateLine,
        number: usize,
        findings: &mut FindingList,
    ) -> bool {
        let place = (number, 1);
        let previous = self.lines.last;
        if previous.is_some_and(|previous| line.epoch <= previous) {
            let message = "the time is not after that of the previous line";
            findings.error(place, "oem-time-order", message);
            return false;
        }
        let system = time_system_of_name(&metadata.time_system);
        if system.is_ok_and(|system| !system.has(line.epoch)) {
            let message = format!("{} has no second 60; only UTC has", metadata.time_system);
            findings.error(place, "oem-leap-second", message);
            return false;
        }
        if line.epoch < metadata.start_time || line.epoch > metadata.stop_time {
            let message = "the time is outside START_TIME to STOP_TIME";
            findings.error(place, "oem-span", message);
            return false;
        }
        if let Some(problem) = self.first_problem(metadata, line) {
            self.is_told = true;
            findings.error(place, problem.0, problem.1);
            return false;
        }
        if self.lines.count == 0 {
            self.lines.have_accelerations = line.acceleration_km_s2.is_some();
        }
        self.lines.count += 1;
        self.lines.last = Some(line.epoch);
        true
    }

    /// The lines of the current segment so far.
    pub(super) fn lines(&self) -> SegmentLines {
        self.lines
    }

    /// The problem of a line, once per segment, since the lines that follow would have it too.
    fn first_problem(
        &self,
        metadata: &SegmentMetadata,
        line: &StateLine,
    ) -> Option<(&'static str, String)> {
        if self.is_told {
            return None;
        }
        let has_acceleration = line.acceleration_km_s2.is_some();
        if self.lines.count > 0 && self.lines.have_accelerations != has_acceleration {
            let message = "only some lines have accelerations; either all lines of a segment must have them or none";
            return Some(("oem-accelerations", message.to_owned()));
        }
        let problem = check_state(self.frame?, &line.state).err()?;
        let message = format!("{} at {}: {problem}", metadata.object_name, line.epoch);
        Some(("implausible-state", message))
    }
}
