//! The values of a position: samples in their various forms, times, intervals, frame and interpolation.

use super::packet::{ArraySamples, PositionPacket};
use super::read::{CzmlAlgorithm, PacketFault};
use crate::earth::Surface;
use crate::ephemeris::arc::still;
use crate::formats::text::timestamp;
use crate::frames::{Frame, State};
use crate::time::Epoch;
use nalgebra::Vector3;
use std::collections::HashMap;

/// The meaning of the numbers of a position.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum PositionKind {
    Cartesian,
    CartesianVelocity,
    Degrees,
    Radians,
}

impl PositionKind {
    /// Number of values per sample, without the time.
    pub(super) fn numbers(self) -> usize {
        match self {
            Self::CartesianVelocity => 6,
            _ => 3,
        }
    }

    /// Kilometres from metres, or from longitude, latitude and height on the ellipsoid.
    fn state(self, numbers: &[f64]) -> State<Frame> {
        let vector = |from: usize| Vector3::from_row_slice(&numbers[from..from + 3]) / 1000.0;
        let geodetic = |longitude_rad: f64, latitude_rad: f64| {
            let surface = Surface::Wgs84;
            let foot_km = surface.position_km(latitude_rad, longitude_rad);
            let up = surface.vertical(latitude_rad, longitude_rad);
            still(foot_km + up * (numbers[2] / 1000.0))
        };
        match self {
            Self::Cartesian => still(vector(0)),
            Self::CartesianVelocity => State::new(vector(0), vector(3)),
            Self::Degrees => geodetic(numbers[0].to_radians(), numbers[1].to_radians()),
            Self::Radians => geodetic(numbers[0], numbers[1]),
        }
    }
}

pub(super) fn samples(
    position: &PositionPacket,
) -> Option<(&'static str, &ArraySamples, PositionKind)> {
    let given = [
        (
            "cartesianVelocity",
            &position.cartesian_velocity,
            PositionKind::CartesianVelocity,
        ),
        ("cartesian", &position.cartesian, PositionKind::Cartesian),
        (
            "cartographicDegrees",
            &position.cartographic_degrees,
            PositionKind::Degrees,
        ),
        (
            "cartographicRadians",
            &position.cartographic_radians,
            PositionKind::Radians,
        ),
    ];
    let mut given = given.into_iter();
    given.find_map(|(key, samples, kind)| Some((key, samples.as_ref()?, kind)))
}

pub(super) fn algorithm(position: &PositionPacket) -> Result<Option<CzmlAlgorithm>, PacketFault> {
    match position.interpolation_algorithm.as_deref() {
        None => Ok(None),
        Some("LINEAR") => Ok(Some(CzmlAlgorithm::Linear)),
        Some("LAGRANGE") => Ok(Some(CzmlAlgorithm::Lagrange)),
        Some("HERMITE") => Ok(Some(CzmlAlgorithm::Hermite)),
        Some(other) => {
            let message = format!("interpolation {other} is not LINEAR, LAGRANGE or HERMITE");
            Err(("czml-interpolation", "interpolationAlgorithm", message))
        }
    }
}

/// The frame of a position; cartographic positions are always Earth-fixed.
pub(super) fn frame(position: &PositionPacket, kind: PositionKind) -> Result<Frame, PacketFault> {
    match position.reference_frame.as_deref() {
        _ if matches!(kind, PositionKind::Degrees | PositionKind::Radians) => Ok(Frame::EarthFixed),
        None | Some("FIXED") => Ok(Frame::EarthFixed),
        Some("INERTIAL") => Ok(Frame::Gcrf),
        Some(other) => {
            let message = format!("frame {other:?} is neither FIXED nor INERTIAL");
            Err(("czml-frame", "referenceFrame", message))
        }
    }
}

/// Passes each sample to `take`, with times as text or in seconds since the epoch.
pub(super) fn each_node(
    key: &'static str,
    samples: &ArraySamples,
    kind: PositionKind,
    epoch: Option<&str>,
    mut take: impl FnMut(Epoch, State<Frame>) -> Result<(), PacketFault>,
) -> Result<(), PacketFault> {
    let broken = |message: String| ("czml-samples", key, message);
    let length = kind.numbers() + 1;
    if !samples.numbers.len().is_multiple_of(length) || samples.numbers.is_empty() {
        let message = format!("each sample must be a time and {} numbers", length - 1);
        return Err(broken(message));
    }
    if samples
        .texts
        .iter()
        .any(|(place, _)| !place.is_multiple_of(length))
    {
        return Err(broken(
            "a sample contains something other than numbers".to_owned(),
        ));
    }
    let texts: HashMap<usize, &String> = samples
        .texts
        .iter()
        .map(|(place, text)| (*place, text))
        .collect();
    let origin = match epoch {
        Some(text) => Some(instant(text).ok_or_else(|| {
            let message = format!("epoch {text:?} is not an ISO 8601 date and time");
            ("czml-epoch", "epoch", message)
        })?),
        None => None,
    };
    let mut last: Option<Epoch> = None;
    for (k, sample) in samples.numbers.chunks_exact(length).enumerate() {
        let at = match (texts.get(&(k * length)), origin) {
            (Some(text), _) => instant(text)
                .ok_or_else(|| broken(format!("{text:?} is not an ISO 8601 date and time")))?,
            (None, Some(origin)) => origin.plus_seconds(sample[0]),
            (None, None) => {
                let message = "samples in seconds need an epoch".to_owned();
                return Err(("czml-epoch", key, message));
            }
        };
        if last.is_some_and(|before| before > at) {
            return Err(broken(
                "the times of the samples do not increase".to_owned(),
            ));
        }
        last = Some(at);
        take(at, kind.state(&sample[1..]))?;
    }
    Ok(())
}

/// The two instants of `2025-01-01T00:00:00Z/2025-01-02T00:00:00Z`.
pub(super) fn interval(key: &'static str, text: &str) -> Result<(Epoch, Epoch), PacketFault> {
    let ends = text.split_once('/');
    let ends = ends.and_then(|(first, last)| Some((instant(first)?, instant(last)?)));
    ends.filter(|(first, last)| first <= last).ok_or_else(|| {
        let message = format!("{text:?} is not an interval of ISO 8601 dates and times");
        ("czml-interval", key, message)
    })
}

/// An instant in UTC or with an offset from it.
fn instant(text: &str) -> Option<Epoch> {
    timestamp::parse_with_offset(text).map(|at| Epoch::from_utc(at.and_utc()))
}
