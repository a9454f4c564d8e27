//! Tables as columns: to NumPy, and by the Arrow C stream interface.

use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{
    ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, RecordBatchIterator, StringArray,
};
use arrow_schema::{ArrowError, DataType, Field, Schema};
use numpy::PyArray1;
use pyo3::exceptions::{PyKeyError, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyList};
use serde_json::Value;
use std::sync::Arc;

/// The values of a column; `None` is a missing one.
#[derive(Clone)]
enum Values {
    Real(Vec<Option<f64>>),
    Integer(Vec<Option<i64>>),
    Truth(Vec<Option<bool>>),
    Text(Vec<Option<String>>),
}

/// What a column holds.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Real,
    Integer,
    Truth,
    Text,
}

/// Columns of whole numbers, by their names in the tables of the program.
const INTEGERS: [&str; 12] = [
    "evaluations",
    "feasible",
    "front_size",
    "generation",
    "index",
    "least_visible",
    "outages",
    "phasing",
    "planes",
    "satellites",
    "satellites_per_plane",
    "seed",
];

/// Columns of truth values.
const TRUTHS: [&str; 3] = ["chosen", "longest_outage_cut", "outage_cut"];

/// Columns of texts.
const TEXTS: [&str; 6] = ["design", "error", "files", "name", "notation", "pattern"];

impl Kind {
    /// The kind of a column of the program's tables, by its name.
    pub(crate) fn of(name: &str) -> Self {
        match name {
            _ if INTEGERS.contains(&name) => Self::Integer,
            _ if TRUTHS.contains(&name) => Self::Truth,
            _ if TEXTS.contains(&name) => Self::Text,
            _ => Self::Real,
        }
    }
}

/// Cells of a kind; numbers that cannot be read as such make a column of texts.
fn typed(kind: Kind, cells: Vec<Option<String>>) -> Values {
    fn all<T: std::str::FromStr>(cells: &[Option<String>]) -> Option<Vec<Option<T>>> {
        let parsed = |cell: &Option<String>| match cell {
            Some(text) => text.parse().map(Some).ok(),
            None => Some(None),
        };
        cells.iter().map(parsed).collect()
    }
    let found = match kind {
        Kind::Integer => all(&cells).map(Values::Integer),
        Kind::Real => all(&cells).map(Values::Real),
        Kind::Truth => all(&cells).map(Values::Truth),
        Kind::Text => None,
    };
    found.unwrap_or(Values::Text(cells))
}

/// Named columns of one length.
#[pyclass(frozen, module = "navwalker._native")]
#[derive(Clone)]
pub(crate) struct Columns {
    names: Vec<String>,
    values: Vec<Values>,
    rows: usize,
}

impl Columns {
    /// Columns of these names and kinds; a row has a value for each, null where it is missing.
    pub(crate) fn new(columns: Vec<(String, Kind)>, rows: &[Vec<Value>]) -> Self {
        let column = |(place, (_, kind)): (usize, &(String, Kind))| {
            let cells = rows
                .iter()
                .map(|row| row.get(place).unwrap_or(&Value::Null));
            match kind {
                Kind::Real => Values::Real(cells.map(Value::as_f64).collect()),
                Kind::Integer => Values::Integer(cells.map(Value::as_i64).collect()),
                Kind::Truth => Values::Truth(cells.map(Value::as_bool).collect()),
                Kind::Text => {
                    let text = |cell: &Value| cell.as_str().map(str::to_owned);
                    Values::Text(cells.map(text).collect())
                }
            }
        };
        Self {
            values: columns.iter().enumerate().map(column).collect(),
            names: columns.into_iter().map(|(name, _)| name).collect(),
            rows: rows.len(),
        }
    }

    /// The columns of a CSV that the program writes.
    pub(crate) fn read(text: &str) -> Result<Self, csv::Error> {
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let names: Vec<String> = reader.headers()?.iter().map(str::to_owned).collect();
        let records = reader.records().collect::<Result<Vec<_>, _>>()?;
        let cell = |record: &csv::StringRecord, place: usize| -> Option<String> {
            record
                .get(place)
                .filter(|cell| !cell.is_empty())
                .map(str::to_owned)
        };
        let column = |(place, name): (usize, &String)| {
            let cells = records.iter().map(|record| cell(record, place));
            typed(Kind::of(name), cells.collect())
        };
        Ok(Self {
            values: names.iter().enumerate().map(column).collect(),
            names,
            rows: records.len(),
        })
    }

    fn batch(&self) -> Result<RecordBatch, ArrowError> {
        let array = |values: &Values| -> (ArrayRef, DataType) {
            match values {
                Values::Real(of) => (Arc::new(Float64Array::from(of.clone())), DataType::Float64),
                Values::Integer(of) => (Arc::new(Int64Array::from(of.clone())), DataType::Int64),
                Values::Truth(of) => (Arc::new(BooleanArray::from(of.clone())), DataType::Boolean),
                Values::Text(of) => (Arc::new(StringArray::from(of.clone())), DataType::Utf8),
            }
        };
        let (arrays, types): (Vec<_>, Vec<_>) = self.values.iter().map(array).unzip();
        let fields = self.names.iter().zip(types);
        let fields = fields.map(|(name, of)| Field::new(name, of, true));
        let schema = Schema::new(fields.collect::<Vec<_>>());
        RecordBatch::try_new(Arc::new(schema), arrays)
    }
}

#[pymethods]
impl Columns {
    /// The columns of a CSV that the program wrote.
    #[staticmethod]
    fn of_csv(text: &str) -> PyResult<Self> {
        Self::read(text).map_err(|error| PyRuntimeError::new_err(error.to_string()))
    }

    #[getter]
    fn names(&self) -> Vec<String> {
        self.names.clone()
    }

    #[getter]
    fn rows(&self) -> usize {
        self.rows
    }

    /// A column as an array; missing numbers are NaN, missing texts None.
    fn column<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let place = self.names.iter().position(|one| one == name);
        let place = place.ok_or_else(|| PyKeyError::new_err(name.to_owned()))?;
        Ok(match &self.values[place] {
            Values::Real(of) => {
                let all = of.iter().map(|value| value.unwrap_or(f64::NAN));
                PyArray1::from_iter(py, all).into_any()
            }
            Values::Integer(of) if of.iter().all(Option::is_some) => {
                PyArray1::from_iter(py, of.iter().flatten().copied()).into_any()
            }
            Values::Integer(of) => {
                let all = of
                    .iter()
                    .map(|value| value.map_or(f64::NAN, |one| one as f64));
                PyArray1::from_iter(py, all).into_any()
            }
            Values::Truth(of) => {
                let all = of.iter().map(|value| value.unwrap_or(false));
                PyArray1::from_iter(py, all).into_any()
            }
            Values::Text(of) => {
                let list = PyList::new(py, of)?;
                let numpy = py.import("numpy")?;
                numpy.call_method1("array", (list, "object"))?
            }
        })
    }

    /// The table as an Arrow C stream.
    #[pyo3(signature = (requested_schema = None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // Types other than those of the columns need not be served.
        let _ = requested_schema;
        let wrong = |error: ArrowError| PyRuntimeError::new_err(error.to_string());
        let batch = self.batch().map_err(wrong)?;
        let schema = batch.schema();
        let reader = RecordBatchIterator::new([Ok(batch)], schema);
        let stream = FFI_ArrowArrayStream::new(Box::new(reader));
        PyCapsule::new_with_value(py, stream, c"arrow_array_stream")
    }
}
