//! How values pickle: `__reduce__` says which static method restores them, and from what.

use pyo3::PyTypeInfo;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};

use crate::error::raise;

/// What `__reduce__` returns: the class's `_restore`, and its arguments.
pub type Reduced<'py> = (Bound<'py, PyAny>, Bound<'py, PyTuple>);

/// `T._restore(*arguments)`.
pub fn restored_from<'py, T: PyTypeInfo>(
    py: Python<'py>,
    arguments: impl IntoPyObject<'py, Target = PyTuple, Output = Bound<'py, PyTuple>, Error: Into<PyErr>>,
) -> PyResult<Reduced<'py>> {
    Ok((py.get_type::<T>().getattr("_restore")?, arguments.into_pyobject(py).map_err(Into::into)?))
}

/// The byte form of a value of the core.
pub fn bytes(py: Python<'_>, stored: ikcore::Result<Vec<u8>>) -> PyResult<Bound<'_, PyBytes>> {
    Ok(PyBytes::new(py, &stored.map_err(raise)?))
}
