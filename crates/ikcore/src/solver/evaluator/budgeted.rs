//! Between solver and objective: counts, clips, checks, and keeps the best.

use smallvec::SmallVec;

use super::best::Best;
use super::halt::Halt;
use crate::objective::{Bounds, CallPattern, Objective, Score};
use crate::rng::LazyRng;
use crate::solver::domain::{Conduct, Domain, Termination};
use crate::solver::stop::{Monitor, Stop, Stopwatch};

/// Points whose scores are kept on the stack.
const CHUNK: usize = 8;

/// A budgeted view of an objective in a box.
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
    pub(super) conduct: Conduct,
    /// The period of each entry; empty where everything is clipped.
    pub(super) periods: Vec<Option<f64>>,
    /// Whether the last point was solved, but outside the box.
    pub(super) solved_outside: bool,
}

/// What a run has done so far.
pub(super) struct Progress {
    evaluations: usize,
    /// Evaluations at which the monitor and the clock are asked next.
    next_poll: usize,
    best: Best,
    attempts: usize,
    /// The best value of the current attempt.
    attempt_value: f64,
}

impl Default for Progress {
    fn default() -> Self {
        Self { evaluations: 0, next_poll: 0, best: Best::default(), attempts: 1, attempt_value: f64::INFINITY }
    }
}

