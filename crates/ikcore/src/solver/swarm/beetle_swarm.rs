//! Beetle swarm optimisation (Wang et al. 2019, "trajectory-planning beetle swarm optimization", equations (26) to (32)):
//! particles with antennae along their velocity.
//!
//! The equations do not work as printed. In our reading, eq. (27) has an inertia weight and a limit on the velocity,
//! without which the swarm diverges; the antennae of eq. (28) to (30) are at x +- V d/2 (the paper prints one name for
//! both) with the velocity just updated, as in line 7 of its Algorithm 1. [`BeetleSwarm::literal`] has no inertia
//! weight.

use super::best_positions::BestPositions;
use super::population::{Generation, Members, Population};
use super::schedule::Schedule;
use super::velocities::Velocities;
use crate::error::{Result, require_factor, require_fraction, require_positive};
use crate::math::comparison::sign;
use crate::objective::Objective;
use crate::solver::Status;
use crate::solver::driver::Solver;
use crate::solver::evaluator::Evaluator;
use crate::wording::words;

/// Direction of a beetle along its velocity, given the values at its antennae.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BeetleDirection {
    /// Direction with the sign of F(right) - F(left), as printed in eq. (28): uphill if the velocity leads downhill, which
    /// slows the contraction of the swarm.
    Printed,
    /// Direction to the antenna with the lower value.
    Downhill,
}

words!("direction": BeetleDirection { Printed => "printed", Downhill => "downhill" });

/// Options of beetle swarm optimisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeetleSwarm {
    /// Number of beetles and generations; every beetle takes three evaluations per generation.
    pub schedule: Schedule,
    /// Inertia weight; eq. (27) has none, equivalent to 1.
    pub inertia: f64,
    /// Attraction to the best position of the beetle, eq. (27).
    pub c1: f64,
    /// Attraction to the best position of the swarm, eq. (27).
    pub c2: f64,
    /// Largest velocity per generation, relative to the width of the box.
    pub velocity_limit: f64,
    /// Weight lambda of the velocity in a move, eq. (26); the rest comes from the antennae.
    pub velocity_share: f64,
    /// Initial step delta, eq. (28).
    pub step: f64,
    /// Factor eta on delta per generation, eq. (32).
    pub step_decay: f64,
    /// Ratio c of delta to the distance d of the antennae, eq. (31).
    pub step_over_antennae: f64,
    /// Direction of the antenna term of eq. (28).
    pub direction: BeetleDirection,
}

impl Default for BeetleSwarm {
    /// Constants that work well for trajectories of arms with two to five joints; the paper prints only the update of delta.
    /// Inertia and attractions are from Eberhart and Shi (2000).
    fn default() -> Self {
        Self {
            schedule: Schedule::of(50),
            inertia: 0.729,
            c1: 1.494,
            c2: 1.494,
            velocity_limit: 0.2,
            velocity_share: 0.9,
            step: 1.0,
            step_decay: 0.97,
            step_over_antennae: 5.0,
            direction: BeetleDirection::Printed,
        }
    }
}

impl BeetleSwarm {
    /// Options of eq. (27) as printed, without inertia weight; velocities may cross the whole box.
    pub fn literal() -> Self {
        Self { inertia: 1.0, velocity_limit: 1.0, ..Self::default() }
    }

    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names the option and its range.
    pub fn validate(&self) -> Result<()> {
        self.schedule.validate(2)?;
        for (name, value) in [
            ("c1", self.c1),
            ("c2", self.c2),
            ("velocity_limit", self.velocity_limit),
            ("step", self.step),
            ("step_over_antennae", self.step_over_antennae),
        ] {
            require_positive(name, value)?;
        }
        require_fraction("inertia", self.inertia)?;
        require_fraction("velocity_share", self.velocity_share)?;
        require_factor("step_decay", self.step_decay)
    }
}

/// State of the swarm between generations.
#[derive(Debug, Clone, Default)]
pub struct State {
    population: Population,
    memory: BestPositions,
    velocities: Velocities,
    /// Right and left antenna of each beetle, alternating.
    antennae: Members,
    /// Step delta of eq. (32).
    step: f64,
}

impl<O: Objective + ?Sized> Solver<O> for BeetleSwarm {
    type State = State;

    fn start(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<(), Status> {
        let population = Population::start(&self.schedule, evaluator, x0)?;
        let beetles = self.schedule.population;
        *state = State {
            memory: BestPositions::new(beetles, x0.len()),
            velocities: Velocities::new(&population, self.velocity_limit),
            antennae: Members::new(2 * beetles, x0.len()),
            step: self.step,
            population,
        };
        Ok(())
    }

    /// Runs one generation: lines 5 to 21 of Algorithm 1.
    fn step(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Status> {
        let State { population, memory, velocities, antennae, step } = state;
        if population.begin_generation(&self.schedule, evaluator)? == Generation::First {
            velocities.draw(population, evaluator.rng());
            // The draw spans half the width; the limit applies to all velocities.
            velocities.all.iter_mut().for_each(|v| *v *= (2.0 * self.velocity_limit).min(1.0));
        } else {
            // Eq. (27), with inertia and limit.
            velocities.update([self.inertia, self.c1, self.c2], population, memory, evaluator.rng());
            self.evaluate_antennae(&population.members, &velocities.all, *step, antennae, evaluator)?;
            self.advance(&mut population.members, &velocities.all, antennae, *step);
            population.members.evaluate_from(0, evaluator)?;
            *step *= self.step_decay; // eq. (32)
        }
        memory.update(population);
        Ok(())
    }
}

impl BeetleSwarm {
    /// Evaluates x + V d/2 and x - V d/2, eq. (29) and (30), with d = delta / c, eq. (31).
    fn evaluate_antennae<O: Objective + ?Sized>(
        &self,
        beetles: &Members,
        velocities: &[f64],
        step: f64,
        antennae: &mut Members,
        evaluator: &mut Evaluator<'_, O>,
    ) -> Result<(), Status> {
        let n = evaluator.dimension();
        let half = 0.5 * step / self.step_over_antennae;
        let pairs = antennae.points.chunks_exact_mut(2 * n);
        for ((pair, x), v) in pairs.zip(beetles.points()).zip(velocities.chunks_exact(n)) {
            let (right, left) = pair.split_at_mut(n);
            for k in 0..n {
                right[k] = x[k] + half * v[k];
                left[k] = x[k] - half * v[k];
            }
        }
        antennae.evaluate_from(0, evaluator)
    }

    /// Moves the beetles: x = x + lambda V + (1 - lambda) xi, eq. (26), with xi = delta V sign(F(right) - F(left)), eq. (28).
    fn advance(&self, beetles: &mut Members, velocities: &[f64], antennae: &Members, step: f64) {
        let n = beetles.dimension();
        let beetles = beetles.points.chunks_exact_mut(n).zip(velocities.chunks_exact(n));
        for ((x, v), smells) in beetles.zip(antennae.values.chunks_exact(2)) {
            let printed = sign(smells[0] - smells[1]);
            let way = if self.direction == BeetleDirection::Printed { printed } else { -printed };
            let share = self.velocity_share + (1.0 - self.velocity_share) * step * way;
            x.iter_mut().zip(v).for_each(|(x, v)| *x += share * v);
        }
    }
}
