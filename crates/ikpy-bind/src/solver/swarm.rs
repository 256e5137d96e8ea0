//! Swarms and evolution: classes that are a population and a list of options.

use ikcore::solver::BeetleDirection;
use ikcore::solver::TrialUpdate;
use ikcore::solver::{BeeColony, BeetleSwarm, DifferentialEvolution, Firefly, Genetic, Qpso};
use pyo3::prelude::*;

use super::schedule::{limited, schedule, scheduled, show_schedule};
use crate::error::raise;
use crate::hash::content_hash;
use crate::options::{NewArguments, Shown, Taken, keywords};

/// The class of a solver whose options are a schedule and these.
macro_rules! swarm {
    ($(#[$doc:meta])* $class:ident, $name:literal, $core:ident { $($(#[$note:meta])* $option:ident: $kind:ty,)* }) => {
        $(#[$doc])*
        ///     max_generations: after so many it gives up; None: as many as the budget allows.
        ///     stall_generations: it gives up when so many in a row gain less than a millionth of the best value; None:
        ///         never.
        #[pyclass(name = $name, module = "beetle_ik", frozen, eq, from_py_object)]
        #[derive(Debug, Clone, PartialEq)]
        pub struct $class(pub $core);

        scheduled!($class);

        #[pymethods]
        impl $class {
            #[new]
            #[pyo3(signature = (*, population=$core::default().schedule.population.value(),
                                $($option=$core::default().$option.value(),)*
                                max_generations=limited($core::default().schedule.max_generations).value(),
                                stall_generations=limited($core::default().schedule.stall_generations).value()))]
            #[allow(clippy::too_many_arguments)]
            fn new(
                population: i128,
                $($option: <$kind as Shown>::Value,)*
                max_generations: Option<i128>,
                stall_generations: Option<i128>,
            ) -> PyResult<Self> {
                let solver = $core {
                    schedule: schedule(population, max_generations, stall_generations)?,
                    $($option: <$kind as Taken>::take(stringify!($option), $option)?,)*
                };
                solver.validate().map_err(raise)?;
                Ok(Self(solver))
            }

            $($(#[$note])*
            #[getter]
            fn $option(&self) -> <$kind as Shown>::Value {
                self.0.$option.value()
            })*

            fn __repr__(&self) -> String {
                let options = [$(format!("{}={}, ", stringify!($option), self.0.$option.text())),*].concat();
                let schedule = &self.0.schedule;
                format!("{}(population={}, {options}{})", $name, schedule.population, show_schedule(schedule))
            }

            fn __hash__(&self) -> u64 {
                content_hash(self)
            }

            fn __getnewargs_ex__<'py>(slf: &Bound<'py, Self>) -> PyResult<NewArguments<'py>> {
                keywords(slf, &["population", $(stringify!($option),)* "max_generations", "stall_generations"])
            }
        }
    };
}

swarm! {
    /// Quantum-behaved particle swarm optimisation (Sun, Feng and Xu 2004): uses values alone.
    ///
    /// Defaults: `QPSO(population=40, expansion=0.75, max_generations=None, stall_generations=50)`.
    ///
    /// Args:
    ///     population: particles.
    ///     expansion: contraction-expansion coefficient alpha; 0.75 is the fixed value of Sun et al. (2012).
    PyQpso, "QPSO", Qpso {
        /// Contraction-expansion coefficient.
        expansion: f64,
    }
}

swarm! {
    /// Firefly algorithm (Yang 2009): uses values alone. Fireflies have turns to attract all that are less bright.
    ///
    /// Defaults: `Firefly(population=25, attractiveness=1.0, absorption=1.0, randomness=0.2, randomness_decay=0.97,
    /// max_generations=None, stall_generations=50)`.
    ///
    /// Args:
    ///     population: fireflies.
    ///     attractiveness: beta_0, at no distance.
    ///     absorption: gamma, with distances in widths of the box.
    ///     randomness: alpha, size of the random part, as a share of the box's width.
    ///     randomness_decay: what alpha is multiplied by with every turn.
    PyFirefly, "Firefly", Firefly {
        /// Attractiveness at no distance.
        attractiveness: f64,
        /// Absorption of light.
        absorption: f64,
        /// Size of the random part at first, as a share of the box's width.
        randomness: f64,
        /// What it is multiplied by with every turn.
        randomness_decay: f64,
    }
}

