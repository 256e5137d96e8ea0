//! Errors beyond the tolerances: what a search lowers when any error within them is as good as none.
//!
//! A component keeps what exceeds its tolerance; a distance or an angle without components is shortened by its tolerance. The
//! search aims a little inside the tolerance, so that it ends within.

use super::criterion::Criterion;
use super::target::Target;
use crate::math::box_step::ROWS;
use crate::objective::TaskBlock;

/// Fraction of a tolerance that the search aims at.
pub(super) const AIMED_AT: f64 = 0.999;

/// Tolerance (m, rad) up to which a search for the exact target is as good.
const NARROW: f64 = 1e-5;

impl Criterion {
    /// Criterion whose value is the excess over the tolerances.
    pub(crate) fn beyond_tolerance(self) -> Self {
        Self { beyond: true, ..self }
    }

    /// Whether tolerances are wide enough to be aimed at.
    pub(crate) fn has_band(&self) -> bool {
        match &self.components {
            Some(components) => components.tolerance.is_some(),
            None => self.tolerance.position.max(self.tolerance.rotation) > NARROW,
        }
    }

    /// Reduces a weighted residual, along the axes of the target if components count, and its derivatives to what lies beyond the
    /// tolerances; returns the sum of squares.
    #[inline(never)]
    pub(super) fn reduce_to_excess(&self, target: &Target, dof: usize, out: &mut TaskBlock) -> f64 {
        let chord = |angle: f64| 2.0 * (0.5 * angle.min(std::f64::consts::PI)).sin();
        let is_pointing = matches!(target, Target::Pointing { .. });
        match &self.components {
            Some(components) => {
                let Some(tolerance) = components.tolerance else { return squares(&out.residual) };
                let single = if is_pointing { 3 } else { ROWS };
                for k in 0..single {
                    reduce_row(k, AIMED_AT * components.weights[k] * tolerance[k], dof, out);
                }
                if is_pointing {
                    reduce_rows(3, AIMED_AT * components.weights[3] * chord(tolerance[3]), dof, out);
                }
            }
            None => {
                let rotation = if is_pointing { chord(self.tolerance.rotation) } else { self.tolerance.rotation };
                reduce_rows(0, AIMED_AT * self.tolerance.position, dof, out);
                reduce_rows(3, AIMED_AT * rotation, dof, out);
            }
        }
        squares(&out.residual)
    }
}

fn squares(residual: &[f64; ROWS]) -> f64 {
    residual.iter().map(|entry| entry * entry).sum()
}

/// Reduces row `k` to its excess over `band`; a band of NaN is that of a component that is free.
fn reduce_row(k: usize, band: f64, dof: usize, out: &mut TaskBlock) {
    let entry = out.residual[k];
    if entry.abs() > band {
        out.residual[k] = entry - band.copysign(entry);
    } else {
        out.residual[k] = 0.0;
        out.columns[..dof].iter_mut().for_each(|column| column[k] = 0.0);
    }
}

/// Shortens the vector of the three rows from `first` on by `band`.
fn reduce_rows(first: usize, band: f64, dof: usize, out: &mut TaskBlock) {
    let TaskBlock { residual, columns, .. } = out;
    let vector: [f64; 3] = std::array::from_fn(|k| residual[first + k]);
    let length = vector.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
    if !(length > band) {
        residual[first..first + 3].fill(0.0);
        columns[..dof].iter_mut().for_each(|column| column[first..first + 3].fill(0.0));
        return;
    }
    let kept = 1.0 - band / length;
    (0..3).for_each(|k| residual[first + k] = kept * vector[k]);
    for column in &mut columns[..dof] {
        let along: f64 = (0..3).map(|k| vector[k] * column[first + k]).sum::<f64>() * band / (length * length * length);
        (0..3).for_each(|k| column[first + k] = kept * column[first + k] + along * vector[k]);
    }
}
