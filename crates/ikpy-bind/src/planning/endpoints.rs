//! Reading of the ends of a motion.

use ikcore::planning::Endpoint;
use ikcore::task::{Subject, Target, TargetRow, Tolerance};
use numpy::PyUntypedArrayMethods;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::convert::{Numbers, array, rigid_rows, shape_text};
use crate::error::invalid;
use crate::ik::{read_target, read_targets};
use crate::joint_order::{joint_array, joint_vector};
use crate::robot::PyRobot;
use crate::tips::{TaskArguments, ToleranceArgument, read_only};
use crate::units;

type Argument<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

/// Reads the start, given as targets or as joint positions.
pub fn read_start(
    robot: &PyRobot,
    target: Argument<'_, '_>,
    q: Argument<'_, '_>,
    task: Argument<'_, '_>,
) -> PyResult<Endpoint> {
    match one_of("start", target, q)? {
        Given::Target(targets) if robot.core.tip_count() > 1 => read_tips("start", robot, targets, task),
        Given::Target(target) => {
            let target = plain("start", robot, target)?;
            refuse_angles("start", &array("start", &target)?)?;
            doubted("start", robot, read_target("start", &target)?).map(Endpoint::from)
        }
        Given::Configuration(q) => joint_vector(&robot.core, "start_q", q).map(Endpoint::Configuration),
    }
}

/// Reads the ends, one or several, given as targets or as joint positions; targets of several tips are dicts.
pub fn read_ends(
    robot: &PyRobot,
    target: Argument<'_, '_>,
    q: Argument<'_, '_>,
    task: Argument<'_, '_>,
) -> PyResult<Vec<Endpoint>> {
    match one_of("end", target, q)? {
        Given::Target(target) if robot.core.tip_count() == 1 => read_ends_of_one(robot, &plain("end", robot, target)?),
        Given::Target(several) if several.is_instance_of::<PyList>() => {
            let ends = several.try_iter()?.enumerate();
            ends.map(|(i, end)| read_tips(&format!("end[{i}]"), robot, &end?, task)).collect()
        }
        Given::Target(targets) => Ok(vec![read_tips("end", robot, targets, task)?]),
        Given::Configuration(q) => read_configurations(robot, q),
    }
}

/// Unwraps the dict that names the only tip of a robot, also within a list.
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

/// Reads one or several targets.
fn read_ends_of_one(robot: &PyRobot, value: &Bound<'_, PyAny>) -> PyResult<Vec<Endpoint>> {
    let numbers = array("end", value)?;
    refuse_angles("end", &numbers)?;
    let rows = numbers.as_slice()?;
    match numbers.shape() {
        [3] | [4, 4] => Ok(vec![doubted("end", robot, read_target("end", value)?)?.into()]),
        [k, 3] if *k > 0 => {
            let positions = rows.as_chunks().0.iter().map(|position| Target::Position(*position));
            positions.map(|target| doubted("end", robot, target).map(Endpoint::from)).collect()
        }
        [k, 4, 4] if *k > 0 => {
            let matrices = rows.chunks_exact(16).enumerate();
            let target = |(i, rows)| {
                let target = Target::from(&rigid_rows(&format!("end[{i}]"), rows)?);
                doubted(&format!("end[{i}]"), robot, target).map(Endpoint::from)
            };
            matrices.map(target).collect()
        }
        shape => Err(invalid(format!(
            "end: expected a pose (4, 4), a position (3,), or several, (k, 4, 4) or (k, 3), got shape {}",
            shape_text(shape)
        ))),
    }
}

/// Doubts the unit of a target of the only tip.
fn doubted(what: &str, robot: &PyRobot, target: Target) -> PyResult<Target> {
    units::doubt(units::of_target(&robot.core, what, Subject::Tip(0), &target))?;
    Ok(target)
}

/// Reads one or several configurations; the core checks the number of joints.
fn read_configurations(robot: &PyRobot, value: &Bound<'_, PyAny>) -> PyResult<Vec<Endpoint>> {
    let numbers = joint_array(&robot.core, "end_q", value)?;
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

/// Reads the targets of several tips.
fn read_tips(name: &str, robot: &PyRobot, target: &Bound<'_, PyAny>, task: Argument<'_, '_>) -> PyResult<Endpoint> {
    let asked = read_targets(name, robot, target)?;
    let Tolerance { position, rotation } = Tolerance::default();
    let [position_tolerance, rotation_tolerance] = &[position, rotation].map(ToleranceArgument::All);
    let settings = TaskArguments { task, position_tolerance, rotation_tolerance }.read_for(robot, &asked)?;
    Ok(Endpoint::Targets { tips: settings.tasks(&asked), targets: TargetRow::from_slice(asked.values()) })
}

enum Given<'a, 'py> {
    Target(&'a Bound<'py, PyAny>),
    Configuration(&'a Bound<'py, PyAny>),
}

/// Returns the argument that was given, a target or joint positions; an error unless it is exactly one.
fn one_of<'a, 'py>(name: &str, target: Argument<'a, 'py>, q: Argument<'a, 'py>) -> PyResult<Given<'a, 'py>> {
    match (target, q) {
        (Some(target), None) => Ok(Given::Target(target)),
        (None, Some(q)) => Ok(Given::Configuration(q)),
        (None, None) => Err(invalid(format!("no {name} was given: give {name}= a position or pose, or {name}_q="))),
        (Some(_), Some(_)) => Err(invalid(format!("both {name} and {name}_q were given: give one of them"))),
    }
}

/// Refuses a row that is no position: it probably holds joint angles.
fn refuse_angles(name: &str, numbers: &Numbers<'_>) -> PyResult<()> {
    match numbers.shape() {
        [n] if *n != 3 => Err(invalid(format!(
            "{name}: expected a pose (4, 4) or a position (3,), got shape ({n},); joint angles go to {name}_q"
        ))),
        _ => Ok(()),
    }
}
