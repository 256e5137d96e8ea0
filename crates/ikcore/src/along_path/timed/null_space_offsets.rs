//! Configurations of an arm along a path, and free offsets along its self-motion.
//!
//! A nominal motion follows the path. At a few nodes along it, offsets in the null space of the task Jacobian are free;
//! natural splines interpolate them. The nominal configurations plus offsets are then projected back onto the points by
//! damped least squares. If the tip has a tolerance band, the nominal motion uses it, and offsets leave the tip where
//! that motion has it.

use nalgebra::DMatrix;

use super::interpolation::JointWaypoints;
use super::null_space::{null_space, turned};
use super::projection::{PathKeeps, Projection};
use crate::along_path::tip_path::{Borders, PathTarget, TipPath};
use crate::math::MAX_DOF;
use crate::math::cubic_spline::CubicSpline;
use crate::objective::Linearization;
use crate::robot::Robot;

/// Nodes of the offsets along the path: as many as the published planner has knots.
pub(super) const NODES: usize = 5;

/// Configurations along a path: a nominal motion, and offsets in the null space of the task.
pub(crate) struct NullSpaceOffsets<'a> {
    projection: Projection<'a>,
    nominal: JointWaypoints,
    /// Targets of the tip at the nominal motion's knots, each with the tip's displacement in its tolerance band.
    held: Vec<PathTarget>,
    /// Directions of the self-motion at each node, one per column.
    bases: Vec<DMatrix<f64>>,
    /// Weight of each node's offset at each point: by point, then by node.
    weights: Vec<f64>,
    /// Whether the first configuration is given, and remains unchanged.
    starts_as_given: bool,
}

impl<'a> NullSpaceOffsets<'a> {
    /// The arm on `tip_path`, with this nominal motion.
    pub(crate) fn around(
        robot: &'a Robot,
        tip_path: &'a TipPath,
        keeps: PathKeeps<'a>,
        nominal: JointWaypoints,
        starts_as_given: bool,
    ) -> Self {
        let rows = nominal.rows.chunks_exact(robot.dof());
        let held = nominal.knots.iter().zip(rows).map(|(knot, q)| tip_path.path_target(*knot).held_at(|| robot.tip(q)));
        let mut motion = Self {
            projection: Projection::new(robot, keeps),
            held: held.collect(),
            weights: node_weights(&nominal.knots),
            nominal,
            bases: vec![],
            starts_as_given,
        };
        motion.bases = motion.self_motions();
        motion
    }

    /// The nominal motion.
    pub(super) fn nominal(&self) -> &JointWaypoints {
        &self.nominal
    }

    /// Number of joints.
    pub(super) fn dof(&self) -> usize {
        self.projection.robot.dof()
    }

    /// Number of points passed.
    pub(super) fn points(&self) -> usize {
        self.held.len()
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
    pub(super) fn write(&mut self, z: &[f64], waypoints: &mut [f64]) -> f64 {
        let n = self.dof();
        let freedom = self.freedom();
        let mut missed = 0.0;
        let mut correction = [0.0; MAX_DOF];
        for point in 0..self.points() {
            let q = &mut waypoints[point * n..(point + 1) * n];
            q.copy_from_slice(self.nominal.row(point));
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
            self.projection.bounds.clip(q);
            if point > 0 || !self.starts_as_given {
                missed += self.projection.project(&self.held[point], q);
            }
            for j in 0..n {
                correction[j] = q[j] - from[j];
            }
        }
        missed
    }

    /// Returns the null space of the task Jacobian at each node, each basis aligned with the previous one.
    fn self_motions(&self) -> Vec<DMatrix<f64>> {
        let n = self.dof();
        let (mut bases, mut at): (Vec<DMatrix<f64>>, _) = (Vec::with_capacity(NODES), Linearization::default());
        for node in 0..NODES {
            let point = self.nominal.knots.partition_point(|knot| *knot < node as f64 / (NODES - 1) as f64);
            let point = point.min(self.points() - 1);
            let q = self.nominal.row(point);
            self.held[point].linearize(self.projection.robot, q, &mut Borders::default(), &mut at);
            let jacobian = DMatrix::from_fn(6, n, |row, joint| at.first.columns[joint][row]);
            let null = null_space(&jacobian);
            bases.push(match bases.first() {
                None => null,
                Some(first) => turned(&null, bases.last().unwrap_or(first), first.ncols()),
            });
        }
        bases
    }
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
