//! NumPy-style indexing of result sequences.

use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyIndexError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyIterator;

use crate::convert::summary;

/// Items selected by an index.
pub enum Selection {
    /// One item.
    One(usize),
    /// Several, in this order.
    Many(Vec<usize>),
}

/// Resolves an index into `len` items: an integer (negative counts from the end), or any index of a one-dimensional numpy
/// array: a slice, a mask, a list of integers. `what` names the sequence in errors.
pub fn select(what: &str, index: &Bound<'_, PyAny>, len: usize) -> PyResult<Selection> {
    let py = index.py();
    if let Ok(index) = index.extract::<isize>() {
        let from_start = if index < 0 { index.checked_add_unsigned(len) } else { Some(index) };
        let inside = from_start.and_then(|i| usize::try_from(i).ok()).filter(|i| *i < len);
        let outside = || PyIndexError::new_err(format!("index {index} is outside {what} of {len}"));
        return inside.map(Selection::One).ok_or_else(outside);
    }
    let all = py.import(intern!(py, "numpy"))?.call_method1(intern!(py, "arange"), (len,))?;
    match all.get_item(index)?.cast::<PyArray1<i64>>() {
        Ok(rows) => Ok(Selection::Many(rows.readonly().as_array().iter().map(|i| *i as usize).collect())),
        Err(_) => {
            let got = summary(index);
            Err(PyIndexError::new_err(format!(
                "{what} has one dimension: the index must be a number, slice or mask, got {got}"
            )))
        }
    }
}

/// Iterates over a sequence lazily: each item is made on demand.
pub fn iterate<'py>(sequence: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyIterator>> {
    let py = sequence.py();
    let builtins = py.import(intern!(py, "builtins"))?;
    let indices = builtins.call_method1(intern!(py, "range"), (sequence.len()?,))?;
    let item = sequence.getattr(intern!(py, "__getitem__"))?;
    builtins.call_method1(intern!(py, "map"), (item, indices))?.try_iter()
}
