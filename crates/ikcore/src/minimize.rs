//! Minimisation of any function in a box by a derivative-free solver.

use std::cell::Cell;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result, require_finite};
use crate::message::{Message, Setting, message};
use crate::objective::{Bounds, CallPattern, Objective, Point, Score};
use crate::rng::{self, LazyRng};
use crate::solver::{AnySolver, DerivativeFree, EvaluationMonitor, Evaluator, Monitor, Status, Stop, Stopwatch};

/// Options of [`minimize`].
#[derive(Debug, Clone)]
pub struct MinimizeOptions {
    /// Solver of the search.
    pub solver: AnySolver<DerivativeFree>,
    /// Start of the search (n,). `None` draws it from the box.
    pub start: Option<Vec<f64>>,
    /// Budgets of the search. A value below [`Stop::value_below`] ends it, also at the start.
    pub stop: Stop,
    /// Seed of the random draws; the same seed gives the same bits.
    pub seed: u64,
}

/// Best point found, and how the search ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Minimum {
    /// Best point (n,), inside the box.
    pub x: Point,
    /// Value of the function there; infinite if it was never finite.
    pub value: f64,
    /// Pairs of (evaluations made, best value then): the start, every improvement, and the end.
    pub history: Vec<[f64; 2]>,
    /// Status [`Status::Solved`] below the requested value. Otherwise the search ends by its own rule ([`Status::Stalled`]) or
    /// when its budget is spent.
    pub status: Status,
    /// Iterations over all starts.
    pub iterations: usize,
    /// Starts beyond the first.
    pub restarts: usize,
    /// Evaluations of the function.
    pub evaluations: usize,
    /// Time taken.
    pub elapsed: Duration,
}

impl Minimum {
    /// Returns a sentence on the outcome, with advice.
    pub fn message(&self) -> Message {
        let Self { value, evaluations, .. } = self;
        if value.is_infinite() {
            return format!("the function had no finite value in {evaluations} evaluations: try another box or start")
                .into();
        }
        let found = format!("best value {value:.6e} after {evaluations} evaluations");
        let end = match self.status {
            Status::Solved => "below the requested value".into(),
            Status::Stalled => "no further progress: try another start or seed, or MultiStart".into(),
            Status::BudgetSpent => {
                message![
                    "when all were spent: raise the ",
                    Setting::Budget,
                    ", or say by ",
                    Setting::EnoughValue,
                    " what is low enough"
                ]
            }
            Status::TimeUp => "when the time was up: raise max_time".into(),
            _ => "when it was stopped: run again to finish".into(),
        };
        message![found, ", ", end]
    }
}

/// Searches the box from `lower` (n,) to `upper` (n,) for the minimum of `objective`.
///
/// # Errors
/// Any [`enum@Error`] for wrong input: an unbounded or empty box, a start outside it, options out of range, a
/// population larger than the budget. A search without success is a status, not an error.
pub fn minimize(
    objective: &mut dyn Objective,
    lower: &[f64],
    upper: &[f64],
    options: &MinimizeOptions,
    monitor: &mut dyn Monitor,
) -> Result<Minimum> {
    let MinimizeOptions { solver, start, stop, seed } = options;
    solver.validate()?;
    stop.validate()?;
    solver.require_affordable(stop)?;
    let bounds = &closed_box(objective.dimension(), lower, upper)?;
    let stopwatch = Stopwatch::start();
    let mut rng = rng::stream(*seed, 0);
    let mut x0 = Point::from_elem(0.0, bounds.lower().len());
    match start {
        Some(start) => x0.copy_from_slice(require_inside(bounds, start)?),
        None => bounds.sample(&mut rng, &mut x0),
    }
    let done = Cell::new(0);
    let mut recorded = Recorded { objective, enough: stop.value_below, done: &done, history: Vec::new() };
    let mut reporting = EvaluationMonitor { monitor, done: &done, total: stop.max_evaluations };
    let narrowed: &mut dyn Objective = &mut recorded;
    let stop = Stop { value_below: None, ..*stop };
    let mut evaluator = Evaluator::new(narrowed, bounds, stop, &mut rng, &mut reporting);
    let status = solver.run(&mut evaluator, &x0);
    let (best, iterations) = (evaluator.best().clone(), evaluator.iterations());
    let (evaluations, restarts) = (evaluator.evaluations(), evaluator.attempts() - 1);
    monitor.progress(evaluations, evaluations);
    Ok(Minimum {
        x: best.x,
        value: best.value,
        history: recorded.finish(evaluations),
        status,
        iterations,
        restarts,
        evaluations,
        elapsed: stopwatch.elapsed(),
    })
}

