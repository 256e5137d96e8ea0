//! Quantum-behaved particle swarm optimisation (Sun, Feng and Xu 2004): particles have no velocity, but are found around
//! an attractor with a spread that follows from their distance to the mean best place.

use super::driver::Solver;
use super::evaluator::{Evaluator, Halt};
use super::population::{Memory, Population, Schedule};
use crate::error::{Result, require_positive};
use crate::objective::{Objective, Point};
use crate::rng::LazyRng;

/// Quantum-behaved particle swarm optimisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Qpso {
    /// Particles and generations.
    pub schedule: Schedule,
    /// Contraction-expansion coefficient alpha; the swarm contracts below 1.78.
    pub expansion: f64,
}

impl Default for Qpso {
    /// alpha = 0.75, the fixed value that Sun et al. (2012) recommend.
    fn default() -> Self {
        Self { schedule: Schedule::of(40), expansion: 0.75 }
    }
}

impl Qpso {
    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names the option and its range.
    pub fn validate(&self) -> Result<()> {
        self.schedule.validate(2).and(require_positive("expansion", self.expansion))
    }
}

/// The swarm between generations.
#[derive(Debug, Clone)]
pub struct State {
    population: Population,
    memory: Memory,
    /// Mean of the best places.
    mean: Point,
}

impl<O: Objective + ?Sized> Solver<O> for Qpso {
    type State = State;

    fn start(&self, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<State, Halt> {
        let population = Population::start(&self.schedule, evaluator, x0)?;
        let memory = Memory::new(self.schedule.population, x0.len());
        Ok(State { population, memory, mean: Point::from_elem(0.0, x0.len()) })
    }

    fn step(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Halt> {
        let State { population, memory, mean } = state;
        if !population.is_drawn(&self.schedule, evaluator)? {
            find_mean(memory, mean);
            self.draw_particles(&mut population.members.points, memory, mean, evaluator.rng());
            population.members.evaluate_from(0, evaluator)?;
        }
        memory.update(population);
        Ok(())
    }
}

/// m = (sum over particles of p) / M.
fn find_mean(memory: &Memory, mean: &mut [f64]) {
    mean.fill(0.0);
    for p in memory.members.points() {
        mean.iter_mut().zip(p).for_each(|(mean, p)| *mean += p);
    }
    let share = 1.0 / memory.members.values.len() as f64;
    mean.iter_mut().for_each(|mean| *mean *= share);
}

impl Qpso {
    /// x = phi p + (1 - phi) g -+ alpha |m - x| ln(1/u), phi, u and the sign anew for each coordinate.
    fn draw_particles(&self, points: &mut [f64], memory: &Memory, mean: &[f64], rng: &mut LazyRng) {
        let g = memory.members.point(memory.leader);
        for (x, p) in points.chunks_exact_mut(mean.len()).zip(memory.members.points()) {
            for k in 0..mean.len() {
                let [phi, side] = rng.uniform_pair();
                // In (0, 1]: the logarithm is finite.
                let u = 1.0 - rng.uniform();
                let spread = -self.expansion * (mean[k] - x[k]).abs() * u.ln();
                x[k] = g[k] + phi * (p[k] - g[k]) + if side < 0.5 { -spread } else { spread };
            }
        }
    }
}
