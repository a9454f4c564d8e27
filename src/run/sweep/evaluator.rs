//! The evaluation of a chunk.

use super::SweepSource;
use super::chunk::SweepChunk;
use super::designs::SweptDesign;
use crate::constellation::Design;
use crate::evaluate::Metrics;
use crate::run::typed_columns::{ColumnKind, TypedColumns};
use crate::run::{DesignSummary, metric_columns, metric_values};
use crate::search::DesignProblem;
use rayon::prelude::*;
use serde_json::Value;

/// A design whose metrics show which ones are computed on demand.
const PROBE: &str = "delta:55:1/1/0@1000";

/// Evaluates the chunks of a sweep.
pub struct SweepEvaluator<'a> {
    problem: &'a DesignProblem<'a>,
    metrics: Vec<String>,
}

impl<'a> SweepEvaluator<'a> {
    /// For the sweeps of a study: evaluates one satellite, to know what is computed on demand.
    #[must_use]
    pub fn new(problem: &'a DesignProblem<'a>) -> Self {
        let probe = PROBE.parse().ok();
        let probed = probe.and_then(|probe| problem.judged(&probe));
        let on_demand = probed.map_or_else(Vec::new, |(metrics, _)| metrics.on_demand());
        let always = metric_columns().into_iter().map(str::to_owned);
        let on_demand = on_demand.into_iter().map(|(name, _)| name);
        Self {
            problem,
            metrics: always.chain(on_demand).collect(),
        }
    }

    /// The table of a chunk, in the order of its designs; `None` if it was stopped. A design that cannot be propagated, or
    /// is none, has no metrics.
    #[must_use]
    pub fn evaluate(
        &self,
        chunk: &SweepChunk,
        is_stopped: &(dyn Fn() -> bool + Sync),
    ) -> Option<TypedColumns> {
        let has_names = chunk.designs.iter().any(|one| one.name.is_some());
        let name = has_names.then_some("name");
        let design = DesignSummary::columns().iter().copied();
        let metrics = self.metrics.iter().map(String::as_str);
        let names = name.into_iter().chain(design).chain(metrics);
        let columns = names.map(|name| (name.to_owned(), ColumnKind::of(name)));
        let columns: Vec<(String, ColumnKind)> = columns.collect();
        let row = |one: &SweptDesign| {
            if is_stopped() {
                return None;
            }
            let own = has_names.then(|| Value::from(one.name.as_deref()));
            Some(own.into_iter().chain(self.row(one, chunk.source)).collect())
        };
        let rows: Option<Vec<Vec<Value>>> = chunk.designs.par_iter().map(row).collect();
        Some(TypedColumns::new(&columns, &rows?))
    }

    /// The cells of a design: its fields, then its metrics.
    fn row(&self, one: &SweptDesign, source: SweepSource) -> Vec<Value> {
        let design: Option<Design> = one.notation.parse().ok();
        let metrics = match (source, &design) {
            (SweepSource::Space, design) => self.problem.metrics(design.as_ref()),
            (SweepSource::List, Some(design)) => {
                self.problem.judged(design).map(|(metrics, _)| metrics)
            }
            (SweepSource::List, None) => None,
        };
        let summary = design.as_ref().map(DesignSummary::from);
        // A summary of numbers and texts is always written.
        let summary = serde_json::to_value(summary).unwrap_or_default();
        let field = |name: &&str| summary.get(name).cloned().unwrap_or(Value::Null);
        let fields = DesignSummary::columns().iter().map(field);
        fields.chain(self.metric_cells(metrics.as_ref())).collect()
    }

    fn metric_cells(&self, metrics: Option<&Metrics>) -> Vec<Value> {
        let found = metrics.and_then(|metrics| metric_values(metrics).ok());
        let found = found.unwrap_or_default();
        let value = |name: &String| {
            let same = found.iter().find(|(one, _)| one == name);
            same.map_or(Value::Null, |(_, value)| value.clone())
        };
        self.metrics.iter().map(value).collect()
    }
}
