//! `tasks`: the parts of a target that count.

use ikcore::math::{Pose, pose};
use ikcore::task::{First, Region, Task, TaskKind};
use numpy::{PyArray1, PyArray2};
use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::convert::{Array, copied, corners, count, point, pose_array, rigid, row, scalar_or_vector, summary, table};
use crate::error::{invalid, raise};
use crate::hash::content_hash;
use crate::options::{NewArguments, list_text};

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PyTask>()?;
    module.add_class::<PyPose>()?;
    module.add_class::<PyPosition>()?;
    module.add_class::<PyOrientation>()?;
    module.add_class::<PyPointing>()
}

/// The part of a target that counts: `Pose`, `Position`, `Orientation` or `Pointing`.
///
/// A `region` keeps the tip in a box, p_min < p < p_max: eq. (5) of Cheng et al. (2020). A target outside the box is
/// approached as far as the box allows, and the status is `HELD_IN_REGION`. A solution with status `SOLVED` or
/// `HELD_IN_REGION` always has its tip inside; so has a track at the end of each tick, with any solver. Within a tick
/// the joints move linearly, so that the tip can leave the box by the curvature of its path.
#[pyclass(name = "Task", module = "beetle_ik.tasks", frozen, subclass, eq)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyTask {
    core: Task,
}

#[pymethods]
impl PyTask {
    /// Weights of the components; None: all 1. A component of weight 0 is free.
    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.core.weights().map(|weights| row(py, weights))
    }

    /// Largest error of each component (m, rad); None: the tolerances of the call apply.
    #[getter]
    fn tolerance<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.core.tolerance().map(|tolerance| row(py, tolerance))
    }

    /// Pose of the tool in the frame of the tip (4, 4); None: the tip itself.
    #[getter]
    fn tool<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray2<f64>>> {
        self.core.tool.as_ref().map(|tool| pose_array(py, tool))
    }

    /// Lower and upper corner of the box that the tip stays in (2, 3) (m); None: no box.
    #[getter]
    fn region<'py>(&self, py: Python<'py>) -> PyResult<Option<Array<'py>>> {
        let corners = |region: &Region| table(py, [*region.lower(), *region.upper()].concat(), &[2, 3]);
        self.core.region.as_ref().map(corners).transpose()
    }

    /// Order among the tasks of several tips: tasks of a lower level are met first, those of higher levels as far as these allow.
    #[getter]
    fn level(&self) -> u32 {
        self.core.level
    }

    fn __repr__(&self) -> String {
        let axis = match &self.core.kind {
            TaskKind::Pointing { axis } => Some(format!("axis={}", list_text(axis))),
            _ => None,
        };
        let matrix = |tool: &Pose| format!("tool={:?}", pose::rows(tool).as_chunks::<4>().0);
        let region = |region: &Region| format!("region=[{}, {}]", list_text(region.lower()), list_text(region.upper()));
        let options = [
            axis,
            self.core.weights().map(|weights| format!("weights={}", list_text(&weights))),
            self.core.tolerance().map(|tolerance| format!("tolerance={}", list_text(&tolerance))),
            self.core.tool.as_ref().map(matrix),
            self.core.region.as_ref().map(region),
            self.core.first.map(|first| format!("first='{first}'")),
            (self.core.level != 0).then(|| format!("level={}", self.core.level)),
        ];
        let given: Vec<_> = options.into_iter().flatten().collect();
        format!("tasks.{}({})", self.core.kind.name(), given.join(", "))
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<NewArguments<'py>> {
        let options = PyDict::new(py);
        if let TaskKind::Pointing { axis } = self.core.kind {
            options.set_item("axis", axis)?;
        }
        options.set_item("weights", self.weights(py))?;
        options.set_item("tolerance", self.tolerance(py))?;
        options.set_item("tool", self.tool(py))?;
        options.set_item("region", self.region(py)?)?;
        if let Some(first) = self.core.first {
            options.set_item("first", first.name())?;
        }
        if self.core.level != 0 {
            options.set_item("level", self.core.level)?;
        }
        Ok((PyTuple::empty(py), options))
    }
}

/// An optional argument.
type Argument<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

