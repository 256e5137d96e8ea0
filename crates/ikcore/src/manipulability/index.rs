//! Yoshikawa's index of a robot's postures.

use super::ellipsoid::Ellipsoid;
use super::gram;
use super::motion::Motion;
use crate::error::Result;
use crate::kinematics::TaskRank;
use crate::math::Columns;
use crate::math::singular_values::SingularValues;
use crate::robot::Robot;

/// Manipulability measure of a robot: the motion that counts, and the rank of its Jacobian.
///
/// The index is the product of the `rank` largest singular values: sqrt(det(J J')) for full rank, sqrt(det(J' J)) for
/// an arm with fewer joints, and the area of the ellipse for the tip of a planar arm, for which both determinants
/// vanish everywhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Manipulability {
    motion: Motion,
    rank: usize,
    /// Number of the tip.
    tip: usize,
}

impl Manipulability {
    /// Measure of `motion` for `robot`.
    pub fn of(robot: &Robot, motion: Motion) -> Self {
        Self::of_tip(robot, 0, motion)
    }

    /// Measure of `motion` for tip number `tip` of `robot`.
    pub(crate) fn of_tip(robot: &Robot, tip: usize, motion: Motion) -> Self {
        let TaskRank { pose, position, rotation } = robot.task_rank_of(tip);
        let rank = match motion {
            Motion::Pose => pose,
            Motion::Position => position,
            Motion::Rotation => rotation,
        };
        Self { motion, rank, tip }
    }

    /// Number of the tip.
    pub(super) fn tip(&self) -> usize {
        self.tip
    }

    /// Motion that counts.
    pub fn motion(&self) -> Motion {
        self.motion
    }

    /// Rank of the Jacobian of the motion, m: the number of directions in which the tip can move.
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// Yoshikawa's index at `q`, which has one finite entry per joint of the robot.
    pub fn index(&self, robot: &Robot, q: &[f64]) -> f64 {
        let mut columns = Columns::default();
        robot.tip_and_jacobian_of(self.tip, q, &mut columns);
        self.index_of(&mut columns[..q.len()])
    }

    /// Index of the matrix with these columns; sets unused rows to zero.
    pub(super) fn index_of(&self, columns: &mut [[f64; 6]]) -> f64 {
        let regular = if self.has_full_rank() { gram::index(columns, self.motion) } else { None };
        regular.unwrap_or_else(|| {
            self.motion.select(columns);
            self.product(&SingularValues::of(columns))
        })
    }

    /// Whether the tip can move in all directions of the motion.
    pub(super) fn has_full_rank(&self) -> bool {
        self.motion.rows().len() == self.rank
    }

    /// Ellipsoid of tip velocities at `q`, which has one finite entry per joint.
    pub fn ellipsoid(&self, robot: &Robot, q: &[f64]) -> Ellipsoid {
        let mut columns = Columns::default();
        robot.tip_and_jacobian_of(self.tip, q, &mut columns);
        let columns = &mut columns[..q.len()];
        self.motion.select(columns);
        Ellipsoid::new(&SingularValues::of(columns), self.rank)
    }

    /// Product of the `rank` largest singular values.
    pub(super) fn product(&self, values: &SingularValues) -> f64 {
        values.lengths[..self.rank].iter().product()
    }
}

/// Yoshikawa's index of `motion` at `q` (n,).
///
/// # Errors
/// As [`Robot::jacobian`]; [`SeveralTips`](crate::Error::SeveralTips).
pub fn manipulability(robot: &Robot, motion: Motion, q: &[f64]) -> Result<f64> {
    robot.require_one_tip("manipulability")?;
    robot.check("joint angles", q)?;
    Ok(Manipulability::of(robot, motion).index(robot, q))
}

/// Yoshikawa's index of `motion` at `qs` (m, n), row-major.
///
/// # Errors
/// As [`Robot::jacobian_all`]; [`SeveralTips`](crate::Error::SeveralTips).
pub fn manipulability_all(robot: &Robot, motion: Motion, qs: &[f64]) -> Result<Vec<f64>> {
    robot.require_one_tip("manipulability")?;
    let rows = robot.rows(qs)?;
    let measure = Manipulability::of(robot, motion);
    Ok(rows.map(|q| measure.index(robot, q)).collect())
}
