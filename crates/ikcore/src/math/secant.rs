//! Jacobian estimated from differences: its columns from probing steps (antennae), then a rank-one update after every step.

use smallvec::{SmallVec, smallvec};

use super::Columns;
use super::block_step::{BlockStep, TaskRows};
use super::box_step::{BoxStep, ROWS};
use super::vector::squared_size;

/// Step length below which a difference measures only rounding.
const SHORTEST: f64 = 1e-12;

/// Estimate of the Jacobian dr/dx, by columns.
#[derive(Debug, Clone, Default)]
pub struct Secant {
    columns: Columns,
}

impl Secant {
    /// Sets column `j` from one antenna: x_j moved by `length`, and r changed by `difference`.
    pub fn set_column(&mut self, j: usize, length: f64, difference: &[f64; ROWS]) {
        self.columns.fit(j + 1);
        self.columns[j] = difference.map(|change| change / length);
    }

    /// Predicts the change J dx of the first `R` rows of r by a step dx.
    pub fn predict<const R: usize>(&self, dx: impl Iterator<Item = f64>) -> [f64; R] {
        let mut sum = [0.0; R];
        for (column, dx) in self.columns.iter().zip(dx) {
            (0..R).for_each(|k| sum[k] += column[k] * dx);
        }
        sum
    }

    /// Updates J after a step `dx` that changed r by `surprise` more than predicted: J + fraction surprise dx' / |dx|^2. With
    /// fraction 1 it is the smallest change of J that explains the step (Broyden 1965, eq. 4.5); a noisy r takes less.
    pub fn learn<const R: usize>(&mut self, dx: impl Iterator<Item = f64> + Clone, surprise: &[f64; R], fraction: f64) {
        let squared: f64 = dx.clone().map(|dx| dx * dx).sum();
        if squared < SHORTEST * SHORTEST {
            return;
        }
        let scale = fraction / squared;
        for (column, dx) in self.columns.iter_mut().zip(dx) {
            let weight = scale * dx;
            (0..R).for_each(|k| column[k] += weight * surprise[k]);
        }
    }

    /// Returns the squared Frobenius norm of the first `n` columns.
    pub fn size(&self, n: usize) -> f64 {
        squared_size(&self.columns[..n])
    }

    /// Writes into `out` the bounded step from `x`; `damping` is relative to the squared size of the Jacobian.
    pub fn step(&self, residual: &[f64; ROWS], damping: f64, x: &[f64], [lower, upper]: [&[f64]; 2], out: &mut [f64]) {
        let lambda = damping * self.size(x.len());
        BoxStep { columns: &self.columns, residual, lambda, x, lower, upper }.write(out);
    }
}

/// Jacobian estimates of several tasks.
#[derive(Debug, Clone, Default)]
pub struct SecantBlocks(SmallVec<[Secant; 1]>);

impl SecantBlocks {
    /// Creates zero Jacobians for this many tasks.
    pub fn new(tasks: usize) -> Self {
        Self(smallvec![Secant::default(); tasks])
    }

    /// Sets column `j` from one antenna: x_j moved by `length`, and the residuals changed from `before` to `after`.
    pub fn set_column(&mut self, j: usize, length: f64, before: &[[f64; ROWS]], after: &[[f64; ROWS]]) {
        for (secant, (before, after)) in self.0.iter_mut().zip(before.iter().zip(after)) {
            secant.set_column(j, length, &std::array::from_fn(|k| after[k] - before[k]));
        }
    }

    /// Updates the Jacobians after a step `dx` that changed the residuals from `before` to `after`.
    pub fn learn(&mut self, dx: impl Iterator<Item = f64> + Clone, before: &[[f64; ROWS]], after: &[[f64; ROWS]]) {
        for (secant, (before, after)) in self.0.iter_mut().zip(before.iter().zip(after)) {
            let predicted: [f64; ROWS] = secant.predict(dx.clone());
            let surprise: [f64; ROWS] = std::array::from_fn(|k| after[k] - before[k] - predicted[k]);
            secant.learn(dx.clone(), &surprise, 1.0);
        }
    }

    /// Writes into `out` the bounded step from `x`; `damping` is relative to the squared size of the Jacobians.
    pub fn step(
        &self,
        residuals: &[[f64; ROWS]],
        damping: f64,
        x: &[f64],
        [lower, upper]: [&[f64]; 2],
        out: &mut [f64],
    ) {
        if let ([secant], [residual]) = (&self.0[..], residuals) {
            return secant.step(residual, damping, x, [lower, upper], out);
        }
        let lambda = damping * self.0.iter().map(|secant| secant.size(x.len())).sum::<f64>();
        let rows = self.0.iter().zip(residuals);
        let rows = rows.map(|(Secant { columns }, residual)| TaskRows { columns, residual, scale: 1.0 });
        let tasks: SmallVec<[TaskRows<'_>; 4]> = rows.collect();
        BlockStep { tasks: &tasks, lambda, x, lower, upper }.write(out);
    }
}

/// Returns the signed length of an antenna from `x` in \[`lower`, `upper`\]: `length` towards a side with enough room, else
/// up to the farther bound; zero if there is no room on either side.
pub fn antenna(x: f64, length: f64, lower: f64, upper: f64) -> f64 {
    let (below, above) = ((x - lower).max(0.0), (upper - x).max(0.0));
    if above >= length || above >= below { length.min(above) } else { -length.min(below) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_update_explains_the_step_and_no_other_direction() {
        let mut secant = Secant::default();
        secant.set_column(0, 0.1, &[0.1, 0.2, 0.0, 0.0, 0.0, 0.0]);
        secant.set_column(1, -0.5, &[0.5, 0.0, -1.0, 0.0, 0.0, 0.0]);
        let (dx, across) = ([0.3, 0.4], [0.4, -0.3]);
        let (predicted, untouched) =
            (secant.predict::<ROWS>(dx.into_iter()), secant.predict::<ROWS>(across.into_iter()));
        let seen = [0.7, -0.2, 0.1, 0.0, 0.0, 0.0];
        secant.learn::<ROWS>(dx.into_iter(), &std::array::from_fn(|k| seen[k] - predicted[k]), 1.0);
        let (along, beside) = (secant.predict::<ROWS>(dx.into_iter()), secant.predict::<ROWS>(across.into_iter()));
        for k in 0..ROWS {
            assert!((along[k] - seen[k]).abs() < 1e-15 && (beside[k] - untouched[k]).abs() < 1e-15);
        }
    }

    #[test]
    fn antennae_stay_in_the_box() {
        assert_eq!(antenna(0.0, 0.1, -1.0, 1.0), 0.1);
        assert_eq!(antenna(0.95, 0.1, -1.0, 1.0), -0.1);
        assert!((antenna(0.02, 0.1, 0.0, 0.05) - 0.03).abs() < 1e-15);
        assert!((antenna(0.04, 0.1, 0.0, 0.05) + 0.04).abs() < 1e-15);
        assert_eq!(antenna(0.5, 0.1, 0.5, 0.5), 0.0);
    }
}
