//! Reading of the ends of a motion.

use ikcore::ik::SolveOptions;
use ikcore::planning::{Endpoint, TipsEndpoint};
use ikcore::task::{Target, Tolerance};
use numpy::PyUntypedArrayMethods;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::convert::{Numbers, array, rigid_rows, shape_text, vector};
use crate::error::invalid;
use crate::ik::read_target;
use crate::robot::PyRobot;
use crate::tips::{Asked, TaskArguments, ToleranceArgument, read_only};

type Argument<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

/// Reads the start, given as a target or as joint positions.
/// The ends of a robot with one tip, without the dicts that may name it.
pub fn plain<'py>(name: &str, robot: &PyRobot, end: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let of_one = |name: &str, end: &Bound<'py, PyAny>| match end.is_instance_of::<PyDict>() {
        true => read_only(name, robot, end, |_, end| Ok(end.clone())),
        false => Ok(end.clone()),
    };
    match end.cast::<PyList>() {
        Ok(several) => {
            let each = several.iter().enumerate().map(|(i, end)| of_one(&format!("{name}[{i}]"), &end));
            Ok(PyList::new(end.py(), each.collect::<PyResult<Vec<_>>>()?)?.into_any())
        }
        Err(_) => of_one(name, end),
    }
}

pub fn read_start(target: Argument<'_, '_>, q: Argument<'_, '_>) -> PyResult<Endpoint> {
    match one_of("start", target, q)? {
        Given::Target(target) => {
            refuse_angles("start", &array("start", target)?)?;
            read_target("start", target).map(Endpoint::Target)
        }
        Given::Configuration(q) => vector("start_q", q).map(Endpoint::Configuration),
    }
}

/// Reads the ends, one or several, given as targets or as joint positions.
pub fn read_ends(target: Argument<'_, '_>, q: Argument<'_, '_>) -> PyResult<Vec<Endpoint>> {
    match one_of("end", target, q)? {
        Given::Target(target) => read_targets(target),
        Given::Configuration(q) => read_configurations(q),
    }
}

/// One or several targets.
fn read_targets(value: &Bound<'_, PyAny>) -> PyResult<Vec<Endpoint>> {
    let numbers = array("end", value)?;
    refuse_angles("end", &numbers)?;
    let rows = numbers.as_slice()?;
    match numbers.shape() {
        [3] | [4, 4] => Ok(vec![Endpoint::Target(read_target("end", value)?)]),
        [k, 3] if *k > 0 => {
            Ok(rows.as_chunks().0.iter().map(|position| Endpoint::Target(Target::Position(*position))).collect())
        }
        [k, 4, 4] if *k > 0 => {
            let matrices = rows.chunks_exact(16).enumerate();
            let target = |(i, rows)| Ok(Endpoint::Target(Target::from(&rigid_rows(&format!("end[{i}]"), rows)?)));
            matrices.map(target).collect()
        }
        shape => Err(invalid(format!(
            "end: expected a pose (4, 4), a position (3,), or several, (k, 4, 4) or (k, 3), got shape {}",
            shape_text(shape)
        ))),
    }
}

/// One or several configurations; the core checks the number of joints.
fn read_configurations(value: &Bound<'_, PyAny>) -> PyResult<Vec<Endpoint>> {
    let numbers = array("end_q", value)?;
    let rows = numbers.as_slice()?;
    match numbers.shape() {
        [_] => Ok(vec![Endpoint::Configuration(rows.to_vec())]),
        [k, n] if k * n > 0 => Ok(rows.chunks_exact(*n).map(|q| Endpoint::Configuration(q.to_vec())).collect()),
        shape => Err(invalid(format!(
            "end_q: expected joint positions (n,), or several, (k, n), got shape {}",
            shape_text(shape)
        ))),
    }
}

/// Reads the start of a motion of several tips, given as a dict of targets or as joint positions.
pub fn read_tips_start(
    robot: &PyRobot,
    target: Argument<'_, '_>,
    q: Argument<'_, '_>,
    task: Argument<'_, '_>,
) -> PyResult<TipsEndpoint> {
    match one_of("start", target, q)? {
        Given::Target(target) => read_tips("start", robot, target, task),
        Given::Configuration(q) => vector("start_q", q).map(TipsEndpoint::Configuration),
    }
}

/// Reads the ends of a motion of several tips: a dict of targets, a list of dicts, or joint positions.
pub fn read_tips_ends(
    robot: &PyRobot,
    target: Argument<'_, '_>,
    q: Argument<'_, '_>,
    task: Argument<'_, '_>,
) -> PyResult<Vec<TipsEndpoint>> {
    match one_of("end", target, q)? {
        Given::Target(several) if several.is_instance_of::<PyList>() => {
            let ends = several.try_iter()?.enumerate();
            ends.map(|(i, end)| read_tips(&format!("end[{i}]"), robot, &end?, task)).collect()
        }
        Given::Target(target) => Ok(vec![read_tips("end", robot, target, task)?]),
        Given::Configuration(q) => {
            let configuration = |end| match end {
                Endpoint::Configuration(q) => Some(TipsEndpoint::Configuration(q)),
                Endpoint::Target(_) => None,
            };
            Ok(read_configurations(q)?.into_iter().filter_map(configuration).collect())
        }
    }
}

/// The targets of several tips.
fn read_tips(name: &str, robot: &PyRobot, target: &Bound<'_, PyAny>, task: Argument<'_, '_>) -> PyResult<TipsEndpoint> {
    let asked = Asked::read(name, robot, target, read_target)?;
    let mut options = SolveOptions::default();
    let Tolerance { position, rotation } = options.tolerance;
    let tolerances = [position, rotation].map(ToleranceArgument::All);
    let tasks = TaskArguments { task, position_tolerance: &tolerances[0], rotation_tolerance: &tolerances[1] };
    tasks.write(robot, &asked, &mut options)?;
    Ok(TipsEndpoint::Targets(options.tips.into_iter().zip(asked.values().iter().copied()).collect()))
}

enum Given<'a, 'py> {
    Target(&'a Bound<'py, PyAny>),
    Configuration(&'a Bound<'py, PyAny>),
}

/// The argument that was given, of the two that may be.
fn one_of<'a, 'py>(name: &str, target: Argument<'a, 'py>, q: Argument<'a, 'py>) -> PyResult<Given<'a, 'py>> {
    match (target, q) {
        (Some(target), None) => Ok(Given::Target(target)),
        (None, Some(q)) => Ok(Given::Configuration(q)),
        (None, None) => Err(invalid(format!("no {name} was given: give {name}= a position or pose, or {name}_q="))),
        (Some(_), Some(_)) => Err(invalid(format!("both {name} and {name}_q were given: give one of them"))),
    }
}

/// A single row that is no position is probably meant as joint angles.
fn refuse_angles(name: &str, numbers: &Numbers<'_>) -> PyResult<()> {
    match numbers.shape() {
        [n] if *n != 3 => Err(invalid(format!(
            "{name}: expected a pose (4, 4) or a position (3,), got shape ({n},); joint angles go to {name}_q"
        ))),
        _ => Ok(()),
    }
}
