//! The product's errors as Python exceptions: the same sentences as the command line's.

use evaluation::sentence::sentence;
use pyo3::create_exception;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

create_exception!(
    vodca,
    Error,
    PyValueError,
    "What was asked for cannot be done. The message names the place and the value, and says what is allowed."
);

/// `error` and what caused it, as an exception.
pub(crate) fn refused(error: impl std::error::Error) -> PyErr {
    Error::new_err(sentence(&error))
}

/// An exception with this message.
pub(crate) fn wrong(message: impl Into<String>) -> PyErr {
    Error::new_err(message.into())
}
