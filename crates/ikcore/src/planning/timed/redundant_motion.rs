//! Configurations of an arm along a path, and free offsets along its self-motion.
//!
//! A nominal motion follows the path with the least joint motion from point to point. At a few nodes along it, offsets
//! in the null space of the task Jacobian are free; natural splines interpolate them. The nominal configurations plus
//! offsets are then projected back onto the points by damped least squares. Where the tip has leeway, the nominal motion uses it,
//! and offsets leave the tip where that motion has it.

use nalgebra::DMatrix;

use super::elastic_band::ElasticBand;
use super::interpolation::JointWaypoints;
use super::null_space::{null_space, turned};
use super::path_walk::PathWalk;
use super::projection::project;
use crate::error::Result;
use crate::interrupt::checkpoint;
use crate::math::MAX_DOF;
use crate::math::cubic_spline::CubicSpline;
use crate::objective::{Bounds, Linearization};
use crate::planning::tip_path::{Borders, PathTarget, TipPath};
use crate::rng;
use crate::robot::Robot;

/// Nodes of the offsets along the path: as many as the published planner has knots.
pub(super) const NODES: usize = 5;

/// Intervals between the points of the nominal motion, apart from corners: half of the published planner's.
const INTERVALS: usize = 25;

/// Starts tried for the nominal motion.
const STARTS: usize = 16;

/// A step from one of these points to the next that fails is halved this often, at the most.
const HALVINGS: usize = 10;

/// The arm on its path.
pub(in crate::planning) struct RedundantMotion<'a> {
    robot: &'a Robot,
    tip_path: &'a TipPath,
    bounds: Bounds,
    /// Targets of the tip at the nominal motion's knots.
    targets: Vec<PathTarget>,
    nominal: JointWaypoints,
    /// The same targets, with the tip where in their leeway the nominal motion has it.
    held: Vec<PathTarget>,
    /// Directions of the self-motion at each node, one per column.
    bases: Vec<DMatrix<f64>>,
    /// Weight of each node's offset at each point: by point, then by node.
    weights: Vec<f64>,
    /// Whether the first configuration is given, and remains unchanged.
    starts_as_given: bool,
    linearization: Linearization,
}

