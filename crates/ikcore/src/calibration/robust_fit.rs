//! Robust fit: Cauchy weights find the measurements that do not belong, and least squares over the others follow.

use super::estimate::Estimate;
use super::levenberg_marquardt::{Descent, descend};
use super::normal_equations::{NormalEquations, Weighing};
use super::residual::Comparison;
use super::statistics::{Influence, chi_square, covariance, influences};
use crate::error::Result;

/// Smallest noise that is believed (m or pixels, rad): rounding of files, and the conditioning of the normal equations.
const LEAST_NOISE: [f64; 2] = [1e-7, 1e-7];
/// Tuning constant of Cauchy's weights: 95 % efficiency for normal noise.
const CAUCHY: f64 = 2.385;
/// Standard deviations beyond which a measurement is an outlier: 3 in 100,000 of a normal variable.
const OUTLIER: f64 = 4.0;
/// Rounds of reweighting, and of rejection.
const ROUNDS: usize = 20;
/// Largest part of the measurements that may be outliers.
const MOST_OUTLIERS: f64 = 0.4;
/// Round after which changes of the noise are too small to matter.
const LAST_ROUND: usize = 4;
/// Relative change of the noise that counts as none.
const STEADY: f64 = 0.02;
/// Maximum number of steps of a descent between two changes of the weights.
const STEPS: usize = 4;
/// Maximum number of steps of the descent after the last change.
const LAST_STEPS: usize = 50;

/// Noise as it was given; without it, it is estimated from the residuals.
#[derive(Debug, Clone)]
pub(super) struct NoiseModel {
    /// Noise of each measurement.
    pub given: Option<Vec<[f64; 2]>>,
    /// Whether outliers are down-weighted.
    pub robust: bool,
}

/// Optimum with its weighing.
#[derive(Debug, Clone)]
pub(super) struct RobustFit {
    pub descent: Descent,
    pub weighing: Weighing,
    pub outliers: Vec<usize>,
    /// Estimated noise over the given one; the noise itself if none was given.
    pub scale: [f64; 2],
}

/// Fits all parameters of nonzero scale.
pub(super) fn fitted(
    comparison: &Comparison<'_>,
    start: Estimate,
    noise: &NoiseModel,
    first_scale: [f64; 2],
    scales: &[f64],
) -> Result<RobustFit> {
    let count = comparison.measured.count();
    let mut fit = RobustFit {
        descent: Descent { estimate: start, iterations: 0, converged: false },
        weighing: noise.weighing(count, first_scale),
        outliers: vec![],
        scale: first_scale,
    };
    if noise.robust {
        reweight(comparison, noise, scales, &mut fit)?;
    }
    reject(comparison, noise, scales, &mut fit)?;
    Ok(fit)
}

impl NoiseModel {
    fn weighing(&self, count: usize, scale: [f64; 2]) -> Weighing {
        let sigma = match &self.given {
            None => vec![scale; count],
            Some(given) => given.iter().map(|[a, b]| [a * scale[0].max(1.0), b * scale[1].max(1.0)]).collect(),
        };
        Weighing { sigma, weights: vec![1.0; count] }
    }

    /// Noise of a measurement for scale 1.
    fn unit(&self, index: usize) -> [f64; 2] {
        self.given.as_ref().map_or([1.0; 2], |given| given[index])
    }

    /// Robust scale of the residuals: medians of their squares, over those of normal noise.
    fn median_scale(&self, influences: &[Influence], parameters_left: f64) -> [f64; 2] {
        std::array::from_fn(|group| {
            let ratio = |(index, influence): (usize, &Influence)| {
                let expected = chi_square(influence.counts[group].max(1), 0.0) * self.unit(index)[group].powi(2);
                influence.squares[group] / expected
            };
            let mut ratios: Vec<f64> = influences.iter().enumerate().map(ratio).collect();
            ratios.sort_by(f64::total_cmp);
            let median = ratios[ratios.len() / 2];
            self.believed(group, (median / parameters_left).sqrt())
        })
    }

    /// Scale of the residuals of the measurements in use, with the degrees of freedom that the fit took.
    fn mean_scale(&self, influences: &[Influence], weights: &[f64]) -> [f64; 2] {
        std::array::from_fn(|group| {
            let (mut sum, mut left) = (0.0, 0.0);
            for (index, influence) in influences.iter().enumerate().filter(|(index, _)| weights[*index] > 0.0) {
                sum += influence.squares[group] / self.unit(index)[group].powi(2);
                left += influence.counts[group] as f64 - influence.taken[group];
            }
            self.believed(group, if left > 0.5 { (sum / left).sqrt() } else { 0.0 })
        })
    }

    fn believed(&self, group: usize, scale: f64) -> f64 {
        if self.given.is_some() { scale } else { scale.max(LEAST_NOISE[group]) }
    }
}

