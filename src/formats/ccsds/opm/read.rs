//! Reads messages strictly, line by line.

use super::{Keplerian, MEAN, Opm, USER_DEFINED, VERSION};
use crate::earth::{J2, RADIUS_KM};
use crate::formats::ReadError;
use crate::formats::ccsds::frame::supported_frame;
use crate::formats::ccsds::keywords::{COVARIANCE, KvnKeyword, SPACECRAFT, may, must, named};
use crate::formats::ccsds::kvn::{CcsdsHeader, Item, KvnBlock, Pair, item, lines};
use crate::formats::text::finding::FindingList;
use crate::formats::text::lines::keep_comment;
use crate::formats::trajectory::{frame_of_name, time_system_of_name};
use crate::frames::{Frame, State, from_teme};
use crate::orbit::Model;
use crate::orbit::earth_orbit::check_state;
use crate::orbit::kepler::eccentric_anomaly;
use crate::units::wrap_360;
use nalgebra::Vector3;
use std::io::{self, BufRead};

/// Tables 3-1 to 3-3 in their order, without manoeuvres and what users define.
pub(super) const MESSAGE: &[KvnKeyword] = &[
    must(VERSION),
    may("CLASSIFICATION"),
    must("CREATION_DATE"),
    must("ORIGINATOR"),
    may("MESSAGE_ID"),
    named("OBJECT_NAME"),
    named("OBJECT_ID"),
    must("CENTER_NAME"),
    must("REF_FRAME"),
    may("REF_FRAME_EPOCH"),
    must("TIME_SYSTEM"),
    must("EPOCH"),
    must("X").unit("km"),
    must("Y").unit("km"),
    must("Z").unit("km"),
    must("X_DOT").unit("km/s"),
    must("Y_DOT").unit("km/s"),
    must("Z_DOT").unit("km/s"),
    may("SEMI_MAJOR_AXIS").unit("km"),
    may("ECCENTRICITY").number(),
    may("INCLINATION").unit("deg"),
    may("RA_OF_ASC_NODE").unit("deg"),
    may("ARG_OF_PERICENTER").unit("deg"),
    may("TRUE_ANOMALY").unit("deg"),
    may("MEAN_ANOMALY").unit("deg"),
    may("GM").unit("km**3/s**2"),
];

/// A manoeuvre of table 3-3; there may be several.
pub(super) const MANOEUVRE: &[KvnKeyword] = &[
    must("MAN_EPOCH_IGNITION"),
    must("MAN_DURATION").unit("s"),
    must("MAN_DELTA_MASS").unit("kg"),
    must("MAN_REF_FRAME"),
    must("MAN_DV_1").unit("km/s"),
    must("MAN_DV_2").unit("km/s"),
    must("MAN_DV_3").unit("km/s"),
];

/// Maximum number of user-defined parameters.
const MOST_USER_DEFINED: usize = 1000;

/// Reads a message; the first broken rule ends it.
///
/// # Errors
/// The first finding, or a failure of the input.
pub fn read(input: impl BufRead) -> Result<Opm, ReadError> {
    let mut findings = FindingList::of_reader();
    let message = parse(input, &mut findings)?;
    let read = findings.unless_error(message)?;
    // Without a finding there is a message.
    read.ok_or_else(|| io::Error::from(io::ErrorKind::UnexpectedEof).into())
}

/// The message of a file, if it is valid; violations go to the list of findings.
///
/// # Errors
/// A failure of the input.
pub fn parse(input: impl BufRead, findings: &mut FindingList) -> io::Result<Option<Opm>> {
    let mut lines = lines(input);
    let mut block = KvnBlock::new(&[MESSAGE, SPACECRAFT, COVARIANCE]);
    let mut manoeuvre: Option<KvnBlock> = None;
    let mut user_defined = Vec::new();
    let mut in_header = true;
    while let Some(line) = lines.next(findings)? {
        match item(&line, findings) {
            Item::Blank => {}
            Item::Comment(text) if in_header => keep_comment(&mut block.comments, text),
            Item::Comment(_) => {}
            Item::Pair(pair) if pair.key.starts_with(USER_DEFINED) => {
                let named = (pair.key, pair.value);
                take_user_defined(named, pair.key_place, &mut user_defined, findings);
            }
            Item::Pair(pair) if pair.key.starts_with("MAN_") => {
                take_manoeuvre(&pair, &mut manoeuvre, findings);
            }
            Item::Pair(pair) => {
                in_header &= matches!(pair.key, VERSION | "CLASSIFICATION");
                block.accept(&pair, findings);
            }
            Item::Other(_) => {
                findings.error((line.number, 1), "opm-line", "not a keyword = value pair");
            }
        }
    }
    let end = (lines.number().max(1), 1);
    if let Some(manoeuvre) = manoeuvre {
        end_manoeuvre(manoeuvre, end, findings);
    }
    let message = message(&block, user_defined, end, findings);
    if let Some((at, reason)) = message.as_ref().and_then(|one| unsupported(one, &block)) {
        findings.unsupported(at, reason);
    }
    Ok(message)
}

