//! Differential evolution, DE/rand/1/bin (Storn and Price 1997).

use super::population::{Generation, Members, Population};
use super::schedule::Schedule;
use crate::error::{Error, Result, require_fraction};
use crate::objective::{Bounds, Objective};
use crate::rng::LazyRng;
use crate::solver::Status;
use crate::solver::driver::Solver;
use crate::solver::evaluator::Evaluator;
use crate::wording::words;

/// Time at which a trial replaces its vector, if it is no worse.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrialUpdate {
    /// Replacement after all trials, as published; the trials are evaluated together.
    Generation,
    /// Immediate replacement, so that the next trials build on it: fewer evaluations, one by one.
    Immediate,
}

words!("update": TrialUpdate { Generation => "generation", Immediate => "immediate" });

/// Options of differential evolution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DifferentialEvolution {
    /// Number of vectors and generations.
    pub schedule: Schedule,
    /// Weight F of the difference of two vectors.
    pub weight: f64,
    /// Crossover rate CR: probability that a coordinate comes from the mutant.
    pub crossover_rate: f64,
    /// Time at which a trial replaces its vector, if it is no worse.
    pub update: TrialUpdate,
}

impl Default for DifferentialEvolution {
    /// Default of F = 0.5 and CR = 0.9, the first choices of Storn and Price (1997).
    fn default() -> Self {
        Self { schedule: Schedule::of(50), weight: 0.5, crossover_rate: 0.9, update: TrialUpdate::Generation }
    }
}

impl DifferentialEvolution {
    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the option and its range.
    pub fn validate(&self) -> Result<()> {
        self.schedule.validate(4)?;
        if !(self.weight > 0.0 && self.weight <= 2.0) {
            return Err(Error::out_of_range("weight", "above 0 and at most 2", self.weight));
        }
        require_fraction("crossover_rate", self.crossover_rate)
    }
}

/// State of the population between generations.
#[derive(Debug, Clone, Default)]
pub struct State {
    population: Population,
    trials: Members,
}

impl<O: Objective + ?Sized> Solver<O> for DifferentialEvolution {
    type State = State;

    fn start(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<(), Status> {
        let population = Population::start(&self.schedule, evaluator, x0)?;
        *state = State { trials: Members::new(self.schedule.population, x0.len()), population };
        Ok(())
    }

    fn step(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Status> {
        let State { population, trials } = state;
        if population.begin_generation(&self.schedule, evaluator)? == Generation::First {
            return Ok(());
        }
        let members = &mut population.members;
        for i in 0..members.values.len() {
            self.cross(members, i, evaluator.bounds(), evaluator.rng(), trials.point_mut(i));
            if self.update == TrialUpdate::Immediate {
                trials.values[i] = evaluator.evaluate(trials.point_mut(i))?;
                select(members, trials, i);
            }
        }
        if self.update == TrialUpdate::Generation {
            trials.evaluate_from(0, evaluator)?;
            (0..members.values.len()).for_each(|i| select(members, trials, i));
        }
        Ok(())
    }
}

/// Replaces vector `i` by its trial if the trial is no worse.
fn select(members: &mut Members, trials: &Members, i: usize) {
    if trials.values[i] <= members.values[i] {
        members.take(i, trials, i);
    }
}

impl DifferentialEvolution {
    /// Writes the trial u_j = x_r1,j + F (x_r2,j - x_r3,j) with probability CR and for at least one coordinate, else x_i,j: eq.
    /// (2) and (4). A coordinate beyond a bound moves half way from x_i to the bound.
    fn cross(&self, members: &Members, i: usize, bounds: &Bounds, rng: &mut LazyRng, trial: &mut [f64]) {
        let [r1, r2, r3] = three_others(i, members.values.len(), rng);
        let (x, x1, x2, x3) = (members.point(i), members.point(r1), members.point(r2), members.point(r3));
        let forced = rng.below(trial.len());
        for j in 0..trial.len() {
            let mutated = rng.uniform() < self.crossover_rate || j == forced;
            let u = if mutated { x1[j] + self.weight * (x2[j] - x3[j]) } else { x[j] };
            let (lower, upper) = (bounds.lower()[j], bounds.upper()[j]);
            trial[j] = if u < lower {
                0.5 * (x[j] + lower)
            } else if u > upper {
                0.5 * (x[j] + upper)
            } else {
                u
            };
        }
    }
}

/// Draws three different members other than `i`, each from the remaining ones.
fn three_others(i: usize, count: usize, rng: &mut LazyRng) -> [usize; 3] {
    let mut taken = [i; 4];
    for k in 1..4 {
        let mut drawn = rng.below(count - k);
        // Each smaller index already taken, in ascending order, shifts the draw by one.
        let mut before = taken;
        before[..k].sort_unstable();
        for other in &before[..k] {
            drawn += usize::from(drawn >= *other);
        }
        taken[k] = drawn;
    }
    [taken[1], taken[2], taken[3]]
}