impl<'a, O: Objective + ?Sized> Evaluator<'a, O> {
    /// A fresh view with nothing counted yet.
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
            conduct: Conduct::default(),
            periods: Vec::new(),
            solved_outside: false,
        }
    }

    /// Takes over the declarations of a solver.
    pub(in crate::solver) fn adopt(&mut self, conduct: Conduct) {
        self.conduct = conduct;
        if conduct.domain == Domain::Wrapped {
            // A locked entry has no room to turn in.
            let locked = |i: usize| self.bounds.lower()[i] == self.bounds.upper()[i];
            let period = |i| if locked(i) { None } else { self.objective.period(i) };
            self.periods = (0..self.dimension).map(period).collect();
        }
    }

    /// What is minimised.
    pub(in crate::solver) fn objective(&self) -> &O {
        self.objective
    }

    /// What it was made of: the objective, the generator and the monitor.
    pub fn into_parts(self) -> (&'a mut O, &'a mut LazyRng, &'a mut dyn Monitor) {
        (self.objective, self.rng, self.monitor)
    }

    /// Number of entries of a point.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// The box.
    pub fn bounds(&self) -> &'a Bounds {
        self.bounds
    }

    /// The run's random generator.
    pub fn rng(&mut self) -> &mut LazyRng {
        self.rng
    }

    /// The best point so far.
    pub fn best(&self) -> &Best {
        &self.progress.best
    }

    /// Evaluations so far.
    pub fn evaluations(&self) -> usize {
        self.progress.evaluations
    }

    /// Starts tried so far.
    pub fn attempts(&self) -> usize {
        self.progress.attempts
    }

    /// The best value since the current attempt began.
    pub fn attempt_value(&self) -> f64 {
        self.progress.attempt_value
    }

    /// Counts a new attempt and writes its start into `x`.
    pub fn next_attempt(&mut self, x: &mut [f64]) {
        self.objective.propose_start(self.progress.attempts, self.bounds, self.rng, x);
        self.progress.attempts += 1;
        self.progress.attempt_value = f64::INFINITY;
    }

    /// Clips `x` to the box, or wraps it there, as the solver declared.
    #[inline]
    pub(super) fn admit(&self, x: &mut [f64]) {
        match self.conduct.domain {
            Domain::Clipped => self.bounds.clip(x),
            Domain::Wrapped => self.bounds.wrap(x, &self.periods),
        }
    }

    /// Clips `x` to the box and returns its value, infinite where it is not finite.
    ///
    /// # Errors
    /// A [`Halt`] when the budget is spent or the monitor asks to stop; `x` was not evaluated then.
    #[inline]
    pub fn evaluate(&mut self, x: &mut [f64]) -> Result<f64, Halt> {
        self.spend(1)?;
        self.admit(x);
        let score = self.objective.evaluate(x);
        Ok(self.record(x, score))
    }

    /// Clips the points stored one after another in `xs`, and writes the value of each.
    ///
    /// # Errors
    /// As for one point; with a budget for some of them only, the first ones are evaluated before the halt.
    pub fn evaluate_all(&mut self, mut xs: &mut [f64], values: &mut [f64]) -> Result<(), Halt> {
        for values in values.chunks_mut(self.pattern.batch_size) {
            let affordable = values.len().min(self.stop.max_evaluations - self.progress.evaluations);
            if affordable == 0 {
                return Err(Halt::Budget);
            }
            self.spend(affordable)?;
            let (chunk, rest) = xs.split_at_mut(affordable * self.dimension);
            self.evaluate_chunk(chunk, &mut values[..affordable]);
            if affordable < values.len() {
                return Err(Halt::Budget);
            }
            xs = rest;
        }
        Ok(())
    }

    #[inline]
    fn evaluate_chunk(&mut self, xs: &mut [f64], values: &mut [f64]) {
        let unknown = Score { value: f64::INFINITY, solved: false };
        let mut scores: SmallVec<[Score; CHUNK]> = SmallVec::from_elem(unknown, values.len());
        xs.chunks_exact_mut(self.dimension).for_each(|x| self.admit(x));
        self.objective.evaluate_all(xs, &mut scores);
        for ((x, score), value) in xs.chunks_exact(self.dimension).zip(&scores).zip(values) {
            *value = self.record(x, *score);
        }
    }

    /// What the driver asks before the first step: is the start solved already?
    ///
    /// # Errors
    /// [`Halt::Solved`].
    pub fn before_steps(&self) -> Result<(), Halt> {
        if self.stop.min_iterations == 0 { self.check_termination() } else { Ok(()) }
    }

    /// What the driver asks after every step: is it time to stop?
    ///
    /// # Errors
    /// The reason to stop.
    pub fn after_step(&self, iterations: usize) -> Result<(), Halt> {
        if iterations < self.stop.min_iterations {
            return Ok(());
        }
        self.check_termination()?;
        match self.stop.value_below {
            Some(value) if self.progress.best.value < value => Err(Halt::BelowValue),
            _ if iterations >= self.stop.max_iterations => Err(Halt::Budget),
            _ => Ok(()),
        }
    }

    /// Err(Solved) once the best point passes the problem's own test.
    ///
    /// # Errors
    /// [`Halt::Solved`].
    pub fn check_solved(&self) -> Result<(), Halt> {
        if self.progress.best.solved { Err(Halt::Solved) } else { Ok(()) }
    }

    /// Err(OutsideBox) if the last point evaluated was solved, but outside the box.
    ///
    /// # Errors
    /// [`Halt::OutsideBox`].
    pub fn check_solved_outside(&self) -> Result<(), Halt> {
        if self.solved_outside { Err(Halt::OutsideBox) } else { Ok(()) }
    }

    /// A solver with a threshold of its own goes on where others are done.
    fn check_termination(&self) -> Result<(), Halt> {
        match self.conduct.termination {
            Termination::Solved => self.check_solved(),
            Termination::Threshold => Ok(()),
        }
    }

    /// Counts evaluations, before they are made.
    ///
    /// # Errors
    /// As [`evaluate`](Self::evaluate).
    #[inline]
    pub(in crate::solver) fn spend(&mut self, count: usize) -> Result<(), Halt> {
        if self.progress.evaluations + count > self.stop.max_evaluations {
            return Err(Halt::Budget);
        }
        if self.progress.evaluations >= self.progress.next_poll {
            self.poll()?;
        }
        self.progress.evaluations += count;
        Ok(())
    }

    #[cold]
    fn poll(&mut self) -> Result<(), Halt> {
        self.progress.next_poll = self.progress.evaluations + self.pattern.poll_interval;
        if !self.monitor.keep_going() {
            return Err(Halt::Interrupted);
        }
        match (self.stop.max_time, &self.stopwatch) {
            (Some(limit), Some(watch)) if watch.elapsed() >= limit => Err(Halt::Time),
            _ => Ok(()),
        }
    }

    /// The value of a point that was evaluated; remembers it, and the point where it is better than the best.
    #[inline]
    pub(in crate::solver) fn record(&mut self, x: &[f64], score: Score) -> f64 {
        let value = if score.value.is_finite() { score.value } else { f64::INFINITY };
        self.progress.attempt_value = self.progress.attempt_value.min(value);
        let solved = score.solved && value.is_finite();
        if self.conduct.domain == Domain::Wrapped {
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
