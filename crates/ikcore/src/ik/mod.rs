//! Inverse kinematics: one solution of a target, or all of them.
//!
//! Read `solve` first. A `SolveContext` is validated once for all targets of a call; an `Attempt` holds the state of
//! one target: problem, random numbers, monitor, `budget`. `nearest` and `best` choose among several solutions,
//! `goal_descent` moves a solution along its self-motion, `self_motion` follows the whole of it, `solve_all` collects
//! solutions (`all_branches` by the closed form), `side_by_side` solves four targets at once for batches. [`problem`](crate::problem) explains why a target was
//! missed.

mod all_branches;
mod attempt;
mod best;
mod budget;
mod context;
mod goal_descent;
mod nearest;
mod self_motion;
mod shared_time;
mod side_by_side;
mod solution;
mod solutions;
mod solve;
mod solve_all;
mod solve_options;
mod whole_turns;

pub(crate) use context::{Query, SolveContext};
pub use self_motion::{SelfMotion, SelfMotionOptions, self_motion};
pub(crate) use side_by_side::solve_queries;
pub use solution::Solution;
pub use solutions::{SolutionView, Solutions};
pub use solve::solve;
pub(crate) use solve::solve_query;
pub use solve_all::{AllOptions, SolutionSet, nearest_miss, solve_all};
pub use solve_options::{Prefer, SolveOptions};
pub(crate) use whole_turns::bring_near;
