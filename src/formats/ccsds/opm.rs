//! CCSDS Orbit Parameter Messages in keyword = value notation and in XML, written and read.
//!
//! Source: CCSDS 502.0-B-3, sections 3 and 7. The message holds the state at the epoch; the
//! osculating elements beside it are of that state, in the same frame (table 3-3). The standard
//! has no place for mean elements but the user-defined parameters (3.2.4), whose names here carry
//! their units; they are those of secular J2 in TEME.

mod keplerian;
mod read;
mod xml;

pub use keplerian::Keplerian;
pub use read::{parse, read};
pub(super) use xml::OpmXmlMessage;
pub use xml::read_xml;

use crate::earth::MU_KM3_S2;
use crate::formats::ccsds::kvn::{CcsdsHeader, CcsdsVersion, write_comments};
use crate::formats::metadata::{Metadata, Object};
use crate::formats::text::timestamp::{SecondDigits, calendar};
use crate::frames::{Frame, State};
use crate::keyword::keywords;
use crate::orbit::MeanElements;
use crate::time::Epoch;
use chrono::NaiveDateTime;
use std::io::{self, Write};

keywords! {
    /// How a message is written down.
    OpmSyntax {
        /// Keyword = value lines.
        Kvn = "kvn",
        /// XML.
        Xml = "xml",
    }
}

/// Keyword of the version.
const VERSION: &str = "CCSDS_OPM_VERS";

/// Beginning of the parameters that users define.
const USER_DEFINED: &str = "USER_DEFINED_";

/// The remark before osculating elements.
const KEPLERIAN_COMMENT: &str = "Osculating elements of the state above";

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

impl OpmSyntax {
    /// The usual extension of its files.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Kvn => "opm",
            Self::Xml => "xml",
        }
    }
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

    /// Writes the message as a file.
    ///
    /// # Errors
    /// If writing fails.
    pub fn write_as(&self, syntax: OpmSyntax, out: &mut impl Write) -> io::Result<()> {
        match syntax {
            OpmSyntax::Kvn => self.write(out),
            OpmSyntax::Xml => self.write_xml(out),
        }
    }

    /// Writes the message in keyword = value notation.
    ///
    /// # Errors
    /// If writing fails.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        self.header.write(out, VERSION)?;
        for (key, value) in self.metadata().into_iter().chain(self.state_vector()) {
            writeln!(out, "{key} = {value}")?;
        }
        if let Some(keplerian) = &self.keplerian {
            write_comments(out, &[KEPLERIAN_COMMENT.to_owned()])?;
            for (key, value) in keplerian.pairs() {
                writeln!(out, "{key} = {value}")?;
            }
        }
        for (key, value) in &self.user_defined {
            writeln!(out, "{key} = {value}")?;
        }
        Ok(())
    }

    /// The keywords of table 3-2 and their values.
    fn metadata(&self) -> [(&'static str, String); 5] {
        [
            ("OBJECT_NAME", self.object_name.clone()),
            ("OBJECT_ID", self.object_id.clone()),
            ("CENTER_NAME", self.center_name.clone()),
            ("REF_FRAME", self.ref_frame.clone()),
            ("TIME_SYSTEM", self.time_system.clone()),
        ]
    }

    /// The epoch and the state (table 3-3).
    fn state_vector(&self) -> [(&'static str, String); 7] {
        let (r, v) = (self.state.position_km.km(), self.state.velocity_km_s);
        let epoch = calendar(self.epoch, SecondDigits::of_stamp(self.epoch));
        [
            ("EPOCH", epoch),
            ("X", format!("{:.9}", r.x)),
            ("Y", format!("{:.9}", r.y)),
            ("Z", format!("{:.9}", r.z)),
            ("X_DOT", format!("{:.12}", v.x)),
            ("Y_DOT", format!("{:.12}", v.y)),
            ("Z_DOT", format!("{:.12}", v.z)),
        ]
    }

    /// Whether the Earth is its centre.
    #[must_use]
    pub fn is_about_earth(&self) -> bool {
        self.center_name.eq_ignore_ascii_case("EARTH")
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
