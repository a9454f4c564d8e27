//! The error budget of a validation.

use super::table::Csv;
use super::{Chart, Figure, FigureError, Plate, RowChart};
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
    let chart = RowChart {
        title: "Error budget of the propagation".to_owned(),
        x: "root mean square difference (km)".to_owned(),
        marks: ["radial", "in-track", "cross-track"]
            .map(str::to_owned)
            .to_vec(),
        rows: lines
            .iter()
            .map(|line| (told(&line.case), line.rms_km.axes().map(f64::abs).to_vec()))
            .collect(),
    };
    Ok(Plate {
        chart: Chart::Rows(chart),
        csv: csv.text()?,
    })
}

/// What a case compares, in words.
fn told(case: &str) -> String {
    let cause = match case {
        "mean-j2/sgp4" => "mean J2, SGP4",
        "mean-j2/sgp4-no-j3j4" => "mean J2, SGP4 without J3 and J4",
        "osculating-j2/sgp4" => "J2 with short periods, SGP4",
        "osculating-j2/sgp4-no-j3j4" => "J2 with short periods, SGP4 without J3 and J4",
        "kepler-slot" => "mean motion in the wrong slot",
        "sgp4-no-j3j4/sgp4-no-j3" => "SGP4 without J3 and J4, without J3",
        "sgp4/sgp4-egm96" => "SGP4, SGP4 with constants of EGM96",
        "sgp4/sgp4-improved" => "SGP4, SGP4 in improved mode",
        "sgp4-at-tle-epoch/sgp4-written-tle" => {
            "elements at the epoch of the TLE, digits of the TLE"
        }
        "sgp4/sgp4-at-tle-epoch" => "SGP4, from the epoch of the TLE",
        other => other,
    };
    cause.to_owned()
}
