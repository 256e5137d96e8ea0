//! Objectives with a smooth error and its gradient.

use super::evaluation::{Objective, Score};

/// Objective with a smooth error E, whose gradient needs no Jacobian.
///
/// E may differ from half of the score's value, but has the same zeros. For a pose it is eq. (11) of Yuan et al. 2016.
pub trait Gradient: Objective {
    /// Returns E and the score at `x`, and writes dE/dx into `gradient`, which has one entry per entry of x.
    fn differentiate(&mut self, x: &[f64], gradient: &mut [f64]) -> SmoothScore;
}

/// Smooth error and score of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SmoothScore {
    /// Smooth error E.
    pub error: f64,
    /// Score, whose value may measure the error differently.
    pub score: Score,
}
