//! Pickling: `__reduce__` returns the static method that restores a value, and its arguments.

use pyo3::PyTypeInfo;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};

use crate::error::raise;

/// The result of `__reduce__`: the class's `_restore`, and its arguments.
pub type Reduced<'py> = (Bound<'py, PyAny>, Bound<'py, PyTuple>);

/// Makes the result of `__reduce__` for `T._restore(*arguments)`.
pub fn restored_from<'py, T: PyTypeInfo>(
    py: Python<'py>,
    arguments: impl IntoPyObject<'py, Target = PyTuple, Output = Bound<'py, PyTuple>, Error: Into<PyErr>>,
) -> PyResult<Reduced<'py>> {
    Ok((py.get_type::<T>().getattr("_restore")?, arguments.into_pyobject(py).map_err(Into::into)?))
}

/// Converts the byte form of a core value to Python bytes.
pub fn bytes(py: Python<'_>, stored: ikcore::Result<Vec<u8>>) -> PyResult<Bound<'_, PyBytes>> {
    Ok(PyBytes::new(py, &stored.map_err(raise)?))
}

/// The error of `__reduce__` of a loop in progress, an object of this class; `another` says how to make one like it.
pub fn in_progress(class: &str, another: &str) -> PyErr {
    PyTypeError::new_err(format!(
        "a {class} is a loop in progress, which cannot be pickled or copied: keep its arguments and {another}"
    ))
}

/// Gives a frozen class that wraps one core value its hash and its pickling; `what` names it in the error of bytes that are no such value.
macro_rules! stored_value {
    ($class:ident, $what:literal) => {
        #[pymethods]
        impl $class {
            fn __hash__(&self) -> u64 {
                $crate::hash::content_hash(self)
            }

            fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<$crate::pickling::Reduced<'py>> {
                let stored = $crate::pickling::bytes(py, ikcore::stored::to_bytes($what, &self.0))?;
                $crate::pickling::restored_from::<Self>(py, (stored,))
            }

            /// Restores a pickled value.
            #[staticmethod]
            fn _restore(bytes: &[u8]) -> PyResult<Self> {
                ikcore::stored::from_bytes($what, bytes).map(Self).map_err($crate::error::raise)
            }
        }
    };
}

pub(crate) use stored_value;
