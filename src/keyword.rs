//! Enums spelled by fixed keywords, in files, notation and results.
//!
//! The macro `words!` declares one: `Display` writes the keyword that `FromStr` reads, and an unknown
//! keyword is reported with the nearest valid one.

use std::fmt;

/// A type whose values are spelled by fixed keywords.
pub trait Word: Copy + Eq + 'static {
    /// Every value, in the order in which they are listed as choices.
    const ALL: &'static [Self];

    /// The spelling in a file.
    fn word(self) -> &'static str;

    /// The value spelled `text`.
    ///
    /// # Errors
    /// [`UnknownWord`], with the choices and the nearest of them.
    fn from_word(text: &str) -> Result<Self, UnknownWord> {
        let known = Self::ALL.iter().find(|value| value.word() == text);
        known
            .copied()
            .ok_or_else(|| UnknownWord::new(text, &Self::choices()))
    }

    /// Every spelling, in the order of [`Word::ALL`].
    fn choices() -> Vec<&'static str> {
        Self::ALL.iter().map(|value| value.word()).collect()
    }
}

/// A keyword that is not one of the choices.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownWord {
    /// The keyword as written.
    pub found: String,
    /// The valid keywords.
    pub choices: Vec<&'static str>,
    /// The choice that was most likely meant.
    pub nearest: Option<&'static str>,
}

impl UnknownWord {
    pub(crate) fn new(found: &str, choices: &[&'static str]) -> Self {
        Self {
            found: found.to_owned(),
            choices: choices.to_vec(),
            nearest: nearest(found, choices),
        }
    }
}

impl fmt::Display for UnknownWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "unknown word {:?}", self.found)?;
        if let Some(nearest) = self.nearest {
            write!(f, ", did you mean {nearest:?}?")?;
        }
        write!(f, " (choices: {})", self.choices.join(", "))
    }
}

impl std::error::Error for UnknownWord {}

macro_rules! words {
    ($(#[$doc:meta])* $name:ident { $($(#[$value_doc:meta])* $value:ident = $word:literal,)+ }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum $name { $($(#[$value_doc])* $value,)+ }

        impl $crate::keyword::Word for $name {
            const ALL: &'static [Self] = &[$(Self::$value,)+];

            fn word(self) -> &'static str {
                match self { $(Self::$value => $word,)+ }
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad($crate::keyword::Word::word(*self))
            }
        }

        impl std::str::FromStr for $name {
            type Err = $crate::keyword::UnknownWord;

            fn from_str(text: &str) -> Result<Self, Self::Err> {
                $crate::keyword::Word::from_word(text)
            }
        }
    };
}

pub(crate) use words;

/// Below this Jaro-Winkler similarity (0 to 1) a name is not worth suggesting:
/// short unrelated keys such as `epoch` and `points` reach about 0.6.
const WORTH_SUGGESTING: f64 = 0.7;

/// The candidate most similar to `written`, if one is similar enough.
///
/// Jaro-Winkler favours a common prefix, so `latitude` finds `latitude-deg`, which is four edits
/// away by edit distance.
pub(crate) fn nearest<'c>(written: &str, candidates: &[&'c str]) -> Option<&'c str> {
    let written = written.to_lowercase().replace('_', "-");
    candidates
        .iter()
        .map(|candidate| (strsim::jaro_winkler(&written, candidate), *candidate))
        .filter(|(similarity, _)| *similarity >= WORTH_SUGGESTING)
        .max_by(|(a, _), (b, _)| a.total_cmp(b))
        .map(|(_, candidate)| candidate)
}
