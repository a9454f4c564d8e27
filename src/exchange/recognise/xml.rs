//! Detection of XML formats by the root element, ignoring its prefix.

use super::Content;
use crate::exchange::lint::Format;

/// The format indicated by the root element.
pub(super) fn content(xml: &[u8], complete: bool) -> Option<Content> {
    let mut rest = xml;
    let cut = || complete.then(|| Content::other("XML that ends before its first element"));
    loop {
        rest = rest.trim_ascii_start();
        let end: &[u8] = match rest {
            [b'<', b'?', ..] => b"?>",
            [b'<', b'!', b'-', b'-', ..] => b"-->",
            [b'<', b'!', ..] => b">",
            [b'<', name @ ..] => {
                let Some(length) = name.iter().position(|b| !is_name(*b)) else {
                    return cut();
                };
                let (name, after) = name.split_at(length);
                return root(&local(name), after, complete);
            }
            [] => return cut(),
            _ => return Some(Content::other("XML without a root element")),
        };
        let Some(at) = find(rest, end) else {
            return cut();
        };
        rest = &rest[at + end.len()..];
    }
}

fn root(name: &str, after: &[u8], complete: bool) -> Option<Content> {
    Some(match name {
        "oem" => Content::Format(Format::OemXml),
        "omm" => Content::Format(Format::OmmXml),
        "opm" => Content::Format(Format::OpmXml),
        "ndm" => return messages(after, complete),
        "html" => Content::other("a web page"),
        "kml" => Content::other("KML"),
        "ocm" | "aem" | "apm" | "acm" | "tdm" | "cdm" | "rdm" => {
            Content::other(format_args!("a CCSDS {} in XML", name.to_uppercase()))
        }
        _ => Content::other(format_args!("XML with the root element <{name}>")),
    })
}

/// The first message of a combined document.
fn messages(mut rest: &[u8], complete: bool) -> Option<Content> {
    while let Some(at) = rest.iter().position(|byte| *byte == b'<') {
        rest = &rest[at + 1..];
        if rest.starts_with(b"!--") {
            match find(rest, b"-->") {
                Some(end) => rest = &rest[end..],
                None => break,
            }
        }
        let Some(length) = rest.iter().position(|b| !is_name(*b)) else {
            break;
        };
        match local(&rest[..length]).as_str() {
            "oem" => return Some(Content::Format(Format::OemXml)),
            "omm" => return Some(Content::Format(Format::OmmXml)),
            "opm" => return Some(Content::Format(Format::OpmXml)),
            _ => {}
        }
    }
    complete.then(|| Content::other("a CCSDS NDM without a supported message (oem, omm, opm)"))
}

fn is_name(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || matches!(byte, b':' | b'_' | b'-' | b'.') || !byte.is_ascii()
}

/// A name without its prefix.
fn local(name: &[u8]) -> String {
    let name = String::from_utf8_lossy(name);
    let local = name.rsplit(':').next().unwrap_or(&name);
    local.to_ascii_lowercase()
}

fn find(text: &[u8], wanted: &[u8]) -> Option<usize> {
    text.windows(wanted.len())
        .position(|window| window == wanted)
}
