//! Many targets at once, on all cores. The only module that knows threads.

mod pool;
mod results;
mod solve_batch;
mod targets;

pub use results::{Batch, Item};
pub use solve_batch::{BatchOptions, OnInvalid, solve_batch};
pub use targets::Targets;
