//! Positions of satellites that are not in a shell, for the globe: samples between which the page interpolates.

use crate::ephemeris::Ephemeris;
use crate::report::page::pack::Packed;
use crate::units::SECONDS_PER_HOUR;
use serde::Serialize;

/// Maximum bytes of the page for the samples of one constellation, however few there are.
const MOST_BYTES: usize = 300_000;

/// Bytes of a sample: three numbers of two bytes, in base64.
const SAMPLE_BYTES: usize = 8;

/// Steps of the samples, seconds. Between samples 300 s apart a cubic is within about 2 km of a low orbit, and
/// 600 s apart within about 30 km, less than a satellite is drawn wide.
const STEPS_S: [f64; 2] = [300.0, 600.0];

/// Minimum time that is covered, seconds, rather than all satellites.
const LEAST_SPAN_S: f64 = 7200.0;

/// Sampled positions.
#[derive(Serialize)]
pub(super) struct Tracks {
    step_s: f64,
    /// Number of samples of each satellite.
    instants: usize,
    /// TEME, km: x, y and z, sample by sample and satellite by satellite; missing in a gap.
    positions_km: Packed,
    /// What is drawn, in words.
    note: String,
}

impl Tracks {
    /// Positions that take at most `bytes` of the page; `None` if every satellite is in a shell, whose elements are
    /// enough.
    pub(super) fn new(ephemeris: &Ephemeris, bytes: usize) -> Option<Self> {
        let others = ephemeris.outside_shells();
        if others.is_empty() {
            return None;
        }
        let grid = ephemeris.grid();
        let span_s = grid.step_s() * grid.len().saturating_sub(1) as f64;
        let plan = Thinning::new(others.len(), span_s, bytes.min(MOST_BYTES));
        let drawn = others.iter().step_by(plan.stride);
        let drawn = drawn.map(|place| &ephemeris.satellites()[*place]);
        let positions = drawn.flat_map(|satellite| {
            (0..plan.instants).flat_map(move |n| {
                let state = ephemeris.state_or_gap(satellite, plan.step_s * n as f64);
                let at = state.ok().flatten().map(|state| state.position_km.km());
                [0, 1, 2].map(|axis| at.map(|at| at[axis]))
            })
        });
        Some(Self {
            step_s: plan.step_s,
            instants: plan.instants,
            positions_km: Packed::new(positions),
            note: plan.told(others.len(), span_s),
        })
    }
}

/// What fits into the page.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Thinning {
    step_s: f64,
    instants: usize,
    /// Every so many satellites are drawn.
    stride: usize,
}

impl Thinning {
    fn new(satellites: usize, span_s: f64, bytes: usize) -> Self {
        let most = (bytes / SAMPLE_BYTES / satellites).max(1);
        let count = |span_s: f64, step_s: f64| (span_s / step_s) as usize + 1;
        let whole = STEPS_S
            .into_iter()
            .find(|step_s| count(span_s, *step_s) <= most);
        if let Some(step_s) = whole {
            return Self {
                step_s,
                instants: count(span_s, step_s),
                stride: 1,
            };
        }
        let step_s = STEPS_S[STEPS_S.len() - 1];
        let instants = most.max(count(span_s.min(LEAST_SPAN_S), step_s));
        Self {
            step_s,
            instants,
            stride: (instants * satellites * SAMPLE_BYTES).div_ceil(bytes),
        }
    }

    /// How the satellites are drawn, and what is left out.
    fn told(&self, satellites: usize, span_s: f64) -> String {
        let mut text = format!(
            "Satellites from files are drawn from positions every {} min, interpolated",
            self.step_s / 60.0
        );
        let drawn_s = self.step_s * (self.instants - 1) as f64;
        if span_s - drawn_s >= self.step_s {
            text += &format!(", over the first {:.1} h only", drawn_s / SECONDS_PER_HOUR);
        }
        if self.stride > 1 {
            let drawn = satellites.div_ceil(self.stride);
            text += &format!("; {drawn} of the {satellites} are drawn");
        }
        text + "."
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ephemeris::testing::files_between_shells;

    /// Those in shells are drawn from their elements.
    #[test]
    fn only_satellites_outside_shells_are_sampled() {
        let mixed = files_between_shells();
        let tracks = Tracks::new(&mixed, MOST_BYTES).unwrap();
        let expected = mixed.satellites()[2..4].iter().flat_map(|satellite| {
            let states = (0..tracks.instants).map(|n| mixed.state(satellite, 300.0 * n as f64));
            states.flat_map(|state| state.unwrap().position_km.km().data.0[0].map(Some))
        });
        let expected = Packed::new(expected);
        let json = |packed: &Packed| serde_json::to_string(packed).unwrap();
        assert_eq!(json(&tracks.positions_km), json(&expected));
    }

    #[test]
    fn what_does_not_fit_is_thinned_and_said_to_be() {
        let day = 86_340.0;
        let told = |satellites: usize| {
            for bytes in [MOST_BYTES, MOST_BYTES / 33] {
                let plan = Thinning::new(satellites, day, bytes);
                let drawn = satellites.div_ceil(plan.stride);
                assert!(drawn * plan.instants * SAMPLE_BYTES <= bytes, "{plan:?}");
            }
            Thinning::new(satellites, day, MOST_BYTES).told(satellites, day)
        };
        assert!(told(66).ends_with("every 5 min, interpolated."));
        assert!(told(200).ends_with("every 10 min, interpolated."));
        assert!(
            told(1000).ends_with("over the first 6.0 h only."),
            "{}",
            told(1000)
        );
        let many = told(10_000);
        assert!(
            many.contains("2.0 h only; 2500 of the 10000 are drawn"),
            "{many}"
        );
        assert_eq!(Thinning::new(3, 0.0, MOST_BYTES).instants, 1);
    }
}
