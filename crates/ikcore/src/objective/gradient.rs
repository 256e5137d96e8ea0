//! Objectives with a smooth error and its gradient.

use super::evaluation::{Objective, Score};

/// An objective that knows a smooth error E and its gradient without forming a Jacobian.
///
/// E need not be half of the score's value, but has the same zeros. For a pose it is eq. (11) of Yuan et al. 2016.
pub trait Gradient: Objective {
    /// Returns E and the score at `x`, and writes dE/dx into `gradient`, which has one entry per entry of x.
    fn differentiate(&mut self, x: &[f64], gradient: &mut [f64]) -> SmoothScore;
}

/// The smooth error and the score of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SmoothScore {
    /// The smooth error E.
    pub error: f64,
    /// The score, whose value may measure the error differently.
    pub score: Score,
}
