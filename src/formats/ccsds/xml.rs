//! Elements of an XML file, with their places, for the Navigation Data Messages.
//!
//! Leaves are distinguished from elements with children; memory is bounded by the length of one tag or
//! text and by the depth. Document type declarations, and entities other than XML's five predefined ones, are
//! refused.

use crate::formats::ccsds::kvn::{CcsdsHeader, CcsdsVersion};
use crate::formats::text::finding::FindingList;
use quick_xml::Reader;
use quick_xml::escape::{escape, resolve_predefined_entity, unescape};
use quick_xml::events::{BytesRef, BytesStart, Event};
use std::borrow::Cow;
use std::io::{self, BufRead, Read, Write};

/// Maximum length of a tag or text, in bytes.
const MAX_EVENT: usize = 1 << 16;

/// Maximum depth of nesting.
const MAX_DEPTH: usize = 32;

/// An element, or its end.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum XmlNode {
    /// Beginning of an element with children, with its `version` if it has one.
    Open(String, Option<String>),
    /// An element that contains only text.
    Leaf(XmlLeaf),
    /// End of an element with children.
    Close(String),
}

/// An element that contains only text.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct XmlLeaf {
    pub(crate) name: String,
    pub(crate) text: String,
    /// Its `units` attribute.
    pub(crate) unit: Option<String>,
    /// Its `parameter` attribute, which names what a user defines.
    pub(crate) parameter: Option<String>,
}

/// A node and the place where it begins.
pub(crate) type LocatedNode = ((usize, usize), XmlNode);

/// Counts lines as they are consumed, and refuses an event that is too long.
struct Counting<R> {
    input: R,
    place: (usize, usize),
    since_event: usize,
}

impl<R: BufRead> Read for Counting<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let available = self.fill_buf()?;
        let taken = available.len().min(buffer.len());
        buffer[..taken].copy_from_slice(&available[..taken]);
        self.consume(taken);
        Ok(taken)
    }
}

impl<R: BufRead> BufRead for Counting<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.since_event > MAX_EVENT {
            let message = format!("a tag or text is longer than {MAX_EVENT} bytes");
            return Err(io::Error::new(io::ErrorKind::InvalidData, message));
        }
        let available = self.input.fill_buf()?;
        Ok(&available[..available.len().min(MAX_EVENT)])
    }

    fn consume(&mut self, count: usize) {
        // The bytes are still in the buffer, so `fill_buf` does not read again.
        if let Ok(available) = self.input.fill_buf() {
            for byte in &available[..count.min(available.len())] {
                self.place = match byte {
                    b'\n' => (self.place.0 + 1, 1),
                    _ => (self.place.0, self.place.1 + 1),
                };
            }
        }
        self.since_event += count;
        self.input.consume(count);
    }
}

/// An open element that has no child yet.
struct Held {
    place: (usize, usize),
    name: String,
    version: Option<String>,
    unit: Option<String>,
    parameter: Option<String>,
    text: String,
}

impl Held {
    fn leaf(self) -> LocatedNode {
        let leaf = XmlLeaf {
            name: self.name,
            text: self.text,
            unit: self.unit,
            parameter: self.parameter,
        };
        (self.place, XmlNode::Leaf(leaf))
    }
}

/// Reads the nodes of a file one by one.
pub(crate) struct Nodes<R> {
    reader: Reader<Counting<R>>,
    held: Option<Held>,
    queued: Option<LocatedNode>,
    depth: usize,
    any: bool,
    ended: bool,
}

impl<R: BufRead> Nodes<R> {
    pub(crate) fn new(input: R) -> Self {
        let counting = Counting {
            input,
            place: (1, 1),
            since_event: 0,
        };
        Self {
            reader: Reader::from_reader(counting),
            held: None,
            queued: None,
            depth: 0,
            any: false,
            ended: false,
        }
    }

    /// Line and column that the reader has reached.
    pub(crate) fn place(&self) -> (usize, usize) {
        self.reader.get_ref().place
    }

    fn refuse(
        &mut self,
        place: (usize, usize),
        message: impl Into<String>,
        findings: &mut FindingList,
    ) {
        findings.error(place, "xml-syntax", message);
        self.ended = true;
    }

    /// The next node; `None` at the end or after a finding.
    pub(crate) fn next(&mut self, findings: &mut FindingList) -> io::Result<Option<LocatedNode>> {
        let mut buffer = Vec::new();
        loop {
            if let Some(node) = self.queued.take() {
                return Ok(Some(node));
            }
            if self.ended {
                return Ok(None);
            }
            let place = self.place();
            self.reader.get_mut().since_event = 0;
            buffer.clear();
            let node = match self.reader.read_event_into(&mut buffer) {
                Ok(Event::Eof) => {
                    if self.depth > 0 || !self.any {
                        let message = "the file ends inside an element, or has no elements";
                        findings.error(place, "xml-truncated", message);
                    }
                    self.ended = true;
                    None
                }
                Ok(Event::Start(tag)) => {
                    let held = held(&tag, place);
                    self.start(held, findings)
                }
                Ok(Event::Empty(tag)) => {
                    let leaf = held(&tag, place).leaf();
                    let parent = self.held.take().map(opened);
                    self.any = true;
                    self.after(parent, leaf)
                }
                Ok(Event::End(tag)) => {
                    self.depth = self.depth.saturating_sub(1);
                    let name = name_of(tag.local_name().as_ref());
                    Some(match self.held.take() {
                        Some(held) => held.leaf(),
                        None => (place, XmlNode::Close(name)),
                    })
                }
                Ok(Event::Text(text)) => {
                    let text = name_of(text.as_ref());
                    self.text(&text, place, findings);
                    None
                }
                Ok(Event::CData(text)) => {
                    let text = name_of(text.as_ref());
                    self.text(&text, place, findings);
                    None
                }
                Ok(Event::GeneralRef(reference)) => {
                    let resolved = resolved(&reference);
                    match resolved {
                        Some(text) => self.text(&text, place, findings),
                        None => self.refuse(
                            place,
                            "the entity is not one of the five that XML predefines",
                            findings,
                        ),
                    }
                    None
                }
                Ok(Event::DocType(_)) => {
                    self.refuse(
                        place,
                        "a document type declaration is not allowed",
                        findings,
                    );
                    None
                }
                Ok(Event::Decl(_) | Event::PI(_) | Event::Comment(_)) => None,
                Err(error) => {
                    self.refuse(place, error.to_string(), findings);
                    None
                }
            };
            if node.is_some() {
                return Ok(node);
            }
        }
    }

