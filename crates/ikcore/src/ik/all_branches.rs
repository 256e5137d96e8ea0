//! All solutions of a pose by the closed form of the arm.

use super::attempt::{APPROACHES, Attempt};
use super::out_of_reach::{ended, is_wide, obstruction};
use super::preference::Preference;
use super::solution::Solution;
use super::solutions::Solutions;
use super::whole_turns::NearestTurns;
use crate::closed_form::{ArmBranches, BranchError, FamilyLimits, MOST_JOINTS, PoseFamily, VERIFIED};
use crate::math::Frame;
use crate::objective::Point;
use crate::solver::{LevenbergMarquardt, MultiStart};
use crate::task::{Target, TipError};

/// A joint that is outside its limits by less (rad, m) is at its limit: rounding.
const AT_LIMIT: f64 = 1e-9;

/// Solutions nearer to each other in every joint (rad, m) are one.
const SAME: f64 = 1e-6;

/// A branch that is outside its limits by less (rad, m) may reach the pose within tolerances from inside them.
const NEAR_LIMIT: f64 = 1e-4;

/// How many times more values of the parameter are tried where none has a solution.
const FINER: usize = 4;

/// Visits to configurations between two looks at the monitor.
const VISITS_BETWEEN_LOOKS: usize = 32;

/// What the closed form yields for one target.
pub(super) struct AllBranches {
    pub solutions: Solutions,
    /// Why there is none, where that is proven.
    pub obstruction: Option<String>,
    /// No solution inside the limits is missing, whole turns aside.
    pub complete: bool,
    /// One solution at least stands for a family, in which a joint is free.
    pub singular: bool,
    /// The monitor asked to stop.
    pub interrupted: bool,
}

/// The solutions at the whole turns nearest to `reference`; of a redundant arm those at `redundancy` values of its parameter. None
/// where the closed form does not apply, or leaves open whether there are any.
pub(super) fn all_branches(attempt: &mut Attempt<'_, '_>, reference: &[f64], redundancy: usize) -> Option<AllBranches> {
    let (target @ Target::Pose(pose), criterion) = attempt.problem.only_target()? else { return None };
    let tolerance = criterion.tolerance;
    let MultiStart { solver: descent, .. } = attempt.context.solver().restarted_descent()?;
    if !attempt.context.asks_for_pose_alone(target) {
        return None;
    }
    let context = attempt.context;
    let (robot, bounds) = (context.robot(), context.bounds());
    let mut taker = Taker {
        turns: NearestTurns::new(robot, bounds, reference),
        descent,
        verified_is_solved: tolerance.position.min(tolerance.rotation) >= VERIFIED,
        nearly: is_wide(attempt),
        found: AllBranches {
            solutions: Solutions::new(robot.dof()),
            obstruction: None,
            complete: true,
            singular: false,
            interrupted: false,
        },
        attempt,
    };
    let count = match robot.family(pose) {
        Some(_) if redundancy == 0 => return None,
        Some(family) => {
            taker.sample(&family, redundancy);
            None
        }
        None => Some(taker.take_all(pose)?),
    };
    let mut found = taker.found;
    if found.solutions.is_empty() {
        found.obstruction = found.complete.then(|| obstruction(attempt, count));
        // The search goes on from what is left open.
        found.obstruction.as_ref()?;
    }
    Some(found)
}

/// The one of them nearest to the reference of `preference`, or a configuration near the target where there is none for certain; None
/// where that is left open.
#[cold]
pub(super) fn nearest_of_all_branches(
    attempt: &mut Attempt<'_, '_>,
    preference: &Preference,
    start: Option<&[f64]>,
) -> Option<Solution> {
    // Of a redundant arm only whether there are any: a single value of its parameter tells.
    let all = all_branches(attempt, &preference.reference(), 1)?;
    if let Some(q) = preference.nearest(all.solutions.iter().map(|solution| solution.q)) {
        return attempt.solved_at(Point::from_slice(q));
    }
    let obstruction = all.obstruction?;
    let from = attempt.first_start(start);
    Some(ended(attempt, from, obstruction))
}

/// Takes the branches that are inside the limits.
struct Taker<'a, 'm, 'p> {
    attempt: &'a mut Attempt<'m, 'p>,
    turns: NearestTurns<'a>,
    descent: LevenbergMarquardt,
    /// The tolerances are no tighter than those by which branches are verified.
    verified_is_solved: bool,
    /// The tolerances may be met although no branch is inside the limits.
    nearly: bool,
    found: AllBranches,
}

