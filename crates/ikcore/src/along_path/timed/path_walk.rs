//! Configurations along a path, each the nearest to the one before.

use super::interpolation::JointWaypoints;
use super::projection::project;
use crate::along_path::tip_path::{Displacement, PathTarget, TipPath};
use crate::math::vector::largest_difference;
use crate::objective::{Bounds, Linearization};
use crate::robot::Robot;

/// Largest motion of a joint (rad, m) from one configuration to the next; more is a jump to another branch.
const JUMP: f64 = 1.5;

/// A walk along a path.
pub(super) struct PathWalk<'w> {
    pub robot: &'w Robot,
    pub tip_path: &'w TipPath,
    pub bounds: &'w Bounds,
    pub aim: WalkAim,
    pub scratch: &'w mut Linearization,
}

/// What a walk meets at each point of its path.
#[derive(Debug, Clone, Copy)]
pub(super) enum WalkAim {
    /// The target, with the tip at this place in its tolerance_band; `None`: anywhere.
    Place(Option<Displacement>),
    /// The whole pose, whatever the task leaves free.
    WholePose,
}

impl PathWalk<'_> {
    /// The configuration near `start` that has the tip at the beginning of the path, if one is found.
    pub fn begun_near(&mut self, start: &[f64]) -> Option<Vec<f64>> {
        let mut q = start.to_vec();
        self.is_met(0.0, &mut q).then_some(q)
    }

    /// Goes on to a path parameter; `None` where the path leads no farther. A step that jumps or misses the path is halved, `halvings`
    /// times at the most: near a singularity joints turn far on a short part of the path.
    #[must_use]
    pub fn on_to(&mut self, fraction: f64, halvings: usize, walked: &mut JointWaypoints) -> Option<()> {
        let last = walked.rows.len() - self.robot.dof();
        let mut q = walked.rows[last..].to_vec();
        if self.is_met(fraction, &mut q) && largest_difference(&q, &walked.rows[last..]) <= JUMP {
            walked.knots.push(fraction);
            walked.rows.extend_from_slice(&q);
            return Some(());
        }
        let from = *walked.knots.last()?;
        let fewer = halvings.checked_sub(1)?;
        self.on_to(0.5 * (from + fraction), fewer, walked)?;
        self.on_to(fraction, fewer, walked)
    }

    fn is_met(&mut self, fraction: f64, q: &mut [f64]) -> bool {
        let target = match self.aim {
            WalkAim::Place(place) => PathTarget { place, ..self.tip_path.path_target(fraction) },
            WalkAim::WholePose => {
                PathTarget { target: self.tip_path.pose(fraction), tolerance_band: None, place: None }
            }
        };
        project(self.robot, &target, self.bounds, q, self.scratch) == 0.0
    }
}
