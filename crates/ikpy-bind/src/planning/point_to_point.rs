//! `plan_point_to_point`.

use ikcore::planning;
use pyo3::prelude::*;

use super::plan::PyPlan;
use super::plan_arguments::{EndArguments, PlanArguments};
use crate::monitor::{Watcher, watched};
use crate::python_calls;
use crate::robot::PyRobot;
use crate::wording::said;

/// Plans a motion between two ends, which comes to rest at the second.
///
/// Args:
///     robot: the arm.
///     start, end: position (3,) (m) or pose (4, 4) of the tip; the planner chooses the configuration. Several ends,
///         (k, 3) or (k, 4, 4), are alternatives, for example grasps: the planner takes the one with the lowest cost,
///         `Plan.chosen_end`. For a robot with several `tips`, dicts as for `solve`; several ends are a list of dicts.
///     start_q, end_q: joint positions (n,) instead; for the end also several, (k, n).
///     start_qd: velocity at the start (n,) (rad/s, m/s), with start_q, "minmax" and acceleration or jerk limits; None: at
///         rest. If the arm cannot move to the end directly, it first stops as quickly as the limits allow.
///     start_slack: how far start_q may be outside its position limits (rad, m), a number or (n,); the motion then begins there and
///         goes inside. None: 5 degrees, 5 mm for joints that slide. Rounding is taken off in any case.
///     end_turns: "nearest": joints that turn without limits go the short way round, and may end whole turns away from end_q (see
///         `Plan.end_turned`); among obstacles they go the other way where that is free. "as_given": they end at end_q.
///     approach: straight line of the tip before the end: its length (m), along the tip's z axis, or a `StraightLine`.
///         The line has constant orientation, begins and ends at rest, and is followed within 0.1 mm.
///     retreat: straight line of the tip after the start, against the z axis, otherwise like `approach`.
///     free_start: whether the arm may start nearer to something than the margin. It then moves out first, and no two
///         bodies come nearer than at the start; see `Plan.freed`.
///     task: part of the poses that counts, one of `tasks`, as for `solve`; None: all of it.
///     keep: constraints at every instant of the motion, a `Keep` or a list of them, such as `upright(robot, tilt=0.1)`. It is certified,
///         not sampled; `Plan.kept` has the largest errors.
///     limits: position, velocity, acceleration, jerk, tip and torque limits; None: the robot's.
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
///         only if none can be reached. A start_q or end_q at which `keep` does not hold (names the error and its tolerance).
///     LimitError: limits that contradict each other or exclude an end; a start farther outside them than start_slack (names the
///         joint and the remedy).
///     InfeasibleError: an arm that cannot stop from start_qd before an obstacle or a position limit, or within tip or torque limits.
///     UnsupportedLimit: limits that vary in time; jerk limits with "tpbso" (`Plan.retime` adds them).
///
/// For example:
///
///     >>> robot = bik.Robot.named("ur5e")
///     >>> home = [0, -1.5, 1.5, -1.5, -1.5, 0]
///     >>> limits = bik.Limits(acceleration=10.0)
///     >>> plan = bik.plan_point_to_point(robot, start_q=home, end=[0.4, 0.1, 0.3], limits=limits)
///     >>> plan.success
///     True
#[pyfunction]
#[pyo3(signature = (robot, start=None, end=None, *, start_q=None, end_q=None, start_qd=None, start_slack=None, end_turns=None,
                    approach=None, retreat=None, free_start=None, task=None, keep=None, limits=None, method=None, objective=None, obstacles=None, margin=None,
                    self_collision=None, stop=None, seed=None, progress=None),
       text_signature = "(robot, start=None, end=None, *, start_q=None, end_q=None, start_qd=None, start_slack=None, \
                         end_turns='nearest', approach=None, retreat=None, free_start=False, task=None, keep=None, limits=None, method='minmax', objective='time', \
                         obstacles=None, margin=None, self_collision=None, stop=None, seed=0, progress=None)")]
#[allow(clippy::too_many_arguments)]
pub fn plan_point_to_point<'py>(
    py: Python<'py>,
    robot: &Bound<'py, PyRobot>,
    start: Option<Bound<'py, PyAny>>,
    end: Option<Bound<'py, PyAny>>,
    start_q: Option<Bound<'py, PyAny>>,
    end_q: Option<Bound<'py, PyAny>>,
    start_qd: Option<Bound<'py, PyAny>>,
    start_slack: Option<Bound<'py, PyAny>>,
    end_turns: Option<Bound<'py, PyAny>>,
    approach: Option<Bound<'py, PyAny>>,
    retreat: Option<Bound<'py, PyAny>>,
    free_start: Option<Bound<'py, PyAny>>,
    task: Option<Bound<'py, PyAny>>,
    keep: Option<Bound<'py, PyAny>>,
    limits: Option<Bound<'py, PyAny>>,
    method: Option<Bound<'py, PyAny>>,
    objective: Option<Bound<'py, PyAny>>,
    obstacles: Option<Bound<'py, PyAny>>,
    margin: Option<Bound<'py, PyAny>>,
    self_collision: Option<Bound<'py, PyAny>>,
    stop: Option<Bound<'py, PyAny>>,
    seed: Option<Bound<'py, PyAny>>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<PyPlan> {
    let arm = robot.get().core.clone();
    let ends = EndArguments { start, end, start_q, end_q };
    let asked = PlanArguments {
        start_qd,
        start_slack,
        end_turns,
        approach,
        retreat,
        free_start,
        task,
        keep,
        limits,
        method,
        objective,
        obstacles,
        margin,
        self_collision,
        stop,
        seed,
    };
    let options = asked.read(py, robot.get())?;
    let (start, ends) = ends.read(robot.get(), &asked.task)?;
    let call = |watcher: &mut Watcher| planning::plan_point_to_point(&arm, &start, &ends, &options.core, watcher);
    let plan = watched(py, progress, call)?;
    python_calls::log(py, "plan_point_to_point", &said(&plan.message()))?;
    PyPlan::new(plan, robot, options.limits, options.obstacles)
}
