//! The cost of the postures along a path.

use std::f64::consts::FRAC_PI_2;

use super::self_motion::{NODES, SelfMotion, passed, travel};
use crate::error::Result;
use crate::math::MAX_DOF;
use crate::objective::{Bounds, Objective, Score};
use crate::path::Reference;
use crate::planning::time_optimal::coarse_duration;
use crate::planning::{Cost, JointPath, MotionLimits, SplineEnds, TimingLimits};

/// The duration, or the joint travel, of the motion through the points of a path, as a function of the offsets along the
/// self-motion at its nodes.
pub struct TimedCost<'a> {
    /// What the arm may choose.
    pub motion: SelfMotion<'a>,
    /// Limits that the motion keeps.
    pub limits: &'a MotionLimits,
    /// The same for its timing.
    pub timing_limits: &'a TimingLimits,
    /// What is minimised.
    pub objective: Cost,
    /// How far the tip may be from points that the splines do not pass (m).
    pub accuracy: f64,
    /// The path.
    pub path: &'a Reference,
    /// The splines pass every so many-th point.
    pub stride: usize,
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

    /// The joint path for these offsets, and by how much it misses the points that it is to pass (m, rad).
    ///
    /// # Errors
    /// None in practice: waypoints that differ make a spline.
    pub fn joint_path(&mut self, z: &[f64]) -> Result<(JointPath, f64)> {
        let mut waypoints = vec![0.0; self.motion.points() * self.motion.dof()];
        let missed = self.motion.place(z, &mut waypoints);
        self.spline(&waypoints).map(|path| (path, missed))
    }

    fn spline(&self, waypoints: &[f64]) -> Result<JointPath> {
        let last = (self.path.len() - 1) as f64;
        let knots: Vec<f64> = passed(self.path.len(), self.stride).map(|row| row as f64 / last).collect();
        JointPath::spline(self.limits.joint_names(), waypoints, Some(&knots), SplineEnds::Natural)
    }

    /// Distances (m) of the tip from the points that the splines do not pass.
    pub fn distances(&self, path: &JointPath) -> impl Iterator<Item = (usize, f64)> {
        let last = self.path.len() - 1;
        let skipped = (0..last).filter(|row| !row.is_multiple_of(self.stride));
        skipped.map(move |row| {
            let mut q = [0.0; MAX_DOF];
            let q = &mut q[..self.motion.dof()];
            path.position(row as f64 / last as f64, q);
            let (tip, wanted) = (self.motion.tip(q), self.path.position(row));
            (row, (0..3).map(|i| (tip[i] - wanted[i]).powi(2)).sum::<f64>().sqrt())
        })
    }

    fn value(&mut self, z: &[f64]) -> Result<f64> {
        let n = self.motion.dof();
        let mut waypoints = vec![0.0; self.motion.points() * n];
        let missed = self.motion.place(z, &mut waypoints);
        if missed > 0.0 {
            // Above everything that reaches all points.
            return Ok(BROKEN * BROKEN * self.scale * (1.0 + missed));
        }
        let path = self.spline(&waypoints)?;
        let beyond: f64 = self.distances(&path).map(|(_, d)| (d / self.accuracy - 1.0).max(0.0)).sum();
        let outside: f64 = (0..n).map(|j| path.excess(j, self.limits.lower[j], self.limits.upper[j])).sum();
        let cost = match self.objective {
            Cost::JointTravel => travel(&waypoints, n),
            _ => coarse_duration(&path, self.timing_limits, SEGMENTS_A_PIECE * path.pieces())?,
        };
        Ok(cost + BROKEN * self.scale * (beyond + outside))
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
