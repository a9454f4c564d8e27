//! Detection of text formats by the first significant lines.

use super::Content;
use crate::exchange::lint::Format;

/// Labels in the first line of formats used in satellite geodesy.
const LABELS: [(&str, &str); 5] = [
    ("RINEX VERSION / TYPE", "a RINEX file"),
    ("CRINEX VERS", "a compressed RINEX file"),
    ("ANTEX VERSION", "an ANTEX file"),
    ("IONEX VERSION", "an IONEX file"),
    ("%=SNX", "a SINEX file"),
];

/// Bytes of text without a recognisable line after which detection gives up.
const ENOUGH: usize = 1 << 16;

/// The format indicated by the lines.
pub(super) fn content(seen: &[u8], complete: bool) -> Option<Content> {
    let text = String::from_utf8_lossy(seen);
    let mut lines: Vec<&str> = text.split(['\n', '\r']).collect();
    if !complete {
        // The last line may be incomplete.
        lines.pop();
    }
    let mut said = lines
        .iter()
        .map(|line| line.trim_end())
        .filter(|line| !line.trim().is_empty())
        .filter(|line| !line.trim_start().starts_with("COMMENT"));
    let mut rows = said.clone().skip_while(|line| is_hash_comment(line));
    let first = rows.next();
    let by_first = first.and_then(|first| by_line(first).or_else(|| almanac(first, rows.clone())));
    if let Some(content) = by_first {
        let mut blocks = rows.filter_map(|line| {
            let (word, block) = line.trim_start().split_once(' ')?;
            word.eq_ignore_ascii_case("BEGIN").then_some(block)
        });
        return Some(match (&content, blocks.next().map(str::trim)) {
            (Content::Format(Format::Stk), Some(block))
                if !block.eq_ignore_ascii_case("Ephemeris") =>
            {
                Content::other(format_args!("an STK file of another type, {block}"))
            }
            _ => content,
        });
    }
    if is_element_sets(&mut said) {
        return Some(Content::Format(Format::Tle));
    }
    (complete || seen.len() >= ENOUGH && first.is_some()).then_some(Content::Unknown)
}

/// `#` begins a comment in tables and element sets, and the first line of SP3.
fn is_hash_comment(line: &str) -> bool {
    line.starts_with('#') && !is_sp3(line)
}

fn is_sp3(line: &str) -> bool {
    matches!(
        line.as_bytes(),
        [b'#', b'a'..=b'd', b'P' | b'V', b'0'..=b'9' | b' ', ..]
    )
}

fn by_line(line: &str) -> Option<Content> {
    let trimmed = line.trim_start();
    if is_sp3(line) {
        return Some(Content::Format(Format::Sp3));
    }
    if let Some(kind) = ccsds_kind(trimmed) {
        return Some(match kind {
            "OEM" => Content::Format(Format::Oem),
            "OMM" => Content::Format(Format::Omm),
            "OPM" => Content::Format(Format::Opm),
            other => Content::other(format_args!("a CCSDS {other}")),
        });
    }
    if trimmed
        .get(..6)
        .is_some_and(|start| start.eq_ignore_ascii_case("stk.v."))
    {
        return Some(Content::Format(Format::Stk));
    }
    if let Some((label, what)) = LABELS.iter().find(|(label, _)| line.contains(label)) {
        return Some(match *label {
            "RINEX VERSION / TYPE" => rinex(line),
            _ => Content::other(what),
        });
    }
    if line.contains(',') {
        return table(line);
    }
    None
}

/// The message type, `OEM` in `CCSDS_OEM_VERS`.
fn ccsds_kind(line: &str) -> Option<&str> {
    let (kind, rest) = line.strip_prefix("CCSDS_")?.split_at_checked(3)?;
    rest.starts_with("_VERS").then_some(kind)
}

fn table(header: &str) -> Option<Content> {
    let has = |name: &str| header.contains(name);
    let format = if has("MEAN_MOTION") {
        Format::OmmCsv
    } else if has("semi_major_axis_km") {
        Format::ElementsCsv
    } else if has("_x_km") {
        Format::StatesCsv
    } else {
        return None;
    };
    Some(Content::Format(format))
}

/// The version in the first columns, the file type in column 21 (RINEX 3.05, table A1).
fn rinex(line: &str) -> Content {
    let version = line.get(..20).unwrap_or_default().trim();
    let kind = match line.as_bytes().get(20) {
        Some(b'N') => "navigation messages",
        Some(b'G') => "GLONASS navigation messages",
        Some(b'H') => "navigation messages of an augmentation system",
        Some(b'L') => "Galileo navigation messages",
        Some(b'O') => "observations",
        Some(b'M') => "meteorology",
        Some(b'C') => "clocks",
        _ => "another kind",
    };
    Content::other(format_args!("a RINEX {version} file of {kind}"))
}

/// An almanac: YUMA begins with a line of stars, SEM with a count and a title, and then the week and the second.
fn almanac<'a>(first: &str, mut rest: impl Iterator<Item = &'a str>) -> Option<Content> {
    let lower = first.to_ascii_lowercase();
    if first.starts_with("**") && lower.contains("almanac") || lower.starts_with("id:") {
        return Some(Content::Format(Format::Yuma));
    }
    let whole = |line: &str, count: usize| {
        let words: Vec<&str> = line.split_whitespace().collect();
        words.len() == count && words.iter().all(|word| word.parse::<u32>().is_ok())
    };
    let count = first.split_whitespace().next();
    let is_count = count.is_some_and(|count| count.parse::<u32>().is_ok_and(|count| count <= 99));
    let is_sem =
        is_count && whole(rest.next()?, 2) && whole(rest.next()?, 1) && whole(rest.next()?, 1);
    is_sem.then_some(Content::Format(Format::Sem))
}

/// Line 1 of an element set, followed by line 2 or at the very beginning.
fn is_element_sets<'a>(lines: &mut impl Iterator<Item = &'a str>) -> bool {
    let is_line = |line: &str, number: &str| line.starts_with(number) && line.len() >= 40;
    let mut before: Option<&str> = None;
    for (place, line) in lines.enumerate() {
        if before.is_some_and(|before| is_line(before, "1 ")) && is_line(line, "2 ") {
            return true;
        }
        if place < 2 && is_line(line, "1 ") && line.len() >= 60 {
            return true;
        }
        before = Some(line);
    }
    false
}
