//! Evaluator: counts, budgets, and the end of a run.

use super::best_point::BestPoint;
use crate::objective::{Bounds, CallPattern, Objective, Score};
use crate::rng::LazyRng;
use crate::solver::domain::Domain;
use crate::solver::monitor::Monitor;
use crate::solver::status::Status;
use crate::solver::stop::Stop;
use crate::solver::stopwatch::Stopwatch;

/// Budgeted view of an objective in a box.
pub struct Evaluator<'a, O: ?Sized> {
    pub(super) objective: &'a mut O,
    pub(super) bounds: &'a Bounds,
    pub(super) stop: Stop,
    pub(super) rng: &'a mut LazyRng,
    pub(super) monitor: &'a mut dyn Monitor,
    pub(super) stopwatch: Option<Stopwatch>,
    pub(super) progress: Progress,
    pub(super) dimension: usize,
    pub(super) pattern: CallPattern,
    pub(super) domain: Domain,
    /// Whether the solver ends at its own threshold.
    pub(super) own_threshold: bool,
    /// Period of each entry; empty if all entries are clipped.
    pub(super) periods: Vec<Option<f64>>,
    /// Whether the last point was solved, but outside the box.
    pub(super) solved_outside: bool,
}

/// Counts of a run so far, and its best point.
pub(super) struct Progress {
    pub(super) evaluations: usize,
    iterations: usize,
    /// Number of evaluations at which monitor and clock are polled next.
    next_poll: usize,
    best: BestPoint,
    attempts: usize,
    /// Best value of the current attempt.
    attempt_value: f64,
}

impl Default for Progress {
    fn default() -> Self {
        Self {
            evaluations: 0,
            iterations: 0,
            next_poll: 0,
            best: BestPoint::default(),
            attempts: 1,
            attempt_value: f64::INFINITY,
        }
    }
}

impl<'a, O: Objective + ?Sized> Evaluator<'a, O> {
    /// Evaluator with all counts at zero.
    pub fn new(
        objective: &'a mut O,
        bounds: &'a Bounds,
        stop: Stop,
        rng: &'a mut LazyRng,
        monitor: &'a mut dyn Monitor,
    ) -> Self {
        let pattern = objective.call_pattern();
        Self {
            dimension: objective.dimension(),
            objective,
            bounds,
            stop,
            rng,
            monitor,
            stopwatch: stop.max_time.map(|_| Stopwatch::start()),
            progress: Progress { next_poll: pattern.poll_interval, ..Progress::default() },
            pattern,
            domain: Domain::Clipped,
            own_threshold: false,
            periods: Vec::new(),
            solved_outside: false,
        }
    }

    /// Adopts the declarations of a solver.
    pub(in crate::solver) fn adopt(&mut self, domain: Domain, own_threshold: bool) {
        (self.domain, self.own_threshold) = (domain, own_threshold);
        if domain == Domain::Wrapped {
            // A locked entry cannot be shifted by a period.
            let locked = |i: usize| self.bounds.lower()[i] == self.bounds.upper()[i];
            let period = |i| if locked(i) { None } else { self.objective.period(i) };
            self.periods = (0..self.dimension).map(period).collect();
        }
    }

