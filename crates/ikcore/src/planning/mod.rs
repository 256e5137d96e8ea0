//! Planning: motions between two ends or along a path, within the limits of the joints.
//!
//! Planners have no control loop (see `tracking`) and do not solve single configurations (see `ik`). A planner takes
//! options, searches, and returns a [`Plan`]: a trajectory, its cost and the limits it violates. In reading order:
//!
//! | file | what |
//! |---|---|
//! | `point_to_point`, `along_path` | the two calls |
//! | `several_tips` | point to point for several tips: targets become configurations |
//! | `planner_options` | their options: method, objective, limits, budget |
//! | `endpoint` | [`Endpoint`]: a start or an end, by target or configuration |
//! | `tip_path` | [`TipPath`]: the curve that the tip follows |
//! | `plan`, `violation` | the result |
//! | `retime` | [`Plan::retime`]: other limits for a finished plan |
//! | `cost` | [`Cost`]: duration, joint travel or tip travel |
//! | `motion_limits` | constant limits of each joint, and their violations by a trajectory |
//! | `minmax` | between two ends: the nearest configurations, joined directly or around obstacles |
//! | `end_pieces` | straight lines at both ends of it, and the way out of a contact at the start |
//! | `joined` | a plan, and motions before and after it |
//! | `timed` | along a path: redundancy and fastest timing in one search |
//! | `clear_path` | the same among obstacles |
//! | `time_optimal` | the fastest timing of a joint path |
//! | `tpbso` | both problems as published by Wang et al. (2019) |
//! | `planar_arm` | closed-form inverse kinematics of planar arms, with the redundancy as a parameter |
//! | `within_limits` | motions of short phases, slowed to their limits |
//! | `search` | runs a solver on the cost of a plan and records its progress |
//! | `deadline` | the wall-clock budget of a plan |
//! | `deviation` | the distance of the tip from its path |
//! | `collision_checks` | margins, collision errors and certifiable motions, shared by planners with obstacles |

mod along_path;
mod clear_path;
mod collision_checks;
mod cost;
mod deadline;
mod deviation;
mod end_pieces;
mod endpoint;
mod joined;
mod minmax;
mod missed_points;
mod motion_limits;
mod plan;
mod planar_arm;
mod planner_options;
mod point_to_point;
mod retime;
mod search;
mod several_tips;
mod time_optimal;
mod timed;
mod tip_path;
mod tpbso;
mod violation;
mod within_limits;

pub use along_path::plan_along_path;
pub use cost::Cost;
pub use end_pieces::{LineContact, LineFrame, StraightLine};
pub use endpoint::Endpoint;
pub(crate) use motion_limits::MotionLimits;
pub use plan::{Freed, Improvement, Peak, Plan};
pub use planar_arm::{Elbow, Orientation, Orientations, PlanarArm, PlanarTarget};
pub use planner_options::{AlongPathMethod, AlongPathOptions, PointToPointMethod, PointToPointOptions};
pub(crate) use point_to_point::check_point_to_point;
pub use point_to_point::plan_point_to_point;
pub use time_optimal::{JointPath, SplineEnds, TimingLimits, TimingOptions, time_optimal};
pub use tip_path::TipPath;
pub use tpbso::Tpbso;
pub use violation::Violation;
