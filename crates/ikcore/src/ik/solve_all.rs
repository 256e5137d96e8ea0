//! Distinct solutions of one target.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::attempt::Attempt;
use super::context::SolveContext;
use super::solution::Solution;
use super::solve_options::SolveOptions;
use super::whole_turns::bring_near;
use crate::error::{Error, Result, require_positive};
use crate::math::vector::distance;
use crate::objective::{Bounds, Point};
use crate::rng;
use crate::robot::Robot;
use crate::solver::{Monitor, Status};
use crate::task::Target;

/// Consecutive known solutions after which the search ends.
const PATIENCE: usize = 100;

/// Options of [`solve_all`].
#[derive(Debug, Clone)]
pub struct AllOptions {
    /// Options of each solve. Its budgets apply to the whole search.
    pub each: SolveOptions,
    /// Largest number of solutions to return.
    pub limit: usize,
    /// Solutions count as the same if every joint differs by less than this (rad, m), apart from whole turns.
    pub separation: f64,
}

impl Default for AllOptions {
    fn default() -> Self {
        Self { each: SolveOptions::default(), limit: 16, separation: 0.1 }
    }
}

/// Distinct solutions, and how the search ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SolutionSet {
    /// The solutions, nearest to the start first; without a start in the order of discovery.
    pub solutions: Vec<Solution>,
    /// The best miss if there is no solution.
    pub miss: Option<Solution>,
    /// Evaluations of the forward kinematics.
    pub evaluations: usize,
    /// Time taken.
    pub elapsed: Duration,
    /// The monitor asked to stop.
    pub interrupted: bool,
}

impl SolutionSet {
    /// [`Status::Solved`] if there is a solution, else why the last search ended.
    pub fn status(&self) -> Status {
        self.miss.as_ref().map_or(Status::Solved, |miss| miss.status)
    }

    /// The number of solutions, or why there are none.
    pub fn message(&self) -> String {
        match (self.solutions.len(), &self.miss) {
            (0, Some(miss)) => format!("no solution; best miss: {}", miss.message()),
            (1, _) => "1 solution".into(),
            (count, _) => format!("{count} distinct solutions"),
        }
    }
}

/// Searches for distinct solutions until a hundred in a row are already known, or the budget is spent.
///
/// Each joint is shifted by whole turns to be nearest to the start or, without one, to the middle of its limits. A
/// redundant arm has infinitely many solutions; those returned differ by at least the separation.
///
/// # Errors
/// Any [`enum@Error`] for wrong input.
pub fn solve_all(
    robot: &Robot,
    target: &Target,
    options: &AllOptions,
    monitor: &mut dyn Monitor,
) -> Result<SolutionSet> {
    let AllOptions { each, limit, separation } = options;
    require_positive("separation", *separation)?;
    if *limit == 0 {
        return Err(Error::out_of_range("limit", "at least 1", 0.0));
    }
    let context = SolveContext::new(robot, each)?;
    let start = each.start.as_deref();
    let target = context.read(target)?;
    start.map_or(Ok(()), |q| context.check_start(q))?;
    let mut problem = context.problem(&target);
    let mut rng = rng::stream(each.seed, 0);
    Ok(search(Attempt::new(&context, &mut problem, &mut rng, monitor), start, options))
}

fn search(mut attempt: Attempt<'_, '_>, start: Option<&[f64]>, options: &AllOptions) -> SolutionSet {
    let (robot, bounds) = (attempt.context.robot(), attempt.context.bounds());
    let mut x0 = attempt.first_start(start);
    let reference = start.map_or_else(|| middle(robot, bounds), Point::from);
    let (mut solutions, mut known) = (Vec::<Solution>::new(), 0);
    let mut interrupted = false;
    let last = loop {
        let found = attempt.solve_from(&x0);
        let mut solution = attempt.mark_held_in_region(found);
        if solution.status != Status::Solved {
            break Some(solution);
        }
        bring_near(robot, bounds, &reference, &mut solution.q);
        if solutions.iter().any(|other| is_same(robot, &other.q, &solution.q, options.separation)) {
            known += 1;
        } else {
            known = 0;
            solutions.push(solution);
        }
        // Without a start any solutions are enough; with one, the nearest are required, and they may come last.
        let enough = start.is_none() && solutions.len() == options.limit;
        // Runs may be too short to poll the monitor.
        interrupted = !attempt.monitor.keep_going();
        if interrupted || known == PATIENCE || enough || attempt.budget.is_spent() {
            break None;
        }
        attempt.next_start(&mut x0);
    };
    if let Some(start) = start {
        solutions.sort_by(|a, b| distance(&a.q, start).total_cmp(&distance(&b.q, start)));
    }
    solutions.truncate(options.limit);
    interrupted |= last.as_ref().is_some_and(|solution| solution.status == Status::Interrupted);
    let miss = last.filter(|_| solutions.is_empty());
    let (evaluations, elapsed) = (attempt.budget.evaluations, attempt.budget.elapsed());
    SolutionSet { solutions, miss, evaluations, elapsed, interrupted }
}

/// The middle of the ranges that joints are sampled from.
fn middle(robot: &Robot, bounds: &Bounds) -> Point {
    let ranges = bounds.lower().iter().zip(bounds.upper()).zip(robot.joints());
    ranges
        .map(|((lower, upper), joint)| {
            let (lower, upper) = joint.sampling_range_within(*lower, *upper);
            0.5 * (lower + upper)
        })
        .collect()
}

/// Whether no joint differs by `separation`, apart from whole turns.
fn is_same(robot: &Robot, a: &[f64], b: &[f64], separation: f64) -> bool {
    (0..a.len()).all(|j| {
        let difference = a[j] - b[j];
        let turn = std::f64::consts::TAU;
        let apart =
            if robot.repeats_every_turn(j) { difference - turn * (difference / turn).round() } else { difference };
        apart.abs() < separation
    })
}
