//! All solutions of a pose by the closed form of the arm.

use std::f64::consts::TAU;

use super::attempt::{APPROACHES, Attempt};
use super::out_of_reach::{is_wide, obstruction, unreachable_result};
use super::preference::{AT_LIMIT, Preference};
use super::solution::Solution;
use super::solutions::Solutions;
use super::weak_direction::WeakDirection;
use super::whole_turns::NearestTurns;
use crate::closed_form::{
    ArmBranches, BranchFit, Doubt, FamilyLimits, MOST_JOINTS, MOVED_BY_POLISHING, PoseFamily, VERIFIED,
};
use crate::math::Frame;
use crate::math::comparison::larger;
use crate::math::vector::largest_difference;
use crate::objective::Point;
use crate::solver::{LevenbergMarquardt, MultiStart};
use crate::task::{Target, TipError, Tolerance};

/// Largest joint difference (rad, m) at which two solutions count as one.
const SAME: f64 = 1e-6;

/// Largest excess over the limits (rad, m) of a branch that may reach the pose within tolerances from inside them.
const NEAR_LIMIT: f64 = 1e-4;

/// Tolerance (m, rad) below which rounding dominates.
const LEAST_TOLERANCE: f64 = 1e-9;

/// Change of the pose, in tolerances per rad or m, below which a direction is practically free.
const ALMOST_FREE: f64 = 1.0;

/// Change of the pose, in tolerances per rad or m, above which a branch is far from singular: the tolerances admit no
/// configuration more than about a milliradian or millimetre away from it.
const FAR_FROM_FREE: f64 = 1e3;

/// Change of the pose, in tolerances, up to which moving a branch inside its limits may still meet the target.
const FIRMLY_OUTSIDE: f64 = 10.0;

/// Number of steps to each side in the line search along the nearly free direction of a branch.
const TRIED_ALONG: usize = 32;
/// Number of halvings of the step afterwards.
const HALVINGS_ALONG: usize = 30;

/// Descents from scattered starts where the closed form may lack solutions.
const SCATTERED: usize = 32;

/// Factor on the number of parameter values where none has a solution.
const FINER: usize = 4;

/// Configurations visited between two polls of the monitor.
const VISITS_BETWEEN_LOOKS: usize = 32;

/// Result of the closed form for one target.
pub(super) struct AllBranches {
    pub solutions: Solutions,
    /// Reason for having no solution, if that is proven.
    pub obstruction: Option<String>,
    /// Whether no solution inside the limits is missing, whole turns aside.
    pub complete: bool,
    /// Whether a solution represents a family in which a joint is free.
    pub singular: bool,
    /// Whether the monitor asked to stop.
    pub interrupted: bool,
}

/// Returns the solutions at the whole turns nearest to `reference`; for a redundant arm, those at `redundancy` values of its
/// parameter. `None` if the closed form does not apply, or cannot decide whether there are any.
pub(super) fn all_branches(attempt: &mut Attempt<'_, '_>, reference: &[f64], redundancy: usize) -> Option<AllBranches> {
    let (target @ Target::Pose(pose), criterion) = attempt.problem.only_target()? else { return None };
    let tolerance = criterion.tolerance;
    let MultiStart { solver: descent, .. } = attempt.context.solver().restarted_descent()?;
    if !attempt.context.asks_for_pose_alone(target) {
        return None;
    }
    let context = attempt.context;
    let (robot, bounds) = (context.robot(), context.bounds());
    let mut collector = BranchCollector {
        turns: NearestTurns::new(robot, bounds, reference),
        descent,
        verified_is_solved: tolerance.position.min(tolerance.rotation) >= VERIFIED,
        widest: tolerance.position.max(tolerance.rotation).max(LEAST_TOLERANCE),
        may_reach_by_tolerance: is_wide(attempt),
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
            collector.sample(&family, redundancy);
            None
        }
        None => Some(collector.take_all(pose)?),
    };
    let mut found = collector.found;
    found.complete &= robot.proves_branches();
    if found.solutions.is_empty() {
        found.obstruction = found.complete.then(|| obstruction(attempt, count));
        // A search continues if nothing is proven.
        found.obstruction.as_ref()?;
    }
    Some(found)
}

/// Returns the solution nearest to the reference of `preference` or, if there is certainly none, a configuration near the
/// target; `None` if the closed form leaves that open.
#[cold]
pub(super) fn nearest_of_all_branches(
    attempt: &mut Attempt<'_, '_>,
    preference: &Preference,
    start: Option<&[f64]>,
) -> Option<Solution> {
    // For a redundant arm, a single value of its parameter decides whether there are any solutions.
    let all = all_branches(attempt, &preference.reference(), 1)?;
    if let Some(q) = preference.nearest(all.solutions.iter().map(|solution| solution.q)) {
        return attempt.solved_at(Point::from_slice(q));
    }
    let obstruction = all.obstruction?;
    let from = attempt.first_start(start);
    Some(unreachable_result(attempt, from, obstruction))
}