/// Makes an instance of a task's class, which adds no fields to kind, weights, tolerance, tool, region and level.
fn instance<C>(kind: TaskKind, options: [Argument<'_, '_>; 4], level: i128, class: C) -> PyResult<PyClassInitializer<C>>
where
    C: PyClass<BaseType = PyTask>,
{
    let core = made(kind, options, level)?;
    Ok(PyClassInitializer::from(PyTask { core }).add_subclass(class))
}

/// Makes a task.
fn made(kind: TaskKind, [weights, tolerance, tool, region]: [Argument<'_, '_>; 4], level: i128) -> PyResult<Task> {
    // Reads a number as a vector of one entry: the core's error then says how many entries it needs.
    let entries = |what, value: Argument<'_, '_>| value.map(|value| scalar_or_vector(what, value)).transpose();
    let weights = entries("weights", weights)?.map(|(weights, _)| weights);
    let tolerance = entries("tolerance", tolerance)?.map(|(tolerance, _)| tolerance);
    let tool = tool.map(|value| rigid("tool", value)).transpose()?;
    let level = count("level", level)?;
    let core = Task::new(kind, weights.as_deref(), tolerance.as_deref(), tool).map_err(raise)?.at_level(level);
    match region {
        None => Ok(core),
        Some(region) => {
            let [lower, upper] = corners("region", region)?;
            Region::new(lower, upper).and_then(|region| core.within(region)).map_err(raise)
        }
    }
}

