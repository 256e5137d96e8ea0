//! The best place of each member, and of them all.

use super::population::{Members, Population};

/// The best place that each member has been at: p of particle swarms, and g, the best of them.
#[derive(Debug, Clone)]
pub(super) struct BestPlaces {
    /// Where each was at its best.
    pub members: Members,
    /// The best of them.
    pub leader: usize,
}

impl BestPlaces {
    /// Nothing remembered yet of so many members.
    pub fn new(population: usize, dimension: usize) -> Self {
        Self { members: Members::new(population, dimension), leader: 0 }
    }

    /// Takes over the places that are better in `now`; the first time, all of them.
    pub fn update(&mut self, now: &Population) {
        for i in 0..now.members.values.len() {
            if now.members.values[i] < self.members.values[i] || now.generation == 1 {
                self.members.take(i, &now.members, i);
            }
        }
        self.leader = self.members.best();
    }
}
