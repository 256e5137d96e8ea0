//! Limits on joint motion as functions of time, and the box of joint positions that they allow at the end of a tick.
//!
//! | file | what |
//! |---|---|
//! | `field` | [`Field`]: positions, velocity, acceleration, jerk |
//! | `profile` | [`Profile`]: one limit of one joint over time |
//! | `joint_limits` | [`Limits`]: all joints, all fields |
//! | `pace` | joints without any limit, and joints that a limit of zero locks |
//! | `start_gate` | starts and configurations as a caller reads them |
//! | `tip_limits` | [`TipField`], `TipLimits`: limits of the motion of tips |
//! | `tick_box` | `TickBox`: position and velocity limits as the box of one tick |
//! | `braking` | acceleration limits narrow that box, so that joints can stop in time |

mod field;
mod joint_limits;
mod pace;
mod profile;
mod start_gate;
mod tick_box;
mod tip_limits;

pub use field::Field;
pub use joint_limits::Limits;
pub(crate) use joint_limits::ROUNDING;
pub(crate) use pace::no_pace;
pub use profile::{Profile, Sinusoid};
pub use start_gate::{AdmittedStart, JointOutside, StartSlack};
pub use tick_box::LimitAt;
pub(crate) use tick_box::TickBox;
pub use tip_limits::TipField;
pub(crate) use tip_limits::TipLimits;
