//! Effect on the metrics of a spherical Earth or of geocentric verticals on the ellipsoid.

use crate::earth::Surface;
use crate::evaluate::{Evaluator, Setup};
use crate::frames::LocalFrame;
use crate::ground::Site;
use crate::validate::{Check, CheckedQuantity, Findings, Subject, ValidateError};

/// A geodetic point on the ellipsoid whose vertical points away from the Earth's centre: the mistake.
fn with_geocentric_vertical(latitude_rad: f64, longitude_rad: f64) -> LocalFrame {
    let right = LocalFrame::new(Surface::Wgs84, latitude_rad, longitude_rad);
    let up = right.origin_km.km().normalize();
    LocalFrame {
        up,
        north: up.cross(&right.east),
        ..right
    }
}

/// Makes the local frame of a latitude and longitude, radians.
type Frames = fn(f64, f64) -> LocalFrame;

fn setup_with(setup: &Setup, frame: Frames) -> Setup {
    let moved = |site: &Site| Site {
        local: frame(
            site.latitude_deg.to_radians(),
            site.longitude_deg.to_radians(),
        ),
        ..site.clone()
    };
    Setup {
        sites: setup.sites.iter().map(moved).collect(),
        ..setup.clone()
    }
}

/// The change in the metrics due to the surface, relative to WGS 84.
pub(super) fn findings(subject: &Subject<'_>) -> Result<Findings, ValidateError> {
    let propagated = subject.propagate_model()?;
    let metrics = |frame: Frames| {
        let evaluator = Evaluator::new(setup_with(subject.setup(), frame))?;
        evaluator.evaluate_ephemeris(&propagated)
    };
    let right = metrics(|lat, lon| LocalFrame::new(Surface::Wgs84, lat, lon))?;
    let others: [(&str, &str, Frames); 2] = [
        (
            "sphere",
            "latitudes read as geocentric on a sphere of the equatorial radius: points shift by up to 21 km",
            |lat, lon| LocalFrame::new(Surface::Sphere, lat, lon),
        ),
        (
            "geocentric-vertical",
            "points on the ellipsoid with geocentric verticals: a tilt of up to 0.19 deg",
            with_geocentric_vertical,
        ),
    ];
    let mut findings = Findings::default();
    for (name, reason, frame) in others {
        let wrong = metrics(frame)?;
        let mut add = |quantity: &str, before: Option<f64>, after: Option<f64>| {
            if let (Some(before), Some(after)) = (before, after) {
                let label = format!("change in {quantity} relative to WGS 84");
                findings.checks.push(Check::new(
                    &format!("geographiclib/{name}/{quantity}"),
                    CheckedQuantity {
                        quantity: &label,
                        unit: "1",
                        statistic: "difference",
                    },
                    after - before,
                    None,
                    reason,
                ));
            }
        };
        add(
            "mean-visible",
            Some(right.mean_visible),
            Some(wrong.mean_visible),
        );
        add("mean-pdop", right.mean_pdop, wrong.mean_pdop);
        add("max-pdop", right.max_pdop, wrong.max_pdop);
    }
    Ok(findings)
}
