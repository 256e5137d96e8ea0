//! Target of the tip at a point of its path.

use super::tolerance_band::{Borders, Displacement, ToleranceBand};
use crate::math::Frame;
use crate::math::box_step::ROWS;
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
        let criterion = self.tolerance_band.map_or_else(|| Tolerance::default().into(), |_| ToleranceBand::criterion());
        let value = self.target.linearize(robot, q, &criterion, &mut out.first).score.value;
        match (&self.tolerance_band, &self.displacement) {
            (None, _) => value,
            (Some(tolerance_band), None) => tolerance_band.reduce(&self.target, borders, q.len(), &mut out.first),
            (Some(tolerance_band), Some(displacement)) => {
                tolerance_band.hold(&self.target, displacement, q.len(), &mut out.first)
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

    /// The distance (m) and the angle (rad) of a tip from the nearest pose within the tolerance band; `None` without one.
    pub fn excess(&self, tip: impl FnOnce() -> Frame) -> Option<[f64; 2]> {
        self.tolerance_band.map(|tolerance_band| tolerance_band.excess(&self.target, &tip()))
    }
}
