//! How a product is read back: its files, its theory and its digits.

use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::exchange::members::{ConstellationMember, Origin};
use crate::formats::tle;
use crate::time::{Epoch, TimeGrid};
use crate::units::SECONDS_PER_DAY;
use std::f64::consts::TAU;

/// Nine decimals of a kilometre, time tags to a nanosecond, and rotations there and back, km.
const STATES_KM: f64 = 1e-8;

/// Six decimals of a kilometre in three components, and epochs to 1e-8 s, km.
const SP3_KM: f64 = 1e-6;

/// The metre between samples, for which their spacing is chosen on one satellite, twice that for the
/// others, plus a decimetre of digits, km.
const CZML_KM: f64 = 2.0 * crate::formats::maps::czml::TARGET_KM + 2e-4;

/// How the files of a product are read back and what they are compared with.
#[derive(Debug, Clone, Copy)]
pub struct ReadBack {
    /// Which of its files contain the constellation.
    pub files: Grouping,
    /// The theory of its satellites.
    pub theory: ReadBackTheory,
    /// How far its digits may move a satellite, km.
    pub digits_km: fn(Extent) -> f64,
}

/// Which files of a product contain the constellation once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Grouping {
    /// All of them together.
    Together,
    /// Each on its own.
    Each,
}

/// The theory that the satellites of a product follow.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReadBackTheory {
    /// The model of the study.
    Study,
    /// SGP4, from element sets at the epoch of the study.
    Sgp4,
    /// SGP4, from element sets at the epoch of the study as a TLE rounds it.
    Sgp4OfTle,
}

impl ReadBackTheory {
    /// What rounds the epoch of the element sets, if there are any.
    pub(super) fn rounding_of_sets(self) -> Option<fn(Epoch) -> Epoch> {
        match self {
            Self::Study => None,
            Self::Sgp4 => Some(|epoch| epoch),
            Self::Sgp4OfTle => Some(tle::rounded_epoch),
        }
    }
}

/// The quantities on which the effect of a digit depends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    /// Largest semi-major axis, km; of satellites without elements, their distance from the centre of the Earth.
    pub semi_major_axis_km: f64,
    /// Span of the study, days; longer where element sets are older than that.
    pub days: f64,
}

impl Extent {
    pub(super) fn new(
        members: &[ConstellationMember<'_>],
        ephemeris: &Ephemeris,
    ) -> Result<Self, EphemerisError> {
        let grid = ephemeris.grid();
        let mut extent = Self {
            semi_major_axis_km: 0.0,
            days: grid.elapsed_s(grid.len() - 1) / SECONDS_PER_DAY,
        };
        for (member, satellite) in members.iter().zip(ephemeris.satellites()) {
            let size_km = match member.origin.semi_major_axis_km() {
                Some(size_km) => size_km,
                None => ephemeris.state(satellite, 0.0)?.position_km.norm(),
            };
            extent.semi_major_axis_km = extent.semi_major_axis_km.max(size_km);
            if let Origin::Set(set) = member.origin {
                let days = days_from(Epoch::from_utc(set.datetime.and_utc()), grid);
                extent.days = extent.days.max(days);
            }
        }
        Ok(extent)
    }
}

/// Days from an instant to the farther end of a grid.
fn days_from(epoch: Epoch, grid: TimeGrid) -> f64 {
    let ends = [0, grid.len() - 1].map(|k| grid.epoch().plus_seconds(grid.elapsed_s(k)));
    let apart = ends.map(|end| end.seconds_since(epoch).abs() / SECONDS_PER_DAY);
    apart[0].max(apart[1])
}

/// States and elements as the tables, the OEM and the STK ephemerides write them.
pub(crate) fn states_km(_: Extent) -> f64 {
    STATES_KM
}

/// States of SP3.
pub(crate) fn sp3_km(_: Extent) -> f64 {
    SP3_KM
}

/// Positions of CZML, which a viewer interpolates.
pub(crate) fn czml_km(_: Extent) -> f64 {
    CZML_KM
}

/// Nine decimals of a kilometre of a: 3/2 da n t in-track, where a low orbit turns by 16
/// revolutions a day at most.
pub(crate) fn opm_km(extent: Extent) -> f64 {
    STATES_KM + 1.5 * 0.5e-9 * (16.0 * TAU * extent.days)
}

/// Twelve decimals of a degree, fifteen of e, thirteen of the mean motion.
pub(crate) fn omm_km(extent: Extent) -> f64 {
    1e-8 * (1.0 + extent.days)
}

/// Four angles to 1e-4°, e to 1e-7 (twice that in-track), the mean motion to 1e-8 rev/day;
/// an inclination off by half a digit turns each of three angles, which J2 moves by 10° a day at
/// most, by three times as much as itself at most.
pub(crate) fn tle_km(extent: Extent) -> f64 {
    let half_digit = 0.5e-4_f64.to_radians();
    let rates = 3.0 * 3.0 * 10_f64.to_radians() * half_digit;
    let grown = (TAU * 0.5e-8 + rates) * extent.days;
    STATES_KM + extent.semi_major_axis_km * (4.0 * half_digit + 1e-7 + grown)
}
