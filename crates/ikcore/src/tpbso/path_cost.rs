//! Along a path in uniform time: the decision vector and cost of Wang et al. (2019), eq. (7) and (19)-(25).

use super::penalties::{BROKEN_LIMIT, NO_CONFIGURATION};
use super::redundancy::{NODES, Redundancy, nearest_turn};
use crate::along_path::{LargestDeviation, TipDeviation, TipPath};
use crate::error::Result;
use crate::math::cubic_spline::{CubicSpline, Piece};
use crate::objective::{Bounds, Objective, Score};
use crate::plan::{Cost, Orientations};
use crate::robot::Robot;
use crate::timing::MotionLimits;
use crate::trajectory::{Trajectory, polynomial};

/// The spline passes every second point; the others measure its accuracy.
const STRIDE: usize = 2;

/// Shortest duration, relative to the time of the slowest joint through its range.
const SHORTEST: f64 = 0.025;

/// Longest duration, relative to the same time ...
const LONGEST: f64 = 5.0;

/// ... or, if longer (e.g. on a path that takes joints through their range more than once), relative to the duration
/// with all free orientations in the middle of their ranges.
const LONGEST_OVER_MIDDLE: f64 = 1.5;

/// The cost F of eq. (25), as a function of \[x_phi (5 per free link), T\].
#[derive(Debug, Clone)]
pub(super) struct PathCost<'a> {
    robot: &'a Robot,
    limits: &'a MotionLimits,
    redundancy: Redundancy,
    spline: CubicSpline,
    cost: Cost,
    accuracy: f64,
    scale: f64,
    start: Option<&'a [f64]>,
    motion: Motion,
    /// Second derivatives of the splines through x_phi.
    node_curvatures: Vec<f64>,
}

/// Splines of all joints over the path from 0 to 1: by joint, then by knot.
#[derive(Debug, Clone)]
struct Motion {
    values: Vec<f64>,
    curvatures: Vec<f64>,
}

impl<'a> PathCost<'a> {
    /// The cost of motions of `robot`, a planar arm, along the path of `redundancy`, with the tip within `accuracy` (m)
    /// of the points that the splines skip.
    pub(super) fn new(
        robot: &'a Robot,
        limits: &'a MotionLimits,
        redundancy: Redundancy,
        cost: Cost,
        accuracy: f64,
        start: Option<&'a [f64]>,
    ) -> Self {
        let last = redundancy.points() - 1;
        let passed = (0..last).step_by(STRIDE).chain([last]);
        let spline = CubicSpline::natural(passed.map(|i| i as f64 / last as f64).collect());
        let size = robot.dof() * spline.knots().len();
        Self {
            scale: cost.scale(robot, limits),
            motion: Motion { values: vec![0.0; size], curvatures: vec![0.0; size] },
            node_curvatures: vec![0.0; NODES * redundancy.links()],
            robot,
            limits,
            redundancy,
            spline,
            cost,
            accuracy,
            start,
        }
    }

    /// The range of the decision vector. A given start fixes the first node of every free link.
    ///
    /// # Errors
    /// [`Error::InvalidPath`](crate::Error::InvalidPath) for a start that is not on the path.
    pub(super) fn bounds(&mut self) -> Result<Bounds> {
        let whole_range = self.limits.whole_range_time();
        let mut ranges = vec![(0.0, 1.0); NODES * self.redundancy.links()];
        if let Some(q) = self.start {
            for (nodes, fraction) in ranges.chunks_exact_mut(NODES).zip(self.redundancy.fractions_of(q)?) {
                nodes[0] = (fraction, fraction);
            }
        }
        let middle: Vec<f64> = ranges.iter().map(|(lowest, highest)| 0.5 * (lowest + highest)).collect();
        let longest = (LONGEST * whole_range).max(LONGEST_OVER_MIDDLE * self.least_duration(&middle));
        ranges.push((SHORTEST * whole_range, longest));
        Ok(Bounds::from_ranges(ranges.into_iter()))
    }

