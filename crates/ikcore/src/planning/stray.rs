//! How far the tip strays from its course.

use super::course::Course;
use super::plan::Violation;
use crate::math::MAX_DOF;
use crate::math::so3::{norm, rotation_between};
use crate::robot::Robot;
use crate::task::Target;

/// Looks in each stretch between two knots; the largest value is then looked for between the neighbours of its best.
const LOOKS: usize = 10;

/// Cuts of that neighbourhood, each of which leaves two thirds.
const CUTS: usize = 8;

/// Joint positions as a function of the share of the course that lies behind.
pub trait Configurations: Fn(f64, &mut [f64]) {}
impl<F: Fn(f64, &mut [f64])> Configurations for F {}

/// How far the tip of a robot that follows these configurations is from its course.
pub struct Stray<'a, C> {
    /// The robot.
    pub robot: &'a Robot,
    /// Where its tip should be.
    pub course: &'a Course,
    /// Where its joints are.
    pub configurations: C,
}

/// The largest value of something, and at which share of the course.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Largest {
    /// The value.
    pub value: f64,
    /// Share of the course.
    pub share: f64,
}

impl Largest {
    fn or_larger(self, other: Self) -> Self {
        if other.value > self.value { other } else { self }
    }
}

/// How far the tip strays at the most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Farthest {
    /// Distance from the course (m).
    pub distance: Largest,
    /// Angle between the tip's rotation and the wanted one (rad); 0 where none is wanted.
    pub angle: Largest,
}

impl Farthest {
    /// What is broken where the tip is to stay within `accuracy` (m, rad).
    pub fn violations(&self, course: &Course, accuracy: f64) -> impl Iterator<Item = Violation> {
        let of = |quantity: &str, largest: Largest, unit: &'static str| {
            let what = format!("{quantity} of the tip from {}", course.place(largest.share));
            let broken = largest.value > accuracy;
            broken.then(|| Violation { what, value: largest.value, bound: accuracy, unit: unit.into() })
        };
        [of("distance", self.distance, "m"), of("turn", self.angle, "rad")].into_iter().flatten()
    }
}

impl<C: Configurations> Stray<'_, C> {
    /// How far the tip strays at the most between the first and the last of `knots`.
    pub fn farthest(&self, knots: &[f64]) -> Farthest {
        let distance = |share: f64, from: f64, to: f64| self.distance(share, from, to);
        let angle = |share: f64, _: f64, _: f64| self.angle(share);
        Farthest { distance: largest(knots, distance), angle: largest(knots, angle) }
    }

    /// The larger of distance (m) and angle (rad) at a share of the course.
    pub fn at(&self, share: f64) -> f64 {
        self.distance(share, share, share).max(self.angle(share))
    }

    /// The larger of the distance (m) from the very place that is due at this share of the course and the angle (rad): no
    /// less than [`at`](Self::at), and quick.
    pub fn at_most(&self, share: f64) -> f64 {
        let mut q = [0.0; MAX_DOF];
        let q = &mut q[..self.robot.dof()];
        (self.configurations)(share, q);
        let target = self.course.target(share);
        let (tip, due) = (self.robot.tip_position(q), target.position().unwrap_or_default());
        let distance = norm(&std::array::from_fn(|k| tip[k] - due[k]));
        match target {
            Target::Pose(due) => distance.max(norm(&rotation_between(&due, &self.robot.tip(q)))),
            _ => distance,
        }
    }

    /// The larger of distance (m) and angle (rad) at `looks` places between two shares of the course.
    pub fn between(&self, from: f64, to: f64, looks: usize) -> f64 {
        let at = |i: usize| from + (to - from) * i as f64 / (looks + 1) as f64;
        let off = |share: f64| self.distance(share, from, to).max(self.angle(share));
        (1..=looks).map(|i| off(at(i))).fold(0.0, f64::max)
    }

    /// From the course near `share`, up to one stretch before and after it: what counts is where the tip goes, not when.
    fn distance(&self, share: f64, from: f64, to: f64) -> f64 {
        let mut q = [0.0; MAX_DOF];
        let q = &mut q[..self.robot.dof()];
        (self.configurations)(share, q);
        let length = to - from;
        self.course.distance(self.robot.tip_position(q), from - length, to + length)
    }

    fn angle(&self, share: f64) -> f64 {
        let Target::Pose(wanted) = self.course.target(share) else { return 0.0 };
        let mut q = [0.0; MAX_DOF];
        let q = &mut q[..self.robot.dof()];
        (self.configurations)(share, q);
        norm(&rotation_between(&wanted, &self.robot.tip(q)))
    }
}

/// The largest `value` of (share, stretch from, stretch to) over all stretches between `knots`, their ends included.
fn largest(knots: &[f64], value: impl Fn(f64, f64, f64) -> f64) -> Largest {
    let none = Largest { value: -1.0, share: 0.0 };
    knots.windows(2).fold(none, |largest, ends| {
        let [from, to] = [ends[0], ends[1]];
        peak(from, to, |share| value(share, from, to)).or_larger(largest)
    })
}

/// The largest value between two shares of the course.
fn peak(from: f64, to: f64, value: impl Fn(f64) -> f64) -> Largest {
    let step = (to - from) / LOOKS as f64;
    let at = |share: f64| Largest { value: value(share), share };
    let best = (1..=LOOKS).map(|i| at(from + step * i as f64)).fold(at(from), Largest::or_larger);
    let [mut lower, mut upper] = [(best.share - step).max(from), (best.share + step).min(to)];
    for _ in 0..CUTS {
        let third = (upper - lower) / 3.0;
        if value(lower + third) > value(upper - third) {
            upper -= third;
        } else {
            lower += third;
        }
    }
    at(0.5 * (lower + upper)).or_larger(best)
}
