//! Variables whose bounds decide the front.

use crate::run::{Diagnostic, FrontMember};
use crate::search::DesignSpace;

/// A front may rest on a bound with this share of its members before that is worth saying.
const RESTING_SHARE: f64 = 0.5;

/// Relative distance from a bound, in parts of the interval, that counts as resting on it.
const RESTING_DISTANCE: f64 = 1e-3;

/// The variables whose bounds decide the front.
#[must_use]
pub fn at_bounds(front: &[FrontMember], space: &DesignSpace) -> Vec<Diagnostic> {
    if front.is_empty() {
        return vec![Diagnostic {
            code: "no-feasible-design".to_owned(),
            message: "no design of the last population meets the constraints; widen the search or \
                      relax the mask, the PDOP cap or the constraints"
                .to_owned(),
        }];
    }
    let whole = |[lo, hi]: [u32; 2]| [f64::from(lo), f64::from(hi)];
    type Value = fn(&FrontMember) -> f64;
    let variables: [(&str, &str, [f64; 2], Value); 4] = [
        ("planes", "", whole(space.planes), |m| {
            m.design.planes as f64
        }),
        (
            "satellites-per-plane",
            "",
            whole(space.satellites_per_plane),
            |m| m.design.satellites_per_plane as f64,
        ),
        ("inclination-deg", "°", space.inclination_deg, |m| {
            m.design.inclination_deg
        }),
        ("altitude-km", " km", space.altitude_km, |m| {
            m.design.altitude_km
        }),
    ];
    let mut found = Vec::new();
    for (name, unit, [lo, hi], value) in variables {
        if hi <= lo {
            continue;
        }
        for (bound, side) in [(lo, "lower"), (hi, "upper")] {
            let near = |m: &&FrontMember| (value(m) - bound).abs() <= RESTING_DISTANCE * (hi - lo);
            let resting = front.iter().filter(near).count();
            if resting as f64 >= RESTING_SHARE * front.len() as f64 {
                found.push(Diagnostic {
                    code: format!("at-bound:{name}"),
                    message: format!(
                        "{name} rests on its {side} bound {bound}{unit} in {resting} of {} front \
                         members: the bound, not the trade-off, sets it",
                        front.len()
                    ),
                });
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constellation::Pattern;
    use crate::run::testing;

    #[test]
    fn bounds_that_decide_are_named() {
        let space = DesignSpace {
            pattern: Pattern::Delta,
            planes: [11, 15],
            satellites_per_plane: [11, 15],
            inclination_deg: [40.0, 60.0],
            altitude_km: [400.0, 1000.0],
            phasing: [1, 1],
            eccentricity: [0.0, 0.0],
            arg_perigee_deg: [0.0, 0.0],
        };
        let front = [
            "delta:45:225/15/1@1000",
            "delta:47:210/15/1@999.9",
            "delta:49:195/15/1@800",
        ];
        let front = front.map(|design| testing::member(1, design));
        let codes: Vec<_> = at_bounds(&front, &space)
            .into_iter()
            .map(|d| d.code)
            .collect();
        assert_eq!(codes, ["at-bound:planes", "at-bound:altitude-km"]);
        assert_eq!(at_bounds(&[], &space)[0].code, "no-feasible-design");
    }
}
