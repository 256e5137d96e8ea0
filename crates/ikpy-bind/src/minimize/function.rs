//! The user's function as an objective.

use std::cell::RefCell;

use ikcore::objective::{CallPattern, Objective, Score};
use ikcore::solver::Monitor;
use numpy::{PyArray1, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::PyException;
use pyo3::intern;
use pyo3::prelude::*;

use crate::convert::{array, shape_text, summary};
use crate::error::invalid;
use crate::monitor::Watcher;

/// Exception raised by the function or by a signal; the search ends at the next check of the monitor.
pub type Failure = RefCell<Option<PyErr>>;

/// Objective function written in Python.
pub struct Function<'py, 'f> {
    pub function: Bound<'py, PyAny>,
    pub dimension: usize,
    pub vectorized: bool,
    pub failure: &'f Failure,
}

impl Function<'_, '_> {
    /// Returns the values, or stores the exception and returns None.
    fn kept<T>(&self, values: PyResult<T>) -> Option<T> {
        values.map_err(|error| *self.failure.borrow_mut() = Some(error)).ok()
    }

    fn value_at(&self, x: &[f64]) -> PyResult<f64> {
        let value = self.function.call1((PyArray1::from_slice(self.function.py(), x),))?;
        number(&value)
    }

    fn values_at(&self, xs: &[f64], out: &mut [Score]) -> PyResult<()> {
        let points = PyArray1::from_slice(self.function.py(), xs).reshape([out.len(), self.dimension])?;
        let values = self.function.call1((points,))?;
        if is_complex(&values)? {
            let got = summary(&values);
            return Err(invalid(format!("function must return {} real numbers, got {got}", out.len())));
        }
        let values = array("the function's values", &values)?;
        if values.shape() != [out.len()] {
            let (expected, got) = (shape_text(&[out.len()]), shape_text(values.shape()));
            return Err(invalid(format!("vectorized function must return shape {expected}, got {got}")));
        }
        for (score, value) in out.iter_mut().zip(values.as_slice()?) {
            score.value = *value;
        }
        Ok(())
    }
}

impl Objective for Function<'_, '_> {
    fn dimension(&self) -> usize {
        self.dimension
    }

    /// Checks the monitor after each evaluation, which costs nothing beside a Python call.
    fn call_pattern(&self) -> CallPattern {
        CallPattern { batch_size: if self.vectorized { usize::MAX } else { 1 }, poll_interval: 1 }
    }

    fn evaluate(&mut self, x: &[f64]) -> Score {
        let mut score = [Score { value: f64::NAN, solved: false }];
        self.evaluate_all(x, &mut score);
        score[0]
    }

    fn evaluate_all(&mut self, xs: &[f64], out: &mut [Score]) {
        out.fill(Score { value: f64::NAN, solved: false });
        if self.vectorized {
            self.kept(self.values_at(xs, out));
            return;
        }
        for (x, score) in xs.chunks_exact(self.dimension).zip(out) {
            match self.kept(self.value_at(x)) {
                Some(value) => score.value = value,
                None => return,
            }
        }
    }
}

/// Whether this is a complex number of numpy or Python, which would lose its imaginary part.
fn is_complex(value: &Bound<'_, PyAny>) -> PyResult<bool> {
    let py = value.py();
    let numpy = py.import(intern!(py, "numpy"))?;
    numpy.call_method1(intern!(py, "iscomplexobj"), (value,))?.extract()
}

/// Reads the function's return value: a float, or any zero-dimensional number.
fn number(value: &Bound<'_, PyAny>) -> PyResult<f64> {
    if let Ok(number) = value.cast_exact::<pyo3::types::PyFloat>() {
        return Ok(number.value());
    }
    let no_number = || invalid(format!("function must return a real number, got {}", summary(value)));
    let dimensions = value.getattr(intern!(value.py(), "ndim")).and_then(|ndim| ndim.extract::<usize>()).unwrap_or(0);
    if value.is_none() || dimensions > 0 || is_complex(value)? {
        return Err(no_number());
    }
    value
        .extract::<f64>()
        .map_err(|error| if error.is_instance_of::<PyException>(value.py()) { no_number() } else { error })
}

/// Monitor that ends the search after an exception of the function, or on Ctrl-C.
pub struct Attendant<'f> {
    pub watcher: &'f mut Watcher,
    pub failure: &'f Failure,
}

impl Monitor for Attendant<'_> {
    fn keep_going(&mut self) -> bool {
        self.failure.borrow().is_none() && self.watcher.keep_going()
    }

    fn progress(&mut self, done: usize, total: usize) {
        self.watcher.progress(done, total);
    }
}
