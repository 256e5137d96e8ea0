//! The acceleration limits over one segment, in the plane of x = (ds/dt)^2 at its start and u = d2s/dt2 on it.
//!
//! Each limit of an acceleration is a strip |a u + b x| <= c; those of joint torques are half-planes. For a given x the strips leave an interval of u, between the lowest of their
//! upper lines and the highest of their lower lines. Both envelopes are piecewise linear; the interval between them is
//! convex.

use super::bounding_line::{Line, NEGLIGIBLE_SLOPE};
use super::constant_limits::ConstantLimits;
use super::derivatives::PathDerivatives;
use super::tip_segments::TipSegments;
use super::torque_bounds::TorqueBounds;
use crate::math::arithmetic::by_instructions;

/// Strictness with which limits are kept over a segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Strictness {
    /// At every point.
    Throughout,
    /// On average: a motion that takes about as long as on the finest grid, but exceeds them somewhere.
    OnAverage,
}

/// Strips, each given by its upper line. The lower line is parallel and has the negative offset.
#[derive(Debug, Default)]
pub(super) struct Strips {
    offsets: Vec<f64>,
    slopes: Vec<f64>,
    /// Lines that bound u from above and from below, not in pairs.
    bounds: [Vec<Line>; 2],
    /// The bound on x from strips that do not bound u.
    pub largest_x: f64,
    /// The largest u from rest.
    pub launch: f64,
}

by_instructions! {
    /// Turns the factors a and b of strips |a u + b x| <= c, row by row (n,), into offsets and slopes of their upper lines. Returns the bound
    /// on x from strips that do not bound u, and the largest u from rest.
    fn upper_lines(a: &mut [f64], b: &mut [f64], limits: &[f64]) -> [f64; 2] {
        let n = limits.len();
        let [least, largest] = sizes(a);
        let mut largest_x = f64::INFINITY;
        for (offsets, slopes) in a.chunks_exact_mut(n).zip(b.chunks_exact_mut(n)) {
            // In wide registers, unless a strip hardly bounds u.
            if least > NEGLIGIBLE_SLOPE * largest {
                for j in 0..n {
                    let a = offsets[j];
                    offsets[j] = limits[j] / a.abs();
                    slopes[j] /= a;
                }
                continue;
            }
            for ((offset, slope), c) in offsets.iter_mut().zip(slopes).zip(limits) {
                let (a, b) = (*offset, *slope);
                if a.abs() <= NEGLIGIBLE_SLOPE * largest {
                    largest_x = largest_x.min(if b == 0.0 { f64::INFINITY } else { c / b.abs() });
                    (*offset, *slope) = (f64::INFINITY, 0.0);
                } else {
                    (*offset, *slope) = (c / a.abs(), b / a);
                }
            }
        }
        [largest_x, sizes(a)[0]]
    }
}

/// Returns the smallest and the largest size of these numbers, side by side: one after the other each would wait for the one before.
#[inline(always)]
fn sizes(numbers: &[f64]) -> [f64; 2] {
    const LANES: usize = 4;
    let (mut least, mut largest) = ([f64::INFINITY; LANES], [0.0; LANES]);
    let (groups, rest) = numbers.as_chunks::<LANES>();
    for group in groups {
        for k in 0..LANES {
            let size = group[k].abs();
            least[k] = if size < least[k] { size } else { least[k] };
            largest[k] = if size > largest[k] { size } else { largest[k] };
        }
    }
    for (k, number) in rest.iter().enumerate() {
        (least[k], largest[k]) = (least[k].min(number.abs()), largest[k].max(number.abs()));
    }
    let [mut all_least, mut all_largest] = [least[0], largest[0]];
    for k in 1..LANES {
        (all_least, all_largest) = (all_least.min(least[k]), all_largest.max(largest[k]));
    }
    [all_least, all_largest]
}

impl Strips {
    pub(super) fn new(joints: usize) -> Self {
        Self {
            offsets: vec![0.0; 3 * joints],
            slopes: vec![0.0; 3 * joints],
            bounds: [vec![], vec![]],
            largest_x: f64::INFINITY,
            launch: f64::INFINITY,
        }
    }