    /// The shortest duration (s) with these free orientations; 0 if a point has no configuration.
    fn least_duration(&mut self, nodes: &[f64]) -> f64 {
        if self.place_knots(nodes).is_err() {
            return 0.0;
        }
        let of_joint = |j: usize| {
            let (_, speed, acceleration, _) = self.joint_extremes(j);
            (speed / self.limits.velocity[j]).max((acceleration / self.limits.acceleration[j]).sqrt())
        };
        (0..self.robot.dof()).map(of_joint).fold(0.0, f64::max)
    }

    /// The motion of decision vector `x`; `None` if a point has no configuration.
    pub(super) fn trajectory(&mut self, x: &[f64]) -> Option<Result<Trajectory>> {
        let (nodes, duration) = (&x[..x.len() - 1], x[x.len() - 1]);
        self.place_knots(nodes).ok()?;
        let knots: Vec<f64> = self.spline.knots().iter().map(|u| u * duration).collect();
        let mut coefficients = vec![];
        for i in 0..knots.len() - 1 {
            coefficients.extend((0..self.robot.dof()).map(|j| {
                let Piece { value, slope, curvature, third, .. } = self.piece(j, i);
                let [t, t2, t3] = [duration, duration.powi(2), duration.powi(3)];
                polynomial([value, slope / t, curvature / (2.0 * t2), third / (6.0 * t3)])
            }));
        }
        Some(Trajectory::from_phases(self.limits.joint_names(), knots, coefficients))
    }

    /// The free orientations of decision vector `x` at every point of the path; points without a configuration are left
    /// out.
    pub(super) fn orientations(&mut self, x: &[f64]) -> Vec<Orientations> {
        let nodes = &x[..x.len() - 1];
        self.redundancy.curvatures(nodes, &mut self.node_curvatures);
        let mut q = vec![0.0; self.robot.dof()];
        let points = 0..self.redundancy.points();
        points.filter_map(|i| self.redundancy.configuration(i, nodes, &self.node_curvatures, &mut q).ok()).collect()
    }

    /// The largest deviations of the tip from `tip_path` in the motion of the last [`trajectory`](Self::trajectory), at its points and
    /// between them.
    pub(super) fn deviation(&self, tip_path: &TipPath) -> LargestDeviation {
        // Points at equal times are not necessarily at equal distances.
        let fractions = tip_path.point_fractions();
        let last = fractions.len() - 1;
        let configurations = |fraction: f64, q: &mut [f64]| {
            let i = fractions.partition_point(|start| *start <= fraction).clamp(1, last) - 1;
            let part = (fraction - fractions[i]) / (fractions[i + 1] - fractions[i]);
            self.place((i as f64 + part) / last as f64, q);
        };
        let knots: Vec<f64> = (0..last).step_by(STRIDE).chain([last]).map(|i| fractions[i]).collect();
        TipDeviation { robot: self.robot, tip_path, configurations }.largest(&knots)
    }

    /// Distances (m) of the tip from the points that the splines skip: one per stride.
    fn distances(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let last = self.redundancy.points() - 1;
        (0..=last).filter(move |i| i % STRIDE != 0 && *i != last).map(move |i| (i, self.distance(i)))
    }

    /// Computes the configuration at every knot, shifts each joint by whole turns to be nearest to the previous knot,
    /// and fits splines.
    ///
    /// # Errors
    /// Total excess of the cosines of eq. (1) over 1.
    fn place_knots(&mut self, nodes: &[f64]) -> Result<(), f64> {
        let (n, knots, last) = (self.robot.dof(), self.spline.knots().len(), self.redundancy.points() - 1);
        self.redundancy.curvatures(nodes, &mut self.node_curvatures);
        let mut q = [0.0; crate::math::MAX_DOF];
        let mut excess = 0.0;
        for knot in 0..knots {
            let point = (knot * STRIDE).min(last);
            match self.redundancy.configuration(point, nodes, &self.node_curvatures, &mut q[..n]) {
                Err(cosine) => excess += cosine.abs(),
                Ok(_) => {
                    for j in 0..n {
                        let place = j * knots + knot;
                        let before = if knot == 0 {
                            self.start.map_or(q[j], |start| start[j])
                        } else {
                            self.motion.values[place - 1]
                        };
                        self.motion.values[place] = nearest_turn(q[j], before);
                    }
                }
            }
        }
        if excess > 0.0 {
            return Err(excess);
        }
        for (values, curvatures) in
            self.motion.values.chunks_exact(knots).zip(self.motion.curvatures.chunks_exact_mut(knots))
        {
            self.spline.curvatures(values, curvatures);
        }
        Ok(())
    }

