//! Distributions, series over time, and the convergence of the search.

use super::table::{Csv, optional};
use super::{
    Axis, Chart, Figure, FigureError, Layer, Measure, MeasureAxis, PlaneChart, Plate, Style,
    at_point, course,
};
use crate::evaluate::{COVERAGE_COLUMNS, EpochMetrics};
use crate::keyword::Keyword;
use crate::optimize::Record;
use crate::report::profile::{Profile, Quantile, quantiles_of};
use crate::report::shown;
use crate::run::Run;
use crate::units::{SECONDS_PER_HOUR, round_decimal};

/// A profile with its name in the legend.
#[derive(Debug, Clone)]
pub struct NamedProfile<'a> {
    /// Name of the constellation.
    pub name: String,
    /// Walker notation, and the names of files.
    pub notation: String,
    /// Its cuts.
    pub profile: &'a Profile,
}

/// Measures without a value at each instant.
const NOT_OVER_TIME: [Measure; 5] = [
    Measure::P95Pdop,
    Measure::LongestOutageS,
    Measure::OneLostMaxPdop,
    Measure::OneLostAvailability,
    Measure::Pdop,
];

/// Measures without a distribution.
const NOT_DISTRIBUTED: [Measure; 3] = [
    Measure::P95Pdop,
    Measure::OneLostMaxPdop,
    Measure::OneLostAvailability,
];

/// The measures that are not among `others`.
fn all_but(others: &[Measure]) -> Vec<Measure> {
    let all = Measure::ALL.iter().copied();
    all.filter(|one| !others.contains(one)).collect()
}

/// The value of a measure at an instant.
pub(in crate::report) fn at_epoch(measure: Measure, epoch: &EpochMetrics) -> Option<f64> {
    if let Some(least) = measure.coverage_level() {
        return epoch.coverage.of(least);
    }
    match measure {
        Measure::MeanVisible => Some(epoch.mean_visible),
        Measure::MaxPdop => epoch.max_pdop,
        Measure::Availability => Some(epoch.availability),
        Measure::GainMeanPdop => epoch.gain_mean_pdop,
        _ => epoch.mean_pdop,
    }
}

/// Whether the distribution of a measure is over the points; of the others it is over the instants.
fn is_over_points(measure: Measure) -> bool {
    measure.coverage_level().is_some()
        || matches!(
            measure,
            Measure::Availability | Measure::LongestOutageS | Measure::GainMeanPdop
        )
}

/// The axis of a measure over the points at one instant.
fn axis_over_points(measure: Measure) -> Axis {
    let label = label_over_points(measure);
    match measure {
        Measure::Availability => Axis::share(label),
        one if one.coverage_level().is_some() => Axis::share(label),
        _ => Axis::new(label),
    }
}

/// The label of a measure over the points at one instant.
fn label_over_points(measure: Measure) -> String {
    if let Some(least) = measure.coverage_level() {
        return format!("fraction of the points with at least {least} LEO satellites");
    }
    let label = match measure {
        Measure::MeanVisible => "E_g(N_visible): visible LEO satellites, mean over the points",
        Measure::MaxPdop => "maximum PDOP over the points",
        Measure::Availability => "availability (fraction of the points)",
        Measure::GainMeanPdop => "gain in mean PDOP over the GNSS alone",
        _ => "E_g(PDOP): mean PDOP over the points",
    };
    label.to_owned()
}

