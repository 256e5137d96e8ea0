//! Planning: from one place to another, or along a given path, within the limits of the joints.
//!
//! | file | what |
//! |---|---|
//! | [`time_optimal`](mod@time_optimal) | the fastest timing of a joint path |

pub mod time_optimal;

pub use time_optimal::{JointPath, SplineEnds, TimingLimits, TimingOptions, time_optimal};
