//! A robot and a target as something to minimise, and why a target was missed.

mod inverse_kinematics;
mod obstruction;

pub use inverse_kinematics::Problem;
pub(crate) use obstruction::obstruction;
