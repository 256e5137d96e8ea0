//! Joint limits up to whole turns, for curves traced without limits.

use std::f64::consts::{PI, TAU};

use smallvec::{SmallVec, smallvec};

use crate::math::MAX_DOF;
use crate::math::hermite::Cubic;
use crate::math::polynomial::roots;
use crate::math::turns::without_turns;
use crate::objective::{Bounds, Point};
use crate::robot::Robot;

/// Joint limits up to whole turns.
pub(in crate::ik) struct WrappedLimits<'a> {
    bounds: &'a Bounds,
    middle: Point,
    /// Whether each joint is periodic by whole turns.
    repeats: SmallVec<[bool; MAX_DOF]>,
}

/// Pieces of a path as pairs of fractions of it.
pub(in crate::ik) type Pieces = SmallVec<[[f64; 2]; 4]>;

impl<'a> WrappedLimits<'a> {
    pub fn new(robot: &Robot, bounds: &'a Bounds) -> Self {
        // Any angle may serve as the middle of a joint without limits.
        let middle = |(lower, upper): (f64, f64)| {
            if lower.is_finite() && upper.is_finite() { 0.5 * (lower + upper) } else { 0.0 }
        };
        let repeats = (0..robot.dof()).map(|j| robot.repeats_every_turn(j)).collect();
        Self { bounds, middle: bounds.ranges().map(middle).collect(), repeats }
    }

    /// Replaces the middle of joints without limits by their `reference` instead of zero.
    pub fn around(mut self, reference: &[f64]) -> Self {
        for ((middle, value), (lower, upper)) in self.middle.iter_mut().zip(reference).zip(self.bounds.ranges()) {
            if !(lower.is_finite() && upper.is_finite()) {
                *middle = *value;
            }
        }
        self
    }

    /// Number of joints.
    pub fn joints(&self) -> usize {
        self.repeats.len()
    }

    /// Whether joint `j` is periodic by whole turns.
    pub fn repeats(&self, j: usize) -> bool {
        self.repeats[j]
    }

    /// Whether a joint that is not periodic is outside its limits.
    pub fn slid_out(&self, q: &[f64]) -> bool {
        (0..q.len()).any(|j| !self.repeats[j] && !self.is_within(j, q[j]))
    }

    /// Difference a - b, whole turns aside.
    pub fn apart(&self, a: &[f64], b: &[f64]) -> Point {
        (0..a.len()).map(|j| self.turned(j, a[j] - b[j])).collect()
    }

    /// Shifts `angle` of joint `j` by whole turns near zero.
    #[inline]
    pub fn turned(&self, j: usize, angle: f64) -> f64 {
        if angle.abs() > PI && self.repeats[j] { without_turns(angle) } else { angle }
    }

    /// Shifts `angle` of joint `j` by whole turns as near as possible to the middle of its limits.
    #[inline]
    pub fn near_middle(&self, j: usize, angle: f64) -> f64 {
        self.middle[j] + self.turned(j, angle - self.middle[j])
    }

    /// Pieces of a short path within the limits. Joints follow the cubics `ways`, which start near their middles.
    pub fn pieces(&self, ways: &[Cubic]) -> Pieces {
        let mut fractions: SmallVec<[f64; 8]> = smallvec![0.0, 1.0];
        // Crossings of the limit of a joint with a range of exactly one turn: both sides are inside, but a turn apart.
        let mut jumps: SmallVec<[f64; 4]> = smallvec![];
        for (j, way) in ways.iter().enumerate() {
            let [low, high] = way.hull();
            let mut is_crossed = false;
            for limit in self.limits_near(j).filter(|limit| low <= *limit && *limit <= high) {
                let [a, b, c, d] = way.coefficients;
                let crossings = roots(&[a - limit, b, c, d], 0.0, 1.0);
                if self.is_one_turn(j) {
                    jumps.extend(crossings.clone());
                }
                fractions.extend(crossings);
                is_crossed = true;
            }
            if !is_crossed && !self.is_within(j, low) {
                return Pieces::new();
            }
        }
        fractions.sort_by(f64::total_cmp);
        let is_inside = |fraction: f64| (0..ways.len()).all(|j| self.is_within(j, ways[j].at(fraction)));
        let mut pieces = Pieces::new();
        for [from, to] in fractions.windows(2).map(|ends| [ends[0], ends[1]]).filter(|[from, to]| from < to) {
            if is_inside(0.5 * (from + to)) {
                // A limit that is only touched, or that a joint with a range of more than one turn passes, does not cut the
                // path.
                match pieces.last_mut() {
                    Some([_, end]) if *end == from && !jumps.contains(&from) => *end = to,
                    _ => pieces.push([from, to]),
                }
            }
        }
        pieces
    }

    fn is_one_turn(&self, j: usize) -> bool {
        self.repeats[j] && (self.bounds.upper()[j] - self.bounds.lower()[j] - TAU).abs() < 1e-9
    }

    /// Limits of joint `j`, and the same limits one turn away.
    fn limits_near(&self, j: usize) -> impl Iterator<Item = f64> {
        let turns = if self.repeats[j] { -1..=1 } else { 0..=0 };
        let (lower, upper) = (self.bounds.lower()[j], self.bounds.upper()[j]);
        turns.flat_map(move |turn: i32| [lower, upper].map(|limit| limit + TAU * f64::from(turn)))
    }

    fn is_within(&self, j: usize, angle: f64) -> bool {
        let angle = self.near_middle(j, angle);
        self.bounds.lower()[j] <= angle && angle <= self.bounds.upper()[j]
    }
}
