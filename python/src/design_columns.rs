//! The columns of evaluated constellations, named as in CSV.

use crate::columns::Columns;
use navwalker::constellation::Design;
use navwalker::evaluate::Metrics;
use navwalker::run::typed_columns::{ColumnKind, TypedColumns};
use navwalker::run::{DesignSummary, metric_columns, metric_values};
use rayon::prelude::*;
use serde_json::Value;

/// A constellation, and its metrics or why it has none.
#[derive(Clone)]
pub(crate) struct Evaluated {
    pub(crate) name: String,
    pub(crate) design: Option<Design>,
    pub(crate) satellites: usize,
    pub(crate) metrics: Result<Metrics, String>,
}

/// The table of evaluated constellations; with `errors` it has a column of them, null where there is none.
pub(crate) fn table(all: &[Evaluated], errors: bool) -> serde_json::Result<Columns> {
    let first = all.iter().find_map(|one| one.metrics.as_ref().ok());
    let metrics: Vec<String> = match first {
        Some(first) => metric_values(first)?
            .into_iter()
            .map(|(name, _)| name)
            .collect(),
        None => metric_columns().into_iter().map(str::to_owned).collect(),
    };
    let mut names = vec!["name".to_owned()];
    names.extend(
        DesignSummary::columns()
            .iter()
            .map(|name| (*name).to_owned()),
    );
    names.extend(metrics);
    if errors {
        names.push("error".to_owned());
    }
    let kinds = names
        .into_iter()
        .map(|name| (name.clone(), ColumnKind::of(&name)));
    let columns: Vec<(String, ColumnKind)> = kinds.collect();
    let rows = all.par_iter().map(|one| row(one, &columns, errors));
    let rows = rows.collect::<serde_json::Result<Vec<_>>>()?;
    Ok(Columns::new(TypedColumns::new(&columns, &rows)))
}

fn row(
    one: &Evaluated,
    columns: &[(String, ColumnKind)],
    errors: bool,
) -> serde_json::Result<Vec<Value>> {
    let mut cells = vec![Value::from(one.name.as_str())];
    let summary = one.design.as_ref().map(DesignSummary::from);
    let summary = serde_json::to_value(summary)?;
    for name in DesignSummary::columns() {
        cells.push(match *name {
            "satellites" => Value::from(one.satellites),
            name => summary.get(name).cloned().unwrap_or(Value::Null),
        });
    }
    if let Ok(metrics) = &one.metrics {
        cells.extend(metric_values(metrics)?.into_iter().map(|(_, value)| value));
    }
    cells.resize(columns.len() - usize::from(errors), Value::Null);
    if errors {
        cells.push(
            one.metrics
                .as_ref()
                .err()
                .map_or(Value::Null, |why| Value::from(why.as_str())),
        );
    }
    Ok(cells)
}
