//! A motion through the points of a path, shortened as far as the tolerance_band of the tip and the redundancy of the arm let it.

use super::interpolation::JointWaypoints;
use super::projection::project;
use crate::along_path::tip_path::PathTarget;
use crate::error::Result;
use crate::interrupt::checkpoint;
use crate::math::MAX_DOF;
use crate::math::vector::{largest_difference, squared_distance};
use crate::objective::{Bounds, Linearization};
use crate::robot::Robot;

/// Most sweeps over the points. A disturbance as long as the path has halved after some thirty.
const SWEEPS: usize = 100;

/// Each configuration goes this much farther than to the middle of its neighbours (over-relaxation).
const BEYOND: f64 = 1.5;

/// A sweep that moves no joint by more (rad, m) is the last.
const SETTLED: f64 = 1e-4;

/// Neighbours stay this far apart (rad, m): the arm moves on along the path, if slowly, where it could rest.
const APART: f64 = 1e-4;

/// What holds the band.
pub(super) struct ElasticBand<'a> {
    pub robot: &'a Robot,
    pub bounds: &'a Bounds,
    /// Targets of the tip, one for each configuration.
    pub targets: &'a [PathTarget],
    /// Whether the first configuration stays where it is.
    pub starts_as_given: bool,
}

impl ElasticBand<'_> {
    /// Shortens `motion`, the configurations of which meet the targets, and still do afterwards: each in turn is pulled towards its
    /// neighbours, and moved back onto its target.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted).
    pub fn tighten(&self, motion: &mut JointWaypoints) -> Result<()> {
        let n = self.robot.dof();
        let mut scratch = Linearization::default();
        let first = usize::from(self.starts_as_given);
        for _ in 0..SWEEPS {
            checkpoint()?;
            let mut moved: f64 = 0.0;
            for point in first..self.targets.len() {
                let mut q = [0.0; MAX_DOF];
                let q = &mut q[..n];
                self.pull(motion, point, q);
                let met = project(self.robot, &self.targets[point], self.bounds, q, &mut scratch) == 0.0;
                let here = &motion.rows[point * n..(point + 1) * n];
                let apart = neighbours(motion, point).into_iter().all(|other| {
                    other == point || largest_difference(q, &motion.rows[other * n..(other + 1) * n]) > APART
                });
                if met && apart && self.tension(motion, point, q) < self.tension(motion, point, here) {
                    moved = moved.max(largest_difference(q, here));
                    motion.rows[point * n..(point + 1) * n].copy_from_slice(q);
                }
            }
            if moved <= SETTLED {
                break;
            }
        }
        Ok(())
    }

    /// Writes to `q` where its neighbours pull the configuration at `point`.
    fn pull(&self, motion: &JointWaypoints, point: usize, q: &mut [f64]) {
        let knots = &motion.knots;
        let [before, after] = neighbours(motion, point);
        let n = q.len();
        let row = |point: usize| &motion.rows[point * n..(point + 1) * n];
        let (fraction, beyond) = if point == before {
            (1.0, 1.0)
        } else if point == after {
            (0.0, 1.0)
        } else {
            ((knots[point] - knots[before]) / (knots[after] - knots[before]), BEYOND)
        };
        for (j, q) in q.iter_mut().enumerate() {
            let between = row(before)[j] + fraction * (row(after)[j] - row(before)[j]);
            *q = row(point)[j] + beyond * (between - row(point)[j]);
        }
        self.bounds.clip(q);
    }

    /// The squared lengths of the band to both sides of `q` at `point`, each by the length of the path there.
    fn tension(&self, motion: &JointWaypoints, point: usize, q: &[f64]) -> f64 {
        let to = |other: usize| {
            let row = &motion.rows[other * q.len()..(other + 1) * q.len()];
            let length = (motion.knots[other] - motion.knots[point]).abs();
            if other == point { 0.0 } else { squared_distance(q, row) / length }
        };
        neighbours(motion, point).into_iter().map(to).sum()
    }
}

/// The points before and after; at an end of the motion that end itself.
fn neighbours(motion: &JointWaypoints, point: usize) -> [usize; 2] {
    [point.saturating_sub(1), (point + 1).min(motion.knots.len() - 1)]
}
