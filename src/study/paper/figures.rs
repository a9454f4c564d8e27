//! The data of the paper's Figures 2 to 4.

use super::searches::{BASELINES, PROPOSED, SATELLITES, SINGLE};
use super::{FoundSet, Measured, PaperError, TableRow};
use crate::constellation::Design;
use crate::ephemeris::Ephemeris;
use crate::evaluate::{EpochMetrics, Evaluator};
use crate::optimize::fuzzy;
use rayon::prelude::*;

/// One design of Figure 2: its two objectives and its fuzzy memberships over the combined set.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedDesign {
    /// `table` for the rows of Table II as printed, `search` for the sets found here.
    pub set: &'static str,
    /// Kind of constellation.
    pub scheme: String,
    /// Walker notation.
    pub design: String,
    /// Equation (8).
    pub j_pos: f64,
    /// Equation (9).
    pub j_cost: f64,
    /// The worst-case membership over the objectives.
    pub membership: f64,
    /// The normalised sum of memberships.
    pub membership_sum: f64,
}

/// The time series of one design for Figures 3 and 4.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Name in the figure.
    pub name: String,
    /// Walker notation.
    pub design: String,
    /// Instant by instant.
    pub epochs: Vec<EpochMetrics>,
}

impl Curve {
    /// E_g(N_visible) of all instants in ascending order: the abscissae of its distribution
    /// function, which rises in equal steps.
    #[must_use]
    pub fn sorted_visible(&self) -> Vec<f64> {
        let mut visible: Vec<f64> = self.epochs.iter().map(|epoch| epoch.mean_visible).collect();
        visible.sort_by(f64::total_cmp);
        visible
    }
}

/// The data of Figures 2 to 4.
#[derive(Debug, Clone, PartialEq)]
pub struct Figures {
    /// Figure 2.
    pub places: Vec<PlacedDesign>,
    /// Figure 3: the rows with 182 satellites, as printed.
    pub constellations: Vec<Curve>,
    /// Figure 4: the picks of the three strategies.
    pub strategies: Vec<Curve>,
}

pub(super) fn figures(
    evaluator: &Evaluator,
    rows: &[TableRow],
    printed: &Measured,
    searches: &[FoundSet],
) -> Result<Figures, PaperError> {
    let designs: Vec<Design> = rows.iter().map(|row| row.design.clone()).collect();
    let strategies = [PROPOSED, SINGLE, SATELLITES];
    let picks = strategies.iter().filter_map(|&name| {
        let set = searches.iter().find(|set| set.name == name)?;
        Some((name.to_owned(), set.pick()?.design.clone()))
    });
    let mut places = table_places(rows, printed)?;
    places.extend(search_places(searches)?);
    Ok(Figures {
        places,
        constellations: compared(evaluator, rows, &designs)?,
        strategies: curves(evaluator, picks.collect())?,
    })
}

/// The curves of the rows with the 182 satellites of the paper's own pick: number 2 of each kind,
/// propagated as `designs`.
pub(super) fn compared(
    evaluator: &Evaluator,
    rows: &[TableRow],
    designs: &[Design],
) -> Result<Vec<Curve>, PaperError> {
    let second = rows.iter().zip(designs).filter(|(row, _)| row.number == 2);
    let named = second.map(|(row, design)| (row.scheme.to_string(), design.clone()));
    curves(evaluator, named.collect())
}

fn curves(evaluator: &Evaluator, named: Vec<(String, Design)>) -> Result<Vec<Curve>, PaperError> {
    let setup = evaluator.setup();
    let curve = |(name, design): (String, Design)| {
        let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid)?;
        Ok(Curve {
            name,
            design: design.to_string(),
            epochs: evaluator.series(&ephemeris)?.epochs,
        })
    };
    named.into_par_iter().map(curve).collect()
}

fn table_places(rows: &[TableRow], printed: &Measured) -> Result<Vec<PlacedDesign>, PaperError> {
    let both = rows.iter().zip(&printed.values).filter_map(|(row, value)| {
        let names = (row.scheme.to_string(), row.design.to_string());
        Some((names, [value.j_pos?, value.j_cost?]))
    });
    placed("table", both.collect())
}

fn search_places(searches: &[FoundSet]) -> Result<Vec<PlacedDesign>, PaperError> {
    let shown = |set: &&FoundSet| set.name == PROPOSED || BASELINES.contains(&set.name);
    let both = searches.iter().filter(shown).flat_map(|set| {
        set.members.iter().filter_map(|member| {
            let names = (set.name.to_owned(), member.design.to_string());
            Some((names, [member.metrics.j_pos?, member.metrics.j_cost?]))
        })
    });
    placed("search", both.collect())
}

type NamedPoint = ((String, String), [f64; 2]);

fn placed(set: &'static str, designs: Vec<NamedPoint>) -> Result<Vec<PlacedDesign>, PaperError> {
    if designs.is_empty() {
        return Ok(Vec::new());
    }
    let points: Vec<[f64; 2]> = designs.iter().map(|(_, point)| *point).collect();
    let memberships = fuzzy(&points)?;
    let values = memberships.minimum.iter().zip(&memberships.share);
    let place = |((names, [j_pos, j_cost]), (&membership, &membership_sum)): (NamedPoint, _)| {
        PlacedDesign {
            set,
            scheme: names.0,
            design: names.1,
            j_pos,
            j_cost,
            membership,
            membership_sum,
        }
    };
    Ok(designs.into_iter().zip(values).map(place).collect())
}
