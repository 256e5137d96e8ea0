//! Timings of a path that keep its margin for certain.

use super::line_timing::JointPolyline;
use crate::error::Result;
use crate::math::vector::squared_distance;
use crate::obstacle::Sweep;
use crate::planning::MotionLimits;
use crate::planning::collision_checks::{TimedMotion, configuration_at};
use crate::planning::deadline::Deadline;
use crate::trajectory::Trajectory;

/// How often blends are narrowed before the motion stops at every corner instead.
const NARROWINGS: usize = 12;

/// A path, with blends as wide as seems best.
pub(super) struct TimedPath {
    pub path: JointPolyline,
    /// The quicker of its timings with and without stops, not certified.
    pub motion: Trajectory,
}

/// The limits and the margin of a motion.
pub(super) struct Timing<'s, 'a> {
    pub limits: &'s MotionLimits,
    pub sweep: &'s mut Sweep<'a>,
    /// Distance to keep (m).
    pub margin: f64,
    pub deadline: Deadline,
}

impl TimedPath {
    /// Times a path.
    pub(super) fn new(path: JointPolyline, limits: &MotionLimits) -> Result<Self> {
        let stopping = path.with_stops(limits)?;
        let blended = path.with_blends(limits, &vec![1.0; path.0.len()]).transpose()?;
        let motion = match blended {
            Some(blended) if blended.duration() < stopping.duration() => blended,
            _ => stopping,
        };
        Ok(Self { path, motion })
    }
}

impl Timing<'_, '_> {
    /// The motion along a path, certified: with blends, narrower where they come too near, or else with a stop at each corner.
    /// `None` if a line of the path comes too near.
    pub(super) fn certified(&mut self, timed: TimedPath) -> Result<Option<Trajectory>> {
        let TimedPath { path, motion } = timed;
        let Some(mut near) = self.too_near(&motion) else { return Ok(Some(motion)) };
        let stopping = path.with_stops(self.limits)?;
        let (mut blended, mut shares) = (motion, vec![1.0; path.0.len()]);
        for _ in 0..NARROWINGS {
            if path.0.len() < 3 || self.deadline.is_over() {
                break;
            }
            shares[nearest_corner(&path, &blended, near)?] *= 0.5;
            let Some(narrower) = path.with_blends(self.limits, &shares).transpose()? else { break };
            blended = narrower;
            if blended.duration() >= stopping.duration() {
                break;
            }
            match self.too_near(&blended) {
                None => return Ok(Some(blended)),
                Some(at) => near = at,
            }
        }
        Ok(self.too_near(&stopping).is_none().then_some(stopping))
    }

    /// When a motion comes too near to something (s), if it does.
    fn too_near(&mut self, motion: &Trajectory) -> Option<f64> {
        let checked = self.sweep.check(&TimedMotion::new(motion), [0.0, motion.duration()], self.margin);
        checked.err().map(|near| near.at)
    }
}

/// The inner point of the path that the motion is nearest to at time `t` (s).
fn nearest_corner(path: &JointPolyline, motion: &Trajectory, t: f64) -> Result<usize> {
    let q = configuration_at(motion, t)?;
    let distance = |i: usize| squared_distance(&path.0[i], &q);
    let nearest = (1..path.0.len() - 1).min_by(|i, k| distance(*i).total_cmp(&distance(*k)));
    Ok(nearest.unwrap_or(0))
}
