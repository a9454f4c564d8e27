//! A build-up or a drawdown, phase by phase, for reading and as CSV.

use super::shown;
use super::{Align, Table};
use crate::evaluate::Metrics;
use crate::run::columns::{cells, metric_columns};
use crate::units::counted;
use serde::Serialize;
use std::io;

/// A phase of a build-up or a drawdown.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PhaseService {
    /// Its name.
    pub phase: String,
    /// Satellites in service.
    pub satellites: usize,
    /// Whether it meets all that service requires.
    pub serves: bool,
    /// The metrics.
    pub metrics: Metrics,
}

/// A build-up or a drawdown.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DeploymentSummary {
    /// What service requires, each as a constraint.
    pub requires: Vec<String>,
    /// The phases, in the order of time.
    pub phases: Vec<PhaseService>,
    /// The first phase that serves; `None` if none does.
    pub service_begins: Option<String>,
    /// The first phase after it that does not serve; `None` if all do.
    pub service_ends: Option<String>,
}

impl DeploymentSummary {
    /// The summary of phases, and what service requires.
    #[must_use]
    pub fn new(requires: Vec<String>, phases: Vec<PhaseService>) -> Self {
        let begins = phases.iter().position(|one| one.serves);
        let later = begins.and_then(|begins| phases[begins..].iter().find(|one| !one.serves));
        Self {
            requires,
            service_begins: begins.map(|begins| phases[begins].phase.clone()),
            service_ends: later.map(|one| one.phase.clone()),
            phases,
        }
    }

    /// A table for reading.
    #[must_use]
    pub fn to_text(&self) -> String {
        let right = Align::Right;
        let mut table = Table::new(&[
            ("phase", Align::Left),
            ("satellites", right),
            ("mean visible", right),
            ("mean PDOP", right),
            ("CVaR of PDOP", right),
            ("maximum PDOP", right),
            ("solved fraction", right),
            ("availability", right),
            ("serves", Align::Left),
        ]);
        for one in &self.phases {
            let metrics = &one.metrics;
            table.row([
                one.phase.clone(),
                one.satellites.to_string(),
                shown::pdop(Some(metrics.mean_visible)),
                shown::pdop(metrics.mean_pdop),
                shown::pdop(metrics.cvar_pdop),
                shown::pdop(metrics.max_pdop),
                shown::share(Some(metrics.solved_fraction)),
                shown::share(Some(metrics.availability)),
                if one.serves { "yes" } else { "no" }.to_owned(),
            ]);
        }
        let phases = counted(self.phases.len(), "phase");
        format!("\n{phases}\n{}{}\n", table.to_text(), self.verdict())
    }

    /// When service begins, and ends.
    fn verdict(&self) -> String {
        let requires = self.requires.join(", ");
        let Some(begins) = &self.service_begins else {
            return format!("no phase serves ({requires})");
        };
        match &self.service_ends {
            None => format!("service begins in {begins} ({requires})"),
            Some(ends) => format!("service begins in {begins} and ends in {ends} ({requires})"),
        }
    }

    /// The phases as rows of CSV: the constellation, the phase, its satellites, whether it serves, and the metrics.
    ///
    /// # Errors
    /// Never for a table in memory.
    pub fn to_csv(&self, constellation: &str, with_header: bool) -> io::Result<String> {
        let columns = metric_columns();
        let mut records = Vec::new();
        if with_header {
            let own = ["name", "phase", "satellites", "serves"];
            let names = own.iter().chain(&columns);
            records.push(names.map(|name| (*name).to_owned()).collect());
        }
        for one in &self.phases {
            let mut record = vec![
                constellation.to_owned(),
                one.phase.clone(),
                one.satellites.to_string(),
                one.serves.to_string(),
            ];
            record.extend(cells(&one.metrics, &columns)?);
            records.push(record);
        }
        let mut out = Vec::new();
        crate::formats::csv::write_records(&mut out, &records)?;
        String::from_utf8(out).map_err(io::Error::other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::testing::no_metrics;

    fn summary(serves: &[bool]) -> DeploymentSummary {
        let phase = |(n, serves): (usize, &bool)| PhaseService {
            phase: format!("p{n}"),
            satellites: 4 * n,
            serves: *serves,
            metrics: no_metrics(),
        };
        let phases = serves.iter().enumerate().map(phase).collect();
        DeploymentSummary::new(vec!["availability >= 1".to_owned()], phases)
    }

    #[test]
    fn service_begins_and_ends() {
        for (serves, begins, ends, verdict) in [
            (
                &[false, false][..],
                None,
                None,
                "no phase serves (availability >= 1)",
            ),
            (
                &[false, true, true],
                Some("p1"),
                None,
                "service begins in p1 (availability >= 1)",
            ),
            (
                &[true, true, false, true],
                Some("p0"),
                Some("p2"),
                "service begins in p0 and ends in p2 (availability >= 1)",
            ),
        ] {
            let of = summary(serves);
            assert_eq!(
                (of.service_begins.as_deref(), of.service_ends.as_deref()),
                (begins, ends)
            );
            assert!(
                of.to_text().ends_with(&format!("{verdict}\n")),
                "{}",
                of.to_text()
            );
        }
        let csv = summary(&[true, false]).to_csv("it", true).unwrap();
        assert!(
            csv.starts_with("name,phase,satellites,serves,mean_visible,"),
            "{csv}"
        );
        assert_eq!(
            csv.lines()
                .nth(2)
                .map(|line| line.starts_with("it,p1,4,false,")),
            Some(true)
        );
    }
}