    /// Number of entries of a point.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Box of the search.
    pub fn bounds(&self) -> &'a Bounds {
        self.bounds
    }

    /// Random generator of the run.
    pub fn rng(&mut self) -> &mut LazyRng {
        self.rng
    }

    /// Best point so far.
    pub fn best(&self) -> &BestPoint {
        &self.progress.best
    }

    /// Evaluations so far.
    pub fn evaluations(&self) -> usize {
        self.progress.evaluations
    }

    /// Finished steps so far.
    pub fn iterations(&self) -> usize {
        self.progress.iterations
    }

    /// Starts tried so far.
    pub fn attempts(&self) -> usize {
        self.progress.attempts
    }

    /// Best value of the current attempt.
    pub fn attempt_value(&self) -> f64 {
        self.progress.attempt_value
    }

    /// Counts a new attempt and writes its start into `x`.
    pub(in crate::solver) fn next_attempt(&mut self, x: &mut [f64]) {
        self.objective.propose_start(self.progress.attempts, self.bounds, self.rng, x);
        self.progress.attempts += 1;
        self.progress.attempt_value = f64::INFINITY;
    }

    /// Clips `x` to the box or wraps it into the box, as declared by the solver.
    #[inline]
    pub(super) fn admit(&self, x: &mut [f64]) {
        match self.domain {
            Domain::Clipped => self.bounds.clip(x),
            Domain::Wrapped => self.bounds.wrap(x, &self.periods),
        }
    }

    /// Ends the run before the first step if the start is solved already.
    ///
    /// # Errors
    /// [`Status::Solved`].
    pub fn before_steps(&self) -> Result<(), Status> {
        if self.stop.min_iterations == 0 { self.check_termination() } else { Ok(()) }
    }

    /// Counts a finished step and checks whether the run ends after it.
    ///
    /// # Errors
    /// Status that ends the run.
    pub(in crate::solver) fn after_step(&mut self) -> Result<(), Status> {
        self.progress.iterations += 1;
        let iterations = self.progress.iterations;
        if iterations < self.stop.min_iterations {
            return Ok(());
        }
        self.check_termination()?;
        match self.stop.value_below {
            Some(value) if self.progress.best.value < value => Err(Status::Improved),
            _ if iterations >= self.stop.max_iterations => Err(Status::BudgetSpent),
            _ => Ok(()),
        }
    }

    /// Final status of a run that `signal` ended. A step may have found a solution before a budget ran out.
    pub(in crate::solver) fn final_status(&self, signal: Status) -> Status {
        if self.progress.best.solved { Status::Solved } else { signal }
    }

    /// Ends the run once the best point passes the problem's own test.
    ///
    /// # Errors
    /// [`Status::Solved`].
    pub fn check_solved(&self) -> Result<(), Status> {
        if self.progress.best.solved { Err(Status::Solved) } else { Ok(()) }
    }

    /// Ends the run if the last point evaluated was solved, but outside the box.
    ///
    /// # Errors
    /// [`Status::OutsideLimits`].
    pub fn check_solved_outside(&self) -> Result<(), Status> {
        if self.solved_outside { Err(Status::OutsideLimits) } else { Ok(()) }
    }

    /// Ends the run if it is solved, unless the solver has its own threshold.
    fn check_termination(&self) -> Result<(), Status> {
        if self.own_threshold { Ok(()) } else { self.check_solved() }
    }

    /// Counts evaluations before they are made.
    ///
    /// # Errors
    /// As [`evaluate`](Self::evaluate).
    #[inline]
    pub(in crate::solver) fn spend(&mut self, count: usize) -> Result<(), Status> {
        if self.progress.evaluations + count > self.stop.max_evaluations {
            return Err(Status::BudgetSpent);
        }
        if self.progress.evaluations >= self.progress.next_poll {
            self.poll()?;
        }
        self.progress.evaluations += count;
        Ok(())
    }

    #[cold]
    fn poll(&mut self) -> Result<(), Status> {
        self.progress.next_poll = self.progress.evaluations + self.pattern.poll_interval;
        if !self.monitor.keep_going() {
            return Err(Status::Interrupted);
        }
        match (self.stop.max_time, &self.stopwatch) {
            (Some(limit), Some(watch)) if watch.elapsed() >= limit => Err(Status::TimeUp),
            _ => Ok(()),
        }
    }

    /// Records the score of `x`, keeps `x` if it is the best so far, and returns its value.
    #[inline]
    pub(in crate::solver) fn record(&mut self, x: &[f64], score: Score) -> f64 {
        let value = if score.value.is_finite() { score.value } else { f64::INFINITY };
        self.progress.attempt_value = self.progress.attempt_value.min(value);
        let solved = score.solved && value.is_finite();
        if self.domain == Domain::Wrapped {
            let outside = !self.bounds.contains(x);
            self.solved_outside = solved && outside;
            if outside {
                return value;
            }
        }
        self.progress.best.challenge(x, value, solved);
        value
    }
}
