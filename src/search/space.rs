//! The space of a search: the intervals of its shells, and how vectors become designs.

use super::shell_space::ShellSpace;
use crate::constellation::{Design, DesignError, Shell, shell_letters};
use crate::optimize::{OptimizeError, Space, Variable};

/// The designs of a search: one shell, or several that work together, beside what is fixed.
///
/// A vector lists the variables of the first shell, then those of the second, and so on.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignSpace {
    /// At least one.
    pub shells: Vec<ShellSpace>,
    /// Shells that every design has after its own.
    pub fixed: Option<Design>,
}

impl From<ShellSpace> for DesignSpace {
    fn from(shell: ShellSpace) -> Self {
        Self {
            shells: vec![shell],
            fixed: None,
        }
    }
}

impl DesignSpace {
    /// The space of the vectors. The variables are named as the keys of a scenario; those of several shells
    /// begin with the letter of the shell: `B.planes`.
    ///
    /// # Errors
    /// If an interval is reversed.
    pub fn vectors(&self) -> Result<Space, OptimizeError> {
        let shells = self.shells.iter().enumerate();
        let variables = shells.flat_map(|(n, shell)| {
            shell.variables().map(move |(name, kind)| Variable {
                name: self.name_of(n, name),
                kind,
            })
        });
        Space::new(variables.collect())
    }

    /// Number of variables of a vector.
    #[must_use]
    pub fn variable_count(&self) -> usize {
        let shells = self.shells.iter();
        shells.map(|shell| shell.variables().count()).sum()
    }

    /// The steps of a sweep, in the order of the vectors; 1 for counts and patterns.
    #[must_use]
    pub fn steps(&self) -> Vec<f64> {
        self.shells.iter().flat_map(ShellSpace::steps).collect()
    }

    /// The name of a variable of a shell.
    #[must_use]
    pub fn name_of(&self, shell: usize, variable: &str) -> String {
        match self.shells.len() {
            1 => variable.to_owned(),
            _ => format!("{}.{variable}", shell_letters(shell)),
        }
    }

    /// Whether a design can have shells that are not in their place: one shell alone is the whole design.
    #[must_use]
    pub fn is_of_one_shell(&self) -> bool {
        self.shells.len() == 1 && self.fixed.is_none()
    }

    /// Makes the variables of each shell consistent.
    pub(super) fn repair(&self, genome: &mut [f64]) {
        self.change(genome, ShellSpace::repair);
    }

    /// Moves the variables of empty shells to their lower limits, so that equal designs are equal vectors.
    pub(super) fn unify(&self, genome: &mut [f64]) {
        self.change(genome, ShellSpace::unify);
    }

    fn change(&self, mut genome: &mut [f64], change: fn(&ShellSpace, &mut [f64])) {
        for shell in &self.shells {
            let (own, others) = genome.split_at_mut(shell.variables().count());
            change(shell, own);
            genome = others;
        }
    }

    /// The part of a vector that is of each shell.
    fn parts<'g>(&self, mut genome: &'g [f64]) -> Vec<&'g [f64]> {
        let mut parts = Vec::with_capacity(self.shells.len());
        for shell in &self.shells {
            let (own, others) = genome.split_at(shell.variables().count());
            parts.push(own);
            genome = others;
        }
        parts
    }

    /// The shells of a vector in the order of the search, without what is fixed; `None` for an empty one.
    ///
    /// # Errors
    /// If a shell is not valid, for example because its perigee is below ground.
    pub fn shells_of(&self, genome: &[f64]) -> Result<Vec<Option<Shell>>, DesignError> {
        let parts = self.parts(genome);
        let pairs = self.shells.iter().zip(parts);
        pairs.map(|(shell, own)| shell.shell(own)).collect()
    }

    /// The design of a vector, with the shells that are fixed; `None` if all shells are empty and none is fixed.
    ///
    /// # Errors
    /// If a shell of the vector is not valid.
    pub fn design(&self, genome: &[f64]) -> Result<Option<Design>, DesignError> {
        let mut shells: Vec<Shell> = self.shells_of(genome)?.into_iter().flatten().collect();
        shells.extend(self.fixed.iter().flat_map(Design::shells));
        match Design::new(shells) {
            Err(DesignError::NoShell) => Ok(None),
            design => design.map(Some),
        }
    }

    /// Whether the design of a vector does not depend on a variable because its shell is empty.
    #[must_use]
    pub fn is_idle(&self, genome: &[f64], variable: usize) -> bool {
        let mut first = 0;
        for (shell, own) in self.shells.iter().zip(self.parts(genome)) {
            if variable < first + own.len() {
                return shell.is_idle(own, variable - first);
            }
            first += own.len();
        }
        false
    }

    /// Whether every shell of the search may be empty.
    #[must_use]
    pub fn may_be_empty(&self) -> bool {
        self.shells.iter().all(ShellSpace::may_be_empty)
    }

    /// What makes several vectors one design, in words: shells that are equal, and patterns that are.
    #[must_use]
    pub fn repetitions(&self) -> Vec<String> {
        let mut found = Vec::new();
        let mut told = Vec::new();
        for (n, shell) in self.shells.iter().enumerate() {
            if told.contains(&n) {
                continue;
            }
            let later = (n + 1..self.shells.len()).filter(|k| self.shells[*k].is_like(shell));
            let same: Vec<usize> = std::iter::once(n).chain(later).collect();
            if same.len() > 1 {
                found.push(equal_shells(&same));
                told.extend(same);
            }
        }
        for (n, shell) in self.shells.iter().enumerate() {
            if shell.has_equal_patterns() {
                let place = match self.shells.len() {
                    1 => String::new(),
                    _ => format!("shell {}: ", shell_letters(n)),
                };
                found.push(format!(
                    "{place}with node-step-deg, delta and star are the same satellites, so the search meets each \
                     design twice; give one pattern"
                ));
            }
        }
        found
    }
}

/// The warning about shells with the same intervals.
fn equal_shells(same: &[usize]) -> String {
    let letters: Vec<String> = same.iter().map(|n| shell_letters(*n)).collect();
    let times = match same.len() {
        2 => "twice".to_owned(),
        count => format!("{} times", (1..=count).product::<usize>()),
    };
    format!(
        "shells {} of the search have the same intervals, so each design is in the space up to {times}, in every \
         order; give them intervals that do not overlap",
        letters.join(" and ")
    )
}

#[cfg(test)]
mod tests;