impl<'a> RedundantMotion<'a> {
    /// The arm on `path`, around the shortest of the motions that follow it; `None` where each of these ends on the way.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub(super) fn new(
        robot: &'a Robot,
        tip_path: &'a TipPath,
        start: Option<&[f64]>,
        seed: u64,
    ) -> Result<Option<Self>> {
        let knots = tip_path.knots(INTERVALS);
        let mut motion = Self::unplaced(robot, tip_path, JointWaypoints { knots, rows: vec![] }, start.is_some());
        let nominal = match start {
            Some(q) => motion.begun_at(q),
            None => motion.shortest(seed)?,
        };
        let Some(nominal) = nominal else { return Ok(None) };
        motion.replace(nominal);
        motion.tighten()?;
        motion.place_nodes();
        Ok(Some(motion))
    }

    /// The arm on `path`, with this nominal motion.
    pub(in crate::planning) fn around(
        robot: &'a Robot,
        tip_path: &'a TipPath,
        nominal: JointWaypoints,
        starts_as_given: bool,
    ) -> Self {
        let mut motion = Self::unplaced(robot, tip_path, nominal, starts_as_given);
        motion.place_nodes();
        motion
    }

    fn unplaced(robot: &'a Robot, tip_path: &'a TipPath, nominal: JointWaypoints, starts_as_given: bool) -> Self {
        Self {
            robot,
            tip_path,
            bounds: Bounds::from_ranges(robot.joints().iter().map(|joint| (joint.lower, joint.upper))),
            targets: nominal.knots.iter().map(|knot| tip_path.path_target(*knot)).collect(),
            weights: node_weights(&nominal.knots),
            nominal,
            held: vec![],
            bases: vec![],
            starts_as_given,
            linearization: Linearization::default(),
        }
    }

    /// The nominal motion.
    pub(super) fn nominal(&self) -> &JointWaypoints {
        &self.nominal
    }

    /// Replaces the nominal motion by another one on the same path.
    pub(super) fn take(&mut self, nominal: JointWaypoints) {
        self.replace(nominal);
        self.place_nodes();
    }

    fn replace(&mut self, nominal: JointWaypoints) {
        self.targets = nominal.knots.iter().map(|knot| self.tip_path.path_target(*knot)).collect();
        self.weights = node_weights(&nominal.knots);
        self.nominal = nominal;
    }

    /// Shortens the nominal motion.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    fn tighten(&mut self) -> Result<()> {
        let Self { robot, bounds, targets, starts_as_given, .. } = self;
        ElasticBand { robot, bounds, targets, starts_as_given: *starts_as_given }.tighten(&mut self.nominal)
    }

    /// Finds what is free around the nominal motion.
    fn place_nodes(&mut self) {
        let rows = self.nominal.rows.chunks_exact(self.robot.dof());
        let held = |(due, q): (&PathTarget, &[f64])| due.held_at(|| self.robot.tip(q));
        self.held = self.targets.iter().zip(rows).map(held).collect();
        self.bases = self.self_motions();
    }

    /// Number of joints.
    pub(super) fn dof(&self) -> usize {
        self.robot.dof()
    }

    /// Number of points passed.
    pub(super) fn points(&self) -> usize {
        self.targets.len()
    }

    /// Number of free parameters at each node.
    pub(super) fn freedom(&self) -> usize {
        self.bases[0].ncols()
    }

    /// Whether the first configuration is given.
    pub(super) fn starts_as_given(&self) -> bool {
        self.starts_as_given
    }

    /// Writes the configurations at all points for the offsets `z` (by node; rad, m along the self-motion) into
    /// `waypoints`; returns the total distance to the points (m, rad).
    pub(super) fn place(&mut self, z: &[f64], waypoints: &mut [f64]) -> f64 {
        let n = self.dof();
        let freedom = self.freedom();
        let mut missed = 0.0;
        let mut correction = [0.0; MAX_DOF];
        for point in 0..self.points() {
            let q = &mut waypoints[point * n..(point + 1) * n];
            q.copy_from_slice(&self.nominal.rows[point * n..(point + 1) * n]);
            for (node, basis) in self.bases.iter().enumerate() {
                let weight = self.weights[point * NODES + node];
                for (k, z) in z[node * freedom..(node + 1) * freedom].iter().enumerate() {
                    q.iter_mut().zip(basis.column(k).iter()).for_each(|(q, b)| *q += weight * z * b);
                }
            }
            // The projection of the previous point is a good guess for this one.
            let mut from = [0.0; MAX_DOF];
            from[..n].copy_from_slice(q);
            q.iter_mut().zip(&correction).for_each(|(q, c)| *q += c);
            self.bounds.clip(q);
            if point > 0 || !self.starts_as_given {
                missed += project(self.robot, &self.held[point], &self.bounds, q, &mut self.linearization);
            }
            for j in 0..n {
                correction[j] = q[j] - from[j];
            }
        }
        missed
    }

    /// The motion of least joint travel, over several starts: one on the path itself, or else within the leeway.
    fn shortest(&mut self, seed: u64) -> Result<Option<JointWaypoints>> {
        let mut rng = rng::stream(seed, 0);
        let starts = self.robot.random_configurations(STARTS, &mut rng)?;
        let leeway = self.tip_path.has_leeway().then_some(Leading::WithinLeeway);
        for leading in [Leading::OnPath].into_iter().chain(leeway) {
            let mut best: Option<(f64, JointWaypoints)> = None;
            for start in starts.chunks_exact(self.dof()) {
                checkpoint()?;
                let Some(nominal) = self.follow(start, leading) else { continue };
                let travel = travel(&nominal.rows, self.dof());
                if best.as_ref().is_none_or(|(least, _)| travel < *least) {
                    best = Some((travel, nominal));
                }
            }
            if let Some((_, nominal)) = best {
                return Ok(Some(nominal));
            }
        }
        Ok(None)
    }

    /// The motion from a given start: in parallel to the path if the start is within its leeway, or else near it.
    fn begun_at(&mut self, q: &[f64]) -> Option<JointWaypoints> {
        let excess = self.targets[0].excess(|| self.robot.tip(q));
        let in_parallel = excess.is_none_or(|excess| excess == [0.0; 2]);
        let parallel = if in_parallel { self.follow(q, Leading::InParallel) } else { None };
        parallel.or_else(|| self.follow(q, Leading::WithinLeeway))
    }

    /// Follows all points from `start`, each from the previous one.
    fn follow(&mut self, start: &[f64], leading: Leading) -> Option<JointWaypoints> {
        let place = match leading {
            Leading::OnPath => self.targets[0].on_path().place,
            Leading::InParallel => self.targets[0].held_at(|| self.robot.tip(start)).place,
            Leading::WithinLeeway => None,
        };
        let Self { robot, tip_path, bounds, nominal, starts_as_given, linearization, .. } = self;
        let mut walk = PathWalk { robot, tip_path, bounds, place, scratch: linearization };
        let first = if *starts_as_given { start.to_vec() } else { walk.begun_near(start)? };
        let mut walked = JointWaypoints { knots: vec![nominal.knots[0]], rows: first };
        for knot in &nominal.knots[1..] {
            walk.on_to(*knot, HALVINGS, &mut walked)?;
        }
        Some(walked)
    }

    /// Returns the null space of the task Jacobian at each node, each basis aligned with the previous one.
    fn self_motions(&mut self) -> Vec<DMatrix<f64>> {
        let n = self.dof();
        let mut bases: Vec<DMatrix<f64>> = Vec::with_capacity(NODES);
        for node in 0..NODES {
            let point = self.nominal.knots.partition_point(|knot| *knot < node as f64 / (NODES - 1) as f64);
            let point = point.min(self.points() - 1);
            let q = &self.nominal.rows[point * n..(point + 1) * n];
            self.held[point].linearize(self.robot, q, &mut Borders::default(), &mut self.linearization);
            let jacobian = DMatrix::from_fn(6, n, |row, joint| self.linearization.first.columns[joint][row]);
            let null = null_space(&jacobian);
            bases.push(match bases.first() {
                None => null,
                Some(first) => turned(&null, bases.last().unwrap_or(first), first.ncols()),
            });
        }
        bases
    }
}

/// What a nominal motion follows.
#[derive(Debug, Clone, Copy)]
enum Leading {
    /// The path itself.
    OnPath,
    /// The path, displaced as the start is.
    InParallel,
    /// The nearest pose within the leeway.
    WithinLeeway,
}

/// Total travel of all joints.
pub(super) fn travel(waypoints: &[f64], n: usize) -> f64 {
    (n..waypoints.len()).map(|i| (waypoints[i] - waypoints[i - n]).abs()).sum()
}

/// Values at every knot of the splines through a unit offset at each node.
fn node_weights(knots: &[f64]) -> Vec<f64> {
    let spline = CubicSpline::natural((0..NODES).map(|node| node as f64 / (NODES - 1) as f64).collect());
    let mut weights = vec![0.0; knots.len() * NODES];
    for node in 0..NODES {
        let (mut values, mut curvatures) = ([0.0; NODES], [0.0; NODES]);
        values[node] = 1.0;
        spline.curvatures(&values, &mut curvatures);
        for (point, knot) in knots.iter().enumerate() {
            weights[point * NODES + node] = spline.at(*knot, &values, &curvatures);
        }
    }
    weights
}
