//! Assessment and linearization of the tip of a robot: the entry points, with and without a region.

use super::assessment::Assessment;
use super::criterion::Criterion;
use super::residual::position;
use super::target::Target;
use super::tip_error::SquaredError;
use crate::math::Frame;
use crate::objective::TaskBlock;
use crate::robot::Robot;

impl Target {
    /// Assesses the tip of `robot` at `q` by `criterion`.
    #[inline]
    pub fn assess(&self, robot: &Robot, q: &[f64], criterion: &Criterion) -> Assessment {
        match (self, criterion.is_componentwise()) {
            (Self::Position(target), false) => position_alone(target, &robot.tip_position(q), criterion),
            _ => self.assess_tip(&robot.tip(q), criterion),
        }
    }

    /// Calls `keep` with the [assessment](Self::assess) of each of the configurations stored consecutively in `qs`, in
    /// order. Positions are computed several at a time.
    #[inline]
    pub(crate) fn assess_all(
        &self,
        robot: &Robot,
        qs: &[f64],
        criterion: &Criterion,
        mut keep: impl FnMut(Assessment),
    ) {
        match (self, criterion.is_componentwise()) {
            (Self::Position(target), false) => {
                robot.tip_positions(qs, |tip| keep(position_alone(target, &tip, criterion)));
            }
            _ => qs.chunks(robot.dof()).for_each(|q| keep(self.assess(robot, q, criterion))),
        }
    }

    /// Assesses `tip` by `criterion`.
    #[inline]
    pub(crate) fn assess_tip(&self, tip: &Frame, criterion: &Criterion) -> Assessment {
        match &criterion.region {
            Some(region) => self.assess_tip_within(region, tip, criterion),
            None => self.assess_tip_anywhere(tip, criterion),
        }
    }

    /// Writes weighted residual and Jacobian at `q`, and returns the assessment by `criterion`.
    #[inline]
    pub fn linearize(&self, robot: &Robot, q: &[f64], criterion: &Criterion, out: &mut TaskBlock) -> Assessment {
        let tip = robot.tip_and_jacobian(q, &mut out.columns);
        self.linearize_tip(&tip, q.len(), criterion, out)
    }

    /// Linearizes like [`linearize`](Self::linearize), from a tip and its geometric Jacobian, given in the first `dof` columns
    /// of `out`.
    #[inline]
    pub(crate) fn linearize_tip(
        &self,
        tip: &Frame,
        dof: usize,
        criterion: &Criterion,
        out: &mut TaskBlock,
    ) -> Assessment {
        match &criterion.region {
            Some(region) => self.linearize_tip_within(region, tip, dof, criterion, out),
            None => self.linearize_tip_anywhere(tip, dof, criterion, out),
        }
    }
}

#[inline(always)]
fn position_alone(target: &[f64; 3], tip: &[f64; 3], criterion: &Criterion) -> Assessment {
    let squared = position::error(target, tip);
    criterion.assess_unweighted(SquaredError { position: Some(squared), rotation: None }, squared)
}
