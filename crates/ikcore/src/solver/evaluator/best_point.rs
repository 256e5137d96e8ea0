//! Best point of a run.

use crate::objective::Point;

/// Best point of a run so far.
#[derive(Debug, Clone, PartialEq)]
pub struct BestPoint {
    /// Coordinates; empty before the first evaluation.
    pub x: Point,
    /// Value; infinite if the objective was never finite.
    pub value: f64,
    /// Whether the point passes the problem's own test.
    pub solved: bool,
}

impl Default for BestPoint {
    /// Best point before the first evaluation.
    fn default() -> Self {
        Self { x: Point::new(), value: f64::INFINITY, solved: false }
    }
}

impl BestPoint {
    /// Keeps `x` if it is better: solved before unsolved, then the lower value, then the earlier point.
    #[inline]
    pub(super) fn challenge(&mut self, x: &[f64], value: f64, solved: bool) {
        let better = (solved && !self.solved) || (solved == self.solved && value < self.value);
        if better || self.x.is_empty() {
            self.replace(x, value, solved);
        }
    }

    #[cold]
    fn replace(&mut self, x: &[f64], value: f64, solved: bool) {
        self.x.resize(x.len(), 0.0);
        self.x.copy_from_slice(x);
        (self.value, self.solved) = (value, solved);
    }
}
