//! `plan_along_path`.

use ikcore::path::Reference;
use ikcore::planning::{self, AlongPathOptions};
use numpy::PyUntypedArrayMethods;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use super::elbow::read_elbow;
use super::plan::PyPlan;
use crate::convert::{array, count, rigid_matrices, shape_text, vector};
use crate::error::{invalid, raise};
use crate::limits::{PyLimits, Sampling, limits_of_call};
use crate::monitor::watched;
use crate::path::PyPath;
use crate::robot::PyRobot;
use crate::solver::{PyStop, derivative_free_solver};

/// Plans a motion whose tip follows a path, in order.
///
/// Args:
///     robot: the arm.
///     path: a `Path`, whose times do not matter here, or points (k, 3) (m) or poses (k, 4, 4).
///     start_q: joint angles (n,) to start from; None: the planner's choice.
///     limits: positions, velocities and accelerations to keep; None: the robot's.
///     method: "timed": redundancy and the fastest timing found together; "tpbso": redundancy by a beetle swarm, uniform
///         time, splines through every second point (Wang et al. 2019).
///     objective: what to minimise: "time" or "joint_travel".
///     elbow: for "tpbso", the sign of the second joint's angle, 1 or -1, unless start_q says it.
///     accuracy: how far the tip may be from the points (m); None: what suits the method.
///     solver: what searches; None: the method's own.
///     stop: budgets; None: the method's own.
///     seed: of the random draws: the same seed, the same bits.
///     progress: True for a bar on the terminal, or a callable of (done, total).
///
/// Returns:
///     A `Plan`. That no plan keeps everything is a status beside the least violating trajectory, not an error.
///
/// Raises:
///     InvalidInputError: wrong shape, NaN, fewer than two points, points out of reach.
///     LimitError: limits that contradict themselves.
///     UnsupportedLimit: jerk limits, or limits that vary in time.
#[pyfunction]
#[pyo3(signature = (robot, path, *, start_q=None, limits=None, method="timed", objective="time", elbow=1, accuracy=None,
                    solver=None, stop=None, seed=0, progress=None))]
#[allow(clippy::too_many_arguments)]
pub fn plan_along_path(
    py: Python<'_>,
    robot: &Bound<'_, PyRobot>,
    path: &Bound<'_, PyAny>,
    start_q: Option<&Bound<'_, PyAny>>,
    limits: Option<&PyLimits>,
    method: &str,
    objective: &str,
    elbow: i128,
    accuracy: Option<f64>,
    solver: Option<&Bound<'_, PyAny>>,
    stop: Option<&PyStop>,
    seed: i128,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<PyPlan> {
    let arm = robot.get().core.clone();
    let reference = read_path(py, path)?;
    let (in_force, resolved) = limits_of_call(py, limits, robot.get(), &Sampling::once())?;
    let options = AlongPathOptions {
        method: method.parse().map_err(raise)?,
        objective: objective.parse().map_err(raise)?,
        start: start_q.map(|q| vector("start_q", q)).transpose()?,
        limits: resolved,
        elbow: read_elbow("elbow", elbow)?,
        accuracy,
        solver: solver.map(|solver| derivative_free_solver("plan_along_path", solver)).transpose()?,
        stop: stop.map(PyStop::core),
        seed: count("seed", seed)?,
    };
    let plan = watched(py, progress, |watcher| planning::plan_along_path(&arm, &reference, &options, watcher))?;
    let positions = (0..reference.len()).flat_map(|i| reference.position(i)).collect();
    PyPlan::new(plan, Some(positions), robot, in_force, PyTuple::empty(py).unbind())
}

/// Intervals that a `Path` is divided into: the published planner's.
const INTERVALS: f64 = 50.0;

/// A `Path`, or points (k, 3), or poses (k, 4, 4).
fn read_path(py: Python<'_>, path: &Bound<'_, PyAny>) -> PyResult<Reference> {
    if let Ok(path) = path.cast::<PyPath>() {
        let path = path.get();
        return path.reference(py, path.duration() / INTERVALS);
    }
    let rows = array("path", path)?;
    let numbers = rows.as_slice()?;
    match rows.shape() {
        [_, 3] => Reference::new(1.0, numbers.as_chunks().0.to_vec(), None).map_err(raise),
        [_, 4, 4] => {
            let poses = rigid_matrices(numbers)?;
            let positions = poses.iter().map(|pose| pose.translation.vector.into()).collect();
            let rotations = poses.iter().map(|pose| *pose.rotation.matrix()).collect();
            Reference::new(1.0, positions, Some(rotations)).map_err(raise)
        }
        shape => Err(invalid(format!(
            "path: expected a Path, points (k, 3) or poses (k, 4, 4), got shape {}",
            shape_text(shape)
        ))),
    }
}
