//! Periods, rates and ground tracks of orbits, as text, JSON and CSV.

use super::{Align, Table};
use crate::constellation::{Design, Shell, Slot};
use crate::orbit::ground_track::{GroundTrack, sun_synchronous_inclination_deg, track_repeats};
use crate::orbit::j2::SecularRates;
use crate::run::columns::optional;
use crate::run::tables::text;
use crate::units::SECONDS_PER_DAY;
use ::csv::Writer;
use serde::Serialize;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::io;

/// Nodal days in which repeats of the ground track are sought: twice the longest cycle of remote sensing, but for
/// geodetic ones.
const MOST_DAYS: u32 = 70;

/// The orbit of the satellites of a shell under secular J2.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OrbitResult {
    /// The shell.
    pub notation: String,
    /// Semi-major axis, km.
    pub semi_major_axis_km: f64,
    /// From perigee to perigee around a point mass, minutes.
    pub kepler_period_min: f64,
    /// From one perigee to the next, minutes.
    pub anomalistic_period_min: f64,
    /// From one ascending node to the next, minutes.
    pub nodal_period_min: f64,
    /// Rate of the node, positive to the east, degrees a day.
    pub nodal_rate_deg_per_day: f64,
    /// Rate of the argument of perigee, degrees a day.
    pub arg_perigee_rate_deg_per_day: f64,
    /// A turn of the Earth as seen from the orbital plane, hours.
    pub nodal_day_h: f64,
    /// Revolutions, from node to node, in a nodal day.
    pub revolutions_per_nodal_day: f64,
    /// From one ascending node to the next on the ground, positive to the east, degrees.
    pub node_step_deg: f64,
    /// The inclination at which an orbit of this size and shape is sun-synchronous, degrees; `None` if there is none.
    pub sun_synchronous_inclination_deg: Option<f64>,
    /// When the ground track repeats, each more closely than all before.
    pub repeats: Vec<RepeatResult>,
}

/// A repeat of a ground track.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RepeatResult {
    /// Nodal days.
    pub nodal_days: u32,
    /// Revolutions.
    pub revolutions: u32,
    /// By how much the track misses itself, along the equator and positive to the east, km.
    pub miss_km: f64,
    /// Altitude at which it does not, km.
    pub exact_altitude_km: Option<f64>,
}

impl OrbitResult {
    /// The orbits of a design, one for each shell.
    #[must_use]
    pub fn of_design(design: &Design) -> Vec<Self> {
        design.shells().iter().map(Self::of_shell).collect()
    }

    fn of_shell(shell: &Shell) -> Self {
        let elements = shell.elements(Slot::FIRST);
        let rates = SecularRates::j2(&elements);
        let track = GroundTrack::of(&elements);
        let minutes = |rate_rad_s: f64| TAU / rate_rad_s / 60.0;
        let per_day = |rate_rad_s: f64| rate_rad_s.to_degrees() * SECONDS_PER_DAY;
        let repeats = track_repeats(&elements, MOST_DAYS).into_iter();
        Self {
            notation: Design::from(*shell).to_string(),
            semi_major_axis_km: elements.semi_major_axis_km,
            kepler_period_min: minutes(elements.kepler_mean_motion_rad_s()),
            anomalistic_period_min: minutes(rates.mean_anomaly_rad_s),
            nodal_period_min: track.nodal_period_s / 60.0,
            nodal_rate_deg_per_day: per_day(rates.raan_rad_s),
            arg_perigee_rate_deg_per_day: per_day(rates.arg_perigee_rad_s),
            nodal_day_h: track.nodal_day_s / 3600.0,
            revolutions_per_nodal_day: track.revolutions_per_day(),
            node_step_deg: track.node_step_deg(),
            sun_synchronous_inclination_deg: sun_synchronous_inclination_deg(&elements),
            repeats: repeats
                .map(|repeat| RepeatResult {
                    nodal_days: repeat.days,
                    revolutions: repeat.revolutions,
                    miss_km: repeat.miss_km,
                    exact_altitude_km: repeat.altitude_km,
                })
                .collect(),
        }
    }

