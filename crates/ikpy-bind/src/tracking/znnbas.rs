//! `ZNNBAS`.

use ikcore::tracking::Controller;
use ikcore::tracking::{Antenna, Delay, UpdateRule, Znnbas};
use pyo3::prelude::*;

use crate::convert::count;
use crate::error::{invalid, raise};
use crate::hash::content_hash;
use crate::limits::PerJoint;
use crate::options::{NewArguments, keywords};

/// Zeroing neural network with beetle antennae search (Khan et al. 2022, eq. 10 to 16): a controller that measures once per
/// tick, one random antenna away from its configuration, and moves by the sign of the change in error.
///
/// It serves to reproduce the paper, and for plants that respond within a millisecond. It learns nothing, its error grows
/// with the speed of the target (about 3.5 v / (gain c1)), and its antennae shake the tool. `BroydenBAS` is better by orders
/// of magnitude in all three respects.
///
/// With poses, h is the squared distance (m^2) plus the squared angle (rad^2): a radian counts as much as a metre.
///
/// Args:
///     gain: k of eq. (14) (1/s), positive. The paper's listing has -10, the gain of a block that includes the minus sign of
///         eq. (14); here a negative gain is allowed, and diverges. gain * dt should not exceed 0.3.
///     antenna_length: lambda of eq. (10) (rad), a number or (n,); 0.1 in the paper.
///     c1: instead of antenna_length, an antenna of c1 sqrt(h), eq. (16) (rad per m), up to 0.5 rad. None for both: c1 = 0.3.
///     delay_steps: alpha of eq. (13), in ticks (10 in the paper); gain * dt * delay_steps should stay below 1.
///     delay: "sliding": the measurement delay_steps ago; "held": a measurement renewed every delay_steps ticks, as in the
///         paper's listing.
///     accept: "always": eq. (15); "improving": the algorithm in the proof of Theorem 1, in which the arm stays at an
///         antenna that is nearer and otherwise returns. It uses neither gain nor delay.
///     sensor_delay: delay of the plant's sensor, in ticks.
///
/// The paper's constants: `ZNNBAS(gain=10, antenna_length=0.1, delay_steps=10)`.
#[pyclass(name = "ZNNBAS", module = "beetle_ik", frozen, eq, from_py_object)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyZnnbas {
    core: Znnbas,
    /// The constant antenna, as given.
    antenna: Option<PerJoint>,
}

#[pymethods]
impl PyZnnbas {
    #[new]
    #[pyo3(signature = (*, gain=100.0, antenna_length=None, c1=None, delay_steps=1, delay="sliding", accept="always",
                        sensor_delay=0))]
    #[allow(clippy::too_many_arguments)]
    fn new(
        gain: f64,
        antenna_length: Option<&Bound<'_, PyAny>>,
        c1: Option<f64>,
        delay_steps: i128,
        #[pyo3(from_py_with = crate::convert::text)] delay: &str,
        #[pyo3(from_py_with = crate::convert::text)] accept: &str,
        sensor_delay: i128,
    ) -> PyResult<Self> {
        let antenna = antenna_length.map(|length| PerJoint::read("antenna_length", length)).transpose()?;
        let core = Znnbas {
            gain,
            antenna: match (&antenna, c1) {
                (Some(_), Some(_)) => {
                    let problem = "give either antenna_length, for a constant antenna, or c1, for one of c1 sqrt(h)";
                    return Err(invalid(problem.into()));
                }
                (Some(lengths), None) => Antenna::Constant(lengths.values.clone()),
                (None, Some(c1)) => Antenna::Adaptive { c1 },
                (None, None) => Znnbas::default().antenna,
            },
            delay_steps: count("delay_steps", delay_steps)?,
            delay: delay.parse::<Delay>().map_err(raise)?,
            accept: accept.parse::<UpdateRule>().map_err(raise)?,
            sensor_delay: count("sensor_delay", sensor_delay)?,
        };
        core.validate_numbers().map_err(raise)?;
        Ok(Self { core, antenna })
    }

    /// Gain k of eq. (14) (1/s).
    #[getter]
    fn gain(&self) -> f64 {
        self.core.gain
    }

    /// Constant antenna length (rad), as given; None if it follows the error.
    #[getter]
    fn antenna_length<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.antenna.as_ref().map(|numbers| numbers.show(py)).transpose()
    }

    /// Ratio of antenna length to error (rad per m); None if the antenna is constant.
    #[getter]
    fn c1(&self) -> Option<f64> {
        match self.core.antenna {
            Antenna::Adaptive { c1 } => Some(c1),
            Antenna::Constant(_) => None,
        }
    }

    /// Delay alpha of eq. (13), in ticks.
    #[getter]
    fn delay_steps(&self) -> usize {
        self.core.delay_steps
    }

    /// Kind of delay: "sliding" or "held".
    #[getter]
    fn delay(&self) -> String {
        self.core.delay.to_string()
    }

    /// Rule for accepting a position: "always" or "improving".
    #[getter]
    fn accept(&self) -> String {
        self.core.accept.to_string()
    }

    /// Delay of the sensor, in ticks.
    #[getter]
    fn sensor_delay(&self) -> usize {
        self.core.sensor_delay
    }

    fn __repr__(&self) -> String {
        let Znnbas { gain, delay_steps, delay, accept, sensor_delay, .. } = &self.core;
        let antenna = match (&self.antenna, self.c1()) {
            (Some(lengths), _) => format!("antenna_length={}", lengths.repr()),
            (None, c1) => format!("c1={:?}", c1.unwrap_or_default()),
        };
        format!(
            "ZNNBAS(gain={gain:?}, {antenna}, delay_steps={delay_steps}, delay='{delay}', accept='{accept}', \
             sensor_delay={sensor_delay})"
        )
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }

    fn __getnewargs_ex__<'py>(slf: &Bound<'py, Self>) -> PyResult<NewArguments<'py>> {
        keywords(slf, &["gain", "antenna_length", "c1", "delay_steps", "delay", "accept", "sensor_delay"])
    }
}

impl PyZnnbas {
    pub fn controller(&self) -> Controller {
        Controller::Znnbas(self.core.clone())
    }
}
