//! The search for the configurations of a program, and the errors where it fails.

use super::follower::{Lost, Stray};
use super::ladder::Ladder;
use super::ladder_block::LadderBlock;
use super::moving_tip::MovingTip;
use super::program::{JointGoal, Move};
use super::rung::{Cause, Dead, Rung};
use super::tool_path::ToolPath;
use crate::error::{Error, Result};
use crate::ik::{AllOptions, SolveOptions, solve_all};
use crate::math::Pose;
use crate::message::{Message, message};
use crate::solver::Monitor;
use crate::task::Target;
use crate::timing::{ConstantLimits, JointPath};
use crate::wording::number;

/// Length (m) past the loss of a path at which its pose is solved to learn why; also the accuracy of the end of the reach.
const BEYOND: f64 = 1e-3;

/// Note in errors of robots whose tips share joints.
const SHARED: &str = "; joints that move another tip too stay where they are";

/// Inputs of the search for configurations.
pub(super) struct Climber<'a> {
    pub tips: &'a [MovingTip<'a>],
    pub limits: &'a ConstantLimits,
    pub moves: &'a [Move],
    pub blocks: &'a [LadderBlock<'a>],
    /// Options of searches for the task of each tip.
    pub searches: Vec<SolveOptions>,
    /// Whether errors say how far the reach goes.
    pub explains: bool,
}

impl Climber<'_> {
    /// The joint paths of all paths of the tip.
    pub fn refined(
        &self,
        ladder: &mut Ladder<'_>,
        rungs: &[Rung],
        monitor: &mut dyn Monitor,
    ) -> Result<Vec<JointPath>> {
        let mut paths = vec![];
        for (i, (block, rung)) in self.blocks.iter().zip(rungs).enumerate() {
            for (k, (path, track)) in block.paths.iter().zip(&rung.tracks).enumerate() {
                let (at, cause) = match ladder.follower(path.tip).refined(path, track.clone(), self.limits)? {
                    Ok(joints) => {
                        paths.push(joints);
                        continue;
                    }
                    Err(Stray::Lost(Lost { at })) => (at, Cause::OutOfReach),
                    Err(Stray::Beyond { at, joint, value }) => (at, Cause::Limit { joint, value }),
                    Err(Stray::Still { at }) => return Err(self.stands_still(path, at)),
                };
                return Err(self.no_way(i, Dead::Path { path: k, at, cause }, monitor)?);
            }
        }
        Ok(paths)
    }

    /// The error for a block without a configuration; with several tips it says which joints stay.
    pub fn no_way(&self, block: usize, dead: Dead, monitor: &mut dyn Monitor) -> Result<Error> {
        let is_shared = |joint: usize| self.tips.iter().all(|tip| !tip.owns(joint));
        let note = (0..self.limits.dof()).any(is_shared).then_some(SHARED);
        let noted = |problem: Message| match note {
            Some(note) => message![problem, note],
            None => problem,
        };
        Ok(match self.why_no_way(block, dead, monitor)? {
            Error::Unreachable { what, problem } => Error::Unreachable { what, problem: noted(problem) },
            Error::NotFound { what, problem } => Error::NotFound { what, problem: noted(problem) },
            other => other,
        })
    }

    fn why_no_way(&self, block: usize, dead: Dead, monitor: &mut dyn Monitor) -> Result<Error> {
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
            _ if !self.explains => None,
            _ => self.end_of_reach(block, path, at, monitor)?,
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

    /// The error for a path on which the arm need not move.
    fn stands_still(&self, path: &ToolPath, at: f64) -> Error {
        let (index, along) = path.place_on_move(at);
        let problem = format!(
            "the task leaves the tip so free that the arm need not move {} m along it: leave it out, or ask for more of the pose",
            number(along)
        );
        Error::NotFound { what: format!("a motion along {}", self.moves[index].named(index)), problem: problem.into() }
    }

    fn beyond_limits(&self, joint: usize, value: f64) -> String {
        let (name, value) = (self.limits.joint_name(joint), number(value));
        let [lower, upper] = [&self.limits.lower, &self.limits.upper].map(|limits| number(limits[joint]));
        format!("joint '{name}' would have to go to {value}, beyond its limits [{lower}, {upper}]")
    }

    /// Returns the length along a move beyond which it has no configuration, and why. `None` if some are found where its path was lost, at
    /// `at`, and it is not proven that its end has none.
    fn end_of_reach(
        &self,
        block: usize,
        path: &ToolPath,
        at: f64,
        monitor: &mut dyn Monitor,
    ) -> Result<Option<(f64, Message)>> {
        let (tip, each, stem) = (&self.tips[path.tip], &self.searches[path.tip], self.blocks[block].stem);
        let (index, along) = path.place_on_move(at);
        let end = path.ends_of_moves().find(|(each, _)| *each == index).map_or(path.length(), |(_, end)| end);
        let mut solutions = |s: f64| {
            let options = AllOptions { each: each.clone(), limit: Some(1), ..AllOptions::default() };
            let seen = tip.seen(&Pose::from(path.pose(s)), stem);
            solve_all(tip.solved(), &Target::from(&seen), &options, monitor)
        };
        let lost = solutions((at + BEYOND).min(path.length()))?;
        if each.task.is_some() {
            // No closed form proves anything of a part of a pose.
            let problem = || "no configuration was found there that meets the task".into();
            return Ok(lost.solutions.is_empty().then(|| (along, problem())));
        }
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
