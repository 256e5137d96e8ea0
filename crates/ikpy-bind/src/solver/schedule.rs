//! Options common to all swarms.

use ikcore::solver::Schedule;
use pyo3::PyResult;

use crate::convert::{count, optional_count};
use crate::options::Shown;

/// Returns None for an unlimited count.
pub fn limited(count: usize) -> Option<usize> {
    Some(count).filter(|count| *count != usize::MAX)
}

/// Makes the schedule from the arguments; None means unlimited.
pub fn schedule(population: i128, max_generations: Option<i128>, stall: Option<i128>) -> PyResult<Schedule> {
    Ok(Schedule {
        population: count("population", population)?,
        max_generations: optional_count("max_generations", max_generations)?.unwrap_or(usize::MAX),
        stall_generations: optional_count("stall_generations", stall)?.unwrap_or(usize::MAX),
    })
}

/// Formats the arguments of the schedule except the population, in Python syntax.
pub fn show_schedule(schedule: &Schedule) -> String {
    let [most, stall] = [schedule.max_generations, schedule.stall_generations].map(|count| limited(count).text());
    format!("max_generations={most}, stall_generations={stall}")
}

/// Defines the getters of a solver that has a schedule.
macro_rules! scheduled {
    ($class:ident) => {
        #[pymethods]
        impl $class {
            /// Size of a generation.
            #[getter]
            fn population(&self) -> usize {
                self.0.schedule.population
            }

            /// Largest number of generations; None: as many as the budget allows.
            #[getter]
            fn max_generations(&self) -> Option<usize> {
                $crate::solver::schedule::limited(self.0.schedule.max_generations)
            }

            /// Generations without improvement after which the search ends; None: never.
            #[getter]
            fn stall_generations(&self) -> Option<usize> {
                $crate::solver::schedule::limited(self.0.schedule.stall_generations)
            }
        }
    };
}

pub(super) use scheduled;
