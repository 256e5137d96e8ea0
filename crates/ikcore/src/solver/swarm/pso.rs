//! Particle swarm optimisation, with a constriction factor (Clerc and Kennedy 2002) or an inertia weight (Shi and
//! Eberhart 1998).
//!
//! The implementation is the global-best swarm. Velocities are clamped relative to the width of the box, as Eberhart and Shi
//! (2000) recommend for both forms, and by default a particle stops at the walls of the box.

use std::fmt;

use super::best_positions::BestPositions;
use super::population::{Generation, Population, tile};
use super::schedule::Schedule;
use super::velocities::Velocities;
use crate::error::{Error, Result, require_positive};
use crate::objective::{Bounds, Objective};
use crate::rng::LazyRng;
use crate::solver::Status;
use crate::solver::driver::Solver;
use crate::solver::evaluator::Evaluator;
use crate::wording::words;

/// Rule that keeps velocities bounded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PsoForm {
    /// Constriction: the new velocity is multiplied by chi, which follows from the attractions.
    Constriction,
    /// Inertia: the old velocity is multiplied by this weight.
    Inertia(f64),
}

impl fmt::Display for PsoForm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Constriction => "constriction",
            Self::Inertia(_) => "inertia",
        })
    }
}

impl PsoForm {
    /// Returns the form with this name; `inertia` is the weight of "inertia", by default 0.729 (Eberhart and Shi 2000).
    ///
    /// # Errors
    /// [`Error::UnknownOption`] lists the names; [`Error::OutOfRange`] if an inertia is given to another form.
    pub fn named(name: &str, inertia: Option<f64>) -> Result<Self> {
        match (name, inertia) {
            ("constriction", None) => Ok(Self::Constriction),
            ("constriction", Some(weight)) => {
                Err(Error::out_of_range("inertia", "left out with form 'constriction'", weight))
            }
            ("inertia", weight) => Ok(Self::Inertia(weight.unwrap_or(0.729))),
            _ => Err(Error::unknown_option("form", name, &["constriction", "inertia"])),
        }
    }

    /// Published attraction to either best position: phi = c1 + c2 = 4.1 of Clerc and Kennedy (2002), 1.49445 of Eberhart and
    /// Shi (2000).
    pub fn attraction(self) -> f64 {
        match self {
            Self::Constriction => 2.05,
            Self::Inertia(_) => 1.49445,
        }
    }
}

/// Treatment of a coordinate that would leave the box; techniques compared by Helwig, Branke and Mostaghim (2013).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Walls {
    /// Stop at the wall, with zero velocity.
    Absorbing,
    /// Redraw in the box, with unchanged velocity, as in mealpy's PSO.
    Random,
}

words!("walls": Walls { Absorbing => "absorbing", Random => "random" });

/// Acceptance of a particle's new position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParticleAcceptance {
    /// Acceptance in any case, as published.
    Always,
    /// Acceptance only of the particle's best position so far; otherwise it returns to the best one. Faster on smooth
    /// functions; as in mealpy's PSO.
    Improving,
}

words!("accept": ParticleAcceptance { Always => "always", Improving => "improving" });

/// Options of particle swarm optimisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pso {
    /// Number of particles and generations.
    pub schedule: Schedule,
    /// Rule that keeps velocities bounded.
    pub form: PsoForm,
    /// Attraction to the best position of the particle.
    pub c1: f64,
    /// Attraction to the best position of the swarm.
    pub c2: f64,
    /// Largest velocity per generation, relative to the width of the box.
    pub velocity_limit: f64,
    /// Acceptance of a particle's new position.
    pub accept: ParticleAcceptance,
    /// Treatment of a coordinate that would leave the box.
    pub walls: Walls,
}

impl Default for Pso {
    fn default() -> Self {
        Self::of(PsoForm::Constriction)
    }
}

impl Pso {
    /// Options of a form with its published attractions. The velocity limit of half the width is the dynamic range X_max of
    /// Eberhart and Shi (2000).
    pub fn of(form: PsoForm) -> Self {
        let attraction = form.attraction();
        Self {
            schedule: Schedule::of(40),
            form,
            c1: attraction,
            c2: attraction,
            velocity_limit: 0.5,
            accept: ParticleAcceptance::Always,
            walls: Walls::Absorbing,
        }
    }

    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the option and its range.
    pub fn validate(&self) -> Result<()> {
        self.schedule.validate(2)?;
        require_positive("c1", self.c1)?;
        require_positive("c2", self.c2)?;
        if !(self.velocity_limit > 0.0) {
            return Err(Error::out_of_range("velocity_limit", "positive", self.velocity_limit));
        }
        match self.form {
            PsoForm::Inertia(weight) if !(0.0..1.0).contains(&weight) => {
                Err(Error::out_of_range("inertia", "at least 0 and below 1", weight))
            }
            PsoForm::Constriction if !(self.c1 + self.c2 > 4.0) => {
                Err(Error::out_of_range("c1 + c2", "above 4 with form 'constriction'", self.c1 + self.c2))
            }
            _ => Ok(()),
        }
    }

