//! The call `plan_moves`.

use super::assembly::Assembly;
use super::ladder::{Block, Cause, Dead, Ladder, Rung, blocks};
use super::outline::outline;
use super::program::{Move, check_program};
use super::tool_path::ToolPath;
use crate::error::{Error, Result};
use crate::ik::{AllOptions, SolveOptions, solve_all};
use crate::limits::{Limits, StartSlack};
use crate::message::{Message, message};
use crate::plan::{Cost, Plan};
use crate::robot::{Robot, limit_rounding};
use crate::solver::{Monitor, Status, Stopwatch};
use crate::task::Target;
use crate::timing::{ConstantLimits, JointPath};
use crate::wording::number;

/// Options of [`plan_moves`].
#[derive(Debug, Clone, Default)]
pub struct MovesOptions {
    /// Limits to keep. `None` means the robot's.
    pub limits: Option<Limits>,
    /// Seed of the random draws; the same seed gives the same bits.
    pub seed: u64,
}

/// Length past the place where a path is lost (m), at which its pose is solved for to learn why.
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
    check_program(robot, moves)?;
    robot.check("start_q", start)?;
    let limits = ConstantLimits::for_robot(robot, options.limits.as_ref(), METHOD)?;
    limits.require_accelerations(METHOD)?;
    let start = limits.position_limits(robot)?.admit_start(Some(robot), "start_q", start, &StartSlack::NONE)?.q;
    let steps = outline(robot, moves, &start)?;
    let blocks = blocks(&steps, moves);
    let each = SolveOptions { limits: options.limits.clone(), seed: options.seed, ..SolveOptions::default() };
    let mut ladder = Ladder::new(robot, &limits, each.clone());
    let climber = Climber { robot, limits: &limits, moves, blocks: &blocks, each };
    let rungs = match ladder.climb(&blocks, &start, monitor)? {
        Ok(rungs) => rungs,
        Err((block, dead)) => return Err(climber.no_way(block, dead, monitor)?),
    };
    let paths = climber.refined(&mut ladder, &rungs, monitor)?;
    let mut assembly = Assembly::new(robot, &limits, moves, &start);
    assembly.add_all(&steps, &rungs, paths)?;
    let (trajectory, reports) = assembly.finish()?;
    let duration = trajectory.duration();
    let violations = limits.violations(&trajectory);
    let status = if violations.is_empty() { Status::Solved } else { Status::Stalled };
    Ok(Plan {
        violations,
        status,
        moves: reports,
        evaluations: ladder.evaluations,
        elapsed: stopwatch.elapsed(),
        ..Plan::of(trajectory, Cost::Time, duration)
    })
}

/// What the search for configurations is about.
struct Climber<'a> {
    robot: &'a Robot,
    limits: &'a ConstantLimits,
    moves: &'a [Move],
    blocks: &'a [Block<'a>],
    each: SolveOptions,
}

impl Climber<'_> {
    /// The joint paths of all paths of the tip.
    fn refined(&self, ladder: &mut Ladder<'_>, rungs: &[Rung], monitor: &mut dyn Monitor) -> Result<Vec<JointPath>> {
        let mut paths = vec![];
        for (i, (block, rung)) in self.blocks.iter().zip(rungs).enumerate() {
            for (k, (path, track)) in block.paths.iter().zip(&rung.tracks).enumerate() {
                let lost = |at: f64, cause: Cause| Dead::Path { path: k, at, cause };
                match ladder.follower().refined(path, track.clone())? {
                    Err(place) => return Err(self.no_way(i, lost(place.at, Cause::OutOfReach), monitor)?),
                    Ok(joints) => match self.excess(&joints) {
                        Some((joint, value)) => {
                            return Err(self.no_way(i, lost(0.0, Cause::Limit { joint, value }), monitor)?);
                        }
                        None => paths.push(joints),
                    },
                }
            }
        }
        Ok(paths)
    }

    /// A joint that leaves its limits, and its value.
    fn excess(&self, path: &JointPath) -> Option<(usize, f64)> {
        (0..self.robot.dof()).find_map(|joint| {
            let (lower, upper) = (self.limits.lower[joint], self.limits.upper[joint]);
            let rounding = limit_rounding(lower, upper);
            let [lowest, highest] = path.range(joint);
            (lowest < lower - rounding)
                .then_some((joint, lowest))
                .or((highest > upper + rounding).then_some((joint, highest)))
        })
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
        let (index, along) = place_on(path, at);
        let named = self.moves[index].named(index);
        let problem: Message = match cause {
            Cause::Limit { joint, value } => {
                let (lower, upper) = (self.limits.lower[joint], self.limits.upper[joint]);
                format!(
                    "{} m along it, joint '{}' would have to go to {}, beyond its limits [{}, {}]; {}",
                    number(along),
                    self.limits.joint_name(joint),
                    number(value),
                    number(lower),
                    number(upper),
                    self.advice(block)
                )
                .into()
            }
            Cause::OutOfReach => {
                let pose = path.pose((at + BEYOND).min(path.length()));
                let options = AllOptions { each: self.each.clone(), ..AllOptions::default() };
                let found = solve_all(self.robot, &Target::Pose(pose), &options, monitor)?;
                if found.solutions.is_empty() {
                    let problem = message![format!("{} m along it, ", number(along)), found.message()];
                    return Ok(Error::Unreachable { what: named, problem });
                }
                format!(
                    "{} m along it, the arm cannot go on from any configuration that it comes with, which a singularity explains; {}",
                    number(along),
                    self.advice(block)
                )
                .into()
            }
        };
        Ok(Error::NotFound { what: format!("a motion along {named}"), problem })
    }

    fn advice(&self, block: usize) -> &'static str {
        match self.blocks[block].goal {
            Some((_, super::program::JointGoal::Pose(_))) => "divide it by a joint move, or move it",
            Some(_) => "give the joint move before it a pose in place of a configuration, so that the planner can choose one",
            None => "begin with a joint move to a pose, so that the planner can choose the configuration",
        }
    }
}

/// The move at the length `at` of a path, and the length along that move.
fn place_on(path: &ToolPath, at: f64) -> (usize, f64) {
    let index = path.pieces[path.piece_at(at)].index;
    let begin = path.pieces.iter().position(|piece| piece.index == index).map_or(0.0, |first| path.breaks[first]);
    (index, at - begin)
}
