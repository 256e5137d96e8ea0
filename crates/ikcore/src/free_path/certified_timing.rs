//! Certified timings of a path: they keep its margin and its constraints at every instant.

use super::line_check::{LineCheck, PathConstraints};
use crate::error::Result;
use crate::math::vector::squared_distance;
use crate::obstacle::ClearanceSweep;
use crate::plan::{Deadline, TimedMotion, configuration_at};
use crate::timing::{ConstantLimits, JointPolyline, Paced};
use crate::trajectory::Trajectory;

/// Maximum number of narrowings of blends, before the motion stops at every corner instead.
const NARROWINGS: usize = 12;

/// Smallest fraction to which blends are cut before they are certified.
const LEAST_FRACTION: f64 = 0.02;

/// A path, with blends as wide as seems clear.
pub(super) struct TimedPath {
    pub path: JointPolyline,
    /// The fraction of the shorter adjacent line that each blend takes.
    fractions: Vec<f64>,
    /// The quicker of its timings with and without stops, not certified and without regard to tips and torques: nothing along the path is quicker.
    pub motion: Trajectory,
}

/// The limits and the margin of a motion.
pub(super) struct Timing<'s, 'a> {
    pub limits: &'s ConstantLimits,
    pub sweep: &'s mut ClearanceSweep<'a>,
    /// Constraints to keep, if there are any.
    pub kept: Option<&'s mut PathConstraints<'a>>,
    /// Distance to keep (m).
    pub margin: f64,
    pub deadline: Deadline,
}

impl TimedPath {
    /// Times a path. `fractions[i]` is the fraction of the shorter adjacent line that the blend of point i takes.
    pub(super) fn new(path: JointPolyline, fractions: Vec<f64>, limits: &ConstantLimits) -> Result<Self> {
        let motion = path.fastest_of_joints(limits, &fractions)?;
        Ok(Self { path, fractions, motion })
    }
}

/// The fraction of the shorter adjacent line that the blend of inner point `i` takes. It cuts the corner: it is as wide as the line
/// between its ends is clear.
pub(super) fn clear_fraction(path: &JointPolyline, i: usize, limits: &ConstantLimits, check: &mut LineCheck) -> f64 {
    let mut fraction = 1.0;
    while fraction > LEAST_FRACTION {
        let [from, to] = path.blend_ends(limits, i, fraction);
        if check.is_clear(&from, &to) {
            break;
        }
        fraction *= 0.5;
    }
    fraction
}

impl Timing<'_, '_> {
    /// Returns the certified motion along a path: with blends, narrower where they come too near or leave a
    /// constraint, or else with a stop at each corner. `None` if a line of the path does.
    pub(super) fn certified(&mut self, timed: TimedPath) -> Result<Option<Trajectory>> {
        let TimedPath { path, mut fractions, motion } = timed;
        let Paced { motion, is_kept } = if self.limits.limit_whole() {
            path.fastest(self.limits, &fractions)?
        } else {
            Paced { motion, is_kept: true }
        };
        if let Some(kept) = self.kept.as_mut().filter(|kept| kept.is_narrow) {
            let followed = kept.followed(&motion, self.limits)?;
            return Ok(followed.filter(|motion| self.first_contact(motion).is_none()));
        }
        let fault = self.first_fault(&motion).or((!is_kept).then_some(0.0));
        let Some(mut fault) = fault else { return Ok(Some(motion)) };
        let Paced { motion: stopping, is_kept } = path.with_stops(self.limits)?;
        let mut blended = motion;
        for _ in 0..NARROWINGS {
            if path.0.len() < 3 || self.deadline.is_over() {
                break;
            }
            fractions[nearest_corner(&path, &blended, fault)?] *= 0.5;
            let Some(narrower) = path.with_blends(self.limits, &fractions).transpose()? else { break };
            blended = narrower;
            if blended.duration() >= stopping.duration() {
                break;
            }
            match self.first_fault(&blended) {
                None if !self.limits.keep_torque(&blended) => break,
                None => return Ok(Some(blended)),
                Some(at) => fault = at,
            }
        }
        Ok((is_kept && self.first_fault(&stopping).is_none()).then_some(stopping))
    }

    /// The time at which a motion comes too near to something or leaves a constraint (s), if any.
    fn first_fault(&mut self, motion: &Trajectory) -> Option<f64> {
        let (timed, whole) = (TimedMotion::new(motion), [0.0, motion.duration()]);
        let broken = self.kept.as_mut().and_then(|kept| kept.sweep.check(&timed, whole).err());
        if let Some(broken) = broken {
            return Some(broken.at);
        }
        self.first_contact(motion)
    }

    /// The time at which a motion comes too near to something (s), if any.
    fn first_contact(&mut self, motion: &Trajectory) -> Option<f64> {
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
