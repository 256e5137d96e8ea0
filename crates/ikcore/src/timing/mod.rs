//! The fastest timing of a joint path, and the constant limits of all timings.
//!
//! | file | what |
//! |---|---|
//! | `time_optimal` | [`time_optimal()`]: the fastest timing of a path, and its options |
//! | `within_tolerance` | [`time_optimal_within`]: motions that may leave their path by a tolerance |
//! | `tube`, `least_bending` | the smooth paths that compete there |
//! | `joint_path` | [`JointPath`]: joint positions as cubics in a path parameter |
//! | `spline`, `polyline` | paths through waypoints |
//! | `inside_limits` | splines that stay inside position limits |
//! | `recorded_noise` | [`recorded_noise()`]: what the noise of a recording costs |
//! | `grid` | the path cut into segments |
//! | `derivatives` | derivatives of the path over a segment |
//! | `velocity_curve` | the velocity limits |
//! | `bounding_line` | lines that bound the acceleration along the path |
//! | `strips` | the acceleration limits |
//! | `tip_segments` | the limits of tips over segments |
//! | `torque_bounds` | the bounds that keep the torque of a joint |
//! | `torque_nodes` | the terms of joint torques at points of a path |
//! | `torque_segments` | the limits of joint torques over segments |
//! | `reachability` | the fastest speed profile on a grid |
//! | `refine` | adaptive refinement of the grid |
//! | `compose` | speed profile to trajectory |
//! | `jerk_limited` | the fastest timing within jerk limits |
//! | `line_timing` | the fastest smooth timing of straight lines |
//! | `quintic` | the quintic from rest to rest |
//! | `time_scaling` | scaling of a whole motion in time, to its limits |
//! | `limit_share` | how much of each limit a motion uses |
//! | `constant_limits`, `violation` | [`ConstantLimits`] of each joint, and their [`Violation`]s by a trajectory |
//! | `required_limits` | limits that a method needs, or cannot keep |
//! | `whole_arm` | slowing a motion down to the limits of tips and torques, and whether joints can hold the arm |

mod bounding_line;
mod compose;
mod constant_limits;
mod derivatives;
mod grid;
mod inside_limits;
mod jerk_limited;
mod joint_path;
mod least_bending;
mod limit_share;
mod line_timing;
mod polyline;
mod quintic;
mod reachability;
mod recorded_noise;
mod refine;
mod required_limits;
mod spline;
mod strips;
mod time_optimal;
mod time_scaling;
mod tip_segments;
mod torque_bounds;
mod torque_nodes;
mod torque_segments;
mod tube;
mod velocity_curve;
mod violation;
mod whole_arm;
mod within_tolerance;

pub use crate::math::cubic_spline::SplineEnds;
pub use constant_limits::ConstantLimits;
pub use joint_path::JointPath;
pub(crate) use limit_share::OneLimit;
pub(crate) use line_timing::Paced;
pub(crate) use polyline::JointPolyline;
pub(crate) use quintic::unit_quintic;
pub use recorded_noise::{RecordedNoise, recorded_noise};
pub use time_optimal::{TimingOptions, time_optimal};
pub(crate) use time_optimal::{coarse_duration, rough_duration, time, time_all};
pub(crate) use time_scaling::scaled;
pub use violation::Violation;
pub use within_tolerance::time_optimal_within;
