//! Inverse kinematics: one solution of a target, or all of them.
//!
//! Read `solve` first. A `SolveContext` is validated once for all targets of a call; an `Attempt` holds everything that
//! one target needs: problem, random numbers, monitor, `budget`. `nearest` and `best` choose among several solutions,
//! `goal_descent` moves one along its self-motion, `solve_all` collects them (`all_branches` by the closed form),
//! `side_by_side` solves four at once for batches.
//! Why a target was missed is a matter of [`problem`](crate::problem).

mod all_branches;
mod attempt;
mod best;
mod budget;
mod context;
mod goal_descent;
mod nearest;
mod shared_time;
mod side_by_side;
mod solution;
mod solve;
mod solve_all;
mod solve_options;
mod whole_turns;

pub(crate) use context::{Query, SolveContext};
pub(crate) use side_by_side::solve_queries;
pub use solution::Solution;
pub use solve::solve;
pub(crate) use solve::solve_query;
pub use solve_all::{AllOptions, SolutionSet, solve_all};
pub use solve_options::{Prefer, SolveOptions};
pub(crate) use whole_turns::bring_near;
