//! The acceleration limits over one segment, in the plane of x = (ds/dt)^2 at its start and u = d2s/dt2 on it.
//!
//! Each limit of an acceleration is a strip |a u + b x| <= c; those of joint torques are half-planes. For a given x the strips leave an interval of u, between the lowest of their
//! upper lines and the highest of their lower lines. Both envelopes are piecewise linear; the interval between them is
//! convex.

use super::bounding_line::{Line, NEGLIGIBLE_SLOPE};
use super::constant_limits::ConstantLimits;
use super::derivatives::PathDerivatives;
use super::tip_segments::TipSegments;
use super::torque_segments::TorqueBounds;

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
    /// On the segment d2q/dt2 = q'(s) u + q''(s) x(s), with x(s) = x + 2 u (s - s_i), is a quadratic in s. Bounds on
    /// its three Bernstein coefficients bound it at every point, not only at grid points.
    pub(super) fn fill(&mut self, derivatives: &PathDerivatives, length: f64, limits: &ConstantLimits) {
        let n = limits.acceleration.len();
        self.offsets.truncate(3 * n);
        self.slopes.truncate(3 * n);
        self.bounds.iter_mut().for_each(Vec::clear);
        let [d0, d1, d2] = derivatives.first.each_ref().map(|row| &row[..n]);
        let [e0, e1] = derivatives.second.each_ref().map(|row| &row[..n]);
        let (offsets, slopes) = (&mut self.offsets[..3 * n], &mut self.slopes[..3 * n]);
        for j in 0..n {
            (offsets[j], slopes[j]) = (d0[j], e0[j]);
            (offsets[n + j], slopes[n + j]) = (d1[j] + length * e0[j], 0.5 * (e0[j] + e1[j]));
            (offsets[2 * n + j], slopes[2 * n + j]) = (d2[j] + 2.0 * length * e1[j], e1[j]);
        }
        let largest = offsets.iter().fold(0.0_f64, |largest, a| largest.max(a.abs()));
        (self.largest_x, self.launch) = (f64::INFINITY, f64::INFINITY);
        for (of_end, slopes) in offsets.chunks_exact_mut(n).zip(slopes.chunks_exact_mut(n)) {
            for ((offset, slope), c) in of_end.iter_mut().zip(slopes).zip(&limits.acceleration) {
                let (a, b) = (*offset, *slope);
                if a.abs() <= NEGLIGIBLE_SLOPE * largest {
                    self.largest_x = self.largest_x.min(if b == 0.0 { f64::INFINITY } else { c / b.abs() });
                    (*offset, *slope) = (f64::INFINITY, 0.0);
                } else {
                    (*offset, *slope) = (c / a.abs(), b / a);
                    self.launch = self.launch.min(*offset);
                }
            }
        }
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
    pub(super) fn bound(&mut self, TorqueBounds { lines, largest_x }: &TorqueBounds) {
        self.largest_x = self.largest_x.min(*largest_x);
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
