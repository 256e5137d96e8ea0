//! Limits on joint motion: functions of time, and the box of joint positions that they leave for the next tick.
//!
//! | file | what |
//! |---|---|
//! | `field` | [`Field`]: positions, velocity, acceleration, jerk |
//! | `profile` | [`Profile`]: one limit of one joint over time |
//! | `joint_limits` | [`Limits`]: those in force, per joint and field |
//! | `tick_box` | [`TickBox`]: where one tick may end |
//! | `braking` | room to brake, where accelerations are limited |

mod braking;
mod field;
mod joint_limits;
mod profile;
mod tick_box;

pub use field::Field;
pub use joint_limits::Limits;
pub use profile::{Profile, Sinusoid};
pub use tick_box::LimitAt;
pub(crate) use tick_box::TickBox;
