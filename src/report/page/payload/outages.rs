//! The outages of the points that are out longest, as bits.

use super::interval;
use crate::report::profile::{PointOutages, Profile};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;

/// Most points shown.
pub(super) const MOST_ROWS: usize = 12;

/// The outages of a point.
#[derive(Serialize)]
pub(super) struct OutageRow {
    label: String,
    /// Whether the point is out at any instant of each interval of the series: bits, the lowest of each byte first.
    bits: String,
}

/// The points that are out longest.
pub(super) fn rows(profile: &Profile) -> Vec<OutageRow> {
    let shown = profile.outages.iter().take(MOST_ROWS);
    let row = |one: &PointOutages| OutageRow {
        label: profile.points[one.point].label(),
        bits: STANDARD.encode(bits(one, profile.step_s(), profile.epochs.len())),
    };
    shown.map(row).collect()
}

fn bits(one: &PointOutages, step_s: f64, epochs: usize) -> Vec<u8> {
    let together = interval(epochs);
    let mut bits = vec![0; epochs.div_ceil(together).div_ceil(8)];
    for outage in &one.outages {
        // A single instant has no step.
        let instant = |at_s: f64| {
            if step_s > 0.0 {
                (at_s / step_s).round() as usize
            } else {
                0
            }
        };
        let first = instant(outage.start_s);
        let end = instant(outage.start_s + outage.length_s).max(first + 1);
        for place in first / together..end.min(epochs).div_ceil(together) {
            bits[place / 8] |= 1 << (place % 8);
        }
    }
    bits
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::Outage;

    #[test]
    fn an_interval_is_out_if_an_instant_is() {
        let outage = |first: u32, count: u32| Outage {
            start_s: 60.0 * f64::from(first),
            length_s: 60.0 * f64::from(count),
            is_cut: false,
        };
        let of = |outages: &[Outage], epochs| {
            let one = PointOutages {
                point: 0,
                outages: outages.to_vec(),
            };
            bits(&one, 60.0, epochs)
        };
        assert_eq!(of(&[outage(0, 1), outage(9, 2)], 11), [1, 6]);
        // Two instants an interval.
        let days = of(&[outage(5, 1), outage(18, 3)], 2880);
        assert_eq!((days.len(), days[0], days[1]), (180, 4, 6));
    }
}
