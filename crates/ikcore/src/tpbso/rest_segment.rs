//! The motion of a joint from rest to a via point, or from a via point to rest.

use smallvec::SmallVec;

use crate::math::polynomial::quadratic_roots;
use crate::trajectory::{Coefficients, polynomial};

/// A motion that is at rest at one end, in terms of the position there and the time s (s) since then or until then:
/// theta = rest + s^3 (c\[0\] + c\[1\] s + c\[2\] s^2).
///
/// Velocity and acceleration vanish at rest, so their remaining factors are quadratic and all extremes have a closed
/// form; the paper samples them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RestSegment {
    rest: f64,
    c: [f64; 3],
    duration: f64,
}

/// Position and velocity of a joint at the via point, where the two segments meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ViaPoint {
    /// theta_m (rad or m).
    pub position: f64,
    /// Rate of theta_m (rad/s or m/s).
    pub velocity: f64,
}

/// Extremes of a segment, and its part of the travel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extremes {
    /// Largest speed (rad/s or m/s).
    pub speed: f64,
    /// Largest acceleration (rad/s^2 or m/s^2).
    pub acceleration: f64,
    /// Lowest position (rad or m).
    pub lowest: f64,
    /// Highest position (rad or m).
    pub highest: f64,
    /// Distance covered, back and forth (rad or m).
    pub travel: f64,
}

impl RestSegment {
    /// The segment from rest at `start` to `via` in `t1` (s): eq. (3) with the coefficients of eq. (4).
    pub(super) fn leaving(start: f64, via: ViaPoint, t1: f64) -> Self {
        let a3 = (4.0 * via.position - via.velocity * t1 - 4.0 * start) / t1.powi(3);
        let a4 = (via.velocity * t1 - 3.0 * via.position + 3.0 * start) / t1.powi(4);
        Self { rest: start, c: [a3, a4, 0.0], duration: t1 }
    }

    /// Acceleration at the via point of a segment that started at rest.
    pub(super) fn final_acceleration(&self) -> f64 {
        self.acceleration(self.duration)
    }

    /// The segment from `via`, passed with this `acceleration`, to rest at `end` in `t2` (s): eq. (5) and (6), with s
    /// as the time to the end.
    pub(super) fn arriving(via: ViaPoint, acceleration: f64, end: f64, t2: f64) -> Self {
        let [_, _, _, a3, a4, a5] = quintic(via, acceleration, end, t2);
        let c3 = -(a3 + 4.0 * a4 * t2 + 10.0 * a5 * t2 * t2);
        let c4 = a4 + 5.0 * a5 * t2;
        Self { rest: end, c: [c3, c4, -a5], duration: t2 }
    }

    /// No motion: a placeholder to be overwritten.
    pub(super) const STILL: Self = Self { rest: 0.0, c: [0.0; 3], duration: 0.0 };

    /// Position at s.
    pub(super) fn position(&self, s: f64) -> f64 {
        let [c3, c4, c5] = self.c;
        self.rest + s.powi(3) * (c3 + s * (c4 + s * c5))
    }

    /// d theta / ds at s.
    fn rate(&self, s: f64) -> f64 {
        let [c3, c4, c5] = self.c;
        s * s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5))
    }

    /// d^2 theta / ds^2 at s.
    fn acceleration(&self, s: f64) -> f64 {
        let [c3, c4, c5] = self.c;
        s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5))
    }

    /// The exact extremes.
    pub(super) fn extremes(&self) -> Extremes {
        let [c3, c4, c5] = self.c;
        let turning_points = self.inner_roots(3.0 * c3, 4.0 * c4, 5.0 * c5);
        let inflections = self.inner_roots(6.0 * c3, 12.0 * c4, 20.0 * c5);
        let jerkless = self.inner_roots(6.0 * c3, 24.0 * c4, 60.0 * c5);
        let largest = |roots: &[f64], value: &dyn Fn(f64) -> f64| {
            roots.iter().map(|s| value(*s).abs()).fold(value(self.duration).abs(), f64::max)
        };
        let (mut from, mut lowest, mut highest, mut travel) = (self.rest, self.rest, self.rest, 0.0);
        for s in turning_points.into_iter().chain([self.duration]) {
            let to = self.position(s);
            travel += (to - from).abs();
            (lowest, highest) = (f64::min(lowest, to), f64::max(highest, to));
            from = to;
        }
        Extremes {
            speed: largest(&inflections, &|s| self.rate(s)),
            acceleration: largest(&jerkless, &|s| self.acceleration(s)),
            lowest,
            highest,
            travel,
        }
    }

    /// Roots of a + b s + c s^2 inside the segment, ascending.
    fn inner_roots(&self, a: f64, b: f64, c: f64) -> SmallVec<[f64; 2]> {
        quadratic_roots(a, b, c, 0.0, self.duration)
    }
}

