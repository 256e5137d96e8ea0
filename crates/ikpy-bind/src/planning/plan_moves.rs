//! `plan_moves`.

use ikcore::obstacle::Surroundings;
use ikcore::planning::{self, JointGoal, Move, MoveKind, MovesOptions};
use ikcore::robot::Robot;
use ikcore::units::{self, UnitDoubt};
use pyo3::prelude::*;

use super::moves::read_moves;
use super::plan::PyPlan;
use crate::convert::count;
use crate::joint_order::joint_vector;
use crate::keep::read_keeps;
use crate::limits::{PyLimits, Sampling, limits_of_call};
use crate::monitor::watched;
use crate::obstacle::GivenObstacles;
use crate::python_calls;
use crate::robot::PyRobot;
use crate::solver::PyStop;
use crate::tips::read_tip_tasks;
use crate::units::doubt;
use crate::wording::said;

/// Plans the motion of a program of moves, from rest at `start_q` to rest.
///
/// Configurations are chosen for the program as a whole, so that no joint meets its limit in the middle of a move: branches and whole
/// turns, and the posture of a redundant arm. Lines and arcs are kept within 10 micrometres, a blend stays within its radius, and the
/// speed asked for is kept between blends to 0.1 % wherever the limits allow; `Plan.moves` says where they do not.
///
/// With obstacles, joint moves find a way around them, and configurations are chosen whose paths are clear; the whole motion is
/// certified between samples too.
///
/// Args:
///     robot: the arm, or a robot with several tips, of which each move to a pose names one. That tip is led by the joints that move
///         no other one, so that all others stay where they are.
///     moves: the program, a sequence of `moves.Joints`, `moves.Line`, `moves.Arc` and `moves.Wait`. Messages count them from 0.
///     start_q: joint positions (n,) at the start.
///     task: what lines, arcs and joint moves to poses must meet of their poses, one of `tasks`, with a tool if needed: free spin about
///         an axis of the tip with `tasks.Pointing`, positions alone, or orientations within tolerances. Positions stay on the lines and
///         arcs whatever their tolerance. None: whole poses. For a robot with several tips one task for all of them, or a dict by tip.
///     limits: position, velocity, acceleration, jerk, tip and torque limits; None: the robot's.
///     obstacles: a `Scene` or a list of obstacles to keep clear of.
///     margin: least distance from obstacles and between links (m); None: 1 mm.
///     self_collision: whether links must keep clear of each other; None: where `obstacles` are given.
///     keep: constraints at every instant of the motion, a `Keep` or a list of them.
///     stop: budgets of the search for each joint move among obstacles; None: as for `plan_point_to_point`.
///     seed: seed of the random draws; the same seed gives the same bits.
///     progress: True shows a progress bar; a callable is called with (done, total).
///
/// Returns:
///     A `Plan`, whose `moves` has a `MoveReport` for each move.
///
/// Raises:
///     InvalidInputError: wrong shape or NaN; a program without moves or one that takes no time; a speed that is not positive, an
///         arc whose points are on a line, a blend that does not fit, and a move that the arm cannot make, or not without a
///         collision, each by the name of the move; a start or joint positions in collision; obstacles and a robot without
///         bodies; a task that leaves a part of the position free, has a region or an order, or a tolerance that no path is kept to; a
///         move that names no tip of several, or one that no joint moves alone, and a blend from one tip to another.
///     UnknownNameError: a tip that the robot has not.
///     LimitError: limits that contradict each other; a start or joint positions outside them.
///     UnsupportedLimit: limits that vary in time, or no acceleration limits.
///
/// For example:
///
///     >>> arm = bik.Robot.named("ur5e")
///     >>> q = [0.0, -1.5, 1.8, -1.9, -1.57, 0.0]
///     >>> down = arm.fk(q)
///     >>> down[2, 3] -= 0.1
///     >>> program = [bik.moves.Line(down, speed=0.05, name="down"), bik.moves.Wait(0.5)]
///     >>> plan = bik.plan_moves(arm, program, start_q=q, limits=bik.Limits(acceleration=5.0))
///     >>> [move.name for move in plan.moves], round(plan.moves[0].speed, 4)
///     (['down', None], 0.05)
#[pyfunction]
#[pyo3(signature = (robot, moves, *, start_q, task=None, limits=None, obstacles=None, margin=None, self_collision=None, keep=None,
                    stop=None, seed=0, progress=None))]
#[allow(clippy::too_many_arguments)]
pub fn plan_moves(
    py: Python<'_>,
    robot: &Bound<'_, PyRobot>,
    moves: &Bound<'_, PyAny>,
    start_q: &Bound<'_, PyAny>,
    task: Option<&Bound<'_, PyAny>>,
    limits: Option<&PyLimits>,
    obstacles: Option<&Bound<'_, PyAny>>,
    margin: Option<f64>,
    self_collision: Option<bool>,
    keep: Option<&Bound<'_, PyAny>>,
    stop: Option<&PyStop>,
    seed: i128,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<PyPlan> {
    let arm = robot.get().core.clone();
    let moves = read_moves(moves)?;
    doubt(moves.iter().enumerate().filter_map(doubted_speed))?;
    doubt(moves.iter().enumerate().filter_map(|(index, each)| doubted_place(&arm, index, each)))?;
    let start = joint_vector(&arm, "start_q", start_q)?;
    let (in_force, resolved) = limits_of_call(py, limits, robot.get(), &Sampling::once())?;
    let given = GivenObstacles::read_for(py, robot.get(), obstacles)?;
    let (task, tip_tasks) = read_tip_tasks(robot.get(), task)?;
    let options = MovesOptions {
        task,
        tip_tasks,
        surroundings: Surroundings { obstacles: obstacles.map(|_| given.core), margin, self_collision },
        keeps: read_keeps(robot.get(), keep)?,
        limits: resolved,
        stop: stop.map(PyStop::core),
        seed: count("seed", seed)?,
    };
    let plan = watched(py, progress, |watcher| planning::plan_moves(&arm, &moves, &start, &options, watcher))?;
    python_calls::log(py, "plan_moves", &said(&plan.message()))?;
    PyPlan::new(plan, robot, in_force, given.tuple)
}

/// Doubts the position that a move leads a tip to.
fn doubted_place(robot: &Robot, index: usize, each: &Move) -> Option<UnitDoubt> {
    let tip = each.tip.as_deref().map_or(Some(0), |name| robot.tip_number(name).ok())?;
    let pose = match &each.kind {
        MoveKind::Line { pose, .. } | MoveKind::Arc { pose, .. } | MoveKind::Joints(JointGoal::Pose(pose)) => pose,
        MoveKind::Joints(JointGoal::Configuration(_)) | MoveKind::Wait(_) => return None,
    };
    units::of_position(robot, &format!("move {index}"), &[tip], &pose.translation.vector.into())
}

/// Doubts the speed of a move.
fn doubted_speed((index, each): (usize, &Move)) -> Option<UnitDoubt> {
    match each.kind {
        MoveKind::Line { speed, .. } | MoveKind::Arc { speed, .. } => {
            units::of_tip_speed(&format!("speed of move {index}"), speed?)
        }
        MoveKind::Joints(_) | MoveKind::Wait(_) => None,
    }
}
