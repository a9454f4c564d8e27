//! Format detection by content, past any preamble and through gzip.
//!
//! A supported format is recognised by what its standard puts first; comments, blank lines, a byte order mark and an
//! XML prologue are skipped, however long. Common formats that are not supported are identified, so that the error
//! names the actual problem. The file name counts only if the content is inconclusive.

mod gzip;
mod json;
mod text;
mod xml;

use crate::exchange::lint::Format;
use std::io::{self, BufRead, BufReader, Cursor, Read};
use thiserror::Error;

/// Bytes examined first; more are read in steps of this size while the format is unclear.
const PROBE: usize = 4096;

/// Maximum number of bytes to examine.
const MOST: usize = 1 << 24;

/// Number of characters of an unknown file to show.
const SHOWN: usize = 40;

/// A file in an unsupported format.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("not a supported format: {0}")]
pub struct Unread(pub(crate) String);

impl Unread {
    fn looks_like(what: impl std::fmt::Display) -> Self {
        Self(format!("it looks like {what}"))
    }
}

/// A file whose content has been examined.
pub struct Recognised<'a> {
    /// Its format, or why it is not supported.
    pub content: Result<Format, Unread>,
    /// The complete contents, decompressed.
    pub input: Box<dyn BufRead + 'a>,
}

/// Detects the format of a file; `file_name` is used if the content is inconclusive.
///
/// # Errors
/// A failure of the input, or gzip data that are damaged.
pub fn recognise<'a>(
    input: impl BufRead + 'a,
    file_name: Option<&str>,
) -> io::Result<Recognised<'a>> {
    let mut input = unpacked(input)?;
    let mut seen = Vec::new();
    let content = loop {
        let wanted = (2 * seen.len()).max(PROBE);
        let missing = (wanted - seen.len()) as u64;
        let complete = input.by_ref().take(missing).read_to_end(&mut seen)? < missing as usize;
        let complete = complete || seen.len() >= MOST;
        if let Some(content) = content(&seen, complete) {
            break content;
        }
    };
    let of_name = file_name.and_then(Format::of_name);
    let content = match (content, of_name) {
        (Content::Format(format), _) => Ok(format),
        (Content::Other(what), _) => Err(what),
        (Content::Unknown, Some(format)) => Ok(format),
        (Content::Unknown, None) => Err(unknown(&seen)),
    };
    let input = Box::new(Cursor::new(seen).chain(input));
    Ok(Recognised { content, input })
}

/// The bytes of a file, decompressed if they are gzip.
///
/// # Errors
/// A failure of the input.
pub fn unpacked<'a>(mut input: impl BufRead + 'a) -> io::Result<Box<dyn BufRead + 'a>> {
    // A pipe may hold the first byte alone.
    let mut start = Vec::with_capacity(gzip::MAGIC.len());
    let wanted = gzip::MAGIC.len() as u64;
    input.by_ref().take(wanted).read_to_end(&mut start)?;
    let is_gzip = start == gzip::MAGIC;
    let input = Cursor::new(start).chain(input);
    Ok(match is_gzip {
        true => Box::new(BufReader::new(gzip::Unpacked::new(input))),
        false => Box::new(input),
    })
}

/// The format indicated by the beginning of a file.
#[derive(Debug, Clone, PartialEq)]
enum Content {
    Format(Format),
    /// A known format that is not supported.
    Other(Unread),
    Unknown,
}

impl Content {
    fn other(what: impl std::fmt::Display) -> Self {
        Self::Other(Unread::looks_like(what))
    }
}

/// Signatures of binary files.
const BINARY: [(&[u8], &str); 12] = [
    (b"\x1f\x9d", "a Unix compress file (.Z); unpack it first"),
    (b"PK\x03\x04", "a zip archive; unpack it first"),
    (b"\xfd7zXZ\0", "an xz file; unpack it first"),
    (b"BZh", "a bzip2 file; unpack it first"),
    (b"\x28\xb5\x2f\xfd", "a zstd file; unpack it first"),
    (b"\x89HDF", "an HDF5 file"),
    (b"CDF\x01", "a NetCDF file"),
    (b"CDF\x02", "a NetCDF file"),
    (b"DAF/", "a SPICE kernel"),
    (b"NAIF/DAF", "a SPICE kernel"),
    (b"%PDF", "a PDF"),
    (b"\x89PNG", "a PNG image"),
];

const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The format indicated by the beginning of a file; `None` if more of it is needed.
fn content(seen: &[u8], complete: bool) -> Option<Content> {
    let mut binary = BINARY.iter();
    if let Some((_, what)) = binary.find(|(magic, _)| seen.starts_with(magic)) {
        return Some(Content::other(what));
    }
    let seen = seen.strip_prefix(BYTE_ORDER_MARK).unwrap_or(seen);
    match seen.trim_ascii_start() {
        [] => complete.then_some(Content::Unknown),
        xml @ [b'<', ..] => xml::content(xml, complete),
        json @ [b'[' | b'{', ..] => json::content(json, complete),
        _ => text::content(seen, complete),
    }
}

fn unknown(seen: &[u8]) -> Unread {
    let text = String::from_utf8_lossy(&seen[..seen.len().min(4 * SHOWN)]).into_owned();
    let first = text.lines().map(str::trim).find(|line| !line.is_empty());
    Unread(match first {
        None => "the file is empty".to_owned(),
        Some(line) => {
            let shown: String = line.chars().take(SHOWN).collect();
            format!("it begins with {shown:?}")
        }
    })
}

#[cfg(test)]
mod tests;
