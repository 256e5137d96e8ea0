//! Planning along a path as fast as the limits allow: redundancy and timing in one search.
//!
//! An outer search chooses the posture of the arm at each point of the path, by a few parameters for the whole motion.
//! For the resulting joint path, the fastest timing is computed exactly and at little cost. So the search space is
//! small, and every limit is kept.
//!
//! | file | what |
//! |---|---|
//! | `timed_planner` | the planner |
//! | `path_problem` | the path, what the motion has to keep, and the motion through given configurations |
//! | `nominal_motions` | motions that follow the path from a few starts |
//! | `null_space_offsets` | one of them, and free offsets from it |
//! | `path_walk` | configurations along the path, each the nearest to the one before |
//! | `elastic_band` | the shortest motion around one |
//! | `null_space` | joint motions that leave the tip in place |
//! | `projection` | projection of configurations onto targets of the path, or near them |
//! | `interpolation` | splines through configurations, dense enough to stay on the path |
//! | `timed_cost` | the duration as a function of the offsets |

mod elastic_band;
mod interpolation;
mod nominal_motions;
mod null_space;
mod null_space_offsets;
mod path_problem;
mod path_walk;
mod projection;
mod timed_cost;
mod timed_planner;

pub(super) use interpolation::{Interpolation, JointWaypoints};
pub(super) use null_space_offsets::NullSpaceOffsets;
pub(super) use path_problem::FollowedPath;
pub(crate) use path_problem::PathProblem;
pub(crate) use projection::PathKeeps;
pub(super) use projection::{NEAR_ENOUGH, Projection, strays};
pub(super) use timed_cost::TimedCost;
pub(crate) use timed_planner::along_path;
pub(super) use timed_planner::search;
