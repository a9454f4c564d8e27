//! The figures of studies: how far each number is from the published one, and those that the study asks for.

use super::{
    Axis, Chart, DeviationChart, DeviationRow, Layer, MeasureAxis, PlaneChart, Style,
    course as of_time,
};
use crate::evaluate::EpochMetrics;
use crate::report::{StatementRecord, StudyResult, quantity_label};
use crate::study::Verdict;
use crate::study::published::{Curve, FigureData, PlacedDesign};
use crate::units::SECONDS_PER_HOUR;

/// A figure of a study with the name of its file. The numbers behind it are in the tables of the study.
pub type NamedChart = (String, Chart);

/// The figures of a study: the deviations of its numbers, if any has a tolerance, and its own.
#[must_use]
pub fn study_figures(study: &StudyResult) -> Vec<NamedChart> {
    let mut charts: Vec<NamedChart> = deviations(study)
        .into_iter()
        .map(|chart| (deviations_name(&study.name), chart))
        .collect();
    let own = study.figures.iter().map(|figure| {
        let title = figure.title.as_str();
        let chart = match &figure.data {
            FigureData::Objectives { objectives, places } => {
                let labels = objectives.map(|objective| quantity_label(&objective.to_string()));
                plane(title, labels.map(Axis::new), placed(places))
            }
            FigureData::VisibleDistribution(curves) => distribution(title, curves),
            FigureData::MaxPdopCourse(curves) => course(title, curves),
        };
        (figure.name.clone(), chart)
    });
    charts.extend(own);
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
    let rows: Vec<DeviationRow> = study.statements.iter().filter_map(row).collect();
    (!rows.is_empty()).then(|| {
        Chart::Deviations(DeviationChart {
            title: format!("{}: computed minus published", study.name),
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

fn plane(title: &str, [x, y]: [Axis; 2], layers: Vec<Layer>) -> Chart {
    Chart::Plane(PlaneChart {
        title: title.to_owned(),
        x,
        y,
        measure: MeasureAxis::Neither,
        layers,
    })
}

/// The designs that are stated as marks, those found by searches as dots.
fn placed(places: &[PlacedDesign]) -> Vec<Layer> {
    let mut layers: Vec<(bool, Layer)> = Vec::new();
    for place in places {
        let is_row = place.set == "table";
        let name = match is_row {
            true => match &place.table {
                Some(table) => format!("{}, {table}", place.scheme),
                None => place.scheme.clone(),
            },
            false => format!("{}, found here", place.scheme),
        };
        let [x, y] = place.objectives;
        let point = (x, y);
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
    layers.into_iter().map(|(_, layer)| layer).collect()
}

/// The distribution of the mean visible satellites over the instants.
fn distribution(title: &str, curves: &[Curve]) -> Chart {
    let points = |curve: &Curve| -> Vec<(f64, f64)> {
        let sorted = curve.sorted_visible();
        let count = sorted.len() as f64;
        let level = |k: usize| k as f64 / count;
        let numbered = sorted.into_iter().enumerate();
        numbered
            .flat_map(|(k, visible)| [(visible, level(k)), (visible, level(k + 1))])
            .collect()
    };
    let layer = |(n, curve): (usize, &Curve)| Layer {
        name: curve.name.clone(),
        points: points(curve),
        style: Style::Line(n),
    };
    let axes = [
        Axis::new("E_g(N_visible)"),
        Axis::share("fraction of the instants at or below"),
    ];
    plane(title, axes, curves.iter().enumerate().map(layer).collect())
}

/// The maximum PDOP over time.
fn course(title: &str, curves: &[Curve]) -> Chart {
    let at = |epoch: &EpochMetrics| (epoch.elapsed_s / SECONDS_PER_HOUR, epoch.max_pdop);
    let named = curves.iter().map(|curve| {
        let samples: Vec<(f64, Option<f64>)> = curve.epochs.iter().map(at).collect();
        (curve.name.clone(), samples)
    });
    let (layers, note) = of_time::layers(&named.collect::<Vec<_>>());
    let axes = [
        Axis::new(format!("time (h){note}")),
        Axis::new("maximum PDOP"),
    ];
    plane(title, axes, layers)
}
