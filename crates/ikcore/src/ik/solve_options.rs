//! How to solve.

use crate::limits::Limits;
use crate::solver::{AnySolver, Stop};
use crate::task::{Goal, Task, Tolerance};
use crate::wording::words;

/// Which solution to return where there are several.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Prefer {
    /// The first one found.
    #[default]
    Any,
    /// The one nearest to the start, of those found.
    Nearest,
    /// The one that serves the goals best, of those found.
    Best,
}

words!("prefer": Prefer { Any => "any", Nearest => "nearest", Best => "best" });

/// How to solve. The default is Levenberg-Marquardt from many starts, within the robot's limits.
#[derive(Debug, Clone, Default)]
pub struct SolveOptions {
    /// The algorithm.
    pub solver: AnySolver,
    /// Which part of the target matters; None: all of it.
    pub task: Option<Task>,
    /// How to use the freedom that the task leaves.
    pub goals: Vec<Goal>,
    /// Which solution to return where there are several.
    pub prefer: Prefer,
    /// The configuration (n,) to begin from; None begins at the indexed configuration nearest to the target.
    pub start: Option<Vec<f64>>,
    /// When the target counts as reached.
    pub tolerance: Tolerance,
    /// Position limits to keep; None keeps the robot's.
    pub limits: Option<Limits>,
    /// Budgets.
    pub stop: Stop,
    /// Seed of the random draws: the same seed gives the same bits. Most targets are solved without a draw, to the same bits
    /// whatever the seed.
    pub seed: u64,
}
