//! One control loop: the accepted configuration, the clock, the box of the tick and the solver that moves within it.

use super::TrackOptions;
use crate::error::{Result, require_positive};
use crate::limits::{Field, LimitAt, Limits};
use crate::objective::{Bounds, LeastSquares, Objective, Point};
use crate::problem::Problem;
use crate::rng::{self, LazyRng};
use crate::robot::Robot;
use crate::solver::{AnySolver, Evaluator, Halt, Monitor, Status, Stop};
use crate::task::{Target, TipError, Tolerance};

/// What became of one tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// [`Status::Solved`] in the band, [`Status::Improved`] nearer than before, else [`Status::Capped`].
    pub status: Status,
    /// Errors at the accepted configuration.
    pub error: TipError,
    /// Position of the tip there (m).
    pub position: [f64; 3],
    /// Evaluations of the forward kinematics.
    pub evaluations: usize,
    /// Iterations of the solver; passes of the beetle.
    pub iterations: usize,
    /// False where a joint cannot be brought within its position limits in this tick.
    pub inside_limits: bool,
    /// The monitor asked to stop; nothing was accepted and time stands still.
    pub interrupted: bool,
}

/// A tracker in progress.
#[derive(Debug)]
pub struct Session<'a> {
    robot: &'a Robot,
    limits: Limits,
    limit_at: LimitAt,
    solver: AnySolver,
    tolerance: Tolerance,
    dt: f64,
    ticks: usize,
    q: Point,
    /// The value accepted in the tick before: what a random search has to beat.
    last_value: Option<f64>,
    tick_box: Bounds,
    rng: LazyRng,
}

impl<'a> Session<'a> {
    /// A session at rest in `start` (n,) at t = 0, with ticks of `dt` (s).
    ///
    /// # Errors
    /// Any [`Error`](crate::Error) for wrong input: a start outside its limits, limits that this tracker cannot keep, a
    /// time step that is not positive.
    pub fn new(robot: &'a Robot, start: &[f64], dt: f64, limits: Limits, options: &TrackOptions) -> Result<Self> {
        require_positive("dt", dt)?;
        options.solver.validate()?;
        options.tolerance.validate()?;
        limits.require_for(robot)?;
        limits.validate(0.0)?;
        let remedy = "this tracker keeps position and velocity limits; leave it out";
        limits.require_none(&[Field::Acceleration, Field::Jerk], "track", remedy)?;
        robot.check("start", start)?;
        limits.require_inside("start", 0.0, start)?;
        Ok(Self {
            robot,
            limits,
            limit_at: options.limit_at,
            solver: options.solver.clone(),
            tolerance: options.tolerance,
            dt,
            ticks: 0,
            q: Point::from_slice(start),
            last_value: None,
            tick_box: Bounds::from_ranges(start.iter().map(|q| (*q, *q))),
            rng: rng::stream(options.seed, 0),
        })
    }

    /// The accepted configuration (n,).
    pub fn q(&self) -> &[f64] {
        &self.q
    }

    /// Time of the accepted configuration (s).
    pub fn time(&self) -> f64 {
        self.ticks as f64 * self.dt
    }

    /// The limits in force.
    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// The time step (s).
    pub fn dt(&self) -> f64 {
        self.dt
    }

    pub(super) fn limit_at(&self) -> LimitAt {
        self.limit_at
    }

    pub(super) fn tolerance(&self) -> Tolerance {
        self.tolerance
    }

    /// Stands still and takes the error to `target` as what the first tick has to beat.
    pub fn begin(&mut self, target: &Target) -> Step {
        let mut problem = Problem::new(self.robot, target, self.tolerance);
        let score = problem.evaluate(&self.q);
        let error = problem.verify(&self.q);
        self.last_value = Some(score.value);
        let status = if score.solved { Status::Solved } else { Status::Improved };
        let position = self.robot.tip_position(&self.q);
        Step { status, error, position, evaluations: 1, iterations: 0, inside_limits: true, interrupted: false }
    }

    /// Moves by one tick towards `target`, inside the limits. Time advances whatever comes of it.
    ///
    /// # Errors
    /// [`Error::NotFinite`](crate::Error::NotFinite) for a target that is not finite.
    pub fn step(&mut self, target: &Target, monitor: &mut dyn Monitor) -> Result<Step> {
        target.validate()?;
        let (from, to) = (self.time(), (self.ticks + 1) as f64 * self.dt);
        let inside_limits = self.limits.narrow(&self.q, from, to, self.limit_at, &mut self.tick_box);
        let stop = self.stop();
        let mut problem = Problem::new(self.robot, target, self.tolerance);
        let objective: &mut dyn LeastSquares = &mut problem;
        let mut evaluator = Evaluator::new(objective, &self.tick_box, stop, &mut self.rng, monitor);
        let outcome = self.solver.run(&mut evaluator, &self.q);
        let best = evaluator.best();
        let improved = self.last_value.is_none_or(|last| best.value < last);
        let (value, evaluations, iterations) = (best.value, evaluator.evaluations(), outcome.iterations);
        let interrupted = outcome.halt == Halt::Interrupted;
        if !interrupted {
            self.q.copy_from_slice(&best.x);
            (self.last_value, self.ticks) = (Some(value), self.ticks + 1);
        }
        let status = match outcome.status() {
            Status::Solved => Status::Solved,
            _ if improved => Status::Improved,
            _ => Status::Capped,
        };
        let error = problem.verify(&self.q);
        let position = self.robot.tip_position(&self.q);
        Ok(Step { status, error, position, evaluations, iterations, inside_limits, interrupted })
    }

    /// When a tick's search ends short of its band. A single solver ends by its own rule, a multi-start by its budget.
    fn stop(&self) -> Stop {
        let standard = Stop::default();
        Stop {
            // Line 16 of Algorithm 1: a random search may go on to the next tick once it beats the last one.
            value_below: if self.solver.settles_for_improvement() { self.last_value } else { None },
            max_evaluations: match self.solver {
                AnySolver::Single(_) => usize::MAX,
                AnySolver::MultiStart(_) => standard.max_evaluations,
            },
            ..standard
        }
    }
}