impl Taker<'_, '_, '_> {
    /// Takes those of a redundant arm at `count` values of its parameter, or at more where none of them has a solution.
    fn sample(&mut self, family: &PoseFamily<'_>, count: usize) {
        let [lower, upper] = self.attempt.context.sampling_ranges();
        let limits = family.limits(lower, upper);
        let arcs = family.arcs(&limits);
        // Outside the arcs there is none: without arcs the pose is out of reach, though not of wide tolerances.
        self.found.complete = arcs.is_empty() && !self.nearly;
        for finer in [1, FINER, FINER * FINER] {
            self.take_values(family, &limits, arcs.spread(count.saturating_mul(finer)));
            if !self.found.solutions.is_empty() || self.found.interrupted || self.found.complete {
                return;
            }
            if finer == 1 && family.is_excluded(&limits, &arcs) && !self.nearly {
                self.found.complete = true;
                return;
            }
        }
        if let Some(values) = family.decisive(&limits) {
            self.take_values(family, &limits, values.into_iter());
            self.found.complete = self.found.solutions.is_empty() && !self.found.interrupted && !self.nearly;
        }
    }

    fn take_values(&mut self, family: &PoseFamily<'_>, limits: &FamilyLimits, values: impl Iterator<Item = f64>) {
        let mut looks = 0;
        family.visit_within(limits, values, |branches| {
            self.attempt.budget.evaluations += branches.evaluations;
            self.found.singular |= branches.singular;
            for (q, error) in branches.iter() {
                self.take_inside(q, error);
            }
            looks += 1;
            self.found.interrupted = looks % VISITS_BETWEEN_LOOKS == 0 && !self.attempt.monitor.keep_going();
            !self.found.interrupted
        });
    }

    /// Takes those of an arm that is not redundant. Returns how many there are, limits aside; None without a closed form.
    fn take_all(&mut self, pose: &Frame) -> Option<usize> {
        let branches = self.attempt.context.robot().branches(pose)?;
        self.take_branches(&branches);
        self.nearly |= branches.nearly;
        if self.found.solutions.is_empty() && self.found.complete && self.nearly {
            self.take_beside();
        }
        Some(branches.len())
    }

    fn take_branches(&mut self, branches: &ArmBranches) {
        self.attempt.budget.evaluations += branches.evaluations;
        self.found.complete &= branches.complete;
        self.found.singular |= branches.singular;
        for (q, error) in branches.iter() {
            // Of a family that is outside with its representative, another member may be inside.
            if !self.take_inside(q, error) && branches.singular {
                self.take_beyond(q);
            }
        }
    }

    /// Takes a branch if it is inside the limits.
    #[inline]
    fn take_inside(&mut self, q: &[f64], error: BranchError) -> bool {
        let mut near = [0.0; MOST_JOINTS];
        let near = &mut near[..q.len()];
        for ((joint, value), placed) in self.turns.joints().iter().zip(q).zip(near.iter_mut()) {
            let value = joint.nearest(*value);
            let outside = (joint.lower - value).max(value - joint.upper);
            if outside > AT_LIMIT {
                self.nearly |= outside < NEAR_LIMIT;
                return false;
            }
            *placed = value.clamp(joint.lower, joint.upper);
        }
        if self.verified_is_solved {
            let BranchError { position, rotation } = error;
            self.found.solutions.push(near, TipError { position, rotation });
        } else {
            // The tolerances asked for may be tighter than rounding allows the closed form.
            self.take_beyond(near);
        }
        true
    }

    /// Takes the branches of a pose that is within the tolerances, where the pose itself has none inside the limits: it is at the
    /// edge of the reach, or beside what an arm with few joints can reach.
    #[cold]
    fn take_beside(&mut self) {
        let q = self.attempt.approach(&self.descent, self.turns.reference(), APPROACHES);
        if !self.attempt.problem.assess(&q).score.solved {
            return;
        }
        self.found.complete = false;
        let context = self.attempt.context;
        let reached = context.robot().tip(&q);
        let branches = context.robot().branches(&reached);
        for (q, _) in branches.iter().flat_map(ArmBranches::iter) {
            self.take_beyond(q);
        }
        if self.found.solutions.is_empty() {
            self.found.solutions.push(&q, self.attempt.problem.assess(&q).error.into());
        }
    }

    /// Takes the solution that a descent from `q` finds.
    #[cold]
    fn take_beyond(&mut self, q: &[f64]) {
        self.found.complete = false;
        let mut near = Point::from_slice(q);
        self.turns.bring_near(&mut near);
        let bounds = self.attempt.context.bounds();
        bounds.clip(&mut near);
        let q = self.attempt.descend_beyond(&self.descent, near, VERIFIED, bounds);
        let assessment = self.attempt.problem.assess(&q);
        let known = |other: &[f64]| other.iter().zip(&q).all(|(a, b)| (a - b).abs() < SAME);
        if assessment.score.solved && !self.found.solutions.iter().any(|other| known(other.q)) {
            self.found.solutions.push(&q, assessment.error.into());
        }
    }
}
