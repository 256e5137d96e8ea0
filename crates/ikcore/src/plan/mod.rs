//! Arguments and results of planners: ends, options, the [`Plan`] and its checks.
//!
//! | file | what |
//! |---|---|
//! | `endpoint` | [`Endpoint`]: a start or an end, by target or configuration |
//! | `planner_options` | method, objective, limits, budget |
//! | `straight_line` | [`StraightLine`]: direction, length and allowed contacts of a straight piece |
//! | `tpbso_options` | [`Tpbso`] |
//! | `cost` | [`Cost`]: duration, joint travel or tip travel |
//! | `plan` | [`Plan`]: the result |
//! | `move_report` | how each move of a program came out |
//! | `path_break` | where the tool leaves its path |
//! | `retime` | [`Plan::retime`]: other limits for a finished plan |
//! | `joined` | a plan, and motions before and after it |
//! | `kept_along` | errors of constraints along a finished motion |
//! | `collision_checks` | margins, collision errors and certifiable motions |
//! | `planar_arm` | closed-form inverse kinematics of planar arms, with the redundancy as a parameter |
//! | `search` | runs a solver on the cost of a plan and records its progress |
//! | `deadline` | the wall-clock budget of a plan |

pub(crate) mod collision_checks;
mod cost;
mod deadline;
mod endpoint;
mod joined;
mod kept_along;
mod move_report;
mod path_break;
#[allow(clippy::module_inception)]
mod plan;
mod planar_arm;
mod planner_options;
mod retime;
mod search;
mod straight_line;
mod tpbso_options;

pub(crate) use collision_checks::{
    END_RESERVE, TimedMotion, certify, configuration_at, least_clearance, motion_space, refuse_collision, too_near,
};
pub use cost::Cost;
pub(crate) use cost::tip_travel_along;
pub(crate) use deadline::Deadline;
pub use endpoint::Endpoint;
pub(crate) use endpoint::{EndName, no_usable_end};
pub(crate) use joined::joined;
pub(crate) use kept_along::broken_along;
pub use move_report::{MoveCourse, MoveReport, SpeedBound};
pub use path_break::Break;
pub use plan::{Freed, Improvement, JointTurned, Peak, Plan};
pub(crate) use planar_arm::{ELBOW_LINKS, wrapped};
pub use planar_arm::{Elbow, Orientation, Orientations, PlanarArm, PlanarTarget};
pub use planner_options::{AlongPathMethod, AlongPathOptions, EndTurns, PointToPointMethod, PointToPointOptions};
pub(crate) use search::{Search, SearchResult};
pub use straight_line::{LineContact, LineFrame, StraightLine};
pub use tpbso_options::Tpbso;
