//! Starting points for a descent: random configurations of a chain, indexed by their tip pose.
//!
//! The index depends on a chain and the ranges of its joints, not on `Robot`. Read `index` for the stored data and
//! `near_target` for how an entry becomes a start.

pub(crate) mod index;
mod near_target;

pub use near_target::Starts;
