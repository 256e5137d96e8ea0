//! Joint values in the order of q.

use ikcore::robot::Robot;
use ikcore::units;
use pyo3::prelude::*;

use crate::convert::{Numbers, Rows, array, rows, vector};
use crate::units::doubt;

/// Reads a configuration (n,); the core checks the number of joints.
pub fn joint_vector(robot: &Robot, what: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let q = vector(what, value)?;
    doubt(units::of_configurations(robot, what, &q))?;
    Ok(q)
}

/// Reads an array of configurations.
pub fn joint_array<'py>(robot: &Robot, what: &str, value: &Bound<'py, PyAny>) -> PyResult<Numbers<'py>> {
    let numbers = array(what, value)?;
    doubt(units::of_configurations(robot, what, numbers.as_slice()?))?;
    Ok(numbers)
}

/// Reads (n,) or (m, n).
pub fn joint_rows<'py>(robot: &Robot, what: &str, value: &Bound<'py, PyAny>) -> PyResult<Rows<'py>> {
    let read = rows(what, robot.name(), robot.dof(), value)?;
    let (Rows::One(qs) | Rows::Many(qs, _)) = &read;
    doubt(units::of_configurations(robot, what, qs.as_slice()?))?;
    Ok(read)
}
