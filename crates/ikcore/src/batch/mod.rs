//! Batches of targets or motions on all cores. The only module that uses threads.
//!
//! `solve_batch`, `plan_batch` and `map_chunks` are the calls. A `job` reads rows, groups them and solves each group; `pool`
//! holds the threads, `workers` runs them while the caller's monitor is polled, `monitors` stop them on request, `results`
//! holds the solutions.

mod batch_options;
mod job;
mod map_chunks;
mod monitors;
mod plan_batch;
mod pool;
mod results;
mod solve_batch;
mod targets;
mod workers;

pub use batch_options::{BatchOptions, OnInvalid};
pub use map_chunks::map_chunks;
pub use plan_batch::{PlanProblem, plan_batch, plan_status};
pub use results::{Batch, message_of_counts};
pub use solve_batch::solve_batch;
pub use targets::Targets;
