//! A rounded corner between two moves of the tip.
//!
//! Position and orientation are quintic Bezier curves, which meet both moves with one direction and one curvature. A Bezier curve is
//! inside the convex hull of its control points, and these are inside the ball of the blend.

use nalgebra::{Rotation3, Vector3};

use super::leg::Leg;

/// Control points of a quintic.
type Controls = [Vector3<f64>; 6];

/// Length of the first and the last side of the control polygon, as a fraction of the blend radius. Two sides are within the ball.
const SIDE: f64 = 0.4;

/// Factor by which sides shrink until their points are in the ball.
const SHRINK: f64 = 0.8;
/// Smallest side, as a fraction of the radius of the ball.
const SMALLEST_SIDE: f64 = 0.01;

/// Cosine of the turn beyond which a corner counts as a reversal, which no smooth curve passes.
const REVERSAL: f64 = -0.999;

/// Intervals of the table of lengths.
const INTERVALS: usize = 64;

/// Nodes and weights of Gauss-Legendre quadrature on [0, 1].
const NODES: [(f64, f64); 3] =
    [(0.112_701_665_379_258_31, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// Steps of Newton's method on the length; its first guess is good to a percent of an interval.
const STEPS: usize = 4;

/// The curve of a corner, by its length.
#[derive(Debug, Clone)]
pub(super) struct Corner {
    position: Controls,
    /// Orientation at the corner, and rotation vectors from it.
    turned: (Rotation3<f64>, Controls),
    /// Length from the start to each of the even values of the parameter.
    lengths: Vec<f64>,
}

impl Corner {
    /// The corner from `before`, where it is left at `from`, to `after`, which is entered at `to`; both cut it at `radius`.
    pub fn between(before: &Leg, from: f64, after: &Leg, to: f64, radius: f64) -> Self {
        let ([p0, t0, k0], [p5, t5, k5]) = (before.at(from), after.at(to));
        let [at_corner, ..] = before.at(before.length);
        let mut side = SIDE * radius;
        let controls = |side: f64| {
            let bent = 1.25 * side * side;
            [p0, p0 + side * t0, p0 + 2.0 * side * t0 + bent * k0, p5 - 2.0 * side * t5 + bent * k5, p5 - side * t5, p5]
        };
        let is_inside = |side: f64| controls(side)[1..5].iter().all(|point| (point - at_corner).norm() <= radius);
        while !is_inside(side) && side > SMALLEST_SIDE * radius {
            side *= SHRINK;
        }
        let position = controls(side);
        let lengths = lengths(&position);
        let whole = lengths[INTERVALS];
        let [first, last] = [(from - before.length) * before.rate, to * after.rate];
        let [begin, end] = [0.2 * whole * before.rate, 0.2 * whole * after.rate];
        let vectors = [first, first + begin, first + 2.0 * begin, last - 2.0 * end, last - end, last];
        let turned = (before.orientation(before.length), vectors);
        Self { position, turned, lengths }
    }

    /// Whether the tip turns back between two legs.
    pub fn turns_back(before: &Leg, after: &Leg) -> bool {
        before.at(before.length)[1].dot(&after.at(0.0)[1]) < REVERSAL
    }

    /// Length of the curve (m).
    pub fn length(&self) -> f64 {
        self.lengths[INTERVALS]
    }

    /// Position and orientation at the length `s`.
    pub fn at(&self, s: f64) -> (Vector3<f64>, Rotation3<f64>) {
        let vector = bezier(&self.turned.1, (s / self.length()).clamp(0.0, 1.0));
        (bezier(&self.position, self.parameter(s)), Rotation3::new(vector) * self.turned.0)
    }

    /// Parameter of the Bezier curve at the length `s`.
    fn parameter(&self, s: f64) -> f64 {
        let interval = self.lengths.partition_point(|length| *length <= s).clamp(1, INTERVALS) - 1;
        let [begin, end] = [self.lengths[interval], self.lengths[interval + 1]];
        let width = 1.0 / INTERVALS as f64;
        let from = interval as f64 * width;
        let mut u = from + width * (s - begin) / (end - begin);
        for _ in 0..STEPS {
            let speed = slope(&self.position, u).norm();
            if speed == 0.0 {
                break;
            }
            u -= (begin + length_between(&self.position, from, u) - s) / speed;
        }
        u.clamp(0.0, 1.0)
    }
}

/// Lengths from the start of the curve.
fn lengths(controls: &Controls) -> Vec<f64> {
    let mut lengths = vec![0.0; INTERVALS + 1];
    for i in 0..INTERVALS {
        let [from, to] = [i, i + 1].map(|i| i as f64 / INTERVALS as f64);
        lengths[i + 1] = lengths[i] + length_between(controls, from, to);
    }
    lengths
}

fn length_between(controls: &Controls, from: f64, to: f64) -> f64 {
    let speed = |node: f64| slope(controls, from + node * (to - from)).norm();
    (to - from) * NODES.iter().map(|(node, weight)| weight * speed(*node)).sum::<f64>()
}

fn bezier(controls: &Controls, u: f64) -> Vector3<f64> {
    let v = 1.0 - u;
    let weights = [
        v.powi(5),
        5.0 * u * v.powi(4),
        10.0 * u * u * v.powi(3),
        10.0 * u.powi(3) * v * v,
        5.0 * u.powi(4) * v,
        u.powi(5),
    ];
    controls.iter().zip(weights).map(|(point, weight)| weight * point).sum()
}

fn slope(controls: &Controls, u: f64) -> Vector3<f64> {
    let v = 1.0 - u;
    let weights = [v.powi(4), 4.0 * u * v.powi(3), 6.0 * u * u * v * v, 4.0 * u.powi(3) * v, u.powi(4)];
    controls.windows(2).zip(weights).map(|(ends, weight)| 5.0 * weight * (ends[1] - ends[0])).sum()
}
