//! `moves`: the moves of a program.

use ikcore::planning::{JointGoal, Move, MoveKind};
use numpy::{PyArray1, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::convert::{array, copied, point, pose_array, rigid, rigid_rows, shape_text, summary};
use crate::error::{invalid, raise};
use crate::hash::content_hash;
use crate::options::{NewArguments, Shown, keywords, list_text};

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PyMove>()?;
    module.add_class::<PyJoints>()?;
    module.add_class::<PyLine>()?;
    module.add_class::<PyArc>()?;
    module.add_class::<PyWait>()
}

/// A move of a program: `Joints`, `Line`, `Arc` or `Wait`.
#[pyclass(name = "Move", module = "beetle_ik.moves", frozen, subclass, eq)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyMove {
    pub core: Move,
}

#[pymethods]
impl PyMove {
    /// Radius about the end of the move (m) inside which the motion may round the corner to the next move; 0: it stops there.
    #[getter]
    fn blend(&self) -> f64 {
        self.core.blend
    }

    /// The tip that the move leads, of a robot with several, or None.
    #[getter]
    fn tip(&self) -> Option<&str> {
        self.core.tip.as_deref()
    }

    /// Name in messages and reports, or None.
    #[getter]
    fn name(&self) -> Option<&str> {
        self.core.name.as_deref()
    }

    fn __repr__(&self) -> String {
        let Move { kind, blend, tip, name } = &self.core;
        let mut rest = vec![];
        let kind = match kind {
            MoveKind::Joints(JointGoal::Configuration(q)) => format!("Joints({}", list_text(q)),
            MoveKind::Joints(JointGoal::Pose(pose)) => {
                format!("Joints(pose at {}", place(pose.translation.vector.as_ref()))
            }
            MoveKind::Line { pose, speed } => {
                rest.push(format!("speed={}", speed.text()));
                format!("Line(pose at {}", place(pose.translation.vector.as_ref()))
            }
            MoveKind::Arc { via, pose, angle, speed } => {
                rest.extend(angle.map(|angle| format!("angle={}", angle.text())));
                rest.push(format!("speed={}", speed.text()));
                format!("Arc({}, pose at {}", list_text(via), place(pose.translation.vector.as_ref()))
            }
            MoveKind::Wait(seconds) => format!("Wait({}", seconds.text()),
        };
        if *blend > 0.0 {
            rest.push(format!("blend={}", blend.text()));
        }
        rest.extend(tip.as_ref().map(|tip| format!("tip='{tip}'")));
        rest.extend(name.as_ref().map(|name| format!("name='{name}'")));
        let rest: String = rest.iter().map(|given| format!(", {given}")).collect();
        format!("moves.{kind}{rest})")
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }
}

fn place(position: &[f64; 3]) -> String {
    list_text(position)
}

/// Refuses a dict of poses by tip, as other calls take them.
fn of_one_tip<'a, 'py>(what: &str, value: &'a Bound<'py, PyAny>) -> PyResult<&'a Bound<'py, PyAny>> {
    let Ok(dict) = value.cast::<PyDict>() else { return Ok(value) };
    let first = dict.keys().iter().next().and_then(|key| key.extract::<String>().ok()).unwrap_or_else(|| "left".into());
    Err(invalid(format!("{what}: a move leads one tip, got a dict: give its pose, and its name as tip='{first}'")))
}

/// Makes a move, which is checked as far as it can be without a robot.
fn made<T: pyo3::PyClass<BaseType = PyMove>>(
    kind: MoveKind,
    blend: f64,
    [tip, name]: [Option<&str>; 2],
    class: T,
) -> PyResult<PyClassInitializer<T>> {
    let core = Move { kind, blend, tip: tip.map(str::to_owned), name: name.map(str::to_owned) };
    core.validate().map_err(raise)?;
    Ok(PyClassInitializer::from(PyMove { core }).add_subclass(class))
}

/// All joints together to a configuration or a pose, as fast as the limits allow (PTP, movej).
///
/// Args:
///     q_or_pose: joint positions (n,) (rad, m), or a pose (4, 4) of the tip, whose configuration the planner chooses.
///     blend: radius (m) about the end inside which the motion may round the corner to the next move; 0: it stops there.
///     tip: name of the tip that is led to a pose, of a robot with several; joints that move another tip too stay where they are.
///     name: name in messages and reports.
///
/// Raises:
///     InvalidInputError: q_or_pose of another shape, NaN, or no rigid transform; a blend below zero; a tip with joint positions.
#[pyclass(name = "Joints", module = "beetle_ik.moves", extends = PyMove, frozen)]
pub struct PyJoints;

