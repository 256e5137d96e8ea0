//! Many targets at once, on all cores. The only module that uses threads.
//!
//! `solve_batch` is the call. A `job` reads rows, groups them and solves each group; `pool` holds the threads,
//! `monitors` stop them on request, `results` holds the results.

mod batch_options;
mod job;
mod monitors;
mod pool;
mod results;
mod solve_batch;
mod targets;

pub use batch_options::{BatchOptions, OnInvalid};
pub use results::{Batch, BatchItem};
pub use solve_batch::solve_batch;
pub use targets::Targets;
