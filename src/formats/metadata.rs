//! The metadata in every exported file: its originator and content, and under which
//! conventions.

use crate::earth::{GMST_RATE_RAD_S, J2, MU_KM3_S2, RADIUS_KM};
use crate::ephemeris::EphemerisSatellite;
use crate::formats::text::timestamp::TimeSystem;
use crate::frames::Frame;
use crate::keyword::keywords;
use crate::orbit::Model;
use crate::time::{Epoch, MOST_UT1_MINUS_UTC_S, ut1_minus_utc_s};
use chrono::Datelike;
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// A catalogue or designator number that has no place in the formats.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum IdentityError {
    /// Catalogue number past Alpha-5.
    #[error(
        "catalogue number {number} is past {}, the last of Alpha-5",
        CatalogNumber::LAST
    )]
    CatalogNumber {
        /// The number.
        number: u32,
    },
    /// Text that is not a catalogue number.
    #[error(
        "'{0}' is not a catalogue number; Alpha-5 is a digit or a letter (not I or O) and four digits"
    )]
    Alpha5(String),
    /// Fewer catalogue numbers than satellites.
    #[error(
        "export.first-catalog-number: from {first} on there are too few numbers for {satellites} satellites; \
         the last of Alpha-5 is {}",
        CatalogNumber::LAST
    )]
    TooFewNumbers {
        /// The first number.
        first: u32,
        /// Satellites that need a number.
        satellites: usize,
    },
}

/// A satellite catalogue number that a TLE can hold: five digits, or Alpha-5 past 99999.
///
/// Source: Space-Track, *Alpha-5* (the first digit becomes a letter, A = 10 to Z = 33,
/// without I and O).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CatalogNumber(u32);

/// The letters of Alpha-5 in the order of their values, from 10.
const ALPHA5: &[u8; 24] = b"ABCDEFGHJKLMNPQRSTUVWXYZ";

impl CatalogNumber {
    /// The last number that Alpha-5 can write: `Z9999`.
    pub const LAST: u32 = 339_999;

    /// The first number that designs are given unless the scenario says otherwise.
    pub const FIRST_OF_DESIGNS: u32 = 90_001;

    /// The number, if a TLE can hold it.
    ///
    /// # Errors
    /// If it is past [`Self::LAST`].
    pub fn new(number: u32) -> Result<Self, IdentityError> {
        if number <= Self::LAST {
            Ok(Self(number))
        } else {
            Err(IdentityError::CatalogNumber { number })
        }
    }

    /// The number.
    #[must_use]
    pub fn number(self) -> u32 {
        self.0
    }
}

impl fmt::Display for CatalogNumber {
    /// The five characters of a TLE: `90001`, `A0000`.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (high, low) = (self.0 / 10_000, self.0 % 10_000);
        match high.checked_sub(10) {
            None => write!(formatter, "{:05}", self.0),
            Some(letter) => {
                let letter = char::from(ALPHA5[letter as usize]);
                write!(formatter, "{letter}{low:04}")
            }
        }
    }
}

impl FromStr for CatalogNumber {
    type Err = IdentityError;

    /// Reads the five characters of a TLE, with blanks or zeros in front.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let wrong = || IdentityError::Alpha5(text.to_owned());
        let trimmed = text.trim_start_matches(' ');
        let all_digits = |part: &str| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit());
        let first = trimmed.bytes().next().ok_or_else(wrong)?;
        let letter = ALPHA5.iter().position(|candidate| *candidate == first);
        let number = match letter {
            Some(letter) if trimmed.len() == 5 && all_digits(&trimmed[1..]) => {
                let low: u32 = trimmed[1..].parse().map_err(|_| wrong())?;
                (letter as u32 + 10) * 10_000 + low
            }
            None if all_digits(trimmed) => trimmed.parse().map_err(|_| wrong())?,
            _ => return Err(wrong()),
        };
        Self::new(number)
    }
}

/// The identity of a satellite in every format.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Object {
    /// Name: `NW-P01-S01`.
    pub name: String,
    /// Catalogue number.
    pub catalog_number: CatalogNumber,
    /// Identifier in the form of an international designator: `2025-900A`.
    pub id: String,
}

impl Object {
    /// The satellite at place `index` (from 0) of a design, numbered from 90001.
    ///
    /// # Errors
    /// If the number is past Alpha-5.
    pub fn numbered(name: &str, index: usize, epoch: Epoch) -> Result<Self, IdentityError> {
        let number = u32::try_from(index).unwrap_or(u32::MAX);
        let number = CatalogNumber::FIRST_OF_DESIGNS.saturating_add(number);
        Ok(Self::synthetic(name, CatalogNumber::new(number)?, epoch))
    }

