//! Solutions of the first four joints, one of which is given.

use super::given_turn::GivenTurn;
use super::goal::{PositionGoal, Trace};
use super::of_position::PositionArm;
use super::scan::{MOST, ScanSample};
use crate::closed_form::angle::Angle;
use crate::closed_form::angle_range::{AngleRange, may_hold};

/// Treatment of the fifth joint while the first four are solved.
pub enum ScanFrom<'a> {
    /// The tip, which no joint after the fourth moves.
    OnAxis,
    /// The goal of a point on the last axis, near the tip.
    Near(&'a PositionGoal<'a>),
    /// A turn of the fifth joint.
    Turn(Angle),
}

impl PositionArm {
    /// Calls `keep` with each solution for a joint that is given. A tip off the last axis moves with the best turn of the fifth
    /// joint: its solutions are those after one alternation.
    pub(super) fn visit(
        &self,
        goal: &PositionGoal<'_>,
        given: &GivenTurn<'_>,
        first: &ScanFrom<'_>,
        mut keep: impl FnMut(ScanSample),
    ) {
        let ranges = given.ranges(&goal.ranges);
        let reached = |goal: &PositionGoal<'_>, last: Angle| {
            let wrist = if self.count < MOST { goal.tip } else { self.moved(MOST - 1, last, &goal.tip) };
            given.reach(self, &wrist, &goal.position, &[AngleRange::ANY; 3])
        };
        let (sets, admitted) = match first {
            ScanFrom::OnAxis => {
                let sets = given.reach(self, &goal.tip, &goal.position, &ranges);
                for set in sets.iter().filter(|set| given.holds(&goal.inside, set)) {
                    let turns = given.all(set);
                    let trace = self.trace(goal, given, &turns);
                    let last = if self.count < MOST { Angle::NONE } else { trace.best(&goal.last) };
                    keep(sample(trace.value(last), turns, last));
                }
                return;
            }
            ScanFrom::Near(seen) => (reached(seen, Angle::NONE), &ranges),
            ScanFrom::Turn(turn) => (reached(goal, *turn), &[AngleRange::ANY; 3]),
        };
        for (branch, set) in sets.iter().enumerate().filter(|(_, set)| may_hold(admitted, *set)) {
            let last = self.trace(goal, given, &given.all(set)).best(&goal.last);
            let again = reached(goal, last).get(branch).copied().unwrap_or(*set);
            if may_hold(&ranges, &again) {
                let turns = given.all(&again);
                keep(sample(self.trace(goal, given, &turns).value(last), turns, last));
            }
        }
    }

    /// Trace of the rotation to the goal after the first four joints.
    fn trace(&self, goal: &PositionGoal<'_>, given: &GivenTurn<'_>, turns: &[Angle; 4]) -> Trace {
        let [first, second] = given.turned(self, turns);
        goal.trace(&first, &second)
    }
}

fn sample(value: f64, [a, b, c, d]: [Angle; 4], last: Angle) -> ScanSample {
    ScanSample { value, turns: [a, b, c, d, last] }
}
