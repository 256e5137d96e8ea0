//! Joint motion in time.

mod piecewise;

pub use piecewise::{Coefficients, Trajectory};
