//! Population methods: swarms, colonies and evolution. They need objective values alone.
//!
//! [`Schedule`] sizes a population and says when it gives up; `population` holds its members and the best place of each,
//! `velocities` those of the two methods whose members have one. Each other file is one algorithm.

mod bee_colony;
pub mod beetle_swarm;
pub mod differential_evolution;
mod firefly;
mod genetic;
mod population;
pub mod pso;
mod qpso;
mod velocities;

pub use bee_colony::BeeColony;
pub use beetle_swarm::BeetleSwarm;
pub use differential_evolution::DifferentialEvolution;
pub use firefly::Firefly;
pub use genetic::Genetic;
pub use population::Schedule;
pub use pso::Pso;
pub use qpso::Qpso;
