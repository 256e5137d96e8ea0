//! The index of configurations to start from, over chain data and ranges of the joints.

pub(crate) mod index;
mod lane_search;
mod near_target;

pub use near_target::Seeds;
