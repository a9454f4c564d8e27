//! The number of a statement under a scenario, an assumption or a fit.

use super::{StudyRun, StudyRunError, Under, gnss};
use crate::constellation::Slot;
use crate::ephemeris::object_name;
use crate::evaluate::Evaluator;
use crate::search::Quantity;
use crate::study::published::measured::{of_orbit, of_sky};
use crate::study::published::metric::{OrbitQuantity, PERCENT, StudyMetric};
use crate::study::published::steps::{StudyReference, rows_of};
use crate::study::published::{PublishedStatement, StatementComparison, StudyKeys};

/// The unit of a key, from its name.
fn unit_of_key(key: &str) -> &'static str {
    const UNITS: [&str; 4] = ["deg", "km", "h", "s"];
    let last = key.rsplit('-').next().unwrap_or_default();
    UNITS
        .into_iter()
        .find(|unit| *unit == last)
        .unwrap_or_default()
}

impl StudyRun<'_> {
    /// The unit of the numbers of a statement.
    pub(super) fn unit(&self, statement: &PublishedStatement) -> &'static str {
        match self.found_fit(&statement.of) {
            Some(fit) => unit_of_key(&fit.vary),
            None => statement.unit(),
        }
    }
}

impl PublishedStatement {
    /// The unit of its numbers, if they are not of a fit.
    fn unit(&self) -> &'static str {
        let is_share = matches!(StudyReference::of(&self.of), StudyReference::Table(_));
        let is_change = matches!(
            self.comparison,
            Some(StatementComparison::PercentAbove(_) | StatementComparison::PercentBelow(_))
        );
        if is_share || is_change {
            PERCENT
        } else {
            self.metric.unit()
        }
    }
}

