//! All solutions of a pose by the closed form of the arm.

use super::attempt::Attempt;
use super::solution::Solution;
use super::whole_turns::bring_near;
use crate::closed_form::ArmBranches;
use crate::objective::Point;
use crate::solver::{LevenbergMarquardt, MultiStart, Status};
use crate::task::Target;

/// A joint that is outside its limits by less (rad, m) is at its limit: rounding.
const AT_LIMIT: f64 = 1e-9;

/// Solutions nearer to each other in every joint (rad, m) are one.
const SAME: f64 = 1e-6;

/// What the closed form yields for one target.
pub(super) struct AllBranches {
    pub solutions: Vec<Solution>,
    /// The nearest configuration, where it is proven that no solution exists inside the limits.
    pub miss: Option<Solution>,
    /// No solution inside the limits is missing, whole turns aside.
    pub complete: bool,
    /// One solution at least stands for a family, in which a joint is free.
    pub singular: bool,
}

/// The solutions at the whole turns nearest to `reference`; of a redundant arm those at `redundancy` values of its parameter. None
/// where the closed form does not apply, or leaves open whether there are any.
pub(super) fn all_branches(attempt: &mut Attempt<'_, '_>, reference: &[f64], redundancy: usize) -> Option<AllBranches> {
    let target = attempt.problem.target();
    let Target::Pose(pose) = target else { return None };
    let MultiStart { solver: descent, .. } = attempt.context.solver().restarted_descent()?;
    if !attempt.context.asks_for_pose_alone(target) {
        return None;
    }
    let context = attempt.context;
    let mut found = AllBranches { solutions: vec![], miss: None, complete: true, singular: false };
    let mut configurations = 0;
    if let Some(family) = context.robot().family(pose) {
        let arcs = family.arcs(context.bounds().lower(), context.bounds().upper());
        // Outside the arcs there is none: without arcs the pose is out of reach.
        found.complete = arcs.is_empty();
        for value in arcs.spread(redundancy) {
            found.take(attempt, &descent, reference, &family.branches_at(value));
        }
    } else {
        let branches = context.robot().branches(pose)?;
        found.complete = branches.complete;
        configurations = branches.len();
        found.take(attempt, &descent, reference, &branches);
    }
    if !found.solutions.is_empty() {
        return Some(found);
    }
    found.complete.then(|| found.proven_miss(attempt, &descent, reference, configurations))
}

impl AllBranches {
    /// Adds the branches that are inside the limits.
    fn take(
        &mut self,
        attempt: &mut Attempt<'_, '_>,
        descent: &LevenbergMarquardt,
        reference: &[f64],
        branches: &ArmBranches,
    ) {
        attempt.budget.evaluations += branches.evaluations;
        self.singular |= branches.singular;
        let known = self.solutions.len();
        for q in branches.iter() {
            self.add(attempt, descent, reference, q, known);
        }
    }

    /// Adds a branch if it is inside the limits. Of a family that is outside with its representative, another member may be
    /// inside: a descent looks for it. Solutions before number `first` are others.
    fn add(
        &mut self,
        attempt: &mut Attempt<'_, '_>,
        descent: &LevenbergMarquardt,
        reference: &[f64],
        q: &[f64],
        first: usize,
    ) {
        let (robot, bounds) = (attempt.context.robot(), attempt.context.bounds());
        let mut near = Point::from_slice(q);
        bring_near(robot, bounds, reference, &mut near);
        let mut clipped = near.clone();
        bounds.clip(&mut clipped);
        let inside = near.iter().zip(&clipped).all(|(near, clipped)| (near - clipped).abs() <= AT_LIMIT);
        if !inside && !self.singular {
            return;
        }
        attempt.budget.evaluations += 1;
        let mut solved = inside && attempt.problem.assess(&clipped).score.solved;
        if !solved {
            // Outside, or the tolerances asked for are tighter than rounding allows the closed form.
            self.complete = false;
            (solved, clipped) = attempt.descend(descent, clipped);
        }
        let known = |other: &Solution| other.q.iter().zip(&clipped).all(|(a, b)| (a - b).abs() < SAME);
        if solved && !self.solutions[first..].iter().any(known) {
            self.solutions.push(attempt.solution(Status::Solved, clipped));
        }
    }

    /// The nearest configuration to a target without a solution; one at the very edge of the reach may meet the tolerances.
    fn proven_miss(
        mut self,
        attempt: &mut Attempt<'_, '_>,
        descent: &LevenbergMarquardt,
        reference: &[f64],
        configurations: usize,
    ) -> Self {
        let q = attempt.approach(descent, reference);
        if attempt.problem.assess(&q).score.solved {
            self.complete = false;
            self.solutions.push(attempt.solution(Status::Solved, q));
            return self;
        }
        let beyond = attempt.problem.beyond_reach(attempt.context.bounds());
        let obstruction = match (configurations, beyond) {
            (0, Some(beyond)) => beyond.to_string(),
            (0, None) => "no configuration has this pose".into(),
            (1, _) => "its one solution is outside the limits".into(),
            (count, _) => format!("all {count} solutions are outside the limits"),
        };
        self.miss = Some(Solution { obstruction, ..attempt.solution(Status::OutOfReach, q) });
        self
    }
}
