//! `MoveReport` and `SpeedBound`.

use ikcore::planning::{MoveReport, SpeedBound};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::pickling::stored_value;

/// Report on a move of a program.
#[pyclass(name = "MoveReport", module = "beetle_ik", frozen, eq)]
#[derive(Debug, PartialEq)]
pub struct PyMoveReport(pub MoveReport);

#[pymethods]
impl PyMoveReport {
    /// Name of the move, or None.
    #[getter]
    fn name(&self) -> Option<&str> {
        self.0.name.as_deref()
    }

    /// When it starts (s). A blend belongs to its two moves by halves of its length.
    #[getter]
    fn start(&self) -> f64 {
        self.0.start
    }

    /// When it ends (s).
    #[getter]
    fn end(&self) -> f64 {
        self.0.end
    }

    /// Largest speed of the tip on it (m/s), between its blends; of a turn on the spot 0.1 m for each radian.
    #[getter]
    fn speed(&self) -> f64 {
        self.0.speed
    }

    /// Limits that kept the tip more than 0.1 % below the requested speed, between the blends of the move, a tuple of `SpeedBound`, in
    /// order of time; empty where it had that speed throughout, and where none is asked for.
    #[getter]
    fn bound_by<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.0.bound_by.iter().cloned().map(PySpeedBound))
    }

    /// The motion of the tip on it, in words: its speed between blends, that the blends take the whole move, or that the arm rests.
    #[getter]
    fn message(&self) -> String {
        self.0.message()
    }

    fn __repr__(&self) -> String {
        let MoveReport { name, start, end, bound_by, .. } = &self.0;
        let name = name.as_ref().map_or_else(String::new, |name| format!(" '{name}'"));
        let bound: Vec<String> = bound_by.iter().map(words).collect();
        let bound = if bound.is_empty() { String::new() } else { format!(", bound by {}", bound.join(", ")) };
        format!("<MoveReport{name}: {start:.3} to {end:.3} s, {}{bound}>", self.0.message())
    }
}

stored_value!(PyMoveReport, "report of a move");

/// A limit that keeps the tip below the speed asked for.
#[pyclass(name = "SpeedBound", module = "beetle_ik", frozen, eq)]
#[derive(Debug, Clone, PartialEq)]
pub struct PySpeedBound(pub SpeedBound);

#[pymethods]
impl PySpeedBound {
    /// The limit: "velocity", "acceleration" or "jerk" of a joint, "tip speed", "tip acceleration" or "tip turn speed".
    #[getter]
    fn limit(&self) -> &str {
        &self.0.limit
    }

    /// Name of the joint, or of the tip.
    #[getter]
    fn of(&self) -> &str {
        &self.0.of
    }

    /// From when (s).
    #[getter]
    fn start(&self) -> f64 {
        self.0.start
    }

    /// Until when (s).
    #[getter]
    fn end(&self) -> f64 {
        self.0.end
    }

    fn __repr__(&self) -> String {
        format!("<SpeedBound: {}>", words(&self.0))
    }
}

stored_value!(PySpeedBound, "bound of a speed");

fn words(SpeedBound { limit, of, start, end }: &SpeedBound) -> String {
    format!("{limit} of '{of}' from {start:.3} to {end:.3} s")
}
