//! The names of constellations.

/// Name of the GNSS alone in tables, which no constellation may have.
pub const GNSS_ONLY: &str = "gnss-only";

/// Longest given name in bytes, since it becomes the name of a folder and the head of a column.
pub const LONGEST_NAME: usize = 64;

/// The characters of a given name, as a class of a regular expression.
pub(crate) const NAME_CHARACTERS: &str = "A-Za-z0-9_-";

/// Whether a text may be given as a name, apart from [`GNSS_ONLY`]: `NAME` in `NAME=NOTATION` and in
/// `[constellations]`.
#[must_use]
pub fn is_name(text: &str) -> bool {
    let allowed = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    (1..=LONGEST_NAME).contains(&text.len()) && text.chars().all(allowed)
}

/// What [`is_name`] accepts, in words.
#[must_use]
pub fn accepted_name() -> String {
    format!("a name of letters, digits, '-' and '_', 1 to {LONGEST_NAME} bytes")
}

/// A name like `text` that [`is_name`] accepts and that is not `taken`.
#[must_use]
pub fn similar_name(text: &str, taken: impl Fn(&str) -> bool) -> String {
    /// Bytes that are left for a number.
    const NUMBER: usize = 8;
    let allowed = |c: char| is_name(c.encode_utf8(&mut [0; 4]));
    let letters = text.chars().map(|c| if allowed(c) { c } else { '_' });
    let base: String = letters.take(LONGEST_NAME - NUMBER).collect();
    let base = if base.is_empty() {
        "constellation".to_owned()
    } else {
        base
    };
    let is_free = |name: &String| name != GNSS_ONLY && !taken(name);
    let numbered = (2_u64..).map(|number| format!("{base}-{number}"));
    let mut names = std::iter::once(base.clone()).chain(numbered);
    names.find(is_free).unwrap_or(base)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_similar_name_is_a_name_and_free() {
        let like = |text: &str, taken: &[&str]| similar_name(text, |name| taken.contains(&name));
        assert_eq!(like("iridium.tle", &[]), "iridium_tle");
        assert_eq!(
            like("iridium.tle", &["iridium_tle", "iridium_tle-2"]),
            "iridium_tle-3"
        );
        assert_eq!(like("", &[]), "constellation");
        assert_eq!(like(GNSS_ONLY, &[]), "gnss-only-2");
        let long = like(&"é".repeat(100), &[]);
        assert!(is_name(&long), "{long}");
        assert!(!is_name(&"a".repeat(LONGEST_NAME + 1)) && !is_name("a b") && !is_name(""));
    }
}
