//! Solutions that keep clear of obstacles, and of the robot itself.
//!
//! `clear_solution` is the call. A `ClearSearch` tests candidates: a configuration that is not clear is pushed along its
//! self-motion, and remembered in case none is. `branches` takes candidates from the closed form, `restarts` from searches,
//! `least_cost` compares several. Every solution that is returned as solved was certified by
//! [`ClearSpace::holds`](crate::obstacle::ClearSpace::holds).

mod blocked_solutions;
mod branches;
mod clear_search;
mod clear_solution;
mod least_cost;
mod restarts;

pub(super) use clear_solution::{clear_solution, made_clear};
