//! Options of `solve`.

use crate::limits::Limits;
use crate::obstacle::Surroundings;
use crate::robot::Robot;
use crate::solver::{AnySolver, Stop};
use crate::task::{Goal, NamedTask, Task, Tolerance};
use crate::wording::words;

/// Which solution to return if there are several.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Prefer {
    /// The first one found.
    #[default]
    Any,
    /// The solution nearest to the start, of those found.
    Nearest,
    /// The solution that is best for the goals, of those found.
    Best,
}

words!("prefer": Prefer { Any => "any", Nearest => "nearest", Best => "best" });

/// Options of [`solve`](super::solve()). The default solves within the robot's limits.
#[derive(Debug, Clone, Default)]
pub struct SolveOptions {
    /// The algorithm. `None` means the closed form of the arm where it has one, and Levenberg-Marquardt from many starts.
    pub solver: Option<AnySolver>,
    /// The part of the target that matters. `None` means all of it.
    pub task: Option<Task>,
    /// The tasks of several tips, in the order of their targets; then `task` and `tolerance` are not used. None for a robot with one.
    pub tips: Vec<NamedTask>,
    /// Goals in the null space of the task.
    pub goals: Vec<Goal>,
    /// Which solution to return if there are several.
    pub prefer: Prefer,
    /// The start (n,). `None` means the middle of the limits for a closed form, and the indexed configuration nearest to the
    /// target for a search.
    pub start: Option<Vec<f64>>,
    /// Tolerances within which the target counts as reached.
    pub tolerance: Tolerance,
    /// Position limits to keep. `None` means the robot's.
    pub limits: Option<Limits>,
    /// What solutions keep clear of. By default nothing is checked.
    pub surroundings: Surroundings,
    /// The nearest two bodies of a solution are left for [`Solution::find_nearest`](super::Solution::find_nearest): finding them takes
    /// about as long as the solve.
    pub nearest_later: bool,
    /// Budgets.
    pub stop: Stop,
    /// Seed of the random draws; the same seed gives the same bits. Most targets are solved without a random draw, and
    /// so independently of the seed.
    pub seed: u64,
}

impl SolveOptions {
    /// The task of the only tip; `None` for a robot with several.
    pub(super) fn only_task(&self, robot: &Robot) -> Option<Task> {
        let named = || self.tips.first().and_then(|tip| tip.task);
        self.task.or_else(named).filter(|_| robot.tip_count() == 1)
    }
}
