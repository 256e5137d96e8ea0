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
use crate::robot::PyRobot;
use crate::solver::PyStop;

/// Plans a motion from one end to another, at rest at both.
///
/// Args:
///     robot: the arm.
///     start, end: position (3,) (m) or pose (4, 4) of the tip; the configuration is the planner's choice.
///     start_q, end_q: instead of them, joint angles (n,).
///     limits: positions, velocities and accelerations to keep; None: the robot's.
///     method: "minmax": the configurations of both ends that are nearest in time, joined as fast as the limits allow;
///         "tpbso" or `TPBSO(...)`: polynomials through a via point, found by a beetle swarm (Wang et al. 2019).
///     objective: what to minimise: "time", "joint_travel" or "tip_travel".
///     obstacles: shapes from `bik.obstacles` to avoid. A robot that has capsules avoids itself too.
///     margin: distance to keep from obstacles and between links (m); None: 1 mm.
///     stop: budget of the search; None: the method's own.
///     seed: of the random draws: the same seed, the same bits.
///     progress: True for a bar on the terminal, or a callable of (done, total).
///
/// Returns:
///     A `Plan`. Where no plan keeps everything, its status says so and its trajectory is the least violating one.
///
/// Raises:
///     InvalidInputError: wrong shape, NaN, an end that cannot be reached (which, and by how much).
///     LimitError: limits that contradict themselves or exclude an end.
///     UnsupportedLimit: jerk limits, or limits that vary in time.
#[pyfunction]
#[pyo3(signature = (robot, start=None, end=None, *, start_q=None, end_q=None, limits=None, method=None, objective="time",
                    obstacles=None, margin=None, stop=None, seed=0, progress=None),
       text_signature = "(robot, start=None, end=None, *, start_q=None, end_q=None, limits=None, method='minmax', \
                         objective='time', obstacles=None, margin=None, stop=None, seed=0, progress=None)")]
#[allow(clippy::too_many_arguments)]
pub fn plan_point_to_point(
    py: Python<'_>,
    robot: &Bound<'_, PyRobot>,
    start: Option<&Bound<'_, PyAny>>,
    end: Option<&Bound<'_, PyAny>>,
    start_q: Option<&Bound<'_, PyAny>>,
    end_q: Option<&Bound<'_, PyAny>>,
    limits: Option<&PyLimits>,
    method: Option<&Bound<'_, PyAny>>,
    objective: &str,
    obstacles: Option<&Bound<'_, PyAny>>,
    margin: Option<f64>,
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
        method: read_method(method)?,
        objective: objective.parse().map_err(raise)?,
        obstacles: obstacles.core,
        margin,
        limits: resolved,
        stop: stop.map(PyStop::core),
        seed: count("seed", seed)?,
    };
    let plan = watched(py, progress, |watcher| planning::plan_point_to_point(&arm, &start, &end, &options, watcher))?;
    PyPlan::new(plan, robot, in_force, given)
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
