//! Enclosures of moving quantities: vectors in balls, numbers in intervals, angles on arcs.

use std::f64::consts::PI;

use crate::closed_form::angle::Angle;
use crate::closed_form::orbit::Orbit;
use crate::math::turns::without_turns;
use crate::math::vector3::{Vector, cross, dot, scaled, sub};

/// Ball that encloses a vector.
#[derive(Debug, Clone, Copy)]
pub struct Ball {
    /// Centre.
    pub middle: Vector,
    /// Radius.
    pub radius: f64,
}

impl Ball {
    /// Rotates the ball about the unit vector `axis` by `turn`, uncertain by `half` (rad).
    pub fn turned(&self, axis: &Vector, turn: Angle, half: f64) -> Self {
        Self { middle: turn.about(axis, &self.middle), radius: self.radius + half * distance(axis, &self.middle) }
    }

    /// Returns the smallest distance of the ball from the line along the unit vector `axis`.
    pub fn least_distance(&self, axis: &Vector) -> f64 {
        (distance(axis, &self.middle) - self.radius).max(0.0)
    }

    /// Returns the largest angle about `axis` between a vector in the ball and its centre (rad).
    pub fn azimuth_error(&self, axis: &Vector) -> f64 {
        let distance = distance(axis, &self.middle);
        // Tangent of the angle whose sine is radius / distance: an upper bound that needs no arcsine.
        if self.radius < distance { self.radius / (distance * distance - self.radius * self.radius).sqrt() } else { PI }
    }
}

/// Returns the distance of `v` from the line along the unit vector `axis`.
pub fn distance(axis: &Vector, v: &Vector) -> f64 {
    let across = cross(axis, v);
    dot(&across, &across).sqrt()
}

/// First harmonic constant + cosine cos q + sine sin q.
#[derive(Debug, Clone, Copy)]
pub struct Harmonic {
    /// Mean value.
    pub constant: f64,
    /// Coefficient of cos q.
    pub cosine: f64,
    /// Coefficient of sin q.
    pub sine: f64,
}

impl Harmonic {
    /// Returns the component along `axis` of a point on a circle.
    pub fn along(axis: &Vector, circle: &Orbit) -> Self {
        Self { constant: dot(axis, &circle.centre), cosine: dot(axis, &circle.cosine), sine: dot(axis, &circle.sine) }
    }

    /// Returns the squared distance of a point on a circle from `other`.
    pub fn squared_distance(circle: &Orbit, other: &Vector) -> Self {
        let way = scaled(&sub(&circle.centre, other), 2.0);
        let constant = 0.25 * dot(&way, &way) + dot(&circle.sine, &circle.sine);
        Self { constant, ..Self::along(&way, circle) }
    }

    fn size(&self) -> f64 {
        (self.cosine * self.cosine + self.sine * self.sine).sqrt()
    }

    /// Bounds the values within `half` (rad) of an angle, widened by `slack`.
    pub fn range_near(&self, turn: Angle, half: f64, slack: f64) -> [f64; 2] {
        let value = self.constant + self.cosine * turn.cos + self.sine * turn.sin;
        let slope = (self.sine * turn.cos - self.cosine * turn.sin).abs();
        let spread = half * slope + 0.5 * half * half * self.size() + slack;
        [value - spread, value + spread]
    }

    /// Returns the arcs on which the value lies within `range`, one on each side of the peak, if the amplitude is uncertain
    /// by the relative error `doubt`; `None` if there are no such arcs.
    pub fn arcs(&self, range: [f64; 2], doubt: f64) -> Option<[Arc; 2]> {
        let [low, high] = range.map(|value| value - self.constant);
        let (least, most) = ((1.0 - doubt) * self.size(), (1.0 + doubt) * self.size());
        // Cosines of the angle from the peak; infinite or NaN if nothing is known.
        let from = if doubt < 1.0 { low / if low > 0.0 { most } else { least } } else { -1.0 };
        let to = if doubt < 1.0 { high / if high > 0.0 { least } else { most } } else { 1.0 };
        if from > 1.0 || to < -1.0 {
            return None;
        }
        let near = if to < 1.0 { to.acos() } else { 0.0 };
        let far = if from > -1.0 { from.acos() } else { PI };
        let (peak, middle, half) = (self.sine.atan2(self.cosine), 0.5 * (near + far), 0.5 * (far - near));
        Some([Arc { middle: peak + middle, half }, Arc { middle: peak - middle, half }])
    }
}

/// Arc of angles within `half` of `middle` (rad).
#[derive(Debug, Clone, Copy)]
pub struct Arc {
    /// Middle angle (rad).
    pub middle: f64,
    /// Half the length (rad).
    pub half: f64,
}

