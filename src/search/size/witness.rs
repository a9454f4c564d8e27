//! Why a design was rejected.

use serde::{Deserialize, Serialize};

/// How a design was rejected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RejectionBasis {
    /// By its shells alone: the constraint is about them, or they are not valid.
    Shells,
    /// No geometry of so many satellites keeps the constraint.
    Geometry,
    /// By a part of the samples.
    Samples,
    /// By an evaluation of all samples.
    Evaluation,
}

/// A ground point of a witness.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PointWitness {
    /// Its number, from 1, in the order of the scenario's points.
    pub number: usize,
    /// Latitude, degrees.
    pub latitude_deg: f64,
    /// East longitude, degrees.
    pub longitude_deg: f64,
}

/// The proof that a design violates a constraint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Witness {
    /// Notation of the design.
    pub design: String,
    /// The constraint as written.
    pub constraint: String,
    /// How it was rejected.
    pub basis: RejectionBasis,
    /// The point of the sample that proves it alone.
    pub point: Option<PointWitness>,
    /// The instant of that sample, seconds after the epoch.
    pub elapsed_s: Option<f64>,
    /// Weighted share of all samples that counted against the constraint by then.
    pub share_at_rejection: Option<f64>,
    /// The best that the quantity can still be; its value, if all samples were evaluated.
    pub value_at_rejection: Option<f64>,
    /// Share of the samples that were evaluated.
    pub samples_share: f64,
    /// How far the constraints are from being kept, if all samples were evaluated.
    pub violation: Option<f64>,
}

impl Witness {
    /// Orders rejected designs by how close they came: evaluated in full with a smaller violation, or rejected after
    /// more samples.
    pub(super) fn is_closer_than(&self, other: &Self) -> bool {
        match (self.violation, other.violation) {
            (Some(mine), Some(theirs)) => mine < theirs,
            (mine, theirs) if mine.is_some() != theirs.is_some() => mine.is_some(),
            _ => self.samples_share > other.samples_share,
        }
    }
}
