//! Joint motion in time.

mod hermite_segment;
mod piecewise;
mod sequence;

pub use piecewise::{Coefficients, POWERS, Trajectory, polynomial};
