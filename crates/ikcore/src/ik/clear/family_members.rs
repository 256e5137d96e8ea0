//! Clear members of the families that the branches of a singular pose stand for.
//!
//! At a singular pose a joint is free, as where two axes of a wrist are aligned: the same pose is reached all along a curve,
//! of which the closed form returns one member. Others may be clear where that one is not.

use super::clear_search::ClearSearch;
use crate::closed_form::ArmBranches;
use crate::ik::preference::Preference;
use crate::ik::self_motion::{LONGEST, StepKind, Walk, WrappedLimits};
use crate::ik::whole_turns::bring_near;
use crate::math::vector::distance;
use crate::objective::{Bounds, Point};

/// Evaluations of the forward kinematics along one family: a joint that turns once takes about a hundred.
const EVALUATIONS: usize = 400;

/// Least number of steps before a family may close.
const STEPS: usize = 3;

impl ClearSearch<'_, '_, '_> {
    /// Finds the preferred clear member of the families of singular `branches`, spaced by the steps of a walk along them.
    /// Blocked members are remembered.
    pub(super) fn clear_member(&mut self, preference: &Preference, branches: &ArmBranches) -> Option<Point> {
        if self.is_hopeless() {
            return None;
        }
        let context = self.attempt.context;
        let (robot, bounds, reference) = (context.robot(), context.bounds(), preference.reference());
        let mut clear: Vec<Point> = Vec::new();
        for (q, _) in branches.iter() {
            if !self.attempt.monitor.keep_going() {
                break;
            }
            for mut member in self.members(q) {
                bring_near(robot, bounds, &reference, &mut member);
                let is_solved = is_inside(bounds, &member) && self.attempt.error_if_solved(&member).is_some();
                if is_solved && self.is_clear(&member) {
                    clear.push(member);
                }
            }
        }
        preference.nearest(clear.iter().map(|q| &**q)).map(Point::from_slice)
    }

    /// Members of the family of `q`, limits aside; none if `q` is not on exactly one curve.
    fn members(&mut self, q: &[f64]) -> Vec<Point> {
        let context = self.attempt.context;
        let limits = WrappedLimits::new(context.robot(), context.bounds());
        let most = EVALUATIONS.min(self.attempt.budget.left() / 4);
        let Some(mut walk) = Walk::enter(self.attempt.problem, q, most, LONGEST) else { return Vec::new() };
        let begin = walk.here().clone();
        let mut members = Vec::new();
        if !walk_on(&mut walk, &limits, &mut members) {
            walk.turn_back_at(&begin);
            walk_on(&mut walk, &limits, &mut members);
        }
        self.attempt.budget.evaluations += walk.evaluations();
        members
    }
}

/// Collects the points of a walk until it closes or comes to a corner. Returns whether it closed.
fn walk_on(walk: &mut Walk<'_, '_>, limits: &WrappedLimits<'_>, members: &mut Vec<Point>) -> bool {
    let begin = walk.here().clone();
    let mut count = 0;
    while let Some((from, StepKind::Smooth)) = walk.step() {
        let there = walk.here();
        let length = distance(&there.q, &from.q);
        if limits.slid_out(&there.q) {
            return false;
        }
        count += 1;
        if count > STEPS && there.has_closed_at(&begin, length, limits) {
            return true;
        }
        members.push(there.q.clone());
    }
    false
}

fn is_inside(bounds: &Bounds, q: &[f64]) -> bool {
    bounds.lower().iter().zip(bounds.upper()).zip(q).all(|((lower, upper), q)| lower <= q && q <= upper)
}
