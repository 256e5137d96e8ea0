//! Intervals of the half-angle tangent, with Bernstein coefficients.

use super::basis::DEGREE;
use crate::closed_form::angle::Angle;

/// Interval of x with the Bernstein coefficients on it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Interval {
    pub coefficients: [f64; DEGREE + 1],
    pub from: f64,
    pub to: f64,
    pub depth: u32,
    /// Rounding error of the coefficients.
    pub noise: f64,
    /// True if the coefficients come from samples of this interval.
    pub sampled: bool,
}

/// Finds the zero of an interval with one sign change, by halving and regula falsi on the coefficients.
#[cold]
pub(super) fn bracketed_by_coefficients(interval: &Interval) -> f64 {
    let mut here = *interval;
    for _ in 0..48 {
        let (low, high) = halves(&here, DEGREE);
        here = if (low.coefficients[0] < 0.0) != (high.coefficients[0] < 0.0) { low } else { high };
        if here.to - here.from < 1e-15 {
            break;
        }
    }
    0.5 * (here.from + here.to)
}

/// Returns the angle whose half has the tangent `x`.
#[inline(always)]
pub(super) fn half_angle(x: f64) -> Angle {
    let inverse = 1.0 / (1.0 + x * x);
    Angle { cos: (1.0 - x) * (1.0 + x) * inverse, sin: 2.0 * x * inverse }
}

/// Counts the sign changes of the coefficients, and reports whether all coefficients are within the noise. An entry within
/// the noise may hide a change.
#[inline(always)]
pub(super) fn variations(coefficients: &[f64], noise: f64) -> (usize, bool) {
    let (mut positive, mut negative, mut changes) = (0_usize, 0_usize, 0_usize);
    let mut last = coefficients[0];
    for b in coefficients {
        positive += usize::from(*b > noise);
        negative += usize::from(*b < -noise);
        changes += usize::from((*b < 0.0) != (last < 0.0));
        last = *b;
    }
    match (positive, negative) {
        (0, 0) => (changes, true),
        (p, 0) if p == coefficients.len() => (0, false),
        (0, n) if n == coefficients.len() => (0, false),
        // A single change proves a single zero only if both ends are above the noise.
        _ if changes == 1 && clear(coefficients, noise) => (1, false),
        _ => (2, false),
    }
}

#[inline(always)]
pub(super) fn clear(coefficients: &[f64], noise: f64) -> bool {
    coefficients[0].abs() > noise && coefficients[coefficients.len() - 1].abs() > noise
}

/// Halves an interval by de Casteljau's algorithm.
#[inline(always)]
pub(super) fn halves(interval: &Interval, degree: usize) -> (Interval, Interval) {
    let middle = 0.5 * (interval.from + interval.to);
    let depth = interval.depth + 1;
    let mut low = Interval { to: middle, depth, ..*interval };
    let mut high = Interval { from: middle, depth, ..*interval };
    let row = &mut high.coefficients;
    for level in 1..=degree {
        for j in 0..=degree - level {
            row[j] = 0.5 * (row[j] + row[j + 1]);
        }
        low.coefficients[level] = row[0];
    }
    (low, high)
}
