//! The configurations in which an arm passes the points of a path, and what may be chosen of them.
//!
//! A nominal motion follows the path with the least joint motion from point to point. At a few nodes along it, offsets in
//! the null space of the task's Jacobian are free; between nodes they follow natural splines. The nominal configurations
//! with their offsets are then brought back onto the points by damped least squares: the nearest solutions.

use nalgebra::DMatrix;

use crate::error::{Error, Result};
use crate::math::MAX_DOF;
use crate::math::box_step::box_step;
use crate::math::cubic_spline::CubicSpline;
use crate::objective::{Bounds, LeastSquares, Linearization};
use crate::path::Reference;
use crate::problem::Problem;
use crate::rng;
use crate::robot::Robot;
use crate::task::{Target, Tolerance};
use crate::wording::number;

/// Nodes of the offsets along the path: the published planner's number of knots.
pub const NODES: usize = 5;

/// Starts tried for the nominal motion.
const STARTS: usize = 16;

/// Steps of the projection at the most; it converges quadratically.
const STEPS: usize = 12;

/// A point counts as met at this squared distance (m^2, rad^2), far below what limits or accuracy can show.
const MET: f64 = 1e-16;

/// Damping over squared error, as in the library's own Levenberg-Marquardt.
const DAMPING: f64 = 0.05;

/// Joints move by this much (rad, m) at the most from one point to the next of the nominal motion; more is a jump to
/// another branch.
const JUMP: f64 = 1.5;

/// The arm on its path.
pub struct SelfMotion<'a> {
    robot: &'a Robot,
    bounds: Bounds,
    /// The points that the joint path passes.
    targets: Vec<Target>,
    /// One row of joints a point.
    nominal: Vec<f64>,
    /// Directions of the self-motion at each node: a column each.
    bases: Vec<DMatrix<f64>>,
    /// What the offset at a node contributes at a point: point by point, node by node.
    weights: Vec<f64>,
    /// Whether the first configuration is given, and stays as it is.
    starts_as_given: bool,
    linearization: Linearization,
}

impl<'a> SelfMotion<'a> {
    /// The arm on every `stride`-th point of `path` and the last.
    ///
    /// # Errors
    /// [`Error::Unreachable`] names the first point that no motion from any start reached.
    pub fn new(robot: &'a Robot, path: &Reference, stride: usize, start: Option<&[f64]>, seed: u64) -> Result<Self> {
        let targets = passed(path.len(), stride).map(|i| target(path, i)).collect::<Vec<_>>();
        let joints = robot.joints();
        let bounds = Bounds::from_ranges(joints.iter().map(|joint| (joint.lower, joint.upper)));
        let weights = node_weights(targets.len());
        let mut motion = Self {
            robot,
            bounds,
            targets,
            nominal: vec![],
            bases: vec![],
            weights,
            starts_as_given: start.is_some(),
            linearization: Linearization::default(),
        };
        motion.nominal = match start {
            Some(q) => motion.follow(q).map_err(|lost| lost.error(path, stride))?,
            None => motion.shortest(path, stride, seed)?,
        };
        motion.bases = motion.self_motions();
        Ok(motion)
    }

    /// Number of joints.
    pub fn dof(&self) -> usize {
        self.robot.dof()
    }

    /// Number of points passed.
    pub fn points(&self) -> usize {
        self.targets.len()
    }

    /// How many numbers are free at each node.
    pub fn freedom(&self) -> usize {
        self.bases[0].ncols()
    }

    /// Whether the first configuration is given.
    pub fn starts_as_given(&self) -> bool {
        self.starts_as_given
    }

    /// Where the tip is at `q` (m).
    pub fn tip(&self, q: &[f64]) -> [f64; 3] {
        self.robot.tip_position(q)
    }

