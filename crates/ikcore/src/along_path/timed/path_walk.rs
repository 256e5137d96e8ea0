//! Configurations along a path, each the nearest to the one before.

use super::interpolation::JointWaypoints;
use super::projection::{Projection, strays};
use crate::along_path::tip_path::{Displacement, PathTarget, TipPath};
use crate::math::vector::{largest_difference, point_between};

/// Largest motion of a joint (rad, m) from one configuration to the next; more is a jump to another branch.
const JUMP: f64 = 1.5;

/// Maximum number of halvings of a step from point to point.
const HALVINGS: usize = 10;

/// A walk along a path.
pub(super) struct PathWalk<'w, 'a> {
    pub tip_path: &'w TipPath,
    pub aim: WalkAim,
    pub projection: &'w mut Projection<'a>,
    /// Whether the joints go on as before where another branch lies ahead of them: through a singularity, not back from it.
    pub straight_on: bool,
    /// Set where another configuration lies ahead than the nearest one.
    pub forks: &'w mut bool,
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
    /// Walks along the whole path by these knots, both ways from near the configuration `start` at the path parameter
    /// `from`; `None` where that is not on the path, or the path leads no farther.
    pub fn along(&mut self, knots: &[f64], from: f64, start: &[f64]) -> Option<JointWaypoints> {
        let mut first = start.to_vec();
        if !self.is_met(from, &mut first) {
            return None;
        }
        self.on_from(knots, from, first)
    }

    /// Walks both ways from a configuration on the path.
    pub fn on_from(&mut self, knots: &[f64], from: f64, first: Vec<f64>) -> Option<JointWaypoints> {
        let n = first.len();
        let mut back = JointWaypoints { knots: vec![from], rows: first };
        knots.iter().rev().filter(|knot| **knot < from).try_for_each(|knot| self.on_to(*knot, HALVINGS, &mut back))?;
        let mut walked = JointWaypoints {
            knots: back.knots.iter().rev().copied().collect(),
            rows: back.rows.chunks_exact(n).rev().flatten().copied().collect(),
        };
        knots.iter().filter(|knot| **knot > from).try_for_each(|knot| self.on_to(*knot, HALVINGS, &mut walked))?;
        Some(walked)
    }

    /// Walks on to a path parameter; `None` where the path leads no farther. A step that jumps or misses the path is
    /// halved, `halvings` times at the most: near a singularity joints turn far on a short part of the path.
    #[must_use]
    fn on_to(&mut self, fraction: f64, halvings: usize, walked: &mut JointWaypoints) -> Option<()> {
        let from = *walked.knots.last()?;
        let last = walked.row(walked.knots.len() - 1);
        let mut q = last.to_vec();
        let is_met = self.is_met(fraction, &mut q) && largest_difference(&q, last) <= JUMP;
        if let Some(ahead) = self.ahead(fraction, walked, is_met.then_some(&q)) {
            *self.forks = true;
            if self.straight_on {
                walked.push(fraction, &ahead);
                return Some(());
            }
        }
        if is_met {
            walked.push(fraction, &q);
            return Some(());
        }
        let fewer = halvings.checked_sub(1)?;
        self.on_to(0.5 * (from + fraction), fewer, walked)?;
        self.on_to(fraction, fewer, walked)
    }

    /// The configuration on the path that the joints get to if they go on as in the last step, if there is one nearby
    /// and the `nearest` one is not: that one turns back, or aside.
    fn ahead(&mut self, fraction: f64, walked: &JointWaypoints, nearest: Option<&Vec<f64>>) -> Option<Vec<f64>> {
        let last = walked.knots.len() - 1;
        let before = last.checked_sub(1)?;
        let ratio = (fraction - walked.knots[before]) / (walked.knots[last] - walked.knots[before]);
        let onward: Vec<f64> = point_between(walked.row(before), walked.row(last), ratio).collect();
        let apart = largest_difference(&onward, walked.row(last));
        if apart > JUMP || nearest.is_some_and(|nearest| !strays(nearest, &onward, apart)) {
            return None;
        }
        let mut q = onward.clone();
        self.projection.bounds.clip(&mut q);
        (self.is_met(fraction, &mut q) && !strays(&q, &onward, apart)).then_some(q)
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
