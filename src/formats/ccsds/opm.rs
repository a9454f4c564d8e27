//! CCSDS Orbit Parameter Messages in keyword = value notation, written and read.
//!
//! Source: CCSDS 502.0-B-3, sections 3 and 7. The message holds the state at the epoch; the
//! osculating elements beside it are of that state, in the same frame (table 3-3). The standard
//! has no place for mean elements but the user-defined parameters (3.2.4), whose names here carry
//! their units; they are those of secular J2 in TEME.

mod keplerian;
mod read;

pub use keplerian::Keplerian;
pub use read::{parse, read};

use crate::earth::MU_KM3_S2;
use crate::formats::ccsds::kvn::{CcsdsHeader, CcsdsVersion, write_comments};
use crate::formats::metadata::{Metadata, Object};
use crate::formats::text::timestamp::{SecondDigits, calendar};
use crate::frames::{Frame, State};
use crate::orbit::MeanElements;
use crate::time::Epoch;
use chrono::NaiveDateTime;
use std::io::{self, Write};

/// Keyword of the version.
const VERSION: &str = "CCSDS_OPM_VERS";

/// Beginning of the parameters that users define.
const USER_DEFINED: &str = "USER_DEFINED_";

/// Names of the mean elements: semi-major axis, eccentricity, inclination, node, perigee, anomaly.
const MEAN: [&str; 6] = [
    "USER_DEFINED_MEAN_SEMI_MAJOR_AXIS_KM",
    "USER_DEFINED_MEAN_ECCENTRICITY",
    "USER_DEFINED_MEAN_INCLINATION_DEG",
    "USER_DEFINED_MEAN_RA_OF_ASC_NODE_DEG",
    "USER_DEFINED_MEAN_ARG_OF_PERICENTER_DEG",
    "USER_DEFINED_MEAN_MEAN_ANOMALY_DEG",
];

/// Name and value of what the mean elements are.
const THEORY: (&str, &str) = ("USER_DEFINED_MEAN_ELEMENT_THEORY", "SECULAR-J2 TEME");

/// A message. Spacecraft parameters, covariance and manoeuvres are checked on reading, and not
/// kept.
#[derive(Debug, Clone, PartialEq)]
pub struct Opm {
    /// The header.
    pub header: CcsdsHeader,
    /// Name of the satellite.
    pub object_name: String,
    /// Identifier of the satellite.
    pub object_id: String,
    /// Origin of the frame.
    pub center_name: String,
    /// Name of the frame.
    pub ref_frame: String,
    /// Name of the time system.
    pub time_system: String,
    /// Instant of the state in the time system.
    pub epoch: NaiveDateTime,
    /// The state, km and km/s.
    pub state: State<Frame>,
    /// Osculating elements.
    pub keplerian: Option<Keplerian>,
    /// Parameters that users define: names with their prefix, and values.
    pub user_defined: Vec<(String, String)>,
}

impl Opm {
    /// The message of a satellite whose state at `epoch` is given in the frame of `metadata`, with its mean elements
    /// in TEME if it has any.
    #[must_use]
    pub fn new(
        version: CcsdsVersion,
        metadata: &Metadata,
        object: &Object,
        elements: Option<&MeanElements>,
        epoch: Epoch,
        state: State<Frame>,
    ) -> Self {
        // Elements in a rotating frame would mean nothing.
        let is_inertial = metadata.frame != Frame::EarthFixed;
        let keplerian = || Keplerian::of_state(&state, MU_KM3_S2);
        Self {
            header: CcsdsHeader::new(version, metadata),
            object_name: object.name.clone(),
            object_id: object.id.clone(),
            center_name: "EARTH".to_owned(),
            ref_frame: metadata.frame.to_string(),
            time_system: metadata.time_system.to_string(),
            epoch: metadata.time_system.stamp(epoch),
            state,
            keplerian: is_inertial.then(keplerian).flatten(),
            user_defined: elements.map_or_else(Vec::new, mean_parameters),
        }
    }

    /// Writes the message.
    ///
    /// # Errors
    /// If writing fails.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        self.header.write(out, VERSION)?;
        let (r, v) = (self.state.position_km.km(), self.state.velocity_km_s);
        let epoch = calendar(self.epoch, SecondDigits::of_stamp(self.epoch));
        for (key, value) in [
            ("OBJECT_NAME", &self.object_name),
            ("OBJECT_ID", &self.object_id),
            ("CENTER_NAME", &self.center_name),
            ("REF_FRAME", &self.ref_frame),
            ("TIME_SYSTEM", &self.time_system),
            ("EPOCH", &epoch),
        ] {
            writeln!(out, "{key} = {value}")?;
        }
        for (key, value) in [("X", r.x), ("Y", r.y), ("Z", r.z)] {
            writeln!(out, "{key} = {value:.9}")?;
        }
        for (key, value) in [("X_DOT", v.x), ("Y_DOT", v.y), ("Z_DOT", v.z)] {
            writeln!(out, "{key} = {value:.12}")?;
        }
        if let Some(keplerian) = &self.keplerian {
            write_comments(out, &["Osculating elements of the state above".to_owned()])?;
            keplerian.write(out)?;
        }
        for (key, value) in &self.user_defined {
            writeln!(out, "{key} = {value}")?;
        }
        Ok(())
    }

    /// The mean elements of secular J2 in TEME at the epoch, when the message has them all.
    #[must_use]
    pub fn mean_elements(&self) -> Option<MeanElements> {
        let text = |key: &str| {
            let mut found = self.user_defined.iter().filter(|(name, _)| name == key);
            found.next().map(|(_, value)| value.as_str())
        };
        if text(THEORY.0)? != THEORY.1 {
            return None;
        }
        let mut values = [0.0; 6];
        for (value, key) in values.iter_mut().zip(MEAN) {
            *value = text(key)?.parse().ok()?;
        }
        let [a, e, i, raan, perigee, anomaly] = values;
        let elements = MeanElements {
            semi_major_axis_km: a,
            eccentricity: e,
            inclination_rad: i.to_radians(),
            raan_rad: raan.to_radians(),
            arg_perigee_rad: perigee.to_radians(),
            mean_anomaly_rad: anomaly.to_radians(),
        };
        elements.checked().ok()
    }
}

/// What the mean elements are, and their values.
fn mean_parameters(elements: &MeanElements) -> Vec<(String, String)> {
    let angles = [
        elements.inclination_rad,
        elements.raan_rad,
        elements.arg_perigee_rad,
        elements.mean_anomaly_rad,
    ];
    let mut values = vec![
        format!("{:.9}", elements.semi_major_axis_km),
        format!("{:.15}", elements.eccentricity),
    ];
    values.extend(angles.map(|rad| format!("{:.12}", rad.to_degrees())));
    let mean = MEAN.map(str::to_owned).into_iter().zip(values);
    let theory = (THEORY.0.to_owned(), THEORY.1.to_owned());
    std::iter::once(theory).chain(mean).collect()
}

#[cfg(test)]
mod tests;
