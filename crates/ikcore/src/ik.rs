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
        let TipError { position, rotation } = self.error;
        let rotation = if rotation.is_nan() { String::new() } else { format!(" and {rotation:.3e} rad") };
        let errors = format!("{position:.3e} m{rotation}");
        match self.status {
            Status::Solved => format!("solved to {errors}"),
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
/// Any [`Error`](crate::Error) for wrong input. A target that is not reached is a status, not an error.
pub fn solve(robot: &Robot, target: &Target, options: &SolveOptions, monitor: &mut dyn Monitor) -> Result<Solution> {
    let stopwatch = Stopwatch::start();
    target.validate()?;
    options.solver.validate()?;
    options.tolerance.validate()?;
    options.stop.validate()?;
    let bounds = position_box(robot, options.limits.as_ref())?;
    let mut rng = rng::stream(options.seed, 0);
    let mut problem = Problem::new(robot, target, options.tolerance);
    let mut buffer = [0.0; MAX_DOF];
    let start = &mut buffer[..robot.dof()];
    match &options.start {
        Some(q) => {
            robot.check("start", q)?;
            require_inside(robot, "start", q, &bounds)?;
            start.copy_from_slice(q);
        }
        None => problem.propose_start(0, &bounds, &mut rng, start),
    }
    let objective: &mut dyn LeastSquares = &mut problem;
    let mut evaluator = Evaluator::new(objective, &bounds, options.stop, &mut rng, monitor);
    let outcome = options.solver.run(&mut evaluator, start);
    let (evaluations, restarts) = (evaluator.evaluations(), evaluator.attempts() - 1);
    let q = evaluator.best().x.clone();
    Ok(Solution {
        status: outcome.status(),
        error: problem.verify(&q),
        iterations: outcome.iterations,
        restarts,
        evaluations,
        elapsed: stopwatch.elapsed(),
        q,
    })
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