    /// Writes the configurations at all points for the offsets `z` (node by node; rad, m along the self-motion) into
    /// `waypoints`; returns by how much points are missed, summed (m, rad).
    pub fn place(&mut self, z: &[f64], waypoints: &mut [f64]) -> f64 {
        let n = self.dof();
        let freedom = self.freedom();
        let mut missed = 0.0;
        let mut correction = [0.0; MAX_DOF];
        for point in 0..self.points() {
            let q = &mut waypoints[point * n..(point + 1) * n];
            q.copy_from_slice(&self.nominal[point * n..(point + 1) * n]);
            for (node, basis) in self.bases.iter().enumerate() {
                let weight = self.weights[point * NODES + node];
                for (k, z) in z[node * freedom..(node + 1) * freedom].iter().enumerate() {
                    q.iter_mut().zip(basis.column(k).iter()).for_each(|(q, b)| *q += weight * z * b);
                }
            }
            // What the point before had to be moved by, this one needs about as much.
            let mut from = [0.0; MAX_DOF];
            from[..n].copy_from_slice(q);
            q.iter_mut().zip(&correction).for_each(|(q, c)| *q += c);
            self.bounds.clip(q);
            if point > 0 || !self.starts_as_given {
                missed += project(self.robot, &self.targets[point], &self.bounds, q, &mut self.linearization);
            }
            for j in 0..n {
                correction[j] = q[j] - from[j];
            }
        }
        missed
    }

    /// The nominal motion of least joint travel, over several starts.
    fn shortest(&mut self, path: &Reference, stride: usize, seed: u64) -> Result<Vec<f64>> {
        let mut rng = rng::stream(seed, 0);
        let starts = self.robot.random_configurations(STARTS, &mut rng)?;
        let mut best: Option<(f64, Vec<f64>)> = None;
        let mut farthest: Option<Lost> = None;
        for start in starts.chunks_exact(self.dof()) {
            match self.follow(start) {
                Ok(nominal) => {
                    let travel = travel(&nominal, self.dof());
                    if best.as_ref().is_none_or(|(least, _)| travel < *least) {
                        best = Some((travel, nominal));
                    }
                }
                Err(lost) => {
                    if farthest.as_ref().is_none_or(|other| lost.is_farther_than(other)) {
                        farthest = Some(lost);
                    }
                }
            }
        }
        match (best, farthest) {
            (Some((_, nominal)), _) => Ok(nominal),
            (None, Some(lost)) => Err(lost.error(path, stride)),
            (None, None) => Err(Error::InvalidPath { problem: "no start was tried".into() }),
        }
    }

    /// From `start` along all points, each from the one before.
    fn follow(&mut self, start: &[f64]) -> Result<Vec<f64>, Lost> {
        let n = self.dof();
        let mut nominal = vec![0.0; self.points() * n];
        let mut q = [0.0; MAX_DOF];
        q[..n].copy_from_slice(start);
        for (point, target) in self.targets.iter().enumerate() {
            let before = q;
            let missed = match point {
                0 if self.starts_as_given => 0.0,
                _ => project(self.robot, target, &self.bounds, &mut q[..n], &mut self.linearization),
            };
            let jump = (0..n).map(|j| (q[j] - before[j]).abs()).fold(0.0, f64::max);
            if missed > 0.0 || (point > 0 && jump > JUMP) {
                return Err(Lost { point, missed });
            }
            nominal[point * n..(point + 1) * n].copy_from_slice(&q[..n]);
        }
        Ok(nominal)
    }

    /// The null space of the task's Jacobian at each node, each basis turned towards the one before.
    fn self_motions(&mut self) -> Vec<DMatrix<f64>> {
        let n = self.dof();
        let mut bases: Vec<DMatrix<f64>> = Vec::with_capacity(NODES);
        for node in 0..NODES {
            let point = node * (self.points() - 1) / (NODES - 1);
            let q = &self.nominal[point * n..(point + 1) * n];
            let mut problem = Problem::new(self.robot, &self.targets[point], Tolerance::default());
            problem.linearize(q, &mut self.linearization);
            let jacobian = DMatrix::from_fn(6, n, |row, joint| self.linearization.columns[joint][row]);
            let null = null_space(&jacobian);
            bases.push(match bases.first() {
                None => null,
                Some(first) => turned(&null, bases.last().unwrap_or(first), first.ncols()),
            });
        }
        bases
    }
}

/// Where a nominal motion ended, and how far it missed the point (m, rad).
struct Lost {
    point: usize,
    missed: f64,
}

