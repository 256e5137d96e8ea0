//! Cost of the postures along a path.

use std::f64::consts::FRAC_PI_2;

use super::interpolation::{Interpolation, JointWaypoints};
use super::redundant_motion::{NODES, RedundantMotion, travel};
use crate::error::Result;
use crate::objective::{Bounds, Objective, Score};
use crate::planning::deviation::TipDeviation;
use crate::planning::time_optimal::coarse_duration;
use crate::planning::{Cost, JointPath, MotionLimits, TimingLimits};

/// The duration, or the joint travel, of the motion along a path, as a function of the offsets along the self-motion at
/// its nodes.
pub(super) struct TimedCost<'a> {
    /// The configurations to choose from.
    pub motion: RedundantMotion<'a>,
    /// The splines through the chosen configurations.
    pub interpolation: Interpolation<'a>,
    /// Limits that the motion keeps.
    pub limits: &'a MotionLimits,
    /// Limits of the timing.
    pub timing_limits: &'a TimingLimits,
    /// Quantity to minimise.
    pub objective: Cost,
    /// Allowed deviation of the tip from the path (m, rad).
    pub accuracy: f64,
    /// A large value of the cost, which scales penalties.
    pub scale: f64,
}

/// Largest offset to either side (rad, m).
const REACH: f64 = FRAC_PI_2;

/// Segments of the timing per piece of the spline during the search: enough to rank postures.
const SEGMENTS_A_PIECE: usize = 2;

/// The search keeps joints this fraction of their range away from their limits: knots added to the spline afterwards
/// may move it by as much.
const MARGIN: f64 = 5e-4;

/// Cost of a violation as large as its limit, as a multiple of the scale.
const BROKEN: f64 = 10.0;

impl TimedCost<'_> {
    /// Returns the range of the offsets; `None` if the arm is not redundant.
    pub(super) fn bounds(&self) -> Option<Bounds> {
        let freedom = self.motion.freedom();
        let free = if self.motion.starts_as_given() { freedom } else { 0 };
        let reach = |i: usize| if i < free { (0.0, 0.0) } else { (-REACH, REACH) };
        (freedom > 0).then(|| Bounds::from_ranges((0..NODES * freedom).map(reach)))
    }

    /// Returns the joint positions for these offsets, at the knots of the nominal motion, and their total distance to
    /// the path (m, rad).
    pub(super) fn waypoints(&mut self, z: &[f64]) -> (JointWaypoints, f64) {
        let knots = self.motion.nominal().knots.clone();
        let mut waypoints = JointWaypoints { rows: vec![0.0; knots.len() * self.motion.dof()], knots };
        let missed = self.motion.place(z, &mut waypoints.rows);
        (waypoints, missed)
    }

    fn value(&mut self, z: &[f64]) -> Result<f64> {
        let (waypoints, missed) = self.waypoints(z);
        if missed > 0.0 {
            // Larger than the cost of any motion that reaches all points.
            return Ok(BROKEN * BROKEN * self.scale * (1.0 + missed));
        }
        let path = self.interpolation.path(&waypoints)?;
        let cost = match self.objective {
            Cost::JointTravel => travel(&waypoints.rows, self.motion.dof()),
            _ => coarse_duration(&path, self.timing_limits, SEGMENTS_A_PIECE * path.pieces())?,
        };
        Ok(cost + BROKEN * self.scale * (self.deviation(&waypoints, &path) + self.outside(&path)))
    }

    /// Returns by how much joints are nearer to their limits than the margin, summed (rad, m).
    fn outside(&self, path: &JointPath) -> f64 {
        let excess = |j: usize| {
            let (lower, upper) = self.limits.finite_range(j);
            let margin = MARGIN * (upper - lower);
            path.excess(j, self.limits.lower[j] + margin, self.limits.upper[j] - margin)
        };
        (0..self.motion.dof()).map(excess).sum()
    }

    /// Returns by how much the tip exceeds the accuracy in the middle between knots, relative to the accuracy and
    /// summed.
    fn deviation(&self, waypoints: &JointWaypoints, path: &JointPath) -> f64 {
        let Interpolation { robot, tip_path, .. } = self.interpolation;
        let tip = TipDeviation { robot, tip_path, configurations: |share: f64, q: &mut [f64]| path.position(share, q) };
        let off = |ends: &[f64]| (tip.bound(0.5 * (ends[0] + ends[1])) / self.accuracy - 1.0).max(0.0);
        waypoints.knots.windows(2).map(off).sum()
    }
}

impl Objective for TimedCost<'_> {
    fn dimension(&self) -> usize {
        NODES * self.motion.freedom()
    }

    /// Never solved: no duration is small enough to stop at.
    fn evaluate(&mut self, z: &[f64]) -> Score {
        Score { value: self.value(z).unwrap_or(f64::INFINITY), solved: false }
    }
}