/// Keeps a parameter that a user defines, given its name with the prefix, and its value.
pub(super) fn take_user_defined(
    (key, value): (&str, &str),
    place: (usize, usize),
    kept: &mut Vec<(String, String)>,
    findings: &mut FindingList,
) {
    if kept.len() == MOST_USER_DEFINED {
        let message = format!("more than {MOST_USER_DEFINED} user-defined parameters");
        findings.error(place, "opm-user-defined", message);
        return;
    }
    if kept.iter().any(|(known, _)| known == key) {
        findings.error(place, "ccsds-repeated", format!("{key} appears twice"));
        return;
    }
    kept.push((key.to_owned(), value.to_owned()));
}

/// The first keyword of a manoeuvre ends the one before it.
fn take_manoeuvre(pair: &Pair<'_>, current: &mut Option<KvnBlock>, findings: &mut FindingList) {
    if pair.key == "MAN_EPOCH_IGNITION"
        && let Some(before) = current.take()
    {
        end_manoeuvre(before, pair.key_place, findings);
    }
    current
        .get_or_insert_with(|| KvnBlock::new(&[MANOEUVRE]))
        .accept(pair, findings);
}

/// Checks a manoeuvre, which is left out: the satellite is propagated without it.
pub(super) fn end_manoeuvre(block: KvnBlock, end: (usize, usize), findings: &mut FindingList) {
    let ignition = block.text("MAN_EPOCH_IGNITION").unwrap_or_default();
    findings.pass_over("manoeuvre", &ignition);
    block.finish(end, findings);
}

/// The message of its keywords.
pub(super) fn message(
    block: &KvnBlock,
    user_defined: Vec<(String, String)>,
    end: (usize, usize),
    findings: &mut FindingList,
) -> Option<Opm> {
    block.finish(end, findings);
    let header = CcsdsHeader::read(block, VERSION, findings);
    let epoch = block.stamp("EPOCH", findings);
    let vector = |keys: [&str; 3]| {
        let [x, y, z] = keys.map(|key| block.number(key));
        Some(Vector3::new(x?, y?, z?))
    };
    let position = vector(["X", "Y", "Z"]);
    let velocity = vector(["X_DOT", "Y_DOT", "Z_DOT"]);
    let keplerian = keplerian(block, findings);
    let message = Opm {
        header: header?,
        object_name: block.text_or_unknown("OBJECT_NAME"),
        object_id: block.text_or_unknown("OBJECT_ID"),
        center_name: block.text("CENTER_NAME")?,
        ref_frame: block.text("REF_FRAME")?,
        time_system: block.text("TIME_SYSTEM")?,
        epoch: epoch?,
        state: State::new(position?, velocity?),
        keplerian,
        user_defined,
    };
    // Without mean elements the message is not read anyway.
    if message.is_about_earth() && message.mean_elements().is_some() {
        supported_frame(block, "opm-frame", findings);
    }
    check_orbit(&message, block.place("X"), findings);
    check_elements(&message, block.place("X"), findings);
    Some(message)
}

/// Refuses mean elements of another orbit than the state beside them.
fn check_elements(message: &Opm, place: (usize, usize), findings: &mut FindingList) {
    if let Some(apart) = elements_apart(message)
        && apart.distance_km > apart.limit_km
    {
        let text = format!(
            "the state is {:.0} km off that of the mean elements USER_DEFINED_MEAN_..., and periodic terms explain at most {:.0} km",
            apart.distance_km, apart.limit_km
        );
        findings.error(place, "opm-mean-elements", text);
    }
}

/// How far the state and the mean elements of a message are apart.
pub(super) struct ElementsApart {
    pub(super) distance_km: f64,
    /// What mean and osculating orbits of the theories here may differ by.
    pub(super) limit_km: f64,
}