    /// A satellite with a number and nothing else of its own.
    ///
    /// The designator follows from the number, so that it is as unique: the year of `epoch`, launches from
    /// 900, which no year has reached, and pieces A to ZZZ without I and O; 90001 is 900A. The same number has the
    /// same designator in every export.
    #[must_use]
    pub fn synthetic(name: &str, number: CatalogNumber, epoch: Epoch) -> Self {
        let numbers = CatalogNumber::LAST + 1;
        let place = (number.number() + numbers - CatalogNumber::FIRST_OF_DESIGNS) % numbers;
        let launch = FIRST_LAUNCH + place as usize / PIECES;
        let piece = piece_letters(place as usize % PIECES);
        Self {
            name: name.to_owned(),
            catalog_number: number,
            id: format!("{:04}-{launch:03}{piece}", epoch.utc().year()),
        }
    }

    /// The identities of satellites in their order.
    ///
    /// # Errors
    /// If the formats cannot tell so many satellites apart.
    pub fn all(
        satellites: &[EphemerisSatellite],
        epoch: Epoch,
    ) -> Result<Vec<Self>, IdentityError> {
        satellites
            .iter()
            .enumerate()
            .map(|(index, satellite)| Self::numbered(&satellite.name, index, epoch))
            .collect()
    }
}

/// First launch number of the synthetic designators; those of all catalogue numbers end at 923.
const FIRST_LAUNCH: usize = 900;

/// Pieces of a launch that one to three of 24 letters name.
const PIECES: usize = 24 + 24 * 24 + 24 * 24 * 24;

/// The piece letters of place `index`: A to Z, AA to ZZ, AAA to ZZZ, without I and O.
fn piece_letters(index: usize) -> String {
    let mut letters = Vec::new();
    let mut rest = index + 1;
    while rest > 0 {
        rest -= 1;
        letters.push(char::from(ALPHA5[rest % ALPHA5.len()]));
        rest /= ALPHA5.len();
    }
    letters.iter().rev().collect()
}

keywords! {
    /// How SGP4 element sets are made from a design.
    ElementChoice {
        /// The J2 mean elements with dM/dt of secular J2 in the mean motion slot.
        Kozai = "kozai",
        /// The same with sqrt(mu/a^3) there, which drifts by up to 400 km a day.
        Kepler = "kepler",
        /// Fitted to the propagated trajectory over the span of the study.
        Fit = "fit",
    }
}

/// What the numbers of a file were computed with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Theory {
    /// States of the propagation model of the scenario.
    Propagated(Model),
    /// An SGP4 element set made from the design.
    Sgp4Elements(ElementChoice),
    /// Element sets of another file, as they are.
    SourceSets,
    /// States by SGP4 from the element sets of another file.
    Sgp4OfSource,
    /// States of another file, interpolated.
    Interpolated,
    /// States from the almanac of another file.
    Almanac,
    /// Different ones for different satellites.
    Several(Vec<Theory>),
}

impl Theory {
    /// The theory of a file whose satellites have these.
    #[must_use]
    pub fn of_all(theories: impl IntoIterator<Item = Self>) -> Self {
        let mut different: Vec<Self> = Vec::new();
        for theory in theories {
            if !different.contains(&theory) {
                different.push(theory);
            }
        }
        match different.len() {
            1 => different.remove(0),
            _ => Self::Several(different),
        }
    }
}

impl fmt::Display for Theory {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(match self {
            Self::Propagated(model) => return model.fmt(formatter),
            Self::Several(theories) => {
                let texts: Vec<String> = theories.iter().map(Self::to_string).collect();
                return formatter.pad(&texts.join("; "));
            }
            Self::Sgp4Elements(ElementChoice::Kozai) => {
                "SGP4 elements, Kozai mean motion dM/dt of secular J2"
            }
            Self::Sgp4Elements(ElementChoice::Kepler) => {
                "SGP4 elements, Kepler mean motion sqrt(mu/a^3) in the Kozai slot"
            }
            Self::Sgp4Elements(ElementChoice::Fit) => {
                "SGP4 elements fitted to the propagated trajectory"
            }
            Self::SourceSets => "SGP4 elements of the source",
            Self::Sgp4OfSource => "SGP4 from the elements of the source",
            Self::Interpolated => "states of the source, interpolated",
            Self::Almanac => "almanac of the source",
        })
    }
}

