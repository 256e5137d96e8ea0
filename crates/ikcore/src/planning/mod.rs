//! Planning: from one place to another, or along a given path, within the limits of the joints.
//!
//! | file | what |
//! |---|---|
//! | [`plan`] | [`Plan`]: the trajectory found, what it costs, what it breaks |
//! | [`cost`] | what a plan minimises: time, joint travel, tip travel |
//! | [`endpoint`] | where a motion starts or ends: a target of the tip, or a configuration |
//! | [`motion_limits`] | constant limits of each joint, and what of them a trajectory breaks |
//! | [`planar_arm`] | arms in a plane: inverse kinematics in closed form, the redundancy left open |
//! | [`tip_path`] | [`TipPath`]: the curve that the tip is to follow, whatever the time |
//! | `deviation` | how far the tip is from that curve |
//! | `collision_checks` | what planners among obstacles share |
//! | `search` | any solver on the cost of a plan |
//! | `minmax` | from end to end by the nearest configurations, and around obstacles |
//! | [`point_to_point`] | the planner from end to end, whatever its method |
//! | [`along_path`] | the planner along a path, whatever its method |
//! | [`time_optimal`](mod@time_optimal) | the fastest timing of a joint path |
//! | `timed` | along a path, redundancy and timing together |
//! | `tpbso` | both as published by Wang et al. (2019) |

pub mod along_path;
mod collision_checks;
pub mod cost;
mod deviation;
pub mod endpoint;
mod minmax;
pub mod motion_limits;
pub mod plan;
pub mod planar_arm;
pub mod point_to_point;
mod search;
pub mod time_optimal;
mod timed;
pub mod tip_path;
mod tpbso;
mod violation;

pub use along_path::{AlongPathMethod, AlongPathOptions, plan_along_path};
pub use cost::Cost;
pub use endpoint::Endpoint;
pub use motion_limits::MotionLimits;
pub use plan::{Improvement, Plan};
pub use planar_arm::Elbow;
pub use point_to_point::{PointToPointMethod, PointToPointOptions, plan_point_to_point};
pub use time_optimal::{JointPath, SplineEnds, TimingLimits, TimingOptions, time_optimal};
pub use tip_path::TipPath;
pub use violation::Violation;
