//! A constellation against an ephemeris that another program made.
//!
//! Objects of the files are matched to the slots of the design, by name or else by position. Their
//! states are compared with ours at their own instants, so nothing is interpolated. Where they
//! differ, conventions that other tools are known to use are tried one by one to see whether one
//! explains the difference. Objects that do not match fail a check; they are never dropped silently.

mod conventions;
mod matching;
mod read;
mod reference;
mod tracks;

pub use conventions::Explanation;
pub use read::{Comparand, FileError, comparands, read};
pub use reference::ReferenceConstellation;

use super::decisions::TrajectoryPair;
use super::distribution::{Distribution, Residual};
use super::residuals::Ric;
use super::{Check, CheckedQuantity, Findings, ValidateError};
use crate::ephemeris::Ephemeris;
use crate::frames::ric_basis;
use crate::orbit::Propagator;
use crate::stats::line_fit;
use crate::units::SECONDS_PER_DAY;
use matching::Matching;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use tracks::{Track, tracks};

/// Distance within which a file agrees with the design, km: a decimetre, more than the digits of
/// any state format lose.
const SAME_KM: f64 = 1e-4;

/// Difference of a satellite of the file from its slot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SatelliteDifference {
    /// The slot.
    pub slot: String,
    /// The object of the file.
    pub object: String,
    /// Samples that were compared.
    pub samples: usize,
    /// Mean difference, km.
    pub offset_km: Ric,
    /// Slope of the difference, km/day.
    pub drift_km_per_day: Ric,
    /// Root mean square of the difference, km.
    pub rms_km: Ric,
    /// Largest distance, km.
    pub max_km: f64,
}

/// A comparison with the ephemeris of another program.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FileComparison {
    /// What was read.
    pub source: String,
    /// How objects were matched to slots: `name` or `place`.
    pub matched_by: String,
    /// Slots without an object.
    pub unmatched_slots: Vec<String>,
    /// Objects without a slot.
    pub unmatched_objects: Vec<String>,
    /// Whether every slot and object matched and all states agree with the design to a decimetre.
    pub agrees: bool,
    /// The satellites, in the order of the slots.
    pub satellites: Vec<SatelliteDifference>,
    /// The convention that explains the difference, if any, and what remains.
    pub explanation: Option<Explanation>,
}

impl FileComparison {
    /// Whether the matched objects agree with the design to a decimetre, whatever is missing.
    #[must_use]
    pub fn matched_agree(&self) -> bool {
        !self.satellites.is_empty() && self.satellites.iter().all(|one| one.max_km <= SAME_KM)
    }
}

/// Compares a constellation with what was read from files; `source` names them.
///
/// # Errors
/// If nothing in the files can be compared: no object has a state, or none within the time span of
/// the study.
pub fn against_file(
    reference: &ReferenceConstellation<'_>,
    source: &str,
    comparands: &[Comparand],
) -> Result<Findings, ValidateError> {
    let tracks = tracks(reference, comparands)?;
    let ours = &reference.ephemeris;
    let matching = Matching::of(&reference.reach_km, ours, &tracks);
    let pairs = matching.pairs(&tracks);
    let satellites = pairs
        .iter()
        .map(|&(slot, track)| difference(ours, slot, track))
        .collect::<Result<Vec<_>, _>>()?;
    if let Some(without) = satellites.iter().find(|one| one.samples == 0) {
        return Err(FileError::NoCommonInstant {
            source_name: source.to_owned(),
            object: without.object.clone(),
        }
        .into());
    }
    let worst = satellites.iter().map(|one| one.max_km).fold(0.0, f64::max);
    let agrees = matching.is_complete() && worst <= SAME_KM;
    let explanation = if agrees {
        None
    } else {
        conventions::explanation(reference, &tracks)?
    };
    if pairs.is_empty() && explanation.is_none() {
        return Err(FileError::NothingMatches {
            source_name: source.to_owned(),
            objects: tracks.len(),
            slots: ours.satellites().len(),
        }
        .into());
    }
    let mut findings = Findings::default();
    findings
        .checks
        .extend(coverage_checks(reference, source, &matching, &tracks));
    let misplaced = matching.misplaced(reference, &tracks)?;
    findings.checks.push(misplaced_check(source, misplaced));
    findings.checks.extend(size_checks(source, &satellites));
    findings
        .distributions
        .extend(distances(ours, source, &pairs)?);
    let covers = tracks.iter().all(|track| track.covers(reference));
    if matching.is_complete() && covers {
        match &reference.first_gap {
            None => findings.append(metrics(reference, source, &pairs)?),
            Some((name, at)) => findings.notes.push(format!(
                "file/{source}: metrics are not compared: {name} of the constellation has no state at {at}"
            )),
        }
    }
    findings.files.push(FileComparison {
        source: source.to_owned(),
        matched_by: matching.how().to_owned(),
        unmatched_slots: matching.unmatched_slots(ours),
        unmatched_objects: matching.unmatched_objects(&tracks),
        agrees,
        satellites,
        explanation,
    });
    Ok(findings)
}

