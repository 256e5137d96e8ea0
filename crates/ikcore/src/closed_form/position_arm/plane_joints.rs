//! Joints two to four about parallel axes: the optima of the orientation at a position, without a scan.
//!
//! The height of the tip along the axes fixes the first joint. In the plane across them, three links reach from the second axis to
//! the goal; the sum of their turns is free, and with the turn of the fifth joint it alone decides the orientation (`turn_pair`). So
//! the best sums are known before the links, two of which then close in closed form. Where limits exclude such a sum, the optimum is
//! at an end of the sums that are left: there a joint is at a limit, or the elbow straight or folded, and two links close as well.

use std::cell::Cell;

use super::goal::PositionGoal;
use super::scan::{MOST, ScanSample};
use super::turn_pair::TurnPair;
use crate::closed_form::angle::Angle;
use crate::closed_form::axis_chain::JointAxis;
use crate::closed_form::structure::{EXACT, Pair};
use crate::closed_form::subproblem::subproblem4;
use crate::math::vector3::{Vector, across, add, dot, sub};

/// Excess of a cosine over 1 that is rounding.
const ROUNDING: f64 = 1e-9;

/// Vector in the plane across the axes.
type Flat = [f64; 2];

/// Second to fourth joint about parallel axes.
#[derive(Debug, Clone)]
pub(super) struct PlaneJoints {
    /// All joints of the arm, four or five.
    all: [JointAxis; MOST],
    count: usize,
    /// Unit vectors across the last axis, and along it.
    last_basis: [Vector; 3],
    /// Unit vectors across the axes, and along them.
    basis: [Vector; 3],
    /// Signs of the three axes along the third vector.
    senses: [f64; 3],
    /// Second axis (m).
    shoulder: Flat,
    /// From the second axis to the third, and from there to the fourth (m).
    links: [Flat; 2],
    /// Turn of the second link, from the zero configuration, that stretches both.
    straight: Angle,
    /// Length (m) below which a lever arm counts as zero.
    floor: f64,
}

/// Three links in the plane, for a value of the first joint.
struct InPlane<'a> {
    joints: &'a PlaneJoints,
    goal: &'a PositionGoal<'a>,
    /// From the fourth axis to the tip, and from the second to the goal (m).
    wrist: Flat,
    to: Flat,
}

/// Number of the solution for the first joint, times two, plus one if the elbow bends to its negative side.
pub(super) type PlaneBranch = usize;

/// Number of these.
pub(super) const PLANE_BRANCHES: usize = 4;

impl PlaneJoints {
    /// Returns `None` unless the second to fourth of `joints` are parallel, not to the first, and apart.
    pub fn new(joints: &[JointAxis; MOST], count: usize, size: f64) -> Option<Self> {
        let pair = |k: usize| Pair::of(&joints[k], &joints[k + 1], size, EXACT);
        if count < 4 || [pair(1), pair(2)] != [Pair::Parallel; 2] || pair(0) == Pair::Parallel {
            return None;
        }
        let basis = across(&joints[1].axis);
        let senses = [1, 2, 3].map(|k| dot(&joints[k].axis, &basis[2]).signum());
        let flat = |v: &Vector| [dot(&basis[0], v), dot(&basis[1], v)];
        let links = [1, 2].map(|k| flat(&sub(&joints[k + 1].point, &joints[k].point)));
        let is_apart = links.iter().all(|link| squared(link).sqrt() > EXACT * size);
        let (shoulder, floor) = (flat(&joints[1].point), 1e-11 * size);
        let straight = towards(&links[1], &links[0]);
        let (all, last_basis) = (*joints, across(&joints[count - 1].axis));
        is_apart.then_some(Self { all, count, last_basis, basis, senses, shoulder, links, straight, floor })
    }

    /// Calls `keep` with each local optimum of the orientation at the position of `goal`, of a tip on the last axis, and with other
    /// configurations where limits cut the sums off. A goal on the first axis has none.
    pub fn visit_optima(&self, goal: &PositionGoal<'_>, mut keep: impl FnMut(ScanSample)) {
        let last = (self.count == MOST).then_some(&goal.last);
        self.visit_places(goal, &goal.tip, |first, place| {
            let wanted = goal.wanted.map(|vector| first.back().about(&self.all[0].axis, &vector));
            let pair = TurnPair::of(&self.basis[2], &self.last_basis, &wanted);
            let mut offer = |[second, third, fourth]: [Angle; 3], sum| {
                let trace = pair.at(sum);
                let fifth = last.map_or(Angle::NONE, |last| trace.best(last));
                keep(ScanSample { value: trace.value(fifth), turns: [first, second, third, fourth, fifth] });
            };
            match last {
                Some(last) => pair.optima(last, |sum| place.with_sum(sum, &mut offer)),
                None => place.with_sum(pair.best_alone(), &mut offer),
            }
            place.at_ends(offer);
        });
    }

    /// Calls `keep` with the least value for this `fifth` turn, and with other configurations where limits cut the sums off, unless
    /// all values are above `most`.
    pub fn visit_best(
        &self,
        goal: &PositionGoal<'_>,
        fifth: Angle,
        most: f64,
        mut keep: impl FnMut(PlaneBranch, ScanSample),
    ) {
        let JointAxis { axis, point, .. } = &self.all[MOST - 1];
        let tip = add(point, &fifth.about(axis, &sub(&goal.tip, point)));
        let [x, y, z] = &self.last_basis;
        let basis = [fifth.about(z, x), fifth.about(z, y), *z];
        let mut side = 0;
        self.visit_places(goal, &tip, |first, place| {
            let wanted = goal.wanted.map(|vector| first.back().about(&self.all[0].axis, &vector));
            let pair = TurnPair::of(&self.basis[2], &basis, &wanted);
            let is_reached = Cell::new(false);
            let mut offer = |[second, third, fourth]: [Angle; 3], sum| {
                let elbow = third.signed(self.senses[1]).and(self.straight.back()).sin < 0.0;
                is_reached.set(true);
                let value = pair.at(sum).value(Angle::NONE);
                keep(side + usize::from(elbow), ScanSample { value, turns: [first, second, third, fourth, fifth] });
            };
            let best = pair.best_alone();
            place.with_sum(best, &mut offer);
            if !is_reached.get() && pair.at(best).value(Angle::NONE) <= most {
                place.at_ends(offer);
            }
            side += 2;
        });
    }

