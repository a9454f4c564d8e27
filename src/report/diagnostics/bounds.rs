//! Variables whose bounds limit the front.

use super::named;
use crate::constellation::shell_letters;
use crate::run::{DesignSummary, Diagnostic, FrontMember};
use crate::search::{DesignSpace, ShellSpace};

/// Fraction of the front at a bound from which this is reported.
const RESTING_SHARE: f64 = 0.5;

/// Distance from a bound, as a fraction of the interval, that counts as being at it.
const RESTING_DISTANCE: f64 = 1e-3;

/// A variable of a shell: its name, unit, limits and value.
struct BoundedVariable {
    name: &'static str,
    unit: &'static str,
    limits: [f64; 2],
    value: fn(&DesignSummary) -> Option<f64>,
}

/// The variables whose bounds limit the front, and the shells that it does not use.
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
    let mut found = Vec::new();
    for (place, shell) in space.shells.iter().enumerate() {
        let members: Vec<&DesignSummary> = front.iter().filter_map(|m| m.shell(place)).collect();
        let is_used = !members.is_empty();
        if !is_used {
            found.push(unused(place, front.len()));
        }
        let widened = bounded(shell).into_iter().filter(|_| is_used);
        let at_end = |variable: &BoundedVariable, (bound, side): (f64, &str)| {
            let BoundedVariable {
                name,
                unit,
                limits: [lo, hi],
                value,
            } = *variable;
            let near = |shell: &&&DesignSummary| {
                value(shell).is_some_and(|x| (x - bound).abs() <= RESTING_DISTANCE * (hi - lo))
            };
            let resting = members.iter().filter(near).count();
            // Where a shell is mostly empty, its bounds do not limit the front.
            (resting as f64 >= RESTING_SHARE * front.len() as f64).then(|| {
                let variable = space.name_of(place, name);
                Diagnostic {
                    message: format!(
                        "{} is at its {side} bound ({bound}{unit}) in {}; consider widening it",
                        named(&variable),
                        designs(resting, front.len())
                    ),
                    code: format!("at-bound:{variable}"),
                }
            })
        };
        for variable in widened {
            let [lo, hi] = variable.limits;
            let ends = [(lo, "lower"), (hi, "upper")].into_iter();
            let open = ends.filter(|(bound, _)| !is_physical_limit(variable.name, *bound));
            found.extend(open.filter_map(|end| at_end(&variable, end)));
        }
    }
    found
}

/// The diagnostic of a shell that is empty in every design of the front.
fn unused(place: usize, front: usize) -> Diagnostic {
    let letters = shell_letters(place);
    Diagnostic {
        code: format!("empty-shell:{letters}"),
        message: format!(
            "shell {letters} of the search is empty in {}",
            designs(front, front)
        ),
    }
}

