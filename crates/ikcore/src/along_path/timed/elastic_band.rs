//! Elastic band: shortens a motion through the points of a path, within the tip's tolerance band and the arm's
//! redundancy.

use super::interpolation::JointWaypoints;
use super::projection::Projection;
use crate::along_path::tip_path::PathTarget;
use crate::error::Result;
use crate::interrupt::checkpoint;
use crate::math::MAX_DOF;
use crate::math::vector::{between, largest_difference, point_between, squared_distance};

/// Maximum number of sweeps over the points. A disturbance as long as the path has halved after some thirty.
const SWEEPS: usize = 100;

/// Over-relaxation: a configuration moves this much farther than to the middle of its neighbours.
const BEYOND: f64 = 1.5;

/// Largest motion of a joint in the last sweep (rad, m).
const SETTLED: f64 = 1e-4;

/// Smallest distance of neighbours (rad, m): the arm moves on along the path, if slowly, where it could rest.
const APART: f64 = 1e-4;

/// The band: targets of the tip, and whether its first end is fixed.
pub(super) struct ElasticBand<'b, 'a> {
    pub projection: &'b mut Projection<'a>,
    /// Targets of the tip, one for each configuration.
    pub targets: &'b [PathTarget],
    /// Whether the first configuration stays where it is.
    pub starts_as_given: bool,
}

impl ElasticBand<'_, '_> {
    /// Shortens `motion`, the configurations of which meet the targets, and still do afterwards: each in turn is pulled towards its
    /// neighbours, and moved back onto its target.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted).
    pub fn tighten(&mut self, motion: &mut JointWaypoints) -> Result<()> {
        let n = self.projection.robot.dof();
        let first = usize::from(self.starts_as_given);
        for _ in 0..SWEEPS {
            checkpoint()?;
            let mut moved: f64 = 0.0;
            for point in first..self.targets.len() {
                let mut q = [0.0; MAX_DOF];
                let q = &mut q[..n];
                self.pull(motion, point, q);
                let met = self.projection.project(&self.targets[point], q) == 0.0;
                let here = motion.row(point);
                let is_apart = |other: usize| other == point || largest_difference(q, motion.row(other)) > APART;
                let apart = neighbours(motion, point).into_iter().all(is_apart);
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
        let (fraction, beyond) = if point == before {
            (1.0, 1.0)
        } else if point == after {
            (0.0, 1.0)
        } else {
            ((knots[point] - knots[before]) / (knots[after] - knots[before]), BEYOND)
        };
        let middle = point_between(motion.row(before), motion.row(after), fraction);
        for ((q, here), middle) in q.iter_mut().zip(motion.row(point)).zip(middle) {
            *q = between(*here, middle, beyond);
        }
        self.projection.bounds.clip(q);
    }

    /// The squared lengths of the band to both sides of `q` at `point`, each by the length of the path there.
    fn tension(&self, motion: &JointWaypoints, point: usize, q: &[f64]) -> f64 {
        let to = |other: usize| {
            let length = (motion.knots[other] - motion.knots[point]).abs();
            if other == point { 0.0 } else { squared_distance(q, motion.row(other)) / length }
        };
        neighbours(motion, point).into_iter().map(to).sum()
    }
}

/// Returns the points before and after; at an end of the motion the end itself.
fn neighbours(motion: &JointWaypoints, point: usize) -> [usize; 2] {
    [point.saturating_sub(1), (point + 1).min(motion.knots.len() - 1)]
}
