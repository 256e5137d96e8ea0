//! Along a path as fast as the limits allow: the arm's redundancy and the timing found together.
//!
//! An outer search chooses the posture in which the arm passes each point of the path, by a few numbers for the whole motion.
//! For the joint path that follows from them, the fastest timing is found exactly and at little cost. So the search space is
//! small, and every limit is kept.
//!
//! | file | what |
//! |---|---|
//! | `timed_planner` | the planner |
//! | `redundant_motion` | configurations along the path, and the freedom to choose them |
//! | `null_space` | directions that move the joints and leave the tip where it is |
//! | `projection` | the nearest configuration that reaches a target |
//! | `interpolation` | splines through configurations, fine enough to keep to the path |
//! | `timed_cost` | the duration as a function of the choice |
//! | `unreachable` | the points that no configuration reaches, for the error |

mod interpolation;
mod null_space;
mod projection;
mod redundant_motion;
mod timed_cost;
mod timed_planner;
mod unreachable;

pub(super) use timed_planner::along_path;