impl StudyRun<'_> {
    /// The place of the scenario of some keys under an assumption.
    pub(super) fn place(
        &mut self,
        under: Under<'_>,
        own: &StudyKeys,
    ) -> Result<usize, StudyRunError> {
        match under {
            Under::Assumption(assumption) => self.world(Some(assumption), own),
            Under::Scenario | Under::Fit(_) => self.world(None, own),
        }
    }

    /// The number of a statement; `None` if it has none.
    pub(super) fn value(
        &mut self,
        statement: &PublishedStatement,
        under: Under<'_>,
    ) -> Result<Option<f64>, StudyRunError> {
        let place = self.place(under, &statement.scenario)?;
        match (statement.metric, StudyReference::of(&statement.of)) {
            (StudyMetric::Implied, _) => return Ok(self.value_of_key(place, &statement.of)),
            (StudyMetric::Sets(comparison), _) => {
                return self.compared(place, comparison, statement, under);
            }
            (metric, StudyReference::Table(name)) => {
                return self.share_met(place, name, metric, under);
            }
            _ => {}
        }
        let ours = self.number(place, statement, &statement.of, under)?;
        let (other, sign) = match &statement.comparison {
            Some(StatementComparison::PercentAbove(other)) => (other, 1.0),
            Some(StatementComparison::PercentBelow(other)) => (other, -1.0),
            _ => return Ok(ours),
        };
        let other = self.number(place, statement, other, under)?;
        let both = ours.zip(other);
        Ok(both.map(|(ours, other)| sign * (100.0 * (ours / other - 1.0))))
    }

    /// The value of a key of the scenario, which a fit varies.
    fn value_of_key(&self, place: usize, of: &str) -> Option<f64> {
        let key = &self.found_fit(of)?.vary;
        let mut value = &toml::Value::Table(self.worlds[place].scenario.to_toml().parse().ok()?);
        for part in key.split('.') {
            value = value.get(part)?;
        }
        let whole = value.as_integer().map(|whole| whole as f64);
        value.as_float().or(whole)
    }

    /// The percentage of the rows of a table whose number of a column is met.
    fn share_met(
        &mut self,
        place: usize,
        table: &str,
        metric: StudyMetric,
        under: Under<'_>,
    ) -> Result<Option<f64>, StudyRunError> {
        let study = self.study;
        let table = study.tables.iter().find(|known| known.name == table);
        let Some((table, at)) = table.and_then(|table| Some((table, table.column(metric)?))) else {
            return Ok(None);
        };
        let mut met = Vec::new();
        for row in &table.rows {
            let of = self.text_of(&row.name, under);
            let found = self.metric_of(place, metric, &of, None, row.line)?;
            let expected = table.columns[at].expected(row.values[at]);
            met.push(found.is_some_and(|found| expected.holds(found)));
        }
        Ok(percent(met))
    }

    /// The text that stands for a reference under an assumption: a row is its constellation.
    pub(super) fn text_of(&self, text: &str, under: Under<'_>) -> String {
        let text = match under {
            Under::Assumption(assumption) => assumption.instead.get(text).map_or(text, |to| to),
            _ => text,
        };
        if !matches!(StudyReference::of(text), StudyReference::One(_)) {
            return text.to_owned();
        }
        let rows = rows_of(&self.study.tables, text);
        let Some(row) = rows.first() else {
            return text.to_owned();
        };
        let moved = match under {
            Under::Fit(n) => self.moves[n].notation(&row.name),
            _ => None,
        };
        moved.unwrap_or(&row.of).to_owned()
    }

    fn number(
        &mut self,
        place: usize,
        statement: &PublishedStatement,
        text: &str,
        under: Under<'_>,
    ) -> Result<Option<f64>, StudyRunError> {
        let of = self.text_of(text, under);
        let satellite = statement.satellite.as_deref();
        self.metric_of(place, statement.metric, &of, satellite, statement.line)
    }

    /// The number of a metric of one constellation, sky or group of GNSS satellites.
    pub(super) fn metric_of(
        &mut self,
        place: usize,
        metric: StudyMetric,
        of: &str,
        satellite: Option<&str>,
        line: usize,
    ) -> Result<Option<f64>, StudyRunError> {
        if let StudyReference::Gnss(beginning) = StudyReference::of(of) {
            let setup = self.evaluator(place, line)?.setup();
            return match metric {
                StudyMetric::Quantity(Quantity::Satellites) => Ok(Some(gnss::count(setup, beginning))),
                StudyMetric::Plane(quantity) => Ok(gnss::of_plane(setup, beginning, quantity)),
                _ => Err(self.study.wrong_at(
                    line,
                    format!("{metric} is not of GNSS satellites; expected satellites, plane-inclination-deg or height-km"),
                )),
            };
        }
        let picked = match StudyReference::of(of) {
            StudyReference::Search(name) => {
                let set = self.searches.iter().find(|set| set.name == name);
                match set.and_then(super::FoundSet::pick) {
                    Some(pick) => Some(pick.design.to_string()),
                    None => return Ok(None),
                }
            }
            _ => None,
        };
        let of = picked.as_deref().unwrap_or(of);
        match metric {
            StudyMetric::Orbit(quantity) => {
                return self.of_orbit(place, quantity, of, satellite, line);
            }
            StudyMetric::Sky(dilution) => {
                let mut known = self.study.skies.iter().zip(&self.skies);
                let sky = known.find(|(sky, _)| sky.name == of);
                return Ok(sky.and_then(|(_, sky)| of_sky(sky, dilution)));
            }
            StudyMetric::Plane(_) => {
                let reason = format!("{metric} is of GNSS satellites, as in of = \"gnss:GEO\"");
                return Err(self.study.wrong_at(line, reason));
            }
            _ => {}
        }
        let (evaluator, scenario, measured) = self.measured(place, of, line)?;
        if let Some(key) = lacking(evaluator, metric) {
            let reason = format!("{metric} needs {key} in the scenario");
            return Err(self.study.wrong_at(line, reason));
        }
        Ok(measured.value(evaluator, &scenario.goals(), metric)?)
    }

    fn of_orbit(
        &self,
        place: usize,
        quantity: OrbitQuantity,
        of: &str,
        satellite: Option<&str>,
        line: usize,
    ) -> Result<Option<f64>, StudyRunError> {
        let design = self.design(place, of, line)?;
        let Some(shell) = design.only_shell() else {
            let reason = format!("{quantity} is of one shell, and {of} has others");
            return Err(self.study.wrong_at(line, reason));
        };
        let Some(name) = satellite else {
            return Ok(of_orbit(shell, Slot::FIRST, quantity));
        };
        let names: Vec<(Slot, String)> = shell
            .slots()
            .map(|slot| (slot, object_name(slot)))
            .collect();
        if let Some((slot, _)) = names.iter().find(|(_, one)| one == name) {
            return Ok(of_orbit(shell, *slot, quantity));
        }
        let ends =
            [names.first(), names.last()].map(|end| end.map_or("", |(_, name)| name.as_str()));
        let [first, last] = ends;
        let reason = format!("satellite: {of} has no {name:?}, but {first} to {last}");
        Err(self.study.wrong_at(line, reason))
    }
}

/// What the scenario lacks that a metric needs.
fn lacking(evaluator: &Evaluator, metric: StudyMetric) -> Option<&'static str> {
    let setup = evaluator.setup();
    let key = metric.needed_key()?;
    let is_there = match key {
        "[accuracy]" => setup.accuracy.is_some(),
        _ => setup.window_s.is_some(),
    };
    (!is_there).then_some(key)
}

/// The percentage of cases that are true; `None` if there are none.
pub(super) fn percent(cases: impl IntoIterator<Item = bool>) -> Option<f64> {
    let (hold, all) = cases.into_iter().fold((0_u32, 0_u32), |(hold, all), case| {
        (hold + u32::from(case), all + 1)
    });
    (all > 0).then(|| 100.0 * f64::from(hold) / f64::from(all))
}
