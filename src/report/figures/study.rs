//! The figures of studies: how far each number is from the published one, and those of the paper.

use super::{Chart, DeviationChart, DeviationRow, Layer, PlaneChart, Style};
use crate::evaluate::EpochMetrics;
use crate::report::{StatementRecord, StudyResult};
use crate::study::Verdict;
use crate::study::paper::{Curve, Figures};
use crate::units::SECONDS_PER_HOUR;

/// A figure of a study with the name of its file. The numbers behind it are in the tables of the study.
pub type NamedChart = (String, Chart);

/// The names of the figures of the paper.
pub const PAPER_FIGURES: [&str; 5] = [
    "figure-2",
    "figure-3a",
    "figure-3b",
    "figure-4a",
    "figure-4b",
];

/// The figures of a study: the deviations of its numbers, if any has a tolerance, and of the paper figures 2 to 4.
#[must_use]
pub fn study_figures(study: &StudyResult) -> Vec<NamedChart> {
    let mut charts: Vec<NamedChart> = deviations(study)
        .into_iter()
        .map(|chart| (deviations_name(study.name()), chart))
        .collect();
    if let StudyResult::Paper(paper) = study {
        let figures = &paper.study.figures;
        let own = [
            places(figures),
            distribution(&figures.constellations),
            course(&figures.constellations),
            distribution(&figures.strategies),
            course(&figures.strategies),
        ];
        let names = PAPER_FIGURES.map(str::to_owned);
        charts.extend(names.into_iter().zip(own));
    }
    charts
}

/// The name of the figure with the deviations of a study.
#[must_use]
pub fn deviations_name(study: &str) -> String {
    format!("deviations-{study}")
}

/// The colour of a verdict.
fn colour(verdict: Verdict) -> usize {
    match verdict {
        Verdict::Met => 2,
        Verdict::MetUnderAssumption => 4,
        Verdict::Fitted | Verdict::Input => 0,
        Verdict::NotMet => 1,
        Verdict::Unconfirmed => 3,
    }
}

/// The deviation of each number in units of its tolerance, under the scenario of the study; `None` if no number has a
/// tolerance.
fn deviations(study: &StudyResult) -> Option<Chart> {
    let row = |one: &StatementRecord| {
        Some(DeviationRow {
            name: format!("{}  ({})", shortened(&one.name), one.verdict),
            tolerances: (one.computed? - one.expected) / one.tolerance?,
            colour: colour(one.verdict),
        })
    };
    let rows: Vec<DeviationRow> = study.statements().iter().filter_map(row).collect();
    (!rows.is_empty()).then(|| {
        Chart::Deviations(DeviationChart {
            title: format!("{}: computed minus published", study.name()),
            x: "deviation (tolerances)".to_owned(),
            rows,
        })
    })
}

/// A name that leaves room for its verdict.
fn shortened(name: &str) -> String {
    const MOST: usize = 38;
    if name.chars().count() <= MOST {
        return name.to_owned();
    }
    name.chars().take(MOST - 1).chain(['…']).collect()
}

fn plane(title: &str, [x, y]: [&str; 2], layers: Vec<Layer>) -> Chart {
    Chart::Plane(PlaneChart {
        title: title.to_owned(),
        x: x.to_owned(),
        y: y.to_owned(),
        layers,
    })
}

/// Figure 2a: the rows of Table II as marks, the sets found here as dots.
fn places(figures: &Figures) -> Chart {
    let mut layers: Vec<(bool, Layer)> = Vec::new();
    for place in &figures.places {
        let is_row = place.set == "table";
        let name = match is_row {
            true => format!("{}, Table II", place.scheme),
            false => format!("{}, found here", place.scheme),
        };
        let point = (place.j_pos, place.j_cost);
        match layers.iter_mut().find(|(_, layer)| layer.name == name) {
            Some((_, layer)) => layer.points.push(point),
            None => {
                let before = layers
                    .iter()
                    .filter(|(of_row, _)| *of_row == is_row)
                    .count();
                let style = match is_row {
                    true => Style::Marks(before + 1),
                    // The colour of the marks of the same scheme.
                    false => Style::Dots(before + 2),
                };
                let points = vec![point];
                layers.push((
                    is_row,
                    Layer {
                        name,
                        points,
                        style,
                    },
                ));
            }
        }
    }
    let layers = layers.into_iter().map(|(_, layer)| layer).collect();
    plane(
        "Figure 2: the plane of the objectives",
        ["J_pos", "J_cost"],
        layers,
    )
}

/// Figures 3a and 4a: the distribution of the mean visible satellites over the instants.
fn distribution(curves: &[Curve]) -> Chart {
    let points = |curve: &Curve| -> Vec<(f64, f64)> {
        let sorted = curve.sorted_visible();
        let count = sorted.len() as f64;
        let numbered = sorted.into_iter().enumerate();
        numbered
            .map(|(k, visible)| (visible, (k + 1) as f64 / count))
            .collect()
    };
    plane(
        "Distribution of the mean visible satellites",
        ["E_g(N_visible)", "fraction of the instants at or below"],
        layers(curves, points),
    )
}

/// Figures 3b and 4b: the maximum PDOP over time.
fn course(curves: &[Curve]) -> Chart {
    let at = |epoch: &EpochMetrics| Some((epoch.elapsed_s / SECONDS_PER_HOUR, epoch.max_pdop?));
    plane(
        "Maximum PDOP over the points",
        ["time (h)", "maximum PDOP"],
        layers(curves, |curve| curve.epochs.iter().filter_map(at).collect()),
    )
}

fn layers(curves: &[Curve], points: impl Fn(&Curve) -> Vec<(f64, f64)>) -> Vec<Layer> {
    let layer = |(n, curve): (usize, &Curve)| Layer {
        name: curve.name.clone(),
        points: points(curve),
        style: Style::Line(n),
    };
    curves.iter().enumerate().map(layer).collect()
}