#[pymethods]
impl PyJoints {
    #[new]
    #[pyo3(signature = (q_or_pose, *, blend=0.0, tip=None, name=None))]
    fn new(
        q_or_pose: &Bound<'_, PyAny>,
        blend: f64,
        #[pyo3(from_py_with = crate::convert::optional_text)] tip: Option<&str>,
        #[pyo3(from_py_with = crate::convert::optional_text)] name: Option<&str>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let numbers = array("q_or_pose", of_one_tip("q_or_pose", q_or_pose)?)?;
        let goal = match numbers.shape() {
            [_] => JointGoal::Configuration(numbers.as_slice()?.to_vec()),
            [4, 4] => JointGoal::Pose(rigid_rows("q_or_pose", numbers.as_slice()?)?),
            shape => {
                let got = shape_text(shape);
                return Err(invalid(format!(
                    "q_or_pose: expected joint positions (n,) or a pose (4, 4), got shape {got}"
                )));
            }
        };
        made(MoveKind::Joints(goal), blend, [tip, name], Self)
    }

    /// Joint positions at the end (n,), or the pose of the tip (4, 4).
    #[getter]
    fn q_or_pose(self_: PyRef<'_, Self>) -> PyResult<Bound<'_, PyAny>> {
        let py = self_.py();
        match &self_.as_super().core.kind {
            MoveKind::Joints(JointGoal::Configuration(q)) => Ok(copied(py, q).into_any()),
            MoveKind::Joints(JointGoal::Pose(pose)) | MoveKind::Line { pose, .. } | MoveKind::Arc { pose, .. } => {
                Ok(pose_array(py, pose).into_any())
            }
            MoveKind::Wait(_) => Ok(py.None().into_bound(py)),
        }
    }

    fn __getnewargs_ex__<'py>(slf: &Bound<'py, Self>) -> PyResult<NewArguments<'py>> {
        keywords(slf, &["q_or_pose", "blend", "tip", "name"])
    }
}

/// The tip along a straight line to a pose; its orientation turns uniformly with the length (LIN, movel).
///
/// Args:
///     pose: (4, 4), pose of the tip at the end.
///     speed: speed of the tip (m/s), kept between the blends wherever the limits allow; a turn on the spot counts 0.1 m for
///         each radian. None: as fast as the limits allow.
///     blend: radius (m) about the end inside which the motion may round the corner to the next line or arc; 0: it stops there.
///     tip: name of the tip, of a robot with several; joints that move another tip too stay where they are.
///     name: name in messages and reports.
///
/// Raises:
///     InvalidInputError: a pose of another shape, or no rigid transform; a speed that is not positive, or a blend below zero.
#[pyclass(name = "Line", module = "beetle_ik.moves", extends = PyMove, frozen)]
pub struct PyLine;

#[pymethods]
impl PyLine {
    #[new]
    #[pyo3(signature = (pose, *, speed=None, blend=0.0, tip=None, name=None))]
    fn new(
        pose: &Bound<'_, PyAny>,
        speed: Option<f64>,
        blend: f64,
        #[pyo3(from_py_with = crate::convert::optional_text)] tip: Option<&str>,
        #[pyo3(from_py_with = crate::convert::optional_text)] name: Option<&str>,
    ) -> PyResult<PyClassInitializer<Self>> {
        made(MoveKind::Line { pose: rigid("pose", of_one_tip("pose", pose)?)?, speed }, blend, [tip, name], Self)
    }

    /// Pose of the tip at the end (4, 4).
    #[getter]
    fn pose(self_: PyRef<'_, Self>) -> PyResult<Option<Bound<'_, PyAny>>> {
        end_pose(self_.py(), &self_.as_super().core)
    }

    /// Speed of the tip (m/s); None: as fast as the limits allow.
    #[getter]
    fn speed(self_: PyRef<'_, Self>) -> Option<f64> {
        speed_of(&self_.as_super().core)
    }

    fn __getnewargs_ex__<'py>(slf: &Bound<'py, Self>) -> PyResult<NewArguments<'py>> {
        keywords(slf, &["pose", "speed", "blend", "tip", "name"])
    }
}

/// The tip along an arc of a circle; its orientation turns uniformly with the length (CIRC, movec).
///
/// Args:
///     via: point (3,) (m) that the arc passes through; of a pose (4, 4) the position counts.
///     pose: (4, 4), pose of the tip at the end.
///     speed: speed of the tip (m/s), kept between the blends wherever the limits allow. None: as fast as the limits allow.
///     blend: radius (m) about the end inside which the motion may round the corner to the next line or arc; 0: it stops there.
///     angle: angle (rad) after which the arc ends, on the circle through its start, `via` and the position of `pose`, with
///         the orientation of `pose`; 2 pi is a full circle. None: it ends at `pose`.
///     tip: name of the tip, of a robot with several; joints that move another tip too stay where they are.
///     name: name in messages and reports.
///
/// Raises:
///     InvalidInputError: a point or a pose of another shape, or no rigid transform; a speed or an angle that is not
///         positive, or a blend below zero.
#[pyclass(name = "Arc", module = "beetle_ik.moves", extends = PyMove, frozen)]
pub struct PyArc;

