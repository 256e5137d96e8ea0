//! `plan_point_to_point`.

use ikcore::planning::{self, Endpoint, PointToPointOptions};
use numpy::PyUntypedArrayMethods;
use pyo3::prelude::*;

use super::plan::PyPlan;
use super::tpbso::read_method;
use crate::convert::{array, count, vector};
use crate::error::{invalid, raise};
use crate::ik::read_target;
use crate::limits::{PyLimits, Sampling, limits_of_call};
use crate::monitor::watched;
use crate::obstacle::Obstacles;
use crate::python_calls;
use crate::robot::PyRobot;
use crate::solver::PyStop;

/// Plans a motion between two ends, to rest at the end.
///
/// Args:
///     robot: the arm.
///     start, end: position (3,) (m) or pose (4, 4) of the tip; the planner chooses the configuration.
///     start_q, end_q: joint positions (n,) instead.
///     start_qd: velocity at the start (n,) (rad/s, m/s), with start_q, "minmax" and acceleration or jerk limits; None: at
///         rest. If the arm cannot move to the end directly, it first stops as quickly as the limits allow.
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
///     InvalidInputError: wrong shape, NaN, or an end that cannot be reached (names the end and the distance).
///     LimitError: limits that contradict each other or exclude an end.
///     InfeasibleError: an arm that cannot stop from start_qd before an obstacle or a position limit.
///     UnsupportedLimit: limits that vary in time; jerk limits with "tpbso" (`Plan.retime` adds them).
#[pyfunction]
#[pyo3(signature = (robot, start=None, end=None, *, start_q=None, end_q=None, start_qd=None, limits=None, method=None, objective="time",
                    obstacles=None, margin=None, self_collision=None, stop=None, seed=0, progress=None),
       text_signature = "(robot, start=None, end=None, *, start_q=None, end_q=None, start_qd=None, limits=None, method='minmax', \
                         objective='time', obstacles=None, margin=None, self_collision=None, stop=None, seed=0, \
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
    let (start, end) = (read_end("start", start, start_q)?, read_end("end", end, end_q)?);
    let (in_force, resolved) = limits_of_call(py, limits, robot.get(), &Sampling::once())?;
    let obstacles = Obstacles::read(py, obstacles)?;
    let given = obstacles.tuple;
    let options = PointToPointOptions {
        start_velocity: start_qd.map(|qd| vector("start_qd", qd)).transpose()?,
        method: read_method(method)?,
        objective: objective.parse().map_err(raise)?,
        obstacles: obstacles.core,
        margin,
        self_collision,
        limits: resolved,
        stop: stop.map(PyStop::core),
        seed: count("seed", seed)?,
    };
    let plan = watched(py, progress, |watcher| planning::plan_point_to_point(&arm, &start, &end, &options, watcher))?;
    python_calls::log(py, format!("plan_point_to_point: {}", plan.message()))?;
    PyPlan::new(plan, robot, in_force, given)
}

/// Reads an end given as a target or as joint positions.
fn read_end(name: &str, target: Option<&Bound<'_, PyAny>>, q: Option<&Bound<'_, PyAny>>) -> PyResult<Endpoint> {
    match (target, q) {
        (Some(target), None) => match array(name, target)?.shape() {
            [n] if *n != 3 => Err(invalid(format!(
                "{name}: expected a pose (4, 4) or a position (3,), got shape ({n},); joint angles go to {name}_q"
            ))),
            _ => read_target(name, target).map(Endpoint::Target),
        },
        (None, Some(q)) => vector(&format!("{name}_q"), q).map(Endpoint::Configuration),
        (None, None) => Err(invalid(format!("no {name} was given: give {name}= a position or pose, or {name}_q="))),
        (Some(_), Some(_)) => Err(invalid(format!("both {name} and {name}_q were given: give one of them"))),
    }
}