/// Differences of a track from its slot at the instants of the track.
fn differences(
    ours: &Ephemeris,
    slot: usize,
    track: &Track,
) -> Result<Vec<(f64, Vector3<f64>)>, ValidateError> {
    let satellite = &ours.satellites()[slot];
    let mut found = Vec::with_capacity(track.states.len());
    for (elapsed_s, theirs) in &track.states {
        // Satellites from files have states at the samples of the study only, and none in a gap.
        let Some(state) = ours.state_or_gap(satellite, *elapsed_s)? else {
            continue;
        };
        if let Some(basis) = ric_basis(&state) {
            found.push((*elapsed_s, basis * (theirs.position_km - state.position_km)));
        }
    }
    Ok(found)
}

fn difference(
    ours: &Ephemeris,
    slot: usize,
    track: &Track,
) -> Result<SatelliteDifference, ValidateError> {
    let found = differences(ours, slot, track)?;
    let days: Vec<f64> = found.iter().map(|(t, _)| t / SECONDS_PER_DAY).collect();
    let n = found.len().max(1) as f64;
    let mean = found.iter().fold(Vector3::zeros(), |sum, (_, d)| sum + d) / n;
    let squares = found
        .iter()
        .fold(Vector3::zeros(), |sum, (_, d)| sum + d.component_mul(d));
    let slope = |axis: usize| {
        let values: Vec<f64> = found.iter().map(|(_, d)| d[axis]).collect();
        line_fit(&days, &values).map_or(0.0, |(_, slope)| slope)
    };
    Ok(SatelliteDifference {
        slot: ours.satellites()[slot].name.clone(),
        object: track.name.clone(),
        samples: found.len(),
        offset_km: Ric::from_vector(mean),
        drift_km_per_day: Ric::from_vector(Vector3::new(slope(0), slope(1), slope(2))),
        rms_km: Ric::from_vector((squares / n).map(f64::sqrt)),
        max_km: found.iter().map(|(_, d)| d.norm()).fold(0.0, f64::max),
    })
}

fn coverage_checks(
    reference: &ReferenceConstellation<'_>,
    source: &str,
    matching: &Matching,
    tracks: &[Track],
) -> Vec<Check> {
    let slots = reference.ephemeris.satellites().len() as f64;
    let matched = matching.count() as f64;
    let count = |name: &str, quantity: &str, value: f64, reason: &str| {
        Check::new(
            &format!("file/{source}/{name}"),
            CheckedQuantity {
                quantity,
                unit: "1",
                statistic: "count",
            },
            value,
            Some(0.0),
            reason,
        )
    };
    let shortest = tracks
        .iter()
        .map(|track| track.covered_share(reference))
        .fold(1.0, f64::min);
    vec![
        count(
            "unmatched-slots",
            "slots of the design without an object",
            slots - matched,
            "every satellite of the design must be in the file",
        ),
        count(
            "unmatched-objects",
            "objects of the file without a slot",
            tracks.len() as f64 - matched,
            "every object of the file must be a satellite of the design",
        ),
        Check::new(
            &format!("file/{source}/uncovered-span"),
            CheckedQuantity {
                quantity: "largest fraction of the study's time span that an object does not cover",
                unit: "1",
                statistic: "max",
            },
            1.0 - shortest,
            Some(1e-9),
            "states must cover the study from first to last sample with no gap longer than a tenth of a revolution; otherwise metrics are not compared",
        ),
    ]
}

