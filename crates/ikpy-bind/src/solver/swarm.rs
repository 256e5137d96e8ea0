//! Swarms and evolutionary algorithms: classes of a population and options.

use ikcore::solver::BeetleDirection;
use ikcore::solver::TrialUpdate;
use ikcore::solver::{BeeColony, BeetleSwarm, DifferentialEvolution, Firefly, Genetic, Qpso};
use pyo3::prelude::*;

use super::schedule::{limited, schedule, scheduled, show_schedule};
use crate::error::raise;
use crate::hash::content_hash;
use crate::options::{NewArguments, Shown, Taken, keywords};

/// Defines the class of a solver whose options are a schedule and the listed ones.
macro_rules! swarm {
    ($(#[$doc:meta])* $class:ident, $name:literal, $core:ident { $($(#[$note:meta])* $option:ident: $kind:ty,)* }) => {
        $(#[$doc])*
        ///     max_generations: largest number of generations; None: as many as the budget allows.
        ///     stall_generations: the search ends after this many generations in a row improve the best value by less than
        ///         a millionth; None: never.
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
    /// Quantum-behaved particle swarm optimisation (Sun, Feng and Xu 2004): needs only values.
    ///
    /// Defaults: `QPSO(population=40, expansion=0.75, max_generations=None, stall_generations=50)`.
    ///
    /// Args:
    ///     population: number of particles.
    ///     expansion: contraction-expansion coefficient alpha; 0.75 is the fixed value of Sun et al. (2012).
    PyQpso, "QPSO", Qpso {
        /// Contraction-expansion coefficient.
        expansion: f64,
    }
}

swarm! {
    /// Firefly algorithm (Yang 2009): needs only values. Each firefly in turn attracts all less bright fireflies.
    ///
    /// Defaults: `Firefly(population=25, attractiveness=1.0, absorption=1.0, randomness=0.2, randomness_decay=0.97,
    /// max_generations=None, stall_generations=50)`.
    ///
    /// Args:
    ///     population: number of fireflies.
    ///     attractiveness: beta_0, attractiveness at distance zero.
    ///     absorption: gamma, absorption of light, with distances in widths of the box.
    ///     randomness: alpha, size of the random step, as a fraction of the box's width.
    ///     randomness_decay: factor that multiplies alpha every turn.
    PyFirefly, "Firefly", Firefly {
        /// Attractiveness at distance zero.
        attractiveness: f64,
        /// Absorption of light.
        absorption: f64,
        /// Initial size of the random step, as a fraction of the box's width.
        randomness: f64,
        /// Factor that multiplies the randomness every turn.
        randomness_decay: f64,
    }
}

swarm! {
    /// Genetic algorithm with the operators of MATLAB's `ga`: elite, tournaments, scattered crossover, Gaussian mutation.
    /// Needs only values.
    ///
    /// Defaults: `Genetic(population=50, elite_share=0.05, crossover_share=0.8, tournament=2,
    /// mutation_rate=1.0, mutation_scale=0.1, mutation_decay=0.97, max_generations=None, stall_generations=50)`.
    ///
    /// Args:
    ///     population: size of a generation.
    ///     elite_share: fraction that survives unchanged, rounded up.
    ///     crossover_share: fraction of the remaining members produced by crossover; mutation produces the rest.
    ///     tournament: size of a tournament; its best member becomes a parent.
    ///     mutation_rate: probability that a coordinate of a mutant changes; at least one does. 1 changes all, as in MATLAB.
    ///     mutation_scale: initial standard deviation of mutations, as a fraction of the box's width.
    ///     mutation_decay: factor that multiplies the standard deviation every generation.
    PyGenetic, "Genetic", Genetic {
        /// Fraction that survives unchanged.
        elite_share: f64,
        /// Fraction of the remaining members produced by crossover.
        crossover_share: f64,
        /// Size of a tournament.
        tournament: usize,
        /// Probability that a coordinate of a mutant changes.
        mutation_rate: f64,
        /// Initial standard deviation of mutations, as a fraction of the box's width.
        mutation_scale: f64,
        /// Factor that multiplies the standard deviation every generation.
        mutation_decay: f64,
    }
}

swarm! {
    /// Artificial bee colony (Karaboga 2005): needs only values.
    ///
    /// Defaults: `BeeColony(population=20, limit=None, max_generations=None, stall_generations=50)`.
    ///
    /// Args:
    ///     population: number of food sources, of employed bees and of onlookers.
    ///     limit: unsuccessful trials after which a source is abandoned; None: sources times dimensions.
    PyBeeColony, "BeeColony", BeeColony {
        /// Unsuccessful trials after which a source is abandoned; None: sources times dimensions.
        limit: Option<usize>,
    }
}

swarm! {
    /// Beetle swarm optimisation (Wang et al. 2019, eq. 26-32), particles with antennae: needs only values. The equations
    /// converge only with an inertia weight and a velocity limit; inertia=1 and velocity_limit=1 give them literally.
    ///
    /// Defaults: `BeetleSwarm(population=50, inertia=0.729, c1=1.494, c2=1.494, velocity_limit=0.2, velocity_share=0.9,
    /// step=1.0, step_decay=0.97, step_over_antennae=5.0, direction='printed', max_generations=None,
    /// stall_generations=50)`.
    ///
    /// Args:
    ///     population: number of beetles; each needs three evaluations per generation.
    ///     inertia: weight of the old velocity.
    ///     c1: attraction to the beetle's own best point, eq. (27).
    ///     c2: attraction to the swarm's best point.
    ///     velocity_limit: largest velocity per generation, as a fraction of the box's width.
    ///     velocity_share: lambda of eq. (26), the fraction of the velocity in a move.
    ///     step: initial delta, eq. (28).
    ///     step_decay: eta of eq. (32), factor that multiplies delta every generation.
    ///     step_over_antennae: c of eq. (31), ratio of delta to the distance between the antennae.
    ///     direction: the sign of eq. (28), as "printed" or "downhill".
    PyBeetleSwarm, "BeetleSwarm", BeetleSwarm {
        /// Weight of the old velocity.
        inertia: f64,
        /// Attraction to the beetle's own best point.
        c1: f64,
        /// Attraction to the swarm's best point.
        c2: f64,
        /// Largest velocity, as a fraction of the box's width.
        velocity_limit: f64,
        /// Fraction of the velocity in a move.
        velocity_share: f64,
        /// Initial delta.
        step: f64,
        /// Factor that multiplies delta every generation.
        step_decay: f64,
        /// Ratio of delta to the distance between the antennae.
        step_over_antennae: f64,
        /// Sign of eq. (28): "printed" or "downhill".
        direction: BeetleDirection,
    }
}

swarm! {
    /// Differential evolution, DE/rand/1/bin (Storn and Price 1997): needs only values.
    ///
    /// Defaults: `DifferentialEvolution(population=50, weight=0.5, crossover_rate=0.9,
    /// update='generation', max_generations=None, stall_generations=50)`.
    ///
    /// Args:
    ///     population: number of vectors.
    ///     weight: F, weight of the difference of two vectors.
    ///     crossover_rate: CR, probability that a coordinate comes from the mutant.
    ///     update: "generation": better trials replace their vectors after the whole generation, which is evaluated together
    ///         (as published); "immediate": at once, which needs fewer evaluations, but one by one.
    PyDifferentialEvolution, "DifferentialEvolution", DifferentialEvolution {
        /// Weight of the difference of two vectors.
        weight: f64,
        /// Probability that a coordinate comes from the mutant.
        crossover_rate: f64,
        /// Time of replacement: "generation" or "immediate".
        update: TrialUpdate,
    }
}
