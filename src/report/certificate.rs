//! A front compared with the front of a grid sweep: how good it is, and what it missed.
//!
//! The sweep is exact only on its grid; a search may find better designs between its points.

use super::shown;
use crate::constellation::shell_letters;
use crate::optimize::{dominates, hypervolume};
use crate::run::{Certificate, DesignSummary, FrontMember, Missed, MissedShell, OptimizeResult};
use crate::search::Quantity;
use crate::units::counted;

/// A design of the sweep counts as found if a front member is worse by at most this fraction of the
/// range of the sweep's front in every objective: the spacing of thirty members along a front.
const FOUND_WITHIN: f64 = 1.0 / 30.0;

impl Certificate {
    /// Compares a front with the result of a sweep of the same problem.
    ///
    /// Both hypervolumes are at the reference point of the certified front. The distance of a member
    /// is that of IGD+ (Ishibuchi et al., EMO 2015): the minimum over the members of the sweep's front
    /// of the root sum of squares by which it is worse, with each objective in units of that front's
    /// range. It is 0 for a member that is no worse than one of them.
    #[must_use]
    pub fn new(found: &OptimizeResult, sweep: &OptimizeResult, objectives: &[Quantity]) -> Self {
        let grid: Vec<Vec<f64>> = sweep
            .front
            .iter()
            .map(|m| minimised(m, objectives))
            .collect();
        let front: Vec<Vec<f64>> = found
            .front
            .iter()
            .map(|m| minimised(m, objectives))
            .collect();
        let ranges = ranges(&grid, objectives.len());
        let nearest = |point: &Vec<f64>| {
            let worse = grid.iter().map(|target| worse_by(point, target, &ranges));
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
        let is_beaten = |target: &Vec<f64>| front.iter().any(|point| dominates(point, target));
        let measured = found.search.hypervolume.measured();
        let missed: Vec<&FrontMember> = sweep
            .front
            .iter()
            .zip(&grid)
            .filter_map(|(member, target)| (!is_found(target)).then_some(member))
            .collect();
        Self {
            evaluations: sweep.search.evaluations,
            grid_members: grid.len(),
            grid_hypervolume: measured.as_ref().map(|at| {
                let pairs = objectives.iter().zip(&at.reference);
                let reference: Vec<f64> = pairs.map(|(q, x)| q.minimised(*x)).collect();
                hypervolume(&grid, &reference)
            }),
            found_hypervolume: measured.map(|at| at.value),
            grid_members_dominated: grid.iter().filter(|target| is_beaten(target)).count(),
            distances: front.iter().filter_map(nearest).collect(),
            missed: Missed::of(&missed),
        }
    }

    /// The certificate for a terminal.
    #[must_use]
    pub fn to_text(&self) -> String {
        let volume =
            |value: Option<f64>| value.map_or_else(|| shown::NONE.to_owned(), shown::significant);
        let worst = self.distances.iter().copied().fold(0.0, f64::max);
        let mean = self.distances.iter().sum::<f64>() / self.distances.len().max(1) as f64;
        let mut text = format!(
            "certificate: a grid sweep of {} designs gives a front of {}, hypervolume {}; the hypervolume \
             of this search is {}\n\
             distance to the sweep's front, relative to its range: mean {:.2} %, maximum {:.2} %\n",
            self.evaluations,
            self.grid_members,
            volume(self.grid_hypervolume),
            volume(self.found_hypervolume),
            100.0 * mean,
            100.0 * worst,
        );
        if self.grid_members_dominated > 0 {
            text += &format!(
                "the search dominates {} of the {} designs of the sweep's front, with designs between \
                 the points of the grid\n",
                self.grid_members_dominated, self.grid_members
            );
        }
        text += &match &self.missed {
            None => "no part of the sweep's front was missed\n".to_owned(),
            Some(missed) => missed.to_text(),
        };
        text
    }
}

impl Missed {
    fn of(members: &[&FrontMember]) -> Option<Self> {
        let first = members.first()?;
        let shells = match first.shells.len() {
            0 => vec![MissedShell::of(None, members, 0)],
            count => (0..count)
                .map(|place| MissedShell::of(Some(shell_letters(place)), members, place))
                .collect(),
        };
        Some(Self {
            members: members.len(),
            shells,
        })
    }

    fn to_text(&self) -> String {
        let shells = self.shells.iter().map(|shell| shell.to_text(self.members));
        format!(
            "missed: {} of the sweep's front {}\n",
            counted(self.members, "design"),
            shells.collect::<Vec<_>>().join("; ")
        )
    }
}

impl MissedShell {
    /// The ranges of the shell at a place of the search.
    fn of(letter: Option<String>, members: &[&FrontMember], place: usize) -> Self {
        let shells = members.iter().filter_map(|member| member.shell(place));
        let shells: Vec<&DesignSummary> = shells.collect();
        Self {
            shell: letter,
            members: shells.len(),
            planes: range(shells.iter().map(|shell| shell.planes)),
            satellites_per_plane: range(shells.iter().filter_map(|one| one.satellites_per_plane)),
            inclination_deg: range(shells.iter().filter_map(|one| one.inclination_deg)),
            altitude_km: range(shells.iter().filter_map(|one| one.altitude_km)),
        }
    }

