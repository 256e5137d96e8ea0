//! Errors of a tip relative to its target, weighted by a criterion.

use super::components::Components;
use super::criterion::Criterion;
use super::target::Target;
use super::tip_error::SquaredError;
use crate::math::Frame;
use crate::math::box_step::ROWS;
use crate::objective::{Score, TaskBlock};

/// Errors of a tip relative to its target, judged by a criterion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Assessment {
    /// Weighted sum of squares, and whether the target is reached.
    pub score: Score,
    /// Unweighted errors of the components that count.
    pub error: SquaredError,
}

impl Criterion {
    /// Assesses `error` with the sum of squares `value`, if all components have the same weight.
    #[inline(always)]
    pub(super) fn assess_unweighted(&self, error: SquaredError, value: f64) -> Assessment {
        Assessment { score: Score { value, solved: error.within(&self.tolerance) }, error }
    }

    /// Assesses the residual of `target`, in base coordinates, by `components`.
    pub(super) fn assess_components(
        &self,
        components: &Components,
        target: &Target,
        residual: &[f64; ROWS],
        error: SquaredError,
    ) -> Assessment {
        let Components { weights, tolerance } = components;
        let turned = turned_into_frame(target, residual);
        let mut entries: [f64; ROWS] = std::array::from_fn(|k| if weights[k] == 0.0 { 0.0 } else { turned[k] });
        let value = (0..ROWS).map(|k| (weights[k] * turned[k]).powi(2)).sum();
        if let (Target::Pointing { .. }, Some(squared)) = (target, error.rotation) {
            let angle = if weights[3] == 0.0 { 0.0 } else { squared.sqrt() };
            entries[3..].copy_from_slice(&[angle, 0.0, 0.0]);
        }
        let counted = |rows: std::ops::Range<usize>, asked: Option<f64>| {
            let counts = asked.is_some() && weights[rows.clone()].iter().any(|weight| *weight != 0.0);
            counts.then(|| entries[rows].iter().map(|entry| entry * entry).sum())
        };
        let error = SquaredError { position: counted(0..3, error.position), rotation: counted(3..6, error.rotation) };
        let solved = match tolerance {
            Some(tolerance) => entries.iter().zip(tolerance).all(|(entry, tolerance)| entry.abs() <= *tolerance),
            None => error.within(&self.tolerance),
        };
        Assessment { score: Score { value, solved }, error }
    }
}

impl Components {
    /// Rotates residual and columns from base coordinates into the target's frame, and weights them.
    pub(super) fn apply(&self, target: &Target, dof: usize, out: &mut TaskBlock) {
        let weighted = |vector: &[f64; ROWS]| {
            let turned = turned_into_frame(target, vector);
            std::array::from_fn(|k| self.weights[k] * turned[k])
        };
        out.residual = weighted(&out.residual);
        for column in &mut out.columns[..dof] {
            *column = weighted(column);
        }
    }
}

impl Target {
    /// Unweighted residual of `tip`, one entry per component.
    pub(crate) fn residual_by_component(&self, tip: &Frame) -> [f64; ROWS] {
        turned_into_frame(self, &self.residual(tip))
    }
}

/// Rotates both halves of a vector from base coordinates into the target frame. The difference of two axes is not
/// rotated, because only its length counts.
fn turned_into_frame(target: &Target, vector: &[f64; ROWS]) -> [f64; ROWS] {
    let along = |frame: &Frame, half: usize| -> [f64; 3] {
        frame.axes.map(|axis| (0..3).map(|k| axis[k] * vector[3 * half + k]).sum())
    };
    let rest = [vector[3], vector[4], vector[5]];
    let ([x, y, z], [u, v, w]) = match target {
        Target::Position(_) => return *vector,
        Target::Pointing { frame, .. } => (along(frame, 0), rest),
        Target::Pose(frame) | Target::Orientation(frame) => (along(frame, 0), along(frame, 1)),
    };
    [x, y, z, u, v, w]
}