#[pymethods]
impl PyArc {
    #[new]
    #[pyo3(signature = (via, pose, *, speed=None, blend=0.0, angle=None, tip=None, name=None))]
    fn new(
        via: &Bound<'_, PyAny>,
        pose: &Bound<'_, PyAny>,
        speed: Option<f64>,
        blend: f64,
        angle: Option<f64>,
        #[pyo3(from_py_with = crate::convert::optional_text)] tip: Option<&str>,
        #[pyo3(from_py_with = crate::convert::optional_text)] name: Option<&str>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let via = match array("via", via)?.shape() {
            [4, 4] => rigid("via", via)?.translation.vector.into(),
            _ => point("via", via)?,
        };
        made(
            MoveKind::Arc { via, pose: rigid("pose", of_one_tip("pose", pose)?)?, angle, speed },
            blend,
            [tip, name],
            Self,
        )
    }

    /// Point that the arc passes through (3,) (m).
    #[getter]
    fn via(self_: PyRef<'_, Self>) -> Option<Bound<'_, PyArray1<f64>>> {
        match &self_.as_super().core.kind {
            MoveKind::Arc { via, .. } => Some(copied(self_.py(), via)),
            _ => None,
        }
    }

    /// Pose of the tip at the end (4, 4).
    #[getter]
    fn pose(self_: PyRef<'_, Self>) -> PyResult<Option<Bound<'_, PyAny>>> {
        end_pose(self_.py(), &self_.as_super().core)
    }

    /// Speed of the tip (m/s); None: as fast as the limits allow.
    #[getter]
    fn speed(self_: PyRef<'_, Self>) -> Option<f64> {
        speed_of(&self_.as_super().core)
    }

    /// Angle after which the arc ends (rad); None: it ends at `pose`.
    #[getter]
    fn angle(self_: PyRef<'_, Self>) -> Option<f64> {
        match self_.as_super().core.kind {
            MoveKind::Arc { angle, .. } => angle,
            _ => None,
        }
    }

    fn __getnewargs_ex__<'py>(slf: &Bound<'py, Self>) -> PyResult<NewArguments<'py>> {
        keywords(slf, &["via", "pose", "speed", "blend", "angle", "tip", "name"])
    }
}

/// Rest for some time.
///
/// Args:
///     seconds: how long (s), from 0 to 1e6.
///     name: name in messages and reports.
///
/// Raises:
///     InvalidInputError: a time outside this range.
#[pyclass(name = "Wait", module = "beetle_ik.moves", extends = PyMove, frozen)]
pub struct PyWait;

#[pymethods]
impl PyWait {
    #[new]
    #[pyo3(signature = (seconds, *, name=None))]
    fn new(
        seconds: f64,
        #[pyo3(from_py_with = crate::convert::optional_text)] name: Option<&str>,
    ) -> PyResult<PyClassInitializer<Self>> {
        made(MoveKind::Wait(seconds), 0.0, [None, name], Self)
    }

    /// Duration (s).
    #[getter]
    fn seconds(self_: PyRef<'_, Self>) -> f64 {
        match self_.as_super().core.kind {
            MoveKind::Wait(seconds) => seconds,
            _ => 0.0,
        }
    }

    fn __getnewargs_ex__<'py>(slf: &Bound<'py, Self>) -> PyResult<NewArguments<'py>> {
        keywords(slf, &["seconds", "name"])
    }
}

fn end_pose<'py>(py: Python<'py>, each: &Move) -> PyResult<Option<Bound<'py, PyAny>>> {
    match &each.kind {
        MoveKind::Line { pose, .. } | MoveKind::Arc { pose, .. } => Ok(Some(pose_array(py, pose).into_any())),
        MoveKind::Joints(_) | MoveKind::Wait(_) => Ok(None),
    }
}

fn speed_of(each: &Move) -> Option<f64> {
    match each.kind {
        MoveKind::Line { speed, .. } | MoveKind::Arc { speed, .. } => speed,
        MoveKind::Joints(_) | MoveKind::Wait(_) => None,
    }
}

/// Reads a sequence of moves.
pub fn read_moves(value: &Bound<'_, PyAny>) -> PyResult<Vec<Move>> {
    let wrong =
        || invalid(format!("moves must be a sequence of moves, such as beetle_ik.moves.Line, got {}", summary(value)));
    let mut moves = vec![];
    for (i, each) in value.try_iter().map_err(|_| wrong())?.enumerate() {
        let each = each?;
        let given = each
            .cast::<PyMove>()
            .map_err(|_| invalid(format!("moves[{i}] must be one of beetle_ik.moves, got {}", summary(&each))))?;
        moves.push(given.get().core.clone());
    }
    Ok(moves)
}
