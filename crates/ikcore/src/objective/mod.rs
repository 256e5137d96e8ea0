//! Interface between robots and solvers: objectives and the box of the search.
//!
//! An objective implements the traits that apply to it: [`Objective`] (values), [`Residual`], [`Gradient`],
//! [`LeastSquares`] (residual and Jacobian). A solver requires the traits it needs, and the compiler checks that the
//! two match.

mod bounds;
mod evaluation;
mod gradient;
mod least_squares;
mod point;

pub use bounds::Bounds;
pub use evaluation::{CallPattern, Objective, Score};
pub use gradient::{Gradient, SmoothScore};
pub use least_squares::{Differentiable, LeastSquares, Linearization, Residual, TaskBlock, TaskResiduals};
pub use point::Point;
