//! Fourteen functions of a line on which every rigid motion acts linearly.
//!
//! For a line through p along l they are l, p, p'p, p'l, p x l and (p'p) l - 2 (p'l) p. Raghavan and Roth ("Kinematic
//! analysis of the 6R manipulator of general geometry", 1990) found that the fourteen loop equations made of these functions
//! share their power products. The reason replaces their elimination by hand here: together with a constant one, the
//! functions are a linear representation of the rigid motions, made of scalars and vectors, so that a rotation enters only by
//! the first power of its cosine and sine.

use crate::math::Frame;
use crate::math::arithmetic::Baseline;
use crate::math::vector3::{Vector, add, add_scaled, cross, dot, scaled, sub};

/// Fourteen line functions and the constant, or a linear combination of several such sets.
#[derive(Debug, Clone, Copy)]
pub struct LineFunctions {
    one: f64,
    l: Vector,
    p: Vector,
    pp: f64,
    pl: f64,
    moment: Vector,
    mirrored: Vector,
}

impl LineFunctions {
    /// Evaluates the functions for the line through `p` along `l`.
    pub fn new(l: &Vector, p: &Vector) -> Self {
        let (pp, pl) = (dot(p, p), dot(p, l));
        let mirrored = sub(&scaled(l, pp), &scaled(p, 2.0 * pl));
        Self { one: 1.0, l: *l, p: *p, pp, pl, moment: cross(p, l), mirrored }
    }

    /// Translates the line by `t`.
    #[inline(always)]
    pub fn shifted(&self, t: &Vector) -> Self {
        let (tt, tl) = (dot(t, t), dot(t, &self.l));
        let turned = add_scaled(&self.mirrored, &cross(t, &self.moment), -2.0);
        Self {
            p: add_scaled(&self.p, t, self.one),
            pp: self.pp + 2.0 * dot(t, &self.p) + tt * self.one,
            pl: self.pl + tl,
            moment: add(&self.moment, &cross(t, &self.l)),
            mirrored: add_scaled(&add_scaled(&turned, &self.l, tt), t, -2.0 * (tl + self.pl)),
            ..*self
        }
    }

    /// Moves the line by the rigid motion `frame`.
    #[inline(always)]
    pub fn moved(&self, frame: &Frame) -> Self {
        self.each(self.one, self.pp, self.pl, |v| frame.turn::<Baseline>(v)).shifted(&frame.origin)
    }

    /// Splits a rotation about the line through `point` along `axis` into its constant, cosine and sine parts.
    #[inline(always)]
    pub fn turning(&self, axis: &Vector, point: &Vector) -> [Self; 3] {
        let here = self.shifted(&scaled(point, -1.0));
        let along = |v: &Vector| scaled(axis, dot(axis, v));
        [
            here.each(here.one, here.pp, here.pl, along).shifted(point),
            here.each(0.0, 0.0, 0.0, |v| sub(v, &along(v))).shifted(point),
            here.each(0.0, 0.0, 0.0, |v| cross(axis, v)).shifted(point),
        ]
    }

    /// Returns the fourteen numbers without the constant.
    #[inline(always)]
    pub fn numbers(&self) -> [f64; 14] {
        let Self { l, p, pp, pl, moment: m, mirrored: w, .. } = self;
        [l[0], l[1], l[2], p[0], p[1], p[2], *pp, *pl, m[0], m[1], m[2], w[0], w[1], w[2]]
    }

    #[inline(always)]
    fn each(&self, one: f64, pp: f64, pl: f64, map: impl Fn(&Vector) -> Vector) -> Self {
        Self { one, l: map(&self.l), p: map(&self.p), pp, pl, moment: map(&self.moment), mirrored: map(&self.mirrored) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_form::angle::Angle;
    use crate::math::vector3::unit;

    #[test]
    fn moving_the_functions_is_moving_the_line() {
        let (l, p) = (unit(&[0.3, -0.4, 0.8]), [0.7, 0.2, -0.9]);
        let (axis, point, turn) = (unit(&[0.5, 0.5, 0.1]), [-0.3, 0.6, 0.4], Angle::by(1.3));
        let frame = turn.about_line(&axis, &point);
        let exact = LineFunctions::new(&frame.turn::<Baseline>(&l), &frame.transform::<Baseline>(&p)).numbers();
        let moved = LineFunctions::new(&l, &p).moved(&frame).numbers();
        let [still, cosine, sine] = LineFunctions::new(&l, &p).turning(&axis, &point).map(|part| part.numbers());
        for k in 0..14 {
            assert!((moved[k] - exact[k]).abs() < 1e-14, "{k}");
            assert!((still[k] + turn.cos * cosine[k] + turn.sin * sine[k] - exact[k]).abs() < 1e-14, "{k}");
        }
    }
}
