//! Several solutions of one target, stored side by side.

use serde::{Deserialize, Serialize};

use crate::math::vector::distance;
use crate::task::TipError;

/// Configurations that reach a target, with the errors of the tip.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Solutions {
    joints: usize,
    /// Configurations (k, n), row by row.
    values: Vec<f64>,
    errors: Vec<TipError>,
}

/// View of one solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolutionView<'a> {
    /// Configuration (n,) (rad, m), inside the limits.
    pub q: &'a [f64],
    /// Errors at `q`, by forward kinematics.
    pub error: TipError,
}

impl Solutions {
    /// Empty list for an arm of `joints` joints.
    pub(super) fn new(joints: usize) -> Self {
        Self { joints, values: Vec::new(), errors: Vec::new() }
    }

    /// Adds a solution.
    #[inline]
    pub(super) fn push(&mut self, q: &[f64], error: TipError) {
        debug_assert_eq!(q.len(), self.joints);
        if self.errors.is_empty() {
            // Room for all branches of a six-joint arm in one allocation.
            self.values.reserve(8 * self.joints);
            self.errors.reserve(8);
        }
        self.values.extend_from_slice(q);
        self.errors.push(error);
    }

    /// Number of solutions.
    pub fn len(&self) -> usize {
        self.errors.len()
    }

    /// Whether there is no solution.
    pub fn is_empty(&self) -> bool {
        self.errors.is_empty()
    }

    /// Configurations (k, n), row by row (rad, m).
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Solution number `i`, counted from 0; `None` beyond the last.
    pub fn get(&self, i: usize) -> Option<SolutionView<'_>> {
        let error = *self.errors.get(i)?;
        Some(SolutionView { q: &self.values[i * self.joints..][..self.joints], error })
    }

    /// Iterates over the solutions in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = SolutionView<'_>> {
        self.values.chunks_exact(self.joints).zip(&self.errors).map(|(q, error)| SolutionView { q, error: *error })
    }

    /// Keeps the first `count` solutions.
    pub(super) fn truncate(&mut self, count: usize) {
        self.values.truncate(count.saturating_mul(self.joints));
        self.errors.truncate(count);
    }

    /// Copies the solutions for which `keep` holds, given those kept before.
    pub(super) fn filtered(&self, keep: impl Fn(&Self, &[f64]) -> bool) -> Self {
        let mut kept = Self::new(self.joints);
        for SolutionView { q, error } in self.iter() {
            if keep(&kept, q) {
                kept.push(q, error);
            }
        }
        kept
    }

    /// Sorts by the distance from `reference` (n,), nearest first.
    pub(super) fn sort_by_distance(&mut self, reference: &[f64]) {
        let mut order: Vec<(f64, usize)> =
            self.iter().enumerate().map(|(i, one)| (distance(one.q, reference), i)).collect();
        order.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let mut sorted = Self::new(self.joints);
        for one in order.iter().filter_map(|(_, i)| self.get(*i)) {
            sorted.push(one.q, one.error);
        }
        *self = sorted;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn three() -> Solutions {
        let mut all = Solutions::new(2);
        for k in [3.0, 1.0, 2.0] {
            all.push(&[k, -k], TipError { position: k, rotation: 0.0 });
        }
        all
    }

    #[test]
    fn sorting_and_filtering_keep_the_errors_beside_their_configurations() {
        let mut all = three();
        all.sort_by_distance(&[0.0, 0.0]);
        assert_eq!(all.values(), [1.0, -1.0, 2.0, -2.0, 3.0, -3.0]);
        assert!(all.iter().all(|one| one.q[0] == one.error.position));
        let odd = all.filtered(|kept, q| q[0] != 2.0 && kept.len() < 5);
        assert_eq!((odd.len(), odd.get(1).map(|one| one.q[0])), (2, Some(3.0)));
        all.truncate(1);
        assert_eq!((all.len(), all.get(1)), (1, None));
    }
}
