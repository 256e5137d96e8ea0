//! Inverse kinematics: one solution of a target, or all of them.
//!
//! Read `solve` first. A `SolveContext` is validated once for all targets of a call; an `Attempt` holds the state of one
//! target: problem, random numbers, monitor, `budget`. `first_branch` answers poses by the closed form and takes the branch
//! chosen by `preference`. `nearest`, `best`, `cheapest_nearby` and `clear` choose among several solutions, `checked_tasks` holds the tasks of several
//! tips. `goal_descent` moves a solution along its self-motion, `self_motion` traces the whole of it, `solve_all` collects
//! solutions (`all_branches` by the closed form; `branches_by_part` for control loops). [`problem`](crate::problem) explains why a target was missed.

mod all_branches;
mod attempt;
mod best;
mod branches_by_part;
mod budget;
mod cheapest_nearby;
mod checked_tasks;
mod clear;
mod context;
mod first_branch;
mod first_of_family;
mod goal_descent;
mod near_misses;
mod nearest;
mod out_of_reach;
mod preference;
mod ranked;
mod self_motion;
mod solution;
mod solutions;
mod solve;
mod solve_all;
mod solve_options;
mod weak_direction;
mod whole_turns;

pub(crate) use branches_by_part::next_branches;
pub use checked_tasks::tip_errors;
pub(crate) use checked_tasks::{checked_tasks, reduce};
pub(crate) use context::{Query, SolveContext, joint_weights};
pub(crate) use ranked::{LevelDescent, RankedDescent, given_up};
pub use self_motion::{SelfMotion, SelfMotionOptions, self_motion};
pub use solution::{Nearest, Solution, SolveReport};
pub use solutions::{SolutionView, Solutions};
pub(crate) use solve::solve_query;
pub use solve::{solve, solve_tips};
pub use solve_all::{AllOptions, SolutionSet, nearest_miss, solve_all, solve_all_tips};
pub use solve_options::{Prefer, SolveOptions};
pub(crate) use whole_turns::bring_near;
