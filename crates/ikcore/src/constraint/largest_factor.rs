//! The largest factor by which a motion must be slowed down, from bounds over intervals.
//!
//! Where a bound is too large, the interval is halved, until the largest factor is known well enough or is small enough.

use crate::trajectory::{Coefficients, Trajectory};

/// Relative room left below a limit, for rounding.
pub(crate) const TIGHT: f64 = 1e-6;

/// Intervals examined before bounds are taken as they are.
const MOST_INTERVALS: usize = 100_000;

/// Maximum number of halvings of a segment.
const DEEPEST: usize = 40;

/// A factor that a motion is judged by.
pub(super) trait IntervalFactor {
    /// Relative accuracy of the largest factor, if it is too large.
    const ACCURACY: f64;

    /// The factor in the middle of an interval, and a bound of it over the interval, `half` (s) to either side of `middle` on these polynomials.
    fn over(&mut self, polynomials: &[Coefficients], interval: [f64; 2]) -> [f64; 2];
}

/// Returns the largest factor of `motion`, or a bound of it up to `enough`. A larger one is too large by its accuracy at most.
pub(super) fn largest_factor(motion: &Trajectory, enough: f64, of: &mut impl IntervalFactor) -> f64 {
    // A factor far below one need not be exact, so that a part at rest needs no short intervals.
    let mut walk = Walk { of, enough: enough.max(1e-9), only_judges: false, seen: 0.0, proven: 0.0, intervals: 0 };
    let n = motion.joints().len();
    let segments = || motion.coefficients().chunks_exact(n).zip(motion.knots().windows(2));
    let bounds: Vec<f64> =
        segments().map(|(polynomials, ends)| walk.see(polynomials, [0.0, ends[1] - ends[0]])).collect();
    for ((polynomials, ends), bound) in segments().zip(bounds) {
        walk.take(polynomials, [0.0, ends[1] - ends[0]], bound, 0);
    }
    walk.proven
}

/// Whether the largest factor of `motion` is at most `most`.
pub(super) fn is_at_most(motion: &Trajectory, most: f64, of: &mut impl IntervalFactor) -> bool {
    let mut walk = Walk { of, enough: most, only_judges: true, seen: 0.0, proven: 0.0, intervals: 0 };
    let n = motion.joints().len();
    for (polynomials, ends) in motion.coefficients().chunks_exact(n).zip(motion.knots().windows(2)) {
        let whole = [0.0, ends[1] - ends[0]];
        let bound = walk.see(polynomials, whole);
        walk.take(polynomials, whole, bound, 0);
        if walk.is_over() {
            return false;
        }
    }
    walk.proven <= most
}

struct Walk<'a, F> {
    of: &'a mut F,
    enough: f64,
    /// Whether a factor beyond `enough` ends the walk.
    only_judges: bool,
    /// Largest factor at a point.
    seen: f64,
    /// Largest bound that was taken.
    proven: f64,
    intervals: usize,
}

impl<F: IntervalFactor> Walk<'_, F> {
    fn is_over(&self) -> bool {
        self.only_judges && self.seen > self.enough
    }

    /// Bounds the factor over an interval, and notes the one in its middle.
    fn see(&mut self, polynomials: &[Coefficients], [from, to]: [f64; 2]) -> f64 {
        let half = 0.5 * (to - from);
        let [seen, bound] = self.of.over(polynomials, [from + half, half]);
        self.seen = self.seen.max(seen);
        bound
    }

    /// Takes the bound over an interval, or halves it.
    fn take(&mut self, polynomials: &[Coefficients], [from, to]: [f64; 2], bound: f64, depth: usize) {
        if self.is_over() {
            return;
        }
        self.intervals += 1;
        let most = if self.seen > self.enough { self.seen * (1.0 + F::ACCURACY) } else { self.enough };
        if bound <= most.max(self.proven) || depth == DEEPEST || self.intervals > MOST_INTERVALS {
            self.proven = self.proven.max(bound);
            return;
        }
        let middle = 0.5 * (from + to);
        for half in [[from, middle], [middle, to]] {
            let bound = self.see(polynomials, half);
            self.take(polynomials, half, bound, depth + 1);
        }
    }
}
