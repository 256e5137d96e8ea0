//! Joint motion in time: piecewise polynomials with exact extremes.

mod coefficients;
mod hermite_segment;
mod piecewise;
mod sequence;

pub use coefficients::{Coefficients, POWERS, polynomial};
pub use piecewise::Trajectory;
