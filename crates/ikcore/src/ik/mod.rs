//! Inverse kinematics: one target, one answer, or all of them.

mod attempt;
mod best;
mod context;
mod goal_descent;
mod nearest;
mod side_by_side;
mod solution;
mod solve;
mod solve_all;

pub(crate) use context::Prepared;
pub(crate) use nearest::bring_near;
pub(crate) use side_by_side::Query;
pub use solution::Solution;
pub use solve::{Prefer, SolveOptions, solve};
pub use solve_all::{AllOptions, SolutionSet, solve_all};
