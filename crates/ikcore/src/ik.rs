//! Inverse kinematics: one target, one answer.

use std::time::Duration;

use crate::error::{Error, Result};
use crate::limits::{Field, Limits};
use crate::math::MAX_DOF;
use crate::objective::{Bounds, LeastSquares, Objective, Point};
use crate::problem::Problem;
use crate::rng;
use crate::robot::Robot;
use crate::solver::stop::Stopwatch;
use crate::solver::{AnySolver, Evaluator, Monitor, Status, Stop};
use crate::task::{Target, TipError, Tolerance};

/// How to solve. The default is Levenberg-Marquardt from many starts, within the robot's limits.
#[derive(Debug, Clone, Default)]
pub struct SolveOptions {
    /// The algorithm.
    pub solver: AnySolver,
    /// Where to begin (n,); None begins at the indexed configuration nearest to the target.
    pub start: Option<Vec<f64>>,
    /// When the target counts as reached.
    pub tolerance: Tolerance,
    /// Position limits to keep; None keeps the robot's.
    pub limits: Option<Limits>,
    /// Budgets.
    pub stop: Stop,
    /// Seed of the random draws: the same seed, the same bits. Most targets are solved without a draw, to the same bits
    /// whatever the seed.
    pub seed: u64,
}

/// The best configuration found, and what became of the search.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The configuration (n,) (rad, m), inside the limits.
    pub q: Point,
    /// Why the search ended.
    pub status: Status,
    /// Errors at `q`, by forward kinematics.
    pub error: TipError,
    /// Iterations over all starts.
    pub iterations: usize,
    /// Starts beyond the first.
    pub restarts: usize,
    /// Evaluations of the forward kinematics.
    pub evaluations: usize,
    /// Time taken.
    pub elapsed: Duration,
}

impl Solution {
    /// What happened, and what to try.
    pub fn message(&self) -> String {
        let errors = self.error;
        match self.status {
            _ if errors.position.is_nan() => format!("not solved: {}", self.status.advice()),
            Status::Solved => format!("solved to {errors}"),
            Status::Improved => format!("below the value asked for, {errors} away"),
            Status::Stalled => format!("no further progress {errors} away: {}", self.status.advice()),
            Status::BudgetSpent => format!("budget spent {errors} away: {}", self.status.advice()),
            Status::TimeUp => format!("time limit over {errors} away: {}", self.status.advice()),
            _ => format!("stopped {errors} away: {}", self.status.advice()),
        }
    }
}

/// Finds a configuration that brings the tip of `robot` to `target`.
///
/// # Errors
/// Any [`enum@Error`] for wrong input. A target that is not reached is a status, not an error.
pub fn solve(robot: &Robot, target: &Target, options: &SolveOptions, monitor: &mut dyn Monitor) -> Result<Solution> {
    let prepared = Prepared::new(robot, options)?;
    let start = options.start.as_deref();
    target.validate()?;
    start.map_or(Ok(()), |q| prepared.check_start(q))?;
    Ok(prepared.run(target, start, 0, monitor))
}

/// A robot and options that were found in order, ready for any number of targets.
#[derive(Debug)]
pub(crate) struct Prepared<'a> {
    robot: &'a Robot,
    options: &'a SolveOptions,
    bounds: Bounds,
}

impl<'a> Prepared<'a> {
    /// Checks what all targets have in common, but for [`SolveOptions::start`]: that is an argument of each.
    ///
    /// # Errors
    /// Any [`Error`] for wrong options.
    pub(crate) fn new(robot: &'a Robot, options: &'a SolveOptions) -> Result<Self> {
        options.solver.validate()?;
        options.tolerance.validate()?;
        options.stop.validate()?;
        Ok(Self { robot, options, bounds: position_box(robot, options.limits.as_ref())? })
    }

    /// Checks a start.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::NotFinite`] or [`Error::OutsideLimits`].
    pub(crate) fn check_start(&self, q: &[f64]) -> Result<()> {
        self.robot.check("start", q)?;
        require_inside(self.robot, "start", q, &self.bounds)
    }

    /// Solves for a target and a start that are in order, drawing from `stream` of the seed.
    pub(crate) fn run(
        &self,
        target: &Target,
        start: Option<&[f64]>,
        stream: u64,
        monitor: &mut dyn Monitor,
    ) -> Solution {
        let stopwatch = Stopwatch::start();
        let mut rng = rng::stream(self.options.seed, stream);
        let mut problem = Problem::new(self.robot, target, self.options.tolerance);
        let mut buffer = [0.0; MAX_DOF];
        let x0 = &mut buffer[..self.robot.dof()];
        match start {
            Some(q) => x0.copy_from_slice(q),
            None => problem.propose_start(0, &self.bounds, &mut rng, x0),
        }
        let objective: &mut dyn LeastSquares = &mut problem;
        let mut evaluator = Evaluator::new(objective, &self.bounds, self.options.stop, &mut rng, monitor);
        let outcome = self.options.solver.run(&mut evaluator, x0);
        let (evaluations, restarts) = (evaluator.evaluations(), evaluator.attempts() - 1);
        let q = evaluator.best().x.clone();
        Solution {
            status: outcome.status(),
            error: problem.verify(&q),
            iterations: outcome.iterations,
            restarts,
            evaluations,
            elapsed: stopwatch.elapsed(),
            q,
        }
    }
}

/// The position limits as a box. Velocities do not matter to a single configuration.
fn position_box(robot: &Robot, limits: Option<&Limits>) -> Result<Bounds> {
    let Some(limits) = limits else {
        return Ok(Bounds::from_ranges(robot.joints().iter().map(|joint| (joint.lower, joint.upper))));
    };
    let remedy = "a single configuration has no motion; leave it out";
    limits.require_for(robot)?;
    limits.require_none(&[Field::Acceleration, Field::Jerk], "solve", remedy)?;
    limits.position_box()
}

fn require_inside(robot: &Robot, what: &str, q: &[f64], bounds: &Bounds) -> Result<()> {
    match (0..q.len()).find(|i| q[*i] < bounds.lower()[*i] || bounds.upper()[*i] < q[*i]) {
        None => Ok(()),
        Some(i) => Err(Error::OutsideLimits {
            what: what.into(),
            joint: robot.joints()[i].name.clone(),
            value: q[i],
            lower: bounds.lower()[i],
            upper: bounds.upper()[i],
        }),
    }
}
