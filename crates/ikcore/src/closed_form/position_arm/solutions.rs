//! Solutions of the first three joints at a value of the fourth.

use super::goal::{PositionGoal, Trace};
use super::of_position::PositionArm;
use super::scan::{MOST, ScanSample};
use crate::closed_form::angle::Angle;
use crate::closed_form::angle_range::{AngleRange, may_hold};
use crate::math::vector3::Vector;

/// Value of the fourth joint, and what it makes of two vectors of the arm's basis.
pub struct Fourth {
    turn: Angle,
    basis: [Vector; 2],
}

/// What the solutions of the first three joints begin with.
pub enum ScanFrom<'a> {
    /// The tip, which no joint after the fourth moves.
    OnAxis,
    /// The goal of a point on the last axis, near the tip.
    Near(&'a PositionGoal<'a>),
    /// A turn of the fifth joint.
    Turn(Angle),
}

impl PositionArm {
    pub(super) fn fourth(&self, value: f64) -> Fourth {
        let [x, y, _] = self.basis;
        if self.count < 4 {
            return Fourth { turn: Angle::NONE, basis: [x, y] };
        }
        let (turn, axis) = (Angle::by(value), &self.joints[3].axis);
        Fourth { turn, basis: [turn.about(axis, &x), turn.about(axis, &y)] }
    }

    /// Calls `keep` with each solution at a value of the fourth joint. A tip off the last axis moves with the best turn of the fifth
    /// joint: its solutions are those after one alternation.
    pub(super) fn visit(
        &self,
        goal: &PositionGoal<'_>,
        fourth: &Fourth,
        first: &ScanFrom<'_>,
        mut keep: impl FnMut(ScanSample),
    ) {
        let wrist = |goal: &PositionGoal<'_>, last: Angle| self.wrist(&goal.tip, fourth.turn, last);
        let reached = |goal: &PositionGoal<'_>, last: Angle| {
            self.three.reach(&wrist(goal, last), &goal.position, &[AngleRange::ANY; 3])
        };
        let (sets, admitted) = match first {
            ScanFrom::OnAxis => {
                let sets = self.three.reach(&wrist(goal, Angle::NONE), &goal.position, &goal.ranges);
                for set in sets.iter().filter(|set| may_hold(&goal.ranges, *set)) {
                    let trace = self.trace(goal, set, fourth);
                    let last = if self.count < MOST { Angle::NONE } else { trace.best(&goal.last) };
                    keep(sample(trace.value(last), set, fourth.turn, last));
                }
                return;
            }
            ScanFrom::Near(seen) => (reached(seen, Angle::NONE), &goal.ranges),
            ScanFrom::Turn(turn) => (reached(goal, *turn), &[AngleRange::ANY; 3]),
        };
        for (branch, set) in sets.iter().enumerate().filter(|(_, set)| may_hold(admitted, *set)) {
            let last = self.trace(goal, set, fourth).best(&goal.last);
            let again = reached(goal, last).get(branch).copied().unwrap_or(*set);
            if may_hold(&goal.ranges, &again) {
                keep(sample(self.trace(goal, &again, fourth).value(last), &again, fourth.turn, last));
            }
        }
    }

    /// Trace of the rotation to the goal after the first four joints.
    fn trace(&self, goal: &PositionGoal<'_>, set: &[Angle; 3], fourth: &Fourth) -> Trace {
        let turned = |v: &Vector| (0..3).rev().fold(*v, |v, j| set[j].about(&self.joints[j].axis, &v));
        goal.trace(&turned(&fourth.basis[0]), &turned(&fourth.basis[1]))
    }
}

fn sample(value: f64, [a, b, c]: &[Angle; 3], fourth: Angle, last: Angle) -> ScanSample {
    ScanSample { value, turns: [*a, *b, *c, fourth, last] }
}