/// The variables of a shell that vary and have ends.
fn bounded(shell: &ShellSpace) -> Vec<BoundedVariable> {
    let whole = |[lo, hi]: [u32; 2]| [f64::from(lo), f64::from(hi)];
    let absent = |limits: Option<[f64; 2]>| limits.unwrap_or([0.0; 2]);
    let variable = |name, unit, limits, value| BoundedVariable {
        name,
        unit,
        limits,
        value,
    };
    let all = [
        variable("planes", "", whole(shell.planes), |d| Some(d.planes as f64)),
        variable(
            "satellites-per-plane",
            "",
            whole(shell.satellites_per_plane),
            |d| Some(d.satellites_per_plane? as f64),
        ),
        variable(
            "inclination-deg",
            "°",
            absent(shell.inclination_deg.limits()),
            |d| d.inclination_deg,
        ),
        variable(
            "altitude-km",
            " km",
            absent(shell.altitude_km.limits()),
            |d| d.altitude_km,
        ),
        variable("phasing", "", open_phasing(shell), |d| {
            Some(d.phasing? as f64)
        }),
        variable("eccentricity", "", shell.eccentricity, |d| d.eccentricity),
        variable(
            "arg-perigee-deg",
            "°",
            open_angle(shell.arg_perigee_deg),
            |d| d.arg_perigee_deg,
        ),
        variable("raan-deg", "°", open_angle(absent(shell.raan_deg)), |d| {
            d.raan_deg
        }),
        variable(
            "arg-latitude-deg",
            "°",
            open_angle(absent(shell.arg_latitude_deg)),
            |d| d.arg_latitude_deg,
        ),
        variable("node-step-deg", "°", absent(shell.node_step_deg), |d| {
            d.node_step_deg
        }),
    ];
    let varies = |variable: &BoundedVariable| variable.limits[0] < variable.limits[1];
    all.into_iter().filter(varies).collect()
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
fn open_phasing(space: &ShellSpace) -> [f64; 2] {
    let [lo, hi] = space.phasing;
    let hi = hi.min(space.planes[1].saturating_sub(1));
    let closed = lo == 0 && hi + 1 >= space.planes[1];
    let lo = if closed { hi } else { lo };
    [f64::from(lo), f64::from(hi)]
}

/// The limits of an angle, degrees; equal if they allow the full circle.
fn open_angle([lo, hi]: [f64; 2]) -> [f64; 2] {
    if hi - lo >= 360.0 { [lo, lo] } else { [lo, hi] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::testing;
    use crate::search::testing::shell;

    #[test]
    fn bounds_that_decide_are_named() {
        let space = ShellSpace {
            planes: [11, 15],
            phasing: [1, 1],
            ..shell()
        };
        let front = [
            "delta:45:225/15/1@1000",
            "delta:47:210/15/1@999.9",
            "delta:49:195/15/1@800",
        ];
        let front = front.map(|design| testing::member(1, design));
        let codes: Vec<_> = at_bounds(&front, &space.clone().into())
            .into_iter()
            .map(|d| d.code)
            .collect();
        assert_eq!(codes, ["at-bound:planes", "at-bound:altitude-km"]);
        assert_eq!(at_bounds(&[], &space.into())[0].code, "no-feasible-design");
    }

    #[test]
    fn every_variable_of_the_search_is_looked_at() {
        let space = ShellSpace {
            planes: [11, 15],
            phasing: [1, 5],
            eccentricity: [0.0, 0.02],
            arg_perigee_deg: [90.0, 270.0],
            ..shell()
        };
        let front = [
            "lattice:45:169/13/5@900,e=0.02,w=270",
            "lattice:47:168/12/5@800,e=0.02,w=270",
        ]
        .map(|design| testing::member(1, design));
        let codes = |space: &ShellSpace| {
            let found = at_bounds(&front, &space.clone().into()).into_iter();
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
        let round = ShellSpace {
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
            &ShellSpace {
                phasing: [0, 5],
                ..round
            }
            .into(),
        );
        let codes: Vec<_> = found.into_iter().map(|d| d.code).collect();
        assert_eq!(codes, ["at-bound:planes"]);
    }

    /// Each shell of a search has its own bounds, and a shell that the front does not use is named.
    #[test]
    fn bounds_are_those_of_a_shell() {
        let low = ShellSpace {
            planes: [3, 5],
            ..shell()
        };
        let polar = ShellSpace {
            inclination_deg: [80.0, 90.0].into(),
            satellites_per_plane: [0, 15],
            ..shell()
        };
        let space = DesignSpace {
            shells: vec![low, polar],
            fixed: None,
        };
        let member = |low: &str, polar: Option<&str>| {
            let shells = [Some(low), polar].map(|one| {
                let shell = one?.parse::<crate::constellation::Shell>().unwrap();
                Some(DesignSummary::from(&shell))
            });
            FrontMember {
                shells: shells.to_vec(),
                ..testing::member(1, low)
            }
        };
        let codes = |front: &[FrontMember]| {
            let found = at_bounds(front, &space).into_iter();
            found.map(|d| d.code).collect::<Vec<_>>()
        };
        let (low, polar) = ("delta:50:60/5/1@800", "delta:90:60/6/1@800");
        let both = member(low, Some(polar));
        assert_eq!(
            codes(&[both.clone(), member(low, None)]),
            ["at-bound:A.planes", "at-bound:B.inclination-deg"]
        );
        // One of three designs has the second shell.
        let mostly_empty = [both, member(low, None), member(low, None)];
        assert_eq!(codes(&mostly_empty), ["at-bound:A.planes"]);
        let found = at_bounds(&[member(low, None)], &space);
        assert_eq!(found[1].code, "empty-shell:B");
        assert!(
            found[0]
                .message
                .starts_with("`planes` of shell A is at its upper bound (5) in the only"),
            "{}",
            found[0].message
        );
    }
}
