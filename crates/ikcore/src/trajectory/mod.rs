//! Joint motion in time.

mod hermite;
mod piecewise;
mod sequence;

pub use piecewise::{Coefficients, POWERS, Trajectory, polynomial};