swarm! {
    /// Genetic algorithm with the operators of MATLAB's `ga`: elite, tournaments, scattered crossover, Gaussian mutation.
    /// Uses values alone.
    ///
    /// Defaults: `Genetic(population=50, elite_share=0.05, crossover_share=0.8, tournament=2,
    /// mutation_rate=1.0, mutation_scale=0.1, mutation_decay=0.97, max_generations=None, stall_generations=50)`.
    ///
    /// Args:
    ///     population: members of a generation.
    ///     elite_share: share that survives unchanged, rounded up.
    ///     crossover_share: share of the others that is born by crossover; the rest by mutation.
    ///     tournament: members of a tournament, the best of which becomes a parent.
    ///     mutation_rate: probability that a coordinate of a mutant moves, one in any case; 1 moves all, as MATLAB does.
    ///     mutation_scale: standard deviation of mutations at first, as a share of the box's width.
    ///     mutation_decay: what it is multiplied by in a generation.
    PyGenetic, "Genetic", Genetic {
        /// Share that survives unchanged.
        elite_share: f64,
        /// Share of the others that is born by crossover.
        crossover_share: f64,
        /// Members of a tournament.
        tournament: usize,
        /// Probability that a coordinate of a mutant moves.
        mutation_rate: f64,
        /// Standard deviation of mutations at first, as a share of the box's width.
        mutation_scale: f64,
        /// What it is multiplied by in a generation.
        mutation_decay: f64,
    }
}

swarm! {
    /// Artificial bee colony (Karaboga 2005): uses values alone.
    ///
    /// Defaults: `BeeColony(population=20, limit=None, max_generations=None, stall_generations=50)`.
    ///
    /// Args:
    ///     population: food sources; there are as many employed bees, and as many onlookers.
    ///     limit: trials in vain after which a source is abandoned; None: sources times dimensions.
    PyBeeColony, "BeeColony", BeeColony {
        /// Trials in vain after which a source is abandoned; None: sources times dimensions.
        limit: Option<usize>,
    }
}

swarm! {
    /// Beetle swarm optimisation (Wang et al. 2019, eq. 26-32), particles with antennae: uses values alone. The equations
    /// need an inertia weight and a limit on velocities to converge; with inertia=1 and velocity_limit=1 they are literal.
    ///
    /// Defaults: `BeetleSwarm(population=50, inertia=0.729, c1=1.494, c2=1.494, velocity_limit=0.2, velocity_share=0.9,
    /// step=1.0, step_decay=0.97, step_over_antennae=5.0, direction='printed', max_generations=None,
    /// stall_generations=50)`.
    ///
    /// Args:
    ///     population: beetles; each takes three evaluations a generation.
    ///     inertia: weight of the old velocity.
    ///     c1: attraction to the beetle's own best place, eq. (27).
    ///     c2: attraction to the swarm's best place.
    ///     velocity_limit: largest velocity, as a share of the box's width a generation.
    ///     velocity_share: lambda of eq. (26), the share of the velocity in a move.
    ///     step: delta at first, eq. (28).
    ///     step_decay: eta of eq. (32).
    ///     step_over_antennae: c of eq. (31).
    ///     direction: the sign of eq. (28), as "printed" or "downhill".
    PyBeetleSwarm, "BeetleSwarm", BeetleSwarm {
        /// Weight of the old velocity.
        inertia: f64,
        /// Attraction to the beetle's own best place.
        c1: f64,
        /// Attraction to the swarm's best place.
        c2: f64,
        /// Largest velocity, as a share of the box's width.
        velocity_limit: f64,
        /// Share of the velocity in a move.
        velocity_share: f64,
        /// delta at first.
        step: f64,
        /// What delta is multiplied by in a generation.
        step_decay: f64,
        /// delta over the distance of the antennae.
        step_over_antennae: f64,
        /// "printed" or "downhill".
        direction: BeetleDirection,
    }
}

swarm! {
    /// Differential evolution, DE/rand/1/bin (Storn and Price 1997): uses values alone.
    ///
    /// Defaults: `DifferentialEvolution(population=50, weight=0.5, crossover_rate=0.9,
    /// update='generation', max_generations=None, stall_generations=50)`.
    ///
    /// Args:
    ///     population: vectors.
    ///     weight: F, weight of the difference of two vectors.
    ///     crossover_rate: CR, probability that a coordinate comes from the mutant.
    ///     update: "generation", better trials take their vectors' places after all of them, evaluated together (as
    ///         published); "immediate", at once: fewer evaluations, but one by one.
    PyDifferentialEvolution, "DifferentialEvolution", DifferentialEvolution {
        /// Weight of the difference of two vectors.
        weight: f64,
        /// Probability that a coordinate comes from the mutant.
        crossover_rate: f64,
        /// "generation" or "immediate".
        update: TrialUpdate,
    }
}
