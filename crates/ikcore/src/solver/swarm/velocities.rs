//! Velocities of a particle swarm or a beetle swarm.
//!
//! Shared data is repeated for each particle, so that an update is one long loop over all coordinates, which the
//! compiler vectorises for any dimension.

use super::best_positions::BestPositions;
use super::population::{Population, tile};
use crate::rng::{LazyRng, split};

/// Velocities of all particles.
#[derive(Debug, Clone, Default)]
pub(super) struct Velocities {
    /// Coordinates, particle by particle.
    pub all: Vec<f64>,
    /// Velocity limits, for every coordinate of every particle.
    limits: Vec<f64>,
    /// Best position of the swarm, repeated.
    leader: Vec<f64>,
    draws: Vec<f64>,
}

impl Velocities {
    /// Particles at rest. `limit` is the largest velocity per generation relative to the width of the box; infinite means no
    /// limit.
    pub fn new(population: &Population, limit: f64) -> Self {
        let none = vec![0.0; population.members.points.len()];
        let mut limits = none.clone();
        tile(&population.widths, &mut limits);
        // Infinity times a width of zero would be NaN.
        limits.iter_mut().for_each(|width| *width = if limit.is_finite() { limit * *width } else { f64::INFINITY });
        Self { all: none.clone(), limits, leader: none.clone(), draws: none }
    }

    /// Draws the initial velocities: uniform within half the width of the box (standard PSO 2007).
    pub fn draw(&mut self, population: &Population, rng: &mut LazyRng) {
        for v in self.all.chunks_exact_mut(population.widths.len()) {
            for (v, width) in v.iter_mut().zip(&population.widths) {
                *v = 0.5 * width * (2.0 * rng.uniform() - 1.0);
            }
        }
    }

    /// Updates v = w v + c1 r1 (p - x) + c2 r2 (g - x), with r1 and r2 drawn for each coordinate, and clamps it to the limits.
    pub fn update(
        &mut self,
        [w, c1, c2]: [f64; 3],
        population: &Population,
        memory: &BestPositions,
        rng: &mut LazyRng,
    ) {
        tile(memory.members.point(memory.leader), &mut self.leader);
        rng.fill(&mut self.draws);
        let count = self.all.len();
        let (x, p, g) = (&population.members.points[..count], &memory.members.points[..count], &self.leader[..count]);
        let (v, limits, draws) = (&mut self.all[..count], &self.limits[..count], &self.draws[..count]);
        for k in 0..count {
            let [r1, r2] = split(draws[k]);
            let wanted = w * v[k] + c1 * r1 * (p[k] - x[k]) + c2 * r2 * (g[k] - x[k]);
            let raised = if wanted > -limits[k] { wanted } else { -limits[k] };
            v[k] = if raised < limits[k] { raised } else { limits[k] };
        }
    }
}
