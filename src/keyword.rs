//! Enums spelled by fixed keywords, in files, notation and results.
//!
//! The macro `keywords!` declares one: `Display` writes the keyword that `FromStr` reads, and an unknown
//! keyword is reported with the nearest valid one.

use std::fmt;

/// A type whose values are spelled by fixed keywords.
pub trait Keyword: Copy + Eq + 'static {
    /// Every value, in the order in which they are listed as choices.
    const ALL: &'static [Self];

    /// The spelling in a file.
    fn keyword(self) -> &'static str;

    /// The value spelled `text`.
    ///
    /// # Errors
    /// [`UnknownKeyword`], with the choices and the nearest of them.
    fn from_keyword(text: &str) -> Result<Self, UnknownKeyword> {
        let known = Self::ALL.iter().find(|value| value.keyword() == text);
        known
            .copied()
            .ok_or_else(|| UnknownKeyword::new(text, &Self::choices()))
    }

    /// Every spelling, in the order of [`Keyword::ALL`].
    fn choices() -> Vec<&'static str> {
        Self::ALL.iter().map(|value| value.keyword()).collect()
    }
}

/// A keyword that is not one of the choices.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownKeyword {
    /// The keyword as written.
    pub found: String,
    /// The valid keywords.
    pub choices: Vec<&'static str>,
    /// The choice that was most likely meant.
    pub nearest: Option<&'static str>,
}

impl UnknownKeyword {
    pub(crate) fn new(found: &str, choices: &[&'static str]) -> Self {
        Self {
            found: found.to_owned(),
            choices: choices.to_vec(),
            nearest: nearest(found, choices),
        }
    }
}

impl fmt::Display for UnknownKeyword {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "unknown name {:?}", self.found)?;
        if let Some(nearest) = self.nearest {
            write!(f, ", did you mean {nearest:?}?")?;
        }
        write!(f, " (choices: {})", self.choices.join(", "))
    }
}

impl std::error::Error for UnknownKeyword {}

macro_rules! keywords {
    ($(#[$doc:meta])* $name:ident { $($(#[$value_doc:meta])* $value:ident = $word:literal,)+ }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum $name { $($(#[$value_doc])* $value,)+ }

        impl $crate::keyword::Keyword for $name {
            const ALL: &'static [Self] = &[$(Self::$value,)+];

            fn keyword(self) -> &'static str {
                match self { $(Self::$value => $word,)+ }
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad($crate::keyword::Keyword::keyword(*self))
            }
        }

        impl std::str::FromStr for $name {
            type Err = $crate::keyword::UnknownKeyword;

            fn from_str(text: &str) -> Result<Self, Self::Err> {
                $crate::keyword::Keyword::from_keyword(text)
            }
        }
    };
}

pub(crate) use keywords;

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