/// Checks that the box is finite on all sides, which a derivative-free search needs.
fn closed_box(dimension: usize, lower: &[f64], upper: &[f64]) -> Result<Bounds> {
    if lower.len() != dimension || dimension == 0 {
        let expected = if dimension == 0 { "at least 1 entry".into() } else { format!("{dimension} entries") };
        return Err(Error::WrongLength { what: "lower".into(), expected, got: lower.len() });
    }
    let entry = |i| format!("entry {i}");
    require_finite("lower", lower, entry)?;
    require_finite("upper", upper, entry)?;
    let bounds = Bounds::new(lower, upper)?;
    // The width from -1e308 to 1e308 overflows.
    let widths: Vec<f64> = lower.iter().zip(upper).map(|(lower, upper)| upper - lower).collect();
    require_finite("upper - lower", &widths, entry)?;
    Ok(bounds)
}

fn require_inside<'a>(bounds: &Bounds, start: &'a [f64]) -> Result<&'a [f64]> {
    let (lower, upper) = (bounds.lower(), bounds.upper());
    if start.len() != lower.len() {
        let expected = format!("{} entries as in lower", lower.len());
        return Err(Error::WrongLength { what: "start".into(), expected, got: start.len() });
    }
    require_finite("start", start, |i| format!("entry {i}"))?;
    match (0..start.len()).find(|i| start[*i] < lower[*i] || upper[*i] < start[*i]) {
        None => Ok(start),
        Some(i) => {
            let requirement = format!("within [{}, {}]", lower[i], upper[i]);
            Err(Error::out_of_range(format!("start[{i}]"), &requirement, start[i]))
        }
    }
}

/// Objective that records every improvement, and compares values with the requested one.
struct Recorded<'a> {
    objective: &'a mut dyn Objective,
    enough: Option<f64>,
    done: &'a Cell<usize>,
    history: Vec<[f64; 2]>,
}

impl Recorded<'_> {
    fn note(&mut self, score: &mut Score) {
        self.done.set(self.done.get() + 1);
        score.solved = self.enough.is_some_and(|enough| score.value < enough);
        let value = if score.value.is_finite() { score.value } else { f64::INFINITY };
        if self.history.last().is_none_or(|[_, best]| value < *best) {
            self.history.push([self.done.get() as f64, value]);
        }
    }

    /// Returns the history with a last row for the end, unless the last evaluation was an improvement.
    fn finish(mut self, evaluations: usize) -> Vec<[f64; 2]> {
        if let Some([at, best]) = self.history.last().copied()
            && at < evaluations as f64
        {
            self.history.push([evaluations as f64, best]);
        }
        self.history
    }
}

impl Objective for Recorded<'_> {
    fn dimension(&self) -> usize {
        self.objective.dimension()
    }

    fn call_pattern(&self) -> CallPattern {
        self.objective.call_pattern()
    }

    fn evaluate(&mut self, x: &[f64]) -> Score {
        let mut score = self.objective.evaluate(x);
        self.note(&mut score);
        score
    }

    fn evaluate_all(&mut self, xs: &[f64], out: &mut [Score]) {
        self.objective.evaluate_all(xs, out);
        out.iter_mut().for_each(|score| self.note(score));
    }

    fn propose_start(&mut self, attempt: usize, bounds: &Bounds, rng: &mut LazyRng, x: &mut [f64]) {
        self.objective.propose_start(attempt, bounds, rng, x);
    }
}