fn misplaced_check(source: &str, misplaced: usize) -> Check {
    Check::new(
        &format!("file/{source}/misplaced-objects"),
        CheckedQuantity {
            quantity: "objects far from the slot they are named after",
            unit: "1",
            statistic: "count",
        },
        misplaced as f64,
        Some(0.0),
        "at its first sample an object must be nearer to its own slot than to the next; otherwise pattern, frame or time differ",
    )
}

fn size_checks(source: &str, satellites: &[SatelliteDifference]) -> Vec<Check> {
    if satellites.is_empty() {
        return Vec::new();
    }
    let n = satellites.len() as f64;
    let square = |value: fn(&Ric) -> f64| {
        let sum: f64 = satellites
            .iter()
            .map(|one| value(&one.rms_km).powi(2))
            .sum();
        (sum / n).sqrt()
    };
    let drift: f64 = satellites
        .iter()
        .map(|one| one.drift_km_per_day.in_track)
        .sum::<f64>()
        / n;
    let reason = "reported only: the file may use another model or convention; the explanation names the one that accounts for the difference";
    let rows: [(&str, &str, &str, f64); 4] = [
        ("radial-rms", "km", "rms", square(|ric| ric.radial)),
        ("in-track-rms", "km", "rms", square(|ric| ric.in_track)),
        (
            "cross-track-rms",
            "km",
            "rms",
            square(|ric| ric.cross_track),
        ),
        ("in-track-drift", "km/day", "mean slope", drift),
    ];
    rows.into_iter()
        .map(|(name, unit, statistic, value)| {
            Check::new(
                &format!("file/{source}/{name}"),
                CheckedQuantity {
                    quantity: &format!("{name}, file minus design"),
                    unit,
                    statistic,
                },
                value,
                None,
                reason,
            )
        })
        .collect()
}

fn distances(
    ours: &Ephemeris,
    source: &str,
    pairs: &[(usize, &Track)],
) -> Result<Option<Distribution>, ValidateError> {
    let mut residuals = Vec::new();
    for &(slot, track) in pairs {
        for (elapsed_s, apart) in differences(ours, slot, track)? {
            residuals.push(Residual {
                value: apart.norm(),
                input: (slot, elapsed_s),
            });
        }
    }
    let name = format!("file/{source}");
    let describe =
        |&(slot, at): &(usize, f64)| format!("{} at {at} s", ours.satellites()[slot].name);
    Ok(Distribution::of(
        &name,
        ["distance", "km"],
        &residuals,
        describe,
    ))
}

/// Decisions, passes and metrics when the file replaces the design.
fn metrics(
    reference: &ReferenceConstellation<'_>,
    source: &str,
    pairs: &[(usize, &Track)],
) -> Result<Findings, ValidateError> {
    let ours = &reference.ephemeris;
    let theirs = pairs
        .iter()
        .map(|&(slot, track)| crate::ephemeris::EphemerisSatellite {
            name: ours.satellites()[slot].name.clone(),
            slot: ours.satellites()[slot].slot,
            propagator: Box::new(track.clone()) as Box<dyn Propagator>,
        });
    let parts = pairs.iter().map(|&(slot, _)| ours.parts()[slot]);
    let theirs = Ephemeris::new(reference.grid(), theirs.collect()).with_parts(parts.collect());
    let seen = TrajectoryPair {
        evaluator: reference.evaluator,
        first: ours,
        second: &theirs,
    };
    Ok(seen.compare(&format!("file/{source}"), None)?)
}

#[cfg(test)]
mod tests;
