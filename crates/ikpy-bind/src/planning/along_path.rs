//! `plan_along_path`.

use ikcore::obstacle::Surroundings;
use ikcore::path::Waypoints;
use ikcore::planning::{self, AlongPathOptions, TipPath};
use numpy::PyUntypedArrayMethods;
use pyo3::prelude::*;

use super::plan::PyPlan;
use super::tpbso::read_method;
use crate::convert::{array, count, rigid_matrices, shape_text};
use crate::error::{invalid, raise};
use crate::joint_order::joint_vector;
use crate::keep::read_keeps;
use crate::limits::{PyLimits, Sampling, limits_of_call};
use crate::monitor::watched;
use crate::obstacle::GivenObstacles;
use crate::path::PyPath;
use crate::python_calls;
use crate::robot::PyRobot;
use crate::solver::{PyStop, derivative_free_solver};
use crate::start_gate::read_slack;
use crate::task::read_task;
use crate::units;
use crate::wording::said;

/// Plans a motion that moves the tip along a path.
///
/// Args:
///     robot: the arm.
///     path: a `Path`, whose timing is ignored, or points (k, 3) (m) or poses (k, 4, 4), joined by straight lines.
///     start_q: joint positions (n,) at the start; None: chosen by the planner.
///     start_slack: as for `plan_point_to_point`; where no motion leads a joint inside at once, it goes no farther out, and is inside
///         at the end.
///     task: part of the poses that counts, one of `tasks`, with a tool if needed. Each component stays within its
///         `tolerance` at every instant; a component of weight 0 is free. The planner uses this freedom. None: the
///         whole pose.
///     keep: further constraints at every instant, a `Keep` or a list of them, with "timed": for example, that a tool whose orientation the
///         path leaves free stays upright.
///     limits: position, velocity, acceleration, jerk, tip and torque limits; None: the robot's.
///     method: "timed": optimises redundancy and timing together; "tpbso" or `TPBSO(...)`: redundancy by a beetle swarm,
///         uniform timing, splines through every second point (Wang et al. 2019), for planar arms.
///     objective: quantity to minimise, "time" or "joint_travel".
///     obstacles: a `Scene` or a list of obstacles to keep clear of, with "timed".
///     margin: least distance from obstacles and between links (m); None: 1 mm.
///     self_collision: whether links must keep clear of each other; None: where `obstacles` are given.
///     accuracy: largest distance of the tip from the path (m), also between points, and largest rotation from it
///         (rad). It determines how many points of the path the motion passes, and how far it may round corners. None: a
///         thousandth of the path's extent,
///         plus the rise of the arc through neighbouring points where points are given; for "tpbso" 4 %. If the `task`
///         has tolerances, the accuracy is part of them and must not exceed the smallest.
///     breaks: whether the tool may leave the path, with "timed". Where no motion follows the whole path, the plan then leaves it as few times
///         as possible: the tool draws back along its axis (by any clear way where that is not free), moves to where another posture can
///         go on, and comes near again, from rest to rest. What no posture reaches, or in none the joints can hold, is left out. `Plan.breaks` says where, when and why.
///     solver: solver of the search of "timed", for an arm with redundancy; None: pattern search from the motion
///         found first. `TPBSO` has a
///         solver of its own.
///     stop: budgets; None: the method's own.
///     seed: seed of the random draws; the same seed gives the same bits.
///     progress: True shows a progress bar; a callable is called with (done, total).
///
/// Returns:
///     A `Plan`. If no plan meets all requirements, its status says so, and its trajectory violates them least. With
///     obstacles, a successful plan is certified to keep the margin at every instant; if none is found, the status is
///     IN_COLLISION, and the message names the place on the path, the two bodies and the depth.
///
/// Raises:
///     InvalidInputError: wrong shape, NaN, fewer than two points, points out of reach, a start in collision, obstacles and
///         a robot without bodies, `breaks` with "tpbso", no way beside the path at a break, or a start_q at which `keep` does not hold.
///     LimitError: limits that contradict each other; a start farther outside them than start_slack.
///     UnsupportedLimit: limits that vary in time, no acceleration limits with "timed", or jerk limits with "tpbso"
///         (`Plan.retime` adds them).
///
/// For example:
///
///     >>> arm = bik.Robot.planar([1.0, 1.0, 1.0])
///     >>> star = bik.paths.pentagram((1.0, 1.0, 0.0), 5.0, radius=0.5)
///     >>> plan = bik.plan_along_path(arm, star, limits=bik.Limits(velocity=3.0, acceleration=10.0))
///     >>> plan.success
///     True
#[pyfunction]
#[pyo3(signature = (robot, path, *, start_q=None, start_slack=None, task=None, keep=None, limits=None, method=None, objective="time", obstacles=None,
                    margin=None, self_collision=None, accuracy=None, breaks=false, solver=None, stop=None, seed=0, progress=None),
       text_signature = "(robot, path, *, start_q=None, start_slack=None, task=None, keep=None, limits=None, method='timed', objective='time', \
                         obstacles=None, margin=None, self_collision=None, accuracy=None, breaks=False, solver=None, stop=None, \
                         seed=0, progress=None)")]
