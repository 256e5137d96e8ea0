//! The best position of each member, and of the whole population.

use super::population::{Members, Population};

/// The best position of each member so far: p of particle swarms, and g, the best of them.
#[derive(Debug, Clone, Default)]
pub(super) struct BestPositions {
    /// The best position of each member.
    pub members: Members,
    /// Index of the best of them.
    pub leader: usize,
}

impl BestPositions {
    /// `population` members without a best position.
    pub fn new(population: usize, dimension: usize) -> Self {
        Self { members: Members::new(population, dimension), leader: 0 }
    }

    /// Updates the positions that are better in `now`; the first time, all of them.
    pub fn update(&mut self, now: &Population) {
        for i in 0..now.members.values.len() {
            if now.members.values[i] < self.members.values[i] || now.generation == 1 {
                self.members.take(i, &now.members, i);
            }
        }
        self.leader = self.members.best();
    }
}
