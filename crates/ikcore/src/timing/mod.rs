//! The fastest timing of a joint path, and the constant limits that all timings keep.
//!
//! | file | what |
//! |---|---|
//! | `time_optimal` | [`time_optimal()`]: the fastest timing of a path, and its options |
//! | `joint_path` | [`JointPath`]: joint positions as cubics in a path parameter |
//! | `spline`, `polyline` | paths through waypoints |
//! | `timing_limits` | [`TimingLimits`] |
//! | `grid` | the path cut into segments |
//! | `derivatives` | derivatives of the path over a segment |
//! | `velocity_curve` | the velocity limits |
//! | `strips` | the acceleration limits |
//! | `reachability` | the fastest speed profile on a grid |
//! | `refine` | adaptive refinement of the grid |
//! | `compose` | speed profile to trajectory |
//! | `jerk` | smoothing that keeps jerk limits |
//! | `line_timing` | the quickest smooth timing of straight lines |
//! | `time_scaling` | a whole motion, faster or slower by one factor |
//! | `within_limits` | motions of short phases, slowed to their limits |
//! | `motion_limits`, `violation` | constant limits of each joint, and their violations by a trajectory |

mod compose;
mod derivatives;
mod grid;
mod jerk;
mod joint_path;
mod line_timing;
mod motion_limits;
mod polyline;
mod reachability;
mod refine;
mod spline;
mod strips;
mod time_optimal;
mod time_scaling;
mod timing_limits;
mod velocity_curve;
mod violation;
mod within_limits;

pub use crate::math::cubic_spline::SplineEnds;
pub use joint_path::JointPath;
pub(crate) use line_timing::JointPolyline;
pub(crate) use motion_limits::MotionLimits;
pub use time_optimal::{TimingOptions, time_optimal};
pub(crate) use time_optimal::{coarse_duration, time_all};
pub(crate) use time_scaling::scaled;
pub use timing_limits::TimingLimits;
pub use violation::Violation;
