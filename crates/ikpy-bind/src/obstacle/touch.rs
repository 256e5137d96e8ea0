//! Reading of links that an obstacle may touch.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

use crate::convert::{optional_texts, summary};
use crate::error::invalid;

/// Names of links that may touch something, as passed from Python.
pub type Touch = Option<Vec<String>>;

/// Reads names of links that may touch something.
pub fn read_touch(value: &Bound<'_, PyAny>) -> PyResult<Touch> {
    let wrong = || invalid(format!("touch must be a list of link names, got {}", summary(value)));
    let named = |error: PyErr| if error.is_instance_of::<PyTypeError>(value.py()) { wrong() } else { error };
    optional_texts(value).map_err(named)
}
