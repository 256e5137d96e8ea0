//! Bounds in the plane of x = (ds/dt)^2 and u = d2s/dt2 that keep the torque of a joint.
//!
//! Over a part of a segment the torque is a(s) u + b(s) x + g(s), where x grows by 2 u s. There a, b and g are parabolas up to rests; so the
//! torque is a cubic, and bounds on its four Bernstein coefficients bound it at every point.

use super::bounding_line::{Line, NEGLIGIBLE_SLOPE};
use super::torque_nodes::NodeTerms;
use crate::constraint::{Drag, Rest, control_points};

/// A half-plane a u + b x <= c, with positive c.
pub(super) type HalfPlane = [f64; 3];

/// Bounds on u over a segment where x grows by 2 u from its start on.
#[derive(Debug)]
pub(super) struct TorqueBounds {
    /// From above, then from below.
    lines: Vec<Line>,
    /// Number of those from above.
    above: usize,
    /// The bound on x from half-planes that do not bound u.
    pub largest_x: f64,
}

impl TorqueBounds {
    /// No bounds.
    pub(super) const NONE: Self = Self { lines: vec![], above: 0, largest_x: f64::INFINITY };

    /// Bounds inside these half-planes.
    pub(super) fn new(half_planes: &[HalfPlane]) -> Self {
        let steepest = half_planes.iter().fold(0.0_f64, |largest, [a, ..]| largest.max(a.abs()));
        let flat = NEGLIGIBLE_SLOPE * steepest;
        let mut lines = Vec::with_capacity(half_planes.len());
        let line = |&[a, b, c]: &HalfPlane| Line { offset: c / a, slope: b / a };
        lines.extend(half_planes.iter().filter(|[a, ..]| *a > flat).map(line));
        let above = lines.len();
        lines.extend(half_planes.iter().filter(|[a, ..]| *a < -flat).map(line));
        let of_flat = half_planes.iter().filter(|[a, b, _]| a.abs() <= flat && *b > 0.0).map(|[_, b, c]| c / b);
        Self { lines, above, largest_x: of_flat.fold(f64::INFINITY, f64::min) }
    }

    /// From above and from below.
    pub(super) fn lines(&self) -> [&[Line]; 2] {
        let (above, below) = self.lines.split_at(self.above);
        [above, below]
    }

    pub(super) fn are_none(&self) -> bool {
        self.largest_x == f64::INFINITY && self.lines.is_empty()
    }
}

/// The limit of a joint's torque over a part of a segment.
pub(super) struct KeptTorque {
    pub ends: [f64; 2],
    pub limit: f64,
    pub rest: Rest,
    /// Friction against positive and against negative torques.
    pub drags: [Drag; 2],
}

impl KeptTorque {
    /// Whether the torque may reach its limit for u and x up to `most`, by the largest sizes of its terms.
    #[inline]
    pub(super) fn can_bind(&self, [hold, of_square, of_change]: [f64; 3], most: [f64; 2]) -> bool {
        let Self { ends: [_, to], limit, rest: [rest_g, rest_b, rest_a], drags } = *self;
        let friction = drags.map(|drag| drag.at_rest + drag.per_square * most[1]);
        let (hold, of_square, of_change) = (hold + rest_g, of_square + rest_b, of_change + rest_a);
        let viscous = drags.map(|drag| 2.0 * to * drag.per_square * most[0]);
        let inertial = of_change * most[0] + of_square * (most[1] + 2.0 * to * most[0]);
        !(inertial + hold + friction[0].max(friction[1]) + viscous[0].max(viscous[1]) <= limit)
    }

