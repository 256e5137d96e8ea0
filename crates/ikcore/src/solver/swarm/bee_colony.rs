//! Artificial bee colony (Karaboga 2005; Karaboga and Basturk 2007): employed bees search near their food source,
//! onlookers near good ones, and a scout replaces a source that has not improved for long.

use super::population::{Generation, Members, Population};
use super::schedule::Schedule;
use crate::error::{Result, require_at_least_one};
use crate::objective::Objective;
use crate::solver::Status;
use crate::solver::driver::Solver;
use crate::solver::evaluator::Evaluator;

/// Options of the artificial bee colony.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeeColony {
    /// Schedule of the food sources, each with an employed bee; there are as many onlookers. Karaboga's colony size is twice
    /// that.
    pub schedule: Schedule,
    /// Failed trials after which a source is abandoned. `None` means sources times dimensions (Karaboga and Basturk 2007).
    pub limit: Option<usize>,
}

impl Default for BeeColony {
    /// Default of 20 sources: the colony of 40 of Karaboga and Basturk (2007).
    fn default() -> Self {
        Self { schedule: Schedule::of(20), limit: None }
    }
}

impl BeeColony {
    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names the option and its range.
    pub fn validate(&self) -> Result<()> {
        self.schedule.validate(2)?;
        self.limit.map_or(Ok(()), |limit| require_at_least_one("limit", limit))
    }
}

/// State of the colony between cycles.
#[derive(Debug, Clone, Default)]
pub struct State {
    population: Population,
    /// Failed trials at each source.
    trials: Vec<usize>,
    /// Source chosen by each onlooker.
    chosen: Vec<usize>,
    /// Candidate positions.
    candidates: Members,
    /// Running sum of the fitness of the sources.
    fitness: Vec<f64>,
}

impl<O: Objective + ?Sized> Solver<O> for BeeColony {
    type State = State;

    fn start(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<(), Status> {
        let sources = self.schedule.population;
        *state = State {
            population: Population::start(&self.schedule, evaluator, x0)?,
            trials: vec![0; sources],
            chosen: vec![0; sources],
            candidates: Members::new(sources, x0.len()),
            fitness: vec![0.0; sources],
        };
        Ok(())
    }

    /// Runs one cycle: employed bees, onlookers, a scout.
    fn step(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Status> {
        if state.population.begin_generation(&self.schedule, evaluator)? == Generation::First {
            return Ok(());
        }
        for (bee, source) in state.chosen.iter_mut().enumerate() {
            *source = bee;
        }
        state.search(evaluator)?;
        state.choose_sources(evaluator);
        state.search(evaluator)?;
        self.send_scout(state, evaluator)
    }
}

impl BeeColony {
    /// Replaces the source with the most failed trials by a uniform draw, once it exceeds the limit.
    fn send_scout<O: Objective + ?Sized>(
        &self,
        state: &mut State,
        evaluator: &mut Evaluator<'_, O>,
    ) -> Result<(), Status> {
        let State { population, trials, .. } = state;
        let limit = self.limit.unwrap_or(trials.len() * evaluator.dimension());
        let worn = (1..trials.len()).fold(0, |worn, i| if trials[i] > trials[worn] { i } else { worn });
        if trials[worn] <= limit {
            return Ok(());
        }
        trials[worn] = 0;
        let source = population.members.point_mut(worn);
        evaluator.bounds().sample(evaluator.rng(), source);
        population.members.values[worn] = evaluator.evaluate(source)?;
        Ok(())
    }
}

impl State {
    /// Searches near each chosen source x, one coordinate at a time: v_j = x_j + phi (x_j - y_j), phi in [-1, 1), y another
    /// source, eq. (2) of Karaboga and Basturk (2007). The better of x and v remains.
    fn search<O: Objective + ?Sized>(&mut self, evaluator: &mut Evaluator<'_, O>) -> Result<(), Status> {
        let Self { population: Population { members, .. }, trials, chosen, candidates, .. } = self;
        let n = evaluator.dimension();
        for (bee, source) in chosen.iter().enumerate() {
            let rng = evaluator.rng();
            let j = rng.below(n);
            let other = rng.below(trials.len() - 1);
            let other = if other < *source { other } else { other + 1 };
            let phi = 2.0 * rng.uniform() - 1.0;
            let (x, y) = (members.point(*source), members.point(other));
            let candidate = candidates.point_mut(bee);
            candidate.copy_from_slice(x);
            candidate[j] += phi * (x[j] - y[j]);
        }
        candidates.evaluate_from(0, evaluator)?;
        for (bee, source) in chosen.iter().enumerate() {
            if candidates.values[bee] < members.values[*source] {
                members.take(*source, candidates, bee);
                trials[*source] = 0;
            } else {
                trials[*source] += 1;
            }
        }
        Ok(())
    }

    /// Chooses sources for the onlookers in proportion to fitness: 1 / (1 + f), or 1 + |f| for negative f.
    fn choose_sources<O: Objective + ?Sized>(&mut self, evaluator: &mut Evaluator<'_, O>) {
        let mut sum = 0.0;
        for (running, value) in self.fitness.iter_mut().zip(&self.population.members.values) {
            sum += if *value >= 0.0 { 1.0 / (1.0 + value) } else { 1.0 - value };
            *running = sum;
        }
        let last = self.fitness.len() - 1;
        for source in &mut self.chosen {
            let drawn = sum * evaluator.rng().uniform();
            *source = self.fitness.partition_point(|running| *running <= drawn).min(last);
        }
    }
}
