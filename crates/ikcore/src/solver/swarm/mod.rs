//! Population methods: swarms, colonies and evolution. They need only objective values.
//!
//! `schedule` is the size of a population and its stopping rule; `population` holds its members, `best_positions` the best
//! position of each member, `velocities` the velocities of the two methods that have them. Every other file is one algorithm.

mod bee_colony;
mod beetle_swarm;
mod best_positions;
mod differential_evolution;
mod firefly;
mod genetic;
mod population;
mod pso;
mod qpso;
mod schedule;
mod velocities;

pub use bee_colony::BeeColony;
pub use beetle_swarm::{BeetleDirection, BeetleSwarm};
pub use differential_evolution::{DifferentialEvolution, TrialUpdate};
pub use firefly::Firefly;
pub use genetic::Genetic;
pub(crate) use pso::constriction;
pub use pso::{ParticleAcceptance, Pso, PsoForm, Walls};
pub use qpso::Qpso;
pub use schedule::Schedule;
