//! The plan of a program for one task.

use super::around::MoveSurroundings;
use super::assembly::Assembly;
use super::climber::Climber;
use super::ladder::{Ladder, blocks};
use super::move_task::MoveTask;
use super::moves_options::MovesOptions;
use super::outline::outline;
use super::program::Move;
use crate::error::Result;
use crate::ik::SolveOptions;
use crate::obstacle::Clearance;
use crate::plan::{Cost, Plan};
use crate::robot::Robot;
use crate::solver::{Monitor, Status};

/// A checked program.
#[derive(Clone, Copy)]
pub(super) struct ProgramPlanner<'a> {
    pub around: MoveSurroundings<'a>,
    /// The robot with the tool of the task.
    pub robot: &'a Robot,
    pub moves: &'a [Move],
    pub start: &'a [f64],
    pub options: &'a MovesOptions,
    /// Whether an error is to say why there is no motion, which takes time.
    pub explains: bool,
}

impl ProgramPlanner<'_> {
    /// Plans the motion whose moves meet `task`.
    ///
    /// # Errors
    /// As [`plan_moves`](super::plan_moves()).
    pub fn plan(&self, task: &MoveTask, monitor: &mut dyn Monitor) -> Result<Plan> {
        let Self { around, robot, moves, start, options, explains } = *self;
        let limits = around.limits;
        let stages = outline(robot, moves, start, task)?;
        let blocks = blocks(&stages, moves);
        let each = SolveOptions {
            limits: Some(limits.position_limits(around.robot)?),
            surroundings: options.surroundings.clone(),
            seed: options.seed,
            ..SolveOptions::default()
        };
        let mut ladder = Ladder::new(around, (robot, *task), each.clone());
        let each = SolveOptions { task: task.searched(), ..each };
        let climber = Climber { robot, limits, moves, blocks: &blocks, each, explains };
        let rungs = match ladder.climb(&blocks, start, monitor)? {
            Ok(rungs) => rungs,
            Err((block, dead)) => return Err(climber.no_way(block, dead, monitor)?),
        };
        let paths = climber.refined(&mut ladder, &rungs, monitor)?;
        let mut assembly = Assembly::new(around, (robot, *task), moves, options, start);
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
        if plan.note_kept(around.robot, &options.keeps)?.is_some() {
            plan.status = Status::Stalled;
        }
        Ok(plan)
    }
}
