//! Reading of the `limits` argument: for the result of a call, and for the core.

use ikcore::limits::Limits;
use ikcore::units;
use pyo3::prelude::*;

use super::{PyLimits, Sampling};
use crate::convert::summary;
use crate::error::misfit;
use crate::robot::PyRobot;
use crate::units::doubt;

/// Reads a required `limits` argument.
pub fn required_limits<'a>(limits: &'a Bound<'_, PyAny>) -> PyResult<&'a PyLimits> {
    let limits = limits.cast::<PyLimits>().map_err(|_| {
        let got = summary(limits);
        misfit(format!("limits must be a Limits, such as Limits(velocity=1.5, acceleration=5.0), got {got}"))
    })?;
    Ok(limits.get())
}

/// Reads the limits of a call: the limits in force, for the result, and the given limits for the core, None without
/// any.
pub fn limits_of_call(
    py: Python<'_>,
    limits: Option<&PyLimits>,
    robot: &PyRobot,
    sampling: &Sampling,
) -> PyResult<(Py<PyLimits>, Option<Limits>)> {
    match limits {
        None => Ok((robot.limits(py)?, None)),
        Some(limits) => {
            let in_force = Py::new(py, limits.in_force(py, &robot.core))?;
            let resolved = limits.resolve(py, &robot.core, sampling)?;
            doubt(units::of_limits_of_call(&robot.core, &resolved))?;
            Ok((in_force, Some(resolved)))
        }
    }
}

/// Reads the limits of a call without a robot, for `n` joints: for the result and for the core.
pub fn limits_without_robot(
    py: Python<'_>,
    limits: Option<&PyLimits>,
    n: usize,
    sampling: &Sampling,
) -> PyResult<(Py<PyLimits>, Limits)> {
    let none = PyLimits::none(n);
    match limits {
        None => Ok((Py::new(py, none)?, Limits::none_for(n))),
        Some(limits) => {
            let resolved =
                limits.with_tips_and_torque(limits.applied_to(py, Limits::none_for(n), n, sampling)?, None)?;
            Ok((Py::new(py, limits.else_of(py, none))?, resolved))
        }
    }
}