/// Lowers the weights of measurements with large residuals until they change no more.
fn reweight(comparison: &Comparison<'_>, noise: &NoiseModel, scales: &[f64], fit: &mut RobustFit) -> Result<()> {
    let count = comparison.measured.count();
    for round in 0..ROUNDS {
        // The first weights come from the start, where gross errors have not yet bent the arm.
        if round > 0 {
            let start = fit.descent.estimate.clone();
            let before = fit.descent.iterations;
            fit.descent = descend(comparison, start, &fit.weighing, scales, STEPS)?;
            fit.descent.iterations += before;
        }
        let Some(mut found) = judged(comparison, fit, scales)? else { return Ok(()) };
        if round == 0 {
            // Nothing was fitted yet.
            found.iter_mut().for_each(|one| one.taken = [0.0; 2]);
        }
        let share = share_left(&found);
        let scale = noise.median_scale(&found, share);
        let mut next = noise.weighing(count, scale);
        for (index, influence) in found.iter().enumerate() {
            let (square, entries) = influence.studentised(next.sigma[index]);
            next.weights[index] = 1.0 / (1.0 + square / (entries.max(1) as f64 * CAUCHY * CAUCHY));
        }
        let change = next.weights.iter().zip(&fit.weighing.weights).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let settled = (scale[0] / fit.scale[0] - 1.0).abs() < 0.05 && change < 0.05;
        (fit.weighing, fit.scale) = (next, scale);
        if settled && round > 0 {
            break;
        }
    }
    Ok(())
}

/// Part of the entries that the fit leaves free; residuals are smaller than the noise by its root.
fn share_left(influences: &[Influence]) -> f64 {
    let entries: usize = influences.iter().map(|one| one.counts[0] + one.counts[1]).sum();
    let taken: f64 = influences.iter().map(|one| one.taken[0] + one.taken[1]).sum();
    (1.0 - taken / entries as f64).max(0.05)
}

/// Least squares over the measurements that are no outliers, until these stay the same.
fn reject(comparison: &Comparison<'_>, noise: &NoiseModel, scales: &[f64], fit: &mut RobustFit) -> Result<()> {
    let count = comparison.measured.count();
    fit.outliers = if noise.robust { outliers_of(comparison, fit, scales)? } else { vec![] };
    for round in 0..ROUNDS {
        fit.weighing = noise.weighing(count, fit.scale);
        fit.outliers.iter().for_each(|row| fit.weighing.weights[*row] = 0.0);
        let before = fit.descent.iterations;
        fit.descent = descend(comparison, fit.descent.estimate.clone(), &fit.weighing, scales, LAST_STEPS)?;
        fit.descent.iterations += before;
        let Some(found) = judged(comparison, fit, scales)? else { break };
        let scale = noise.mean_scale(&found, &fit.weighing.weights);
        let steady = (0..2).all(|group| (scale[group] - fit.scale[group]).abs() <= STEADY * fit.scale[group]);
        fit.scale = scale;
        let outliers = if noise.robust { outliers_of(comparison, fit, scales)? } else { vec![] };
        if outliers == fit.outliers && (steady || noise.given.is_some() || round >= LAST_ROUND) || round + 1 == ROUNDS {
            break;
        }
        fit.outliers = outliers;
    }
    Ok(())
}

fn judged(comparison: &Comparison<'_>, fit: &RobustFit, scales: &[f64]) -> Result<Option<Vec<Influence>>> {
    let system = NormalEquations::at(comparison, &fit.descent.estimate, &fit.weighing, scales)?;
    let Some(covariance) = covariance(&system) else { return Ok(None) };
    influences(comparison, &fit.descent.estimate, &fit.weighing, scales, &covariance).map(Some)
}

/// Measurements whose residual is beyond the noise, the worst ones first if they are too many.
fn outliers_of(comparison: &Comparison<'_>, fit: &RobustFit, scales: &[f64]) -> Result<Vec<usize>> {
    let Some(found) = judged(comparison, fit, scales)? else { return Ok(vec![]) };
    // Too few measurements cannot tell an outlier from the arm.
    let entries: usize = found.iter().map(|one| one.counts[0] + one.counts[1]).sum();
    if share_left(&found) * (entries as f64) < 6.0 {
        return Ok(vec![]);
    }
    let mut beyond: Vec<(f64, usize)> = vec![];
    for (index, influence) in found.iter().enumerate() {
        // A measurement left out has not drawn the fit towards itself.
        let left_out = fit.weighing.weights[index] == 0.0;
        let one = Influence { taken: if left_out { [0.0; 2] } else { influence.taken }, ..influence.clone() };
        let (square, entries) = one.studentised(fit.weighing.sigma[index]);
        let ratio = square / chi_square(entries, OUTLIER);
        if ratio > 1.0 {
            beyond.push((ratio, index));
        }
    }
    beyond.sort_by(|a, b| b.0.total_cmp(&a.0));
    beyond.truncate((MOST_OUTLIERS * found.len() as f64) as usize);
    let mut rows: Vec<usize> = beyond.into_iter().map(|(_, row)| row).collect();
    rows.sort_unstable();
    Ok(rows)
}
