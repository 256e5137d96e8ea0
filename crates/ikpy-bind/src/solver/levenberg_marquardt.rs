//! `LevenbergMarquardt`.

use ikcore::solver::LevenbergMarquardt;
use pyo3::prelude::*;

use crate::error::raise;
use crate::options::options;

/// Levenberg-Marquardt with the analytic Jacobian, inside the limits: joints at a bound are held, and the step is solved
/// again for the other joints.
///
/// Defaults: `LevenbergMarquardt(initial_damping=0.05)`.
///
/// Args:
///     initial_damping: initial ratio of damping to squared error; larger values take smaller steps far from the target.
#[pyclass(name = "LevenbergMarquardt", module = "beetle_ik", frozen, eq, from_py_object)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyLevenbergMarquardt(pub LevenbergMarquardt);

#[pymethods]
impl PyLevenbergMarquardt {
    #[new]
    #[pyo3(signature = (*, initial_damping=LevenbergMarquardt::default().initial_damping))]
    fn new(initial_damping: f64) -> PyResult<Self> {
        let solver = LevenbergMarquardt { initial_damping, ..LevenbergMarquardt::default() };
        solver.validate().map_err(raise)?;
        Ok(Self(solver))
    }
}

options! {
    PyLevenbergMarquardt, "LevenbergMarquardt" {
        /// Initial ratio of damping to squared error.
        initial_damping: f64,
    }
}
