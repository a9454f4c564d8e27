//! A build-up or a drawdown, phase by phase.

use super::table::{Csv, optional};
use super::{
    Axis, Chart, Figure, FigureError, Layer, Measure, MeasureAxis, PlaneChart, Plate, Style,
};
use crate::evaluate::Metrics;

/// The phases of a constellation.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedPhases {
    /// Its name.
    pub name: String,
    /// What it is made of.
    pub notation: String,
    /// Name, satellites in service and metrics of each phase, in the order of time.
    pub phases: Vec<(String, usize, Metrics)>,
}

/// The measures that the figure shows.
const SHOWN: [Measure; 5] = [
    Measure::Availability,
    Measure::MeanVisible,
    Measure::MeanPdop,
    Measure::P95Pdop,
    Measure::MaxPdop,
];

fn value(measure: Measure, metrics: &Metrics) -> Option<f64> {
    match measure {
        Measure::Availability => Some(metrics.availability),
        Measure::MeanVisible => Some(metrics.mean_visible),
        Measure::P95Pdop => metrics.p95_pdop,
        Measure::MaxPdop => metrics.max_pdop,
        _ => metrics.mean_pdop,
    }
}

/// A measure of each phase, over all points and instants. A phase without a value is a gap.
///
/// # Errors
/// If the measure is not one of phases, or has no value in any.
pub fn phases(all: &[NamedPhases], measure: Measure) -> Result<Plate, FigureError> {
    let figure = Figure::Phases;
    if !SHOWN.contains(&measure) {
        return Err(FigureError::measure(figure, measure, &SHOWN));
    }
    let header = [
        "name",
        "design",
        "phase",
        "satellites",
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
        let mut points = Vec::new();
        for (at, (phase, satellites, metrics)) in (1_u32..).zip(&one.phases) {
            csv.row([
                one.name.clone(),
                one.notation.clone(),
                phase.clone(),
                satellites.to_string(),
                metrics.mean_visible.to_string(),
                optional(metrics.mean_pdop),
                optional(metrics.cvar_pdop),
                optional(metrics.max_pdop),
                metrics.solved_fraction.to_string(),
                metrics.availability.to_string(),
            ])?;
            let value = value(measure, metrics).into_iter();
            points.extend(value.flat_map(|y| [(f64::from(at), y), (f64::from(at + 1), y)]));
        }
        layers.push(Layer {
            name: one.name.clone(),
            points,
            style: Style::Line(n),
        });
    }
    layers.retain(|layer| !layer.points.is_empty());
    if layers.is_empty() {
        let reason = "no phase has a solved sample";
        return Err(FigureError::Nothing { figure, reason });
    }
    let names = all.first().map_or(&[][..], |one| &one.phases);
    let x = match names {
        [first, .., last] => format!(
            "phase, from 1 ({}) to {} ({})",
            first.0,
            names.len(),
            last.0
        ),
        _ => "phase".to_owned(),
    };
    let chart = PlaneChart {
        title: "Phases of the constellation".to_owned(),
        x: Axis {
            is_whole: true,
            ..Axis::new(x)
        },
        y: match measure {
            Measure::Availability => Axis::share("availability (fraction of points and instants)"),
            other => Axis::new(other.label()),
        },
        measure: MeasureAxis::Y,
        layers,
    };
    Ok(Plate {
        chart: Chart::Plane(chart),
        csv: csv.text()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::testing::no_metrics;

    #[test]
    fn a_phase_is_a_step_and_has_a_row() {
        let phase = |(n, pdop): (usize, Option<f64>)| {
            let metrics = Metrics {
                mean_pdop: pdop,
                ..no_metrics()
            };
            (format!("p{n}"), n, metrics)
        };
        let values = [Some(2.0), None, Some(1.5)];
        let one = NamedPhases {
            name: "it".to_owned(),
            notation: "delta:55:3/3/1@925".to_owned(),
            phases: values.into_iter().enumerate().map(phase).collect(),
        };
        let plate = phases(std::slice::from_ref(&one), Measure::MeanPdop).unwrap();
        assert_eq!(plate.csv.lines().count(), 4);
        let Chart::Plane(chart) = plate.chart else {
            panic!("no plane")
        };
        assert_eq!(
            chart.layers[0].points,
            [(1.0, 2.0), (2.0, 2.0), (3.0, 1.5), (4.0, 1.5)]
        );
        assert_eq!(chart.x.label, "phase, from 1 (p0) to 3 (p2)");
        assert!(phases(&[one], Measure::LongestOutageS).is_err());
    }
}
