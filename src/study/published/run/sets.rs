//! What statements say of sets of designs: which dominate, which are picked, whose curves are better.

use super::figures::Curve;
use super::numbers::percent;
use super::{StudyRun, StudyRunError, Under};
use crate::optimize::{dominates, fuzzy};
use crate::study::published::PublishedStatement;
use crate::study::published::metric::{SetComparison, StudyMetric};
use crate::study::published::steps::{StudyReference, rows_of};

/// The objectives of a design, each to be minimised.
type ObjectivePoint = Vec<f64>;

impl StudyRun<'_> {
    /// The number of a comparison; `None` if it has none.
    pub(super) fn compared(
        &mut self,
        place: usize,
        comparison: SetComparison,
        statement: &PublishedStatement,
        under: Under<'_>,
    ) -> Result<Option<f64>, StudyRunError> {
        let line = statement.line;
        let Some(against) = statement.comparison.as_ref().map(|other| other.with()) else {
            return Ok(None);
        };
        let of = &statement.of;
        Ok(match comparison {
            SetComparison::MostVisible | SetComparison::LowestMaxPdop => {
                let own = self.curves(place, of, under, line)?;
                let others = self.curves(place, against, under, line)?;
                let [own] = own.as_slice() else {
                    let reason =
                        format!("{comparison} is of one constellation, and {of} is several");
                    return Err(self.study.wrong_at(line, reason));
                };
                match comparison {
                    SetComparison::MostVisible => most_visible(own, &others),
                    _ => lowest_max(own, &others),
                }
            }
            _ => {
                let own = self.points(place, of, under, line)?;
                let others = self.points(place, against, under, line)?;
                let Some((own, others)) = own.zip(others) else {
                    return Ok(None);
                };
                let beaten =
                    |point: &ObjectivePoint| others.iter().any(|other| dominates(other, point));
                match comparison {
                    SetComparison::Dominated => percent(own.iter().map(beaten)),
                    SetComparison::Undominated => percent(own.iter().map(|point| !beaten(point))),
                    _ => lead(&own, &others),
                }
            }
        })
    }

    /// The constellations of a reference with their names in figures: rows by group where no two have the same.
    pub(super) fn named(&self, text: &str, under: Under<'_>) -> Vec<(String, String)> {
        let rows = rows_of(&self.study.tables, text);
        if rows.is_empty() {
            let name = match StudyReference::of(text) {
                StudyReference::Search(name) => name,
                _ => text,
            };
            return vec![(name.to_owned(), self.text_of(text, under))];
        }
        let group = |name: &Option<String>| {
            let alike = rows.iter().filter(|row| row.group == *name).count();
            name.clone().filter(|_| alike == 1)
        };
        rows.iter()
            .map(|row| {
                let name = group(&row.group).unwrap_or_else(|| row.name.clone());
                (name, self.text_of(&row.name, under))
            })
            .collect()
    }

    /// The objectives of the designs of a reference; `None` if a row has none.
    fn points(
        &mut self,
        place: usize,
        text: &str,
        under: Under<'_>,
        line: usize,
    ) -> Result<Option<Vec<ObjectivePoint>>, StudyRunError> {
        let designs = match StudyReference::of(text) {
            StudyReference::Search(name) => self.members(name),
            _ => self
                .named(text, under)
                .into_iter()
                .map(|(_, of)| of)
                .collect(),
        };
        let mut points = Vec::new();
        for of in designs {
            let Some(point) = self.objectives(place, &of, line)? else {
                return Ok(None);
            };
            points.push(point);
        }
        Ok(Some(points))
    }

    /// The notations of what a search found.
    pub(super) fn members(&self, search: &str) -> Vec<String> {
        let set = self.searches.iter().find(|set| set.name == search);
        let members = set.into_iter().flat_map(|set| &set.members);
        members.map(|member| member.design.to_string()).collect()
    }

    /// The objectives of the scenario for a constellation, each to be minimised; `None` if one has no value.
    pub(super) fn objectives(
        &mut self,
        place: usize,
        of: &str,
        line: usize,
    ) -> Result<Option<ObjectivePoint>, StudyRunError> {
        let quantities = self.worlds[place].scenario.objectives.minimize.clone();
        let mut point = Vec::new();
        for quantity in quantities {
            let metric = StudyMetric::Quantity(quantity);
            match self.metric_of(place, metric, of, None, line)? {
                Some(value) => point.push(quantity.minimised(value)),
                None => return Ok(None),
            }
        }
        Ok(Some(point))
    }
}

/// The highest worst-case membership of some points minus that of others, over both sets together.
fn lead(own: &[ObjectivePoint], others: &[ObjectivePoint]) -> Option<f64> {
    let all: Vec<&ObjectivePoint> = own.iter().chain(others).collect();
    let memberships = fuzzy(&all).ok()?.minimum;
    let (of_own, of_others) = memberships.split_at(own.len());
    let highest = |of: &[f64]| of.iter().copied().max_by(f64::total_cmp);
    Some(highest(of_own)? - highest(of_others)?)
}

/// Percentage of the quantiles of the mean visible satellites at which a curve is above all others.
fn most_visible(own: &Curve, others: &[Curve]) -> Option<f64> {
    let others: Vec<Vec<f64>> = others.iter().map(Curve::sorted_visible).collect();
    let own = own.sorted_visible();
    percent((own.iter().enumerate()).map(|(k, x)| others.iter().all(|other| other[k] < *x)))
}

/// Percentage of the instants at which the maximum PDOP of a curve is below that of all others.
fn lowest_max(own: &Curve, others: &[Curve]) -> Option<f64> {
    let below = |k: usize, x: f64| {
        let mut rivals = others.iter().map(|other| other.epochs[k].max_pdop);
        rivals.all(|rival| rival.is_none_or(|rival| x < rival))
    };
    let instants = own.epochs.iter().enumerate();
    percent(instants.map(|(k, epoch)| epoch.max_pdop.is_some_and(|x| below(k, x))))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two points on a front and one behind both: memberships by hand.
    #[test]
    fn validate_the_lead_in_membership() {
        let point = |x: f64, y: f64| vec![x, y];
        let (own, others) = ([point(0.25, 0.25)], [point(0.0, 1.0), point(1.0, 0.0)]);
        // In units of the ranges (0.75, 0.75); the ends have a worst membership of 0.
        assert_eq!(lead(&own, &others), Some(0.75));
        assert_eq!(lead(&others, &own), Some(-0.75));
        assert_eq!(lead(&own, &[]), None);
    }
}
