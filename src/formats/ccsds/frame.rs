//! The frame of a message about an Earth orbit: one rule for ephemeris and parameter messages.

use super::kvn::KvnBlock;
use crate::formats::text::finding::FindingList;
use crate::formats::trajectory::frame_of_name;
use crate::frames::Frame;

/// The frame that REF_FRAME names; an error of `rule` if it is not supported, or is asked for at an epoch where only the
/// one of date is.
pub(super) fn supported_frame(
    block: &KvnBlock,
    rule: &'static str,
    findings: &mut FindingList,
) -> Option<Frame> {
    let name = block.text("REF_FRAME")?;
    let frame = match frame_of_name(&name) {
        Ok(frame) => frame,
        Err(unknown) => {
            let message = format!("REF_FRAME: {unknown}");
            findings.error(block.place("REF_FRAME"), rule, message);
            return None;
        }
    };
    let moves = matches!(frame, Frame::Teme | Frame::EarthFixed);
    if moves && block.text("REF_FRAME_EPOCH").is_some() {
        let message = format!("{name} of epoch is not supported; only {name} of date is");
        findings.error(block.place("REF_FRAME_EPOCH"), rule, message);
    }
    Some(frame)
}
