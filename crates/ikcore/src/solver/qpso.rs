//! Quantum-behaved particle swarm optimisation (Sun, Feng and Xu 2004): particles have no velocity, but are found around
//! an attractor with a spread that follows from their distance to the mean best place.

use smallvec::SmallVec;

use super::driver::Solver;
use super::evaluator::{Evaluator, Halt};
use super::population::{Memory, Population, Schedule};
use crate::error::{Result, require_positive};
use crate::math::MAX_DOF;
use crate::math::logarithm::ln;
use crate::objective::{Objective, Point};
use crate::rng::{LazyRng, split};

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
        let n = mean.len();
        let g = memory.members.point(memory.leader);
        let mut draws: SmallVec<[f64; 2 * MAX_DOF]> = SmallVec::from_elem(0.0, 2 * n);
        for (x, p) in points.chunks_exact_mut(n).zip(memory.members.points()) {
            rng.fill(&mut draws);
            let (first, second) = draws.split_at(n);
            let (x, p, g, mean, second) = (&mut x[..n], &p[..n], &g[..n], &mean[..n], &second[..n]);
            for k in 0..n {
                let [phi, side] = split(first[k]);
                // 1 - u is in (0, 1], where the logarithm is finite.
                let spread = self.expansion * (mean[k] - x[k]).abs() * ln(1.0 - second[k]);
                let attractor = g[k] + phi * (p[k] - g[k]);
                x[k] = attractor + if side < 0.5 { -spread } else { spread };
            }
        }
    }
}
