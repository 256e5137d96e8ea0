//! Levenberg-Marquardt with restarts on many objectives, four side by side: where one run ends, the next begins.
//!
//! Results are bit-identical to those of [`run`](super::driver::run): every decision is taken for one run alone, only the
//! arithmetic of a step is done for four at once.

use super::evaluator::Evaluator;
use super::levenberg_marquardt::{Descent, LevenbergMarquardt};
use super::multi_start::{AttemptProgress, MultiStart};
use super::status::Status;
use crate::math::MAX_DOF;
use crate::math::f64x4::F64x4;
use crate::math::four_box_steps::FourBoxSteps;
use crate::objective::{Bounds, FourLinearizations, Point, Score, SideBySide};

/// Runs side by side.
const LANES: usize = 4;

/// Rounds that the last run may be alone. Its lane does no more than a run by itself would, and takes twice the time.
const ROUNDS_ALONE: usize = 64;

/// Runs `solver` on each of `runs` (a label, a fresh evaluator, a start) in the box `bounds`, and calls `ended` with label and
/// status as each ends. The objectives must fit [`linearize_four`](SideBySide::linearize_four). The status is None where the
/// last run was left alone for long: the caller runs it again by itself.
pub(crate) fn run_side_by_side<'a, L, O: SideBySide + 'a>(
    solver: &MultiStart<LevenbergMarquardt>,
    bounds: &Bounds,
    mut runs: impl Iterator<Item = (L, Evaluator<'a, O>, Point)>,
    ended: impl FnMut(L, Evaluator<'a, O>, Option<Status>),
) {
    let mut lanes = Lanes {
        solver,
        bounds,
        ended,
        lanes: std::array::from_fn(|_| None),
        points: [[F64x4::ZERO; MAX_DOF]; 2],
        linearizations: [FourLinearizations::default(), FourLinearizations::default()],
        here: 0,
    };
    let mut rounds_alone = 0;
    while rounds_alone < ROUNDS_ALONE {
        lanes.take_up(&mut runs);
        match lanes.lanes.iter().flatten().count() {
            0 => return,
            1 => rounds_alone += 1,
            _ => rounds_alone = 0,
        }
        lanes.go_to_trials();
        let scores = lanes.evaluate();
        lanes.judge(&scores);
    }
    lanes.let_go();
}

/// Four runs, each in a lane of the arrays.
struct Lanes<'s, 'a, L, O, F> {
    solver: &'s MultiStart<LevenbergMarquardt>,
    bounds: &'s Bounds,
    ended: F,
    lanes: [Option<Lane<'a, L, O>>; LANES],
    /// One for the points, one for the trials; `here` says which is which.
    points: [[F64x4; MAX_DOF]; 2],
    linearizations: [FourLinearizations; 2],
    here: usize,
}

/// What a run has apart from the others.
struct Lane<'a, L, O> {
    label: L,
    evaluator: Evaluator<'a, O>,
    next: Next,
    descent: Descent,
    attempt: AttemptProgress,
}

/// What a run evaluates next.
enum Next {
    /// The point where it begins.
    Start(Point),
    /// The point where it begins again.
    Restart(Point),
    /// The trial of a step.
    Trial,
}

impl<'a, L, O: SideBySide + 'a, F: FnMut(L, Evaluator<'a, O>, Option<Status>)> Lanes<'_, 'a, L, O, F> {
    /// Fills lanes that are empty.
    fn take_up(&mut self, runs: &mut impl Iterator<Item = (L, Evaluator<'a, O>, Point)>) {
        for lane in self.lanes.iter_mut().filter(|lane| lane.is_none()) {
            let Some((label, evaluator, x0)) = runs.next() else { return };
            *lane = Some(Lane {
                label,
                evaluator,
                next: Next::Start(x0),
                descent: self.solver.solver.descent_from(f64::INFINITY),
                attempt: AttemptProgress::begun_at(f64::INFINITY),
            });
        }
    }

    /// Writes the points that are evaluated next.
    fn go_to_trials(&mut self) {
        self.step();
        let n = self.bounds.lower().len();
        for l in 0..LANES {
            let [first, second] = &self.points;
            let stuck = first[..n].iter().zip(second).all(|(a, b)| a.0[l] == b.0[l]);
            self.advance(l, |lane, solver| match lane.next {
                Next::Trial if stuck || lane.descent.lambda().is_err() => lane.begin_again(solver),
                _ => Ok(()),
            });
            let Some(Lane { next: Next::Start(x) | Next::Restart(x), .. }) = &mut self.lanes[l] else { continue };
            self.bounds.clip(x);
            for (trials, x) in self.points[1 - self.here].iter_mut().zip(x) {
                trials.0[l] = *x;
            }
        }
    }

    /// One bounded step in every lane; what it writes into lanes that begin means nothing.
    fn step(&mut self) {
        let lambda =
            |lane: &Option<Lane<'a, L, O>>| lane.as_ref().map_or(Ok(1.0), |lane| lane.descent.lambda()).unwrap_or(1.0);
        let n = self.bounds.lower().len();
        let FourLinearizations { residual, columns } = &self.linearizations[self.here];
        let (x, trials) = here_and_there(&mut self.points, self.here);
        let steps = FourBoxSteps {
            columns: &columns[..n],
            residual,
            lambda: F64x4(std::array::from_fn(|l| lambda(&self.lanes[l]))),
            x: &x[..n],
            lower: self.bounds.lower(),
            upper: self.bounds.upper(),
        };
        steps.write(&mut trials[..n]);
    }

    /// Scores of the trials, as far as the budgets allow; those of empty lanes mean nothing.
    fn evaluate(&mut self) -> [Score; LANES] {
        for l in 0..LANES {
            self.advance(l, |lane, _| lane.evaluator.spend(1));
        }
        let Some(any) = self.lanes.iter().flatten().next() else {
            return [Score { value: f64::INFINITY, solved: false }; LANES];
        };
        let objective = |l: usize| self.lanes[l].as_ref().unwrap_or(any).evaluator.objective();
        let there = 1 - self.here;
        let trials = &self.points[there][..self.bounds.lower().len()];
        O::linearize_four(std::array::from_fn(objective), trials, &mut self.linearizations[there])
    }

    /// Decides what becomes of the trials, and of the runs.
    fn judge(&mut self, scores: &[Score; LANES]) {
        let (n, there) = (self.bounds.lower().len(), 1 - self.here);
        let mut x = [0.0; MAX_DOF];
        for (l, score) in scores.iter().enumerate() {
            for (x, trials) in x.iter_mut().zip(&self.points[there][..n]) {
                *x = trials.0[l];
            }
            let mut keeps = true;
            self.advance(l, |lane, solver| lane.judge(&x[..n], *score, solver, &mut keeps));
            if !keeps {
                self.carry_over(l);
            }
        }
        self.here = there;
    }

    /// Takes point and linearization of a lane along where its trial was refused.
    fn carry_over(&mut self, l: usize) {
        let (n, here) = (self.bounds.lower().len(), self.here);
        let (from, to) = here_and_there(&mut self.points, here);
        from[..n].iter().zip(to).for_each(|(from, to)| to.0[l] = from.0[l]);
        let (from, to) = here_and_there(&mut self.linearizations, here);
        from.residual.iter().zip(&mut to.residual).for_each(|(from, to)| to.0[l] = from.0[l]);
        let columns = from.columns[..n].as_flattened().iter().zip(to.columns.as_flattened_mut());
        columns.for_each(|(from, to)| to.0[l] = from.0[l]);
    }

    /// Does `work` in lane `l`, if a run is there; the run ends where the work is halted.
    fn advance(
        &mut self,
        l: usize,
        work: impl FnOnce(&mut Lane<'a, L, O>, &MultiStart<LevenbergMarquardt>) -> Result<(), Status>,
    ) {
        let Some(lane) = &mut self.lanes[l] else { return };
        if let Err(signal) = work(lane, self.solver)
            && let Some(Lane { label, evaluator, .. }) = self.lanes[l].take()
        {
            let status = evaluator.final_status(signal);
            (self.ended)(label, evaluator, Some(status));
        }
    }

    /// Hands back the runs that have not ended.
    fn let_go(&mut self) {
        for Lane { label, evaluator, .. } in self.lanes.iter_mut().filter_map(Option::take) {
            (self.ended)(label, evaluator, None);
        }
    }
}

/// The one numbered `here`, and the other.
fn here_and_there<T>([first, second]: &mut [T; 2], here: usize) -> (&mut T, &mut T) {
    if here == 0 { (first, second) } else { (second, first) }
}

impl<L, O: SideBySide> Lane<'_, L, O> {
    /// Takes in the score of the point `x`; `keeps` becomes false where it is a trial that is refused.
    fn judge(
        &mut self,
        x: &[f64],
        score: Score,
        MultiStart { solver, rule }: &MultiStart<LevenbergMarquardt>,
        keeps: &mut bool,
    ) -> Result<(), Status> {
        let value = self.evaluator.record(x, score);
        if let Next::Trial = self.next {
            let verdict = solver.judge(&mut self.descent, value);
            *keeps = verdict.keeps();
            if rule.begins_again(verdict.goes_on(), &mut self.attempt, self.evaluator.attempt_value())? {
                self.next = Next::Restart(rule.next_start(&mut self.evaluator)?);
                return Ok(());
            }
        } else {
            self.descent = solver.descent_from(value);
            self.attempt = AttemptProgress::begun_at(self.evaluator.attempt_value());
            if let Next::Start(_) = std::mem::replace(&mut self.next, Next::Trial) {
                return self.evaluator.before_steps();
            }
        }
        self.evaluator.after_step()
    }

    /// Gives an attempt up that came to its end.
    fn begin_again(&mut self, solver: &MultiStart<LevenbergMarquardt>) -> Result<(), Status> {
        self.next = Next::Restart(solver.rule.next_start(&mut self.evaluator)?);
        Ok(())
    }
}
