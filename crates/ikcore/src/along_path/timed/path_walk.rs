//! Configurations along a path, each the nearest to the one before.

use super::interpolation::JointWaypoints;
use super::projection::Projection;
use crate::along_path::tip_path::{Displacement, PathTarget, TipPath};
use crate::math::vector::largest_difference;

/// Largest motion of a joint (rad, m) from one configuration to the next; more is a jump to another branch.
const JUMP: f64 = 1.5;

/// A walk along a path.
pub(super) struct PathWalk<'w, 'a> {
    pub tip_path: &'w TipPath,
    pub aim: WalkAim,
    pub projection: &'w mut Projection<'a>,
}

/// Target of a walk at each point of its path.
#[derive(Debug, Clone, Copy)]
pub(super) enum WalkAim {
    /// The target, with the tip displaced like this within its tolerance band; `None`: anywhere.
    Displaced(Option<Displacement>),
    /// The whole pose, whatever the task leaves free.
    WholePose,
}

impl PathWalk<'_, '_> {
    /// Returns a configuration near `start` with the tip at the beginning of the path, if one is found.
    pub fn begun_near(&mut self, start: &[f64]) -> Option<Vec<f64>> {
        let mut q = start.to_vec();
        self.is_met(0.0, &mut q).then_some(q)
    }

    /// Walks on to a path parameter; `None` where the path leads no farther. A step that jumps or misses the path is
    /// halved, `halvings` times at the most: near a singularity joints turn far on a short part of the path.
    #[must_use]
    pub fn on_to(&mut self, fraction: f64, halvings: usize, walked: &mut JointWaypoints) -> Option<()> {
        let from = *walked.knots.last()?;
        let last = walked.row(walked.knots.len() - 1);
        let mut q = last.to_vec();
        if self.is_met(fraction, &mut q) && largest_difference(&q, last) <= JUMP {
            walked.push(fraction, &q);
            return Some(());
        }
        let fewer = halvings.checked_sub(1)?;
        self.on_to(0.5 * (from + fraction), fewer, walked)?;
        self.on_to(fraction, fewer, walked)
    }

    fn is_met(&mut self, fraction: f64, q: &mut [f64]) -> bool {
        let target = match self.aim {
            WalkAim::Displaced(displacement) => PathTarget { displacement, ..self.tip_path.path_target(fraction) },
            WalkAim::WholePose => {
                PathTarget { target: self.tip_path.pose(fraction), tolerance_band: None, displacement: None }
            }
        };
        self.projection.project(&target, q) == 0.0
    }
}
