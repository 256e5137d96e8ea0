//! Robots: the serial chain from a base link to a tip link, its joints, limits and kinematics.

mod builder;
mod chain;
mod joint;
mod kinematics;
mod model;

pub use builder::{ChainBuilder, Drive};
pub use joint::{Joint, JointKind};
pub use kinematics::Columns;
pub use model::Robot;

use crate::math::MAX_DOF;
