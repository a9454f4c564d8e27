//! The error budget of a validation.

use super::table::Csv;
use super::{BarChart, Chart, Figure, FigureError, Plate};
use crate::run::ValidateResult;

/// The root mean square differences of each case, by axis.
///
/// # Errors
/// If there is no validation with a budget.
pub fn budget(validation: Option<&ValidateResult>) -> Result<Plate, FigureError> {
    let lines = validation.map_or(&[][..], |validation| &validation.findings.budget);
    if lines.is_empty() {
        return Err(FigureError::Nothing {
            figure: Figure::Budget,
            reason: "no validation against SGP4 was run",
        });
    }
    let header = [
        "case",
        "rms_radial_km",
        "rms_in_track_km",
        "rms_cross_track_km",
        "max_radial_km",
        "max_in_track_km",
        "max_cross_track_km",
        "growth_radial_km_per_day",
        "growth_in_track_km_per_day",
        "growth_cross_track_km_per_day",
    ];
    let mut csv = Csv::new(&header)?;
    for line in lines {
        let numbers = [line.rms_km, line.max_km, line.growth_km_per_day];
        let numbers = numbers
            .iter()
            .flat_map(|ric| ric.axes())
            .map(|x| x.to_string());
        csv.row([line.case.clone()].into_iter().chain(numbers))?;
    }
    let chart = BarChart {
        title: "Error budget of the propagation".to_owned(),
        y: "RMS difference (km)".to_owned(),
        bars: ["radial", "in-track", "cross-track"]
            .map(str::to_owned)
            .to_vec(),
        groups: lines
            .iter()
            .map(|line| (line.case.clone(), line.rms_km.axes().to_vec()))
            .collect(),
    };
    Ok(Plate {
        chart: Chart::Bars(chart),
        csv: csv.text()?,
    })
}
