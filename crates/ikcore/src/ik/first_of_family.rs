//! First solution of a pose by the closed form of an arm with one redundant joint.

use std::borrow::Cow;

use super::all_branches::nearest_of_all_branches;
use super::attempt::Attempt;
use super::context::SolveContext;
use super::near_misses::{LOOKED, from_near_misses};
use super::out_of_reach::{is_wide, obstruction, unreachable_result};
use super::preference::{Miss, Preference};
use super::solution::Solution;
use crate::closed_form::{ArmConfigurations, FamilyLimits, ParameterArcs, PoseFamily};
use crate::solver::Status;

/// Largest number of arm angles before near misses are tried.
const SCANNED_ANGLES: usize = 8;

/// Arm angles before testing whether any has a solution: most poses have one earlier.
const ANGLES_BEFORE_DOUBT: usize = 4;

/// Values of a joint as parameter before that test, which takes as long as fifty values.
const SCANNED_VALUES: usize = 10;

/// Largest number of parameter values, not yet excluded, that near misses start from.
const OPEN: usize = 2;

/// Divisor of the remaining evaluation budget for the final short search.
const SEARCH_DIVISOR: usize = 400;

/// Excess over the limits (rad, m) that rounding may explain.
const UNDECIDED: f64 = 1e-4;

/// Outcome of scattered parameter values without a solution.
enum Scattered {
    /// Proof that no solution is within the limits.
    Unreachable,
    /// No solution at these values; others may have one.
    Open(Vec<f64>),
    /// Half the budget spent on failed branches: the rest is left to a search.
    TooCostly,
}

/// Search over the self-motion of one pose of a redundant arm.
pub(super) struct FamilySearch<'a> {
    family: &'a PoseFamily<'a>,
    limits: FamilyLimits,
    arcs: ParameterArcs,
    preference: Cow<'a, Preference>,
    start: Option<&'a [f64]>,
}

impl<'a> FamilySearch<'a> {
    /// Search for the solution nearest to the start or, without one, the most central one, each among few.
    pub fn new(context: &'a SolveContext<'_>, family: &'a PoseFamily<'_>, start: Option<&'a [f64]>) -> Self {
        let [lower, upper] = context.sampling_ranges();
        let limits = family.limits(lower, upper);
        let arcs = family.arcs(&limits);
        Self { family, limits, arcs, preference: context.preference(start), start }
    }

    /// Tries a descent from the start, then the first parameter values with a branch inside the limits, then the analysis of
    /// the values between. `None` if a search has to continue.
    pub fn first(&self, attempt: &mut Attempt<'_, '_>) -> Option<Solution> {
        if let Some(start) = self.start {
            let (status, q) = attempt.search_once(start);
            if status != Status::Stalled {
                return Some(attempt.explained(status, q));
            }
        }
        if let Some(solution) = self.near_the_pose(attempt) {
            return Some(solution);
        }
        match self.at_scattered_values(attempt) {
            Ok(solution) => Some(solution),
            Err(Scattered::Unreachable) => self.unreachable(attempt),
            Err(Scattered::TooCostly) => None,
            Err(Scattered::Open(open)) => match self.at_decisive_values(attempt) {
                Ok(solution) => Some(solution),
                Err(Miss::Far) => self.unreachable(attempt),
                Err(Miss::Near) => self.near_the_limits(attempt, &open),
            },
        }
    }

    /// Solution at one of the first parameter values: most poses have one there.
    pub fn at_first_values(&self, attempt: &mut Attempt<'_, '_>) -> Option<Solution> {
        let mut likely = ArmConfigurations::none();
        self.arcs.scattered(ANGLES_BEFORE_DOUBT).find_map(|value| {
            self.family.likely_at(value, &self.limits, &mut likely);
            attempt.preferred(&self.preference, &mut likely).ok()
        })
    }

    /// Descends from the closed form at a few values, for an arm whose structure is only approximate.
    fn near_the_pose(&self, attempt: &mut Attempt<'_, '_>) -> Option<Solution> {
        if !self.family.is_approximate() {
            return None;
        }
        let mut near = ArmConfigurations::none();
        self.arcs.scattered(self.scanned()).find_map(|value| {
            self.family.candidates_at(value, &self.limits, &mut near);
            attempt.descended_from(&self.preference, &mut near)
        })
    }

