//! `Violation`.

use ikcore::planning::Violation;
use pyo3::prelude::*;

use crate::pickling::stored_value;

/// A bound that a planned trajectory exceeds; `str` describes it in words.
#[pyclass(name = "Violation", module = "beetle_ik", frozen, eq)]
#[derive(Debug, PartialEq)]
pub struct PyViolation(pub Violation);

#[pymethods]
impl PyViolation {
    /// The quantity that exceeds the bound, for example "velocity of joint 'elbow'".
    #[getter]
    fn what(&self) -> &str {
        &self.0.what
    }

    /// Largest value on the trajectory, in `unit`.
    #[getter]
    fn value(&self) -> f64 {
        self.0.value
    }

    /// The bound, in `unit`.
    #[getter]
    fn bound(&self) -> f64 {
        self.0.bound
    }

    /// Unit of value and bound, for example "rad/s".
    #[getter]
    fn unit(&self) -> &str {
        &self.0.unit
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }

    fn __repr__(&self) -> String {
        format!("<Violation: {}>", self.0)
    }
}

stored_value!(PyViolation, "violation");
