//! Joint motion in time.

mod piecewise;
mod segment;
mod sequence;

pub use piecewise::{Coefficients, POWERS, Trajectory, polynomial};
