//! Particle swarm with a constriction factor over joint points on circles: sections 2.3 and 2.5, eq. (17) and (18), of
//! "Trajectory tracking of redundant manipulator based on PSO algorithm optimization".

use super::linkage::{Linkage, Point2};
use crate::error::{Error, Result, require_at_least_one, require_positive};
use crate::rng::LazyRng;
use crate::solver::{Monitor, Status, constriction};

/// Largest number of particles or generations.
const MOST: usize = 1_000_000;

/// Options of the published swarm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CircleSwarm {
    /// Number of particles; published 5.
    pub population: usize,
    /// Number of generations, the first draw included; published 10.
    pub generations: usize,
    /// Attraction to the best position of the particle. phi = c1 + c2 must be above 4: below that eq. (18) has no root,
    /// although the paper says "phi > 3".
    pub c1: f64,
    /// Attraction to the best position of the swarm; eq. (17) prints the particle's own.
    pub c2: f64,
    /// Velocity limit Vm of a coordinate (m per generation); not published.
    pub velocity_limit: f64,
    /// Whether random factors are in [-1, 1], as printed, instead of [0, 1].
    pub signed: bool,
}

impl Default for CircleSwarm {
    fn default() -> Self {
        Self { population: 5, generations: 10, c1: 2.05, c2: 2.05, velocity_limit: 0.2, signed: false }
    }
}

/// Draws of a particle after which no posture is assumed to exist.
const DRAWS: usize = 10_000;

/// Posture found by a search.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FoundPosture {
    /// Best posture (n,).
    pub q: Vec<f64>,
    /// Index of the posture.
    pub index: f64,
    /// Best index after each generation.
    pub history: Vec<f64>,
    /// Number of postures whose index was computed.
    pub evaluations: usize,
    /// Status [`Status::Solved`], or [`Status::Interrupted`] before the end of the search.
    pub status: Status,
}

struct Particle {
    points: Vec<Point2>,
    velocities: Vec<Point2>,
    best: (f64, Vec<Point2>),
}

struct Swarm<'a> {
    options: &'a CircleSwarm,
    linkage: &'a Linkage,
    rng: &'a mut LazyRng,
    monitor: &'a mut dyn Monitor,
    q: Vec<f64>,
    /// Index, points and configuration of the best posture.
    best: (f64, Vec<Point2>, Vec<f64>),
    evaluations: usize,
}

impl CircleSwarm {
    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the option and its range.
    pub fn validate(&self) -> Result<()> {
        for (what, count) in [("population", self.population), ("generations", self.generations)] {
            require_at_least_one(what, count)?;
            if count > MOST {
                return Err(Error::out_of_range(what, format!("at most {MOST}"), count as f64));
            }
        }
        for (what, value) in [("c1", self.c1), ("c2", self.c2), ("velocity_limit", self.velocity_limit)] {
            require_positive(what, value)?;
        }
        let phi = self.c1 + self.c2;
        if phi > 4.0 { Ok(()) } else { Err(Error::out_of_range("c1 + c2", "above 4", phi)) }
    }

    /// Searches for the best posture of `linkage`; `None` if the swarm finds none.
    pub(super) fn search(
        &self,
        linkage: &Linkage,
        rng: &mut LazyRng,
        monitor: &mut dyn Monitor,
    ) -> Option<FoundPosture> {
        let n = linkage.links();
        let best = (f64::NEG_INFINITY, vec![], vec![]);
        let mut swarm = Swarm { options: self, linkage, rng, monitor, q: vec![0.0; n], best, evaluations: 0 };
        let mut history = vec![];
        let status = swarm.run(&mut history)?;
        let (index, _, q) = swarm.best;
        Some(FoundPosture { q, index, history, evaluations: swarm.evaluations, status })
    }
}

impl Swarm<'_> {
    /// Runs all generations, or as many as the monitor allows, and appends the best index after each to `history`.
    /// `None` if a particle finds no posture.
    fn run(&mut self, history: &mut Vec<f64>) -> Option<Status> {
        let mut particles = vec![];
        for _ in 0..self.options.population {
            particles.push(self.draw()?);
            if !self.monitor.keep_going() {
                return Some(Status::Interrupted);
            }
        }
        history.push(self.best.0);
        for _ in 1..self.options.generations {
            for particle in &mut particles {
                self.advance(particle)?;
                if !self.monitor.keep_going() {
                    return Some(Status::Interrupted);
                }
            }
            history.push(self.best.0);
        }
        Some(Status::Solved)
    }

    /// Draws a random particle on the circles: steps (1) and (2) of the paper.
    fn draw(&mut self) -> Option<Particle> {
        let links = self.linkage.links();
        for _ in 0..DRAWS {
            let mut angle = || self.rng.uniform_in(-std::f64::consts::PI, std::f64::consts::PI);
            let headings: Vec<f64> = (2..links).map(|_| angle()).collect();
            let side = angle();
            let Some(points) = self.linkage.close(&headings, side) else { continue };
            let Some(index) = self.evaluate(&points) else { continue };
            let limit = self.options.velocity_limit;
            let velocities = points.iter().map(|_| [0; 2].map(|_| self.rng.uniform_in(-limit, limit))).collect();
            return Some(Particle { best: (index, points.clone()), points, velocities });
        }
        None
    }

    /// Moves a particle by one generation: eq. (17), then projection onto the circles; redrawn if that fails (step 5).
    fn advance(&mut self, particle: &mut Particle) -> Option<()> {
        let CircleSwarm { c1, c2, velocity_limit, signed, .. } = *self.options;
        // Eq. (18), where the printed equation lacks the absolute value.
        let chi = constriction(self.options.c1 + self.options.c2);
        let lowest = if signed { -1.0 } else { 0.0 };
        for (i, (point, velocity)) in particle.points.iter_mut().zip(&mut particle.velocities).enumerate() {
            for k in 0..2 {
                let [r1, r2] = [0; 2].map(|_| self.rng.uniform_in(lowest, 1.0));
                let own = c1 * r1 * (particle.best.1[i][k] - point[k]);
                let common = c2 * r2 * (self.best.1[i][k] - point[k]);
                velocity[k] = (chi * (velocity[k] + own + common)).clamp(-velocity_limit, velocity_limit);
                point[k] += velocity[k];
            }
        }
        let repaired = self.linkage.repair(&mut particle.points);
        let index = repaired.and_then(|()| self.evaluate(&particle.points));
        match index {
            Some(index) if index > particle.best.0 => particle.best = (index, particle.points.clone()),
            Some(_) => {}
            None => {
                let drawn = self.draw()?;
                (particle.points, particle.velocities) = (drawn.points, drawn.velocities);
                if drawn.best.0 > particle.best.0 {
                    particle.best = drawn.best;
                }
            }
        }
        Some(())
    }

    /// Returns the index of a posture, and records the posture if it is the best.
    fn evaluate(&mut self, points: &[Point2]) -> Option<f64> {
        let index = self.linkage.index(points, &mut self.q)?;
        self.evaluations += 1;
        if index > self.best.0 {
            self.best = (index, points.to_vec(), self.q.clone());
        }
        Some(index)
    }
}
