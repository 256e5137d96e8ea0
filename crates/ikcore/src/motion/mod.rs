//! Motion in joint space inside limits up to jerk: of commands tick by tick, and from state to state.
//!
//! Commands are positions q_k, one per tick of `dt`. A tick's *step* is q_k - q_(k-1), its *change* the difference of two
//! steps, and the change of the change is limited by jerk: |step| <= v dt, |change| <= a dt^2, |change' - change| <= j dt^3.
//! Between commands an arm that interpolates them by a uniform cubic B-spline keeps the same limits at every instant,
//! because velocity, acceleration and jerk of the spline are averages of these differences.
//!
//! | file | what |
//! |---|---|
//! | `braking` | `Braking`: how a joint brakes; its fastest stop in closed form |
//! | `stop_curve` | the same stop, tick by tick |
//! | `admissible` | the changes of a joint after which it can still stop inside its limits |
//! | `reachable_set` | these changes for all joints, as the box of a tick |
//! | `joint_state` | steps and changes of all joints |
//! | `bracket` | zeros of increasing functions |
//! | `noise_level` | noise of a sequence of samples, robust to jumps |
//! | `goal_scales` | largest steps and changes, in which goals are measured |
//! | `goal_memory` | how many samples of a noisy goal to average |
//! | `goal_fit` | weighted least squares of a line or a parabola through samples at any times |
//! | `moving_goal` | the goal configuration as a moving point: position, step and change from noisy samples |
//! | `goal_extrapolation` | where it is between samples, and when these are late |
//! | `pursuit` | the change of each joint towards a moving goal |
//! | `arm_state` | [`ArmState`]: positions, velocities and accelerations of all joints |
//! | `synchronised` | all joints from one state to another in the same time, as short as possible |
//! | `state_to_state` | the calls [`state_to_state`] and [`stop`]: checks, and the [`Trajectory`](crate::trajectory::Trajectory) |

mod admissible;
mod arm_state;
mod bracket;
mod braking;
mod goal_extrapolation;
mod goal_fit;
mod goal_memory;
mod goal_scales;
mod joint_state;
mod moving_goal;
#[cfg(test)]
mod moving_goal_tests;
mod noise_level;
mod pursuit;
mod reachable_set;
mod state_to_state;
mod stop_curve;
mod synchronised;

pub use arm_state::ArmState;
pub(crate) use braking::Braking;
pub(crate) use goal_scales::Scales;
pub(crate) use joint_state::JointState;
pub(crate) use moving_goal::{GoalSample, MovingGoal};
pub(crate) use pursuit::Pursuit;
pub(crate) use reachable_set::ReachableSet;
pub(crate) use state_to_state::meet;
pub use state_to_state::{state_to_state, state_to_state_from, stop};
pub(crate) use stop_curve::StopCurve;