    /// Tries a few scattered values: most poses have a solution at one of the first.
    fn at_scattered_values(&self, attempt: &mut Attempt<'_, '_>) -> Result<Solution, Scattered> {
        if self.arcs.is_empty() {
            return Err(Scattered::Unreachable);
        }
        let mut likely = ArmConfigurations::none();
        let half_the_budget = attempt.budget.left() / 2;
        for (number, value) in self.arcs.scattered(self.scanned()).enumerate() {
            if number == ANGLES_BEFORE_DOUBT
                && self.family.is_by_arm_angle()
                && self.family.is_excluded(&self.limits, &self.arcs)
            {
                return Err(Scattered::Unreachable);
            }
            self.family.likely_at(value, &self.limits, &mut likely);
            if likely.is_empty() {
                continue;
            }
            match attempt.preferred(&self.preference, &mut likely) {
                Ok(solution) => return Ok(solution),
                Err(Miss::Far) => continue,
                Err(Miss::Near) => {}
            }
            // Polishing is still needed near singular poses.
            let branches = self.family.branches_at(value);
            attempt.budget.evaluations += branches.evaluations;
            if let Ok(q) = self.preference.choose(&mut branches.configurations())
                && let Some(solution) = attempt.solved_at(q)
            {
                return Ok(solution);
            }
            if attempt.budget.left() < half_the_budget {
                return Err(Scattered::TooCostly);
            }
        }
        self.by_doubt(attempt)
    }

    /// Largest number of values before near misses are tried.
    fn scanned(&self) -> usize {
        if self.family.is_by_arm_angle() { SCANNED_ANGLES } else { SCANNED_VALUES }
    }

    /// Tries a value that the proof of infeasibility could not exclude, or returns the outcome of the proof.
    #[cold]
    fn by_doubt(&self, attempt: &mut Attempt<'_, '_>) -> Result<Solution, Scattered> {
        let (mut likely, mut solution) = (ArmConfigurations::none(), None);
        let open = self.family.open_values(&self.limits, &self.arcs, OPEN, |value| {
            self.family.likely_at(value, &self.limits, &mut likely);
            if !likely.is_empty() {
                solution = attempt.preferred(&self.preference, &mut likely).ok();
            }
            solution.is_some()
        });
        match (solution, open) {
            (Some(solution), _) => Ok(solution),
            (None, Some(open)) if open.is_empty() => Err(Scattered::Unreachable),
            (None, open) => Err(Scattered::Open(open.unwrap_or_default().to_vec())),
        }
    }

    /// Tries the values that decide whether there is a solution, if they are known. `Miss::Far` if there is certainly none.
    #[cold]
    fn at_decisive_values(&self, attempt: &mut Attempt<'_, '_>) -> Result<Solution, Miss> {
        let decisive = self.family.decisive(&self.limits).ok_or(Miss::Near)?;
        let mut likely = ArmConfigurations::none();
        let mut miss = if decisive.is_sure { Miss::Far } else { Miss::Near };
        for value in decisive.values {
            self.family.likely_at(value, &self.limits, &mut likely);
            if let Ok(solution) = attempt.preferred(&self.preference, &mut likely) {
                return Ok(solution);
            }
            if self.preference.misses(&mut likely, UNDECIDED).next().is_some() {
                miss = Miss::Near;
            }
        }
        Err(miss)
    }

    /// Descends from branches slightly outside the limits.
    #[cold]
    fn near_the_limits(&self, attempt: &mut Attempt<'_, '_>, open: &[f64]) -> Option<Solution> {
        match from_near_misses(attempt, (self.family, &self.preference), &self.arcs, open) {
            Ok(solution) => Some(solution),
            Err(Miss::Far) if self.family.is_sure_of_arcs() => self.searched_in_short(attempt),
            Err(_) => None,
        }
    }

    /// Searches with a small fraction of the budget. A miss is reported as not found, which is no proof.
    #[cold]
    fn searched_in_short(&self, attempt: &mut Attempt<'_, '_>) -> Option<Solution> {
        let x0 = attempt.first_start(self.start);
        let reserve = attempt.budget.left() - attempt.budget.left() / SEARCH_DIVISOR;
        let (status, q) = attempt.search(attempt.context.bounds(), &x0, reserve);
        if status != Status::BudgetSpent || attempt.budget.is_spent() {
            return Some(attempt.explained(status, q));
        }
        let mut solution = attempt.explained(Status::Stalled, q);
        if solution.obstruction.is_empty() {
            let (values, evaluations) = (self.scanned() + LOOKED, solution.evaluations);
            solution.obstruction = format!(
                "no solution at {values} values of the redundancy, nor by a search, {evaluations} evaluations in all"
            );
        }
        Some(solution)
    }

    /// Result if no solution is within the limits; `None` if that is not proven.
    #[cold]
    fn unreachable(&self, attempt: &mut Attempt<'_, '_>) -> Option<Solution> {
        if is_wide(attempt) {
            return nearest_of_all_branches(attempt, &self.preference, self.start);
        }
        if !attempt.context.robot().proves_branches() {
            return None;
        }
        let obstruction = obstruction(attempt, None);
        let from = attempt.first_start(self.start);
        Some(unreachable_result(attempt, from, obstruction))
    }
}
