//! One target, one answer.

use super::context::Prepared;
use super::solution::Solution;
use crate::error::Result;
use crate::limits::Limits;
use crate::robot::Robot;
use crate::solver::{AnySolver, Monitor, Stop};
use crate::task::{Goal, Target, Task, Tolerance};
use crate::wording::words;

/// Which solution to return where there are several.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Prefer {
    /// The first one found.
    #[default]
    Any,
    /// Of those found, the one nearest to the start.
    Nearest,
    /// Of those found, the one that serves the goals best.
    Best,
}

words!("prefer": Prefer { Any => "any", Nearest => "nearest", Best => "best" });

/// How to solve. The default is Levenberg-Marquardt from many starts, within the robot's limits.
#[derive(Debug, Clone, Default)]
pub struct SolveOptions {
    /// The algorithm.
    pub solver: AnySolver,
    /// What of the target matters; None: all that it says.
    pub task: Option<Task>,
    /// What to do with the freedom that the task leaves.
    pub goals: Vec<Goal>,
    /// Which solution to return where there are several.
    pub prefer: Prefer,
    /// Where to begin (n,); None begins at the indexed configuration nearest to the target.
    pub start: Option<Vec<f64>>,
    /// When the target counts as reached.
    pub tolerance: Tolerance,
    /// Position limits to keep; None keeps the robot's.
    pub limits: Option<Limits>,
    /// Budgets.
    pub stop: Stop,
    /// Seed of the random draws: the same seed, the same bits. Most targets are solved without a draw, to the same bits
    /// whatever the seed.
    pub seed: u64,
}

/// Finds a configuration that brings the tip of `robot` to `target`.
///
/// With goals, the solution found is moved along the self-motion until they are as good as they get near it. With
/// [`Prefer::Nearest`] further solutions are sought from starts spread ever wider about the given one, each moved along the
/// self-motion and by whole turns towards it, until 24 in a row are no nearer or the budget is spent. Near is what has the
/// smallest |q - start|, joints counted in rad and m. With [`Prefer::Best`] solutions are sought from all over until 40 in
/// a row, each moved along the self-motion, serve the goals no better. An arm with one joint more than its task needs is led
/// once along every curve of solutions, past the limits that cut it, until 40 solutions or 1200 evaluations in a row meet
/// no new curve.
///
/// # Errors
/// Any [`Error`](crate::Error) for wrong input. A target that is not reached is a status, not an error.
pub fn solve(robot: &Robot, target: &Target, options: &SolveOptions, monitor: &mut dyn Monitor) -> Result<Solution> {
    let prepared = Prepared::new(robot, options)?;
    let start = options.start.as_deref();
    let target = prepared.read(target)?;
    start.map_or(Ok(()), |q| prepared.check_start(q))?;
    prepared.require_reference(start)?;
    Ok(prepared.run(&target, start, 0, monitor))
}
