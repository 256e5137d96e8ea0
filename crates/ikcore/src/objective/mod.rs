//! The meeting point of the robot side and the solver side: what is minimised, and within which box.
//!
//! An objective implements what it can: [`Objective`] (values), [`Residual`], [`Gradient`], [`LeastSquares`] (residual and
//! Jacobian). A solver asks for what it needs, and the compiler checks that the two fit.

mod bounds;
mod evaluation;
mod gradient;
mod least_squares;
mod point;

pub use bounds::Bounds;
pub use evaluation::{CallPattern, Objective, Score};
pub use gradient::{Gradient, SmoothScore};
pub use least_squares::{Differentiable, LeastSquares, Linearization, Residual};
pub(crate) use least_squares::{FourLinearizations, SideBySide};
pub use point::Point;
