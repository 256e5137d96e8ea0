//! What the tip is to reach: residuals of a frame task and their derivatives.

mod pose;
mod position;

use crate::error::{Error, Result, require_finite};
use crate::math::{Frame, Pose, so3};
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

/// When a target counts as reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Largest distance of the tip from the target (m).
    pub position: f64,
    /// Largest geodesic angle to the target's orientation (rad).
    pub rotation: f64,
}

impl Default for Tolerance {
    fn default() -> Self {
        Self { position: 1e-6, rotation: 1e-6 }
    }
}

impl Tolerance {
    /// Checks that both are positive.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for zero, negative or NaN.
    pub fn validate(&self) -> Result<()> {
        for (what, value) in [("position_tolerance", self.position), ("rotation_tolerance", self.rotation)] {
            if !(value > 0.0) {
                return Err(Error::out_of_range(what, "positive", value));
            }
        }
        Ok(())
    }
}

/// How far the tip is from its target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipError {
    /// Distance (m).
    pub position: f64,
    /// Geodesic angle (rad); NaN where the target asks for no orientation.
    pub rotation: f64,
}

impl TipError {
    /// The error of a tip whose orientation does not matter.
    #[inline]
    pub fn of_position(target: &[f64; 3], tip: &[f64; 3]) -> Self {
        Self { position: so3::norm(&position::residual(target, tip)), rotation: f64::NAN }
    }

    /// The sum of squares that solvers minimise.
    pub fn value(&self) -> f64 {
        // max() drops the NaN of an orientation that was not asked for.
        let rotation = self.rotation.max(0.0);
        self.position * self.position + rotation * rotation
    }

    /// Whether both are within `tolerance`; an orientation that was not asked for always is.
    pub fn within(&self, tolerance: &Tolerance) -> bool {
        self.position <= tolerance.position && !(self.rotation > tolerance.rotation)
    }
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
    /// [`Error::NotFinite`].
    pub fn validate(&self) -> Result<()> {
        let (Self::Position(position) | Self::Pose(Frame { origin: position, .. })) = self;
        require_finite("target", position, |i| format!("coordinate {}", ["x", "y", "z"][i]))?;
        match self {
            Self::Position(_) => Ok(()),
            Self::Pose(frame) => require_finite("target", frame.axes.as_flattened(), |i| format!("rotation entry {i}")),
        }
    }

    /// Its position (m).
    pub fn position(&self) -> &[f64; 3] {
        match self {
            Self::Position(position) => position,
            Self::Pose(frame) => &frame.origin,
        }
    }

    /// Whether it asks for an orientation.
    pub fn is_pose(&self) -> bool {
        matches!(self, Self::Pose(_))
    }

    /// How far the tip of `robot` at `q` is from here.
    #[inline]
    pub fn error(&self, robot: &Robot, q: &[f64]) -> TipError {
        match self {
            Self::Position(target) => TipError::of_position(target, &robot.tip_position(q)),
            Self::Pose(target) => {
                let tip = robot.tip(q);
                TipError {
                    position: so3::norm(&position::residual(&target.origin, &tip.origin)),
                    rotation: so3::norm(&so3::rotation_between(target, &tip)),
                }
            }
        }
    }

    /// Residual and Jacobian at `q`, and the error.
    #[inline]
    pub(crate) fn linearize(&self, robot: &Robot, q: &[f64], out: &mut Linearization) -> TipError {
        let tip = robot.tip_and_jacobian(q, &mut out.columns);
        match self {
            Self::Position(target) => position::linearize(target, &tip, q.len(), out),
            Self::Pose(target) => pose::linearize(target, &tip, q.len(), out),
        }
    }
}
