//! Variables whose bounds limit the front.

use crate::run::{Diagnostic, FrontMember};
use crate::search::DesignSpace;

/// Fraction of the front at a bound from which this is reported.
const RESTING_SHARE: f64 = 0.5;

/// Distance from a bound, as a fraction of the interval, that counts as being at it.
const RESTING_DISTANCE: f64 = 1e-3;

/// The variables whose bounds limit the front.
#[must_use]
pub fn at_bounds(front: &[FrontMember], space: &DesignSpace) -> Vec<Diagnostic> {
    if front.is_empty() {
        return vec![Diagnostic {
            code: "no-feasible-design".to_owned(),
            message: "no design of the result meets the constraints; widen the search bounds or \
                      relax the mask, the PDOP cap or the constraints"
                .to_owned(),
        }];
    }
    let whole = |[lo, hi]: [u32; 2]| [f64::from(lo), f64::from(hi)];
    type Value = fn(&FrontMember) -> Option<f64>;
    let variables: [(&str, &str, [f64; 2], Value); 7] = [
        ("planes", "", whole(space.planes), |m| {
            Some(m.design.as_ref()?.planes as f64)
        }),
        (
            "satellites-per-plane",
            "",
            whole(space.satellites_per_plane),
            |m| Some(m.design.as_ref()?.satellites_per_plane? as f64),
        ),
        ("inclination-deg", "°", space.inclination_deg, |m| {
            m.design.as_ref()?.inclination_deg
        }),
        ("altitude-km", " km", space.altitude_km, |m| {
            m.design.as_ref()?.altitude_km
        }),
        ("phasing", "", open_phasing(space), |m| {
            Some(m.design.as_ref()?.phasing? as f64)
        }),
        ("eccentricity", "", space.eccentricity, |m| {
            m.design.as_ref()?.eccentricity
        }),
        ("arg-perigee-deg", "°", open_perigee(space), |m| {
            m.design.as_ref()?.arg_perigee_deg
        }),
    ];
    let mut found = Vec::new();
    for (name, unit, [lo, hi], value) in variables {
        if hi <= lo {
            continue;
        }
        let ends = [(lo, "lower"), (hi, "upper")];
        for (bound, side) in ends
            .into_iter()
            .filter(|(bound, _)| !is_physical_limit(name, *bound))
        {
            let near = |m: &&FrontMember| {
                value(m).is_some_and(|x| (x - bound).abs() <= RESTING_DISTANCE * (hi - lo))
            };
            let resting = front.iter().filter(near).count();
            if resting as f64 >= RESTING_SHARE * front.len() as f64 {
                found.push(Diagnostic {
                    code: format!("at-bound:{name}"),
                    message: format!(
                        "`{name}` is at its {side} bound ({bound}{unit}) in {}; consider widening it",
                        designs(resting, front.len())
                    ),
                });
            }
        }
    }
    found
}

/// Whether a bound is where the variable itself ends, so that no search could be wider.
fn is_physical_limit(variable: &str, bound: f64) -> bool {
    match variable {
        "planes" | "satellites-per-plane" => bound <= 1.0,
        "inclination-deg" => bound <= 0.0 || bound >= 180.0,
        "phasing" | "eccentricity" => bound <= 0.0,
        _ => false,
    }
}

/// `n` of `all` designs of a front, in words.
fn designs(n: usize, all: usize) -> String {
    match (n, all) {
        (_, 1) => "the only design of the front".to_owned(),
        (2, 2) => "both designs of the front".to_owned(),
        _ if n == all => format!("all {all} designs of the front"),
        _ => format!("{n} of the {all} designs of the front"),
    }
}

/// The limits of the phasing; equal if they allow every phasing of every number of planes, since
/// phasings repeat after P and so have no ends.
fn open_phasing(space: &DesignSpace) -> [f64; 2] {
    let [lo, hi] = space.phasing;
    let hi = hi.min(space.planes[1].saturating_sub(1));
    let closed = lo == 0 && hi + 1 >= space.planes[1];
    let lo = if closed { hi } else { lo };
    [f64::from(lo), f64::from(hi)]
}

/// The limits of the argument of perigee, degrees; equal if they allow the full circle.
fn open_perigee(space: &DesignSpace) -> [f64; 2] {
    let [lo, hi] = space.arg_perigee_deg;
    if hi - lo >= 360.0 { [lo, lo] } else { [lo, hi] }
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

    #[test]
    fn every_variable_of_the_search_is_looked_at() {
        let space = DesignSpace {
            pattern: Pattern::Lattice,
            planes: [11, 15],
            satellites_per_plane: [11, 15],
            inclination_deg: [40.0, 60.0],
            altitude_km: [400.0, 1000.0],
            phasing: [1, 5],
            eccentricity: [0.0, 0.02],
            arg_perigee_deg: [90.0, 270.0],
        };
        let front = [
            "lattice:45:169/13/5@900,e=0.02,w=270",
            "lattice:47:168/12/5@800,e=0.02,w=270",
        ]
        .map(|design| testing::member(1, design));
        let codes = |space: &DesignSpace| {
            let found = at_bounds(&front, space).into_iter();
            found.map(|d| d.code).collect::<Vec<_>>()
        };
        assert_eq!(
            codes(&space),
            [
                "at-bound:phasing",
                "at-bound:eccentricity",
                "at-bound:arg-perigee-deg"
            ]
        );
        // A full circle has no ends.
        let round = DesignSpace {
            planes: [11, 13],
            phasing: [0, 12],
            arg_perigee_deg: [0.0, 360.0],
            ..space
        };
        assert_eq!(codes(&round), ["at-bound:planes", "at-bound:eccentricity"]);
        // Nor can a search go below a circle.
        let front = ["delta:45:169/13/0@900"].map(|design| testing::member(1, design));
        let found = at_bounds(
            &front,
            &DesignSpace {
                phasing: [0, 5],
                ..round
            },
        );
        let codes: Vec<_> = found.into_iter().map(|d| d.code).collect();
        assert_eq!(codes, ["at-bound:planes"]);
    }
}
