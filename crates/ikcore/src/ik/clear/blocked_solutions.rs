//! Configurations that reach the target but are not clear.

use crate::objective::Point;
use crate::obstacle::{ClearSpace, NearestContact};

/// Largest number of stored candidates.
const KEPT: usize = 64;

/// Reservoir of candidates, spread evenly over their order of discovery.
#[derive(Debug)]
pub(super) struct BlockedSolutions {
    kept: Vec<Point>,
    /// Number of candidates added.
    pub count: usize,
    /// Spacing of the stored candidates.
    stride: usize,
}

impl BlockedSolutions {
    pub fn new() -> Self {
        Self { kept: Vec::new(), count: 0, stride: 1 }
    }

    pub fn push(&mut self, q: &[f64]) {
        if self.count.is_multiple_of(self.stride) {
            if self.kept.len() == KEPT {
                let mut number = 0;
                self.kept.retain(|_| {
                    number += 1;
                    number % 2 == 1
                });
                self.stride *= 2;
            }
            if self.count.is_multiple_of(self.stride) {
                self.kept.push(Point::from_slice(q));
            }
        }
        self.count += 1;
    }

    /// First candidate.
    pub fn first(&self) -> Option<&Point> {
        self.kept.first()
    }

    /// Stored candidates in descending order of clearance.
    pub fn by_clearance(&self, space: &ClearSpace<'_>) -> Vec<(NearestContact, Point)> {
        let nearest = |q: &Point| Some((space.clearance(q).nearest?, q.clone()));
        let mut all: Vec<(NearestContact, Point)> = self.kept.iter().filter_map(nearest).collect();
        all.sort_by(|(a, _), (b, _)| b.contact.distance.total_cmp(&a.contact.distance));
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_of_many_candidates_is_kept() {
        let mut all = BlockedSolutions::new();
        (0..1000).for_each(|i| all.push(&[f64::from(i)]));
        let kept: Vec<f64> = all.kept.iter().map(|q| q[0]).collect();
        assert!(kept.len() > KEPT / 2 - 1 && kept.len() <= KEPT && all.count == 1000);
        assert!(kept.windows(2).all(|pair| pair[1] - pair[0] == kept[1]), "{kept:?}");
        assert!(kept[0] == 0.0 && kept[kept.len() - 1] > 900.0);
    }
}
