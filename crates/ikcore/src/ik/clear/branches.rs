//! Clear solutions by the closed form: branches, and samples of the self-motion.

use super::clear_search::{ClearSearch, Exhausted};
use crate::closed_form::{ArmConfigurations, Doubt, PoseFamily, VERIFIED};
use crate::ik::first_branch::LEAST_BUDGET;
use crate::ik::preference::Preference;
use crate::math::Frame;
use crate::objective::Point;
use crate::task::Target;

/// Largest number of parameter values of a redundant arm.
const SCANNED: usize = 2048;

/// Parameter values between two polls of the monitor.
const VALUES_BETWEEN_LOOKS: usize = 64;

/// Parameter values before testing whether any branch can be clear: most poses have a clear one earlier.
const VALUES_BEFORE_DOUBT: usize = 4;

/// Clear solution, or the reason why no branch is clear; `None` if the closed form does not apply, or no branch is inside the
/// limits.
pub(super) type BranchOutcome = Option<Result<Point, Exhausted>>;

impl ClearSearch<'_, '_, '_> {
    /// Finds the preferred clear branch; for a redundant arm, one at the first value of its parameter that has a clear branch.
    pub(super) fn by_branches(&mut self, preference: &Preference) -> BranchOutcome {
        let context = self.attempt.context;
        let (target @ Target::Pose(pose), _) = self.attempt.problem.only_target()? else { return None };
        if !context.asks_for_pose(target) || self.attempt.budget.left() < LEAST_BUDGET {
            return None;
        }
        let robot = context.robot();
        match (robot.solves_at_once(), robot.family(pose)) {
            (Some(true), Some(family)) => self.of_family(&family, preference),
            (Some(_), None) => self.of_branches(pose, preference),
            _ => None,
        }
    }

    /// Finds the preferred clear branch of a non-redundant arm.
    fn of_branches(&mut self, pose: &Frame, preference: &Preference) -> BranchOutcome {
        let robot = self.attempt.context.robot();
        let mut likely = ArmConfigurations::none();
        robot.likely_branches(pose, &mut likely);
        if let Some(q) = self.first_clear(preference, &mut likely, VERIFIED) {
            return Some(Ok(q));
        }
        if self.has_candidates() && likely.is_all {
            return Some(Err(Exhausted::All));
        }
        // Polishing is still needed near singular poses.
        self.forget_candidates();
        let branches = robot.branches(pose)?;
        self.attempt.budget.evaluations += branches.evaluations;
        match self.first_clear(preference, &mut branches.configurations(), f64::INFINITY) {
            Some(q) => Some(Ok(q)),
            None if self.has_candidates() && branches.doubt == Doubt::None && !branches.singular => {
                Some(Err(Exhausted::All))
            }
            None if branches.singular && self.has_candidates() => match self.clear_member(preference, &branches) {
                Some(q) => Some(Ok(q)),
                None => self.clear_by_pushing(),
            },
            None => self.clear_by_pushing(),
        }
    }

    fn of_family(&mut self, family: &PoseFamily<'_>, preference: &Preference) -> BranchOutcome {
        let [lower, upper] = self.attempt.context.sampling_ranges();
        let limits = family.limits(lower, upper);
        let mut likely = ArmConfigurations::none();
        let half_the_budget = self.attempt.budget.left() / 2;
        for (k, value) in family.arcs(&limits).scattered(SCANNED).enumerate() {
            family.likely_at(value, &limits, &mut likely);
            if let Some(q) = self.first_clear(preference, &mut likely, f64::INFINITY) {
                return Some(Ok(q));
            }
            let is_hopeless = k >= VALUES_BEFORE_DOUBT && self.is_hopeless();
            if is_hopeless || self.attempt.budget.left() < half_the_budget {
                break;
            }
            if k % VALUES_BETWEEN_LOOKS == VALUES_BETWEEN_LOOKS - 1 && !self.attempt.monitor.keep_going() {
                return Some(Err(Exhausted::Interrupted));
            }
        }
        self.clear_by_pushing()
    }

    /// Pushes a blocked branch clear.
    fn clear_by_pushing(&mut self) -> BranchOutcome {
        match self.pushed_candidate() {
            Some(q) => Some(Ok(q)),
            None if self.has_candidates() => Some(Err(Exhausted::Tried)),
            None => None,
        }
    }

    /// Returns the preferred one of `configurations` that is inside the limits, solves the target with an error of at most
    /// `most` (m, rad), and is clear.
    fn first_clear(
        &mut self,
        preference: &Preference,
        configurations: &mut ArmConfigurations,
        most: f64,
    ) -> Option<Point> {
        preference.ordered(configurations).into_iter().find(|q| {
            let error = self.attempt.error_if_solved(q);
            error.is_some_and(|error| error.position.max(error.rotation) <= most) && self.is_clear(q)
        })
    }
}