    fn to_text(&self, of: usize) -> String {
        let with = match (&self.shell, self.members) {
            (None, _) => "with".to_owned(),
            (Some(letter), 0) => return format!("without shell {letter}"),
            (Some(letter), members) if members == of => format!("with shell {letter} of"),
            (Some(letter), members) => {
                format!("with shell {letter} (empty in {}) of", of - members)
            }
        };
        let mut parts = Vec::new();
        let mut add = |name: &str, range: Option<[f64; 2]>, unit: &str| {
            let of_range = range.map(|[lo, hi]| format!("{name} {lo} to {hi}{unit}"));
            parts.extend(of_range);
        };
        let whole = |range: Option<[usize; 2]>| range.map(|ends| ends.map(|end| end as f64));
        add("planes", whole(self.planes), "");
        add("satellites per plane", whole(self.satellites_per_plane), "");
        add("inclination", self.inclination_deg, " deg");
        add("altitude", self.altitude_km, " km");
        format!("{with} {}", parts.join(", "))
    }
}

/// The least and the greatest of some values; `None` of none.
fn range<T: PartialOrd + Copy>(values: impl Iterator<Item = T>) -> Option<[T; 2]> {
    let widened = |[lo, hi]: [T; 2], value: T| {
        [
            if value < lo { value } else { lo },
            if value > hi { value } else { hi },
        ]
    };
    values.fold(None, |ends: Option<[T; 2]>, value| {
        Some(widened(ends.unwrap_or([value; 2]), value))
    })
}

fn minimised(member: &FrontMember, objectives: &[Quantity]) -> Vec<f64> {
    let values = objectives.iter().zip(&member.objectives);
    values
        .map(|(quantity, (_, value))| quantity.minimised(*value))
        .collect()
}

/// Range of the sweep's front in each objective; 1 if it is zero.
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
    use crate::run::{Hypervolume, SearchSummary, testing};

    #[test]
    fn only_what_is_worse_counts() {
        assert_eq!(worse_by(&[1.0, 3.0], &[2.0, 1.0], &[1.0, 4.0]), [0.0, 0.5]);
        assert_eq!(ranges(&[vec![1.0, 5.0], vec![3.0, 5.0]], 2), [2.0, 1.0]);
        assert_eq!(ranges(&[], 1), [1.0]);
    }

    fn result(points: &[[f64; 2]], reference: [f64; 2]) -> OptimizeResult {
        let objectives = [Quantity::MeanPdop, Quantity::Satellites];
        let member = |(n, [a, b]): (usize, &[f64; 2])| FrontMember {
            objectives: vec![("mean-pdop".to_owned(), *a), ("satellites".to_owned(), *b)],
            ..testing::member(n + 1, "delta:45:225/15/1@1000")
        };
        OptimizeResult {
            front: points.iter().enumerate().map(member).collect(),
            search: SearchSummary {
                hypervolume: Hypervolume::of(points, None, Some(&reference), &objectives),
                ..testing::summary()
            },
            history: Vec::new(),
            chosen_reference: None,
        }
    }

    /// By hand at the search's point (4, 4), whatever the sweep chose: the grid has 2 by 2 and 3 by 1
    /// with 2 by 1 in common, the search 2.5 by 2.
    #[test]
    fn a_search_may_beat_the_grid() {
        let found = result(&[[1.5, 2.0]], [4.0, 4.0]);
        let sweep = result(&[[1.0, 3.0], [2.0, 2.0]], [9.0, 9.0]);
        let certificate =
            Certificate::new(&found, &sweep, &[Quantity::MeanPdop, Quantity::Satellites]);
        assert_eq!(certificate.grid_hypervolume, Some(5.0));
        assert_eq!(certificate.found_hypervolume, Some(5.0));
        assert_eq!(certificate.grid_members_dominated, 1);
        assert_eq!(certificate.distances, [0.0]);
        let text = certificate.to_text();
        assert!(
            text.contains("a grid sweep of 900 designs gives a front of 2, hypervolume 5"),
            "{text}"
        );
        assert!(
            text.contains("dominates 1 of the 2 designs of the sweep's front"),
            "{text}"
        );
        assert!(!text.contains("exact"), "{text}");
    }

    /// What was missed is told for each shell of the search, whatever the others are.
    #[test]
    fn what_was_missed_is_told_by_shell() {
        let member = |shells: [Option<&str>; 3]| FrontMember {
            shells: shells
                .map(|one| {
                    let shell: crate::constellation::Shell = one?.parse().unwrap();
                    Some(DesignSummary::from(&shell))
                })
                .to_vec(),
            ..testing::member(1, "delta:50:8/2/1@800")
        };
        let (low, polar) = (Some("delta:50:8/2/1@800"), Some("star:90:12/4/1@1100"));
        let members = [
            member([low, polar, None]),
            member([Some("delta:45:15/5/1@900"), None, None]),
        ];
        let missed = Missed::of(&[&members[0], &members[1]]).unwrap();
        assert_eq!(
            missed.to_text(),
            "missed: 2 designs of the sweep's front with shell A of planes 2 to 5, satellites per plane 3 to 4, \
             inclination 45 to 50 deg, altitude 800 to 900 km; with shell B (empty in 1) of planes 4 to 4, satellites \
             per plane 3 to 3, inclination 90 to 90 deg, altitude 1100 to 1100 km; without shell C\n"
        );
        let [a, b, c] = missed.shells.as_slice() else {
            panic!("{missed:?}");
        };
        assert_eq!((a.members, a.planes), (2, Some([2, 5])));
        assert_eq!((b.members, b.inclination_deg), (1, Some([90.0, 90.0])));
        assert_eq!((c.members, c.planes), (0, None));
        let one = testing::member(1, "delta:50:8/2/1@800");
        let missed = Missed::of(&[&one]).unwrap();
        assert_eq!(
            missed.to_text(),
            "missed: 1 design of the sweep's front with planes 2 to 2, satellites per plane 4 to 4, inclination 50 to \
             50 deg, altitude 800 to 800 km\n"
        );
        assert_eq!(Missed::of(&[]), None);
    }
}