/// Defines the class of a task without further options.
macro_rules! task {
    ($(#[$doc:meta])* $class:ident, $name:literal, $kind:expr) => {
        $(#[$doc])*
        ///     tool: (4, 4), pose of the tool in the frame of the tip; the tool reaches the target.
        ///     region: (2, 3) (m), lower and upper corner of the box in the frame of the base that the tip (or tool) stays in;
        ///         infinite on open sides. See `Task`.
        ///     level: Order among the tasks of several tips: tasks of a lower level are met first, those of higher levels as far as these
        ///         allow. Tasks of the same level share the error.
        #[pyclass(name = $name, module = "beetle_ik.tasks", extends = PyTask, frozen)]
        pub struct $class;

        #[pymethods]
        impl $class {
            #[new]
            #[pyo3(signature = (*, weights=None, tolerance=None, tool=None, region=None, level=0))]
            fn new(
                weights: Argument<'_, '_>,
                tolerance: Argument<'_, '_>,
                tool: Argument<'_, '_>,
                region: Argument<'_, '_>,
                level: i128,
            ) -> PyResult<PyClassInitializer<Self>> {
                instance($kind, [weights, tolerance, tool, region], level, Self)
            }
        }
    };
}

/// The whole pose.
///
/// Args:
///     weights: (6,), for x, y, z and the three components of the rotation vector, along the axes of the target; 0
///         leaves a component free.
///     tolerance: (6,) (m, rad), largest error of each component, instead of the tolerances of the call.
///     tool: (4, 4), pose of the tool in the frame of the tip; the tool reaches the target.
///     region: (2, 3) (m), lower and upper corner of the box in the frame of the base that the tip (or tool) stays in;
///         infinite on open sides. See `Task`.
///     first: "position" or "orientation", the part that is met exactly where the whole pose cannot be met; the other
///         comes as near as the first allows. The status is then `ROTATION_GIVEN_UP` or `POSITION_GIVEN_UP`. None:
///         "position" for an arm with fewer than six joints; for others both parts share the error. Not with weights
///         or a region.
///     level: Order among the tasks of several tips: tasks of a lower level are met first, those of higher levels as far as these
///         allow. Tasks of the same level share the error.
#[pyclass(name = "Pose", module = "beetle_ik.tasks", extends = PyTask, frozen)]
pub struct PyPose;

#[pymethods]
impl PyPose {
    #[new]
    #[pyo3(signature = (*, weights=None, tolerance=None, tool=None, region=None, first=None, level=0))]
    fn new(
        weights: Argument<'_, '_>,
        tolerance: Argument<'_, '_>,
        tool: Argument<'_, '_>,
        region: Argument<'_, '_>,
        #[pyo3(from_py_with = crate::convert::optional_text)] first: Option<&str>,
        level: i128,
    ) -> PyResult<PyClassInitializer<Self>> {
        let first: Option<First> = first.map(str::parse).transpose().map_err(raise)?;
        let task = made(TaskKind::Pose, [weights, tolerance, tool, region], level)?;
        let core = first.map_or(Ok(task), |first| task.with_first(first)).map_err(raise)?;
        Ok(PyClassInitializer::from(PyTask { core }).add_subclass(Self))
    }

    /// The part that is met exactly where the whole pose cannot be met: "position" or "orientation"; None: "position" for an arm
    /// with fewer than six joints.
    #[getter]
    fn first(self_: PyRef<'_, Self>) -> Option<&'static str> {
        self_.as_super().core.first.map(First::name)
    }
}

task! {
    /// The position only; the orientation is free. Of a target given as a pose, only the position counts.
    ///
    /// Args:
    ///     weights: (3,), for x, y and z of the base; 0 leaves a component free.
    ///     tolerance: (3,) (m), largest error of each component, instead of the tolerance of the call.
    PyPosition, "Position", TaskKind::Position
}

task! {
    /// The orientation only; the position is free.
    ///
    /// Args:
    ///     weights: (3,), for the components of the rotation vector along the axes of the target; 0 leaves one free.
    ///     tolerance: (3,) (rad), largest error of each component, instead of the tolerance of the call.
    PyOrientation, "Orientation", TaskKind::Orientation
}

/// The position, and the direction of one axis of the tip; rotation about that axis is free. `rotation_error` is the angle
/// between the axis and its target direction.
///
/// Args:
///     axis: (3,), in the frame of the tip, of any nonzero length; None: (0, 0, 1).
///     weights: (4,), for x, y and z along the axes of the target, and for the angle; 0 leaves a component free.
///     tolerance: (4,) (m, m, m, rad), largest error of each component, instead of the tolerances of the call.
///     tool: (4, 4), pose of the tool in the frame of the tip; the tool reaches the target.
///     region: (2, 3) (m), lower and upper corner of the box in the frame of the base that the tip (or tool) stays in;
///         infinite on open sides. See `Task`.
///     level: Order among the tasks of several tips: tasks of a lower level are met first, those of higher levels as far as these
///         allow. Tasks of the same level share the error.
#[pyclass(name = "Pointing", module = "beetle_ik.tasks", extends = PyTask, frozen)]
pub struct PyPointing;

#[pymethods]
impl PyPointing {
    #[new]
    #[pyo3(signature = (*, axis=None, weights=None, tolerance=None, tool=None, region=None, level=0))]
    fn new(
        axis: Argument<'_, '_>,
        weights: Argument<'_, '_>,
        tolerance: Argument<'_, '_>,
        tool: Argument<'_, '_>,
        region: Argument<'_, '_>,
        level: i128,
    ) -> PyResult<PyClassInitializer<Self>> {
        let axis = axis.map_or(Ok([0.0, 0.0, 1.0]), |axis| point("axis", axis))?;
        instance(TaskKind::Pointing { axis }, [weights, tolerance, tool, region], level, Self)
    }

    /// The axis in the frame of the tip (3,).
    #[getter]
    fn axis<'py>(self_: PyRef<'py, Self>) -> Option<Bound<'py, PyArray1<f64>>> {
        let py = self_.py();
        match self_.as_super().core.kind {
            TaskKind::Pointing { axis } => Some(copied(py, &axis)),
            _ => None,
        }
    }
}

/// Reads the `task` argument of a call.
pub fn read_task(value: Option<&Bound<'_, PyAny>>) -> PyResult<Option<Task>> {
    let Some(value) = value else { return Ok(None) };
    match value.cast::<PyTask>() {
        Ok(task) => Ok(Some(task.get().core)),
        Err(_) => Err(invalid(format!("task must be one of beetle_ik.tasks, got {}", summary(value)))),
    }
}

/// Returns the instance of `tasks` for a task.
pub fn task_object<'py>(py: Python<'py>, task: &Task) -> PyResult<Bound<'py, PyAny>> {
    let base = PyClassInitializer::from(PyTask { core: *task });
    match task.kind {
        TaskKind::Pose => Ok(Bound::new(py, base.add_subclass(PyPose))?.into_any()),
        TaskKind::Position => Ok(Bound::new(py, base.add_subclass(PyPosition))?.into_any()),
        TaskKind::Orientation => Ok(Bound::new(py, base.add_subclass(PyOrientation))?.into_any()),
        TaskKind::Pointing { .. } => Ok(Bound::new(py, base.add_subclass(PyPointing))?.into_any()),
    }
}
