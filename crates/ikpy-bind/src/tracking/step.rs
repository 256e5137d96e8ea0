//! `Step`.

use std::time::Duration;

use ikcore::stored::{from_bytes, to_bytes};
use ikcore::tracking::Step;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;

use crate::convert::row;
use crate::error::raise;
use crate::limits::PyLimits;
use crate::outcome::outcome;
use crate::pickling::{self, Reduced};
use crate::traversal::traversed;

/// The result of one step of a `Tracker` or a `ControlSession`.
#[pyclass(name = "Step", module = "beetle_ik", frozen)]
pub struct PyStep {
    core: Step,
    /// The configuration to command (n,) (rad, m).
    #[pyo3(get)]
    q: Py<PyArray1<f64>>,
    /// The joint velocity over the step (n,) (rad/s, m/s).
    #[pyo3(get)]
    qd: Py<PyArray1<f64>>,
    /// The limits in force.
    #[pyo3(get)]
    limits: Py<PyLimits>,
    elapsed: Duration,
}

traversed!(PyStep: limits);

outcome! {
    PyStep = |result|
    /// Whether the tip is within the tolerances.
    success,
    /// SOLVED within the tolerances, IMPROVED nearer than in the previous step, otherwise CAPPED.
    status: result.core.status,
    message: result.core.message(),
    /// Evaluations of the forward kinematics.
    evaluations: result.core.evaluations,
    elapsed: result.elapsed,
}

#[pymethods]
impl PyStep {
    /// Distance of the tip from the target (m).
    #[getter]
    fn position_error(&self) -> f64 {
        self.core.error.position
    }

    /// Geodesic angle to the target's orientation (rad); NaN if the task leaves the orientation free.
    #[getter]
    fn rotation_error(&self) -> f64 {
        self.core.error.rotation
    }

    /// False if a joint cannot be brought within its position limits, or slowed down to its velocity limit, in this step.
    #[getter]
    fn inside_limits(&self) -> bool {
        self.core.inside_limits
    }

    fn __repr__(&self) -> String {
        format!("<Step {}: {}>", self.core.status.name(), self.core.message())
    }
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let (q, qd) = (self.q.bind(py).readonly(), self.qd.bind(py).readonly());
        let state = (self.core, q.as_slice()?, qd.as_slice()?, self.elapsed);
        pickling::restored_from::<Self>(py, (pickling::bytes(py, to_bytes("step", &state))?, &self.limits))
    }

    /// Restores a pickled value.
    #[staticmethod]
    fn _restore(py: Python<'_>, bytes: &[u8], limits: Py<PyLimits>) -> PyResult<Self> {
        let (core, q, qd, elapsed): (_, Vec<f64>, Vec<f64>, _) = from_bytes("step", bytes).map_err(raise)?;
        Ok(Self::new(py, core, [q, qd], limits, elapsed))
    }
}

impl PyStep {
    /// `motion`: the configuration to command and the joint velocity over the step.
    pub fn new(py: Python<'_>, core: Step, motion: [Vec<f64>; 2], limits: Py<PyLimits>, elapsed: Duration) -> Self {
        let [q, qd] = motion.map(|values| row(py, values).unbind());
        Self { core, q, qd, limits, elapsed }
    }
}
