//! `Limits` and `Sinusoid`.

mod given;
mod joint_limits;
mod of_call;
mod of_tips;
mod per_joint;
mod sampling;
mod sinusoid;

pub use joint_limits::PyLimits;
pub use of_call::{limits_of_call, limits_without_robot, required_limits};
pub use per_joint::PerJoint;
pub use sampling::Sampling;
pub use sinusoid::PySinusoid;
