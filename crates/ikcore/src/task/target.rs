//! Targets of the tip.

use smallvec::SmallVec;

use crate::error::{Result, require_finite};
use crate::math::{Frame, Pose};

/// The targets of one solve: that of the only tip, or one for each task of several.
pub type TargetRow = SmallVec<[Target; 1]>;

/// A target of the tip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// A position (m); the orientation is free.
    Position([f64; 3]),
    /// A full pose.
    Pose(Frame),
    /// The orientation of a frame; the position is free.
    Orientation(Frame),
    /// The position of a frame and the direction of `axis` in it; the rotation about the axis is free.
    Pointing {
        /// The full pose, including the rotation about the axis.
        frame: Frame,
        /// The axis in the tip's own coordinates, of unit length.
        axis: [f64; 3],
    },
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
        let frame = match self {
            Self::Position(position) => return check_point(position),
            Self::Pose(frame) | Self::Orientation(frame) | Self::Pointing { frame, .. } => frame,
        };
        check_point(&frame.origin)?;
        require_finite("target", frame.axes.as_flattened(), |i| format!("rotation entry {i}"))
    }

    /// The target position (m), if any.
    pub fn position(&self) -> Option<[f64; 3]> {
        match self {
            Self::Position(position) => Some(*position),
            Self::Pose(frame) | Self::Pointing { frame, .. } => Some(frame.origin),
            Self::Orientation(_) => None,
        }
    }

    /// The target frame, if any.
    pub(super) fn frame(&self) -> Option<&Frame> {
        match self {
            Self::Position(_) => None,
            Self::Pose(frame) | Self::Orientation(frame) | Self::Pointing { frame, .. } => Some(frame),
        }
    }

    /// The same target with its position, if it has one, replaced.
    pub(crate) fn with_position(&self, replaced: impl Fn(&[f64; 3]) -> [f64; 3]) -> Self {
        let moved = |frame: &Frame| Frame { origin: replaced(&frame.origin), ..*frame };
        match self {
            Self::Position(position) => Self::Position(replaced(position)),
            Self::Pose(frame) => Self::Pose(moved(frame)),
            Self::Pointing { frame, axis } => Self::Pointing { frame: moved(frame), axis: *axis },
            Self::Orientation(_) => *self,
        }
    }
}

fn check_point(point: &[f64; 3]) -> Result<()> {
    require_finite("target", point, |i| format!("coordinate {}", ["x", "y", "z"][i]))
}
