//! YUMA almanacs of nominal GNSS constellations, written and read.
//!
//! Source: U.S. Coast Guard Navigation Center, *GPS NANUS, Almanacs*: "Definition of a Yuma
//! Almanac" (fields, their order and units); the user's algorithm is that of IS-GPS-200, table
//! 20-IV, with the almanac's subset (20.3.3.5.1.2): a mean motion of sqrt(mu/A³) and a constant
//! rate of the node. A preset fits without loss of angle: A is chosen for the rate of the argument
//! of latitude, which moves the radius, and the node's rate absorbs the difference of the two rates
//! of the Earth ([M-39](crate::models#m-39)).

mod orbit;
mod read;

pub use orbit::AlmanacOrbit;
pub use read::{parse, read};

use crate::constellation::gnss::{GnssOrbit, GnssSatellite};
use crate::earth::{GEOSYNCHRONOUS_RADIUS_KM, GMST_RATE_RAD_S, GPS_EARTH_RATE_RAD_S, GPS_MU_M3_S2};
use crate::formats::text::timestamp::TimeSystem;
use crate::time::Epoch;
use crate::units::wrap_pi;
use chrono::{NaiveDate, NaiveDateTime, TimeDelta};
use std::io::{self, Write};

/// The definition that the files follow.
pub const FORMAT_VERSION: &str = "NAVCEN";

/// Seconds of a week.
const WEEK_S: f64 = 604_800.0;

/// Spacing of the times of applicability, s (IS-GPS-200, table 20-VI: scale 2¹²).
const TOA_STEP_S: f64 = 4_096.0;

/// Weeks after which the count begins again (IS-GPS-200, 3.3.4: ten bits).
const WEEKS: i64 = 1_024;

/// The almanac of one satellite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Almanac {
    /// Number of the satellite.
    pub prn: u32,
    /// Health: 0 is good.
    pub health: u32,
    /// Eccentricity.
    pub eccentricity: f64,
    /// Seconds of the week to which the elements refer.
    pub toa_s: f64,
    /// Inclination, rad.
    pub inclination_rad: f64,
    /// Rate of the right ascension, rad/s.
    pub raan_rate_rad_s: f64,
    /// Square root of the semi-major axis, m^(1/2).
    pub sqrt_a: f64,
    /// Longitude of the ascending node at the start of the week, rad.
    pub raan_at_week_rad: f64,
    /// Argument of perigee, rad.
    pub arg_perigee_rad: f64,
    /// Mean anomaly, rad.
    pub mean_anomaly_rad: f64,
    /// GPS week, modulo 1024.
    pub week: u32,
}

/// Why a satellite has no almanac.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoAlmanac {
    /// It is propagated by SGP4, or given by a file.
    Sgp4,
    /// Its perigee moves, which an almanac has no rate for.
    Eccentric,
}

/// GPS week and the time of applicability next to an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Applicability {
    week: i64,
    toa_s: f64,
}

impl Applicability {
    /// The one next to an instant; 604 800 s is the start of the next week.
    #[must_use]
    pub fn next_to(epoch: Epoch) -> Self {
        let since = TimeSystem::Gps.stamp(epoch) - gps_origin();
        let week = since.num_seconds().div_euclid(WEEK_S as i64);
        let of_week = since - TimeDelta::weeks(week);
        let seconds = of_week.num_milliseconds() as f64 / 1000.0;
        let toa_s = (seconds / TOA_STEP_S).round() * TOA_STEP_S;
        // The last multiple in a week is 602 112.
        if toa_s >= WEEK_S {
            return Self {
                week: week + 1,
                toa_s: 0.0,
            };
        }
        Self { week, toa_s }
    }

    /// The instant.
    #[must_use]
    pub fn epoch(self) -> Epoch {
        let seconds = TimeDelta::seconds(self.toa_s as i64);
        TimeSystem::Gps.epoch(gps_origin() + TimeDelta::weeks(self.week) + seconds)
    }
}

/// Start of GPS time (IS-GPS-200, 3.3.4).
fn gps_origin() -> NaiveDateTime {
    let day = NaiveDate::from_ymd_opt(1980, 1, 6).unwrap_or_default();
    day.and_time(chrono::NaiveTime::MIN)
}

/// Angles at an instant and their rates: node, mean argument of latitude; and the ellipse, whose perigee stays.
struct AlmanacAngles {
    eccentricity: f64,
    arg_perigee_rad: f64,
    inclination_rad: f64,
    raan_rad: f64,
    raan_rate_rad_s: f64,
    latitude_argument_rad: f64,
    latitude_argument_rate_rad_s: f64,
}

