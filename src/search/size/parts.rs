//! Parts of the walk, which several processes may try. Nothing is learnt from one for another, so that a search that takes up the
//! results of parts is the one that tries everything itself.

use super::level::LevelSummary;
use super::order::Hardness;
use super::problem::SizeProblem;
use super::walk::SizeSearch;
use crate::optimize::OptimizeError;
use crate::search::Quantity;
use serde::{Deserialize, Serialize};

/// Points of the grid in a part: seconds of one thread for a day by minutes, and eight batches, of which one is tried in an order
/// that is not learnt yet.
pub(super) const PART_POINTS: u64 = 8192;

/// Where the walk is: a number of satellites, the counts of the shells, a point of that part of the grid, and the points before it in
/// the whole walk.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(super) struct Cursor {
    pub(super) level: usize,
    pub(super) counts: usize,
    pub(super) point: u64,
    pub(super) walked: u64,
}

impl Cursor {
    /// At the first point with the next counts of the shells.
    pub(super) fn with_next_counts(self) -> Self {
        Self {
            counts: self.counts + 1,
            point: 0,
            ..self
        }
    }

    /// At the first point with the next number of satellites.
    pub(super) fn with_next_level(self) -> Self {
        Self {
            level: self.level + 1,
            walked: self.walked,
            ..Self::default()
        }
    }
}

impl SizeProblem<'_> {
    /// Points of the grid, repeats included, in the order of the walk up to and with a number of satellites.
    fn points_with(&self, satellites: usize) -> Result<Vec<u64>, OptimizeError> {
        let all = self.with_total(satellites);
        all.iter().map(|counts| self.part(counts).count()).collect()
    }

    /// Number of parts of the whole walk.
    ///
    /// # Errors
    /// If a part of the grid has more than 2^53 points.
    pub fn parts(&self) -> Result<u64, OptimizeError> {
        let mut points = 0;
        for satellites in self.totals() {
            points += self.points_with(satellites)?.iter().sum::<u64>();
        }
        Ok(points.div_ceil(self.part_points))
    }

    /// The number of satellites that a part begins with; `None` behind the last.
    ///
    /// # Errors
    /// If a part of the grid has more than 2^53 points.
    pub fn satellites_of_part(&self, part: u64) -> Result<Option<usize>, OptimizeError> {
        let at = self.cursor_at(part * self.part_points)?;
        Ok(self.totals().get(at.level).copied())
    }

    /// Where the walk is after so many points.
    pub(super) fn cursor_at(&self, walked: u64) -> Result<Cursor, OptimizeError> {
        let mut at = Cursor::default();
        for satellites in self.totals() {
            for points in self.points_with(satellites)? {
                if walked - at.walked < points {
                    at.point = walked - at.walked;
                    at.walked = walked;
                    return Ok(at);
                }
                at.walked += points;
                at = at.with_next_counts();
            }
            at = at.with_next_level();
        }
        Ok(at)
    }

    /// The points of the walk up to the end of the part that a place is in.
    pub(super) fn end_of_part(&self, at: Cursor) -> u64 {
        (at.walked / self.part_points + 1) * self.part_points
    }

    /// The last number of satellites that a search reaches that has found designs with `fewest` or fewer.
    #[must_use]
    pub fn last_reached(&self, fewest: usize, slack: usize) -> usize {
        let mut totals = self.totals().into_iter();
        let next = totals.find(|satellites| *satellites > fewest);
        next.map_or(fewest, |next| next.max(fewest + slack))
    }
}

impl SizeSearch {
    /// A search of a part alone, by its number from 0, as [`SizeSearch::start`]; `None` behind the last.
    ///
    /// # Errors
    /// If a part of the grid has more than 2^53 points.
    pub fn of_part(
        problem: &SizeProblem<'_>,
        slack: usize,
        objective: Option<Quantity>,
        part: u64,
    ) -> Result<Option<Self>, OptimizeError> {
        if problem.satellites_of_part(part)?.is_none() {
            return Ok(None);
        }
        Ok(Some(Self {
            cursor: problem.cursor_at(part * problem.part_points)?,
            only: Some(part),
            ..Self::start(problem, slack, objective)
        }))
    }

    /// The part that the next step begins, if it does.
    #[must_use]
    pub fn next_part(&self, problem: &SizeProblem<'_>) -> Option<u64> {
        let walked = self.cursor.walked;
        let begins = !self.is_done && walked.is_multiple_of(problem.part_points);
        begins.then_some(walked / problem.part_points)
    }

    /// Takes up the finished search of the part that the next step would begin; returns whether it is that.
    ///
    /// # Errors
    /// If a part of the grid has more than 2^53 points.
    pub fn absorb(&mut self, problem: &SizeProblem<'_>, part: Self) -> Result<bool, OptimizeError> {
        let number = self.next_part(problem);
        let is_that = number.is_some() && part.only == number && part.is_done;
        if !is_that || (part.slack, &part.objective) != (self.slack, &self.objective) {
            return Ok(false);
        }
        for level in part.levels {
            if self.is_beyond(level.satellites) {
                break;
            }
            self.absorb_level(level);
        }
        let end = problem.cursor_at(problem.end_of_part(self.cursor))?;
        self.go_on_at(problem, end, &problem.totals());
        Ok(true)
    }

    fn absorb_level(&mut self, level: LevelSummary) {
        let (satellites, objective) = (level.satellites, self.objective());
        let are_all_named = self.fewest().is_none_or(|fewest| fewest == satellites);
        match self.levels.last_mut() {
            Some(last) if last.satellites == satellites => {
                last.absorb(level, objective, are_all_named);
            }
            _ => {
                let mut first = LevelSummary::new(satellites);
                first.absorb(level, objective, are_all_named);
                self.levels.push(first);
            }
        }
    }

    /// Ends, or goes on at a place; a part begins with nothing learnt.
    pub(super) fn go_on_at(&mut self, problem: &SizeProblem<'_>, next: Cursor, totals: &[usize]) {
        let is_next = next.walked / problem.part_points > self.cursor.walked / problem.part_points;
        self.cursor = next;
        let next = totals.get(next.level);
        let is_last = next.is_none_or(|satellites| self.is_beyond(*satellites));
        self.is_done = is_last || is_next && self.only.is_some();
        if is_next && !self.is_done {
            self.tried_in_part = 0;
            self.hardness = problem.sample_tiles().map(Hardness::new);
        }
    }

    /// What is kept of a search in a file: of one that is done only what was found.
    #[must_use]
    pub fn kept(&self) -> Self {
        if !self.is_done {
            return self.clone();
        }
        Self {
            cursor: Cursor::default(),
            tried_in_part: 0,
            hardness: None,
            ..self.clone()
        }
    }
}
