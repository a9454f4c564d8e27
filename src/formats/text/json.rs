//! The objects of a JSON array, one at a time, each with its place in the file.

use crate::formats::text::finding::FindingList;
use std::io::{self, BufRead};

/// Default maximum size of an object, in bytes.
const MAX_OBJECT: usize = 1 << 20;

/// An object of the array.
pub(crate) struct JsonObject {
    /// Its text, from `{` to `}`.
    text: String,
    /// Where it begins.
    start: (usize, usize),
}

impl JsonObject {
    /// Place of a byte of the object in the file.
    fn place(&self, at: usize) -> (usize, usize) {
        let before = &self.text[..at];
        let lines = before.matches('\n').count();
        match before.rfind('\n') {
            Some(end) => (self.start.0 + lines, at - end),
            None => (self.start.0, self.start.1 + at),
        }
    }

    /// Line and column of a key of the object.
    pub(crate) fn place_of(&self, key: &str) -> (usize, usize) {
        self.place(self.text.find(&format!("\"{key}\"")).unwrap_or(0))
    }

    /// The members of the object as text; a finding if it is not an object of plain values.
    pub(crate) fn members(&self, findings: &mut FindingList) -> Option<Vec<(String, String)>> {
        let members: serde_json::Map<String, serde_json::Value> = self.parsed(findings)?;
        let text = |(key, value): (String, serde_json::Value)| match value {
            serde_json::Value::String(text) => Some((key, text)),
            serde_json::Value::Number(number) => Some((key, number.to_string())),
            // Null is a missing value.
            _ => None,
        };
        Some(members.into_iter().filter_map(text).collect())
    }

    /// The object parsed as `T`; a finding if it does not match.
    pub(crate) fn parsed<T: serde::de::DeserializeOwned>(
        &self,
        findings: &mut FindingList,
    ) -> Option<T> {
        let error = match serde_json::from_str(&self.text) {
            Ok(parsed) => return Some(parsed),
            Err(error) => error,
        };
        let lines = self.start.0 + error.line().saturating_sub(1);
        let column = match error.line() {
            0 | 1 => self.start.1 + error.column().saturating_sub(1),
            _ => error.column().max(1),
        };
        let text = error.to_string();
        // serde_json appends a place relative to the object.
        let message = text.split(" at line ").next().unwrap_or_default();
        findings.error((lines, column), "json-syntax", message);
        None
    }
}

/// Reads the objects of an array one by one, or a single object.
pub(crate) struct Objects<R> {
    input: R,
    place: (usize, usize),
    state: ScanState,
    /// Maximum size of an object, in bytes.
    most: usize,
}

#[derive(Clone, Copy, PartialEq)]
enum ScanState {
    Start,
    Inside,
    BetweenObjects,
    End,
}

impl<R: BufRead> Objects<R> {
    pub(crate) fn new(input: R) -> Self {
        Self {
            input,
            place: (1, 0),
            state: ScanState::Start,
            most: MAX_OBJECT,
        }
    }

    /// Accepts objects of up to `most` bytes.
    pub(crate) fn up_to(self, most: usize) -> Self {
        Self { most, ..self }
    }

    /// The next byte; afterwards `self.place` is its place.
    fn byte(&mut self) -> io::Result<Option<u8>> {
        let available = self.input.fill_buf()?;
        let Some(byte) = available.first().copied() else {
            return Ok(None);
        };
        self.input.consume(1);
        self.place.1 += 1;
        Ok(Some(byte))
    }

    fn line_ended(&mut self, byte: u8) {
        if byte == b'\n' {
            self.place = (self.place.0 + 1, 0);
        }
    }

    /// The next object; `None` at the end or after a finding.
    pub(crate) fn next(&mut self, findings: &mut FindingList) -> io::Result<Option<JsonObject>> {
        while self.state != ScanState::End {
            let Some(byte) = self.byte()? else {
                let message = "the array is missing or not closed";
                findings.error((self.place.0, self.place.1 + 1), "json-truncated", message);
                self.state = ScanState::End;
                return Ok(None);
            };
            match (self.state, byte) {
                (_, b' ' | b'\t' | b'\r' | b'\n') => {}
                // A byte order mark may come first.
                (ScanState::Start, 0xEF | 0xBB | 0xBF) if self.place.1 <= 3 => {}
                (ScanState::Start, b'[') => self.state = ScanState::Inside,
                (ScanState::Inside | ScanState::BetweenObjects, b']') => {
                    self.state = ScanState::End
                }
                (ScanState::BetweenObjects, b',') => self.state = ScanState::Inside,
                (ScanState::Start | ScanState::Inside, b'{') => {
                    self.state = match self.state {
                        ScanState::Start => ScanState::End,
                        _ => ScanState::BetweenObjects,
                    };
                    return self.object(findings);
                }
                _ => {
                    let message = "expected an object or an array of objects";
                    findings.error(self.place, "json-syntax", message);
                    self.state = ScanState::End;
                }
            }
            self.line_ended(byte);
        }
        Ok(None)
    }

    /// The rest of an object whose opening brace has been read.
    fn object(&mut self, findings: &mut FindingList) -> io::Result<Option<JsonObject>> {
        let start = self.place;
        let mut bytes = vec![b'{'];
        let (mut depth, mut in_string, mut escaped) = (1_usize, false, false);
        while depth > 0 {
            let byte = self.byte()?.filter(|_| bytes.len() < self.most);
            let Some(byte) = byte else {
                let message = match bytes.len() < self.most {
                    true => "the object is not closed".to_owned(),
                    false => format!("the object is not closed within {} bytes", self.most),
                };
                findings.error(start, "json-truncated", message);
                self.state = ScanState::End;
                return Ok(None);
            };
            bytes.push(byte);
            self.line_ended(byte);
            match byte {
                _ if escaped => escaped = false,
                b'\\' if in_string => escaped = true,
                b'"' => in_string = !in_string,
                b'{' if !in_string => depth += 1,
                b'}' if !in_string => depth -= 1,
                _ => {}
            }
        }
        let Ok(text) = String::from_utf8(bytes) else {
            findings.error(start, "character", "the object is not UTF-8");
            self.state = ScanState::End;
            return Ok(None);
        };
        Ok(Some(JsonObject { text, start }))
    }
}
