//! Planning: from one place to another, or along a given path, within the limits of the joints.
//!
//! | file | what |
//! |---|---|
//! | [`plan`] | [`Plan`]: the trajectory found, what it costs, what it breaks |
//! | [`cost`] | what a plan minimises: time, joint travel, tip travel |
//! | [`end`] | where a motion starts or ends: a target of the tip, or a configuration |
//! | [`motion_limits`] | constant limits of each joint, and what of them a trajectory breaks |
//! | [`planar_arm`] | arms in a plane: inverse kinematics in closed form, the redundancy left open |
//! | [`course`] | [`Course`]: where the tip is to go along a path |
//! | `stray` | how far it strays from that |
//! | `minmax` | from end to end by the nearest configurations, and around obstacles |
//! | [`point_to_point`] | the planner from end to end, whatever its method |
//! | [`along_path`] | the planner along a path, whatever its method |
//! | [`time_optimal`](mod@time_optimal) | the fastest timing of a joint path |
//! | `timed` | along a path, redundancy and timing together |
//! | `tpbso` | both as published by Wang et al. (2019) |

pub mod along_path;
pub mod cost;
pub mod course;
pub mod end;
mod minmax;
pub mod motion_limits;
pub mod plan;
pub mod planar_arm;
pub mod point_to_point;
mod stray;
pub mod time_optimal;
mod timed;
mod tpbso;

pub use along_path::{AlongPathMethod, AlongPathOptions, plan_along_path};
pub use cost::Cost;
pub use course::Course;
pub use end::End;
pub use motion_limits::MotionLimits;
pub use plan::{Improvement, Plan, Violation};
pub use planar_arm::Elbow;
pub use point_to_point::{PointToPointMethod, PointToPointOptions, plan_point_to_point};
pub use time_optimal::{JointPath, SplineEnds, TimingLimits, TimingOptions, time_optimal};