/// The distribution of a measure: [`Measure::Pdop`] over all points and instants, with the tail of
/// the first design; availability, coverage, outages and gain over the points; the others over the instants (figures 3a
/// and 4a of the paper).
///
/// # Errors
/// If the measure has no distribution, or there is nothing to show.
pub fn cdf(designs: &[NamedProfile<'_>], measure: Measure) -> Result<Plate, FigureError> {
    let figure = Figure::Cdf;
    let distribution = |profile: &Profile| -> Vec<Quantile> {
        let epochs = profile.epochs.iter();
        match measure {
            Measure::Pdop => profile.pdop.clone(),
            one if is_over_points(one) => profile.over_points(|point| at_point(one, point)),
            _ => quantiles_of(epochs.filter_map(|epoch| at_epoch(measure, epoch))),
        }
    };
    if NOT_DISTRIBUTED.contains(&measure) {
        let choices = all_but(&NOT_DISTRIBUTED);
        return Err(FigureError::measure(figure, measure, &choices));
    }
    let mut csv = Csv::new(&["design", "share", &measure.column(), "name"])?;
    let mut layers = Vec::new();
    for (n, named) in designs.iter().enumerate() {
        let quantiles = distribution(named.profile);
        for q in &quantiles {
            csv.row([
                named.notation.clone(),
                q.level.to_string(),
                q.value.to_string(),
                named.name.clone(),
            ])?;
        }
        layers.push(Layer {
            name: named.name.clone(),
            points: steps(&quantiles),
            style: Style::Line(n),
        });
    }
    if let (Measure::Pdop, Some(first)) = (measure, designs.first()) {
        layers.extend(tail_marks(first.profile));
    }
    layers.retain(|layer| !layer.points.is_empty());
    if layers.is_empty() {
        let reason = "all samples are unsolved";
        return Err(FigureError::Nothing { figure, reason });
    }
    let x = match measure {
        Measure::Pdop => "PDOP of all points and times".to_owned(),
        one if is_over_points(one) => format!("{}, over the points", one.label()),
        _ => label_over_points(measure),
    };
    let chart = PlaneChart {
        title: "Cumulative distribution".to_owned(),
        x: Axis::new(x),
        y: Axis::share("fraction at or below"),
        measure: MeasureAxis::X,
        layers,
    };
    Ok(Plate {
        chart: Chart::Plane(chart),
        csv: csv.text()?,
    })
}

/// The distribution as a step function, up to the last drawn level.
fn steps(quantiles: &[Quantile]) -> Vec<(f64, f64)> {
    let below = [0.0].into_iter().chain(quantiles.iter().map(|q| q.level));
    let step = |(q, below): (&Quantile, f64)| [(q.value, below), (q.value, q.level)];
    quantiles.iter().zip(below).flat_map(step).collect()
}

/// Vertical lines at the value at risk and at the CVaR.
fn tail_marks(profile: &Profile) -> Vec<Layer> {
    let Some(tail) = profile.tail else {
        return Vec::new();
    };
    let line = |name: String, x: f64| Layer {
        name,
        points: vec![(x, 0.0), (x, 1.0)],
        style: Style::Rule,
    };
    let percent = round_decimal(100.0 * tail.level, 6);
    vec![
        line(
            format!(
                "{percent} % quantile {}",
                shown::pdop(Some(tail.value_at_risk))
            ),
            tail.value_at_risk,
        ),
        line(
            format!("CVaR of PDOP {}", shown::pdop(Some(tail.cvar))),
            tail.cvar,
        ),
    ]
}

/// A measure over time (figures 3b and 4b of the paper).
///
/// # Errors
/// If the measure has no value at an instant, or there is nothing to show.
pub fn series(designs: &[NamedProfile<'_>], measure: Measure) -> Result<Plate, FigureError> {
    let figure = Figure::Series;
    if NOT_OVER_TIME.contains(&measure) {
        let choices = all_but(&NOT_OVER_TIME);
        return Err(FigureError::measure(figure, measure, &choices));
    }
    let before = [
        "design",
        "elapsed_s",
        "mean_visible",
        "mean_pdop",
        "max_pdop",
        "solved_fraction",
        "availability",
        "gain_mean_pdop",
    ];
    let mut csv = Csv::new(&[&before[..], &COVERAGE_COLUMNS, &["name"]].concat())?;
    let mut courses = Vec::new();
    for named in designs {
        for epoch in &named.profile.epochs {
            let numbers = [
                Some(epoch.elapsed_s),
                Some(epoch.mean_visible),
                epoch.mean_pdop,
                epoch.max_pdop,
                Some(epoch.solved_fraction),
                Some(epoch.availability),
                epoch.gain_mean_pdop,
            ];
            let coverage = epoch.coverage.shares().map(Some);
            let cells = numbers.into_iter().chain(coverage).map(optional);
            let (notation, name) = (named.notation.clone(), named.name.clone());
            csv.row([notation].into_iter().chain(cells).chain([name]))?;
        }
        let at = |e: &EpochMetrics| (e.elapsed_s / SECONDS_PER_HOUR, at_epoch(measure, e));
        let samples: Vec<(f64, Option<f64>)> = named.profile.epochs.iter().map(at).collect();
        courses.push((named.name.clone(), samples));
    }
    let (layers, note) = course::layers(&courses);
    if layers.is_empty() {
        let reason = "all samples are unsolved";
        return Err(FigureError::Nothing { figure, reason });
    }
    let chart = PlaneChart {
        title: "Over time".to_owned(),
        x: Axis::new(format!("time since the epoch (h){note}")),
        y: axis_over_points(measure),
        measure: MeasureAxis::Y,
        layers,
    };
    Ok(Plate {
        chart: Chart::Plane(chart),
        csv: csv.text()?,
    })
}

/// The hypervolume over the evaluations; without a hypervolume, the size of the front.
///
/// # Errors
/// If the run has no history.
pub fn convergence(run: &Run) -> Result<Plate, FigureError> {
    if run.history.is_empty() {
        return Err(FigureError::Nothing {
            figure: Figure::Convergence,
            reason: "the run has no history",
        });
    }
    let header = [
        "generation",
        "evaluations",
        "hypervolume",
        "front_size",
        "feasible",
    ];
    let mut csv = Csv::new(&header)?;
    let volumes = Record::volumes(&run.history);
    for (record, volume) in run.history.iter().zip(&volumes) {
        csv.row([
            record.generation.to_string(),
            record.evaluations.to_string(),
            optional(*volume),
            record.front_size.to_string(),
            record.feasible.to_string(),
        ])?;
    }
    let has_volume = volumes.iter().any(Option::is_some);
    let points = run
        .history
        .iter()
        .zip(&volumes)
        .filter_map(|(record, volume)| {
            let size = (!has_volume).then_some(record.front_size as f64);
            Some((record.evaluations as f64, volume.or(size)?))
        });
    let y = match (has_volume, run.reference()) {
        (true, Some(reference)) => {
            format!("hypervolume at {}", shown::point(&reference))
        }
        (true, None) => "hypervolume".to_owned(),
        (false, _) => "designs on the front".to_owned(),
    };
    let chart = PlaneChart {
        title: "Convergence of the search".to_owned(),
        x: Axis::new("designs evaluated"),
        y: Axis::new(y),
        measure: MeasureAxis::Neither,
        layers: vec![Layer {
            name: String::new(),
            points: points.collect(),
            style: Style::Line(0),
        }],
    };
    Ok(Plate {
        chart: Chart::Plane(chart),
        csv: csv.text()?,
    })
}
