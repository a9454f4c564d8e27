//! A front compared with the front of a grid sweep: how good it is, and what it missed.

use crate::run::{Certificate, FrontMember, Missed, OptimizeResult};
use crate::search::Quantity;

/// A design of the sweep counts as found if a front member is worse by at most this fraction of the
/// range of the sweep's front in every objective: the spacing of thirty members along a front.
const FOUND_WITHIN: f64 = 1.0 / 30.0;

impl Certificate {
    /// Compares a front with the result of a sweep of the same problem.
    ///
    /// The distance of a member is that of IGD+ (Ishibuchi et al., EMO 2015): the minimum over the
    /// members of the sweep's front of the root sum of squares by which it is worse, with each
    /// objective in units of that front's range. It is 0 for a member that none of them dominates.
    #[must_use]
    pub fn new(found: &OptimizeResult, sweep: &OptimizeResult, objectives: &[Quantity]) -> Self {
        let exact: Vec<Vec<f64>> = sweep
            .front
            .iter()
            .map(|m| minimised(m, objectives))
            .collect();
        let front: Vec<Vec<f64>> = found
            .front
            .iter()
            .map(|m| minimised(m, objectives))
            .collect();
        let ranges = ranges(&exact, objectives.len());
        let nearest = |point: &Vec<f64>| {
            let worse = exact.iter().map(|target| worse_by(point, target, &ranges));
            worse
                .map(|w| w.iter().map(|x| x * x).sum::<f64>().sqrt())
                .reduce(f64::min)
        };
        let is_found = |target: &Vec<f64>| {
            front.iter().any(|point| {
                worse_by(point, target, &ranges)
                    .iter()
                    .all(|&worse| worse <= FOUND_WITHIN)
            })
        };
        let missed: Vec<&FrontMember> = sweep
            .front
            .iter()
            .zip(&exact)
            .filter_map(|(member, target)| (!is_found(target)).then_some(member))
            .collect();
        Self {
            evaluations: sweep.search.evaluations,
            exact_members: exact.len(),
            exact_hypervolume: sweep.search.hypervolume.value,
            found_hypervolume: found.search.hypervolume.value,
            distances: front.iter().filter_map(nearest).collect(),
            missed: Missed::of(&missed),
        }
    }

    /// The certificate for a terminal.
    #[must_use]
    pub fn to_text(&self) -> String {
        let volume =
            |value: Option<f64>| value.map_or_else(|| "none".to_owned(), |v| format!("{v:.4}"));
        let worst = self.distances.iter().copied().fold(0.0, f64::max);
        let mean = self.distances.iter().sum::<f64>() / self.distances.len().max(1) as f64;
        let mut text = format!(
            "certificate: a grid sweep of {} designs gives a front of {}, hypervolume {}; this search {}\n\
             distance to the sweep's front, relative to its range: mean {:.2} %, maximum {:.2} %\n",
            self.evaluations,
            self.exact_members,
            volume(self.exact_hypervolume),
            volume(self.found_hypervolume),
            100.0 * mean,
            100.0 * worst,
        );
        text += &match &self.missed {
            None => "no part of the sweep's front was missed\n".to_owned(),
            Some(missed) => format!(
                "missed: {} designs of the sweep's front with planes {} to {}, satellites per plane {} to {}, \
                 inclination {} to {} deg, altitude {} to {} km\n",
                missed.members,
                missed.planes[0],
                missed.planes[1],
                missed.satellites_per_plane[0],
                missed.satellites_per_plane[1],
                missed.inclination_deg[0],
                missed.inclination_deg[1],
                missed.altitude_km[0],
                missed.altitude_km[1],
            ),
        };
        text
    }
}

impl Missed {
    fn of(members: &[&FrontMember]) -> Option<Self> {
        let whole = |value: fn(&FrontMember) -> usize| {
            let values = || members.iter().map(|member| value(member));
            Some([values().min()?, values().max()?])
        };
        let real = |value: fn(&FrontMember) -> f64| {
            let values = || members.iter().map(|member| value(member));
            Some([values().reduce(f64::min)?, values().reduce(f64::max)?])
        };
        Some(Self {
            members: members.len(),
            planes: whole(|m| m.design.planes)?,
            satellites_per_plane: whole(|m| m.design.satellites_per_plane)?,
            inclination_deg: real(|m| m.design.inclination_deg)?,
            altitude_km: real(|m| m.design.altitude_km)?,
        })
    }
}

fn minimised(member: &FrontMember, objectives: &[Quantity]) -> Vec<f64> {
    let values = objectives.iter().zip(&member.objectives);
    values
        .map(|(quantity, (_, value))| quantity.minimised(*value))
        .collect()
}

/// Range of the exact front in each objective; 1 if it is zero.
fn ranges(points: &[Vec<f64>], objectives: usize) -> Vec<f64> {
    let range = |n: usize| {
        let values = || points.iter().map(|point| point[n]);
        let width =
            values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min);
        if width > 0.0 && width.is_finite() {
            width
        } else {
            1.0
        }
    };
    (0..objectives).map(range).collect()
}

/// How much worse `point` is than `target` in each objective, in units of the ranges.
fn worse_by(point: &[f64], target: &[f64], ranges: &[f64]) -> Vec<f64> {
    let differences = point.iter().zip(target).zip(ranges);
    differences
        .map(|((p, t), range)| ((p - t) / range).max(0.0))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_worse_counts() {
        assert_eq!(worse_by(&[1.0, 3.0], &[2.0, 1.0], &[1.0, 4.0]), [0.0, 0.5]);
        assert_eq!(ranges(&[vec![1.0, 5.0], vec![3.0, 5.0]], 2), [2.0, 1.0]);
        assert_eq!(ranges(&[], 1), [1.0]);
    }
}
