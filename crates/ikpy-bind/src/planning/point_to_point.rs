//! `plan_point_to_point`.

use ikcore::planning::{self, PointToPointOptions};
use pyo3::prelude::*;

use super::endpoints::{read_ends, read_start};
use super::plan::PyPlan;
use super::tpbso::read_method;
use crate::convert::{count, vector};
use crate::error::raise;
use crate::limits::{PyLimits, Sampling, limits_of_call};
use crate::monitor::watched;
use crate::obstacle::Obstacles;
use crate::python_calls;
use crate::robot::PyRobot;
use crate::solver::PyStop;
use crate::task::read_task;

/// Plans a motion between two ends, to rest at the end.
///
/// Args:
///     robot: the arm.
///     start, end: position (3,) (m) or pose (4, 4) of the tip; the planner chooses the configuration. Several ends, (k, 3) or
///         (k, 4, 4), are alternatives, such as grasps: the planner takes the one with the lowest cost, `Plan.chosen_end`.
///     start_q, end_q: joint positions (n,) instead; for the end also several, (k, n).
///     start_qd: velocity at the start (n,) (rad/s, m/s), with start_q, "minmax" and acceleration or jerk limits; None: at
///         rest. If the arm cannot move to the end directly, it first stops as quickly as the limits allow.
///     task: which part of the poses counts, one of `tasks`, as for `solve`; None: all of it.
///     limits: position, velocity, acceleration and jerk limits; None: the robot's.
///     method: "minmax": joins the two configurations of the ends that are nearest in time, as fast as the limits allow;
///         "tpbso" or `TPBSO(...)`: polynomials through a via point, found by a beetle swarm (Wang et al. 2019).
///     objective: quantity to minimise, "time", "joint_travel" or "tip_travel".
///     obstacles: a `Scene` or a list of obstacles that the robot must not touch.
///     margin: least distance from obstacles and between links (m); None: 1 mm.
///     self_collision: whether links must keep clear of each other; None: where the robot has bodies.
///     stop: budgets; None: the method's own.
///     seed: seed of the random draws; the same seed gives the same bits.
///     progress: True shows a progress bar; a callable is called with (done, total).
///
/// Returns:
///     A `Plan`. If no plan meets all requirements, its status says so, and its trajectory violates them least.
///
/// Raises:
///     InvalidInputError: wrong shape, NaN, or an end that cannot be reached (names the end and the distance); of several ends
///         only if none can be reached.
///     LimitError: limits that contradict each other or exclude an end.
///     InfeasibleError: an arm that cannot stop from start_qd before an obstacle or a position limit.
///     UnsupportedLimit: limits that vary in time; jerk limits with "tpbso" (`Plan.retime` adds them).
#[pyfunction]
#[pyo3(signature = (robot, start=None, end=None, *, start_q=None, end_q=None, start_qd=None, task=None, limits=None, method=None, objective="time",
                    obstacles=None, margin=None, self_collision=None, stop=None, seed=0, progress=None),
       text_signature = "(robot, start=None, end=None, *, start_q=None, end_q=None, start_qd=None, task=None, limits=None, \
                         method='minmax', objective='time', obstacles=None, margin=None, self_collision=None, stop=None, seed=0, \
                         progress=None)")]
#[allow(clippy::too_many_arguments)]
pub fn plan_point_to_point(
    py: Python<'_>,
    robot: &Bound<'_, PyRobot>,
    start: Option<&Bound<'_, PyAny>>,
    end: Option<&Bound<'_, PyAny>>,
    start_q: Option<&Bound<'_, PyAny>>,
    end_q: Option<&Bound<'_, PyAny>>,
    start_qd: Option<&Bound<'_, PyAny>>,
    task: Option<&Bound<'_, PyAny>>,
    limits: Option<&PyLimits>,
    method: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = crate::convert::text)] objective: &str,
    obstacles: Option<&Bound<'_, PyAny>>,
    margin: Option<f64>,
    self_collision: Option<bool>,
    stop: Option<&PyStop>,
    seed: i128,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<PyPlan> {
    let arm = robot.get().core.clone();
    let (start, ends) = (read_start(start, start_q)?, read_ends(end, end_q)?);
    let (in_force, resolved) = limits_of_call(py, limits, robot.get(), &Sampling::once())?;
    let obstacles = Obstacles::read(py, obstacles)?;
    let given = obstacles.tuple;
    let options = PointToPointOptions {
        start_velocity: start_qd.map(|qd| vector("start_qd", qd)).transpose()?,
        task: read_task(task)?,
        method: read_method(method)?,
        objective: objective.parse().map_err(raise)?,
        obstacles: obstacles.core,
        margin,
        self_collision,
        limits: resolved,
        stop: stop.map(PyStop::core),
        seed: count("seed", seed)?,
    };
    let plan = watched(py, progress, |watcher| planning::plan_point_to_point(&arm, &start, &ends, &options, watcher))?;
    python_calls::log(py, format!("plan_point_to_point: {}", plan.message()))?;
    PyPlan::new(plan, robot, in_force, given)
}