/// The distance between the state and that of the mean elements, or between their velocities in half a radian of the
/// orbit if that is larger; `None` if one of them is missing or its frame or time
/// system is unknown.
///
/// Mean and osculating positions differ by the periodic terms: those of J2 have amplitudes of at most 3/4 J2 R²/p on
/// each axis beside a shift of the radius of at most 3/2 J2 R²/p ([M-40](crate::models#m-40) and
/// [M-41](crate::models#m-41)), J3 adds 2 |J3/(2 J2)| R = 15 km in-track ([M-42](crate::models#m-42)), and both grow with the eccentricity
/// by at most 1 + 8 e ([M-45](crate::models#m-45)). The limit is the sum, doubled for elements of other constants.
pub(super) fn elements_apart(message: &Opm) -> Option<ElementsApart> {
    let elements = message
        .mean_elements()
        .filter(|_| message.is_about_earth())?;
    let frame = frame_of_name(&message.ref_frame).ok()?;
    let epoch = time_system_of_name(&message.time_system)
        .ok()?
        .epoch(message.epoch);
    let propagator = Model::J2.propagator(&elements, epoch).ok()?;
    let of_elements: State<Frame> = from_teme(propagator.state_at(0.0).ok()?, frame, epoch, 0.0);
    let apart_km = (message.state.position_km - of_elements.position_km).norm();
    let per_s = (message.state.velocity_km_s - of_elements.velocity_km_s).norm();
    // The terms of J2 have two periods per revolution.
    let by_velocity_km = per_s / (2.0 * elements.kepler_mean_motion_rad_s());
    let e = elements.eccentricity;
    let j2_km = J2 * RADIUS_KM * RADIUS_KM / (elements.semi_major_axis_km * (1.0 - e * e));
    let periodic_km = (1.5 + 3.0 * 0.75) * j2_km + FROZEN_KM;
    Some(ElementsApart {
        distance_km: apart_km.max(by_velocity_km),
        limit_km: 2.0 * (1.0 + 8.0 * e) * periodic_km,
    })
}

/// In-track amplitude of the eccentricity that J3 forces, km.
const FROZEN_KM: f64 = 15.0;

/// Refuses a state that is no Earth orbit, in a frame that is known.
fn check_orbit(message: &Opm, place: (usize, usize), findings: &mut FindingList) {
    let frame = frame_of_name(&message.ref_frame);
    if let (true, Ok(frame)) = (message.is_about_earth(), frame)
        && let Err(fault) = check_state(frame, &message.state)
    {
        let text = format!("{} at {}: {fault}", message.object_name, message.epoch);
        findings.error(place, "implausible-state", text);
    }
}

/// Why a valid message cannot be propagated, and the place of the keyword that is the reason.
pub(super) fn unsupported(message: &Opm, block: &KvnBlock) -> Option<((usize, usize), String)> {
    if !message.is_about_earth() {
        let center = &message.center_name;
        let reason =
            format!("CENTER_NAME: {center} is valid, but only orbits about the Earth are read");
        return Some((block.place("CENTER_NAME"), reason));
    }
    if let Err(unknown) = time_system_of_name(&message.time_system) {
        let reason = format!("TIME_SYSTEM: {unknown}");
        return Some((block.place("TIME_SYSTEM"), reason));
    }
    message.mean_elements().is_none().then(|| {
        let is_mean = |(key, _): &(String, String)| MEAN.contains(&key.as_str());
        let reason = match message.user_defined.iter().any(is_mean) {
            true => "EPOCH: the mean elements USER_DEFINED_MEAN_... are not all there, numbers and in range, and a \
                     state at one instant cannot be propagated",
            false => "EPOCH: a state at one instant is valid, but only messages with mean elements, such as \
                      USER_DEFINED_MEAN_SEMI_MAJOR_AXIS_KM, can be propagated",
        };
        (block.place("EPOCH"), reason.to_owned())
    })
}

/// Elements are given all or not at all, with one of the anomalies (3.2.4.4).
fn keplerian(block: &KvnBlock, findings: &mut FindingList) -> Option<Keplerian> {
    let given = |key: &&str| block.text(key).is_some();
    let keys = [
        "SEMI_MAJOR_AXIS",
        "ECCENTRICITY",
        "INCLINATION",
        "RA_OF_ASC_NODE",
        "ARG_OF_PERICENTER",
        "GM",
    ];
    let anomalies = ["TRUE_ANOMALY", "MEAN_ANOMALY"];
    let first = keys.iter().chain(&anomalies).find(|key| given(key))?;
    let missing = keys.iter().find(|key| !given(key));
    if missing.is_some() || anomalies.iter().filter(|key| given(key)).count() != 1 {
        let message = "osculating elements need all six, with one of the two anomalies, and GM";
        findings.error(block.place(first), "opm-elements", message);
        return None;
    }
    let [a, e, i, raan, perigee, gm] = keys.map(|key| block.number(key));
    let [true_anomaly, mean_anomaly] = anomalies.map(|key| block.number(key));
    let eccentricity = e?;
    if !(0.0..1.0).contains(&eccentricity) {
        // Open orbits have elements too, but nothing here uses them.
        return None;
    }
    let of_mean = |mean_deg: f64| {
        let half = 0.5 * eccentric_anomaly(mean_deg.to_radians(), eccentricity);
        let stretch = ((1.0 + eccentricity) / (1.0 - eccentricity)).sqrt();
        wrap_360((2.0 * (stretch * half.sin()).atan2(half.cos())).to_degrees())
    };
    Some(Keplerian {
        semi_major_axis_km: a?,
        eccentricity,
        inclination_deg: i?,
        raan_deg: raan?,
        arg_perigee_deg: perigee?,
        true_anomaly_deg: true_anomaly.or(mean_anomaly.map(of_mean))?,
        gm_km3_s2: gm?,
    })
}
