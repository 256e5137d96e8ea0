//! Kinematics of one configuration.

use nalgebra::Matrix6xX;

use super::model::Robot;
use crate::error::Result;
use crate::kinematics::link_frames::link_frames;
use crate::kinematics::{Reach, Screws, Wrench};
use crate::math::Columns;
use crate::math::{Frame, MAX_DOF, Pose};

impl Robot {
    /// Pose of the tip at `q` (n,) (rad, m).
    ///
    /// # Errors
    /// [`Error::WrongLength`](crate::Error::WrongLength) or [`Error::NotFinite`](crate::Error::NotFinite).
    pub fn fk(&self, q: &[f64]) -> Result<Pose> {
        self.check("joint angles", q)?;
        Ok(self.tip(q).into())
    }

    /// Geometric Jacobian at the tip, 6 x n: linear rows (m per rad or m), then angular, in the base's axes.
    ///
    /// # Errors
    /// [`Error::WrongLength`](crate::Error::WrongLength) or [`Error::NotFinite`](crate::Error::NotFinite).
    pub fn jacobian(&self, q: &[f64]) -> Result<Matrix6xX<f64>> {
        self.check("joint angles", q)?;
        let mut columns = Columns::default();
        self.tip_and_jacobian(q, &mut columns);
        Ok(Matrix6xX::from_iterator(q.len(), columns[..q.len()].iter().flatten().copied()))
    }

    /// Pose of every link at `q` (n,), base first, in the order of [`link_names`](Self::link_names).
    ///
    /// # Errors
    /// [`Error::WrongLength`](crate::Error::WrongLength) or [`Error::NotFinite`](crate::Error::NotFinite).
    pub fn link_poses(&self, q: &[f64]) -> Result<Vec<Pose>> {
        self.check("joint angles", q)?;
        let mut reached = [Frame::IDENTITY; MAX_DOF + 1];
        self.write_stage_frames(q, &mut reached);
        Ok(link_frames(self.chain(), &reached).into_iter().map(Pose::from).collect())
    }

    /// [`fk`](Self::fk) without the check: `q` has one finite entry per joint.
    #[inline]
    pub fn tip(&self, q: &[f64]) -> Frame {
        (self.kernels().tip)(self.chain(), q)
    }

    /// Position of the tip (m) at `q`, which has one finite entry per joint.
    #[inline]
    pub fn tip_position(&self, q: &[f64]) -> [f64; 3] {
        (self.kernels().tip_position)(self.chain(), q)
    }

    /// Calls `visit` with the tip position (m) at each of the configurations `qs`, stored consecutively. Faster than
    /// calling [`tip_position`](Self::tip_position) for each, with bit-identical results (for joint angles below 8e5
    /// rad).
    #[inline]
    pub fn tip_positions(&self, qs: &[f64], visit: impl FnMut([f64; 3])) {
        self.kernels().tip_positions(self.chain(), qs, self.dof(), visit);
    }

    /// Writes the Jacobian and returns the tip, in one pass without the check: `q` has one finite entry per joint.
    #[inline]
    pub fn tip_and_jacobian(&self, q: &[f64], columns: &mut Columns) -> Frame {
        (self.kernels().jacobian)(self.chain(), q, columns)
    }

    /// Writes the joint torques J'w (N m, or N for prismatic joints) of w = wrench(tip) and returns the tip, in one
    /// pass without a Jacobian. `q` and `torques` have one entry per joint.
    #[inline]
    pub fn tip_and_torques(&self, q: &[f64], wrench: &dyn Fn(&Frame) -> Wrench, torques: &mut [f64]) -> Frame {
        (self.kernels().torques)(self.chain(), q, wrench, torques)
    }

    /// Bounds on the positions that the tip can reach between these joint limits.
    pub fn reach(&self, lower: &[f64], upper: &[f64]) -> Reach {
        self.reach_of_links().with_slides(self.chain(), lower, upper)
    }

    /// Screws of the moving elements at `q`, which has one finite entry per joint; base to tip, mimics included.
    pub fn screws(&self, q: &[f64]) -> Screws {
        let mut reached = [Frame::IDENTITY; MAX_DOF + 1];
        self.write_stage_frames(q, &mut reached);
        Screws::of(self.chain(), &reached)
    }

    /// Writes the frames after 0, 1, 2, ... moving elements; the z axis of each but the first is the axis of the
    /// element.
    pub(crate) fn write_stage_frames(&self, q: &[f64], frames: &mut [Frame]) {
        (self.kernels().stage_frames)(self.chain(), q, frames);
    }
}
