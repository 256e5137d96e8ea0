//! Options of `solve`.

use crate::limits::Limits;
use crate::obstacle::Surroundings;
use crate::robot::Robot;
use crate::solver::{AnySolver, Stop};
use crate::task::{Goal, NamedTask, Task, Tolerance};
use crate::wording::words;

/// Choice among several solutions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Prefer {
    /// First solution found.
    #[default]
    Any,
    /// Solution nearest to the start, of those found.
    Nearest,
    /// Solution with the least cost of the goals, of those found.
    Best,
}

words!("prefer": Prefer { Any => "any", Nearest => "nearest", Best => "best" });

/// Options of [`solve`](super::solve()). The default solves within the robot's limits.
#[derive(Debug, Clone, Default)]
pub struct SolveOptions {
    /// Solver. `None` means the closed form of the arm if it has one, else Levenberg-Marquardt from many starts.
    pub solver: Option<AnySolver>,
    /// Part of the target to reach. `None` means all of it.
    pub task: Option<Task>,
    /// Tasks of several tips, in the order of their targets, in place of `task` and `tolerance`; empty for a robot with one
    /// tip.
    pub tips: Vec<NamedTask>,
    /// Goals in the null space of the task.
    pub goals: Vec<Goal>,
    /// Choice among several solutions.
    pub prefer: Prefer,
    /// Start of the search (n,). `None` means the middle of the limits for a closed form, and the indexed configuration nearest
    /// to the target for a search.
    pub start: Option<Vec<f64>>,
    /// Cost of moving each joint away from the start (n,), positive: of the solutions, the one is wanted with the least sum of
    /// (weight * (q - start))^2. `None` means that all joints cost the same.
    pub joint_weights: Option<Vec<f64>>,
    /// Tolerances within which the target counts as reached.
    pub tolerance: Tolerance,
    /// Position limits to keep. `None` means the robot's.
    pub limits: Option<Limits>,
    /// Obstacles and self-collision to avoid; none by default.
    pub surroundings: Surroundings,
    /// Whether to defer the nearest two bodies of a solution to [`Solution::find_nearest`](super::Solution::find_nearest):
    /// finding them takes about as long as the solve.
    pub nearest_later: bool,
    /// Whether only whole solutions count: a miss is not brought nearer, nor one part of a pose met without the other.
    pub whole_only: bool,
    /// Budgets of the search.
    pub stop: Stop,
    /// Seed of the random draws; the same seed gives the same bits. Most targets are solved without a random draw, and
    /// therefore independently of the seed.
    pub seed: u64,
}

impl SolveOptions {
    /// Task of the only tip; `None` for a robot with several.
    pub(super) fn only_task(&self, robot: &Robot) -> Option<Task> {
        let named = || self.tips.first().and_then(|tip| tip.task);
        self.task.or_else(named).filter(|_| robot.tip_count() == 1)
    }
}
