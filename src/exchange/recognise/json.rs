//! Detection of JSON formats by the keys of the first object.

use super::Content;
use crate::exchange::lint::Format;

/// Keys that occur only in element sets.
const OF_OMM: [&[u8]; 6] = [
    b"CCSDS_OMM_VERS",
    b"OBJECT_NAME",
    b"OBJECT_ID",
    b"NORAD_CAT_ID",
    b"MEAN_MOTION",
    b"MEAN_ELEMENT_THEORY",
];

/// The format indicated by the first object.
pub(super) fn content(json: &[u8], complete: bool) -> Option<Content> {
    let mut scanner = Scanner::default();
    let mut key: &[u8] = b"";
    for (at, byte) in json.iter().enumerate() {
        match scanner.next(*byte, at) {
            Step::Text(from) if scanner.depth == 1 => {
                let text = &json[from..at];
                if scanner.is_value {
                    match (key, text) {
                        (b"id", b"document") => return Some(Content::Format(Format::Czml)),
                        (b"type", b"FeatureCollection" | b"Feature" | b"Topology") => {
                            return Some(Content::other("GeoJSON"));
                        }
                        _ => {}
                    }
                    continue;
                }
                key = text;
                if OF_OMM.contains(&key) {
                    return Some(Content::Format(Format::OmmJson));
                }
                if matches!(key, b"tle0" | b"tle1" | b"tle2") {
                    let message = "JSON with TLEs in the style of SatNOGS; write tle0, tle1 and tle2 as the lines of a TLE file";
                    return Some(Content::other(message));
                }
            }
            Step::ObjectEnd => return Some(neither()),
            Step::Text(_) | Step::Other => {}
        }
    }
    complete.then(neither)
}

fn neither() -> Content {
    Content::other("JSON, but neither CZML nor OMM")
}

/// A scanner that tracks strings and the nesting of objects.
#[derive(Default)]
struct Scanner {
    depth: usize,
    /// Depth of arrays inside the first object.
    arrays: usize,
    /// Start of the current string.
    string: Option<usize>,
    escaped: bool,
    /// Whether a colon came after the last key.
    is_value: bool,
}

enum Step {
    /// The end of a string that began at this position.
    Text(usize),
    /// The end of the first object.
    ObjectEnd,
    Other,
}

impl Scanner {
    fn next(&mut self, byte: u8, at: usize) -> Step {
        if let Some(from) = self.string {
            match byte {
                _ if self.escaped => self.escaped = false,
                b'\\' => self.escaped = true,
                b'"' => {
                    self.string = None;
                    return Step::Text(from);
                }
                _ => {}
            }
            return Step::Other;
        }
        match byte {
            b'"' => self.string = Some(at + 1),
            b'{' => {
                self.depth += 1;
                self.is_value = false;
            }
            b'}' => {
                self.depth = self.depth.saturating_sub(1);
                if self.depth == 0 {
                    return Step::ObjectEnd;
                }
            }
            b'[' if self.depth > 0 => self.arrays += 1,
            b']' => self.arrays = self.arrays.saturating_sub(1),
            b':' => self.is_value = true,
            b',' if self.depth == 1 && self.arrays == 0 => self.is_value = false,
            _ => {}
        }
        Step::Other
    }
}
