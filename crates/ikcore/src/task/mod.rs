//! What the tip is to reach: residuals of a frame task and their derivatives.

pub mod entrywise;
mod error;
mod pose;
mod position;

pub use error::{SquaredError, TipError, Tolerance};

use crate::error::{Result, require_finite};
use crate::math::{Frame, Pose};
use crate::objective::Linearization;
use crate::robot::Robot;

/// Where the tip is to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// A position (m), the orientation left free.
    Position([f64; 3]),
    /// A full pose.
    Pose(Frame),
}

impl From<&Pose> for Target {
    fn from(pose: &Pose) -> Self {
        Self::Pose(Frame::from(pose))
    }
}

impl Target {
    /// Checks that every number is finite.
    ///
    /// # Errors
    /// [`Error::NotFinite`](crate::Error::NotFinite).
    pub fn validate(&self) -> Result<()> {
        let (Self::Position(position) | Self::Pose(Frame { origin: position, .. })) = self;
        require_finite("target", position, |i| format!("coordinate {}", ["x", "y", "z"][i]))?;
        match self {
            Self::Position(_) => Ok(()),
            Self::Pose(frame) => require_finite("target", frame.axes.as_flattened(), |i| format!("rotation entry {i}")),
        }
    }

    /// How far the tip of `robot` at `q` is from here.
    #[inline]
    pub fn error(&self, robot: &Robot, q: &[f64]) -> SquaredError {
        match self {
            Self::Position(target) => position::error(target, &robot.tip_position(q)),
            Self::Pose(target) => pose::error(target, &robot.tip(q)),
        }
    }

    /// Hands [`error`](Self::error) at the configurations stored one after another to `keep`, in order; side by side
    /// where only positions matter.
    #[inline]
    pub fn errors(&self, robot: &Robot, qs: &[f64], mut keep: impl FnMut(SquaredError)) {
        match self {
            Self::Position(target) => robot.tip_positions(qs, |tip| keep(position::error(target, &tip))),
            Self::Pose(_) => qs.chunks(robot.dof()).for_each(|q| keep(self.error(robot, q))),
        }
    }

    /// How far a tip is from here.
    #[inline]
    pub fn error_of(&self, tip: &Frame) -> SquaredError {
        match self {
            Self::Position(target) => position::error(target, &tip.origin),
            Self::Pose(target) => pose::error(target, tip),
        }
    }

    /// Residual and Jacobian at `q`, and the error.
    #[inline]
    pub fn linearize(&self, robot: &Robot, q: &[f64], out: &mut Linearization) -> SquaredError {
        let tip = robot.tip_and_jacobian(q, &mut out.columns);
        self.complete(&tip, q.len(), out)
    }

    /// The same from a tip and its geometric Jacobian, which stands in the first `dof` columns of `out`.
    #[inline]
    pub fn complete(&self, tip: &Frame, dof: usize, out: &mut Linearization) -> SquaredError {
        match self {
            Self::Position(target) => position::linearize(target, tip, dof, out),
            Self::Pose(target) => pose::linearize(target, tip, dof, out),
        }
    }
}
