//! Joint motion in time.

mod hermite;
mod piecewise;

pub use piecewise::{Coefficients, POWERS, Trajectory, polynomial};
