//! The numbers of planes and satellites of the shells of a space, by the number of satellites in all.

use crate::search::DesignSpace;
use std::collections::{BTreeMap, BTreeSet};

/// Planes and satellites per plane of each shell.
pub(super) type ShellCounts = Vec<[u32; 2]>;

/// The pairs of planes and satellites per plane of each shell, by their product.
pub(super) struct CountGrid {
    shells: Vec<BTreeMap<usize, Vec<[u32; 2]>>>,
}

impl CountGrid {
    pub(super) fn new(space: &DesignSpace) -> Self {
        let of_shell = |shell: &crate::search::ShellSpace| {
            let mut pairs: BTreeMap<usize, Vec<[u32; 2]>> = BTreeMap::new();
            let [fewest, most] = shell.planes;
            for planes in fewest..=most {
                for per_plane in shell.satellites_per_plane[0]..=shell.satellites_per_plane[1] {
                    // One empty shell stands for all.
                    if per_plane > 0 || planes == fewest {
                        let satellites = planes as usize * per_plane as usize;
                        pairs
                            .entry(satellites)
                            .or_default()
                            .push([planes, per_plane]);
                    }
                }
            }
            pairs
        };
        Self {
            shells: space.shells.iter().map(of_shell).collect(),
        }
    }

    /// The numbers of satellites that occur, in ascending order.
    pub(super) fn totals(&self) -> Vec<usize> {
        let sums = |sums: BTreeSet<usize>, shell: &BTreeMap<usize, _>| {
            let further = sums
                .iter()
                .flat_map(|sum| shell.keys().map(move |one| sum + one));
            further.collect()
        };
        let totals = self.shells.iter().fold(BTreeSet::from([0]), sums);
        totals.into_iter().collect()
    }

    /// The combinations with so many satellites, in the order of the shells' planes and satellites per plane.
    pub(super) fn with_total(&self, satellites: usize) -> Vec<ShellCounts> {
        let mut found = Vec::new();
        self.complete(&mut Vec::new(), satellites, &mut found);
        found.sort_unstable();
        found
    }

    fn complete(&self, begun: &mut ShellCounts, rest: usize, found: &mut Vec<ShellCounts>) {
        let Some(shell) = self.shells.get(begun.len()) else {
            if rest == 0 {
                found.push(begun.clone());
            }
            return;
        };
        let is_last = begun.len() + 1 == self.shells.len();
        let range = if is_last { rest..=rest } else { 0..=rest };
        for (satellites, pairs) in shell.range(range) {
            for pair in pairs {
                begun.push(*pair);
                self.complete(begun, rest - satellites, found);
                begun.pop();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::testing::shell;

    #[test]
    fn every_combination_has_its_total() {
        let mut space: DesignSpace = shell().into();
        space.shells[0].planes = [2, 4];
        space.shells[0].satellites_per_plane = [2, 3];
        let mut second = space.shells[0].clone();
        second.planes = [3, 5];
        second.satellites_per_plane = [0, 2];
        space.shells.push(second);
        let grid = CountGrid::new(&space);
        let all: Vec<ShellCounts> = grid
            .totals()
            .iter()
            .flat_map(|total| grid.with_total(*total))
            .collect();
        // Six pairs of the first; of the second one that is empty, and six.
        assert_eq!(all.len(), 6 * 7);
        assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), all.len());
        let satellites = |counts: &ShellCounts| counts.iter().map(|[p, s]| p * s).sum::<u32>();
        assert!(all.is_sorted_by_key(satellites));
        assert_eq!(grid.with_total(4), [[[2, 2], [3, 0]]]);
        assert_eq!(grid.with_total(7), [[[2, 2], [3, 1]]]);
        assert_eq!(
            grid.with_total(12),
            [
                [[2, 2], [4, 2]],
                [[2, 3], [3, 2]],
                [[3, 2], [3, 2]],
                [[3, 3], [3, 1]],
                [[4, 2], [4, 1]],
                [[4, 3], [3, 0]]
            ]
        );
    }
}
