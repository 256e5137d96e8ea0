//! `plan_point_to_point`.

use ikcore::planning::{self, Endpoint, PointToPointOptions};
use numpy::PyUntypedArrayMethods;
use pyo3::prelude::*;

use super::elbow::read_elbows;
use super::plan::PyPlan;
use crate::convert::{array, count, vector};
use crate::error::{invalid, raise};
use crate::ik::read_target;
use crate::limits::{PyLimits, Sampling, limits_of_call};
use crate::monitor::watched;
use crate::obstacle::Obstacles;
use crate::robot::PyRobot;
use crate::solver::{PyStop, derivative_free_solver};

/// Plans a motion from one end to another, at rest at both.
///
/// Args:
///     robot: the arm.
///     start, end: position (3,) (m) or pose (4, 4) of the tip; the configuration is the planner's choice.
///     start_q, end_q: instead of them, joint angles (n,).
///     limits: positions, velocities and accelerations to keep; None: the robot's.
///     method: "minmax": the ends' configurations that are nearest in time, joined at the limits' pace; "tpbso":
///         polynomials through a via point, searched by a beetle swarm (Wang et al. 2019).
///     objective: what to minimise: "time", "joint_travel" or "tip_travel".
///     obstacles: what the robot may not touch, from `bik.obstacles`; it may never touch itself if it has capsules.
///     margin: distance to keep from obstacles and between links (m); None: 1 mm.
///     elbows: for "tpbso" on planar arms, the sign of the second joint's angle at start and end, 1 or -1; None: (1, 1).
///     solver: what searches; None: the method's own.
///     stop: budgets; None: the method's own.
///     seed: seed of the random draws; the same seed gives the same bits.
///     progress: True shows a progress bar; a callable is called with (done, total).
///
/// Returns:
///     A `Plan`. That no plan keeps everything is a status beside the least violating trajectory, not an error.
///
/// Raises:
///     InvalidInputError: wrong shape, NaN, an end that cannot be reached (which, and by how much).
///     LimitError: limits that contradict themselves or exclude an end.
///     UnsupportedLimit: jerk limits, or limits that vary in time.
#[pyfunction]
#[pyo3(signature = (robot, start=None, end=None, *, start_q=None, end_q=None, limits=None, method="minmax",
                    objective="time", obstacles=None, margin=None, elbows=None, solver=None, stop=None, seed=0,
                    progress=None))]
#[allow(clippy::too_many_arguments)]
pub fn plan_point_to_point(
    py: Python<'_>,
    robot: &Bound<'_, PyRobot>,
    start: Option<&Bound<'_, PyAny>>,
    end: Option<&Bound<'_, PyAny>>,
    start_q: Option<&Bound<'_, PyAny>>,
    end_q: Option<&Bound<'_, PyAny>>,
    limits: Option<&PyLimits>,
    method: &str,
    objective: &str,
    obstacles: Option<&Bound<'_, PyAny>>,
    margin: Option<f64>,
    elbows: Option<[i128; 2]>,
    solver: Option<&Bound<'_, PyAny>>,
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
        method: method.parse().map_err(raise)?,
        objective: objective.parse().map_err(raise)?,
        obstacles: obstacles.core,
        margin,
        elbows: elbows.map(read_elbows).transpose()?,
        limits: resolved,
        solver: solver.map(|solver| derivative_free_solver("plan_point_to_point", solver)).transpose()?,
        stop: stop.map(PyStop::core),
        seed: count("seed", seed)?,
    };
    let plan = watched(py, progress, |watcher| planning::plan_point_to_point(&arm, &start, &end, &options, watcher))?;
    PyPlan::new(plan, None, robot, in_force, given)
}

/// An end given as a target or as joint angles.
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
