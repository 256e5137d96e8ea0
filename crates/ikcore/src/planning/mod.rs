//! Planning: motions between two ends or along a path, within the limits of the joints.
//!
//! Planners have no control loop (see `tracking`) and do not solve single configurations (see `ik`). A planner takes
//! options, searches, and returns a [`Plan`]: a trajectory, its cost and the limits it violates. The calls are here; each
//! theory has a room of its own:
//!
//! | room | what |
//! |---|---|
//! | `timing` | the fastest timing of a joint path, of a line, of a finished motion |
//! | `plan` | ends, options, the [`Plan`] and its checks |
//! | `free_path` | between two ends: the nearest configurations, joined directly or around obstacles |
//! | `approach_retreat` | straight lines at both ends of it, and the way out of a contact at the start |
//! | `along_path` | a path of the tip: redundancy and timing in one search, the same among obstacles |
//! | `moves` | programs of moves: joint moves, lines, arcs, waits, with blends between them |
//! | `tpbso` | both problems as published by Wang et al. (2019) |
//!
//! | file | what |
//! |---|---|
//! | `point_to_point`, `along_path` | the two calls |
//! | `admitted_ends` | start and ends of a motion as the caller reads them |
//! | `with_breaks` | along a path that the tool leaves where it must |
//! | `several_tips` | point to point for several tips: targets become configurations |

mod admitted_ends;
mod along_path;
mod point_to_point;
mod several_tips;
mod with_breaks;

pub use crate::along_path::TipPath;
pub use crate::moves::{JointGoal, Move, MoveKind, MovesOptions, plan_moves};
pub use crate::plan::{
    AlongPathMethod, AlongPathOptions, Break, Cost, Elbow, EndTurns, Endpoint, Freed, Improvement, JointTurned,
    LineContact, LineFrame, MoveCourse, MoveReport, Orientation, Orientations, Peak, Plan, PlanarArm, PlanarTarget,
    PointToPointMethod, PointToPointOptions, SpeedBound, StraightLine, Tpbso,
};
pub use crate::timing::{
    ConstantLimits, JointPath, RecordedNoise, SplineEnds, TimingOptions, Violation, recorded_noise, time_optimal,
    time_optimal_within,
};
pub use along_path::plan_along_path;
pub(crate) use point_to_point::check_point_to_point;
pub use point_to_point::plan_point_to_point;