/// The polynomial of the first segment, eq. (4).
pub(super) fn quartic(start: f64, via: ViaPoint, t1: f64) -> Coefficients {
    let RestSegment { rest, c: [a3, a4, _], .. } = RestSegment::leaving(start, via, t1);
    polynomial([rest, 0.0, 0.0, a3, a4])
}

/// The coefficients of the second segment, eq. (6).
pub(super) fn quintic(via: ViaPoint, acceleration: f64, end: f64, t2: f64) -> [f64; 6] {
    let ViaPoint { position, velocity } = via;
    let way = end - position;
    let coasting = acceleration * t2 * t2;
    [
        position,
        velocity,
        0.5 * acceleration,
        (20.0 * way - 12.0 * velocity * t2 - 3.0 * coasting) / (2.0 * t2.powi(3)),
        (-30.0 * way + 16.0 * velocity * t2 + 3.0 * coasting) / (2.0 * t2.powi(4)),
        (12.0 * way - 6.0 * velocity * t2 - coasting) / (2.0 * t2.powi(5)),
    ]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::math::polynomial::evaluate;

    /// Value, rate and second derivative of the two segments where they begin and end.
    fn boundary(start: f64, via: ViaPoint, end: f64, t1: f64, t2: f64) -> [[f64; 3]; 4] {
        let first = quartic(start, via, t1);
        let acceleration = RestSegment::leaving(start, via, t1).final_acceleration();
        let second = quintic(via, acceleration, end, t2);
        [evaluate(&first, 0.0), evaluate(&first, t1), evaluate(&second, 0.0), evaluate(&second, t2)]
    }

    #[test]
    fn meets_all_eleven_conditions() {
        let via = ViaPoint { position: 0.7, velocity: -1.3 };
        let [begin, before, after, finish] = boundary(-0.4, via, 1.9, 0.8, 1.1);
        assert_eq!(begin, [-0.4, 0.0, 0.0]);
        for (got, wanted) in before[..2].iter().chain(&after[..2]).zip([0.7, -1.3, 0.7, -1.3]) {
            assert!((got - wanted).abs() < 1e-14, "{got} for {wanted}");
        }
        assert!((before[2] - after[2]).abs() < 1e-13);
        for (got, wanted) in finish.into_iter().zip([1.9, 0.0, 0.0]) {
            assert!((got - wanted).abs() < 1e-12, "{got} for {wanted}");
        }
    }

    /// The extremes at `count` samples of a polynomial.
    fn sampled(polynomial: &[f64], duration: f64, count: usize) -> Extremes {
        let mut found =
            Extremes { speed: 0.0, acceleration: 0.0, lowest: f64::INFINITY, highest: f64::NEG_INFINITY, travel: 0.0 };
        let mut last = polynomial[0];
        for i in 0..=count {
            let [position, speed, acceleration] = evaluate(polynomial, duration * i as f64 / count as f64);
            found.speed = found.speed.max(speed.abs());
            found.acceleration = found.acceleration.max(acceleration.abs());
            (found.lowest, found.highest) = (found.lowest.min(position), found.highest.max(position));
            found.travel += (position - last).abs();
            last = position;
        }
        found
    }

    fn assert_near(exact: &Extremes, sampled: &Extremes) {
        let pairs = [
            (exact.speed, sampled.speed),
            (exact.acceleration, sampled.acceleration),
            (exact.lowest, sampled.lowest),
            (exact.highest, sampled.highest),
            (exact.travel, sampled.travel),
        ];
        for (exact, sampled) in pairs {
            assert!((exact - sampled).abs() <= 1e-4 * sampled.abs().max(1.0), "{exact:?}, sampled {sampled:?}");
        }
    }

    proptest! {
        #[test]
        fn extremes_are_those_of_many_samples(
            start in -3.0..3.0, position in -3.0..3.0, velocity in -3.0..3.0, end in -3.0..3.0,
            t1 in 0.2..3.0, t2 in 0.2..3.0,
        ) {
            let via = ViaPoint { position, velocity };
            let first = RestSegment::leaving(start, via, t1);
            assert_near(&first.extremes(), &sampled(&quartic(start, via, t1), t1, 5000));
            let acceleration = first.final_acceleration();
            let second = RestSegment::arriving(via, acceleration, end, t2);
            assert_near(&second.extremes(), &sampled(&quintic(via, acceleration, end, t2), t2, 5000));
        }
    }
}
