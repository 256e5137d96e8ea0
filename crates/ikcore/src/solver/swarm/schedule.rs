//! Schedule of a population: its size and its stopping rule.

use crate::error::{Error, Result, require_at_least_one};

/// Size of a population, and its stopping rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Schedule {
    /// Members of a generation.
    pub population: usize,
    /// Maximum number of generations, including the first.
    pub max_generations: usize,
    /// Consecutive generations without a gain of a millionth of the best value after which the swarm gives up.
    pub stall_generations: usize,
}

/// Largest population, limited by memory.
const LARGEST_POPULATION: usize = 1_000_000;

impl Schedule {
    /// Schedule of `population` members, with as many generations as the budget allows and at most 50 without a gain (the
    /// default of the MATLAB genetic algorithm).
    pub const fn of(population: usize) -> Self {
        Self { population, max_generations: usize::MAX, stall_generations: 50 }
    }

    /// Checks the counts, for an algorithm that needs at least `fewest` members.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the option and its range.
    pub fn validate(&self, fewest: usize) -> Result<()> {
        let Self { population, max_generations, stall_generations } = *self;
        if !(fewest..=LARGEST_POPULATION).contains(&population) {
            let requirement = format!("between {fewest} and {LARGEST_POPULATION}");
            return Err(Error::out_of_range("population", &requirement, population as f64));
        }
        require_at_least_one("max_generations", max_generations)?;
        require_at_least_one("stall_generations", stall_generations)
    }
}
