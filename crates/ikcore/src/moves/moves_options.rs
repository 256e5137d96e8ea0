//! Options of the planner of programs.

use crate::constraint::Keep;
use crate::limits::Limits;
use crate::obstacle::Surroundings;
use crate::solver::Stop;
use crate::task::Task;

/// Options of [`plan_moves`](super::plan_moves()).
#[derive(Debug, Clone, Default)]
pub struct MovesOptions {
    /// Task of lines, arcs and joint moves to poses at their poses, with a tool if needed. Positions stay on the lines and arcs,
    /// whatever their tolerance. `None` means whole poses.
    pub task: Option<Task>,
    /// The same for these tips, by number, in place of `task`.
    pub tip_tasks: Vec<(usize, Option<Task>)>,
    /// Surroundings that the motion keeps clear of. By default nothing is checked.
    pub surroundings: Surroundings,
    /// Constraints at every instant of the motion.
    pub keeps: Vec<Keep>,
    /// Limits to keep. `None` means the robot's.
    pub limits: Option<Limits>,
    /// Budget of each search for a joint move among obstacles. `None` means that of `plan_point_to_point`.
    pub stop: Option<Stop>,
    /// Seed of the random draws; the same seed gives the same bits.
    pub seed: u64,
}

impl MovesOptions {
    /// Task of the moves of tip number `tip`.
    pub(super) fn task_of(&self, tip: usize) -> Option<&Task> {
        let own = self.tip_tasks.iter().find(|(number, _)| *number == tip);
        own.map_or(self.task.as_ref(), |(_, task)| task.as_ref())
    }
}
