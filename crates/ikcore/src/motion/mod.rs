//! Motions in joint space from limits alone, without a path.
//!
//! | file | what |
//! |---|---|
//! | `arm_state` | [`ArmState`]: positions, velocities and accelerations of all joints |
//! | `synchronised` | all joints from one state to another in the same time, as short as possible |
//! | `state_to_state` | the calls [`state_to_state`] and [`stop`]: checks, and the [`Trajectory`](crate::trajectory::Trajectory) |

mod arm_state;
mod state_to_state;
mod synchronised;

pub use arm_state::ArmState;
pub(crate) use state_to_state::meet;
pub use state_to_state::{state_to_state, stop};
