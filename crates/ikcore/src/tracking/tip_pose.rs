//! What a sensor measures of the tip, and what a path asks of it.

use crate::error::{Result, require_finite};
use crate::math::box_step::ROWS;
use crate::math::so3::{rotated, rotation_between};
use crate::math::vector::{median, norm, squared_distance};
use crate::math::{Frame, Pose};
use crate::task::TipError;

/// A position of the tip, with its orientation if that is measured or asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipPose {
    /// Axes as in the base where there is no orientation.
    frame: Frame,
    oriented: bool,
}

impl From<[f64; 3]> for TipPose {
    #[inline]
    fn from(position: [f64; 3]) -> Self {
        Self { frame: Frame { origin: position, ..Frame::IDENTITY }, oriented: false }
    }
}

impl From<Frame> for TipPose {
    #[inline]
    fn from(frame: Frame) -> Self {
        Self { frame, oriented: true }
    }
}

impl From<&Pose> for TipPose {
    fn from(pose: &Pose) -> Self {
        Frame::from(pose).into()
    }
}

impl TipPose {
    /// Before anything is measured.
    pub(super) const UNKNOWN: Self =
        Self { frame: Frame { origin: [f64::NAN; 3], ..Frame::IDENTITY }, oriented: false };

    /// The position (m).
    #[inline]
    pub fn position(&self) -> [f64; 3] {
        self.frame.origin
    }

    /// The pose, if there is an orientation.
    pub fn pose(&self) -> Option<Pose> {
        self.oriented.then(|| self.frame.into())
    }

    /// Whether there is an orientation.
    #[inline]
    pub fn is_oriented(&self) -> bool {
        self.oriented
    }

    /// For messages.
    pub(super) fn kind(&self) -> &'static str {
        if self.oriented { "a pose (4, 4)" } else { "a position (3,)" }
    }

    /// As much of it as `target` asks for; None where that asks for an orientation and there is none.
    #[inline]
    pub(super) fn as_asked_by(mut self, target: &Self) -> Option<Self> {
        if target.oriented && !self.oriented {
            return None;
        }
        self.oriented = target.oriented;
        Some(self)
    }

    /// Err unless every number is finite; `what` names it.
    pub(super) fn require_finite(&self, what: &str) -> Result<()> {
        require_finite(what, &self.frame.origin, |k| format!("entry {k}"))?;
        if self.oriented {
            require_finite(what, self.frame.axes.as_flattened(), |k| format!("rotation entry {k}"))?;
        }
        Ok(())
    }

    /// r = (p - p_d, log(R R_d')), in base coordinates (m, rad), as tasks define it; the angular rows are zero without an
    /// orientation. Seen from another measurement, it is the motion of the tip.
    #[inline]
    pub(super) fn residual(&self, target: &Self) -> [f64; ROWS] {
        let (p, d) = (&self.frame.origin, &target.frame.origin);
        let [a, b, c] = self.rotation(target).unwrap_or_default();
        [p[0] - d[0], p[1] - d[1], p[2] - d[2], a, b, c]
    }

    #[inline]
    fn rotation(&self, target: &Self) -> Option<[f64; 3]> {
        (self.oriented && target.oriented).then(|| rotation_between(&target.frame, &self.frame))
    }

    /// r'r: a radian counts as much as a metre.
    #[inline]
    pub(super) fn squared_error(&self, target: &Self) -> f64 {
        let position = squared_distance(&target.frame.origin, &self.frame.origin);
        match self.rotation(target) {
            Some([x, y, z]) => position + (x * x + y * y + z * z),
            None => position,
        }
    }

    /// |r|.
    #[inline]
    pub(super) fn distance(&self, target: &Self) -> f64 {
        self.squared_error(target).sqrt()
    }

    /// Both parts of the error.
    #[inline]
    pub(super) fn error(&self, target: &Self) -> TipError {
        TipError {
            position: squared_distance(&target.frame.origin, &self.frame.origin).sqrt(),
            rotation: self.rotation(target).map_or(f64::NAN, |phi| norm(&phi)),
        }
    }

    /// The middle one of three, in each direction.
    pub(super) fn median([a, b, c]: [Self; 3]) -> Self {
        let origin = std::array::from_fn(|k| median(a.frame.origin[k], b.frame.origin[k], c.frame.origin[k]));
        let axes = match (b.rotation(&a), c.rotation(&a)) {
            (Some(to_b), Some(to_c)) => {
                let turn = std::array::from_fn(|k| median(0.0, to_b[k], to_c[k]));
                a.frame.axes.map(|axis| rotated(&axis, &turn))
            }
            _ => a.frame.axes,
        };
        Self { frame: Frame { axes, origin }, ..a }
    }
}
