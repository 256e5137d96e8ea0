//! The plan of a program for one task.

use super::around::MoveSurroundings;
use super::assembly::Assembly;
use super::climber::Climber;
use super::ladder::Ladder;
use super::ladder_block::blocks;
use super::moves_options::MovesOptions;
use super::moving_tip::MovingTip;
use super::outline::outline;
use super::program::Move;
use crate::error::Result;
use crate::ik::SolveOptions;
use crate::obstacle::{Clearance, Surroundings};
use crate::plan::{Cost, Plan};
use crate::solver::{Monitor, Status};

/// A checked program, and the task of each tip.
#[derive(Clone, Copy)]
pub(super) struct ProgramPlanner<'a> {
    pub around: MoveSurroundings<'a>,
    pub tips: &'a [MovingTip<'a>],
    pub moves: &'a [Move],
    pub start: &'a [f64],
    pub options: &'a MovesOptions,
    /// Whether errors explain why there is no motion, which takes time.
    pub explains: bool,
}

impl ProgramPlanner<'_> {
    /// Plans the motion.
    ///
    /// # Errors
    /// As [`plan_moves`](super::plan_moves()).
    pub fn plan(&self, monitor: &mut dyn Monitor) -> Result<Plan> {
        let Self { around, tips, moves, start, options, explains } = *self;
        let limits = around.limits;
        let stages = outline(tips, moves, start)?;
        let blocks = blocks(tips, &stages, moves, start);
        let searches = tips.iter().map(|tip| self.search(tip)).collect::<Result<Vec<_>>>()?;
        let mut ladder = Ladder::new(around, tips, &searches);
        let of_task =
            |(tip, each): (&MovingTip<'_>, &SolveOptions)| SolveOptions { task: tip.task.searched(), ..each.clone() };
        let searches = tips.iter().zip(&searches).map(of_task).collect();
        let climber = Climber { tips, limits, moves, blocks: &blocks, searches, explains };
        let rungs = match ladder.climb(&blocks, start, monitor)? {
            Ok(rungs) => rungs,
            Err((block, dead)) => return Err(climber.no_way(block, dead, monitor)?),
        };
        let paths = climber.refined(&mut ladder, &rungs, monitor)?;
        let mut assembly = Assembly::new(around, tips, moves, options, start);
        assembly.add_all(&stages, &rungs, paths, monitor)?;
        let (trajectory, reports) = assembly.finish()?;
        let duration = trajectory.duration();
        let violations = limits.violations(&trajectory);
        let status = if violations.is_empty() { Status::Solved } else { Status::Stalled };
        let mut plan = Plan {
            violations,
            status,
            moves: reports,
            clearance: around.space.map(|space| Clearance::at_least(space.margin())),
            surroundings: around.space.map(|space| space.surroundings()),
            evaluations: ladder.evaluations,
            ..Plan::of(trajectory, Cost::Time, duration)
        };
        plan.note_kept(around.robot, &options.keeps)?;
        Ok(plan)
    }

    /// Options of searches for configurations of a tip. Collisions of several tips are left to the ladder, which knows all joints.
    fn search(&self, tip: &MovingTip<'_>) -> Result<SolveOptions> {
        let surroundings =
            if self.tips.len() == 1 { self.options.surroundings.clone() } else { Surroundings::default() };
        Ok(SolveOptions {
            limits: Some(tip.solved_limits(self.around.limits)?),
            surroundings,
            seed: self.options.seed,
            ..SolveOptions::default()
        })
    }
}
