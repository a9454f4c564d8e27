//! Bounds that a feasible design must meet, written like `max-pdop <= 2.5`.

use std::fmt;
use std::str::FromStr;

use super::Quantity;
use crate::keyword::{Keyword, UnknownKeyword, keywords};

keywords! {
    /// The side of its bound on which a constrained quantity must be.
    Relation {
        /// The quantity is at most the bound.
        AtMost = "<=",
        /// The quantity is at least the bound.
        AtLeast = ">=",
    }
}

/// A bound that a feasible design must meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constraint {
    /// What is bounded.
    pub quantity: Quantity,
    /// On which side of the bound it must be.
    pub relation: Relation,
    /// The bound, in the unit of the quantity.
    pub bound: f64,
}

/// Why a text is not a constraint.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ConstraintError {
    /// It has neither `<=` nor `>=`.
    #[error(
        "found {found:?}, expected a quantity, <= or >=, and a number, as in \"max-pdop <= 2.5\""
    )]
    NoRelation {
        /// The text as written.
        found: String,
    },
    /// The quantity is unknown.
    #[error(transparent)]
    UnknownQuantity(#[from] UnknownKeyword),
    /// The bound is not a finite number.
    #[error("found the bound {found:?}, expected a finite number")]
    Bound {
        /// The bound as written.
        found: String,
    },
    /// The bound of a fraction is none.
    #[error("found the bound {found:?}, expected a number from 0 to 1: {quantity} is a fraction")]
    NoFraction {
        /// The quantity.
        quantity: Quantity,
        /// The bound as written.
        found: String,
    },
}

impl Constraint {
    /// How far a design is from meeting the bound ([M-33](crate::models#m-33)): the excess of the
    /// value, relative to the bound (absolute for bounds below 1), plus the fraction of unsolved samples
    /// for a statistic of PDOP that they would make infinite. 1 for any other missing value.
    #[must_use]
    pub fn violation(&self, value: Option<f64>, solved_fraction: f64) -> f64 {
        let unsolved = self.quantity.unsolved_share(solved_fraction);
        let Some(value) = value else {
            return if unsolved > 0.0 { unsolved } else { 1.0 };
        };
        let excess = match self.relation {
            Relation::AtMost => value - self.bound,
            Relation::AtLeast => self.bound - value,
        };
        excess.max(0.0) / self.bound.abs().max(1.0) + unsolved
    }
}

impl FromStr for Constraint {
    type Err = ConstraintError;

    fn from_str(text: &str) -> Result<Self, ConstraintError> {
        let split = |relation: &Relation| Some((*relation, text.split_once(relation.keyword())?));
        let (relation, (quantity, bound)) =
            Relation::ALL
                .iter()
                .find_map(split)
                .ok_or_else(|| ConstraintError::NoRelation {
                    found: text.to_owned(),
                })?;
        let found = || bound.trim().to_owned();
        let quantity: Quantity = quantity.trim().parse()?;
        let number = bound.trim().parse().ok();
        let number = number.filter(|number: &f64| number.is_finite());
        let bound = number.ok_or_else(|| ConstraintError::Bound { found: found() })?;
        if quantity.is_fraction() && !(0.0..=1.0).contains(&bound) {
            let found = found();
            return Err(ConstraintError::NoFraction { quantity, found });
        }
        Ok(Self {
            quantity,
            relation,
            // Adding zero turns -0 into 0, so that equal bounds are written identically.
            bound: bound + 0.0,
        })
    }
}

impl fmt::Display for Constraint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            quantity,
            relation,
            bound,
        } = self;
        write!(f, "{quantity} {relation} {}", bound)
    }
}
