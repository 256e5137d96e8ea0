//! Motions of one joint between two states within velocity, acceleration and jerk limits.
//!
//! For a given duration the final positions that can be reached form an interval, because states and limits are convex
//! in the motion. Its ends are reached by the two extremal motions, in closed form: as far as possible in either
//! direction. So a duration is possible if the final position lies between theirs, the shortest duration is one at which
//! the final position equals one of them, and for any longer one the mean of the two, weighted to end there, keeps every
//! limit. The phases of the extremal motions are those of Berscheid and Kroeger, "Jerk-limited Real-time Trajectory
//! Generation with Arbitrary Target States", 2021 (arXiv 2105.04830).
//!
//! | file | what |
//! |---|---|
//! | `motion_state` | [`MotionState`] and [`Rates`], the limits |
//! | `phases` | up to seven phases of constant jerk |
//! | `jerk_limited` | the extremal motion under a jerk limit |
//! | `acceleration_limited` | the extremal motion without a jerk limit, and without both |
//! | `extremal` | the one of these that applies, and where it changes its shape |
//! | `entry` | the way back inside the limits |
//! | `transfer` | [`Transfer`]: possible durations between two states, and the motion for one of them |
//! | `first_passing` | the first duration for which an extremal motion passes a position |
//! | `joint_profile` | [`JointProfile`]: a motion in time |

mod acceleration_limited;
mod entry;
mod extremal;
mod first_passing;
mod jerk_limited;
mod joint_profile;
mod motion_state;
mod phases;
mod transfer;

pub use joint_profile::{JointProfile, JointSegment};
pub use motion_state::{MotionState, Rates};
pub use transfer::Transfer;