    /// Computes the strips of a segment with these `derivatives` of the path and this `length`.
    ///
    /// On the segment, d2q/dt2 = q'(s) u + q''(s) x(s) with x(s) = x + 2 u (s - s_i): a quadratic in s. Limits on its three Bernstein
    /// coefficients therefore hold at every point of the segment. For limits kept on average the mean of the coefficients is limited.
    pub(super) fn fill(
        &mut self,
        derivatives: &PathDerivatives,
        length: f64,
        limits: &ConstantLimits,
        kept: Strictness,
    ) {
        let n = limits.acceleration.len();
        self.offsets.resize(3 * n, 0.0);
        self.slopes.resize(3 * n, 0.0);
        self.bounds.iter_mut().for_each(Vec::clear);
        let [d0, d1, d2] = derivatives.first.each_ref().map(|row| &row[..n]);
        let [e0, e1] = derivatives.second.each_ref().map(|row| &row[..n]);
        let (offsets, slopes) = (&mut self.offsets[..3 * n], &mut self.slopes[..3 * n]);
        for j in 0..n {
            (offsets[j], slopes[j]) = (d0[j], e0[j]);
            (offsets[n + j], slopes[n + j]) = (d1[j] + length * e0[j], 0.5 * (e0[j] + e1[j]));
            (offsets[2 * n + j], slopes[2 * n + j]) = (d2[j] + 2.0 * length * e1[j], e1[j]);
        }
        let rows = match kept {
            Strictness::Throughout => 3 * n,
            Strictness::OnAverage => {
                for row in [&mut *offsets, &mut *slopes] {
                    (0..n).for_each(|j| row[j] = (row[j] + row[n + j] + row[2 * n + j]) / 3.0);
                }
                n
            }
        };
        self.offsets.truncate(rows);
        self.slopes.truncate(rows);
        [self.largest_x, self.launch] = upper_lines(&mut self.offsets, &mut self.slopes, &limits.acceleration);
    }

    /// Adds the strips of tips over a segment.
    pub(super) fn add(&mut self, tips: &TipSegments<'_>, segment: usize) {
        let mut largest = 0.0_f64;
        tips.strips(segment, |[a, ..]| largest = largest.max(a.abs()));
        tips.strips(segment, |[a, b, c]| {
            if a.abs() <= NEGLIGIBLE_SLOPE * largest {
                self.largest_x = self.largest_x.min(if b == 0.0 { f64::INFINITY } else { c / b.abs() });
            } else {
                self.offsets.push(c / a.abs());
                self.slopes.push(b / a);
                self.launch = self.launch.min(c / a.abs());
            }
        });
    }

    /// Adds the bounds of joint torques.
    pub(super) fn bound(&mut self, torques: &TorqueBounds) {
        let lines = torques.lines();
        self.largest_x = self.largest_x.min(torques.largest_x);
        self.launch = lines[0].iter().map(|line| line.offset).fold(self.launch, f64::min);
        self.bounds.iter_mut().zip(lines).for_each(|(all, more)| all.extend_from_slice(more));
    }

    /// The lowest upper line at `x`.
    pub(super) fn upper(&self, x: f64) -> Line {
        self.tightest(x)[0]
    }

    /// The lowest upper and the highest lower line at `x`.
    pub(super) fn tightest(&self, x: f64) -> [Line; 2] {
        let mut upper = (f64::INFINITY, Line { offset: f64::INFINITY, slope: 0.0 });
        let mut lower = (f64::NEG_INFINITY, Line { offset: f64::NEG_INFINITY, slope: 0.0 });
        for (&offset, &slope) in self.offsets.iter().zip(&self.slopes) {
            let middle = slope * x;
            if offset - middle < upper.0 {
                upper = (offset - middle, Line { offset, slope });
            }
            if -offset - middle > lower.0 {
                lower = (-offset - middle, Line { offset: -offset, slope });
            }
        }
        let [above, below] = &self.bounds;
        for line in above {
            if line.at(x) < upper.0 {
                upper = (line.at(x), *line);
            }
        }
        for line in below {
            if line.at(x) > lower.0 {
                lower = (line.at(x), *line);
            }
        }
        [upper.1, lower.1]
    }
}
