//! Normal equations of weighted least squares with a prior, in units of the prior.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::estimate::Estimate;
use super::residual::{Block, Comparison, LENGTHS, ResidualScratch};
use crate::error::Result;
use crate::interrupt::checkpoint_at;

/// Noise and weight of each measurement.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Weighing {
    /// Standard deviations of lengths and angles, of each measurement (m or pixels, rad).
    pub sigma: Vec<[f64; 2]>,
    /// Factor on the squares of each measurement, from 0 to 1.
    pub weights: Vec<f64>,
}

/// A'A + I, A'r + z and r'r + z'z: r are the weighted residuals, A their Jacobian by z, parameters in units of their prior.
pub(super) struct NormalEquations {
    pub matrix: DMatrix<f64>,
    pub gradient: DVector<f64>,
    pub cost: f64,
}

impl Block {
    /// Divides by the noise, and multiplies columns by `scales`.
    pub fn whiten(&mut self, sigma: [f64; 2], has_rotations: bool, scales: &[f64]) {
        let rows = self.residual.iter_mut().zip(self.jacobian.chunks_exact_mut(scales.len())).enumerate();
        for (row, (residual, slopes)) in rows {
            let factor = 1.0 / sigma[usize::from(has_rotations && row >= LENGTHS)];
            *residual *= factor;
            slopes.iter_mut().zip(scales).for_each(|(slope, scale)| *slope *= factor * scale);
        }
    }
}

impl Comparison<'_> {
    /// Calls `visit` with each measurement, whitened.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted).
    pub fn each(
        &self,
        estimate: &Estimate,
        weighing: &Weighing,
        scales: &[f64],
        mut visit: impl FnMut(usize, &Block),
    ) -> Result<()> {
        let (mut scratch, mut block) = (ResidualScratch::default(), Block::default());
        for index in 0..self.measured.count() {
            checkpoint_at(index)?;
            self.write(index, estimate, &mut scratch, &mut block);
            block.whiten(weighing.sigma[index], self.measured.has_rotations(), scales);
            visit(index, &block);
        }
        Ok(())
    }
}

impl NormalEquations {
    /// Assembles them at an estimate. Scale 0 holds a parameter.
    pub fn at(comparison: &Comparison<'_>, estimate: &Estimate, weighing: &Weighing, scales: &[f64]) -> Result<Self> {
        let n = scales.len();
        let z = prior_residuals(comparison, estimate, scales);
        let mut matrix = vec![0.0; n * n];
        let mut gradient = vec![0.0; n];
        let mut cost = 0.0;
        comparison.each(estimate, weighing, scales, |index, block| {
            let weight = weighing.weights[index];
            if weight == 0.0 {
                return;
            }
            for (residual, slopes) in block.residual.iter().zip(block.jacobian.chunks_exact(n)) {
                cost += weight * residual * residual;
                for (k, slope) in slopes.iter().enumerate().filter(|(_, slope)| **slope != 0.0) {
                    let factor = weight * slope;
                    gradient[k] += factor * residual;
                    let column = &mut matrix[k * n + k..(k + 1) * n];
                    column.iter_mut().zip(&slopes[k..]).for_each(|(entry, other)| *entry += factor * other);
                }
            }
        })?;
        for k in 0..n {
            matrix[k * n + k] += 1.0;
            gradient[k] += z[k];
            cost += z[k] * z[k];
        }
        // The lower triangle, which the decomposition reads.
        Ok(Self { matrix: DMatrix::from_vec(n, n, matrix), gradient: DVector::from_vec(gradient), cost })
    }

    /// Decomposes the matrix with its diagonal larger by the factor 1 + `damping`.
    pub fn decomposed(&self, damping: f64) -> Option<Cholesky<f64, Dyn>> {
        let mut damped = self.matrix.clone();
        (0..damped.nrows()).for_each(|k| damped[(k, k)] *= 1.0 + damping);
        Cholesky::new(damped)
    }
}

/// Deviations from the start, in units of the prior.
pub(super) fn prior_residuals(comparison: &Comparison<'_>, estimate: &Estimate, scales: &[f64]) -> Vec<f64> {
    let values = estimate.values(&comparison.model.parameters, &comparison.measured.landmark());
    values.iter().zip(scales).map(|(value, scale)| if *scale == 0.0 { 0.0 } else { value / scale }).collect()
}

/// Cost at an estimate: squares of the weighted residuals and of the prior.
pub(super) fn cost(
    comparison: &Comparison<'_>,
    estimate: &Estimate,
    weighing: &Weighing,
    scales: &[f64],
) -> Result<f64> {
    let mut cost: f64 = prior_residuals(comparison, estimate, scales).iter().map(|z| z * z).sum();
    let has_rotations = comparison.measured.has_rotations();
    let (mut scratch, mut block) = (ResidualScratch::default(), Block::default());
    for (index, (weight, sigma)) in weighing.weights.iter().zip(&weighing.sigma).enumerate() {
        checkpoint_at(index)?;
        comparison.write_residual(index, estimate, &mut scratch, &mut block);
        let group = |row: usize| usize::from(has_rotations && row >= LENGTHS);
        let whitened = block.residual.iter().enumerate().map(|(row, residual)| residual / sigma[group(row)]);
        cost += weight * whitened.map(|r| r * r).sum::<f64>();
    }
    Ok(cost)
}