/// Maximum distance of the Earth's pole from that of an ITRF since 1972, rad: 0.6 arcseconds (IERS EOP C04).
const MOST_POLAR_MOTION_RAD: f64 = 2.91e-6;

/// The description of a file's content.
#[derive(Debug, Clone, PartialEq)]
pub struct Metadata {
    /// Who made the file.
    pub originator: String,
    /// When the file says it was made: the epoch of the scenario, so that equal runs give
    /// equal bytes.
    pub creation: Epoch,
    /// Frame of the states, or of the elements.
    pub frame: Frame,
    /// Time system of the stamps.
    pub time_system: TimeSystem,
    /// What the numbers were computed with.
    pub theory: Theory,
    /// The study that the file belongs to, one line each: design, scenario.
    pub subject: Vec<String>,
    /// A note on the frame: its distance from the frame that it is labelled as.
    pub frame_note: Option<String>,
    /// Whether satellites come from other files, with identities of their own.
    pub from_files: bool,
}

impl Metadata {
    /// The lines that name the subject and the conventions, for the comments of a file.
    /// Printable ASCII, no line longer than 200 characters if the subject's are not.
    #[must_use]
    pub fn comments(&self) -> Vec<String> {
        let mut lines = self.subject.clone();
        lines.push(format!("Theory: {}", self.theory));
        lines.push(format!(
            "Design constants: mu = {MU_KM3_S2} km3/s2, Re = {RADIUS_KM} km, J2 = {J2:e}; \
             WGS-72 in SGP4 alone"
        ));
        lines.push(frame_comment(self.frame).to_owned());
        lines.extend(self.frame_note.clone());
        lines.push(self.identities().to_owned());
        lines
    }

    fn identities(&self) -> &'static str {
        if self.from_files {
            "Identities: those of the source files, synthetic where these have none"
        } else {
            "Simulated objects: OBJECT_ID and catalogue numbers are synthetic"
        }
    }
}

/// What a reader has to know of a frame, with the conventions that lead to it.
#[must_use]
pub fn frame_comment(frame: Frame) -> &'static str {
    match frame {
        Frame::Teme => {
            "Frame: TEME of date, true equator and mean equinox (Vallado et al., AIAA 2006-6753)"
        }
        Frame::Eme2000 => {
            "Frame: EME2000 from TEME by the equation of the equinoxes (1994) and IAU 1976/1980, \
             no corrections"
        }
        Frame::Gcrf => {
            "Frame: GCRF from TEME by the equation of the equinoxes (1994), IAU 1976/1980 and the \
             frame bias"
        }
        Frame::EarthFixed => {
            "Frame: pseudo-Earth-fixed, TEME rotated by GMST (IAU 1982), UT1 = UTC at the epoch, no polar motion"
        }
    }
}

