//! Many targets, four side by side: for each, to the bit, what it would get alone.

use super::prepared::Prepared;
use super::run::Run;
use super::solution::Solution;
use super::solve::Prefer;
use crate::problem::Problem;
use crate::rng::{self, LazyRng};
use crate::solver::{Evaluator, LevenbergMarquardt, Monitor, MultiStart, run_side_by_side};
use crate::task::Target;

/// A target and a start that are in order.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Job<'a> {
    /// Where the tip is to be.
    pub target: Target,
    /// Where to begin.
    pub start: Option<&'a [f64]>,
    /// The stream of the seed to draw from.
    pub stream: u64,
}

/// What the evaluator of a run borrows.
struct Lent<'a, M> {
    number: usize,
    start: Option<&'a [f64]>,
    problem: Problem<'a>,
    rng: LazyRng,
    monitor: M,
}

impl Prepared<'_> {
    /// [`run`](Self::run) for all `jobs`; `ended` is told the number of each and its solution, in the order in which they end. Each
    /// asks a copy of the `monitor`; jobs that it keeps from beginning are left out.
    pub(crate) fn run_all<M: Monitor + Clone>(
        &self,
        jobs: &[Job<'_>],
        monitor: &M,
        mut ended: impl FnMut(usize, Solution),
    ) {
        let descent = self.descent_side_by_side();
        let mut lent = Vec::new();
        for (number, Job { target, start, stream }) in jobs.iter().enumerate() {
            let mut monitor = monitor.clone();
            if !monitor.keep_going() {
                return;
            }
            if descent.is_some() && self.goes_side_by_side(target) {
                let rng = rng::stream(self.options().seed, *stream);
                lent.push(Lent { number, start: *start, problem: self.problem(target), rng, monitor });
            } else {
                ended(number, self.run(target, *start, *stream, &mut monitor));
            }
        }
        if let Some(descent) = descent {
            self.run_lent(&descent, &mut lent, ended);
        }
    }

    fn run_lent<'a, M: Monitor>(
        &'a self,
        descent: &MultiStart<LevenbergMarquardt>,
        lent: &'a mut [Lent<'a, M>],
        mut ended: impl FnMut(usize, Solution),
    ) {
        let runs = lent.iter_mut().map_while(|Lent { number, start, problem, rng, monitor }| {
            if !monitor.keep_going() {
                return None;
            }
            let run = Run::one_of_four(self.options().stop);
            let x0 = self.first_start(problem, *start, rng);
            let evaluator = Evaluator::new(problem, self.bounds(), run.rest(run.reserve()), rng, monitor);
            Some(((*number, run), evaluator, x0))
        });
        run_side_by_side(descent, self.bounds(), runs, |(number, mut run), evaluator, outcome| {
            let found = run.found(&evaluator, outcome);
            let (problem, rng, monitor) = evaluator.into_parts();
            ended(number, run.concluded(self, problem, &descent.solver, found, rng, monitor));
        });
    }

    /// The descents that can be made side by side, where nothing follows them and no clock runs.
    fn descent_side_by_side(&self) -> Option<MultiStart<LevenbergMarquardt>> {
        let alone = self.options().prefer == Prefer::Any && self.goals().is_empty();
        let descent = self.options().solver.restarted_descent();
        descent.filter(|_| alone && self.options().stop.max_time.is_none())
    }

    fn goes_side_by_side(&self, target: &Target) -> bool {
        target.goes_side_by_side(self.criterion()) && self.beyond_reach(target).is_none()
    }
}
