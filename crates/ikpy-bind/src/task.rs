//! `tasks`: what of a target matters.

use ikcore::math::{Pose, pose};
use ikcore::task::{Region, Task, TaskKind};
use numpy::{PyArray1, PyArray2};
use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::convert::{Array, copied, corners, point, pose_array, rigid, row, scalar_or_vector, summary, table};
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

/// What of a target matters: one of `Pose`, `Position`, `Orientation` and `Pointing`.
///
/// With a `region`, the tip is kept in a box, p_min < p < p_max: eq. (5) of Cheng et al. (2020). A target outside is approached
/// as far as the box allows, and the status is `HELD_IN_REGION`. No solution is `SOLVED` or `HELD_IN_REGION` with the tip
/// outside; a track never leaves the box at the end of a tick, whatever its solver. Between two ticks the joints move in straight
/// lines, the tip does not quite.
#[pyclass(name = "Task", module = "beetle_ik.tasks", frozen, subclass, eq)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyTask {
    core: Task,
}

#[pymethods]
impl PyTask {
    /// Factors on the components; None: all one. A component of weight zero is left free.
    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.core.weights().map(|weights| row(py, weights))
    }

    /// Largest error of each component (m, rad); None: the tolerances of the call.
    #[getter]
    fn tolerance<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.core.tolerance().map(|tolerance| row(py, tolerance))
    }

    /// From the tip to what is to reach the target (4, 4); None: the tip itself.
    #[getter]
    fn tool<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        self.core.tool.as_ref().map(|tool| pose_array(py, tool)).transpose()
    }

    /// The corners of the box that the tip is kept in (2, 3) (m); None: anywhere.
    #[getter]
    fn region<'py>(&self, py: Python<'py>) -> PyResult<Option<Array<'py>>> {
        let corners = |region: &Region| table(py, [*region.lower(), *region.upper()].concat(), &[2, 3]);
        self.core.region.as_ref().map(corners).transpose()
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
        options.set_item("tool", self.tool(py)?)?;
        options.set_item("region", self.region(py)?)?;
        Ok((PyTuple::empty(py), options))
    }
}

/// An argument that may be left out.
type Argument<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

/// A task of a class that adds nothing to what all of them take besides their kind: weights, tolerance,
/// tool and region.
fn made<C>(
    kind: TaskKind,
    [weights, tolerance, tool, region]: [Argument<'_, '_>; 4],
    class: C,
) -> PyResult<PyClassInitializer<C>>
where
    C: PyClass<BaseType = PyTask>,
{
    // One number is one too few: the core says how many there should be.
    let entries = |what, value: Argument<'_, '_>| value.map(|value| scalar_or_vector(what, value)).transpose();
    let weights = entries("weights", weights)?.map(|(weights, _)| weights);
    let tolerance = entries("tolerance", tolerance)?.map(|(tolerance, _)| tolerance);
    let tool = tool.map(|value| rigid("tool", value)).transpose()?;
    let core = Task::new(kind, weights.as_deref(), tolerance.as_deref(), tool).map_err(raise)?;
    let core = match region {
        None => core,
        Some(region) => {
            let [lower, upper] = corners("region", region)?;
            Region::new(lower, upper).and_then(|region| core.within(region)).map_err(raise)?
        }
    };
    Ok(PyClassInitializer::from(PyTask { core }).add_subclass(class))
}

/// The class of a task whose kind says it all.
macro_rules! task {
    ($(#[$doc:meta])* $class:ident, $name:literal, $kind:expr) => {
        $(#[$doc])*
        ///     tool: (4, 4), from the tip to what is to reach the target.
        ///     region: (2, 3) (m), lower and upper corner of a box in the frame of the base that the tip (or its tool) is kept in;
        ///         infinite where it is open. See `Task`.
        #[pyclass(name = $name, module = "beetle_ik.tasks", extends = PyTask, frozen)]
        pub struct $class;

        #[pymethods]
        impl $class {
            #[new]
            #[pyo3(signature = (*, weights=None, tolerance=None, tool=None, region=None))]
            fn new(
                weights: Argument<'_, '_>,
                tolerance: Argument<'_, '_>,
                tool: Argument<'_, '_>,
                region: Argument<'_, '_>,
            ) -> PyResult<PyClassInitializer<Self>> {
                made($kind, [weights, tolerance, tool, region], Self)
            }
        }
    };
}

task! {
    /// The whole pose.
    ///
    /// Args:
    ///     weights: (6,), factors on x, y, z and on the three components of the rotation vector, along the axes of the target;
    ///         zero leaves a component free.
    ///     tolerance: (6,) (m, rad), largest error of each component, instead of the tolerances of the call.
    PyPose, "Pose", TaskKind::Pose
}

task! {
    /// The position alone; the orientation is left free. Takes the position of a target that is a pose.
    ///
    /// Args:
    ///     weights: (3,), factors on x, y and z of the base; zero leaves a component free.
    ///     tolerance: (3,) (m), largest error of each component, instead of the tolerance of the call.
    PyPosition, "Position", TaskKind::Position
}

task! {
    /// The orientation alone; the position is left free.
    ///
    /// Args:
    ///     weights: (3,), factors on the components of the rotation vector along the axes of the target; zero leaves one free.
    ///     tolerance: (3,) (rad), largest error of each component, instead of the tolerance of the call.
    PyOrientation, "Orientation", TaskKind::Orientation
}

/// The position, and the direction of one axis of the tip; the spin about it is left free. `rotation_error` is the angle
/// between that axis and the same one of the target.
///
/// Args:
///     axis: (3,), in the tip's coordinates, of any length but zero.
///     weights: (4,), factors on x, y and z along the axes of the target, and on the angle; zero leaves a component free.
///     tolerance: (4,) (m, m, m, rad), largest error of each component, instead of the tolerances of the call.
///     tool: (4, 4), from the tip to what is to reach the target.
///     region: (2, 3) (m), lower and upper corner of a box in the frame of the base that the tip (or its tool) is kept in;
///         infinite where it is open. See `Task`.
#[pyclass(name = "Pointing", module = "beetle_ik.tasks", extends = PyTask, frozen)]
pub struct PyPointing;

#[pymethods]
impl PyPointing {
    #[new]
    #[pyo3(signature = (*, axis=None, weights=None, tolerance=None, tool=None, region=None))]
    fn new(
        axis: Argument<'_, '_>,
        weights: Argument<'_, '_>,
        tolerance: Argument<'_, '_>,
        tool: Argument<'_, '_>,
        region: Argument<'_, '_>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let axis = axis.map_or(Ok([0.0, 0.0, 1.0]), |axis| point("axis", axis))?;
        made(TaskKind::Pointing { axis }, [weights, tolerance, tool, region], Self)
    }

    /// In the tip's coordinates (3,).
    #[getter]
    fn axis<'py>(self_: PyRef<'py, Self>) -> Option<Bound<'py, PyArray1<f64>>> {
        let py = self_.py();
        match self_.as_super().core.kind {
            TaskKind::Pointing { axis } => Some(copied(py, &axis)),
            _ => None,
        }
    }
}

/// The task of a call, if one is given.
pub fn read_task(value: Option<&Bound<'_, PyAny>>) -> PyResult<Option<Task>> {
    let Some(value) = value else { return Ok(None) };
    match value.cast::<PyTask>() {
        Ok(task) => Ok(Some(task.get().core)),
        Err(_) => Err(invalid(format!("task must be of beetle_ik.tasks, got {}", summary(value)))),
    }
}
