//! Motions that can be certified.

use crate::math::vector::write_between;

/// A joint motion over an interval of its parameter: time, ticks, or the fraction of a straight line.
pub trait JointMotion {
    /// Writes the configuration at `at`.
    fn write(&self, at: f64, q: &mut [f64]);

    /// Writes the deviation of each joint (rad, m) from the straight line between its values at `from` and `to`, which has the same
    /// parameter: at fraction s of the interval by at most 4 s (1 - s) times this. The entries are zero before. A spline need keep only
    /// to its control points.
    fn write_off_line(&self, from: f64, to: f64, off_line: &mut [f64]);

    /// Point at which an interval is divided; `None` if it is not to be divided.
    fn middle(&self, from: f64, to: f64) -> Option<f64> {
        let middle = 0.5 * (from + to);
        (from < middle && middle < to).then_some(middle)
    }

    /// Whether the arm does not pass the configurations of whole numbers, but follows the uniform cubic B-spline with these control
    /// points. Then `write` also knows those just outside of the interval.
    fn is_spline(&self) -> bool {
        false
    }
}

/// A straight line in joint space; its parameter runs from 0 to 1.
#[derive(Debug, Clone, Copy)]
pub struct Edge<'a> {
    /// Start (n,).
    pub from: &'a [f64],
    /// End (n,).
    pub to: &'a [f64],
}

impl JointMotion for Edge<'_> {
    fn write(&self, at: f64, q: &mut [f64]) {
        write_between(self.from, self.to, at, q);
    }

    fn write_off_line(&self, _from: f64, _to: f64, _off_line: &mut [f64]) {}
}