    /// The quantities with their units, as in the header of the CSV.
    fn columns(&self) -> [(&'static str, Option<f64>); 10] {
        [
            ("semi_major_axis_km", Some(self.semi_major_axis_km)),
            ("kepler_period_min", Some(self.kepler_period_min)),
            ("anomalistic_period_min", Some(self.anomalistic_period_min)),
            ("nodal_period_min", Some(self.nodal_period_min)),
            ("nodal_rate_deg_per_day", Some(self.nodal_rate_deg_per_day)),
            (
                "arg_perigee_rate_deg_per_day",
                Some(self.arg_perigee_rate_deg_per_day),
            ),
            ("nodal_day_h", Some(self.nodal_day_h)),
            (
                "revolutions_per_nodal_day",
                Some(self.revolutions_per_nodal_day),
            ),
            ("node_step_deg", Some(self.node_step_deg)),
            (
                "sun_synchronous_inclination_deg",
                self.sun_synchronous_inclination_deg,
            ),
        ]
    }
}

/// The orbits for a terminal.
#[must_use]
pub fn orbits_text(orbits: &[OrbitResult]) -> String {
    let mut text = String::new();
    for (n, orbit) in orbits.iter().enumerate() {
        let gap = if n > 0 { "\n" } else { "" };
        let _ = writeln!(text, "{gap}{}, under secular J2", orbit.notation);
        let mut table = Table::new(&[("", Align::Left), ("", Align::Right), ("", Align::Left)]);
        let sun = orbit.sun_synchronous_inclination_deg;
        for (name, value, unit) in [
            (
                "semi-major axis",
                format!("{:.3}", orbit.semi_major_axis_km),
                "km",
            ),
            (
                "Kepler period",
                format!("{:.4}", orbit.kepler_period_min),
                "min",
            ),
            (
                "anomalistic period",
                format!("{:.4}", orbit.anomalistic_period_min),
                "min",
            ),
            (
                "nodal period",
                format!("{:.4}", orbit.nodal_period_min),
                "min",
            ),
            (
                "rate of the node",
                format!("{:+.5}", orbit.nodal_rate_deg_per_day),
                "deg/day",
            ),
            (
                "rate of the argument of perigee",
                format!("{:+.5}", orbit.arg_perigee_rate_deg_per_day),
                "deg/day",
            ),
            ("nodal day", format!("{:.5}", orbit.nodal_day_h), "h"),
            (
                "revolutions in a nodal day",
                format!("{:.6}", orbit.revolutions_per_nodal_day),
                "",
            ),
            (
                "step of the ascending node",
                format!("{:+.4}", orbit.node_step_deg),
                "deg",
            ),
            (
                "sun-synchronous inclination",
                sun.map_or_else(|| "none".to_owned(), |deg| format!("{deg:.4}")),
                if sun.is_some() { "deg" } else { "" },
            ),
        ] {
            table.row([name.to_owned(), value, unit.to_owned()]);
        }
        text += table.rows_text(&mut [0; 3]).as_str();
        let mut repeats = Table::new(&[
            ("nodal\ndays", Align::Right),
            ("revolutions", Align::Right),
            ("misses by\n(km)", Align::Right),
            ("exact at altitude\n(km)", Align::Right),
        ]);
        for repeat in &orbit.repeats {
            repeats.row([
                repeat.nodal_days.to_string(),
                repeat.revolutions.to_string(),
                format!("{:+.2}", repeat.miss_km),
                repeat
                    .exact_altitude_km
                    .map_or_else(|| "-".to_owned(), |km| format!("{km:.3}")),
            ]);
        }
        let _ = write!(text, "\nrepeats of the ground track\n{}", repeats.to_text());
    }
    text
}

/// The orbits, a row for each repeat of the ground track.
///
/// # Errors
/// Never for a table in memory.
pub fn orbits_csv(orbits: &[OrbitResult]) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    for (n, orbit) in orbits.iter().enumerate() {
        let columns = orbit.columns();
        if n == 0 {
            let names = columns.iter().map(|(name, _)| *name);
            let repeat = ["nodal_days", "revolutions", "miss_km", "exact_altitude_km"];
            writer.write_record(std::iter::once("notation").chain(names).chain(repeat))?;
        }
        for repeat in &orbit.repeats {
            let mut row = vec![orbit.notation.clone()];
            row.extend(columns.iter().map(|(_, value)| optional(*value)));
            row.push(repeat.nodal_days.to_string());
            row.push(repeat.revolutions.to_string());
            row.push(repeat.miss_km.to_string());
            row.push(optional(repeat.exact_altitude_km));
            writer.write_record(row)?;
        }
    }
    text(writer)
}
