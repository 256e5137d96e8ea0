//! `BroydenBAS`.

use ikcore::solver::BroydenBas;
use ikcore::tracking::Controller;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::control::PyControlSession;
use crate::convert::count;
use crate::error::raise;
use crate::limits::PyLimits;

/// Antenna differences as secants: f(q + antenna) - f(q) is a column of the Jacobian, and every step made is an antenna
/// too (Broyden 1965). It needs what the tip did, not a model.
///
/// As the controller of `track_model_free` it is the one to choose: the Jacobian estimate is carried along the path, and
/// antennae are put out again where steps stop predicting. A measurement that surprises is asked for again before it is
/// believed, so that noise and outliers of the sensor do no harm. As a solver, in `solve` and `track`, it serves
/// where residuals are cheap and a Jacobian is not; `LevenbergMarquardt` needs fewer evaluations.
///
/// Defaults: `BroydenBAS(antenna_length=0.01, max_evaluations_per_step=20, sensor_delay=0)`.
///
/// Args:
///     antenna_length: of the controller's antennae (rad, m): well above the noise of the sensor once the arm has levered
///         it up. A solver, without noise to be afraid of, uses 1e-6.
///     max_evaluations_per_step: measurements after which a step of a path ends; 1: one command a tick.
///     sensor_delay: measurements by which the plant's sensor is late: every command is sent so many times more, and the
///         last answer counts.
#[pyclass(name = "BroydenBAS", module = "beetle_ik", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub struct PyBroydenBas(pub BroydenBas);

#[pymethods]
impl PyBroydenBas {
    #[new]
    #[pyo3(signature = (*, antenna_length=BroydenBas::default().antenna_length, max_evaluations_per_step=20, sensor_delay=0))]
    fn new(antenna_length: f64, max_evaluations_per_step: i128, sensor_delay: i128) -> PyResult<Self> {
        let broyden = BroydenBas {
            antenna_length,
            max_evaluations_per_step: count("max_evaluations_per_step", max_evaluations_per_step)?,
            sensor_delay: count("sensor_delay", sensor_delay)?,
        };
        broyden.validate().map_err(raise)?;
        Ok(Self(broyden))
    }

    /// Length of the controller's antennae (rad, m).
    #[getter]
    fn antenna_length(&self) -> f64 {
        self.0.antenna_length
    }

    /// Measurements after which a step ends.
    #[getter]
    fn max_evaluations_per_step(&self) -> usize {
        self.0.max_evaluations_per_step
    }

    /// Measurements by which the sensor is late.
    #[getter]
    fn sensor_delay(&self) -> usize {
        self.0.sensor_delay
    }

    /// The controller at work in your own loop, from `start` (n,) and t = 0: see `ControlSession`.
    #[pyo3(signature = (start, *, dt, limits=None, position_tolerance=1e-9, seed=0))]
    fn session(
        &self,
        start: &Bound<'_, PyAny>,
        dt: f64,
        limits: Option<&PyLimits>,
        position_tolerance: f64,
        seed: i128,
    ) -> PyResult<PyControlSession> {
        PyControlSession::new(&Controller::BroydenBas(self.0), start, dt, limits, position_tolerance, seed)
    }

    fn __repr__(&self) -> String {
        let BroydenBas { antenna_length, max_evaluations_per_step, sensor_delay } = self.0;
        format!(
            "BroydenBAS(antenna_length={antenna_length}, max_evaluations_per_step={max_evaluations_per_step}, \
             sensor_delay={sensor_delay})"
        )
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        let options = PyDict::new(py);
        options.set_item("antenna_length", self.0.antenna_length)?;
        options.set_item("max_evaluations_per_step", self.0.max_evaluations_per_step)?;
        options.set_item("sensor_delay", self.0.sensor_delay)?;
        Ok((PyTuple::empty(py), options))
    }
}