    /// Adds the half-planes in which it is kept on average.
    pub(super) fn push_average(&self, nodes: [NodeTerms<'_>; 3], joint: usize, half_planes: &mut Vec<HalfPlane>) {
        let Self { ends: [from, to], limit, drags, .. } = *self;
        let mean = |[start, middle, end]: [f64; 3]| (start + 4.0 * middle + end) / 6.0;
        let of_square = nodes.map(|terms| terms.of_square[joint]);
        let x_per_u = [2.0 * from, from + to, 2.0 * to];
        let a = mean(nodes.map(|terms| terms.of_change[joint])) + mean([0, 1, 2].map(|k| x_per_u[k] * of_square[k]));
        let (b, g) = (mean(of_square), mean(nodes.map(|terms| terms.hold[joint])));
        for (side, drag) in [1.0, -1.0].into_iter().zip(drags) {
            let of_square = drag.per_square;
            half_planes.push([
                side * a + x_per_u[1] * of_square,
                side * b + of_square,
                limit - side * g - drag.at_rest,
            ]);
        }
    }

    /// Adds the half-planes in which it is kept, but for those that hold for all u and x up to `most`.
    pub(super) fn push(
        &self,
        nodes: [NodeTerms<'_>; 3],
        joint: usize,
        most: [f64; 2],
        half_planes: &mut Vec<HalfPlane>,
    ) {
        let Self { ends: [from, to], limit, rest: [rest_g, rest_b, rest_a], drags } = *self;
        let a = control_points(nodes.map(|terms| terms.of_change[joint]));
        let b = control_points(nodes.map(|terms| terms.of_square[joint]));
        let g = control_points(nodes.map(|terms| terms.hold[joint]));
        // x(s) = x + 2 u s, and s times a parabola is a cubic.
        let (a, b, g, slope) = (raised(a), raised(b), raised(g), times_parameter(b, [from, to]));
        for i in 0..4 {
            let (a, b, g) = (a[i] + 2.0 * slope[i], b[i], g[i]);
            for (side, drag) in [1.0, -1.0].into_iter().zip(drags) {
                let c = limit - side * g - rest_g - drag.at_rest;
                // Friction counts (ds/dt)^2 = x + 2 u s as x and as u.
                let rest_a = rest_a + 2.0 * to * (rest_b + drag.per_square);
                let b = side * b + rest_b + drag.per_square;
                let both = [side * a + rest_a, side * a - rest_a];
                let of_x = b.max(0.0) * most[1];
                // If no x alone exceeds the limit, and both half-planes bound u from the same side, the steeper one implies the other.
                let steeper = usize::from(both[1].abs() > both[0].abs());
                let is_one = of_x <= c && both[0] * both[1] > 0.0;
                let binds = |(k, a): &(usize, f64)| !(a.abs() * most[0] + of_x <= c || is_one && *k != steeper);
                half_planes.extend(both.into_iter().enumerate().filter(binds).map(|(_, a)| [a, b, c]));
            }
        }
    }
}

/// The largest sizes of the holding torque, of the factor of (ds/dt)^2 and of that of d2s/dt2.
#[inline]
pub(super) fn largest_terms(nodes: [NodeTerms<'_>; 3], joint: usize) -> [f64; 3] {
    let [start, middle, end] = nodes;
    [
        largest([start.hold[joint], middle.hold[joint], end.hold[joint]]),
        largest([start.of_square[joint], middle.of_square[joint], end.of_square[joint]]),
        largest([start.of_change[joint], middle.of_change[joint], end.of_change[joint]]),
    ]
}

/// The largest size of the parabola with these values at the start, in the middle and at the end.
#[inline]
fn largest(values: [f64; 3]) -> f64 {
    let [start, middle, end] = control_points(values).map(f64::abs);
    start.max(middle).max(end)
}

/// The Bernstein coefficients of a parabola as those of a cubic.
fn raised([start, middle, end]: [f64; 3]) -> [f64; 4] {
    [start, (start + 2.0 * middle) / 3.0, (2.0 * middle + end) / 3.0, end]
}

/// The Bernstein coefficients of a parabola times the parameter, from one value to another.
fn times_parameter([start, middle, end]: [f64; 3], [from, to]: [f64; 2]) -> [f64; 4] {
    [from * start, (2.0 * from * middle + to * start) / 3.0, (from * end + 2.0 * to * middle) / 3.0, to * end]
}
