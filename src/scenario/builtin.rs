//! The built-in scenarios.

use crate::keyword::UnknownKeyword;

/// Name and text of every built-in scenario.
const BUILTINS: [(&str, &str); 5] = [
    ("paper", include_str!("../../data/scenarios/paper.toml")),
    (
        "regional",
        include_str!("../../data/scenarios/regional.toml"),
    ),
    ("global", include_str!("../../data/scenarios/global.toml")),
    ("europe", include_str!("../../data/scenarios/europe.toml")),
    ("robust", include_str!("../../data/scenarios/robust.toml")),
];

/// The names of the built-in scenarios.
#[must_use]
pub fn builtin_names() -> Vec<&'static str> {
    BUILTINS.iter().map(|(name, _)| *name).collect()
}

/// The text of a built-in scenario.
///
/// # Errors
/// [`UnknownKeyword`] with the existing names and the nearest of them.
pub fn builtin(name: &str) -> Result<&'static str, UnknownKeyword> {
    let known = BUILTINS.iter().find(|(known, _)| *known == name);
    known
        .map(|(_, text)| *text)
        .ok_or_else(|| UnknownKeyword::new(name, &builtin_names()))
}
