//! The evaluator sits between solver and objective: it counts, clips, checks, and keeps the best point.
//!
//! `budgeted` holds the evaluator itself: counts, budgets, the end of a run. `values` and `derivatives` are the
//! evaluations that solvers call; `best_point` is the best of them.

mod best_point;
mod budgeted;
mod derivatives;
mod values;

pub use best_point::BestPoint;
pub use budgeted::Evaluator;