    fn piece(&self, joint: usize, i: usize) -> Piece {
        let knots = self.spline.knots().len();
        let of_joint = joint * knots..(joint + 1) * knots;
        self.spline.piece(i, &self.motion.values[of_joint.clone()], &self.motion.curvatures[of_joint])
    }

    /// F of eq. (25), with weights that the printed equation lacks; without them, error could be traded for time.
    fn value(&mut self, x: &[f64]) -> f64 {
        let (nodes, duration) = (&x[..x.len() - 1], x[x.len() - 1]);
        if let Err(excess) = self.place_knots(nodes) {
            return NO_CONFIGURATION * self.scale * excess;
        }
        let (mut travel, mut broken) = (0.0, 0.0);
        for j in 0..self.robot.dof() {
            let (way, speed, acceleration, outside) = self.joint_extremes(j);
            travel += way;
            let fraction = |value: f64, limit: f64| if value > limit { value / limit } else { 0.0 };
            broken += fraction(speed / duration, self.limits.velocity[j])
                + fraction(acceleration / (duration * duration), self.limits.acceleration[j])
                + if outside > 0.0 { 1.0 + outside } else { 0.0 };
        }
        let missed: f64 = self.distances().map(|(_, d)| d / self.accuracy).filter(|fraction| *fraction > 1.0).sum();
        let cost = if self.cost == Cost::Time { duration } else { travel };
        cost + BROKEN_LIMIT * self.scale * (broken + missed)
    }

    /// Travel (if it is the objective), largest speed and acceleration over the path from 0 to 1, and the excess over
    /// the position limits.
    fn joint_extremes(&self, j: usize) -> (f64, f64, f64, f64) {
        let (mut travel, mut speed, mut acceleration, mut outside) = (0.0, 0.0_f64, 0.0_f64, f64::NEG_INFINITY);
        let [lower, upper] = [self.limits.lower[j], self.limits.upper[j]];
        let turns_freely = lower.is_infinite() && upper.is_infinite();
        for i in 0..self.spline.knots().len() - 1 {
            let piece = self.piece(j, i);
            if !(turns_freely && self.cost == Cost::Time) {
                let mut from = piece.value;
                for s in piece.turning_points().into_iter().chain([piece.span]) {
                    let to = piece.at(s);
                    travel += (to - from).abs();
                    outside = outside.max(lower - to).max(to - upper);
                    from = to;
                }
            }
            speed = speed.max(piece.steepest());
            acceleration = acceleration.max(piece.curvature.abs());
        }
        (travel, speed, acceleration, outside)
    }

    /// Writes the joint positions at the fraction `u` of the duration.
    fn place(&self, u: f64, q: &mut [f64]) {
        let knots = self.spline.knots().len();
        let joints = self.motion.values.chunks_exact(knots).zip(self.motion.curvatures.chunks_exact(knots));
        for (q, (values, curvatures)) in q.iter_mut().zip(joints) {
            *q = self.spline.at(u, values, curvatures);
        }
    }

    /// Distance of the tip from point `i` of the path at its time: eq. (24).
    fn distance(&self, i: usize) -> f64 {
        let u = i as f64 / (self.redundancy.points() - 1) as f64;
        let knot = i / STRIDE;
        let since = u - self.spline.knots()[knot];
        let mut q = [0.0; crate::math::MAX_DOF];
        let q = &mut q[..self.robot.dof()];
        q.iter_mut().enumerate().for_each(|(j, q)| *q = self.piece(j, knot).at(since));
        let tip = self.robot.tip_position(q);
        let [x, y] = self.redundancy.target(i).position;
        (tip[0] - x).hypot(tip[1] - y)
    }
}

impl Objective for PathCost<'_> {
    fn dimension(&self) -> usize {
        NODES * self.redundancy.links() + 1
    }

    /// Never solved: no cost is small enough to stop at.
    fn evaluate(&mut self, x: &[f64]) -> Score {
        Score { value: self.value(x), solved: false }
    }
}