#[allow(clippy::too_many_arguments)]
pub fn plan_along_path(
    py: Python<'_>,
    robot: &Bound<'_, PyRobot>,
    path: &Bound<'_, PyAny>,
    start_q: Option<&Bound<'_, PyAny>>,
    start_slack: Option<&Bound<'_, PyAny>>,
    task: Option<&Bound<'_, PyAny>>,
    keep: Option<&Bound<'_, PyAny>>,
    limits: Option<&PyLimits>,
    method: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = crate::convert::text)] objective: &str,
    obstacles: Option<&Bound<'_, PyAny>>,
    margin: Option<f64>,
    self_collision: Option<bool>,
    accuracy: Option<f64>,
    breaks: bool,
    solver: Option<&Bound<'_, PyAny>>,
    stop: Option<&PyStop>,
    seed: i128,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<PyPlan> {
    let arm = robot.get().core.clone();
    robot.get().core.require_one_tip("plan_along_path").map_err(raise)?;
    let tip_path = read_tip_path(py, path)?;
    let doubtful = |point| units::of_point(&arm, "path", ikcore::task::Subject::Tip(0), point);
    units::doubt(tip_path.points().positions().iter().find_map(doubtful))?;
    let (in_force, resolved) = limits_of_call(py, limits, robot.get(), &Sampling::once())?;
    let given = GivenObstacles::read_for(py, robot.get(), obstacles)?;
    let options = AlongPathOptions {
        method: read_method(method)?,
        objective: objective.parse().map_err(raise)?,
        start: start_q.map(|q| joint_vector(&arm, "start_q", q)).transpose()?,
        start_slack: read_slack(start_slack)?,
        task: read_task(task)?,
        keeps: read_keeps(robot.get(), keep)?,
        surroundings: Surroundings { obstacles: obstacles.map(|_| given.core), margin, self_collision },
        limits: resolved,
        accuracy,
        breaks,
        solver: solver.map(|solver| derivative_free_solver("plan_along_path", solver)).transpose()?,
        stop: stop.map(PyStop::core),
        seed: count("seed", seed)?,
    };
    let plan = watched(py, progress, |watcher| planning::plan_along_path(&arm, &tip_path, &options, watcher))?;
    python_calls::log(py, "plan_along_path", &said(&plan.message()))?;
    PyPlan::new(plan, robot, in_force, given.tuple)
}

/// Reads a `Path`, points (k, 3) or poses (k, 4, 4).
fn read_tip_path(py: Python<'_>, path: &Bound<'_, PyAny>) -> PyResult<TipPath> {
    match path.cast::<PyPath>() {
        Ok(path) => path.get().tip_path(py),
        Err(_) => TipPath::through(&read_points(path)?).map_err(raise),
    }
}

/// Reads points (k, 3) or poses (k, 4, 4).
fn read_points(path: &Bound<'_, PyAny>) -> PyResult<Waypoints> {
    let rows = array("path", path)?;
    let numbers = rows.as_slice()?;
    match rows.shape() {
        [_, 3] => Waypoints::new(numbers.as_chunks().0.to_vec(), None).map_err(raise),
        [_, 4, 4] => {
            let poses = rigid_matrices(numbers)?;
            let positions = poses.iter().map(|pose| pose.translation.vector.into()).collect();
            let rotations = poses.iter().map(|pose| *pose.rotation.matrix()).collect();
            Waypoints::new(positions, Some(rotations)).map_err(raise)
        }
        shape => Err(invalid(format!(
            "path: expected a Path, points (k, 3) or poses (k, 4, 4), got shape {}",
            shape_text(shape)
        ))),
    }
}
