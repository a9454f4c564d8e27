//! What the loss of each satellite does.

use super::table::{Csv, optional};
use super::{Axis, Chart, Figure, FigureError, Layer, MeasureAxis, PlaneChart, Plate, Style};
use crate::evaluate::Metrics;

/// A constellation, and the metrics without each of its satellites.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedLosses {
    /// Its name.
    pub name: String,
    /// What it is made of.
    pub notation: String,
    /// The metrics with all satellites.
    pub whole: Metrics,
    /// Name of each satellite, or names of each set joined by `+`, and the metrics without it.
    pub lost: Vec<(String, Metrics)>,
    /// Number of satellites that fail together.
    pub k: usize,
    /// Whether the sets were drawn.
    pub is_drawn: bool,
}

impl NamedLosses {
    /// The places of the losses, the worst first: what leaves most samples unsolved, then what has the largest CVaR.
    #[must_use]
    pub fn worst_first(&self) -> Vec<usize> {
        let cvar = |place: usize| self.lost[place].1.cvar_pdop.unwrap_or(f64::INFINITY);
        let solved = |place: usize| self.lost[place].1.solved_fraction;
        let mut places: Vec<usize> = (0..self.lost.len()).collect();
        places.sort_by(|&a, &b| {
            let by_solved = solved(a).total_cmp(&solved(b));
            by_solved.then_with(|| cvar(b).total_cmp(&cvar(a)))
        });
        places
    }
}

/// The distribution of the CVaR of PDOP over the satellites, each lost alone, or over sets of them, beside that of the whole
/// constellation.
///
/// # Errors
/// If no loss leaves a solved sample.
pub fn failures(all: &[NamedLosses]) -> Result<Plate, FigureError> {
    let header = [
        "name",
        "design",
        "without",
        "mean_visible",
        "mean_pdop",
        "cvar_pdop",
        "max_pdop",
        "solved_fraction",
        "availability",
    ];
    let mut csv = Csv::new(&header)?;
    let mut layers = Vec::new();
    for (n, one) in all.iter().enumerate() {
        for (name, metrics) in &one.lost {
            csv.row([
                one.name.clone(),
                one.notation.clone(),
                name.clone(),
                metrics.mean_visible.to_string(),
                optional(metrics.mean_pdop),
                optional(metrics.cvar_pdop),
                optional(metrics.max_pdop),
                metrics.solved_fraction.to_string(),
                metrics.availability.to_string(),
            ])?;
        }
        layers.push(Layer {
            name: one.name.clone(),
            points: steps(one),
            style: Style::Line(n),
        });
        layers.extend(one.whole.cvar_pdop.map(|cvar| Layer {
            name: format!("{}: all up", one.name),
            points: vec![(cvar, 0.0), (cvar, 1.0)],
            style: Style::Rule,
        }));
    }
    layers.reverse();
    if all.iter().all(|one| steps(one).is_empty()) {
        return Err(FigureError::Nothing {
            figure: Figure::Failures,
            reason: "without a satellite no sample is solved",
        });
    }
    let k = all.first().map_or(1, |one| one.k);
    let is_drawn = all.iter().any(|one| one.is_drawn);
    let chart = PlaneChart {
        title: format!("Loss of {}", crate::units::counted(k, "satellite")),
        x: Axis::new(match k {
            1 => "CVaR of PDOP without the satellite",
            _ => "CVaR of PDOP without the satellites",
        }),
        y: Axis::share(match (k, is_drawn) {
            (1, _) => "fraction of the satellites",
            (_, true) => "fraction of the draws",
            (_, false) => "fraction of the sets",
        }),
        measure: MeasureAxis::X,
        layers,
    };
    Ok(Plate {
        chart: Chart::Plane(chart),
        csv: csv.text()?,
    })
}

/// The step function of the CVaR; a loss that leaves no solved sample is beyond its end.
fn steps(one: &NamedLosses) -> Vec<(f64, f64)> {
    let mut values: Vec<f64> = one.lost.iter().filter_map(|(_, of)| of.cvar_pdop).collect();
    values.sort_unstable_by(f64::total_cmp);
    let count = one.lost.len() as f64;
    let step =
        |(n, value): (usize, f64)| [(value, n as f64 / count), (value, (n + 1) as f64 / count)];
    values.into_iter().enumerate().flat_map(step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::testing::no_metrics;

    #[test]
    fn losses_rise_to_one_and_the_table_has_a_row_each() {
        let with = |cvar| Metrics {
            cvar_pdop: cvar,
            ..no_metrics()
        };
        let losses = |values: [Option<f64>; 3]| NamedLosses {
            name: "it".to_owned(),
            notation: "delta:55:3/3/1@925".to_owned(),
            whole: with(Some(1.5)),
            lost: values.map(|value| ("NW".to_owned(), with(value))).to_vec(),
            k: 1,
            is_drawn: false,
        };
        let plate = failures(&[losses([Some(3.0), Some(2.0), None])]).unwrap();
        assert_eq!(plate.csv.lines().count(), 4);
        let Chart::Plane(chart) = plate.chart else {
            panic!("no plane")
        };
        assert_eq!(chart.layers[1].points[..2], [(2.0, 0.0), (2.0, 1.0 / 3.0)]);
        assert_eq!(chart.layers[1].points[3], (3.0, 2.0 / 3.0));
        assert_eq!(chart.layers[0].name, "it: all up");
        assert!(failures(&[losses([None; 3])]).is_err());
    }
}
