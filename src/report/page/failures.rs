//! What failures of satellites do, as a section of the page.

use crate::report::figures::draw::{DrawError, Sheet, svg};
use crate::report::figures::{NamedLosses, Plate, failures};
use crate::report::shown;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use thiserror::Error;

/// Most rows of the table.
const MOST_ROWS: usize = 20;

/// Why there is no section.
#[derive(Debug, Error)]
pub enum FailureSectionError {
    /// A figure has nothing to show.
    #[error(transparent)]
    Figure(#[from] crate::report::figures::FigureError),
    /// A figure cannot be drawn.
    #[error(transparent)]
    Draw(#[from] DrawError),
}

/// What failures of satellites do.
#[derive(Debug, Clone, PartialEq)]
pub struct FailureSection {
    /// The constellation of the table and the map.
    pub(super) name: String,
    /// What fails: `one satellite`, `2 satellites, 200 draws`.
    pub(super) cases: String,
    /// The distribution and the map as images in base64.
    pub(super) distribution: String,
    pub(super) map: Option<String>,
    /// What fails on the map.
    pub(super) map_without: String,
    pub(super) rows: Vec<LossRow>,
    pub(super) left_out: usize,
}

/// A row of the table: the metrics without some satellites.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LossRow {
    pub(super) without: String,
    pub(super) cells: [String; 5],
}

impl FailureSection {
    /// The losses of some constellations, the first with a table, and with a map if there is one: of its worst losses of one
    /// satellite, each point by itself, or of its worst case of several.
    ///
    /// # Errors
    /// If a figure cannot be drawn.
    pub fn new(losses: &[NamedLosses], map: Option<&Plate>) -> Result<Self, FailureSectionError> {
        let distribution = image(&failures(losses)?)?;
        let map = map.map(image).transpose()?;
        let first = losses.first();
        let lost = first.map_or(&[][..], |one| &one.lost);
        let places = first.map_or_else(Vec::new, NamedLosses::worst_first);
        let worst: Vec<_> = places.iter().map(|place| &lost[*place]).collect();
        let row = |(without, metrics): &&(String, crate::evaluate::Metrics)| {
            let of_all = |pdop: Option<f64>| pdop.filter(|_| metrics.solved_fraction >= 1.0);
            LossRow {
                without: without.clone(),
                cells: [
                    shown::pdop(of_all(metrics.mean_pdop)),
                    shown::pdop(of_all(metrics.cvar_pdop)),
                    shown::pdop(of_all(metrics.max_pdop)),
                    shown::share(Some(metrics.solved_fraction)),
                    shown::share(Some(metrics.availability)),
                ],
            }
        };
        let k = first.map_or(1, |one| one.k);
        let satellites = crate::units::counted(k, "satellite");
        let cases = match first.is_some_and(|one| one.is_drawn) {
            true => format!("{satellites}, {} draws", lost.len()),
            false => format!("{satellites}, all {} cases", lost.len()),
        };
        let map_without = match worst.first() {
            Some((names, _)) if k > 1 => format!("{names}, the worst of these cases"),
            _ => "the worst one satellite".to_owned(),
        };
        Ok(Self {
            map_without,
            name: first.map(|one| one.name.clone()).unwrap_or_default(),
            cases,
            distribution,
            map,
            rows: worst.iter().take(MOST_ROWS).map(row).collect(),
            left_out: lost.len().saturating_sub(MOST_ROWS),
        })
    }
}

/// A figure as SVG in base64.
fn image(plate: &Plate) -> Result<String, DrawError> {
    let mut bytes = Vec::new();
    svg(&plate.chart, Sheet::default(), &mut bytes)?;
    Ok(STANDARD.encode(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::Metrics;
    use crate::evaluate::testing::no_metrics;

    /// The worst come first: unsolved samples, then CVaR; a loss that leaves unsolved samples has no CVaR.
    #[test]
    fn the_table_begins_with_the_worst() {
        let with = |cvar: f64, solved_fraction: f64| Metrics {
            cvar_pdop: Some(cvar),
            solved_fraction,
            ..no_metrics()
        };
        let mut lost: Vec<(String, Metrics)> = (0..25)
            .map(|n| (format!("S{n}"), with(2.0 + 0.01 * f64::from(n), 1.0)))
            .collect();
        lost[3].1 = with(1.0, 0.999);
        let losses = NamedLosses {
            name: "<it>".to_owned(),
            notation: "n".to_owned(),
            whole: with(1.9, 1.0),
            lost,
            k: 1,
            is_drawn: false,
        };
        let section = FailureSection::new(std::slice::from_ref(&losses), None).unwrap();
        assert_eq!(section.map_without, "the worst one satellite");
        let pairs = NamedLosses { k: 2, ..losses };
        let of_pairs = FailureSection::new(&[pairs], None).unwrap();
        assert_eq!(of_pairs.map_without, "S3, the worst of these cases");
        let names: Vec<&str> = section
            .rows
            .iter()
            .map(|row| row.without.as_str())
            .collect();
        assert_eq!(names[..3], ["S3", "S24", "S23"]);
        assert_eq!((names.len(), section.left_out), (20, 5));
        assert_ne!(section.rows[0].cells[1], section.rows[1].cells[1]);
        assert!(
            section.rows[1].cells[1].starts_with("2.24"),
            "{:?}",
            section.rows[1]
        );
        assert_eq!(section.cases, "1 satellite, all 25 cases");
    }
}
