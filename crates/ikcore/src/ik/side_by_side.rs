//! Many targets, four side by side: for each, to the bit, what it would get alone.

use std::cell::Cell;
use std::time::Duration;

use super::attempt::Run;
use super::context::Prepared;
use super::solution::Solution;
use super::solve::Prefer;
use crate::problem::Problem;
use crate::rng::{self, LazyRng};
use crate::solver::stop::Stopwatch;
use crate::solver::{Evaluator, LevenbergMarquardt, Monitor, MultiStart, run_side_by_side};
use crate::task::Target;

/// Targets for which it does not pay yet: lanes stand empty until the last one has ended.
const TOO_FEW: usize = 8;

/// A target and a start that are in order.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Query<'a> {
    /// Where the tip is to be.
    pub target: Target,
    /// Where to begin.
    pub start: Option<&'a [f64]>,
    /// The stream of the seed to draw from.
    pub stream: u64,
}

/// What the evaluator of a run borrows.
struct Workspace<'a, M> {
    number: usize,
    problem: Problem<'a>,
    rng: LazyRng,
    monitor: M,
}

impl Prepared<'_> {
    /// [`run`](Self::run) for all `queries`; `ended` is told the number of each and its solution, in the order in which they end. Each
    /// asks a copy of the `monitor`; those that it keeps from beginning are left out.
    pub(crate) fn run_all<M: Monitor + Clone>(
        &self,
        queries: &[Query<'_>],
        monitor: &M,
        mut ended: impl FnMut(usize, Solution),
    ) {
        let descent = self.descent_side_by_side().filter(|_| queries.len() >= TOO_FEW);
        let mut workspaces = Vec::new();
        for (number, Query { target, start, stream }) in queries.iter().enumerate() {
            let mut monitor = monitor.clone();
            if !monitor.keep_going() {
                return;
            }
            if descent.is_some() && self.goes_side_by_side(target) {
                let rng = rng::stream(self.options().seed, *stream);
                workspaces.push(Workspace { number, problem: self.problem(target), rng, monitor });
            } else {
                ended(number, self.run(target, *start, *stream, &mut monitor));
            }
        }
        if let Some(descent) = descent {
            self.run_in_lanes(&descent, queries, &mut workspaces, ended);
        }
    }

    /// The default solver's runs, side by side until the last one is left alone.
    fn run_in_lanes<'a, M: Monitor>(
        &'a self,
        descent: &MultiStart<LevenbergMarquardt>,
        queries: &[Query<'_>],
        workspaces: &'a mut [Workspace<'a, M>],
        mut ended: impl FnMut(usize, Solution),
    ) {
        let shared = SharedTime::start();
        let runs = workspaces.iter_mut().map_while(|Workspace { number, problem, rng, monitor }| {
            if !monitor.keep_going() {
                return None;
            }
            let (run, begun) = (Run::new(self.options().stop), shared.enter());
            let x0 = self.first_start(problem, queries[*number].start, rng);
            let evaluator = Evaluator::new(problem, self.bounds(), run.rest(run.reserve()), rng, monitor);
            Some(((*number, run, begun), evaluator, x0))
        });
        run_side_by_side(descent, self.bounds(), runs, |(number, mut run, begun), evaluator, outcome| {
            let found = outcome.map(|outcome| run.found(&evaluator, outcome));
            let (problem, rng, monitor) = evaluator.into_parts();
            let solution = match found {
                Some(found) => run.concluded(self, problem, &descent.solver, found, rng, monitor),
                None => {
                    let Query { target, start, stream } = &queries[number];
                    self.run(target, *start, *stream, monitor)
                }
            };
            ended(number, Solution { elapsed: shared.leave(begun), ..solution });
        });
    }

    /// The descents that can be made side by side, where nothing follows them and no clock runs.
    pub(crate) fn descent_side_by_side(&self) -> Option<MultiStart<LevenbergMarquardt>> {
        let alone = self.options().prefer == Prefer::Any && self.goals().is_empty();
        let descent = self.options().solver.restarted_descent();
        descent.filter(|_| alone && self.options().stop.max_time.is_none())
    }

    fn goes_side_by_side(&self, target: &Target) -> bool {
        target.goes_side_by_side(self.criterion()) && self.beyond_reach(target).is_none()
    }
}

/// Time that runs share in equal parts with those beside them.
struct SharedTime {
    stopwatch: Stopwatch,
    state: Cell<Shares>,
}

/// What a run that was there all the time would have used by `until`, and how many runs share the time from then on.
#[derive(Clone, Copy)]
struct Shares {
    until: Duration,
    each: Duration,
    runs: u32,
}

impl SharedTime {
    fn start() -> Self {
        let state = Shares { until: Duration::ZERO, each: Duration::ZERO, runs: 0 };
        Self { stopwatch: Stopwatch::start(), state: Cell::new(state) }
    }

    /// Up to now, by so many runs from now on.
    fn share(&self, runs: impl FnOnce(u32) -> u32) -> Duration {
        let (Shares { until, each, runs: before }, now) = (self.state.get(), self.stopwatch.elapsed());
        let each = each + (now - until) / before.max(1);
        self.state.set(Shares { until: now, each, runs: runs(before) });
        each
    }

    /// A run begins; what to [`leave`](Self::leave) with.
    fn enter(&self) -> Duration {
        self.share(|runs| runs + 1)
    }

    /// A run ends; its share of the time since it began.
    fn leave(&self, begun: Duration) -> Duration {
        self.share(|runs| runs - 1) - begun
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_add_up_to_the_time_that_passed() {
        let shared = SharedTime::start();
        let first = shared.enter();
        let second = shared.enter();
        let shares = [shared.leave(first), shared.leave(second)];
        let passed = shared.stopwatch.elapsed();
        assert!(shares.iter().sum::<Duration>() <= passed);
        assert!(shares[1] >= Duration::ZERO && shared.state.get().runs == 0);
    }
}