impl Almanac {
    /// The almanac of a nominal satellite of a study that starts at `epoch`.
    ///
    /// # Errors
    /// If an almanac has no elements for its motion.
    pub fn of(
        satellite: &GnssSatellite,
        prn: u32,
        epoch: Epoch,
        at: Applicability,
    ) -> Result<Self, NoAlmanac> {
        let since_s = at.epoch().seconds_since(epoch);
        let gmst_rad = epoch.gmst_rad(since_s);
        let angles = angles(&satellite.orbit, since_s, gmst_rad)?;
        let rate = angles.latitude_argument_rate_rad_s;
        let fixed_node = angles.raan_rad - gmst_rad + GPS_EARTH_RATE_RAD_S * at.toa_s;
        Ok(Self {
            prn,
            health: 0,
            eccentricity: angles.eccentricity,
            toa_s: at.toa_s,
            inclination_rad: angles.inclination_rad,
            raan_rate_rad_s: angles.raan_rate_rad_s - (GMST_RATE_RAD_S - GPS_EARTH_RATE_RAD_S),
            sqrt_a: (GPS_MU_M3_S2 / (rate * rate)).powf(1.0 / 6.0),
            raan_at_week_rad: wrap_pi(fixed_node),
            arg_perigee_rad: wrap_pi(angles.arg_perigee_rad),
            mean_anomaly_rad: wrap_pi(angles.latitude_argument_rad - angles.arg_perigee_rad),
            week: at.week.rem_euclid(WEEKS) as u32,
        })
    }

    /// Writes the satellite's block.
    ///
    /// # Errors
    /// If writing fails.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let Self { prn, week, .. } = self;
        writeln!(
            out,
            "******** Week {week:4} almanac for PRN-{prn:02} ********"
        )?;
        writeln!(out, "ID:                         {prn:02}")?;
        writeln!(out, "Health:                     {:03}", self.health)?;
        let number = |out: &mut _, key: &str, value: f64| field(out, key, value);
        number(out, "Eccentricity:", self.eccentricity)?;
        writeln!(out, "Time of Applicability(s):  {:11.4}", self.toa_s)?;
        writeln!(
            out,
            "Orbital Inclination(rad):   {:.10}",
            self.inclination_rad
        )?;
        number(out, "Rate of Right Ascen(r/s):", self.raan_rate_rad_s)?;
        writeln!(out, "SQRT(A)  (m 1/2):           {:.7}", self.sqrt_a)?;
        number(out, "Right Ascen at Week(rad):", self.raan_at_week_rad)?;
        writeln!(
            out,
            "Argument of Perigee(rad):   {:.9}",
            self.arg_perigee_rad
        )?;
        number(out, "Mean Anom(rad):", self.mean_anomaly_rad)?;
        number(out, "Af0(s):", 0.0)?;
        number(out, "Af1(s/s):", 0.0)?;
        writeln!(out, "week:                        {week}")
    }
}

/// A key and a number in the exponent form of the format: `-0.7931758961E-008`.
fn field(out: &mut impl Write, key: &str, value: f64) -> io::Result<()> {
    let text = format!("{value:.10E}");
    let (digits, exponent) = text.split_once('E').unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or_default();
    let sign = if exponent < 0 { '-' } else { '+' };
    writeln!(out, "{key:<27}{digits:>13}E{sign}{:03}", exponent.abs())
}

fn angles(orbit: &GnssOrbit, since_s: f64, gmst_rad: f64) -> Result<AlmanacAngles, NoAlmanac> {
    match orbit {
        GnssOrbit::Secular(secular) => {
            let elements = secular.elements_at(since_s);
            if elements.eccentricity > 0.0 {
                return Err(NoAlmanac::Eccentric);
            }
            let rates = secular.rates();
            Ok(AlmanacAngles {
                eccentricity: 0.0,
                arg_perigee_rad: 0.0,
                inclination_rad: elements.inclination_rad,
                raan_rad: elements.raan_rad,
                raan_rate_rad_s: rates.raan_rad_s,
                latitude_argument_rad: elements.arg_perigee_rad + elements.mean_anomaly_rad,
                latitude_argument_rate_rad_s: rates.arg_latitude_rad_s(),
            })
        }
        GnssOrbit::Geosynchronous(orbit) => Ok(AlmanacAngles {
            eccentricity: orbit.eccentricity,
            arg_perigee_rad: orbit.arg_perigee_rad,
            inclination_rad: orbit.inclination_rad,
            raan_rad: orbit.raan_rad,
            raan_rate_rad_s: 0.0,
            latitude_argument_rad: orbit.argument_of_latitude_rad + GMST_RATE_RAD_S * since_s,
            latitude_argument_rate_rad_s: GMST_RATE_RAD_S,
        }),
        // Any node will do on the equator: that of the longitude it is held over.
        GnssOrbit::Geostationary { longitude_rad, .. } => Ok(AlmanacAngles {
            eccentricity: 0.0,
            arg_perigee_rad: 0.0,
            inclination_rad: 0.0,
            raan_rad: gmst_rad + longitude_rad,
            raan_rate_rad_s: 0.0,
            latitude_argument_rad: 0.0,
            latitude_argument_rate_rad_s: GMST_RATE_RAD_S,
        }),
        GnssOrbit::Sgp4(_) | GnssOrbit::Given(_) => Err(NoAlmanac::Sgp4),
    }
}

/// How far the radius of the almanac is from that of the satellite, km.
#[must_use]
pub fn radius_shift_km(almanac: &Almanac, orbit: &GnssOrbit) -> f64 {
    let radius_km = match orbit {
        GnssOrbit::Secular(secular) => secular.elements_at(0.0).semi_major_axis_km,
        _ => GEOSYNCHRONOUS_RADIUS_KM,
    };
    almanac.sqrt_a * almanac.sqrt_a / 1000.0 - radius_km
}

#[cfg(test)]
mod tests;
