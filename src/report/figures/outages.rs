//! The outages of the points that are out longest, over time.

use super::{Chart, FigureError, NamedProfile, Plate, TimelineChart, title};
use crate::report::csv::OUTAGE_COLUMNS;
use crate::report::figures::table::Csv;
use crate::units::SECONDS_PER_HOUR;

/// The outages of a constellation at the points that are out longest; without rows if no point has any.
///
/// # Errors
/// Never for a table in memory.
pub fn timeline(named: &NamedProfile<'_>) -> Result<Plate, FigureError> {
    let profile = named.profile;
    let mut csv = Csv::new(&OUTAGE_COLUMNS)?;
    let mut rows = Vec::new();
    for one in &profile.outages {
        let point = &profile.points[one.point];
        for outage in &one.outages {
            csv.row([
                point.latitude_deg.to_string(),
                point.longitude_deg.to_string(),
                outage.start_s.to_string(),
                outage.length_s.to_string(),
                outage.is_cut.to_string(),
                point.name.as_deref().unwrap_or_default().to_owned(),
            ])?;
        }
        let hours = one.outages.iter().map(|outage| {
            let end_s = outage.start_s + outage.length_s;
            [outage.start_s, end_s].map(|at| at / SECONDS_PER_HOUR)
        });
        rows.push((point.label(), hours.collect()));
    }
    let step_s = profile.step_s();
    let title = title(named);
    let chart = TimelineChart {
        title: match rows.is_empty() {
            true => format!("No point has an outage: {title}"),
            false => format!("Outages: {title}"),
        },
        x: format!("time since the epoch (h), in steps of {step_s} s"),
        span: [0.0, profile.epochs.len() as f64 * step_s / SECONDS_PER_HOUR],
        rows,
    };
    Ok(Plate {
        chart: Chart::Timeline(chart),
        csv: csv.text()?,
    })
}
