//! Tables as columns: to NumPy, and by the Arrow C stream interface.

use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{
    ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, RecordBatchIterator, StringArray,
};
use arrow_schema::{ArrowError, DataType, Field, Schema};
use navwalker::run::typed_columns::{ColumnValues, TypedColumns};
use numpy::PyArray1;
use pyo3::exceptions::{PyKeyError, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyList};
use std::sync::Arc;

/// Named columns of one length.
#[pyclass(frozen, module = "navwalker._native")]
#[derive(Clone)]
pub(crate) struct Columns(TypedColumns);

impl Columns {
    pub(crate) fn new(table: TypedColumns) -> Self {
        Self(table)
    }

    /// The columns of a CSV that the program writes.
    pub(crate) fn read(text: &str) -> Result<Self, csv::Error> {
        TypedColumns::of_csv(text).map(Self)
    }

    fn batch(&self) -> Result<RecordBatch, ArrowError> {
        use ColumnValues::{Integer, Real, Text, Truth};
        let array = |values: &ColumnValues| -> (ArrayRef, DataType) {
            match values {
                Real(of) => (Arc::new(Float64Array::from(of.clone())), DataType::Float64),
                Integer(of) => (Arc::new(Int64Array::from(of.clone())), DataType::Int64),
                Truth(of) => (Arc::new(BooleanArray::from(of.clone())), DataType::Boolean),
                Text(of) => (Arc::new(StringArray::from(of.clone())), DataType::Utf8),
            }
        };
        let (arrays, types): (Vec<_>, Vec<_>) = self.0.values().iter().map(array).unzip();
        let fields = self.0.names().iter().zip(types);
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
        self.0.names().to_vec()
    }

    #[getter]
    fn rows(&self) -> usize {
        self.0.rows()
    }

    /// A column as an array; missing numbers are NaN, missing texts None.
    fn column<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let found = self.0.get(name);
        let found = found.ok_or_else(|| PyKeyError::new_err(name.to_owned()))?;
        Ok(match found {
            ColumnValues::Real(of) => {
                let all = of.iter().map(|value| value.unwrap_or(f64::NAN));
                PyArray1::from_iter(py, all).into_any()
            }
            ColumnValues::Integer(of) if of.iter().all(Option::is_some) => {
                PyArray1::from_iter(py, of.iter().flatten().copied()).into_any()
            }
            ColumnValues::Integer(of) => {
                let all = of
                    .iter()
                    .map(|value| value.map_or(f64::NAN, |one| one as f64));
                PyArray1::from_iter(py, all).into_any()
            }
            ColumnValues::Truth(of) => {
                let all = of.iter().map(|value| value.unwrap_or(false));
                PyArray1::from_iter(py, all).into_any()
            }
            ColumnValues::Text(of) => {
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
