//! Metrics as Python has them.

use crate::errors::NavwalkerError;
use navwalker::evaluate::Metrics;
use navwalker::run::metric_values;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::Value;

/// Metrics as a dictionary; a metric without a value is None.
pub(crate) fn dictionary<'py>(py: Python<'py>, metrics: &Metrics) -> PyResult<Bound<'py, PyDict>> {
    let dictionary = PyDict::new(py);
    let values =
        metric_values(metrics).map_err(|error| NavwalkerError::new_err(error.to_string()))?;
    for (name, value) in values {
        match value {
            Value::Bool(truth) => dictionary.set_item(name, truth)?,
            Value::Number(number) => match number.as_i64() {
                Some(whole) if name == "least_visible" => dictionary.set_item(name, whole)?,
                _ => dictionary.set_item(name, number.as_f64())?,
            },
            _ => dictionary.set_item(name, py.None())?,
        }
    }
    Ok(dictionary)
}
