//! Clear solutions by the closed form: branches, and samples of the self-motion.

use super::clear_search::{ClearSearch, Exhausted};
use crate::closed_form::{ArmConfigurations, Doubt, PoseFamily, VERIFIED};
use crate::ik::first_branch::LEAST_BUDGET;
use crate::ik::preference::Preference;
use crate::math::Frame;
use crate::objective::Point;
use crate::task::Target;

/// Most values of the parameter of a redundant arm that are tried.
const SCANNED: usize = 2048;

/// Values of the parameter between two looks at the monitor.
const VALUES_BETWEEN_LOOKS: usize = 64;

/// Values after which it is asked whether any can have a clear branch: most poses have one before.
const VALUES_BEFORE_DOUBT: usize = 4;

/// A clear solution, or why no branch is clear; `None` where the closed form does not apply, or no branch is inside the limits.
pub(super) type BranchOutcome = Option<Result<Point, Exhausted>>;

impl ClearSearch<'_, '_, '_> {
    /// The preferred one of the clear branches; of a redundant arm one at the first value of its parameter that has one.
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

    /// Of an arm that is not redundant.
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
        // Beside singular poses, what is near a branch is still to be polished.
        self.forget_candidates();
        let branches = robot.branches(pose)?;
        self.attempt.budget.evaluations += branches.evaluations;
        match self.first_clear(preference, &mut branches.configurations(), f64::INFINITY) {
            Some(q) => Some(Ok(q)),
            None if self.has_candidates() && branches.doubt == Doubt::None && !branches.singular => {
                Some(Err(Exhausted::All))
            }
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

    /// Where no branch is clear.
    fn clear_by_pushing(&mut self) -> BranchOutcome {
        match self.pushed_candidate() {
            Some(q) => Some(Ok(q)),
            None if self.has_candidates() => Some(Err(Exhausted::Tried)),
            None => None,
        }
    }

    /// The preferred one of those `configurations` that are inside the limits, solve the target with no more than an error (m, rad) and
    /// are clear.
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
