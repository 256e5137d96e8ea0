//! Objectives that are sums of squares: residuals and Jacobians.

use super::evaluation::{Objective, Score};
use super::gradient::Gradient;
use crate::math::MAX_DOF;
use crate::math::box_step::ROWS;

/// Residual r and Jacobian dr/dx at a point.
#[derive(Debug, Clone)]
pub struct Linearization {
    /// Weighted residual, actual minus target; rows that a task does not use are zero.
    pub residual: [f64; ROWS],
    /// Columns of the weighted Jacobian, one per entry of x; the first `dimension` are in use.
    pub columns: [[f64; ROWS]; MAX_DOF],
}

impl Default for Linearization {
    fn default() -> Self {
        Self { residual: [0.0; ROWS], columns: [[0.0; ROWS]; MAX_DOF] }
    }
}

/// An objective that is a sum of at most six squares.
pub trait Residual: Objective {
    /// The weighted residual at `x`, actual minus target, and the score; rows that a task does not use are zero.
    fn residual(&mut self, x: &[f64], out: &mut [f64; ROWS]) -> Score;
}

/// A residual with its Jacobian.
pub trait LeastSquares: Residual {
    /// Residual and Jacobian at `x` in one pass, and the score.
    fn linearize(&mut self, x: &[f64], out: &mut Linearization) -> Score;
}

impl Linearization {
    /// Writes J'r, the gradient of r'r / 2, into `gradient`, which has one entry per entry of x.
    pub fn gradient(&self, gradient: &mut [f64]) {
        for (slope, column) in gradient.iter_mut().zip(&self.columns) {
            *slope = column.iter().zip(&self.residual).map(|(c, r)| c * r).sum();
        }
    }
}

/// All evaluations of the inverse kinematics problem that a solver may use.
pub trait Differentiable: LeastSquares + Gradient {}

impl<O: LeastSquares + Gradient + ?Sized> Differentiable for O {}
