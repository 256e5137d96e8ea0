//! The motion between ticks of an arm whose velocity may not jump.
//!
//! The curve is a uniform cubic B-spline with the commanded positions as control points. Its velocity is a mean of the
//! displacements per tick, its acceleration interpolates their differences, and its jerk is the second difference; limits kept
//! at the ticks therefore hold in between. The curve passes each commanded position at a sixth of that tick's acceleration
//! times dt^2, because no curve through alternating positions could keep the limits that their differences keep.

use crate::trajectory::{Coefficients, polynomial};

/// Smallest number of positions that determine the curve.
pub(super) const FEWEST: usize = 3;

/// Returns the polynomials between the rows of `q` (at least [`FEWEST`], of `n` joints), ordered by segment, then joint. The
/// arm rests before the first row, and keeps its acceleration after the last.
pub(super) fn spline(q: &[f64], n: usize, dt: f64) -> Vec<Coefficients> {
    let rows = q.len() / n;
    let at = |row: usize, j: usize| q[row * n + j];
    let mut coefficients = Vec::with_capacity((rows - 1) * n);
    for row in 0..rows - 1 {
        for j in 0..n {
            let [here, next] = [at(row, j), at(row + 1, j)];
            let before = if row == 0 { here } else { at(row - 1, j) };
            let after = if row + 2 < rows { at(row + 2, j) } else { 3.0 * (next - here) + before };
            coefficients.push(segment([before, here, next, after], dt));
        }
    }
    coefficients
}

/// Spline segment between the second and the third of four control points.
pub(super) fn segment([before, here, next, after]: [f64; 4], dt: f64) -> Coefficients {
    // Differences first: small numbers lose fewer digits.
    let [first, second, third] = [here - before, next - here, after - next];
    let [bend, next_bend] = [second - first, third - second];
    polynomial([
        here + bend / 6.0,
        0.5 * (first + second) / dt,
        0.5 * bend / (dt * dt),
        (next_bend - bend) / (6.0 * dt * dt * dt),
    ])
}
