//! The call `plan_moves`.

use super::around::MoveSurroundings;
use super::assembly::Assembly;
use super::follower::{Lost, Stray};
use super::ladder::{Cause, Dead, Ladder, LadderBlock, Rung, blocks};
use super::moves_options::MovesOptions;
use super::outline::outline;
use super::program::{JointGoal, Move, MoveKind, check_program, with_blends_that_count};
use super::tool_path::ToolPath;
use crate::error::{Error, Result};
use crate::ik::{AllOptions, SolveOptions, solve_all};
use crate::limits::StartSlack;
use crate::message::{Message, message};
use crate::obstacle::Clearance;
use crate::plan::{Cost, Plan};
use crate::robot::Robot;
use crate::solver::{Monitor, Status, Stopwatch};
use crate::task::Target;
use crate::timing::{ConstantLimits, JointPath};
use crate::wording::number;

/// Length past the place where a path is lost (m), at which its pose is solved for to learn why; also how exactly the end of the reach is
/// found.
const BEYOND: f64 = 1e-3;

/// Plans the motion of a program of `moves`, from rest at `start` to rest.
///
/// Configurations are chosen for the program as a whole: no joint meets its limit in the middle of a move. Each move of the tip is as fast
/// as asked for wherever the limits allow; what does not is in [`Plan::moves`].
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
    robot.require_one_tip(METHOD)?;
    let moves = &with_blends_that_count(moves);
    check_program(robot, moves)?;
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
    let stages = outline(robot, moves, &start)?;
    let blocks = blocks(&stages, moves);
    let each = SolveOptions {
        limits: Some(inside),
        surroundings: options.surroundings.clone(),
        seed: options.seed,
        ..SolveOptions::default()
    };
    let mut ladder = Ladder::new(around, each.clone());
    let climber = Climber { robot, limits: &limits, moves, blocks: &blocks, each };
    let rungs = match ladder.climb(&blocks, &start, monitor)? {
        Ok(rungs) => rungs,
        Err((block, dead)) => return Err(climber.no_way(block, dead, monitor)?),
    };
    let paths = climber.refined(&mut ladder, &rungs, monitor)?;
    let mut assembly = Assembly::new(around, moves, options, &start);
    assembly.add_all(&stages, &rungs, paths, monitor)?;
    let (trajectory, reports) = assembly.finish()?;
    let duration = trajectory.duration();
    let violations = limits.violations(&trajectory);
    let status = if violations.is_empty() { Status::Solved } else { Status::Stalled };
    let mut plan = Plan {
        violations,
        status,
        moves: reports,
        clearance: space.as_ref().map(|space| Clearance::at_least(space.margin())),
        surroundings: space.as_ref().map(|space| space.surroundings()),
        evaluations: ladder.evaluations,
        ..Plan::of(trajectory, Cost::Time, duration)
    };
    if plan.note_kept(robot, &options.keeps)?.is_some() {
        plan.status = Status::Stalled;
    }
    plan.elapsed = stopwatch.elapsed();
    Ok(plan)
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

/// What the search for configurations is about.
struct Climber<'a> {
    robot: &'a Robot,
    limits: &'a ConstantLimits,
    moves: &'a [Move],
    blocks: &'a [LadderBlock<'a>],
    each: SolveOptions,
}

