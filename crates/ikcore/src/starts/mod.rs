//! Starting points for a descent: random configurations of a chain, indexed by their tip pose.
//!
//! The index depends on a chain and the ranges of its joints, not on `Robot`. Read `index` for the stored data and
//! `near_target` for how an entry becomes a start; `nearest_by_lane` is the scan.

pub(crate) mod index;
mod near_target;
mod nearest_by_lane;

pub use near_target::Starts;
