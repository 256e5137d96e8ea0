//! `NewtonRaphson`.

use ikcore::solver::NewtonRaphson;
use pyo3::prelude::*;

use crate::error::raise;
use crate::options::options;

/// Newton-Raphson by the pseudo-inverse of the Jacobian, on the box of the limits. Very quick from a start that is near
/// enough; from others it may jump about until its budget is spent.
///
/// Defaults: `NewtonRaphson(step_fraction=1.0)`.
///
/// Args:
///     step_fraction: share of the full step that is taken, above 0 and at most 1.
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
        /// Share of the full step that is taken.
        step_fraction: f64,
    }
}