/// Collector of the branches inside the limits.
struct BranchCollector<'a, 'm, 'p> {
    attempt: &'a mut Attempt<'m, 'p>,
    turns: NearestTurns<'a>,
    descent: LevenbergMarquardt,
    /// Whether the tolerances are no tighter than the verification of branches.
    verified_is_solved: bool,
    /// Larger tolerance (m, rad).
    widest: f64,
    /// Whether the tolerances may be met although no branch is inside the limits.
    may_reach_by_tolerance: bool,
    found: AllBranches,
}

impl BranchCollector<'_, '_, '_> {
    /// Takes the solutions of a redundant arm at `count` values of its parameter, or at more values if there is none.
    fn sample(&mut self, family: &PoseFamily<'_>, count: usize) {
        let [lower, upper] = self.attempt.context.sampling_ranges();
        let limits = family.limits(lower, upper);
        let arcs = family.arcs(&limits);
        // Outside the arcs there is no solution: without arcs the pose is out of reach, unless tolerances are wide.
        self.found.complete = arcs.is_empty() && !self.may_reach_by_tolerance;
        for finer in [1, FINER, FINER * FINER] {
            self.take_values(family, &limits, arcs.spread(count.saturating_mul(finer)));
            if !self.found.solutions.is_empty() || self.found.interrupted || self.found.complete {
                return;
            }
            if finer == 1 && family.is_excluded(&limits, &arcs) && !self.may_reach_by_tolerance {
                self.found.complete = true;
                return;
            }
        }
        if let Some(decisive) = family.decisive(&limits) {
            self.take_values(family, &limits, decisive.values.into_iter());
            self.found.complete = decisive.is_sure
                && self.found.solutions.is_empty()
                && !self.found.interrupted
                && !self.may_reach_by_tolerance;
        }
    }

    fn take_values(&mut self, family: &PoseFamily<'_>, limits: &FamilyLimits, values: impl Iterator<Item = f64>) {
        let mut looks = 0;
        family.visit_within(limits, values, |branches| {
            self.attempt.budget.evaluations += branches.evaluations;
            self.found.singular |= branches.singular;
            for (q, fit) in branches.iter() {
                let outside = self.take_inside(q, fit);
                if AT_LIMIT < outside && outside < NEAR_LIMIT && self.found.solutions.is_empty() {
                    self.may_reach_by_tolerance = true;
                    self.take_by_descent(q);
                }
            }
            looks += 1;
            self.found.interrupted = looks % VISITS_BETWEEN_LOOKS == 0 && !self.attempt.monitor.keep_going();
            !self.found.interrupted
        });
    }

    /// Takes the solutions of a non-redundant arm. Returns the number of branches, limits aside; `None` without a closed form.
    fn take_all(&mut self, pose: &Frame) -> Option<usize> {
        let branches = self.attempt.context.robot().branches(pose)?;
        self.take_branches(&branches);
        for q in branches.near_misses() {
            self.may_reach_by_tolerance = true;
            self.take_by_descent(q);
        }
        if self.found.solutions.is_empty() && self.may_reach_by_tolerance {
            self.take_within_tolerance();
        }
        self.found.complete &= !self.may_reach_by_tolerance;
        if branches.doubt == Doubt::Anywhere && !self.found.singular {
            self.take_scattered();
        }
        Some(branches.len())
    }

    fn take_branches(&mut self, branches: &ArmBranches) {
        self.attempt.budget.evaluations += branches.evaluations;
        self.found.complete &= branches.doubt != Doubt::Anywhere;
        self.found.singular |= branches.singular;
        let is_sure = branches.doubt == Doubt::None && !branches.singular;
        for (q, fit) in branches.iter() {
            let outside = self.take_inside(q, fit);
            if outside <= AT_LIMIT {
                self.admit_curve(fit.stiffness);
            }
            if !is_sure || AT_LIMIT < outside && outside < MOVED_BY_POLISHING {
                self.take_nearby(q, outside);
            }
        }
    }

    /// Takes a branch if it is inside the limits. Returns its largest excess over them (rad, m).
    #[inline]
    fn take_inside(&mut self, q: &[f64], fit: BranchFit) -> f64 {
        let mut near = [0.0; MOST_JOINTS];
        let near = &mut near[..q.len()];
        let mut outside = 0.0;
        for ((joint, value), placed) in self.turns.joints().iter().zip(q).zip(near.iter_mut()) {
            let value = joint.nearest(*value);
            outside = larger(outside, larger(joint.lower - value, value - joint.upper));
            *placed = value.clamp(joint.lower, joint.upper);
        }
        if outside > AT_LIMIT {
            return outside;
        }
        if self.verified_is_solved {
            let BranchFit { position, rotation, .. } = fit;
            self.found.solutions.push(near, TipError { position, rotation });
        } else {
            // Rounding in the closed form may exceed the tolerances.
            self.found.complete = false;
            self.take_by_descent(near);
        }
        outside
    }

    /// Withdraws the claim that no solution is missing if the tolerances admit a curve of configurations through a branch of
    /// this `stiffness` (m, rad).
    #[inline]
    fn admit_curve(&mut self, stiffness: f64) {
        let change = stiffness / self.widest;
        self.found.complete &= change > FAR_FROM_FREE;
        self.found.singular |= change < ALMOST_FREE;
    }

    /// Takes solutions near a branch: close to a singularity the tolerances admit a curve of configurations, part of which may
    /// be inside the limits even if the branch is `outside` them (rad, m).
    #[cold]
    fn take_nearby(&mut self, q: &[f64], outside: f64) {
        let Some((_, criterion)) = self.attempt.problem.only_target() else { return };
        let Tolerance { position, rotation } = criterion.tolerance;
        let tolerance = Tolerance { position: position.max(LEAST_TOLERANCE), rotation: rotation.max(LEAST_TOLERANCE) };
        let weak = WeakDirection::at(self.attempt.context.robot(), q, &tolerance);
        if weak.change < ALMOST_FREE {
            self.found.singular = true;
            self.found.complete = false;
        }
        if outside > AT_LIMIT && outside * weak.change < FIRMLY_OUTSIDE {
            // A descent decides if the arm is far from singular.
            if weak.change > FAR_FROM_FREE {
                return self.take_by_descent(q);
            }
            self.found.complete = false;
            let along = self.least_outside_along(q, &weak.direction);
            self.take_by_descent(&along);
        }
    }

    /// Returns the configuration least outside the limits on the line from `q` along `direction`.
    fn least_outside_along(&self, q: &[f64], direction: &[f64]) -> Point {
        let at = |t: f64| q.iter().zip(direction).map(|(q, v)| q + t * v).collect::<Point>();
        let outside = |t: f64| {
            let values = self.turns.joints().iter().zip(at(t));
            values.fold(0.0, |most: f64, (joint, value)| {
                let value = joint.nearest(value);
                most.max(joint.lower - value).max(value - joint.upper)
            })
        };
        let mut best = (outside(0.0), 0.0);
        let mut step = TAU / TRIED_ALONG as f64;
        for k in 1..=TRIED_ALONG {
            for t in [step * k as f64, -step * k as f64] {
                best = if outside(t) < best.0 { (outside(t), t) } else { best };
            }
        }
        for _ in 0..HALVINGS_ALONG {
            step *= 0.5;
            for t in [best.1 + step, best.1 - step] {
                best = if outside(t) < best.0 { (outside(t), t) } else { best };
            }
        }
        at(best.1)
    }

    /// Takes the branches of a pose within the tolerances if the pose itself has none inside the limits: at the edge of the
    /// reach, or just outside the poses that an arm with few joints can reach.
    #[cold]
    fn take_within_tolerance(&mut self) {
        let q = self.attempt.approach(&self.descent, self.turns.reference(), APPROACHES, usize::MAX);
        if !self.attempt.problem.assess(&q).score.solved {
            return;
        }
        let context = self.attempt.context;
        let reached = context.robot().tip(&q);
        let branches = context.robot().branches(&reached);
        for (q, _) in branches.iter().flat_map(ArmBranches::iter) {
            self.take_by_descent(q);
        }
        if self.found.solutions.is_empty() {
            self.found.solutions.push(&q, self.attempt.problem.assess(&q).error.into());
        }
    }

    /// Takes the solutions of descents from scattered starts, where the closed form may miss some.
    #[cold]
    fn take_scattered(&mut self) {
        let mut start = self.attempt.first_start(None);
        for _ in 0..SCATTERED {
            self.take_by_descent(&start);
            self.attempt.next_start(&mut start);
        }
    }

    /// Takes the solution of a descent from `q`.
    #[cold]
    fn take_by_descent(&mut self, q: &[f64]) {
        let mut near = Point::from_slice(q);
        self.turns.bring_near(&mut near);
        let bounds = self.attempt.context.bounds();
        bounds.clip(&mut near);
        let mut q = self.attempt.descend_beyond(&self.descent, near, VERIFIED, bounds);
        self.turns.bring_near(&mut q);
        let assessment = self.attempt.problem.assess(&q);
        let known = |other: &[f64]| largest_difference(other, &q) < SAME;
        if assessment.score.solved && !self.found.solutions.iter().any(|other| known(other.q)) {
            self.found.solutions.push(&q, assessment.error.into());
        }
    }
}