    /// Calls `visit` with the turns of the first joint that bring `tip` to the height of the goal, and what is left in the plane.
    fn visit_places(&self, goal: &PositionGoal<'_>, tip: &Vector, mut visit: impl FnMut(Angle, &InPlane<'_>)) {
        let JointAxis { axis, point, .. } = &self.all[0];
        let along = &self.basis[2];
        let away = sub(&goal.position, point);
        let turns_back = subproblem4(along, axis, &away, dot(along, &sub(tip, point)), self.floor);
        if turns_back.free {
            return;
        }
        let wrist = self.flat(&sub(tip, &self.all[3].point));
        for back in turns_back.iter().filter(|back| goal.inside[0].holds(back.back())) {
            let seen = self.flat(&add(point, &back.about(axis, &away)));
            visit(back.back(), &InPlane { joints: self, goal, wrist, to: minus(&seen, &self.shoulder) });
        }
    }

    fn flat(&self, v: &Vector) -> Flat {
        [dot(&self.basis[0], v), dot(&self.basis[1], v)]
    }
}

impl InPlane<'_> {
    /// Calls `keep` with the turns of the three joints of this `sum`, inside the limits.
    fn with_sum(&self, sum: Angle, mut keep: impl FnMut([Angle; 3], Angle)) {
        let [upper, fore] = &self.joints.links;
        let to = minus(&self.to, &turned(sum, &self.wrist));
        two_links(upper, fore, &to, |first, both| self.offer([first, both, sum], &mut keep));
    }

    /// Calls `keep` with the turns of the three joints where one is at a limit, or the elbow straight or folded, and their sum.
    fn at_ends(&self, mut keep: impl FnMut([Angle; 3], Angle)) {
        let [upper, fore] = &self.joints.links;
        for first in self.limits(0) {
            let to = minus(&self.to, &turned(first, upper));
            two_links(fore, &self.wrist, &to, |both, all| self.offer([first, both, all], &mut keep));
        }
        let straight = self.joints.straight;
        for elbow in self.limits(1).chain([straight, straight.opposite()]) {
            let arm = plus(upper, &turned(elbow, fore));
            two_links(&arm, &self.wrist, &self.to, |first, all| {
                self.offer([first, first.and(elbow), all], &mut keep);
            });
        }
        for bend in self.limits(2) {
            let hand = plus(fore, &turned(bend, &self.wrist));
            two_links(upper, &hand, &self.to, |first, both| self.offer([first, both, both.and(bend)], &mut keep));
        }
    }

    /// Calls `keep` with the turns of the joints, if inside the limits: `links` turn by one, two and three of them.
    fn offer(&self, [first, both, all]: [Angle; 3], keep: &mut impl FnMut([Angle; 3], Angle)) {
        let turns = [first, both.and(first.back()), all.and(both.back())];
        let turns: [Angle; 3] = std::array::from_fn(|k| turns[k].signed(self.joints.senses[k]));
        if turns.iter().zip(&self.goal.inside[1..]).all(|(turn, range)| range.holds(*turn)) {
            keep(turns, all);
        }
    }

    /// Limits of the joint `k` of the three, as turns of its link.
    fn limits(&self, k: usize) -> impl Iterator<Item = Angle> + use<> {
        let (range, sense) = (self.goal.inside[k + 1], self.joints.senses[k]);
        range.ends.into_iter().filter(move |_| range.is_limited()).map(move |limit| limit.signed(sense))
    }
}

/// Calls `keep` with the turns of two links that reach `to` one after the other; none of a link without length.
fn two_links(first: &Flat, second: &Flat, to: &Flat, mut keep: impl FnMut(Angle, Angle)) {
    let [a, b, reach] = [first, second, to].map(squared);
    let product = (a * b).sqrt();
    let cos = 0.5 * (reach - a - b) / product;
    // Written so that what is no number has no solution.
    if !(cos.abs() <= 1.0 + ROUNDING) {
        return;
    }
    let cos = cos.clamp(-1.0, 1.0);
    let sin = (1.0 - cos * cos).sqrt();
    let between = towards(second, first);
    for bend in [Angle { cos, sin }.and(between), Angle { cos, sin: -sin }.and(between)] {
        let turn = towards(&plus(first, &turned(bend, second)), to);
        keep(turn, turn.and(bend));
    }
}

/// Turn from one vector to the other.
fn towards([x, y]: &Flat, [a, b]: &Flat) -> Angle {
    Angle::towards(x * a + y * b, x * b - y * a)
}

fn turned(turn: Angle, [x, y]: &Flat) -> Flat {
    [turn.cos * x - turn.sin * y, turn.sin * x + turn.cos * y]
}

fn plus(a: &Flat, b: &Flat) -> Flat {
    [a[0] + b[0], a[1] + b[1]]
}

fn minus(a: &Flat, b: &Flat) -> Flat {
    [a[0] - b[0], a[1] - b[1]]
}

fn squared([x, y]: &Flat) -> f64 {
    x * x + y * y
}
