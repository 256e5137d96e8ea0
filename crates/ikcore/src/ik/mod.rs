//! Inverse kinematics: one target, one answer, or all of them.

mod all;
mod arcs;
mod best;
mod curve;
mod flip;
mod nearest;
mod prepared;
mod room;
mod round;
mod run;
mod self_motion;
mod side_by_side;
mod solution;
mod solve;
mod unreached;

pub use all::{AllOptions, SolutionSet, solve_all};
pub(crate) use nearest::bring_near;
pub(crate) use prepared::Prepared;
pub(crate) use side_by_side::Query;
pub use solution::Solution;
pub use solve::{Prefer, SolveOptions, solve};
