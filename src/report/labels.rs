//! The names of quantities for readers.

use crate::keyword::Keyword;
use crate::search::Quantity;

/// The label of a quantity's axis.
#[must_use]
pub fn quantity_label(name: &str) -> String {
    let Ok(quantity) = Quantity::from_keyword(name) else {
        return name.to_owned();
    };
    let label = match quantity {
        Quantity::JPos => "J_pos = mean PDOP + \u{3bb} CVaR of PDOP",
        Quantity::JCost => "J_cost = satellites / mean visible",
        Quantity::MeanPdop => "mean PDOP",
        Quantity::CvarPdop => "CVaR of PDOP",
        Quantity::P95Pdop => "95 % quantile of PDOP",
        Quantity::P99Pdop => "99 % quantile of PDOP",
        Quantity::MaxPdop => "maximum PDOP",
        Quantity::Satellites => "satellites",
        Quantity::Planes => "planes",
        Quantity::NewSatellites => "new satellites",
        Quantity::NewPlanes => "new planes",
        Quantity::MeanVisible => "mean visible LEO satellites",
        Quantity::Availability => "availability",
        Quantity::InformationPdop => "mean PDOP of a window",
        Quantity::Sigma3dM => "1-sigma position error (m)",
        Quantity::SigmaHM => "1-sigma horizontal error (m)",
        Quantity::SigmaVM => "1-sigma height error (m)",
        Quantity::Error953dM => "95 % position error (m)",
        Quantity::Error95HM => "95 % horizontal error (m)",
        Quantity::Error95VM => "95 % height error (m)",
        Quantity::LeastSeparationKm => "least separation (km)",
        Quantity::LaunchCost => "launch cost (satellites)",
        Quantity::LeastVisible => "least number of visible LEO satellites",
        Quantity::MeanTotalVisible => "mean visible satellites, LEO and GNSS",
        Quantity::LongestOutageS => "longest outage (s)",
        Quantity::N1MaxPdop => "maximum PDOP without any one satellite",
        Quantity::N1CvarPdop => "CVaR of PDOP without any one satellite",
        Quantity::N1Availability => "availability without any one satellite",
        Quantity::ExpectedAvailability => "expected availability",
        Quantity::P95Hdop => "95 % quantile of HDOP",
        Quantity::P95Vdop => "95 % quantile of VDOP",
        other => return indexed_label(other),
    };
    label.to_owned()
}

/// The label of a coverage, or of a gain.
fn indexed_label(quantity: Quantity) -> String {
    if let Some(of) = quantity.gain_in() {
        return format!("gain in {}", quantity_label(of.keyword()));
    }
    match quantity.coverage_levels() {
        Some((least, true)) => format!("fraction with at least {least} satellites, LEO and GNSS"),
        Some((least, false)) => format!("fraction with at least {least} LEO satellites"),
        None => quantity.to_string(),
    }
}
