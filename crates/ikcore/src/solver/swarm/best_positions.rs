//! Best position of each member, and of the whole population.

use super::population::{Members, Population};

/// Best positions so far: p of each member in particle swarms, and g, the best of all.
#[derive(Debug, Clone, Default)]
pub(super) struct BestPositions {
    /// Best position of each member.
    pub members: Members,
    /// Index of the best member.
    pub leader: usize,
}

impl BestPositions {
    /// Memory of `population` members without a best position.
    pub fn new(population: usize, dimension: usize) -> Self {
        Self { members: Members::new(population, dimension), leader: 0 }
    }

    /// Replaces positions by better ones in `now`; the first time, replaces all.
    pub fn update(&mut self, now: &Population) {
        for i in 0..now.members.values.len() {
            if now.members.values[i] < self.members.values[i] || now.generation == 1 {
                self.members.take(i, &now.members, i);
            }
        }
        self.leader = self.members.best();
    }
}
