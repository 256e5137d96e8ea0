//! Search for the decision vector of a plan, by any derivative-free solver.

use std::cell::Cell;

use super::plan::Improvement;
use crate::error::Result;
use crate::objective::{Bounds, Objective, Point, Score};
use crate::rng;
use crate::solver::{
    AnySolver, DerivativeFree, EvaluationMonitor, Evaluator, Monitor, PatternSearch, Status, Stop, run,
};

/// A solver, its budget and its seed.
pub(crate) struct Search {
    /// The algorithm; `None`: pattern search from the start.
    pub solver: Option<AnySolver<DerivativeFree>>,
    /// Budget of the search.
    pub stop: Stop,
    /// Seed of the random draws.
    pub seed: u64,
    /// Start of the search; `None`: at random.
    pub start: Option<Point>,
}

/// Result of a search.
#[derive(Clone)]
pub(crate) struct SearchResult {
    /// The best decision vector.
    pub x: Point,
    /// Improvements, in the order of evaluations.
    pub history: Vec<Improvement>,
    /// Evaluations.
    pub evaluations: usize,
    status: Status,
}

impl SearchResult {
    /// Joins this search and a `later` one.
    pub(crate) fn then(self, later: Self) -> Self {
        let Self { mut history, evaluations, .. } = self;
        let least = history.last().map_or(f64::INFINITY, |best| best.cost);
        let lower = later.history.into_iter().filter(|improvement| improvement.cost < least);
        history.extend(lower.map(|one| Improvement { evaluations: evaluations + one.evaluations, ..one }));
        Self { history, evaluations: evaluations + later.evaluations, ..later }
    }

    /// Returns the status of a plan: solved if `keeps_everything`, else why the search ended.
    pub(crate) fn status(&self, keeps_everything: bool) -> Status {
        match self.status {
            Status::Interrupted => Status::Interrupted,
            _ if keeps_everything => Status::Solved,
            other => other,
        }
    }
}

impl Search {
    /// Minimises `cost` within `bounds`.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) for wrong options of the solver or a budget of zero.
    pub(crate) fn run(
        &self,
        cost: &mut dyn Objective,
        bounds: &Bounds,
        monitor: &mut dyn Monitor,
    ) -> Result<SearchResult> {
        let Self { solver, stop, seed, start } = self;
        solver.as_ref().map_or(Ok(()), AnySolver::<DerivativeFree>::validate)?;
        stop.validate()?;
        let done = Cell::new(0);
        let mut recorded = Recorded { cost, history: vec![], done: &done };
        let mut reporting = EvaluationMonitor { monitor, done: &done, total: stop.max_evaluations };
        // Streams from 0 on belong to the inverse kinematics of the ends.
        let mut rng = rng::stream(*seed, u64::MAX);
        let mut x0 = Point::from_elem(0.0, recorded.dimension());
        match start {
            Some(start) => x0.copy_from_slice(start),
            None => bounds.sample(&mut rng, &mut x0),
        }
        let objective: &mut dyn Objective = &mut recorded;
        let mut evaluator = Evaluator::new(objective, bounds, *stop, &mut rng, &mut reporting);
        let status = match solver {
            Some(solver) => solver.run(&mut evaluator, &x0),
            None => run(&PatternSearch, &mut evaluator, &x0),
        };
        let (x, evaluations) = (evaluator.best().x.clone(), evaluator.evaluations());
        let history = recorded.history;
        monitor.progress(evaluations, evaluations);
        Ok(SearchResult { x, history, evaluations, status })
    }
}

/// Records every improvement.
struct Recorded<'a> {
    cost: &'a mut dyn Objective,
    history: Vec<Improvement>,
    done: &'a Cell<usize>,
}

impl Objective for Recorded<'_> {
    fn dimension(&self) -> usize {
        self.cost.dimension()
    }

    fn evaluate(&mut self, x: &[f64]) -> Score {
        let score = self.cost.evaluate(x);
        self.done.set(self.done.get() + 1);
        if self.history.last().is_none_or(|best| score.value < best.cost) {
            self.history.push(Improvement { evaluations: self.done.get(), cost: score.value });
        }
        score
    }
}
