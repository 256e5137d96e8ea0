//! Yoshikawa's index of a robot's postures.

use super::ellipsoid::Ellipsoid;
use super::gradient;
use super::gram::GramFactor;
use super::motion::Motion;
use crate::error::Result;
use crate::kinematics::{Columns, Directions};
use crate::math::MAX_DOF;
use crate::math::singular::SingularValues;
use crate::robot::Robot;

/// The measure of a robot's postures: which motion counts, and how many directions of it the robot has at all.
///
/// The index is the product of as many singular values as there are directions: sqrt(det(J J')) where the tip can move
/// in all of them, sqrt(det(J' J)) for an arm of fewer joints, and the area of the ellipse for the tip of a planar arm,
/// where both determinants vanish everywhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Manipulability {
    motion: Motion,
    directions: usize,
}

impl Manipulability {
    /// The measure of `motion` for `robot`.
    pub fn of(robot: &Robot, motion: Motion) -> Self {
        let Directions { pose, position, rotation } = robot.directions();
        let directions = match motion {
            Motion::Pose => pose,
            Motion::Position => position,
            Motion::Rotation => rotation,
        };
        Self { motion, directions }
    }

    /// Which motion counts.
    pub fn motion(&self) -> Motion {
        self.motion
    }

    /// Directions in which the tip can move, m.
    pub fn directions(&self) -> usize {
        self.directions
    }

    /// Yoshikawa's index at `q`, which has one finite entry per joint of the robot.
    pub fn index(&self, robot: &Robot, q: &[f64]) -> f64 {
        let mut columns: Columns = [[0.0; 6]; MAX_DOF];
        robot.tip_and_jacobian(q, &mut columns);
        self.index_of(&mut columns[..q.len()])
    }

    /// The index of the matrix with these columns, of which the rows that do not count are emptied.
    pub(super) fn index_of(&self, columns: &mut [[f64; 6]]) -> f64 {
        match self.gram_factor(columns) {
            Some(gram) => gram.index(),
            None => {
                self.motion.select(columns);
                self.product(&SingularValues::of(columns))
            }
        }
    }

    /// The factorisation of J J' away from singularities, where the robot has all directions of the motion.
    pub(super) fn gram_factor(&self, columns: &[[f64; 6]]) -> Option<GramFactor> {
        let rows = self.motion.rows();
        if rows.len() == self.directions { GramFactor::of(columns, rows) } else { None }
    }

    /// The index at `q`, and its gradient (n,) in `out`; nothing is allocated. `q` and `out` have one entry per joint.
    ///
    /// Exact, by the derivative of the geometric Jacobian. Where the index is zero it has no gradient: what is written
    /// then points out of the singularity on one of its two sides, or is zero.
    pub fn gradient(&self, robot: &Robot, q: &[f64], out: &mut [f64]) -> f64 {
        gradient::index(self, robot, q, out)
    }

    /// The ellipsoid of tip velocities at `q`, which has one finite entry per joint.
    pub fn ellipsoid(&self, robot: &Robot, q: &[f64]) -> Ellipsoid {
        Ellipsoid::new(&decompose(robot, self.motion, q), self.directions)
    }

    /// The product of the largest singular values, one per direction.
    pub(super) fn product(&self, values: &SingularValues) -> f64 {
        values.lengths[..self.directions].iter().product()
    }
}

fn decompose(robot: &Robot, motion: Motion, q: &[f64]) -> SingularValues {
    let mut columns: Columns = [[0.0; 6]; MAX_DOF];
    robot.tip_and_jacobian(q, &mut columns);
    let columns = &mut columns[..q.len()];
    motion.select(columns);
    SingularValues::of(columns)
}

/// Yoshikawa's index of `motion` at `q` (n,).
///
/// # Errors
/// As [`Robot::jacobian`].
pub fn manipulability(robot: &Robot, motion: Motion, q: &[f64]) -> Result<f64> {
    robot.check("joint angles", q)?;
    Ok(Manipulability::of(robot, motion).index(robot, q))
}

/// The same at `qs`, (m, n) row after row.
///
/// # Errors
/// As [`Robot::jacobian_all`].
pub fn manipulability_all(robot: &Robot, motion: Motion, qs: &[f64]) -> Result<Vec<f64>> {
    let rows = robot.rows(qs)?;
    let measure = Manipulability::of(robot, motion);
    Ok(rows.map(|q| measure.index(robot, q)).collect())
}
