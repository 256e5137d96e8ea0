//! Position or pose of a tip, as measured by a sensor or prescribed by a path.

use std::borrow::Cow;

use crate::error::{Result, require_finite};
use crate::math::box_step::ROWS;
use crate::math::so3::{rotated, rotation_between};
use crate::math::vector::median;
use crate::math::{Frame, Pose};
use crate::task::residual::{pose, position};
use crate::task::{SquaredError, TipError};

/// Position or pose of a tip. Not `Copy`, because a copy always moves the 13 words of a pose.
#[derive(Debug, PartialEq)]
pub enum TipPose {
    /// Position alone (m).
    Position([f64; 3]),
    /// Position (m) and orientation.
    Pose(Frame),
}

impl Clone for TipPose {
    #[inline]
    fn clone(&self) -> Self {
        match self {
            Self::Position(position) => Self::Position(*position),
            Self::Pose(frame) => Self::Pose(*frame),
        }
    }

    /// Writes in place: the derived form would copy a whole pose, four times in each tick of a controller.
    #[inline]
    fn clone_from(&mut self, source: &Self) {
        if let (Self::Position(position), Self::Position(source)) = (&mut *self, source) {
            *position = *source;
        } else {
            *self = source.clone();
        }
    }
}

impl From<[f64; 3]> for TipPose {
    #[inline]
    fn from(position: [f64; 3]) -> Self {
        Self::Position(position)
    }
}

impl From<Frame> for TipPose {
    #[inline]
    fn from(frame: Frame) -> Self {
        Self::Pose(frame)
    }
}

impl From<&Pose> for TipPose {
    fn from(pose: &Pose) -> Self {
        Frame::from(pose).into()
    }
}

impl TipPose {
    /// Value before the first measurement.
    pub(super) const UNKNOWN: Self = Self::Position([f64::NAN; 3]);

    /// Position (m).
    #[inline]
    pub fn position(&self) -> &[f64; 3] {
        match self {
            Self::Position(position) => position,
            Self::Pose(frame) => &frame.origin,
        }
    }

    /// Pose, if there is an orientation.
    pub fn pose(&self) -> Option<Pose> {
        match self {
            Self::Position(_) => None,
            Self::Pose(frame) => Some((*frame).into()),
        }
    }

    /// Whether there is an orientation.
    #[inline]
    pub fn is_oriented(&self) -> bool {
        matches!(self, Self::Pose(_))
    }

    /// Name of the variant, for messages.
    pub(super) fn kind(&self) -> &'static str {
        if self.is_oriented() { "a pose (4, 4)" } else { "a position (3,)" }
    }

    /// Part that `target` specifies; `None` if the target has an orientation and this one has none.
    #[inline]
    pub(super) fn as_asked_by(&self, target: &Self) -> Option<Cow<'_, Self>> {
        match (self, target) {
            (Self::Position(_), Self::Pose(_)) => None,
            (Self::Pose(frame), Self::Position(_)) => Some(Cow::Owned(Self::Position(frame.origin))),
            _ => Some(Cow::Borrowed(self)),
        }
    }

    /// Whether every number is finite.
    #[inline]
    pub(super) fn is_finite(&self) -> bool {
        match self {
            Self::Position(position) => position.iter().all(|x| x.is_finite()),
            Self::Pose(frame) => frame.origin.iter().chain(frame.axes.as_flattened()).all(|x| x.is_finite()),
        }
    }

    /// Checks that every number is finite; `what` names the value in the error.
    #[inline]
    pub(super) fn require_finite(&self, what: &str) -> Result<()> {
        if self.is_finite() { Ok(()) } else { self.not_finite(what) }
    }

    #[cold]
    fn not_finite(&self, what: &str) -> Result<()> {
        require_finite(what, self.position(), |k| format!("entry {k}"))?;
        match self {
            Self::Position(_) => Ok(()),
            Self::Pose(frame) => require_finite(what, frame.axes.as_flattened(), |k| format!("rotation entry {k}")),
        }
    }

    /// Residual r = (p - p_d, log(R R_d')) in base coordinates (m, rad), as tasks define it; the angular rows are zero without
    /// an orientation. The residual to an earlier measurement is the motion of the tip.
    #[inline]
    pub(super) fn residual(&self, target: &Self) -> [f64; ROWS] {
        let (p, d) = (self.position(), target.position());
        let [a, b, c] = self.rotation(target).unwrap_or_default();
        [p[0] - d[0], p[1] - d[1], p[2] - d[2], a, b, c]
    }

    /// Rotation vector from `target` to this pose (rad), if both have an orientation.
    #[inline]
    fn rotation(&self, target: &Self) -> Option<[f64; 3]> {
        match (self, target) {
            (Self::Pose(tip), Self::Pose(target)) => Some(rotation_between(target, tip)),
            _ => None,
        }
    }

    /// Squared errors of position and, if both have one, orientation.
    #[inline]
    fn squared_errors(&self, target: &Self) -> SquaredError {
        match (self, target) {
            (Self::Pose(tip), Self::Pose(target)) => pose::error(target, tip),
            _ => SquaredError { position: Some(position::error(target.position(), self.position())), rotation: None },
        }
    }

    /// Squared error r'r: a radian counts as much as a metre.
    #[inline]
    pub(super) fn squared_error(&self, target: &Self) -> f64 {
        self.squared_errors(target).sum()
    }

    /// Norm of the residual, |r|.
    #[inline]
    pub(super) fn distance(&self, target: &Self) -> f64 {
        self.squared_error(target).sqrt()
    }

    /// Position and orientation error.
    #[inline]
    pub(super) fn error(&self, target: &Self) -> TipError {
        self.squared_errors(target).into()
    }

    /// Median of three, in each direction.
    pub(super) fn median([a, b, c]: &[Self; 3]) -> Self {
        let (p, q, r) = (a.position(), b.position(), c.position());
        let origin = std::array::from_fn(|k| median(p[k], q[k], r[k]));
        match (a, b.rotation(a), c.rotation(a)) {
            (Self::Pose(frame), Some(to_b), Some(to_c)) => {
                let turn = std::array::from_fn(|k| median(0.0, to_b[k], to_c[k]));
                Self::Pose(Frame { axes: frame.axes.map(|axis| rotated(&axis, &turn)), origin })
            }
            _ => Self::Position(origin),
        }
    }
}
