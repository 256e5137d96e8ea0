//! `NewtonRaphson`.

use ikcore::solver::NewtonRaphson;
use pyo3::prelude::*;

use crate::error::raise;
use crate::options::options;

/// Newton-Raphson with the pseudo-inverse of the Jacobian, inside the limits. It converges fast from a start near a
/// solution; from others it may jump around until its budget is spent.
///
/// Defaults: `NewtonRaphson(step_fraction=1.0)`.
///
/// Args:
///     step_fraction: fraction of the full step to take, above 0 and at most 1.
#[pyclass(name = "NewtonRaphson", module = "beetle_ik", frozen, eq, from_py_object)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyNewtonRaphson(pub NewtonRaphson);

#[pymethods]
impl PyNewtonRaphson {
    #[new]
    #[pyo3(signature = (*, step_fraction=NewtonRaphson::default().step_fraction))]
    fn new(step_fraction: f64) -> PyResult<Self> {
        let solver = NewtonRaphson { step_fraction };
        solver.validate().map_err(raise)?;
        Ok(Self(solver))
    }
}

options! {
    PyNewtonRaphson, "NewtonRaphson" {
        /// Fraction of the full step to take.
        step_fraction: f64,
    }
}
