//! Evaluator between solver and objective: counts, clips, checks, and keeps the best point.
//!
//! `budgeted` holds the evaluator itself: counts, budgets, the end of a run. `values` and `derivatives` are the evaluations
//! that solvers call; `best_point` keeps the best point.

mod best_point;
mod budgeted;
mod derivatives;
mod values;

pub use best_point::BestPoint;
pub use budgeted::Evaluator;
