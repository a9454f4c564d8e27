//! Text that others wrote, such as the names of objects in a file, made safe to show.
//!
//! A terminal obeys control characters, and a line of text is laid out by invisible ones: they can move the
//! cursor, hide or reverse what is read, or begin a line that looks like the program's own. Here they are written as
//! escapes, so that the text shows what it holds.

use serde::Serialize;
use std::borrow::Cow;
use std::fmt::Write;

/// Whether a character acts on the display instead of appearing on it: control characters (C0, DEL and C1), marks of
/// the text direction, characters without width, and separators of lines and paragraphs.
#[must_use]
pub fn is_obeyed(character: char) -> bool {
    character.is_control()
        || matches!(character,
            '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{feff}'
            | '\u{200b}'..='\u{200f}'
            | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}'
            | '\u{fff9}'..='\u{fffb}'
            | '\u{e0000}'..='\u{e007f}')
}

/// A name or a message on one line: `\n`, `\t`, and otherwise `\u{1b}` in place of what a terminal would obey.
#[must_use]
pub fn printable(text: &str) -> Cow<'_, str> {
    escaped(text, is_obeyed, |out, character| {
        out.extend(character.escape_default());
    })
}

/// A text of several lines, of which only the line breaks and tabulators are obeyed.
#[must_use]
pub fn printable_lines(text: &str) -> Cow<'_, str> {
    let refused = |character| is_obeyed(character) && !"\n\t".contains(character);
    escaped(text, refused, |out, character| {
        out.extend(character.escape_default());
    })
}

/// A name or a message on one line of Markdown, without any markup of its own.
#[must_use]
pub fn markdown(text: &str) -> Cow<'_, str> {
    let marks = |character| is_obeyed(character) || "|`<[".contains(character);
    escaped(text, marks, |out, character| {
        if is_obeyed(character) {
            out.extend(character.escape_default());
        } else {
            out.push('\\');
            out.push(character);
        }
    })
}

/// The value as JSON over several lines, as [`printable_json`].
///
/// # Errors
/// If the value cannot be written as JSON, such as a map whose keys are not texts.
pub fn json(value: &impl Serialize) -> serde_json::Result<String> {
    let json = serde_json::to_string_pretty(value)?;
    Ok(printable_json(&json).into_owned())
}

/// JSON of the same value without any raw character that a terminal would obey, besides its line breaks: elsewhere they
/// occur only in strings, where `\u202e` means the same.
#[must_use]
pub fn printable_json(json: &str) -> Cow<'_, str> {
    let refused = |character| is_obeyed(character) && character != '\n';
    escaped(json, refused, |out, character| {
        for unit in character.encode_utf16(&mut [0; 2]) {
            // Writing to a string does not fail.
            let _ = write!(out, "\\u{unit:04x}");
        }
    })
}

/// The text with `write` in place of each character for which `is_refused`.
fn escaped(
    text: &str,
    is_refused: impl Fn(char) -> bool,
    write: impl Fn(&mut String, char),
) -> Cow<'_, str> {
    if !text.contains(&is_refused) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        if is_refused(character) {
            write(&mut out, character);
        } else {
            out.push(character);
        }
    }
    Cow::Owned(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_obeys_is_escaped() {
        let text =
            "a\u{1b}[2J\u{9b}1m\r\n\tb\u{202e}c\u{2066}\u{200b}\u{2028}\u{61c}\u{feff}d\u{7f}";
        assert_eq!(
            printable(text),
            r"a\u{1b}[2J\u{9b}1m\r\n\tb\u{202e}c\u{2066}\u{200b}\u{2028}\u{61c}\u{feff}d\u{7f}"
        );
        assert!(printable_lines(text).contains("\\r\n\tb\\u{202e}"));
        let plain = "Beidou-3 M1 北斗 N̄ µ µ·10⁻³ C:\\new";
        assert!(matches!(printable(plain), Cow::Borrowed(same) if same == plain));
    }

    #[test]
    fn markdown_has_no_markup_of_others() {
        assert_eq!(markdown("a|b`c<d>[e](f)\n"), "a\\|b\\`c\\<d>\\[e](f)\\n");
    }

    #[test]
    fn json_keeps_its_value() {
        let value = "a\u{7f}\u{9b}\u{202e}\u{e0041}\"\\\u{1b}\n é";
        let safe = json(&[value]).unwrap();
        assert!(!safe.replace('\n', "").contains(is_obeyed), "{safe}");
        assert_eq!(
            serde_json::from_str::<[String; 1]>(&safe).unwrap()[0],
            value
        );
    }
}
