//! Joint values in the order of q: those with names are put into it, and those that look like degrees are doubted.

use ikcore::robot::Robot;
use ikcore::units;
use numpy::{PyArrayDyn, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::convert::{Numbers, Rows, array, as_they_are, is_list, one_dimension, own, shape_text, table};
use crate::error::{invalid, raise};
use crate::python_calls;
use crate::units::doubt;

/// Reads a configuration (n,) in the order of q; values with names are put into it.
pub fn joint_vector(robot: &Robot, what: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let q = joint_numbers(robot, what, value)?;
    doubt(units::of_configurations(robot, what, &q))?;
    Ok(q)
}

/// Reads one number for each joint, whatever its unit; values with names are put into the order of q.
pub fn joint_numbers(robot: &Robot, what: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    one_dimension(what, &ordered_numbers(robot, what, value)?)
}

/// Reads an array of configurations; values with names are put into the order of q.
pub fn joint_array<'py>(robot: &Robot, what: &str, value: &Bound<'py, PyAny>) -> PyResult<Numbers<'py>> {
    let numbers = ordered_numbers(robot, what, value)?;
    doubt(units::of_configurations(robot, what, numbers.as_slice()?))?;
    Ok(numbers)
}

/// Reads (n,) or (m, n); values with names are put into the order of q.
pub fn joint_rows<'py>(robot: &Robot, what: &str, value: &Bound<'py, PyAny>) -> PyResult<Rows<'py>> {
    let n = robot.dof();
    let array = joint_array(robot, what, value)?;
    match array.shape() {
        [_] => Ok(Rows::One(array)),
        [m, columns] if *columns == n => {
            let m = *m;
            Ok(Rows::Many(array, m))
        }
        shape => {
            let (owner, got) = (robot.name(), shape_text(shape));
            Err(invalid(format!("{what} of robot '{owner}': expected shape ({n},) or (m, {n}), got {got}")))
        }
    }
}

/// Reads rates or torques of all joints, one row or as many `rows` as there are configurations; values with names are put into the
/// order of q.
pub fn rate_rows<'py>(
    robot: &Robot,
    what: &str,
    value: &Bound<'py, PyAny>,
    rows: Option<usize>,
) -> PyResult<Numbers<'py>> {
    let array = ordered_numbers(robot, what, value)?;
    let (m, n, owner) = (rows.unwrap_or(0), robot.dof(), robot.name());
    let expected: &[usize] = if rows.is_none() { &[n] } else { &[m, n] };
    if array.shape() == expected {
        return Ok(array);
    }
    let (expected, got) = (shape_text(expected), shape_text(array.shape()));
    Err(invalid(format!("{what} of robot '{owner}': expected shape {expected}, that of the joint angles, got {got}")))
}

/// Reads an array of configurations, whatever their unit; values with names are put into the order of q.
fn ordered_numbers<'py>(robot: &Robot, what: &str, value: &Bound<'py, PyAny>) -> PyResult<Numbers<'py>> {
    if let Some(numbers) = as_they_are(value) {
        return Ok(numbers);
    }
    match in_order(robot, value)? {
        Some(ordered) => array(what, &ordered),
        None => array(what, value),
    }
}

/// Returns the configurations of values with names, in the order of q; None for other values.
fn in_order<'py>(robot: &Robot, value: &Bound<'py, PyAny>) -> PyResult<Option<Bound<'py, PyAny>>> {
    let is_plain =
        is_list(value) || (value.is_exact_instance_of::<PyUntypedArray>() && value.cast::<PyArrayDyn<f64>>().is_ok());
    if is_plain {
        return Ok(None);
    }
    match python_calls::labelled(value)? {
        Some((names, values)) => q_from(robot, &names, &values, false, false).map(|q| Some(q.into_any())),
        None => Ok(None),
    }
}

/// Returns the configurations (n,) or (m, n) of `values` (k,) or (m, k) with these joint names.
pub fn q_from<'py>(
    robot: &Robot,
    names: &[String],
    values: &Bound<'py, PyAny>,
    degrees: bool,
    ignore_extra: bool,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let (numbers, k, n) = (array("values", values)?, names.len(), robot.dof());
    if names.is_empty() {
        return Err(invalid("names: expected the names of joints, got none".into()));
    }
    let shape = match numbers.shape() {
        [columns] if *columns == k => vec![n],
        [m, columns] if *columns == k => vec![*m, n],
        shape => {
            let got = shape_text(shape);
            return Err(invalid(format!("values: expected shape ({k},) or (m, {k}), one per name, got {got}")));
        }
    };
    let q = robot.q_from(names, numbers.as_slice()?, degrees, ignore_extra).map_err(raise)?;
    table(values.py(), q, &shape).map(own)
}
