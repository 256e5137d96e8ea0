//! Targets of the tip.

use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use crate::error::{Error, Result, require_finite};
use crate::math::vector::distance;
use crate::math::{Frame, Pose};

/// Targets of one solve: one for each task.
pub type TargetRow = SmallVec<[Target; 1]>;

/// Target of the tip.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Target {
    /// Position (m); the orientation is free.
    Position([f64; 3]),
    /// Full pose.
    Pose(Frame),
    /// Orientation of a frame; the position is free.
    Orientation(Frame),
    /// Position of a frame and the direction of `axis` in it; the rotation about the axis is free.
    Pointing {
        /// Full pose, including the rotation about the axis.
        frame: Frame,
        /// Axis in the tip's own coordinates, of unit length.
        axis: [f64; 3],
    },
}

impl From<&Pose> for Target {
    fn from(pose: &Pose) -> Self {
        Self::Pose(Frame::from(pose))
    }
}

impl Target {
    /// Checks that every number is finite, and that squares of the position are.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OutOfRange`].
    pub fn validate(&self) -> Result<()> {
        self.validate_as("target")
    }

    /// [`validate`](Self::validate), with the name of the argument in errors.
    ///
    /// # Errors
    /// As [`validate`](Self::validate).
    pub(crate) fn validate_as(&self, what: &str) -> Result<()> {
        let frame = match self {
            Self::Position(position) => return check_point(what, position),
            Self::Pose(frame) | Self::Orientation(frame) | Self::Pointing { frame, .. } => frame,
        };
        check_point(what, &frame.origin)?;
        require_finite(what, frame.axes.as_flattened(), |i| format!("rotation entry {i}"))
    }

    /// Position of the target (m), if it has one.
    pub fn position(&self) -> Option<[f64; 3]> {
        match self {
            Self::Position(position) => Some(*position),
            Self::Pose(frame) | Self::Pointing { frame, .. } => Some(frame.origin),
            Self::Orientation(_) => None,
        }
    }

    /// Frame of the target, if it has one.
    pub(super) fn frame(&self) -> Option<&Frame> {
        match self {
            Self::Position(_) => None,
            Self::Pose(frame) | Self::Orientation(frame) | Self::Pointing { frame, .. } => Some(frame),
        }
    }

    /// Distance to another target, in position and in the axes of its frame (m, rad); infinite to one of another kind.
    pub(crate) fn distance_to(&self, other: &Self) -> f64 {
        let apart = |one: Option<&[f64]>, other: Option<&[f64]>| match (one, other) {
            (Some(one), Some(other)) => distance(one, other),
            (None, None) => 0.0,
            _ => f64::INFINITY,
        };
        let positions = [self.position(), other.position()];
        let [one, two] = [0, 1].map(|k: usize| positions[k].as_ref().map(<[f64; 3]>::as_slice));
        let axes = [self, other].map(|target| target.frame().map(|frame| frame.axes.as_flattened()));
        apart(one, two) + apart(axes[0], axes[1])
    }

    /// Replaces the position of the target, if it has one.
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

/// Largest coordinate of a target (m): squares of larger ones are beyond floating-point numbers.
const FARTHEST: f64 = 1e100;

/// Checks the position of a target, the argument `what`.
pub(crate) fn check_point(what: &str, point: &[f64; 3]) -> Result<()> {
    let coordinate = |i: usize| format!("coordinate {}", ["x", "y", "z"][i]);
    require_finite(what, point, coordinate)?;
    match point.iter().position(|value| value.abs() > FARTHEST) {
        None => Ok(()),
        Some(i) => {
            let what = format!("{what}: {}", coordinate(i));
            Err(Error::out_of_range(what, format!("from -{FARTHEST:e} to {FARTHEST:e} m"), point[i]))
        }
    }
}
