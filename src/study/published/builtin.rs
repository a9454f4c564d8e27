//! The built-in studies.

use crate::keyword::UnknownKeyword;

/// Name and text of every built-in study of published numbers.
const STUDIES: [(&str, &str); 13] = [
    ("paper", include_str!("../../../data/studies/paper.toml")),
    (
        "gps-sps",
        include_str!("../../../data/studies/gps-sps.toml"),
    ),
    (
        "ballard-rosette",
        include_str!("../../../data/studies/ballard-rosette.toml"),
    ),
    (
        "guan-2020",
        include_str!("../../../data/studies/guan-2020.toml"),
    ),
    (
        "globalstar",
        include_str!("../../../data/studies/globalstar.toml"),
    ),
    (
        "iridium",
        include_str!("../../../data/studies/iridium.toml"),
    ),
    (
        "kaplan-hegarty",
        include_str!("../../../data/studies/kaplan-hegarty.toml"),
    ),
    (
        "sun-synchronous",
        include_str!("../../../data/studies/sun-synchronous.toml"),
    ),
    ("skies", include_str!("../../../data/studies/skies.toml")),
    (
        "galileo",
        include_str!("../../../data/studies/galileo.toml"),
    ),
    (
        "glonass",
        include_str!("../../../data/studies/glonass.toml"),
    ),
    (
        "wang-2019",
        include_str!("../../../data/studies/wang-2019.toml"),
    ),
    ("topex", include_str!("../../../data/studies/topex.toml")),
];

/// The names of the built-in studies of published numbers.
#[must_use]
pub fn builtin_studies() -> Vec<&'static str> {
    STUDIES.iter().map(|(name, _)| *name).collect()
}

/// The text of a built-in study.
///
/// # Errors
/// [`UnknownKeyword`] with the existing names and the nearest of them.
pub fn builtin_study(name: &str) -> Result<&'static str, UnknownKeyword> {
    let known = STUDIES.iter().find(|(known, _)| *known == name);
    known
        .map(|(_, text)| *text)
        .ok_or_else(|| UnknownKeyword::new(name, &builtin_studies()))
}
