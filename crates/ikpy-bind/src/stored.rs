//! How values pickle: `__reduce__` says which static method restores them, and from what.

use pyo3::call::PyCallArgs;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use pyo3::{IntoPyObject, PyTypeInfo};

use crate::error::raise;

/// What `__reduce__` returns: the class's `_restore`, and its arguments.
pub type Reduced<'py, A> = (Bound<'py, PyAny>, A);

/// `T._restore(*arguments)`.
pub fn restored_from<'py, T, A>(py: Python<'py>, arguments: A) -> PyResult<Reduced<'py, A>>
where
    T: PyTypeInfo,
    A: IntoPyObject<'py> + PyCallArgs<'py>,
{
    Ok((py.get_type::<T>().getattr("_restore")?, arguments))
}

/// The byte form of a value of the core.
pub fn bytes(py: Python<'_>, stored: ikcore::Result<Vec<u8>>) -> PyResult<Bound<'_, PyBytes>> {
    Ok(PyBytes::new(py, &stored.map_err(raise)?))
}
