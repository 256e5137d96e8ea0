//! `Keep` and `upright`: constraints at every instant of a motion.

use std::f64::consts::PI;

use ikcore::Error;
use ikcore::constraint::Keep;
use ikcore::math::Frame;
use ikcore::math::pose::{rows, turning};
use ikcore::message::Setting;
use ikcore::robot::Robot;
use ikcore::stored::{from_bytes, to_bytes};
use ikcore::task::{NamedTask, Subject, Target, Task, TaskKind, Tolerance};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};

use crate::convert::{point, pose_array, row, summary};
use crate::error::{invalid, raise};
use crate::hash::content_hash;
use crate::ik::read_target;
use crate::options::list_text;
use crate::pickling::{Reduced, bytes, restored_from};
use crate::robot::PyRobot;
use crate::task::{read_task, task_object};
use crate::tip_keys::{CENTER_OF_MASS, TipKey, in_words, key_object, read_key, subject, tips_in_words};
use crate::wording::spelt;

/// Constraint at every instant of a motion: the error of a task to a target stays within the task's tolerance.
///
/// Args:
///     target: pose (4, 4) or position (3,) (m); or a dict from tips to targets, as for `solve`: the key ("left", "right") is the pose
///         of the second tip in the frame of the first.
///     task: part of the target that counts, one of `tasks`, with its tolerance: components without one are within 1e-6 m or rad, those
///         with an infinite one, or of weight 0, are free. None: all of the target, within 1e-6.
///
/// Raises:
///     InvalidInputError: wrong shape, NaN; a task that needs an orientation with a position as target; nothing to keep; a task
///         with a level, since what is kept comes before all targets.
///
/// For example, a hand that stays within 1 cm of the plane z = 0.3 m:
///
///     >>> free = float("inf")
///     >>> plane = bik.Keep([0, 0, 0.3], bik.tasks.Position(tolerance=[free, free, 0.01]))
#[pyclass(name = "Keep", module = "beetle_ik", frozen, eq)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyKeep {
    /// Targets by tip; the only one of a robot with one tip has no key.
    targets: Vec<(Option<TipKey>, Target)>,
    task: Option<Task>,
}

#[pymethods]
impl PyKeep {
    #[new]
    #[pyo3(signature = (target, task=None))]
    fn new(target: &Bound<'_, PyAny>, task: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let targets = match target.cast::<PyDict>() {
            Err(_) => vec![(None, read_target("target", target)?)],
            Ok(dict) if dict.is_empty() => {
                return Err(invalid("target: the dict is empty; name one tip, or a pair of tips, at least".into()));
            }
            Ok(dict) => {
                let each = dict.iter().map(|(key, value)| {
                    let key = read_key("target", &key)?;
                    let target = read_target(&format!("target of {}", in_words(&key)), &value)?;
                    Ok((Some(key), target))
                });
                each.collect::<PyResult<Vec<_>>>()?
            }
        };
        Self { targets, task: read_task(task)? }.checked()
    }

    /// The target: a pose (4, 4), a position (3,) (m), or a dict of them by tip.
    #[getter]
    fn target<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        if let [(None, target)] = &self.targets[..] {
            return target_object(py, target);
        }
        let dict = PyDict::new(py);
        for (key, target) in &self.targets {
            if let Some(key) = key {
                dict.set_item(key_object(py, key)?, target_object(py, target)?)?;
            }
        }
        Ok(dict.into_any())
    }

    /// The part of the target that counts; None: all of it.
    #[getter]
    fn task<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.task.as_ref().map(|task| task_object(py, task)).transpose()
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let each = self.targets.iter().map(|(key, target)| -> PyResult<String> {
            let key = key.as_ref().map(|key| Ok::<_, PyErr>(format!("{}: ", key_object(py, key)?.repr()?)));
            Ok(key.transpose()?.unwrap_or_default() + &target_text(target))
        });
        let each = each.collect::<PyResult<Vec<_>>>()?.join(", ");
        let target = if let [(None, _)] = self.targets[..] { each } else { format!("{{{each}}}") };
        let task = self.task(py)?.map_or(Ok(String::new()), |task| task.repr().map(|text| format!(", {text}")))?;
        Ok(format!("Keep({target}{task})"))
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        restored_from::<Self>(py, (bytes(py, to_bytes("keep", &(&self.targets, &self.task)))?,))
    }

    /// Restores a pickled value.
    #[staticmethod]
    fn _restore(bytes: &[u8]) -> PyResult<Self> {
        let (targets, task) = from_bytes("keep", bytes).map_err(raise)?;
        Self { targets, task }.checked()
    }
}

impl PyKeep {
    /// Finds wrong tasks and targets where they are given.
    fn checked(self) -> PyResult<Self> {
        for (_, target) in &self.targets {
            Keep::new(&self.named(Subject::Tip(0)), target).map_err(raise)?;
        }
        Ok(self)
    }

    fn named(&self, subject: Subject) -> NamedTask {
        NamedTask { subject, task: self.task, tolerance: Tolerance::default() }
    }

    /// Constraints of the core for the tips of `robot`.
    fn of(&self, robot: &Robot) -> PyResult<Vec<Keep>> {
        let one = |(key, target): &(Option<TipKey>, Target)| {
            let subject = match key {
                Some(key) => subject(robot, key)?,
                None if robot.tip_count() == 1 => Subject::Tip(0),
                None => {
                    let (name, tips) = (robot.name(), tips_in_words(robot));
                    return Err(invalid(format!(
                        "keep: robot '{name}' has several tips, {tips}: give Keep a dict from tips to targets, or upright one tip="
                    )));
                }
            };
            Keep::new(&self.named(subject), target).map_err(raise)
        };
        self.targets.iter().map(one).collect()
    }

