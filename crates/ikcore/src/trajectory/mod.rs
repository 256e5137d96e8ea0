//! Joint motion in time.

mod coefficients;
mod hermite_segment;
mod piecewise;
mod sequence;

pub use coefficients::{Coefficients, POWERS, polynomial};
pub use piecewise::Trajectory;