    /// Weights (w, c1, c2) of v = w v + c1 r1 (p - x) + c2 r2 (g - x).
    fn weights(&self) -> [f64; 3] {
        match self.form {
            PsoForm::Inertia(weight) => [weight, self.c1, self.c2],
            PsoForm::Constriction => {
                let chi = constriction(self.c1 + self.c2);
                [chi, chi * self.c1, chi * self.c2]
            }
        }
    }
}

/// Constriction factor chi = 2 / |2 - phi - sqrt(phi^2 - 4 phi)| of phi = c1 + c2, eq. (4) of Eberhart and Shi (2000).
pub(crate) fn constriction(phi: f64) -> f64 {
    2.0 / (2.0 - phi - (phi * phi - 4.0 * phi).sqrt()).abs()
}

/// State of the swarm between generations.
#[derive(Debug, Clone, Default)]
pub struct State {
    population: Population,
    memory: BestPositions,
    velocities: Velocities,
    tiled: TiledBounds,
}

impl<O: Objective + ?Sized> Solver<O> for Pso {
    type State = State;

    fn start(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<(), Status> {
        let population = Population::start(&self.schedule, evaluator, x0)?;
        *state = State {
            memory: BestPositions::new(self.schedule.population, x0.len()),
            velocities: Velocities::new(&population, self.velocity_limit),
            tiled: TiledBounds::new(evaluator.bounds(), &population),
            population,
        };
        Ok(())
    }

    fn step(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Status> {
        let State { population, memory, velocities, tiled } = state;
        if population.begin_generation(&self.schedule, evaluator)? == Generation::First {
            velocities.draw(population, evaluator.rng());
        } else {
            velocities.update(self.weights(), population, memory, evaluator.rng());
            let (points, velocities) = (&mut population.members.points, &mut velocities.all);
            match self.walls {
                Walls::Absorbing => tiled.stop(points, velocities),
                Walls::Random => tiled.draw_anew(points, velocities, evaluator.rng()),
            }
            population.members.evaluate_from(0, evaluator)?;
        }
        memory.update(population);
        if self.accept == ParticleAcceptance::Improving {
            population.members.points.copy_from_slice(&memory.members.points);
        }
        Ok(())
    }
}

/// Bounds of every coordinate of every particle.
#[derive(Debug, Clone, Default)]
struct TiledBounds {
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl TiledBounds {
    fn new(bounds: &Bounds, population: &Population) -> Self {
        let tiled = |row| {
            let mut rows = vec![0.0; population.members.points.len()];
            tile(row, &mut rows);
            rows
        };
        Self { lower: tiled(bounds.lower()), upper: tiled(bounds.upper()) }
    }

    /// Moves x = x + v; a coordinate that would leave the box stops at its bound.
    fn stop(&self, points: &mut [f64], velocities: &mut [f64]) {
        let walls = self.lower.iter().zip(&self.upper);
        for ((x, v), (lower, upper)) in points.iter_mut().zip(velocities).zip(walls) {
            move_within(x, v, *lower, *upper);
        }
    }

    /// Moves x = x + v; a coordinate that would leave the box is redrawn.
    fn draw_anew(&self, points: &mut [f64], velocities: &[f64], rng: &mut LazyRng) {
        let walls = self.lower.iter().zip(&self.upper);
        for ((x, v), (lower, upper)) in points.iter_mut().zip(velocities).zip(walls) {
            let wanted = *x + *v;
            *x = if *lower <= wanted && wanted <= *upper { wanted } else { rng.uniform_in(*lower, *upper) };
        }
    }
}

/// Moves x by v. A coordinate that meets its bound loses its velocity.
#[inline]
fn move_within(x: &mut f64, v: &mut f64, lower: f64, upper: f64) {
    let wanted = *x + *v;
    let raised = if wanted > lower { wanted } else { lower };
    *x = if raised < upper { raised } else { upper };
    *v = if *x == wanted { *v } else { 0.0 };
}
