//! `BroydenBAS`.

use ikcore::solver::BroydenBas;
use ikcore::tracking::Controller;
use pyo3::prelude::*;

use crate::convert::count;
use crate::error::raise;
use crate::options::options;

/// A quasi-Newton method that uses antenna differences as secants: f(q + antenna) - f(q) estimates a column of the
/// Jacobian, and each step made is another secant (Broyden 1965). It needs measurements of the tip, not a model.
///
/// It is the recommended controller for `track_model_free`: it updates its Jacobian estimate along the path, and
/// estimates columns anew when the predictions of steps become wrong. An unexpected measurement is repeated before it is
/// used, which makes the controller robust against noise and outliers of the sensor. As a solver, in `solve` and `track`,
/// it suits problems with cheap residuals and no Jacobian; `LevenbergMarquardt` needs fewer evaluations.
///
/// With poses, the residual has six rows, the distance (m) and the rotation vector (rad): a radian counts as much as a metre,
/// also for the noise of the sensor.
///
/// Defaults: `BroydenBAS(antenna_length=0.01, max_evaluations_per_step=20, sensor_delay=0)`.
///
/// Args:
///     antenna_length: length of the controller's antennae (rad, m). The tip displacement that they cause should be well
///         above the noise of the sensor. As a solver, without noise, it uses 1e-6.
///     max_evaluations_per_step: measurements per step of a path; 1: one command per tick.
///     sensor_delay: delay of the plant's sensor, in measurements. Each command is repeated this many times, and the last
///         measurement counts.
#[pyclass(name = "BroydenBAS", module = "beetle_ik", frozen, eq, from_py_object)]
#[derive(Debug, Clone, PartialEq)]
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
}

options! {
    PyBroydenBas, "BroydenBAS" {
        /// Length of the controller's antennae (rad, m).
        antenna_length: f64,
        /// Measurements per step.
        max_evaluations_per_step: usize,
        /// Delay of the sensor, in measurements.
        sensor_delay: usize,
    }
}

impl PyBroydenBas {
    pub fn controller(&self) -> Controller {
        Controller::BroydenBas(self.0)
    }
}
