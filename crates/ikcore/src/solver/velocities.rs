//! Velocities of a swarm of particles: those of PSO, and of beetles that fly as particles do.
//!
//! What is the same for all particles is laid out as their coordinates are, particle by particle, so that each update is
//! one long loop, which the compiler vectorises whatever the dimension.

use super::population::{Memory, Population, repeat};
use crate::rng::{LazyRng, split};

/// The velocities, and what turning them takes.
#[derive(Debug, Clone)]
pub struct Velocities {
    /// All coordinates, particle by particle.
    pub all: Vec<f64>,
    /// Largest velocities.
    most: Vec<f64>,
    /// The swarm's best place.
    leader: Vec<f64>,
    draws: Vec<f64>,
}

impl Velocities {
    /// Particles at rest; `limit` is the largest velocity as a share of the box's width a generation; infinite: none.
    pub fn new(population: &Population, limit: f64) -> Self {
        let none = vec![0.0; population.members.points.len()];
        let mut most = none.clone();
        repeat(&population.widths, &mut most);
        // Of an infinite share of no width there is no telling.
        most.iter_mut().for_each(|most| *most = if limit.is_finite() { limit * *most } else { f64::INFINITY });
        Self { all: none.clone(), most, leader: none.clone(), draws: none }
    }

    /// Half way from each particle to a uniform draw around it: at most half the width (standard PSO 2007).
    pub fn draw(&mut self, population: &Population, rng: &mut LazyRng) {
        for v in self.all.chunks_exact_mut(population.widths.len()) {
            for (v, width) in v.iter_mut().zip(&population.widths) {
                *v = 0.5 * width * (2.0 * rng.uniform() - 1.0);
            }
        }
    }

    /// v = w v + c1 r1 (p - x) + c2 r2 (g - x), r1 and r2 anew for each coordinate, clamped to the largest.
    pub fn turn(&mut self, [w, c1, c2]: [f64; 3], population: &Population, memory: &Memory, rng: &mut LazyRng) {
        repeat(memory.members.point(memory.leader), &mut self.leader);
        rng.fill(&mut self.draws);
        let count = self.all.len();
        let (x, p, g) = (&population.members.points[..count], &memory.members.points[..count], &self.leader[..count]);
        let (v, most, draws) = (&mut self.all[..count], &self.most[..count], &self.draws[..count]);
        for k in 0..count {
            let [r1, r2] = split(draws[k]);
            let wanted = w * v[k] + c1 * r1 * (p[k] - x[k]) + c2 * r2 * (g[k] - x[k]);
            let raised = if wanted > -most[k] { wanted } else { -most[k] };
            v[k] = if raised < most[k] { raised } else { most[k] };
        }
    }
}
