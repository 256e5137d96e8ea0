//! Circle described by a point that turns about an axis, precomputed for many angles.

use crate::closed_form::angle::Angle;
use crate::math::vector3::{Vector, add, cross, dot, scaled, sub};

/// Circle centre + cosine cos q + sine sin q.
#[derive(Debug, Clone, Copy)]
pub struct Orbit {
    /// Centre of the circle.
    pub centre: Vector,
    /// Radius vector at q = 0.
    pub cosine: Vector,
    /// Radius vector at q = pi/2.
    pub sine: Vector,
}

impl Orbit {
    /// Returns the circle of `v` as it turns about the unit vector `axis`.
    pub fn of(axis: &Vector, v: &Vector) -> Self {
        let centre = scaled(axis, dot(axis, v));
        Self { centre, cosine: sub(v, &centre), sine: cross(axis, v) }
    }

    /// Expresses the circle in coordinates along three unit vectors.
    pub fn seen(&self, along: &[Vector; 3]) -> Self {
        let Self { centre, cosine, sine } = self;
        Self { centre: seen(along, centre), cosine: seen(along, cosine), sine: seen(along, sine) }
    }

    /// Translates the circle.
    pub fn moved(&self, by: &Vector) -> Self {
        Self { centre: add(&self.centre, by), ..*self }
    }

    /// Returns the point at an angle.
    #[inline(always)]
    pub fn at(&self, turn: Angle) -> Vector {
        let Self { centre, cosine, sine } = self;
        std::array::from_fn(|k| centre[k] + (cosine[k] * turn.cos + sine[k] * turn.sin))
    }
}

/// Returns the coordinates of `v` along three unit vectors.
#[inline(always)]
pub fn seen(along: &[Vector; 3], v: &Vector) -> Vector {
    [dot(&along[0], v), dot(&along[1], v), dot(&along[2], v)]
}

/// Rotates `v` about z.
#[inline(always)]
pub fn about_z(turn: Angle, v: &Vector) -> Vector {
    let [x, y, z] = *v;
    [turn.cos * x - turn.sin * y, turn.sin * x + turn.cos * y, z]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vector3::{norm, unit};

    #[test]
    fn a_point_on_the_circle_is_the_turned_point() {
        let (axis, v) = (unit(&[0.3, -0.5, 0.8]), [0.2, 0.9, -0.4]);
        let along = [unit(&[0.0, 0.8, 0.5]), [1.0, 0.0, 0.0], unit(&[0.0, 0.5, -0.8])];
        let circle = Orbit::of(&axis, &v).moved(&[1.0, 2.0, 3.0]).seen(&along);
        for turn in [0.0, 0.7, -2.5, 3.1].map(Angle::by) {
            let expected = seen(&along, &add(&turn.about(&axis, &v), &[1.0, 2.0, 3.0]));
            assert!(norm(&sub(&circle.at(turn), &expected)) < 1e-15 * 8.0);
            let about = turn.about(&[0.0, 0.0, 1.0], &v);
            assert!(norm(&sub(&about_z(turn, &v), &about)) < 1e-15);
        }
    }
}
