//! What the classes of swarms have in common: how options come from Python and go back.

use ikcore::solver::Schedule;
use ikcore::solver::beetle_swarm::Direction;
use ikcore::solver::differential_evolution::Update;
use pyo3::PyResult;

use crate::convert::{count, optional_count};
use crate::error::raise;

/// An option of a solver as the core holds it.
pub trait SolverOption: Sized {
    /// What Python gives, and gets back.
    type Given;
    fn take(name: &str, given: Self::Given) -> PyResult<Self>;
    fn give(&self) -> Self::Given;
    /// As Python writes it.
    fn show(&self) -> String;
}

impl SolverOption for f64 {
    type Given = f64;
    fn take(_: &str, given: f64) -> PyResult<Self> {
        Ok(given)
    }
    fn give(&self) -> f64 {
        *self
    }
    fn show(&self) -> String {
        self.to_string()
    }
}

impl SolverOption for usize {
    type Given = i128;
    fn take(name: &str, given: i128) -> PyResult<Self> {
        count(name, given)
    }
    fn give(&self) -> i128 {
        *self as i128
    }
    fn show(&self) -> String {
        self.to_string()
    }
}

impl SolverOption for Option<usize> {
    type Given = Option<i128>;
    fn take(name: &str, given: Self::Given) -> PyResult<Self> {
        optional_count(name, given)
    }
    fn give(&self) -> Self::Given {
        self.map(|count| count as i128)
    }
    fn show(&self) -> String {
        self.map_or_else(|| "None".into(), |count| count.to_string())
    }
}

/// Options that are one of a few names.
macro_rules! named {
    ($($option:ty),*) => {
        $(impl SolverOption for $option {
            type Given = String;
            fn take(_: &str, given: String) -> PyResult<Self> {
                given.parse().map_err(raise)
            }
            fn give(&self) -> String {
                self.to_string()
            }
            fn show(&self) -> String {
                format!("'{self}'")
            }
        })*
    };
}

named!(Direction, Update);

/// None where a count is without limit.
pub fn limited(count: usize) -> Option<usize> {
    Some(count).filter(|count| *count != usize::MAX)
}

/// The schedule of these arguments; None is without limit.
pub fn schedule(population: i128, max_generations: Option<i128>, stall: Option<i128>) -> PyResult<Schedule> {
    Ok(Schedule {
        population: count("population", population)?,
        max_generations: optional_count("max_generations", max_generations)?.unwrap_or(usize::MAX),
        stall_generations: optional_count("stall_generations", stall)?.unwrap_or(usize::MAX),
    })
}

/// The arguments of the schedule as Python writes them, population apart.
pub fn show_schedule(schedule: &Schedule) -> String {
    let [most, stall] = [schedule.max_generations, schedule.stall_generations].map(|count| limited(count).show());
    format!("max_generations={most}, stall_generations={stall}")
}
