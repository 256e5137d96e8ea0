//! Target of the tip at a point of its path.

use super::tolerance_band::{Borders, Displacement, ToleranceBand};
use crate::math::Frame;
use crate::math::box_step::ROWS;
use crate::math::so3::{norm, rotation_between};
use crate::math::vector::distance;
use crate::objective::Linearization;
use crate::robot::Robot;
use crate::task::{Target, Tolerance};

/// The target at a point of a path, and how far the tip may be off.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PathTarget {
    pub target: Target,
    /// `None`: not at all.
    pub tolerance_band: Option<ToleranceBand>,
    /// Displacement of the tip within its tolerance band; `None`: any.
    pub displacement: Option<Displacement>,
}

impl PathTarget {
    /// Writes residual and Jacobian at `q` of the excess over the tolerance band; returns the sum of squares.
    pub fn linearize(&self, robot: &Robot, q: &[f64], borders: &mut Borders, out: &mut Linearization) -> f64 {
        let tip = robot.tip_and_jacobian(q, &mut out.first.columns);
        self.linearize_tip(&tip, q.len(), borders, out)
    }

    /// Linearizes like [`linearize`](Self::linearize), from a tip and its geometric Jacobian of `dof` columns, which are in `out`.
    pub fn linearize_tip(&self, tip: &Frame, dof: usize, borders: &mut Borders, out: &mut Linearization) -> f64 {
        let criterion = self.tolerance_band.map_or_else(|| Tolerance::default().into(), |_| ToleranceBand::criterion());
        let value = self.target.linearize_tip(tip, dof, &criterion, &mut out.first).score.value;
        match (&self.tolerance_band, &self.displacement) {
            (None, _) => value,
            (Some(tolerance_band), None) => tolerance_band.reduce(&self.target, borders, dof, &mut out.first),
            (Some(tolerance_band), Some(displacement)) => {
                tolerance_band.hold(&self.target, displacement, dof, &mut out.first)
            }
        }
    }

    /// The same target with the tip off by no more than `most` (m, rad) where it is not free.
    pub fn at_most(&self, most: f64) -> Self {
        Self { tolerance_band: self.tolerance_band.map(|tolerance_band| tolerance_band.at_most(most)), ..*self }
    }

    /// The same target with the tip on the path itself; free components stay free.
    pub fn on_path(&self) -> Self {
        Self { displacement: Some([0.0; ROWS]), ..*self }
    }

    /// The same target with the tip where `tip` is; free components stay free.
    pub fn held_at(&self, tip: impl FnOnce() -> Frame) -> Self {
        Self {
            displacement: self.tolerance_band.map(|_| ToleranceBand::displacement_of(&self.target, &tip())),
            ..*self
        }
    }

    /// The distance (m) and the angle (rad) of a tip from the target, or from the nearest pose within the tolerance band.
    pub fn off(&self, tip: &Frame) -> [f64; 2] {
        self.excess(|| *tip).unwrap_or_else(|| {
            let position = self.target.position();
            let apart = position.map_or(0.0, |position| distance(&tip.origin, &position));
            [apart, angle_between(&self.target, || *tip)]
        })
    }

    /// The distance (m) and the angle (rad) of a tip from the nearest pose within the tolerance band; `None` without one.
    pub fn excess(&self, tip: impl FnOnce() -> Frame) -> Option<[f64; 2]> {
        self.tolerance_band.map(|tolerance_band| tolerance_band.excess(&self.target, &tip()))
    }
}

/// Angle (rad) of the tip from a target's orientation, or from the direction of its axis; 0 for a position.
pub(crate) fn angle_between(target: &Target, tip: impl FnOnce() -> Frame) -> f64 {
    match target {
        Target::Pose(due) => norm(&rotation_between(due, &tip())),
        Target::Pointing { .. } => {
            target.assess_tip(&tip(), &Tolerance::default().into()).error.rotation.map_or(0.0, f64::sqrt)
        }
        Target::Position(_) | Target::Orientation(_) => 0.0,
    }
}
