//! The words that a scenario file may use where only a few are known.
//!
//! Every enum here is spelled in a file by the word that its [`fmt::Display`]
//! writes; [`FromStr`] takes the same word and nothing else.

use std::fmt;
use std::str::FromStr;

use super::nearest::nearest;

/// A type whose values are spelled by a fixed set of words.
pub trait Word: Copy + Eq + 'static {
    /// Every value, in the order in which choices are listed.
    const ALL: &'static [Self];

    /// The spelling in a file.
    fn word(self) -> &'static str;

    /// The value spelled `text`.
    ///
    /// # Errors
    /// [`UnknownWord`] with the choices and the nearest of them.
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

/// A word that is not one of the choices.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownWord {
    /// The word as written.
    pub found: String,
    /// The words that are known.
    pub choices: Vec<&'static str>,
    /// The choice that was most likely meant.
    pub nearest: Option<&'static str>,
}

impl UnknownWord {
    pub(super) fn new(found: &str, choices: &[&'static str]) -> Self {
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

        impl Word for $name {
            const ALL: &'static [Self] = &[$(Self::$value,)+];

            fn word(self) -> &'static str {
                match self { $(Self::$value => $word,)+ }
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.pad(self.word())
            }
        }

        impl FromStr for $name {
            type Err = UnknownWord;

            fn from_str(text: &str) -> Result<Self, UnknownWord> {
                Self::from_word(text)
            }
        }
    };
}

words! {
    /// The surface on which ground points lie and to which their verticals belong.
    Surface {
        /// The WGS84 ellipsoid, geodetic verticals.
        Wgs84 = "wgs84",
        /// A sphere of the equatorial radius, geocentric verticals.
        Sphere = "sphere",
    }
}

words! {
    /// How the LEO design is propagated.
    Model {
        /// Secular J2 rates on mean elements.
        J2 = "j2",
        /// Kepler's motion.
        TwoBody = "two-body",
        /// Secular J2 rates and the first-order short-period terms.
        J2Osculating = "j2-osculating",
        /// SGP4 with B* = 0.
        Sgp4 = "sgp4",
    }
}

words! {
    /// How the points of a grid count in a mean.
    Weights {
        /// Every point counts the same.
        Equal = "equal",
        /// A point counts as the cosine of its latitude, that is, as its share of the area.
        CosLatitude = "cos-latitude",
    }
}

words! {
    /// How a line of sight counts in the least-squares solution behind a PDOP.
    Weighting {
        /// Every line of sight counts the same.
        Unit = "unit",
        /// A line of sight counts as the sine of its elevation.
        SineElevation = "sine-elevation",
    }
}

words! {
    /// A GNSS whose constellation is built in.
    Gnss {
        /// BeiDou-3: 24 MEO, 3 IGSO, 3 GEO.
        Beidou3 = "beidou-3",
        /// GPS.
        Gps = "gps",
        /// Galileo.
        Galileo = "galileo",
        /// GLONASS.
        Glonass = "glonass",
    }
}

words! {
    /// The receiver clocks that are solved for beside the position.
    Clocks {
        /// One for each system in view.
        PerSystem = "per-system",
        /// One for all systems.
        Shared = "shared",
    }
}

words! {
    /// The pattern of the designs that are searched.
    Pattern {
        /// Walker delta: nodes spread over 360 degrees.
        Delta = "delta",
        /// Walker star: nodes spread over 180 degrees.
        Star = "star",
        /// Two-dimensional lattice flower.
        Lattice = "lattice",
    }
}

words! {
    /// The strategy of the search.
    Algorithm {
        /// NSGA-II.
        Nsga2 = "nsga2",
        /// Multi-objective particle swarm.
        Mopso = "mopso",
        /// Uniform random sampling.
        Random = "random",
        /// Every design of the lattice that the steps span.
        Exhaustive = "exhaustive",
    }
}

words! {
    /// A number that a design has, to be minimized, maximized or bounded.
    Quantity {
        /// Mean PDOP plus the weighted tail.
        JPos = "j-pos",
        /// Satellites for each LEO satellite in view.
        JCost = "j-cost",
        /// Mean PDOP.
        MeanPdop = "mean-pdop",
        /// Mean of the worst share of the PDOP.
        CvarPdop = "cvar-pdop",
        /// Largest PDOP.
        MaxPdop = "max-pdop",
        /// Number of satellites.
        Satellites = "satellites",
        /// Number of planes.
        Planes = "planes",
        /// Mean number of LEO satellites in view.
        MeanVisible = "mean-visible",
        /// Share of the samples with a PDOP of at most `availability-pdop`.
        Availability = "availability",
        /// Relative cost of bringing the satellites up.
        LaunchCost = "launch-cost",
    }
}

impl Quantity {
    /// Whether more of it is better: as an objective it is then maximized.
    #[must_use]
    pub fn maximized(self) -> bool {
        matches!(self, Self::MeanVisible | Self::Availability)
    }

    /// The coordinate of the hypervolume's reference point when none is given.
    #[must_use]
    pub fn default_reference(self) -> Option<f64> {
        match self {
            Self::JPos => Some(2.0),
            Self::JCost => Some(22.0),
            _ => None,
        }
    }
}

words! {
    /// The side of its bound on which a constrained quantity must stay.
    Relation {
        /// The quantity is at most the bound.
        AtMost = "<=",
        /// The quantity is at least the bound.
        AtLeast = ">=",
    }
}
