//! PositionGoal of one query, and how near a turn of the last joint comes to its orientation.

use crate::closed_form::angle::Angle;
use crate::closed_form::angle_range::AngleRange;
use crate::closed_form::branches::MOST_JOINTS;
use crate::math::Frame;
use crate::math::arithmetic::Baseline;
use crate::math::vector3::{Vector, cross, dot, sub};

/// Rounding of the cosine between two angles.
const ROUNDING: f64 = 1e-6;

/// PositionGoal of one query, in the frame of the first link.
pub struct PositionGoal<'a> {
    /// Target position (m).
    pub position: Vector,
    /// Rotation from the zero configuration to the target orientation.
    pub turned: Frame,
    /// Images of the arm's basis by it.
    pub wanted: [Vector; 3],
    /// Tip in the zero configuration (m).
    pub tip: Vector,
    /// Limits of the axes (rad).
    pub limits: &'a [[f64; 2]; MOST_JOINTS],
    /// Ranges of the first four axes, wider than their limits.
    pub ranges: [AngleRange; 4],
    /// The same up to rounding.
    pub inside: [TurnRange; 4],
    /// Range of the fifth axis.
    pub last: TurnRange,
}

/// Trace of the rotation between the tip and the goal: a constant, and the parts along cosine and sine of the last turn.
#[derive(Debug, Clone, Copy)]
pub struct Trace {
    pub constant: f64,
    pub cosine: f64,
    pub sine: f64,
}

/// Angles modulo 2 pi between two limits.
#[derive(Debug, Clone, Copy)]
pub struct TurnRange {
    /// Limits; of a whole turn, no rotation.
    pub ends: [Angle; 2],
    middle: Angle,
    /// Least cosine of the angle to the middle.
    least: f64,
}

impl PositionGoal<'_> {
    /// PositionGoal for the point `on_axis` of the last axis instead of the tip: where it is if the tip has the goal's pose.
    pub fn seen_from(&self, on_axis: Vector) -> Self {
        let off = self.turned.turn::<Baseline>(&sub(&self.tip, &on_axis));
        Self { position: sub(&self.position, &off), tip: on_axis, ..*self }
    }

    /// Trace for the tip whose basis is carried to `first`, `second` and their cross product, the axis of the last turn.
    #[inline]
    pub fn trace(&self, first: &Vector, second: &Vector) -> Trace {
        let [k1, k2, axis] = &self.wanted;
        Trace {
            constant: dot(axis, &cross(first, second)),
            cosine: dot(k1, first) + dot(k2, second),
            sine: dot(k1, second) - dot(k2, first),
        }
    }
}

impl Trace {
    /// Value 1 - cos of the angle to the goal's orientation after the last turn.
    #[inline]
    pub fn value(&self, turn: Angle) -> f64 {
        0.5 * (3.0 - self.constant - self.cosine * turn.cos - self.sine * turn.sin)
    }

    /// Last turn in `range` with the least value.
    #[inline]
    pub fn best(&self, range: &TurnRange) -> Angle {
        let best = Angle::towards(self.cosine, self.sine);
        if range.holds(best) {
            return best;
        }
        let [lower, upper] = range.ends;
        if self.value(lower) <= self.value(upper) { lower } else { upper }
    }
}

impl TurnRange {
    /// Least cosine of a whole turn, which no cosine is below.
    const WHOLE: f64 = -2.0;

    /// Whether some turns are outside.
    pub fn is_limited(&self) -> bool {
        self.least > Self::WHOLE
    }

    /// Range between these limits (rad).
    pub fn of([lower, upper]: [f64; 2]) -> Self {
        let half = 0.5 * (upper - lower);
        if half < std::f64::consts::PI {
            let least = half.cos() - ROUNDING;
            Self { ends: [Angle::by(lower), Angle::by(upper)], middle: Angle::by(lower + half), least }
        } else {
            Self { ends: [Angle::NONE; 2], middle: Angle::NONE, least: Self::WHOLE }
        }
    }

    /// Whether `turn` is inside, up to rounding.
    #[inline]
    pub fn holds(&self, turn: Angle) -> bool {
        self.middle.cos * turn.cos + self.middle.sin * turn.sin >= self.least
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng;

    #[test]
    fn the_best_turn_is_the_best_of_many_inside_the_range() {
        let mut rng = rng::stream(8, 0);
        for draw in 0..300 {
            let mut entry = || rng.uniform_in(-1.0, 1.0);
            let trace = Trace { constant: entry(), cosine: entry(), sine: entry() };
            // Ranges of round numbers, of a point, and beyond a turn as well.
            let (lower, width) = ([-1.0, 0.0, 2.0, -3.0][draw % 4] + entry(), [0.0, 0.5, 3.0, 6.0, 7.0][draw % 5]);
            let best = trace.value(trace.best(&TurnRange::of([lower, lower + width])));
            let values = (0..=400).map(|k| trace.value(Angle::by(lower + width * f64::from(k) / 400.0)));
            let least = values.fold(f64::INFINITY, f64::min);
            assert!(best <= least + 1e-12, "{trace:?} between {lower} and {}", lower + width);
            assert!(best >= least - 1e-3, "{trace:?} between {lower} and {}", lower + width);
        }
    }
}
