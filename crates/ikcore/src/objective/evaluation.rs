//! Objective functions and the scores of points.

use super::bounds::Bounds;
use crate::rng::LazyRng;

/// Value of an objective at a point, and whether the point solves the problem.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Score {
    /// Weighted sum of squares r'r.
    pub value: f64,
    /// Whether the problem's own test is passed, for example that distance and angle are both within their tolerances.
    pub solved: bool,
}

/// Preferred batching and polling of evaluations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CallPattern {
    /// Number of points to evaluate together, if a solver has as many.
    pub batch_size: usize,
    /// Evaluations between two polls of monitor and clock.
    pub poll_interval: usize,
}

impl Default for CallPattern {
    /// Default for evaluations of tens of nanoseconds: one poll every ten microseconds.
    fn default() -> Self {
        Self { batch_size: 8, poll_interval: 256 }
    }
}

/// Objective function to minimise. It owns its scratch and is cloned per thread.
pub trait Objective {
    /// Number of entries of a point.
    fn dimension(&self) -> usize;

    /// Evaluates `x`, a point in the box.
    fn evaluate(&mut self, x: &[f64]) -> Score;

    /// Evaluates many points, stored consecutively in `xs`.
    fn evaluate_all(&mut self, xs: &[f64], out: &mut [Score]) {
        for (x, score) in xs.chunks_exact(self.dimension()).zip(out) {
            *score = self.evaluate(x);
        }
    }

    /// Preferred batching and polling; read once per run.
    fn call_pattern(&self) -> CallPattern {
        CallPattern::default()
    }

    /// Writes the start of attempt number `attempt` (from 1; attempt 0 is the caller's start). By default it is uniform in the
    /// box.
    fn propose_start(&mut self, attempt: usize, bounds: &Bounds, rng: &mut LazyRng, x: &mut [f64]) {
        let _ = attempt;
        bounds.sample(rng, x);
    }

    /// Period of entry `entry` of a point, if it has one: 2 pi for an angle whose full turns do not matter.
    fn period(&self, entry: usize) -> Option<f64> {
        let _ = entry;
        None
    }
}
