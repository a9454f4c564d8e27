//! The exceptions, with the messages of the program.

use navwalker::cli::embedded::{MessageKind, Transcript, error_text};
use pyo3::create_exception;
use pyo3::exceptions::{PyUserWarning, PyValueError};
use pyo3::prelude::*;
use std::ffi::CString;

create_exception!(
    navwalker,
    NavwalkerError,
    PyValueError,
    "What navwalker cannot do, and why."
);
create_exception!(
    navwalker,
    ScenarioError,
    NavwalkerError,
    "A scenario with an unknown key, a wrong value or a file that cannot be read."
);
create_exception!(
    navwalker,
    DesignError,
    NavwalkerError,
    "A constellation that cannot be: a wrong notation, an orbit that cannot be propagated, an unknown satellite."
);
create_exception!(
    navwalker,
    FileError,
    NavwalkerError,
    "A file that cannot be read or written."
);

create_exception!(
    navwalker,
    NavwalkerWarning,
    PyUserWarning,
    "What may be wrong in a result."
);

/// Gives the warnings among what was printed as warnings of Python; hints are of the terminal.
pub(crate) fn warn(py: Python<'_>, printed: &Transcript) -> PyResult<()> {
    let category = py.get_type::<NavwalkerWarning>();
    for message in &printed.messages {
        if message.kind == MessageKind::Warning {
            let text = CString::new(message.text.replace('\0', " "))?;
            PyErr::warn(py, &category, &text, 2)?;
        }
    }
    Ok(())
}

/// An error of a scenario.
pub(crate) fn scenario(error: &anyhow::Error) -> PyErr {
    ScenarioError::new_err(error_text(error))
}

/// An error of a scenario, with what Python has in place of flags.
pub(crate) fn refused(error: &anyhow::Error) -> PyErr {
    let flags = "--allow-large, or evaluate --tile I/N";
    ScenarioError::new_err(error_text(error).replace(flags, "evaluate(…, tiles=N)"))
}

/// An error of a constellation.
pub(crate) fn design(error: &anyhow::Error) -> PyErr {
    DesignError::new_err(error_text(error))
}

/// An error of a file.
pub(crate) fn file(error: &anyhow::Error) -> PyErr {
    FileError::new_err(error_text(error))
}
