//! Solutions clear of obstacles and of the robot itself.
//!
//! `clear_solution` is the call. A `ClearSearch` tests candidates: a blocked configuration is pushed along its self-motion, and
//! remembered in case no solution is clear. `branches` takes candidates from the closed form, `family_members` from the families
//! of singular poses, `restarts` from searches;
//! `least_cost` compares several. Every solution returned as solved was certified by
//! [`ClearSpace::holds`](crate::obstacle::ClearSpace::holds).

mod blocked_part;
mod blocked_solutions;
mod branches;
mod clear_search;
mod clear_solution;
mod family_members;
mod least_cost;
mod restarts;

pub(super) use blocked_part::in_collision_at;
pub(super) use clear_solution::{clear_solution, made_clear};