impl Climber<'_> {
    /// The joint paths of all paths of the tip.
    fn refined(&self, ladder: &mut Ladder<'_>, rungs: &[Rung], monitor: &mut dyn Monitor) -> Result<Vec<JointPath>> {
        let mut paths = vec![];
        for (i, (block, rung)) in self.blocks.iter().zip(rungs).enumerate() {
            for (k, (path, track)) in block.paths.iter().zip(&rung.tracks).enumerate() {
                let (at, cause) = match ladder.follower().refined(path, track.clone(), self.limits)? {
                    Ok(joints) => {
                        paths.push(joints);
                        continue;
                    }
                    Err(Stray::Lost(Lost { at })) => (at, Cause::OutOfReach),
                    Err(Stray::Beyond { at, joint, value }) => (at, Cause::Limit { joint, value }),
                };
                return Err(self.no_way(i, Dead::Path { path: k, at, cause }, monitor)?);
            }
        }
        Ok(paths)
    }

    /// The error for a block without a configuration.
    fn no_way(&self, block: usize, dead: Dead, monitor: &mut dyn Monitor) -> Result<Error> {
        let (path, at, cause) = match dead {
            Dead::Goal(problem) => {
                let index = self.blocks[block].goal.map_or(0, |(index, _)| index);
                return Ok(Error::Unreachable { what: self.moves[index].named(index), problem });
            }
            Dead::Path { path, at, cause } => (self.blocks[block].paths[path], at, cause),
        };
        let (index, along) = path.place_on_move(at);
        let named = self.moves[index].named(index);
        let no_solution = match &cause {
            Cause::Blocked(_) => None,
            _ => self.end_of_reach(path, at, monitor)?,
        };
        let no_solution = no_solution.map(|(at, why)| message![format!("{} m along it, ", number(at)), why]);
        let along = number(along);
        let problem: Message = match (cause, no_solution) {
            (Cause::OutOfReach, Some(problem)) => return Ok(Error::Unreachable { what: named, problem }),
            (Cause::OutOfReach, None) => format!(
                "{along} m along it, the arm cannot go on from any configuration that it comes with, which a singularity explains; {}",
                self.advice(block)
            )
            .into(),
            (Cause::Limit { joint, value }, no_solution) => {
                let advice = match no_solution {
                    Some(place) => message!["no other configuration helps: ", place],
                    None => self.advice(block).into(),
                };
                message![format!("{along} m along it, {}; ", self.beyond_limits(joint, value)), advice]
            }
            (Cause::Blocked(fault), _) => format!("{along} m along it, {fault}").into(),
        };
        Ok(Error::NotFound { what: format!("a motion along {named}"), problem })
    }

    fn beyond_limits(&self, joint: usize, value: f64) -> String {
        let (name, value) = (self.limits.joint_name(joint), number(value));
        let [lower, upper] = [&self.limits.lower, &self.limits.upper].map(|limits| number(limits[joint]));
        format!("joint '{name}' would have to go to {value}, beyond its limits [{lower}, {upper}]")
    }

    /// Where a move has no configuration any more: the length along it, and why. `None` if some are found where its path was lost, at `at`,
    /// and it is not proven that its end has none.
    fn end_of_reach(&self, path: &ToolPath, at: f64, monitor: &mut dyn Monitor) -> Result<Option<(f64, Message)>> {
        let (index, along) = path.place_on_move(at);
        let end = path.ends_of_moves().find(|(each, _)| *each == index).map_or(path.length(), |(_, end)| end);
        let mut solutions = |s: f64| {
            let options = AllOptions { each: self.each.clone(), limit: Some(1), ..AllOptions::default() };
            solve_all(self.robot, &Target::Pose(path.pose(s)), &options, monitor)
        };
        let lost = solutions((at + BEYOND).min(path.length()))?;
        if lost.obstruction.is_some() {
            return Ok(Some((along, lost.message())));
        }
        let mut beyond = solutions(end)?;
        if beyond.obstruction.is_none() {
            return Ok(lost.solutions.is_empty().then(|| (along, lost.message())));
        }
        let (mut near, mut far) = (at, end);
        while far - near > BEYOND {
            let middle = 0.5 * (near + far);
            let found = solutions(middle)?;
            if found.obstruction.is_some() {
                (far, beyond) = (middle, found);
            } else {
                near = middle;
            }
        }
        Ok(Some((path.place_on_move(far).1, beyond.message())))
    }

    fn advice(&self, block: usize) -> &'static str {
        match self.blocks[block].goal {
            Some((_, JointGoal::Pose(_))) => "divide it by a joint move, or move it",
            Some(_) => {
                "give the joint move before it a pose in place of a configuration, so that the planner can choose one"
            }
            None => "begin with a joint move to a pose, so that the planner can choose the configuration",
        }
    }
}
