//! Joint motion in time: piecewise polynomials with exact extremes.
//!
//! `piecewise` holds [`Trajectory`], `coefficients` the polynomial of one joint in one segment, `hermite_segment` its
//! construction from values at both ends, and `sequence` the concatenation of motions.

mod coefficients;
mod hermite_segment;
mod piecewise;
mod sequence;

pub(crate) use coefficients::derivative_bounds;
pub use coefficients::{Coefficients, POWERS, polynomial};
pub use piecewise::Trajectory;