impl Arc {
    /// Returns the arc between two angles.
    pub fn between([first, last]: [f64; 2]) -> Self {
        Self { middle: 0.5 * (first + last), half: 0.5 * (last - first) }
    }

    /// Extends the arc at both ends.
    pub fn wider(self, by: f64) -> Self {
        Self { half: self.half + by, ..self }
    }

    /// Whether the arc is the full circle.
    pub fn is_all(&self) -> bool {
        !(self.half < PI)
    }

    /// Splits the arc at its middle.
    pub fn halves(&self) -> [Self; 2] {
        let half = 0.5 * self.half;
        [self.middle - half, self.middle + half].map(|middle| Self { middle, half })
    }

    /// Intersects the arc with `limits` modulo 2 pi; returns all of it where the intersection may have two parts.
    pub fn within(self, limits: &Self) -> Option<Self> {
        if !(self.half + limits.half < PI) {
            return Some(self);
        }
        let off = self.middle - limits.middle;
        let off = without_turns(off);
        let (first, last) = ((off - self.half).max(-limits.half), (off + self.half).min(limits.half));
        let Self { middle, half } = Self::between([first, last]);
        (first <= last).then_some(Self { middle: limits.middle + middle, half })
    }

    /// Returns the middle angle.
    pub fn turn(&self) -> Angle {
        Angle::by(self.middle)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::math::vector3::{add_scaled, norm, unit};
    use crate::rng;

    #[test]
    fn arcs_hold_every_angle_at_which_a_value_is_within_a_range() {
        let mut rng = rng::stream(3, 0);
        for _ in 0..20_000 {
            let mut draw = |most: f64| rng.uniform_in(-most, most);
            let harmonic = Harmonic { constant: draw(1.0), cosine: draw(1.0), sine: draw(1.0) };
            let (q, doubt) = (draw(PI), draw(1.1).abs());
            let factor = 1.0 + doubt * draw(1.0);
            let value = harmonic.constant + factor * (harmonic.cosine * q.cos() + harmonic.sine * q.sin());
            let range = [value - draw(0.5).abs() - 1e-12, value + draw(0.5).abs() + 1e-12];
            let arcs = harmonic.arcs(range, doubt).expect("it is within");
            let angle = Arc { middle: q + TAU, half: 0.0 };
            assert!(arcs.iter().any(|arc| angle.within(&arc.wider(1e-6)).is_some()), "{harmonic:?} {q} {range:?}");
            let half = draw(1.0).abs();
            let near = harmonic.range_near(Angle::by(q + half * draw(1.0)), half, 1e-12);
            let value = harmonic.constant + harmonic.cosine * q.cos() + harmonic.sine * q.sin();
            assert!(near[0] <= value && value <= near[1]);
        }
        assert!(Harmonic { constant: 0.0, cosine: 0.6, sine: 0.8 }.arcs([1.2, 2.0], 0.1).is_none());
    }

    #[test]
    fn a_ball_holds_what_is_turned_and_its_direction() {
        let (axis, mut rng) = (unit(&[0.3, -0.5, 0.8]), rng::stream(3, 1));
        for _ in 0..2000 {
            let mut draw = |most: f64| rng.uniform_in(-most, most);
            let ball = Ball { middle: [draw(1.0), draw(1.0), draw(1.0)], radius: draw(0.5).abs() };
            let (q, half) = (draw(3.0), draw(0.5).abs());
            let off = unit(&[draw(1.0), draw(1.0), draw(1.0)]);
            let point: Vector = add_scaled(&ball.middle, &off, ball.radius);
            let turned = ball.turned(&axis, Angle::by(q), half);
            let there = Angle::by(q + half * draw(1.0)).about(&axis, &point);
            assert!(norm(&sub(&there, &turned.middle)) <= turned.radius + 1e-12);
            let [a, b] = [cross(&axis, &ball.middle), cross(&axis, &point)];
            let apart = dot(&a, &b) / (dot(&a, &a) * dot(&b, &b)).sqrt();
            assert!(apart.min(1.0).acos() <= ball.azimuth_error(&axis) + 1e-7);
        }
    }

    #[test]
    fn what_is_left_of_an_arc_within_limits() {
        let limits = Arc::between([-1.0, 2.0]);
        let left = Arc::between([TAU + 1.5, TAU + 2.5]).within(&limits).expect("a part");
        assert!((left.middle - 1.75).abs() < 1e-12 && (left.half - 0.25).abs() < 1e-12);
        assert!(Arc::between([2.1, 3.0]).within(&limits).is_none());
        assert!(Arc { middle: f64::NAN, half: 0.0 }.within(&limits).is_some());
        assert!(Arc::between([-4.0, 4.0]).is_all() && !limits.is_all());
    }
}