impl Lost {
    fn is_farther_than(&self, other: &Self) -> bool {
        self.point > other.point || (self.point == other.point && self.missed < other.missed)
    }

    fn error(&self, path: &Reference, stride: usize) -> Error {
        let row = (self.point * stride).min(path.len() - 1);
        let problem = if self.missed > 0.0 {
            format!("the nearest configuration found within the limits misses it by {}", number(self.missed))
        } else {
            "only another branch of configurations does, and the arm cannot jump to it".into()
        };
        Error::Unreachable { what: format!("point {row} of the path"), problem }
    }
}

/// Rows of the path that the splines pass.
pub fn passed(rows: usize, stride: usize) -> impl Iterator<Item = usize> {
    (0..rows - 1).step_by(stride).chain([rows - 1])
}

fn target(path: &Reference, row: usize) -> Target {
    match path.pose(row) {
        Some(pose) => Target::from(&pose),
        None => Target::Position(path.position(row)),
    }
}

/// Brings `q` onto the target, to a nearby solution; returns by how much that is missed (m, rad), 0 where it is met.
fn project(robot: &Robot, target: &Target, bounds: &Bounds, q: &mut [f64], scratch: &mut Linearization) -> f64 {
    let mut problem = Problem::new(robot, target, Tolerance::default());
    let mut next = [0.0; MAX_DOF];
    let mut value = f64::INFINITY;
    for _ in 0..STEPS {
        value = problem.linearize(q, scratch).value;
        if value <= MET {
            return 0.0;
        }
        let next = &mut next[..q.len()];
        box_step(&scratch.columns, &scratch.residual, DAMPING * value, q, bounds.lower(), bounds.upper(), next);
        q.copy_from_slice(next);
    }
    value.sqrt()
}

/// Sum over the joints of how far each goes.
pub fn travel(waypoints: &[f64], n: usize) -> f64 {
    (n..waypoints.len()).map(|i| (waypoints[i] - waypoints[i - n]).abs()).sum()
}

/// The splines through a unit offset at each node, at every point.
fn node_weights(points: usize) -> Vec<f64> {
    let spline = CubicSpline::natural((0..NODES).map(|node| node as f64 / (NODES - 1) as f64).collect());
    let mut weights = vec![0.0; points * NODES];
    for node in 0..NODES {
        let (mut values, mut bends) = ([0.0; NODES], [0.0; NODES]);
        values[node] = 1.0;
        spline.bends(&values, &mut bends);
        for point in 0..points {
            weights[point * NODES + node] = spline.at(point as f64 / (points - 1) as f64, &values, &bends);
        }
    }
    weights
}

/// Singular values below this share of the largest count as zero: a joint motion that leaves the tip where it is.
const NULL: f64 = 1e-6;

/// An orthonormal basis of what the Jacobian maps to zero.
fn null_space(jacobian: &DMatrix<f64>) -> DMatrix<f64> {
    let gram = jacobian.transpose() * jacobian;
    let eigen = gram.symmetric_eigen();
    let largest = eigen.eigenvalues.amax();
    let null: Vec<usize> =
        (0..eigen.eigenvalues.len()).filter(|i| eigen.eigenvalues[*i] <= NULL * NULL * largest.max(1e-300)).collect();
    eigen.eigenvectors.select_columns(&null)
}

/// A basis of the space of `null` near `before`, with `count` columns: where a singularity adds a direction, it is left
/// out.
fn turned(null: &DMatrix<f64>, before: &DMatrix<f64>, count: usize) -> DMatrix<f64> {
    let shadow = null * (null.transpose() * before);
    let mut basis = DMatrix::zeros(before.nrows(), count);
    for k in 0..count {
        let mut column = shadow.column(k).into_owned();
        for other in 0..k {
            let along: f64 = basis.column(other).dot(&column);
            column -= basis.column(other) * along;
        }
        let length = column.norm();
        // A direction that has no shadow is kept as it was: the projection brings it back onto the path.
        let kept = if length > NULL { column / length } else { before.column(k).into_owned() };
        basis.set_column(k, &kept);
    }
    basis
}
