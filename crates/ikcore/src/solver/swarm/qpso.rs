//! Quantum-behaved particle swarm optimisation (Sun, Feng and Xu 2004). Particles have no velocity: they are drawn around an
//! attractor, with a spread proportional to their distance from the mean best position.

use super::best_positions::BestPositions;
use super::population::{Generation, Members, Population, tile};
use super::schedule::Schedule;
use crate::error::{Result, require_positive};
use crate::math::logarithm::ln;
use crate::objective::{Objective, Point};
use crate::rng::{LazyRng, split};
use crate::solver::Status;
use crate::solver::driver::Solver;
use crate::solver::evaluator::Evaluator;

/// Options of quantum-behaved particle swarm optimisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Qpso {
    /// Number of particles and generations.
    pub schedule: Schedule,
    /// Contraction-expansion coefficient alpha; the swarm contracts below 1.78.
    pub expansion: f64,
}

impl Default for Qpso {
    /// Default of alpha = 0.75, the fixed value that Sun et al. (2012) recommend.
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

/// State of the swarm between generations.
#[derive(Debug, Clone, Default)]
pub struct State {
    population: Population,
    memory: BestPositions,
    scratch: Scratch,
}

impl<O: Objective + ?Sized> Solver<O> for Qpso {
    type State = State;

    fn start(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<(), Status> {
        let population = Population::start(&self.schedule, evaluator, x0)?;
        let memory = BestPositions::new(self.schedule.population, x0.len());
        *state = State { scratch: Scratch::new(&population.members), population, memory };
        Ok(())
    }

    fn step(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Status> {
        let State { population, memory, scratch } = state;
        if population.begin_generation(&self.schedule, evaluator)? == Generation::Later {
            find_mean(memory, &mut scratch.mean);
            self.draw_particles(&mut population.members.points, memory, scratch, evaluator.rng());
            population.members.evaluate_from(0, evaluator)?;
        }
        memory.update(population);
        Ok(())
    }
}

/// Scratch of an update, with shared data repeated for every particle, so that an update is one long loop over all coordinates,
/// which the compiler vectorises for any dimension.
#[derive(Debug, Clone, Default)]
struct Scratch {
    /// Mean of the best positions.
    mean: Point,
    means: Vec<f64>,
    /// Best position of the swarm, repeated.
    leader: Vec<f64>,
    draws: Vec<f64>,
}

impl Scratch {
    fn new(members: &Members) -> Self {
        let none = vec![0.0; members.points.len()];
        let mean = Point::from_elem(0.0, members.dimension());
        Self { mean, means: none.clone(), leader: none.clone(), draws: none }
    }
}

/// Resolution of the second half of a draw: 27 bits.
const LAST_PLACE: f64 = 1.0 / (1_u64 << 27) as f64;

/// Computes the mean best position m = (sum over particles of p) / M.
fn find_mean(memory: &BestPositions, mean: &mut [f64]) {
    mean.fill(0.0);
    for p in memory.members.points() {
        mean.iter_mut().zip(p).for_each(|(mean, p)| *mean += p);
    }
    let share = 1.0 / memory.members.values.len() as f64;
    mean.iter_mut().for_each(|mean| *mean *= share);
}

impl Qpso {
    /// Draws x = phi p + (1 - phi) g -+ alpha |m - x| ln(1/u), with phi, u and the sign drawn for each coordinate.
    fn draw_particles(&self, points: &mut [f64], memory: &BestPositions, scratch: &mut Scratch, rng: &mut LazyRng) {
        tile(memory.members.point(memory.leader), &mut scratch.leader);
        tile(&scratch.mean, &mut scratch.means);
        rng.fill(&mut scratch.draws);
        let count = points.len();
        let (x, p) = (&mut points[..count], &memory.members.points[..count]);
        let (g, mean, draws) = (&scratch.leader[..count], &scratch.means[..count], &scratch.draws[..count]);
        for k in 0..count {
            let [phi, rest] = split(draws[k]);
            // Sign and magnitude from one draw, uniform in (-1, 1). The ends, where the logarithm is infinite, cannot occur.
            let signed = 2.0 * rest - (1.0 - LAST_PLACE);
            let spread = self.expansion * (mean[k] - x[k]).abs() * -ln(1.0 - signed.abs());
            x[k] = g[k] + phi * (p[k] - g[k]) + spread.copysign(signed);
        }
    }
}
