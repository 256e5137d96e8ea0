//! Search for a clear solution: its state, and the blocked solutions.

use std::cell::OnceCell;

use super::blocked_solutions::BlockedSolutions;
use crate::ik::attempt::Attempt;
use crate::ik::solution::{Nearest, Solution};
use crate::ik::whole_turns::bring_near;
use crate::objective::Point;
use crate::obstacle::{Blocked, ClearSpace, Contact};
use crate::solver::Status;
use crate::task::{Goal, Goals};

/// Clearance beyond the margin to which a configuration is pushed (m).
const BEYOND: f64 = 5e-3;

/// Number of blocked solutions to push if none is clear.
const PUSHED: usize = 8;

/// Search for a clear solution of one target.
pub(in crate::ik) struct ClearSearch<'s, 'm, 'p> {
    pub attempt: &'s mut Attempt<'m, 'p>,
    pub space: &'p ClearSpace<'p>,
    blocked: BlockedSolutions,
    /// Contact that no motion of the arm ends, computed on first use.
    hopeless: OnceCell<Option<Blocked>>,
    push: Goals,
}

/// Clear solution, or the result without one.
pub(super) type Found = Result<Point, Box<Solution>>;

/// Extent of a search that found no clear solution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::ik) enum Exhausted {
    /// All solutions inside the limits.
    All,
    /// Some solutions; others may exist.
    Tried,
    /// Interrupted by the monitor.
    Interrupted,
}

impl Exhausted {
    fn status(self) -> Status {
        if self == Self::Interrupted { Status::Interrupted } else { Status::InCollision }
    }
}

impl<'s, 'm, 'p> ClearSearch<'s, 'm, 'p> {
    pub fn new(attempt: &'s mut Attempt<'m, 'p>, space: &'p ClearSpace<'p>) -> Self {
        let away = Goal::Clearance { up_to: space.margin() + BEYOND, weight: 1.0 };
        let push = Goals::new(&[away], attempt.context.robot(), attempt.context.bounds());
        Self { attempt, space, blocked: BlockedSolutions::new(), hopeless: OnceCell::new(), push }
    }

    /// Remembers solutions of a part of the target, which are not clear. What the whole target fixes does not block all of them.
    pub fn note_partial(&mut self, configurations: &[Point]) {
        configurations.iter().for_each(|q| self.blocked.push(q));
        self.hopeless = OnceCell::from(None);
    }

    /// Whether the solution `q` is clear. A blocked one is remembered.
    pub fn is_clear(&mut self, q: &[f64]) -> bool {
        self.attempt.budget.evaluations += 1;
        if self.space.holds(q) {
            return true;
        }
        self.blocked.push(q);
        false
    }

    /// Whether no solution is clear, whatever the arm does.
    pub fn is_hopeless(&self) -> bool {
        self.blocked_for_good().is_some()
    }

    fn blocked_for_good(&self) -> Option<&Blocked> {
        let q = self.blocked.first()?;
        let found = || self.space.blocked_at(q, &self.attempt.problem.fixed_frames());
        self.hopeless.get_or_init(found).as_ref()
    }

    /// Returns the solution `q`, or a clear one near it on its self-motion.
    pub fn cleared(&mut self, q: Point) -> Option<Point> {
        if self.is_clear(&q) {
            return Some(q);
        }
        if self.is_hopeless() { None } else { self.pushed(q) }
    }

    /// Shifts the joints of the clear solution `q` by whole turns towards `start`, unless rounding takes it out of the clear
    /// space.
    pub fn bring_near(&self, start: &[f64], q: &mut Point) {
        let (context, mut near) = (self.attempt.context, q.clone());
        bring_near(context.robot(), context.bounds(), start, &mut near);
        if self.space.holds(&near) {
            *q = near;
        }
    }

    /// Pushes the candidates least deep in collision along their self-motion. Returns the first that becomes clear.
    pub fn pushed_candidate(&mut self) -> Option<Point> {
        if self.is_hopeless() {
            return None;
        }
        let nearly = self.blocked.by_clearance(self.space);
        nearly.into_iter().take(PUSHED).find_map(|(_, q)| self.pushed(q))
    }

    /// Moves `q` along its self-motion until it is clear.
    fn pushed(&mut self, mut q: Point) -> Option<Point> {
        let mut goals = self.push.clone();
        let is_solved = self.attempt.descend_goals(&mut goals, &mut q) && self.attempt.problem.assess(&q).score.solved;
        (is_solved && self.space.holds(&q)).then_some(q)
    }

    /// Forgets the blocked solutions.
    pub fn forget_candidates(&mut self) {
        (self.blocked, self.hopeless) = (BlockedSolutions::new(), OnceCell::new());
    }

    /// Whether any blocked solution was found.
    pub fn has_candidates(&self) -> bool {
        self.blocked.count > 0
    }

    /// Result without a clear solution: the candidate least deep in collision.
    pub fn in_collision(&self, exhausted: Exhausted) -> Option<Box<Solution>> {
        let (nearest, q) = self.blocked.by_clearance(self.space).into_iter().next()?;
        let margin = self.space.margin();
        let said = |contact: &Contact| contact.in_words(margin);
        let obstruction = match (self.blocked_for_good(), exhausted) {
            (Some(Blocked::Hand(contact)), _) => {
                format!("{} whatever the arm does: the hand itself is in the way", said(contact))
            }
            (Some(Blocked::Base(contact)), _) if contact.measured().is_some() => {
                format!("{} whatever the arm does", said(contact))
            }
            (Some(Blocked::Base(contact)), _) => {
                format!("{} whatever the arm does; {}", said(contact), contact.remedy())
            }
            (None, Exhausted::All) if self.blocked.count == 1 => {
                format!("{} at the only solution inside the limits", said(&nearest.contact))
            }
            (None, Exhausted::All) => {
                let count = self.blocked.count;
                format!("{} at the best of {count} solutions, and there are no others", said(&nearest.contact))
            }
            (None, _) => {
                let count = self.blocked.count;
                format!("{} at the best of {count} solutions tried, and others may exist", said(&nearest.contact))
            }
        };
        let mut solution = Box::new(self.attempt.solution(exhausted.status(), q));
        solution.obstruction = obstruction;
        solution.nearest =
            Some(Box::new(Nearest { clearance: Some(nearest).into(), open_mesh: self.space.first_open_mesh() }));
        Some(solution)
    }

    /// Result like [`in_collision`](Self::in_collision), or `last`, which is not clear either, if no distance is known.
    pub fn in_collision_or(&self, mut last: Solution, exhausted: Exhausted) -> Box<Solution> {
        if last.status == Status::Solved {
            last.status = exhausted.status();
        }
        self.in_collision(exhausted).unwrap_or_else(|| Box::new(last))
    }
}
