//! `BroydenBAS`.

use ikcore::solver::BroydenBas;
use ikcore::tracking::Controller;
use pyo3::prelude::*;

use crate::convert::count;
use crate::error::raise;
use crate::options::options;

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
        /// Measurements after which a step ends.
        max_evaluations_per_step: usize,
        /// Measurements by which the sensor is late.
        sensor_delay: usize,
    }
}

impl PyBroydenBas {
    pub fn controller(&self) -> Controller {
        Controller::BroydenBas(self.0)
    }
}