    fn start(&mut self, held: Held, findings: &mut FindingList) -> Option<LocatedNode> {
        self.any = true;
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            let message = format!("elements nest deeper than {MAX_DEPTH}");
            self.refuse(held.place, message, findings);
        }
        self.held.replace(held).map(opened)
    }

    /// The first of two nodes; the second is queued.
    fn after(&mut self, first: Option<LocatedNode>, second: LocatedNode) -> Option<LocatedNode> {
        match first {
            Some(first) => {
                self.queued = Some(second);
                Some(first)
            }
            None => Some(second),
        }
    }

    fn text(&mut self, text: &str, place: (usize, usize), findings: &mut FindingList) {
        match &mut self.held {
            Some(held) if held.text.len() + text.len() <= MAX_EVENT => held.text.push_str(text),
            Some(_) => self.refuse(place, "the text of an element is too long", findings),
            None if text.trim().trim_start_matches('\u{feff}').is_empty() => {}
            None => self.refuse(
                place,
                "found text where only elements are allowed",
                findings,
            ),
        }
    }
}

fn opened(held: Held) -> LocatedNode {
    (held.place, XmlNode::Open(held.name, held.version))
}

fn held(tag: &BytesStart<'_>, place: (usize, usize)) -> Held {
    let attribute = |name: &str| {
        let found = tag.try_get_attribute(name).ok().flatten();
        found.map(|attribute| {
            let value = name_of(attribute.value.as_ref());
            // What is not an entity stands for itself.
            unescape(&value).map_or_else(|_| value.clone(), Cow::into_owned)
        })
    };
    Held {
        place,
        // A namespace prefix adds nothing to the name.
        name: name_of(tag.local_name().as_ref()),
        version: attribute("version"),
        unit: attribute("units"),
        parameter: attribute("parameter"),
        text: String::new(),
    }
}

/// Text of an event; bytes that are not UTF-8 become replacement characters, which no field accepts.
fn name_of(bytes: impl AsRef<[u8]>) -> String {
    String::from_utf8_lossy(bytes.as_ref()).into_owned()
}

fn resolved(reference: &BytesRef<'_>) -> Option<String> {
    if let Ok(Some(character)) = reference.resolve_char_ref() {
        return Some(character.to_string());
    }
    resolve_predefined_entity(&name_of(reference.as_ref())).map(str::to_owned)
}

/// The schema attributes of the outermost element (CCSDS 505.0-B-2, section 4).
fn schema(version: CcsdsVersion) -> String {
    let schema = match version {
        CcsdsVersion::V2 => "ndmxml-2.0.0-master-2.0.xsd",
        CcsdsVersion::V3 => "ndmxml-3.0.0-master-3.0.xsd",
    };
    format!(
        "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" \
         xsi:noNamespaceSchemaLocation=\"https://sanaregistry.org/r/ndmxml_unqualified/{schema}\""
    )
}

const DECLARATION: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>";

/// Begins a combined instantiation (CCSDS 505.0-B-2, section 4; 502.0-B-3, 8.12).
pub(crate) fn begin_ndm(out: &mut impl Write, version: CcsdsVersion) -> io::Result<()> {
    writeln!(out, "{DECLARATION}\n<ndm {}>", schema(version))
}

/// Begins a file of one message.
pub(crate) fn begin_file(
    out: &mut impl Write,
    element: &str,
    id: &str,
    version: CcsdsVersion,
) -> io::Result<()> {
    let schema = schema(version);
    writeln!(
        out,
        "{DECLARATION}\n<{element} {schema} id=\"{id}\" version=\"{version}\">"
    )
}

/// Writes elements that contain only text.
pub(crate) fn write_leaves<'a>(
    out: &mut impl Write,
    leaves: impl IntoIterator<Item = (&'a str, &'a str)>,
) -> io::Result<()> {
    for (key, value) in leaves {
        writeln!(out, "<{key}>{}</{key}>", escape(value))?;
    }
    Ok(())
}

/// Writes comments.
pub(crate) fn write_comments(out: &mut impl Write, comments: &[String]) -> io::Result<()> {
    write_leaves(out, comments.iter().map(|text| ("COMMENT", text.as_str())))
}

/// Ends a combined instantiation.
pub(crate) fn end_ndm(out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "</ndm>")
}

/// The header section of a message.
pub(crate) fn write_header(out: &mut impl Write, header: &CcsdsHeader) -> io::Result<()> {
    writeln!(out, "<header>")?;
    write_comments(out, &header.comments)?;
    for (key, value) in header.pairs() {
        write_leaves(out, [(key, value.as_str())])?;
    }
    writeln!(out, "</header>")
}
