//! The first solution of a pose by the closed form of an arm with one joint more than the pose needs.

use std::borrow::Cow;

use super::all_branches::nearest_of_all_branches;
use super::attempt::Attempt;
use super::context::SolveContext;
use super::near_misses::{LOOKED, from_near_misses};
use super::out_of_reach::{ended, is_wide, obstruction};
use super::preference::{Miss, Preference};
use super::solution::Solution;
use crate::closed_form::{ArmConfigurations, FamilyLimits, ParameterArcs, PoseFamily};
use crate::solver::Status;

/// Most arm angles that are tried before near misses are.
const SCANNED_ANGLES: usize = 8;

/// Arm angles after which it is asked whether any can have a solution: most poses have one before.
const ANGLES_BEFORE_DOUBT: usize = 4;

/// Values of a joint as parameter that are tried before it is asked: the answer takes as long as fifty values.
const SCANNED_VALUES: usize = 10;

/// Most values of the parameter that are tried first where near misses are looked for: those where a solution is not excluded.
const OPEN: usize = 2;

/// The search after both takes one of so many evaluations that the budget leaves.
const SEARCHED_SHARE: usize = 400;

/// A configuration that is outside the limits by less (rad, m) may be inside but for rounding.
const UNDECIDED: f64 = 1e-4;

/// How a look at scattered values ends without a solution.
enum Scattered {
    /// No solution is within the limits.
    Unreachable,
    /// None is at these values, but may be near others.
    Open(Vec<f64>),
    /// Branches that failed took half the budget: the rest is for a search.
    TooCostly,
}

/// A pose of such an arm, and which of its solutions to take.
pub(super) struct FamilySearch<'a> {
    family: &'a PoseFamily<'a>,
    limits: FamilyLimits,
    arcs: ParameterArcs,
    preference: Cow<'a, Preference>,
    start: Option<&'a [f64]>,
}

impl<'a> FamilySearch<'a> {
    /// The solution nearest to the start or, without one, the most central one, each among few.
    pub fn new(context: &'a SolveContext<'_>, family: &'a PoseFamily<'_>, start: Option<&'a [f64]>) -> Self {
        let [lower, upper] = context.sampling_ranges();
        let limits = family.limits(lower, upper);
        let arcs = family.arcs(&limits);
        Self { family, limits, arcs, preference: context.preference(start), start }
    }

    /// From the start by descent; then the first value of the parameter that has a branch inside the limits; then what is known of the
    /// values between. None where a search is to go on.
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

    /// Of an arm whose structure holds only nearly: by descent from what the closed form finds at a few values.
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

    /// Tries a few values: most poses have a solution at one of the first.
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
            // Beside singular poses, what is near a branch is still to be polished.
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

    /// Most values that are tried before near misses are.
    fn scanned(&self) -> usize {
        if self.family.is_by_arm_angle() { SCANNED_ANGLES } else { SCANNED_VALUES }
    }

    /// A solution at a value that the proof of there being none could not exclude, or how that ends.
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

    /// A solution at one of the values that decide whether there is any, where they are known; far if there is none for certain.
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

    /// A solution near branches that are little outside the limits.
    #[cold]
    fn near_the_limits(&self, attempt: &mut Attempt<'_, '_>, open: &[f64]) -> Option<Solution> {
        match from_near_misses(attempt, (self.family, &self.preference), &self.arcs, open) {
            Ok(solution) => Some(solution),
            Err(Miss::Far) if self.family.is_sure_of_arcs() => self.searched_in_short(attempt),
            Err(_) => None,
        }
    }

    /// A search with a small share of the budget. What it misses is reported as not found, which is no proof.
    #[cold]
    fn searched_in_short(&self, attempt: &mut Attempt<'_, '_>) -> Option<Solution> {
        let x0 = attempt.first_start(self.start);
        let reserve = attempt.budget.left() - attempt.budget.left() / SEARCHED_SHARE;
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

    /// No solution is within the limits; None where that is not proven.
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
        Some(ended(attempt, from, obstruction))
    }
}
