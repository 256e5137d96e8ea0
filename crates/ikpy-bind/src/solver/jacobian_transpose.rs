//! `JacobianTranspose`.

use ikcore::solver::{JacobianTranspose, StepSize};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict, PyTuple};

use crate::error::raise;
use crate::solver::rate::{Rate, number_or_auto};

/// Jacobian transpose: the steepest descent on the squared error, on the box of the limits. No inverse, so that singular
/// configurations do no harm; many small steps instead.
///
/// Args:
///     step_size: how far a step goes along the transposed Jacobian times the error; "auto": where the linearised error
///         is smallest (Buss 2004).
#[pyclass(name = "JacobianTranspose", module = "beetle_ik", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
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

    /// How far a step goes, or "auto".
    #[getter]
    fn step_size(&self) -> Rate {
        Rate::from(match self.0.step_size {
            StepSize::Auto => None,
            StepSize::Fixed(size) => Some(size),
        })
    }

    fn __repr__(&self) -> String {
        format!("JacobianTranspose(step_size={})", self.step_size())
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        Ok((PyTuple::empty(py), [("step_size", self.step_size())].into_py_dict(py)?))
    }
}
