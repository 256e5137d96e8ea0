//! Statistics at the optimum: covariance, leverages, errors of held-out measurements.

use nalgebra::{DMatrix, DVector};

use super::estimate::Estimate;
use super::normal_equations::{NormalEquations, Weighing};
use super::residual::{Block, Comparison, LENGTHS};
use crate::error::Result;

/// Residual of one measurement, and the part of it that the fit absorbed.
#[derive(Debug, Clone)]
pub(super) struct Influence {
    /// Squared lengths and angles of the residual (m^2 or pixels^2, rad^2).
    pub squares: [f64; 2],
    /// Entries of both.
    pub counts: [usize; 2],
    /// Traces of the hat matrix over both: degrees of freedom that the measurement takes.
    pub taken: [f64; 2],
    /// Squared lengths and angles of the residual if the measurement is held out; infinite if it alone determines something.
    pub held_out: [f64; 2],
}

/// Inverse of the normal matrix: covariance of the parameters in units of their prior.
pub(super) fn covariance(system: &NormalEquations) -> Option<DMatrix<f64>> {
    Some(system.decomposed(0.0).or_else(|| system.decomposed(1e-12))?.inverse())
}

/// Influence of each measurement. Those held out by closed form: e = (I - H)^-1 r with the hat matrix H = A C A' (Allen's PRESS), which
/// is exact for linear models.
pub(super) fn influences(
    comparison: &Comparison<'_>,
    estimate: &Estimate,
    weighing: &Weighing,
    scales: &[f64],
    covariance: &DMatrix<f64>,
) -> Result<Vec<Influence>> {
    let has_rotations = comparison.measured.has_rotations();
    let mut found = Vec::with_capacity(weighing.weights.len());
    comparison.each(estimate, weighing, scales, |index, block| {
        found.push(influence(block, weighing.sigma[index], weighing.weights[index], has_rotations, covariance));
    })?;
    Ok(found)
}

fn influence(block: &Block, sigma: [f64; 2], weight: f64, has_rotations: bool, covariance: &DMatrix<f64>) -> Influence {
    let (rows, n) = (block.residual.len(), covariance.nrows());
    let jacobian = DMatrix::from_row_slice(rows, n, &block.jacobian);
    let hat = weight * &jacobian * covariance * jacobian.transpose();
    let residual = DVector::from_column_slice(&block.residual);
    let rest = DMatrix::identity(rows, rows) - &hat;
    let held_out = rest.cholesky().map(|factor| factor.solve(&residual));
    let mut found = Influence { squares: [0.0; 2], counts: [0; 2], taken: [0.0; 2], held_out: [0.0; 2] };
    for row in 0..rows {
        let group = usize::from(has_rotations && row >= LENGTHS);
        let square = |whitened: f64| (whitened * sigma[group]).powi(2);
        found.squares[group] += square(residual[row]);
        found.counts[group] += 1;
        found.taken[group] += hat[(row, row)];
        found.held_out[group] += held_out.as_ref().map_or(f64::INFINITY, |held_out| square(held_out[row]));
    }
    found
}

impl Influence {
    /// Squared residual in units of the noise left after the fit, and its number of entries.
    pub fn studentised(&self, sigma: [f64; 2]) -> (f64, usize) {
        let group = |g: usize| {
            let count = self.counts[g] as f64;
            if self.counts[g] == 0 {
                return 0.0;
            }
            // A measurement that the fit follows closely has a small residual of itself.
            let left = (1.0 - self.taken[g] / count).max(1e-3);
            self.squares[g] / (sigma[g] * sigma[g] * left)
        };
        (group(0) + group(1), self.counts[0] + self.counts[1])
    }
}

/// Quantile of the chi-square distribution with `degrees` at `z` standard deviations of a normal variable (Wilson and Hilferty 1931).
pub(super) fn chi_square(degrees: usize, z: f64) -> f64 {
    let degrees = degrees as f64;
    let ninth = 2.0 / (9.0 * degrees);
    degrees * (1.0 - ninth + z * ninth.sqrt()).max(0.0).powi(3)
}
