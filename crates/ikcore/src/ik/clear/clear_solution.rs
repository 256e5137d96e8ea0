//! Clear solution of one target, as `solve` returns it.

use super::clear_search::{ClearSearch, Exhausted, Found};
use crate::ik::attempt::Attempt;
use crate::ik::first_branch::by_closed_form;
use crate::ik::solution::{Nearest, Solution};
use crate::ik::solve_options::Prefer;
use crate::objective::Point;
use crate::obstacle::{Blocked, ClearSpace, Contact, Sensed};
use crate::solver::Status;

/// Finds a solution in `space`, or the configuration nearest to one.
///
/// A descent from the caller's start is tried first, then the branches of the closed form, then searches. Blocked solutions are
/// pushed along their self-motion. Goals are descended on inside `space`.
pub(in crate::ik) fn clear_solution<'p>(
    attempt: &mut Attempt<'_, 'p>,
    space: &'p ClearSpace<'p>,
    start: Option<&[f64]>,
) -> Solution {
    let context = attempt.context;
    let mut search = ClearSearch::new(attempt, space);
    let found = match (context.options().prefer, start) {
        (Prefer::Nearest, Some(start)) => search.nearest_to(start),
        (Prefer::Best, start) => search.least_cost(&mut context.goals().clone(), start),
        (_, start) => search.first(start).map(|q| search.improved(q, start)),
    };
    let mut solution = found.map_or_else(|missed| *missed, |q| attempt.solution(Status::Solved, q));
    solution.own_points = own_points(&solution, space, start);
    if solution.nearest.is_none() && !context.options().nearest_later {
        solution.nearest = Some(Box::new(Nearest::at(space, &solution.q)));
    }
    solution
}

/// Returns `solution` if it is clear, or a clear one near it on its self-motion; otherwise sets the status
/// [`Status::InCollision`].
pub(in crate::ik) fn made_clear<'p>(
    attempt: &mut Attempt<'_, 'p>,
    space: &'p ClearSpace<'p>,
    solution: Solution,
) -> Solution {
    let checked = ClearSearch::new(attempt, space).checked(solution);
    let mut solution = checked.map_or_else(|blocked| *blocked, |q| attempt.solution(Status::Solved, q));
    solution.own_points = own_points(&solution, space, None);
    solution
}

/// Returns what was measured of the robot itself, if a solution is in collision with it: the robot is in it at its `start`, or with
/// a body that no joint moves.
fn own_points(solution: &Solution, space: &ClearSpace<'_>, start: Option<&[f64]>) -> Option<Sensed> {
    if solution.status != Status::InCollision {
        return None;
    }
    let measured = |contact: &Contact| contact.measured().filter(|_| contact.distance < space.margin());
    if let Some(Blocked::Base(contact)) = space.blocked_anywhere(&solution.q) {
        return measured(&contact);
    }
    let contact = |q: &[f64]| space.clearance(q).nearest.map(|nearest| nearest.contact);
    let here = measured(&contact(&solution.q)?)?;
    start.and_then(contact).as_ref().and_then(measured).map(|_| here)
}

impl ClearSearch<'_, '_, '_> {
    /// Finds the first clear solution; the error is the result without one.
    fn first(&mut self, start: Option<&[f64]>) -> Found {
        if let Some(start) = start
            && let Some(q) = self.near_start(start)
        {
            return Ok(q);
        }
        let context = self.attempt.context;
        match self.by_branches(&context.preference(start)) {
            Some(Ok(q)) => return Ok(q),
            Some(Err(exhausted)) => {
                if let Some(solution) = self.in_collision(exhausted) {
                    return Err(solution);
                }
            }
            None => {
                if let Some(solution) = by_closed_form(self.attempt, start) {
                    return self.checked(solution);
                }
            }
        }
        let x0 = self.attempt.first_start(start);
        self.by_restarts(x0)
    }

    /// Returns the configuration of `solution` if it is clear, or a clear one near it on its self-motion.
    fn checked(&mut self, solution: Solution) -> Found {
        if solution.status != Status::Solved {
            return Err(Box::new(solution));
        }
        let found = self.cleared(solution.q.clone());
        found.ok_or_else(|| self.in_collision_or(solution, Exhausted::Tried))
    }

    /// Finds a clear solution by one descent from `start`.
    fn near_start(&mut self, start: &[f64]) -> Option<Point> {
        if self.attempt.problem.assess(start).score.solved {
            return self.cleared(Point::from_slice(start));
        }
        let robot = self.attempt.context.robot();
        // Other arms get the nearest branch from their closed form.
        if robot.dof() <= robot.task_rank().pose && robot.solves_at_once() == Some(true) {
            return None;
        }
        let (status, q) = self.attempt.search_once(start);
        if status == Status::Solved { self.cleared(q) } else { None }
    }

    /// Finds the clear solution nearest to `start`: among all branches of a non-redundant arm, else among those found.
    fn nearest_to(&mut self, start: &[f64]) -> Found {
        let context = self.attempt.context;
        if context.robot().dof() <= context.robot().task_rank().pose {
            match self.by_branches(&context.preference(Some(start))) {
                Some(Ok(q)) => return Ok(q),
                Some(Err(exhausted)) => {
                    if let Some(solution) = self.in_collision(exhausted) {
                        return Err(solution);
                    }
                }
                None => {}
            }
        }
        self.least_cost(&mut context.distance_from(start), Some(start))
    }

    /// Moves the clear solution `q` along its self-motion to the nearest optimum of the goals.
    fn improved(&mut self, mut q: Point, start: Option<&[f64]>) -> Point {
        let context = self.attempt.context;
        let Some(mut goals) = context.goals_from(start) else { return q };
        if let Some(start) = start {
            self.bring_near(start, &mut q);
        }
        self.attempt.descend_goals(&mut goals, &mut q);
        q
    }
}
