//! A trajectory as a motion that can be certified.

use crate::math::polynomial::evaluate;
use crate::obstacle::Motion;
use crate::trajectory::{Coefficients, POWERS, Trajectory};

/// A trajectory; its parameter is time (s).
pub(in crate::planning) struct InTime<'a>(pub &'a Trajectory);

impl Motion for InTime<'_> {
    fn around(&self, from: f64, to: f64, middle: &mut [f64], reach: &mut [f64]) {
        let (knots, polynomials) = (self.0.knots(), self.0.coefficients());
        let n = middle.len();
        let last = knots.len() - 2;
        let piece_of = |t: f64| knots.partition_point(|knot| *knot <= t).saturating_sub(1).min(last);
        let center = 0.5 * (from + to);
        let home = piece_of(center);
        for j in 0..n {
            middle[j] = evaluate(&polynomials[home * n + j], center - knots[home])[0];
        }
        reach.fill(0.0);
        for piece in piece_of(from)..=piece_of(to) {
            let (begin, end) = (knots[piece].max(from), knots[piece + 1].min(to));
            let half = 0.5 * (end - begin).max(0.0);
            for j in 0..n {
                let local = shifted(&polynomials[piece * n + j], 0.5 * (begin + end) - knots[piece]);
                // Taylor's series about the middle of the piece ends, so that its terms bound it.
                let swing = local[1..].iter().rev().fold(0.0, |sum, c| (sum + c.abs()) * half);
                reach[j] = reach[j].max((local[0] - middle[j]).abs() + swing);
            }
        }
    }
}

/// The same polynomial in powers of s - `by`, by repeated synthetic division.
fn shifted(coefficients: &Coefficients, by: f64) -> Coefficients {
    let mut c = *coefficients;
    for low in 0..POWERS - 1 {
        for power in (low..POWERS - 1).rev() {
            c[power] += by * c[power + 1];
        }
    }
    c
}
