//! Time-optimal motions of one joint between two states within velocity, acceleration and jerk limits.
//!
//! For a given duration the reachable final positions form an interval, because states and limits are convex in the motion.
//! The ends of the interval are reached by two extremal motions, which maximise the displacement in either direction and have
//! a closed form. A duration is therefore possible if the final position lies between theirs. At the shortest possible
//! duration the final position equals one of them; for a longer duration the mean of the two, weighted to end at the final
//! position, satisfies every limit. The phases of the extremal motions follow Berscheid and Kroeger, "Jerk-limited Real-time
//! Trajectory Generation with Arbitrary Target States", 2021 (arXiv 2105.04830).
//!
//! | file | contents |
//! |---|---|
//! | `motion_state` | [`MotionState`] and [`Rates`], the limits |
//! | `phases` | up to seven phases of constant jerk |
//! | `jerk_limited` | extremal motion under a jerk limit |
//! | `acceleration_limited` | extremal motion without a jerk limit, and without acceleration limit |
//! | `extremal` | the extremal motion that applies, and where its shape changes |
//! | `entry` | return to the limits |
//! | `transfer` | [`Transfer`]: possible durations between two states, and the motion for one of them |
//! | `first_passing` | shortest duration in which an extremal motion reaches a position |
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
