//! Assessment and linearization of a tip without a region.

use super::assessment::Assessment;
use super::criterion::Criterion;
use super::residual::{orientation, pointing, pose, position};
use super::target::Target;
use super::tip_error::SquaredError;
use crate::math::Frame;
use crate::math::box_step::ROWS;
use crate::math::real::Real;
use crate::math::so3::axes_of;
use crate::objective::TaskBlock;

impl Target {
    /// Assesses `tip` by `criterion`, ignoring its region.
    #[inline]
    pub(super) fn assess_tip_anywhere(&self, tip: &Frame, criterion: &Criterion) -> Assessment {
        let (error, value) = self.error(tip);
        let mut assessment = match &criterion.components {
            None => criterion.assess_unweighted(error, value),
            Some(components) => criterion.assess_components(components, self, &self.residual(tip), error),
        };
        if criterion.beyond {
            assessment.score.value = self.excess(tip, criterion);
        }
        assessment
    }

    /// Value of the excess over the tolerances. Apart, because its block would burden the assessment of every other target.
    #[inline(never)]
    fn excess(&self, tip: &Frame, criterion: &Criterion) -> f64 {
        let mut block = TaskBlock { residual: self.residual(tip), ..TaskBlock::default() };
        if let Some(components) = &criterion.components {
            components.apply(self, 0, &mut block);
        }
        criterion.reduce_to_excess(self, 0, &mut block)
    }

    /// Writes weighted residual and Jacobian from the geometric Jacobian in the first `dof` columns of `out`, and returns the
    /// assessment by `criterion`, ignoring its region.
    #[inline]
    pub(super) fn linearize_tip_anywhere(
        &self,
        tip: &Frame,
        dof: usize,
        criterion: &Criterion,
        out: &mut TaskBlock,
    ) -> Assessment {
        let (error, value) = self.linearize_unweighted(tip, dof, out);
        let mut assessment = match &criterion.components {
            None => criterion.assess_unweighted(error, value),
            Some(components) => {
                let assessment = criterion.assess_components(components, self, &out.residual, error);
                components.apply(self, dof, out);
                assessment
            }
        };
        if criterion.beyond {
            assessment.score.value = criterion.reduce_to_excess(self, dof, out);
        }
        assessment
    }

    /// Writes unweighted residual and Jacobian, in base coordinates; returns the errors and r'r.
    #[inline]
    fn linearize_unweighted(&self, tip: &Frame, dof: usize, out: &mut TaskBlock) -> (SquaredError, f64) {
        match self {
            Self::Pose(target) => summed(pose::linearize(target, tip, dof, out)),
            Self::Position(target) => {
                position::linearize(target, &tip.origin, dof, out);
                self.error(tip)
            }
            Self::Pointing { frame, axis } => pointing::linearize(frame, axis, tip, dof, out),
            Self::Orientation(target) => {
                out.residual[..3].fill(0.0);
                out.columns[..dof].iter_mut().for_each(|column| column[..3].fill(0.0));
                let TaskBlock { residual, columns, .. } = out;
                let (target, tip) = (axes_of(target), axes_of(tip));
                let rotation = orientation::linearize(&target, &tip, residual, &mut columns[..dof]);
                summed(SquaredError { position: None, rotation: Some(rotation.stored()) })
            }
        }
    }

    /// Squared errors, and r'r.
    #[inline]
    fn error(&self, tip: &Frame) -> (SquaredError, f64) {
        match self {
            Self::Pose(target) => summed(pose::error(target, tip)),
            Self::Position(target) => {
                summed(SquaredError { position: Some(position::error(target, &tip.origin)), rotation: None })
            }
            Self::Pointing { frame, axis } => pointing::error(frame, axis, tip),
            Self::Orientation(target) => {
                summed(SquaredError { position: None, rotation: Some(orientation::error(target, tip)) })
            }
        }
    }

    /// Unweighted residual of `tip` in base coordinates.
    pub(super) fn residual(&self, tip: &Frame) -> [f64; ROWS] {
        let mut out = TaskBlock::default();
        self.linearize_unweighted(tip, 0, &mut out);
        out.residual
    }
}

/// Squared errors, and their sum.
#[inline(always)]
fn summed(error: SquaredError) -> (SquaredError, f64) {
    (error, error.sum())
}
