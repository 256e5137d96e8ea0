//! Starts for a descent: random configurations of a chain, indexed by where they bring the tip.
//!
//! They know a chain and the ranges of its joints, no `Robot`. Read `index` for what is stored, `near_target` for
//! how an entry becomes a start; `nearest_by_lane` scans.

pub(crate) mod index;
mod near_target;
mod nearest_by_lane;

pub use near_target::Starts;
