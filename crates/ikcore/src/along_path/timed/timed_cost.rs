//! Cost of the postures along a path.

use std::f64::consts::FRAC_PI_2;

use super::interpolation::{Interpolation, JointWaypoints};
use super::null_space_offsets::{NODES, NullSpaceOffsets, travel};
use super::path_problem::PathProblem;
use crate::along_path::deviation::deviation_on;
use crate::error::Result;
use crate::objective::{Bounds, Objective, Score};
use crate::obstacle::ClearSpace;
use crate::plan::Cost;
use crate::timing::{JointPath, coarse_duration};

/// The duration, or the joint travel, of the motion along a path, as a function of the offsets along the self-motion at
/// its nodes.
pub(crate) struct TimedCost<'a> {
    /// The path, and the limits and accuracy of the motion.
    pub problem: &'a PathProblem<'a>,
    /// The configurations to choose from.
    pub motion: NullSpaceOffsets<'a>,
    /// The splines through the chosen configurations.
    pub interpolation: Interpolation<'a>,
    /// Space that the motion stays in, if anything can collide.
    pub space: Option<&'a ClearSpace<'a>>,
    /// A large value of the cost, which scales penalties.
    scale: f64,
}

/// Largest offset to either side (rad, m).
const REACH: f64 = FRAC_PI_2;

/// Segments of the timing per piece of the spline during the search: enough to rank postures.
const SEGMENTS_A_PIECE: usize = 2;

/// The search keeps joints this fraction of their range away from their limits: knots added to the spline afterwards
/// may move it by as much.
const MARGIN: f64 = 5e-4;

/// The search keeps this much more than the margin at the knots (m): between them the motion may come nearer.
const KEPT_IN_SEARCH: f64 = 1e-3;

/// Cost of a violation as large as its limit, as a multiple of the scale.
const BROKEN: f64 = 10.0;

impl<'a> TimedCost<'a> {
    pub(crate) fn new(
        problem: &'a PathProblem<'a>,
        motion: NullSpaceOffsets<'a>,
        interpolation: Interpolation<'a>,
    ) -> Self {
        let scale = problem.options.objective.scale(&problem.robot, &problem.limits);
        Self { problem, motion, interpolation, space: None, scale }
    }

    /// Returns the range of the offsets; `None` if the arm is not redundant.
    pub(super) fn bounds(&self) -> Option<Bounds> {
        let freedom = self.motion.freedom();
        let free = if self.motion.starts_as_given() { freedom } else { 0 };
        let reach = |i: usize| if i < free { (0.0, 0.0) } else { (-REACH, REACH) };
        (freedom > 0).then(|| Bounds::from_ranges((0..NODES * freedom).map(reach)))
    }

    /// Returns the joint positions for these offsets, at the knots of the nominal motion, and their total distance to
    /// the path (m, rad).
    pub(crate) fn waypoints(&mut self, z: &[f64]) -> (JointWaypoints, f64) {
        let knots = self.motion.nominal().knots.clone();
        let mut waypoints = JointWaypoints { rows: vec![0.0; knots.len() * self.motion.dof()], knots };
        let missed = self.motion.write(z, &mut waypoints.rows);
        (waypoints, missed)
    }

    fn value(&mut self, z: &[f64]) -> Result<f64> {
        let (waypoints, missed) = self.waypoints(z);
        if missed > 0.0 {
            // Larger than the cost of any motion that reaches all points.
            return Ok(BROKEN * BROKEN * self.scale * (1.0 + missed));
        }
        let path = self.interpolation.path(&waypoints)?;
        let cost = match self.problem.options.objective {
            Cost::JointTravel => travel(&waypoints.rows, self.motion.dof()),
            _ => coarse_duration(&path, &self.problem.limits, SEGMENTS_A_PIECE * path.pieces())?,
        };
        let broken = self.deviation(&waypoints, &path) + self.outside(&path) + self.blocked(&waypoints);
        Ok(cost + BROKEN * self.scale * broken)
    }

    /// Returns the fraction of waypoints that are not clear.
    fn blocked(&self, waypoints: &JointWaypoints) -> f64 {
        let Some(space) = self.space else { return 0.0 };
        let rows = waypoints.rows.chunks_exact(self.motion.dof());
        rows.filter(|q| !space.keeps(q, KEPT_IN_SEARCH)).count() as f64 / waypoints.knots.len() as f64
    }

    /// Returns by how much joints are nearer to their limits than the margin, summed (rad, m).
    fn outside(&self, path: &JointPath) -> f64 {
        let excess = |j: usize| {
            let (lower, upper) = self.problem.limits.finite_range(j);
            let margin = MARGIN * (upper - lower);
            path.excess(j, self.problem.limits.lower[j] + margin, self.problem.limits.upper[j] - margin)
        };
        (0..self.motion.dof()).map(excess).sum()
    }

    /// Returns by how much the tip exceeds the accuracy in the middle between knots, relative to the accuracy and
    /// summed.
    fn deviation(&self, waypoints: &JointWaypoints, path: &JointPath) -> f64 {
        let Interpolation { robot, tip_path, .. } = self.interpolation;
        let tip = deviation_on(robot, tip_path, path);
        let off = |ends: &[f64]| (tip.bound(0.5 * (ends[0] + ends[1])) / self.problem.accuracy - 1.0).max(0.0);
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
