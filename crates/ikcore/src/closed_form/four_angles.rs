//! Four angles in SIMD lanes, as cosines and sines. Each lane performs the operations of [`Angle`] in the same order.

use crate::closed_form::angle::Angle;
use crate::closed_form::orbit::Orbit;
use crate::math::real::Real;

/// Rotation angle about a known axis, one per lane.
#[derive(Debug, Clone, Copy)]
pub struct FourAngles<R> {
    /// Cosines.
    pub cos: R,
    /// Sines.
    pub sin: R,
}

impl<R: Real> FourAngles<R> {
    /// Returns the directions of the points (x, y); [`Angle::NONE`] at the origin.
    #[inline(always)]
    pub fn towards(x: R, y: R) -> Self {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let square = x * x + y * y;
        let inverse = one / square.sqrt();
        Self { cos: zero.choose_below(square, x * inverse, one), sin: zero.choose_below(square, y * inverse, zero) }
    }

    /// Returns the inverse rotations.
    #[inline(always)]
    pub fn back(self) -> Self {
        Self { cos: self.cos, sin: -self.sin }
    }

    /// Adds other rotations about the same axis.
    #[inline(always)]
    pub fn and(self, other: Self) -> Self {
        Self { cos: self.cos * other.cos - self.sin * other.sin, sin: self.sin * other.cos + self.cos * other.sin }
    }

    /// Multiplies the angles by `sign`, 1 or -1: rotations about the reversed axis.
    #[inline(always)]
    pub fn signed(self, sign: f64) -> Self {
        Self { cos: self.cos, sin: R::splat(sign) * self.sin }
    }

    /// Rotates the vectors (x, y, z) about z.
    #[inline(always)]
    pub fn about_z(self, [x, y, z]: [R; 3]) -> [R; 3] {
        [self.cos * x - self.sin * y, self.sin * x + self.cos * y, z]
    }

    /// Returns the points of a circle at these angles.
    #[inline(always)]
    pub fn on(self, circle: &Orbit) -> [R; 3] {
        let Orbit { centre, cosine, sine } = circle;
        let entry = |k: usize| R::splat(centre[k]) + (R::splat(cosine[k]) * self.cos + R::splat(sine[k]) * self.sin);
        [entry(0), entry(1), entry(2)]
    }

    /// Returns the angle in lane `lane`.
    #[inline(always)]
    pub fn lane(self, lane: usize) -> Angle {
        Angle { cos: self.cos.lane(lane), sin: self.sin.lane(lane) }
    }

    /// Replaces the angle in lane `lane`.
    #[inline(always)]
    pub fn with_lane(self, lane: usize, angle: Angle) -> Self {
        Self { cos: self.cos.with_lane(lane, angle.cos), sin: self.sin.with_lane(lane, angle.sin) }
    }
}

/// Returns the dot products of four vector pairs.
#[inline(always)]
pub fn dot<R: Real>(a: &[R; 3], b: &[R; 3]) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::arithmetic::NoFma;
    use crate::math::f64x4::F64x4;
    use crate::math::real::Four;

    #[test]
    fn each_lane_is_to_the_bit_what_one_angle_gives() {
        let of = |values: [f64; 4]| Four::<NoFma>::of(F64x4(values));
        let (x, y) = ([0.3, -1.2, 0.0, 1e-9], [0.7, 0.4, 0.0, -2.0]);
        let (four, turns) = (FourAngles::towards(of(x), of(y)), [0, 1, 2, 3].map(|k| Angle::towards(x[k], y[k])));
        let circle = Orbit::of(&[0.6, 0.0, 0.8], &[0.2, -0.5, 0.9]).moved(&[0.1, 0.2, 0.3]);
        let points = four.on(&circle);
        let added = four.and(four).back().signed(-1.0).about_z(points);
        for (lane, turn) in turns.iter().enumerate() {
            assert_eq!(four.lane(lane), *turn);
            let point = circle.at(*turn);
            assert_eq!([0, 1, 2].map(|k| points[k].lane(lane)), point);
            let expected = crate::closed_form::orbit::about_z(turn.and(*turn).back().signed(-1.0), &point);
            assert_eq!([0, 1, 2].map(|k| added[k].lane(lane)), expected);
            let product = crate::math::vector3::dot(&point, &point);
            assert_eq!(dot(&points, &points).lane(lane), product);
        }
        let changed = four.with_lane(2, Angle::by(0.5));
        assert_eq!((changed.lane(2), changed.lane(1)), (Angle::by(0.5), turns[1]));
    }
}
