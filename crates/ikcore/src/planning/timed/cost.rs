//! The cost of the postures along a path.

use std::f64::consts::FRAC_PI_2;

use super::passage::{Interpolation, Passage};
use super::self_motion::{NODES, SelfMotion, travel};
use crate::error::Result;
use crate::objective::{Bounds, Objective, Score};
use crate::planning::stray::Stray;
use crate::planning::time_optimal::coarse_duration;
use crate::planning::{Cost, JointPath, MotionLimits, TimingLimits};

/// The duration, or the joint travel, of the motion along a course, as a function of the offsets along the self-motion at
/// its nodes.
pub struct TimedCost<'a> {
    /// What the arm may choose.
    pub motion: SelfMotion<'a>,
    /// The splines through what it chose.
    pub interpolation: Interpolation<'a>,
    /// Limits that the motion keeps.
    pub limits: &'a MotionLimits,
    /// The same for its timing.
    pub timing_limits: &'a TimingLimits,
    /// What is minimised.
    pub objective: Cost,
    /// How far the tip may be from the course (m, rad).
    pub accuracy: f64,
    /// What is a lot of the cost: the measure of penalties.
    pub scale: f64,
}

/// How far the offsets may go to either side (rad, m).
const REACH: f64 = FRAC_PI_2;

/// Segments of the timing in each piece of the spline while searching: enough to rank one posture before another.
const SEGMENTS_A_PIECE: usize = 2;

/// What a broken limit costs, in shares of the scale, for each of the limit's own size.
const BROKEN: f64 = 10.0;

impl TimedCost<'_> {
    /// What the offsets may be; None where the arm has no choice.
    pub fn bounds(&self) -> Option<Bounds> {
        let freedom = self.motion.freedom();
        let free = if self.motion.starts_as_given() { freedom } else { 0 };
        let reach = |i: usize| if i < free { (0.0, 0.0) } else { (-REACH, REACH) };
        (freedom > 0).then(|| Bounds::from_ranges((0..NODES * freedom).map(reach)))
    }

    /// The joint positions for these offsets, at the nominal motion's knots, and by how much they miss the course (m, rad).
    pub fn passage(&mut self, z: &[f64]) -> (Passage, f64) {
        let knots = self.motion.nominal().knots.clone();
        let mut passage = Passage { waypoints: vec![0.0; knots.len() * self.motion.dof()], knots };
        let missed = self.motion.place(z, &mut passage.waypoints);
        (passage, missed)
    }

    fn value(&mut self, z: &[f64]) -> Result<f64> {
        let n = self.motion.dof();
        let (passage, missed) = self.passage(z);
        if missed > 0.0 {
            // Above everything that reaches all points.
            return Ok(BROKEN * BROKEN * self.scale * (1.0 + missed));
        }
        let path = self.interpolation.path(&passage)?;
        let outside: f64 = (0..n).map(|j| path.excess(j, self.limits.lower[j], self.limits.upper[j])).sum();
        let cost = match self.objective {
            Cost::JointTravel => travel(&passage.waypoints, n),
            _ => coarse_duration(&path, self.timing_limits, SEGMENTS_A_PIECE * path.pieces())?,
        };
        Ok(cost + BROKEN * self.scale * (self.beyond(&passage, &path) + outside))
    }

    /// By how much the tip strays too far in the middle between knots, in shares of the accuracy.
    fn beyond(&self, passage: &Passage, path: &JointPath) -> f64 {
        let Interpolation { robot, course, .. } = self.interpolation;
        let stray = Stray { robot, course, configurations: |share: f64, q: &mut [f64]| path.position(share, q) };
        let off = |ends: &[f64]| (stray.at_most(0.5 * (ends[0] + ends[1])) / self.accuracy - 1.0).max(0.0);
        passage.knots.windows(2).map(off).sum()
    }
}

impl Objective for TimedCost<'_> {
    fn dimension(&self) -> usize {
        NODES * self.motion.freedom()
    }

    /// Never solved: there is no duration that a search could stop at.
    fn evaluate(&mut self, z: &[f64]) -> Score {
        Score { value: self.value(z).unwrap_or(f64::INFINITY), solved: false }
    }
}
