//! Angles represented by cosine and sine; closed forms work on these and take arctangents only at the end.

use crate::math::Frame;
use crate::math::vector3::{Vector, add_scaled, cross, dot, scaled, sub};

/// Rotation angle about a known axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Angle {
    /// Cosine of the angle.
    pub cos: f64,
    /// Sine of the angle.
    pub sin: f64,
}

impl Angle {
    /// Zero rotation.
    pub const NONE: Self = Self { cos: 1.0, sin: 0.0 };

    /// Returns the rotation by `angle` (rad).
    pub fn by(angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self { cos, sin }
    }

    /// Returns the direction of the point (x, y); [`Self::NONE`] at the origin.
    #[inline(always)]
    pub fn towards(x: f64, y: f64) -> Self {
        let square = x * x + y * y;
        if square > 0.0 {
            let inverse = 1.0 / square.sqrt();
            Self { cos: x * inverse, sin: y * inverse }
        } else {
            Self::NONE
        }
    }

    /// Returns the angle (rad), in (-pi, pi].
    #[inline(always)]
    pub fn angle(self) -> f64 {
        self.sin.atan2(self.cos)
    }

    /// Returns the inverse rotation.
    #[inline(always)]
    pub fn back(self) -> Self {
        Self { cos: self.cos, sin: -self.sin }
    }

    /// Adds half a turn.
    #[inline(always)]
    pub fn opposite(self) -> Self {
        Self { cos: -self.cos, sin: -self.sin }
    }

    /// Adds another rotation about the same axis.
    #[inline(always)]
    pub fn and(self, other: Self) -> Self {
        Self { cos: self.cos * other.cos - self.sin * other.sin, sin: self.sin * other.cos + self.cos * other.sin }
    }

    /// Multiplies the angle by `sign`, 1 or -1: a rotation about the reversed axis.
    #[inline(always)]
    pub fn signed(self, sign: f64) -> Self {
        Self { cos: self.cos, sin: sign * self.sin }
    }

    /// Rotates `v` about the unit vector `axis` (Rodrigues' formula).
    #[inline(always)]
    pub fn about(self, axis: &Vector, v: &Vector) -> Vector {
        let turned = add_scaled(&scaled(v, self.cos), &cross(axis, v), self.sin);
        add_scaled(&turned, axis, (1.0 - self.cos) * dot(axis, v))
    }

    /// Returns the rigid motion that rotates about the line through `point` along the unit vector `axis`.
    #[inline]
    pub fn about_line(self, axis: &Vector, point: &Vector) -> Frame {
        let [x, y, z] = &Frame::IDENTITY.axes;
        let axes = [self.about(axis, x), self.about(axis, y), self.about(axis, z)];
        Frame { axes, origin: sub(point, &self.about(axis, point)) }
    }
}
