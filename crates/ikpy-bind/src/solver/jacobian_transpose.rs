//! `JacobianTranspose`.

use ikcore::solver::{JacobianTranspose, StepSize};
use pyo3::prelude::*;

use super::rate::number_or_auto;
use crate::error::raise;
use crate::options::options;

/// Jacobian transpose method: steepest descent on the squared error, inside the limits. It inverts nothing, so that singular
/// configurations do no harm, but takes many small steps.
///
/// Args:
///     step_size: factor of the step J^T e; "auto": the factor that minimises the linearised error (Buss 2004).
#[pyclass(name = "JacobianTranspose", module = "beetle_ik", frozen, eq, from_py_object)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyJacobianTranspose(pub JacobianTranspose);

#[pymethods]
impl PyJacobianTranspose {
    #[new]
    #[pyo3(signature = (*, step_size=None), text_signature = "(*, step_size='auto')")]
    fn new(step_size: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let size = number_or_auto("step_size", step_size)?;
        let solver = JacobianTranspose { step_size: size.map_or(StepSize::Auto, StepSize::Fixed) };
        solver.validate().map_err(raise)?;
        Ok(Self(solver))
    }
}

options! {
    PyJacobianTranspose, "JacobianTranspose" {
        /// Factor of the step J^T e, or "auto".
        step_size: StepSize,
    }
}
