//! The fastest timing of a joint path within velocity and acceleration limits, which hold at every point of the path.
//!
//! | file | what |
//! |---|---|
//! | `timing` | [`time_optimal`]: the call and its options |
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

mod compose;
mod derivatives;
mod grid;
mod jerk;
mod joint_path;
mod polyline;
mod reachability;
mod refine;
mod spline;
mod strips;
mod timing;
mod timing_limits;
mod velocity_curve;

pub use crate::math::cubic_spline::SplineEnds;
pub use joint_path::JointPath;
pub use timing::{TimingOptions, time_optimal};
pub(super) use timing::{coarse_duration, time_all};
pub use timing_limits::TimingLimits;