    /// The constraint of a robot with these tips.
    pub fn from_core(keep: &Keep, robot: &Robot) -> Self {
        let names: Vec<&str> = robot.tips().collect();
        let key = match keep.task().subject {
            Subject::Tip(_) if names.len() == 1 => None,
            Subject::CenterOfMass => Some(vec![CENTER_OF_MASS.to_owned()]),
            Subject::Tip(tip) => Some(vec![names[tip].to_owned()]),
            Subject::Pair { from, of } => Some([from, of].map(|tip| names[tip].to_owned()).to_vec()),
        };
        Self { targets: vec![(key, *keep.target())], task: keep.task().task }
    }
}

/// Keeps an axis of the tip within an angle of a direction all the way, such as a cup that must not spill.
///
/// Args:
///     robot: the arm.
///     axis: (3,), axis of the tip, in its own frame, of any length but zero.
///     direction: (3,), where the axis points, in the frame of the base; by default down, as for a hand that hangs.
///     tilt: largest angle between them (rad).
///     tip: name of the tip of a robot with several; None: its only one.
///
/// Returns:
///     A `Keep`, for `keep=` of `plan_point_to_point` and others.
///
/// Raises:
///     InvalidInputError: an axis or a direction of length zero; a tilt that is not positive, or beyond pi; no tip of several.
///     UnknownNameError: a tip that the robot does not have.
///
/// For example:
///
///     >>> arm = bik.Robot.named("panda")
///     >>> keep = bik.upright(arm, tilt=0.25)
#[pyfunction]
#[pyo3(signature = (robot, *, axis=None, direction=None, tilt=0.1, tip=None),
       text_signature = "(robot, *, axis=(0, 0, 1), direction=(0, 0, -1), tilt=0.1, tip=None)")]
pub fn upright(
    robot: &PyRobot,
    axis: Option<&Bound<'_, PyAny>>,
    direction: Option<&Bound<'_, PyAny>>,
    tilt: f64,
    #[pyo3(from_py_with = crate::convert::optional_text)] tip: Option<&str>,
) -> PyResult<PyKeep> {
    let vector = |what: &str, given: Option<&Bound<'_, PyAny>>, default: [f64; 3]| {
        let vector = given.map_or(Ok(default), |given| point(what, given))?;
        if let Some(i) = vector.iter().position(|entry| !entry.is_finite()) {
            return Err(raise(Error::NotFinite { what: what.into(), place: format!("entry {i}"), value: vector[i] }));
        }
        match vector.iter().any(|entry| *entry != 0.0) {
            true => Ok(vector),
            false => Err(invalid(format!("the length of {what} must be positive, got 0.0"))),
        }
    };
    let (axis, direction) = (vector("axis", axis, [0.0, 0.0, 1.0])?, vector("direction", direction, [0.0, 0.0, -1.0])?);
    if !(tilt > 0.0) {
        return Err(invalid(format!("tilt must be positive, got {tilt:?}")));
    }
    if tilt > PI {
        let degrees = spelt(&Setting::RadiansFromDegrees);
        return Err(invalid(format!("tilt must be at most pi, at which any axis is allowed, got {tilt:?}; {degrees}")));
    }
    let key = match tip {
        None if robot.core.tip_count() == 1 => None,
        None => {
            let (name, tips) = (robot.core.name(), tips_in_words(&robot.core));
            return Err(invalid(format!("tip: robot '{name}' has several tips, name one of {tips}")));
        }
        Some(tip) => {
            let key = vec![tip.to_owned()];
            subject(&robot.core, &key)?;
            (robot.core.tip_count() > 1).then_some(key)
        }
    };
    let target = Target::Pose(Frame::from(&turning(axis, direction)));
    let free = f64::INFINITY;
    let task = Task::new(TaskKind::Pointing { axis }, None, Some(&[free, free, free, tilt]), None).map_err(raise)?;
    Ok(PyKeep { targets: vec![(key, target)], task: Some(task) })
}

/// Reads the constraints of `robot`: none, a `Keep`, or several.
pub fn read_keeps(robot: &PyRobot, value: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<Keep>> {
    let Some(value) = value else { return Ok(vec![]) };
    let one = |value: &Bound<'_, PyAny>| match value.cast::<PyKeep>() {
        Ok(keep) => keep.get().of(&robot.core),
        Err(_) => Err(invalid(format!("keep: expected a Keep or a list of them, got {}", summary(value)))),
    };
    if value.cast::<PyList>().is_ok() || value.cast::<PyTuple>().is_ok() {
        let mut all = vec![];
        for each in value.try_iter()? {
            all.extend(one(&each?)?);
        }
        return Ok(all);
    }
    one(value)
}

/// Formats a target in Python syntax.
fn target_text(target: &Target) -> String {
    match target {
        Target::Position(position) => list_text(position),
        Target::Pose(frame) | Target::Orientation(frame) | Target::Pointing { frame, .. } => {
            format!("{:?}", rows(&(*frame).into()).as_chunks::<4>().0)
        }
    }
}

fn target_object<'py>(py: Python<'py>, target: &Target) -> PyResult<Bound<'py, PyAny>> {
    match target {
        Target::Position(position) => Ok(row(py, position.to_vec()).into_any()),
        Target::Pose(frame) | Target::Orientation(frame) | Target::Pointing { frame, .. } => {
            Ok(pose_array(py, &(*frame).into()).into_any())
        }
    }
}
