//! Firefly algorithm (Yang 2009): fireflies move towards brighter ones, less so at a distance, plus a random part.
//!
//! The published loop runs over fireflies i and j, moves i towards j if j is brighter, and evaluates i at once. Here the loop
//! over j is the outer one: each firefly in turn attracts all dimmer ones, which are evaluated together. A step is one such
//! turn; a generation is one turn of each firefly.

use super::population::{Generation, Members, Population};
use super::schedule::Schedule;
use crate::error::{Result, require_factor, require_not_negative, require_positive};
use crate::objective::{Objective, Point};
use crate::rng::split;
use crate::solver::Status;
use crate::solver::driver::Solver;
use crate::solver::evaluator::Evaluator;

/// Options of the firefly algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Firefly {
    /// Number of fireflies and generations.
    pub schedule: Schedule,
    /// Attractiveness beta_0 at zero distance.
    pub attractiveness: f64,
    /// Absorption gamma of light, with distances relative to the width of the box.
    pub absorption: f64,
    /// Randomness alpha: size of the random part, relative to the width of the box.
    pub randomness: f64,
    /// Factor on alpha per turn.
    pub randomness_decay: f64,
}

impl Default for Firefly {
    /// Default of beta_0 = 1, gamma = 1, alpha = 0.2 and 25 fireflies (Yang 2009, 2010); the decay is Yang's (2014) 0.97.
    fn default() -> Self {
        Self {
            schedule: Schedule::of(25),
            attractiveness: 1.0,
            absorption: 1.0,
            randomness: 0.2,
            randomness_decay: 0.97,
        }
    }
}

impl Firefly {
    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names the option and its range.
    pub fn validate(&self) -> Result<()> {
        self.schedule.validate(2)?;
        require_positive("attractiveness", self.attractiveness)?;
        require_positive("randomness", self.randomness)?;
        require_not_negative("absorption", self.absorption)?;
        require_factor("randomness_decay", self.randomness_decay)
    }

    /// Schedule in turns.
    fn turns(&self) -> Schedule {
        let Schedule { population, max_generations, stall_generations } = self.schedule;
        Schedule {
            population,
            max_generations: max_generations.saturating_mul(population),
            stall_generations: stall_generations.saturating_mul(population),
        }
    }
}

/// State of the swarm between turns.
#[derive(Debug, Clone, Default)]
pub struct State {
    population: Population,
    /// Indices of the fireflies that move this turn (a prefix of the list is in use), and their next positions.
    moving: Vec<usize>,
    moved: Members,
    /// Index of the attracting firefly.
    attractor: usize,
    /// Randomness alpha of this turn.
    randomness: f64,
    /// Inverse widths of the box; zero for a locked coordinate, which does not contribute to distances.
    scales: Point,
    draws: Vec<f64>,
}

impl<O: Objective + ?Sized> Solver<O> for Firefly {
    type State = State;

    fn start(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<(), Status> {
        let fireflies = self.schedule.population;
        let population = Population::start(&self.schedule, evaluator, x0)?;
        *state = State {
            scales: population.widths.iter().map(|width| if *width > 0.0 { 1.0 / width } else { 0.0 }).collect(),
            population,
            moving: vec![0; fireflies],
            moved: Members::new(fireflies, x0.len()),
            attractor: 0,
            randomness: self.randomness,
            draws: vec![0.0; fireflies * x0.len().div_ceil(2)],
        };
        Ok(())
    }

    fn step(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Status> {
        let State { population, moving, moved, attractor, randomness, scales, draws } = state;
        if population.begin_generation(&self.turns(), evaluator)? == Generation::First {
            return Ok(());
        }
        let Population { members, widths, .. } = population;
        let (light, x_j) = (members.values[*attractor], members.point(*attractor));
        let count = list_dimmer(&members.values, light, moving);
        let moving = &moving[..count];
        let pairs = x_j.len().div_ceil(2);
        evaluator.rng().fill(&mut draws[..pairs * moving.len()]);
        let draws = draws.chunks_exact(pairs);
        for ((i, to), draws) in moving.iter().zip(moved.points.chunks_exact_mut(x_j.len())).zip(draws) {
            let x = members.point(*i);
            let beta = self.attractiveness_at(x, x_j, scales);
            fly(x, x_j, beta, *randomness, widths, draws, to);
        }
        evaluator.evaluate_all(&mut moved.points[..moving.len() * x_j.len()], &mut moved.values[..moving.len()])?;
        for (place, i) in moving.iter().enumerate() {
            members.take(*i, moved, place);
        }
        *attractor = (*attractor + 1) % members.values.len();
        *randomness *= self.randomness_decay;
        Ok(())
    }
}

/// Lists the fireflies dimmer than `light` in `moving`, and returns their number. The loop is free of unpredictable branches.
fn list_dimmer(values: &[f64], light: f64, moving: &mut [usize]) -> usize {
    let mut count = 0;
    for (i, value) in values.iter().enumerate() {
        moving[count] = i;
        count += usize::from(*value > light);
    }
    count
}

impl Firefly {
    /// Attractiveness beta = beta_0 exp(-gamma r^2), eq. (9) of Yang (2009).
    #[inline]
    fn attractiveness_at(&self, x: &[f64], x_j: &[f64], scales: &[f64]) -> f64 {
        let apart = x.iter().zip(x_j).zip(scales).map(|((x, x_j), scale)| (x_j - x) * scale);
        let squared: f64 = apart.map(|apart| apart * apart).sum();
        self.attractiveness * (-self.absorption * squared).exp()
    }
}

/// Writes x + beta (x_j - x) + alpha (u - 1/2), eq. (10) of Yang (2009); one draw gives two values of u.
#[inline]
fn fly(x: &[f64], x_j: &[f64], beta: f64, randomness: f64, widths: &[f64], draws: &[f64], to: &mut [f64]) {
    let n = to.len();
    let (x, x_j, widths) = (&x[..n], &x_j[..n], &widths[..n]);
    let moved = |k: usize, u: f64| x[k] + (beta * (x_j[k] - x[k]) + randomness * widths[k] * (u - 0.5));
    for (j, draw) in draws[..n / 2].iter().enumerate() {
        let [u, v] = split(*draw);
        (to[2 * j], to[2 * j + 1]) = (moved(2 * j, u), moved(2 * j + 1, v));
    }
    if n % 2 == 1 {
        to[n - 1] = moved(n - 1, split(draws[n / 2])[0]);
    }
}