/// How far the pseudo-Earth-fixed frame of a scenario that starts at `epoch` is from an ITRF with
/// Earth-orientation data, `radius_km` from the axis of the Earth: by UT1 - UTC of the epoch, and by the pole.
#[must_use]
pub fn distance_from_itrf(epoch: Epoch, radius_km: f64) -> String {
    let observed_s = ut1_minus_utc_s(epoch).map(f64::abs);
    let turned_s = observed_s.unwrap_or(MOST_UT1_MINUS_UTC_S);
    let ten_metres = |rad: f64| (rad * radius_km * 100.0).round().max(1.0) * 10.0;
    let turned_m = ten_metres(turned_s * GMST_RATE_RAD_S);
    let pole_m = ten_metres(MOST_POLAR_MOTION_RAD);
    let (about, why) = match observed_s {
        Some(s) => ("about", format!("is {s:.2} s at the epoch (IERS EOP C04)")),
        None => (
            "at most",
            format!("<= {MOST_UT1_MINUS_UTC_S} s, not yet observed at the epoch"),
        ),
    };
    format!(
        "Off an ITRF with Earth-orientation data by {about} {turned_m} m at r = {radius_km:.0} km, as \
         |UT1 - UTC| {why}, and by polar motion, at most {pole_m} m"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    fn epoch() -> Epoch {
        Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap())
    }

    /// |UT1 - UTC| ω r of IERS EOP 20 C04: 0.676 s on 2015-06-30 is 360 m at 925 km, 0.046 s on 2025-01-01 is 18 m;
    /// at most 0.9 s where it is not observed.
    #[test]
    fn validate_the_distance_from_an_itrf() {
        let told = |utc: &str, radius_km| {
            let text = distance_from_itrf(Epoch::from_utc(utc.parse().unwrap()), radius_km);
            assert!(text.is_ascii() && text.len() <= 200, "{text}");
            text
        };
        let leap = told("2015-06-30T00:00:00Z", 7_303.0);
        assert!(
            leap.contains("about 360 m at r = 7303 km, as |UT1 - UTC| is 0.68 s"),
            "{leap}"
        );
        assert!(leap.ends_with("polar motion, at most 20 m"), "{leap}");
        let recent = told("2025-01-01T00:00:00Z", 7_303.0);
        assert!(
            recent.contains("about 20 m at r = 7303 km, as |UT1 - UTC| is 0.05 s"),
            "{recent}"
        );
        let high = told("2025-01-01T00:00:00Z", 42_164.0);
        assert!(
            high.contains("about 140 m") && high.contains("at most 120 m"),
            "{high}"
        );
        let future = told("2090-01-01T00:00:00Z", 7_303.0);
        assert!(
            future.contains("at most 480 m at r = 7303 km, as |UT1 - UTC| <= 0.9 s"),
            "{future}"
        );
    }

    /// The examples of Space-Track's description of Alpha-5.
    #[test]
    fn validate_alpha5() {
        for (number, text) in [
            (5, "00005"),
            (99_999, "99999"),
            (100_000, "A0000"),
            (148_493, "E8493"),
            (182_931, "J2931"),
            (234_018, "P4018"),
            (301_928, "W1928"),
            (339_999, "Z9999"),
        ] {
            let catalog = CatalogNumber::new(number).unwrap();
            assert_eq!(catalog.to_string(), text);
            assert_eq!(text.parse(), Ok(catalog));
        }
        assert_eq!("    5".parse(), CatalogNumber::new(5));
        assert!(CatalogNumber::new(340_000).is_err());
        for wrong in [
            "I0000", "O0000", "A000", "a0000", "", "12 45", "-0001", "AA000",
        ] {
            assert!(wrong.parse::<CatalogNumber>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn identities_are_unique_and_fit_a_tle() {
        let mut ids = HashSet::new();
        let mut numbers = HashSet::new();
        for index in 0..crate::constellation::Design::MAX_SATELLITES {
            let object = Object::numbered("NW", index, epoch()).unwrap();
            assert!(object.id.len() <= 11, "{}", object.id);
            numbers.insert(object.catalog_number.to_string());
            ids.insert(object.id);
        }
        assert_eq!(ids.len(), crate::constellation::Design::MAX_SATELLITES);
        assert_eq!(numbers.len(), ids.len());
        assert!(ids.contains("2025-900A") && ids.contains("2025-900AA"));
        assert!(ids.contains("2025-901A"));
        assert!(Object::numbered("NW", 249_998, epoch()).is_ok());
        assert!(Object::numbered("NW", 249_999, epoch()).is_err());
    }

    /// Every number that a TLE can hold has a designator of its own, which fits a TLE.
    #[test]
    fn designators_are_as_unique_as_numbers() {
        let object = |number| Object::synthetic("A", CatalogNumber::new(number).unwrap(), epoch());
        let ids: HashSet<String> = (0..=CatalogNumber::LAST).map(|n| object(n).id).collect();
        assert_eq!(ids.len(), CatalogNumber::LAST as usize + 1);
        assert_eq!(object(90_001).id, "2025-900A");
        assert_eq!(
            object(90_000).id.len(),
            11,
            "the last of them, in launch 923"
        );
    }

    #[test]
    fn comments_fit_a_line_of_ccsds() {
        for frame in [Frame::Teme, Frame::Eme2000, Frame::Gcrf, Frame::EarthFixed] {
            let metadata = Metadata {
                originator: "NAVWALKER".to_owned(),
                creation: epoch(),
                frame,
                time_system: TimeSystem::Utc,
                theory: Theory::Sgp4Elements(ElementChoice::Kepler),
                subject: vec!["Design: delta:55:182/13/1@925".to_owned()],
                frame_note: None,
                from_files: false,
            };
            for line in metadata.comments() {
                assert!(line.len() <= 200 && line.bytes().all(|b| (b' '..=b'~').contains(&b)));
            }
        }
    }
}
