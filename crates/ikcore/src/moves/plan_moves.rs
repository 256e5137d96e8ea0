//! The call `plan_moves`.

use super::around::MoveSurroundings;
use super::move_task::MoveTask;
use super::moves_options::MovesOptions;
use super::moving_tip::{MovingTip, led_by};
use super::program::{JointGoal, Move, MoveKind, check_program, with_blends_that_count};
use super::program_planner::ProgramPlanner;
use crate::error::{Error, Result};
use crate::limits::StartSlack;
use crate::plan::Plan;
use crate::robot::Robot;
use crate::solver::{Monitor, Status, Stopwatch};
use crate::timing::ConstantLimits;

/// Plans the motion of a program of `moves`, from rest at `start` to rest.
///
/// Configurations are chosen for the program as a whole: no joint meets its limit in the middle of a move. Each move of the tip is as fast
/// as requested wherever the limits allow; [`Plan::moves`] names the limits that slow it.
///
/// With a [task](MovesOptions::task) that leaves a part of the poses free, programs for tasks that ask for more, from whole poses on, are
/// planned too, and the fastest is taken: freedom never makes a program slower.
///
/// # Errors
/// [`Error::InvalidMove`] for a move that contradicts itself or its neighbours, [`Error::Unreachable`] and [`Error::NotFound`] for one that
/// the arm cannot make, each with the name of the move; any [`Error`] for other wrong input.
pub fn plan_moves(
    robot: &Robot,
    moves: &[Move],
    start: &[f64],
    options: &MovesOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    const METHOD: &str = "plan_moves";
    let stopwatch = Stopwatch::start();
    let tips = MovingTip::all(robot, options)?;
    let moves = &with_blends_that_count(moves);
    check_program(robot, moves)?;
    require_movable(&tips, moves)?;
    robot.check("start_q", start)?;
    let limits = ConstantLimits::for_robot(robot, options.limits.as_ref(), METHOD)?;
    limits.require_accelerations(METHOD)?;
    options.keeps.iter().try_for_each(|keep| keep.require_tips(robot))?;
    let space = options.surroundings.clear_space(robot)?;
    let around = MoveSurroundings { robot, limits: &limits, space: space.as_ref(), keeps: &options.keeps };
    let inside = limits.position_limits(robot)?;
    let admitted = |what: &str, q: &[f64]| -> Result<Vec<f64>> {
        let q = inside.admit_start(Some(robot), what, q, &StartSlack::NONE)?.q;
        around.refuse(what, &q)?;
        Ok(q)
    };
    let start = admitted("start_q", start)?;
    let moves = &with_goals(moves, admitted)?;
    let planner = ProgramPlanner { around, tips: &tips, moves, start: &start, options, explains: true };
    let mut planned = planner.plan(monitor);
    let mut evaluations = count(&planned);
    for tighter in tighter(&tips) {
        if let Err(Error::Interrupted) = planned {
            break;
        }
        let other = ProgramPlanner { tips: &tighter, explains: false, ..planner }.plan(monitor);
        evaluations += count(&other);
        planned = better(planned, other);
    }
    let mut plan = planned?;
    plan.evaluations = evaluations;
    plan.elapsed = stopwatch.elapsed();
    Ok(plan)
}

/// The same tips with stricter tasks: without tolerances where there are some, and for whole poses.
fn tighter<'a>(tips: &[MovingTip<'a>]) -> impl Iterator<Item = Vec<MovingTip<'a>>> {
    let all = |tighter: fn(&MoveTask) -> MoveTask| tips.iter().map(|tip| tip.with_task(tighter(&tip.task))).collect();
    let has_tolerance = tips.iter().any(|tip| tip.task.has_tolerance());
    let leaves_a_part = tips.iter().any(|tip| !tip.task.is_whole());
    let exact: Option<Vec<_>> = has_tolerance.then(|| all(MoveTask::exact));
    let whole: Option<Vec<_>> = leaves_a_part.then(|| all(|_| MoveTask::default()));
    exact.into_iter().chain(whole)
}

/// Checks that joints move each tip that a move names while the others stay.
///
/// # Errors
/// [`Error::InvalidMove`].
fn require_movable(tips: &[MovingTip<'_>], moves: &[Move]) -> Result<()> {
    let is_stuck = |each: &Move| each.tip.is_some() && !led_by(tips, each)[0].is_movable();
    match moves.iter().enumerate().find(|(_, each)| is_stuck(each)) {
        None => Ok(()),
        Some((i, each)) => {
            let problem = format!(
                "no joint moves tip '{}' alone, and joints that move other tips too stay where they are: give a joint move to a configuration",
                each.tip.as_deref().unwrap_or_default()
            );
            Err(Error::InvalidMove { what: each.named(i), problem: problem.into() })
        }
    }
}

fn count(planned: &Result<Plan>) -> usize {
    planned.as_ref().map_or(0, |plan| plan.evaluations)
}

/// Returns the better of two plans, the second for a stricter task: one that keeps everything, then the faster one. Of two errors the first
/// one, but for an interruption.
fn better(planned: Result<Plan>, tighter: Result<Plan>) -> Result<Plan> {
    let (one, other) = match (&planned, &tighter) {
        (_, Err(Error::Interrupted)) | (Err(_), Ok(_)) => return tighter,
        (_, Err(_)) => return planned,
        (Ok(one), Ok(other)) => (one, other),
    };
    let [is_solved, is_other_solved] = [one, other].map(|plan| plan.status == Status::Solved);
    let is_first = if is_solved == is_other_solved { one.cost <= other.cost } else { is_solved };
    if is_first { planned } else { tighter }
}

/// The moves with the configurations that the gate `admitted`.
fn with_goals(moves: &[Move], admitted: impl Fn(&str, &[f64]) -> Result<Vec<f64>>) -> Result<Vec<Move>> {
    let with_goal = |(i, each): (usize, &Move)| {
        let MoveKind::Joints(JointGoal::Configuration(q)) = &each.kind else { return Ok(each.clone()) };
        let q = admitted(&format!("joint positions of {}", each.named(i)), q)?;
        Ok(Move { kind: MoveKind::Joints(JointGoal::Configuration(q)), ..each.clone() })
    };
    moves.iter().enumerate().map(with_goal).collect()
}
