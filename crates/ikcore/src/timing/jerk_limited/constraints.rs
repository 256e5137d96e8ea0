//! The limits at points of the clock, as rows for y = (du/dt)^2 and its derivatives y' and y''.
//!
//! With Q the joint positions over u: the velocity is Q' sqrt(y), the acceleration Q'' y + Q' y' / 2, and the jerk
//! sqrt(y) (Q''' y + 3/2 Q'' y' + 1/2 Q' y'').

use super::super::constant_limits::ConstantLimits;
use super::clock::Clock;
use super::rate_spline::{RateSpline, Weights};

/// Places in each interval where the limits are imposed, and their weights in integrals (Simpson's rule). At both ends, because the jerk
/// jumps at knots.
const PLACES: [[f64; 2]; 3] = [[0.0, 1.0 / 6.0], [0.5, 4.0 / 6.0], [1.0, 1.0 / 6.0]];

/// Rows of all points.
#[derive(Debug)]
pub(super) struct Constraints {
    pub points: Vec<Point>,
    /// By point, then by joint.
    rows: Vec<Row>,
    joints: usize,
}

/// One point of the clock.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    pub interval: usize,
    pub weights: Weights,
    /// Weight in the integral over the clock.
    pub share: f64,
    /// 1 / y where a velocity limit or the largest path speed is reached; zero without.
    pub slowness: f64,
}

/// Limits of one joint at one point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row {
    /// |a . (y, y')| <= 1: the acceleration limit.
    pub acceleration: [f64; 2],
    /// |b . (y, y', y'')| <= 1 / sqrt(y): the jerk limit.
    pub jerk: [f64; 3],
}

impl Constraints {
    /// The limits of a motion at the `rate` of a `clock`. A jerk that takes an acceleration from one limit to the other within `step` (s)
    /// is as good as any higher one: a spline cannot follow it.
    pub(super) fn new(clock: &Clock, rate: &RateSpline, limits: &ConstantLimits, step: f64) -> Self {
        let inverses = inverses(limits, step);
        let mut points = Vec::with_capacity(PLACES.len() * rate.intervals());
        let mut rows = Vec::with_capacity(PLACES.len() * rate.intervals() * limits.dof());
        for interval in 0..rate.intervals() {
            for [place, weight] in PLACES {
                let at = clock.at(rate.reading(interval, place), rate.reading(interval, 0.5));
                let mut slowness = at.slowness();
                for (joint, [v, a, b]) in inverses.iter().enumerate() {
                    let [_, first, second, third] = at.joint(joint);
                    slowness = slowness.max((first * v).powi(2));
                    rows.push(Row {
                        acceleration: [second * a, 0.5 * first * a],
                        jerk: [third * b, 1.5 * second * b, 0.5 * first * b],
                    });
                }
                let weights = rate.weights(interval, place);
                points.push(Point { interval, weights, share: weight * rate.length(interval), slowness });
            }
        }
        Self { points, rows, joints: limits.dof() }
    }

    /// Each point with its rows.
    pub(super) fn all(&self) -> impl Iterator<Item = (&Point, &[Row])> {
        self.points.iter().zip(self.rows.chunks_exact(self.joints))
    }

    /// Number of inequalities.
    pub(super) fn count(&self) -> usize {
        self.points.len() + 4 * self.rows.len()
    }

    /// Measures the clock so that y = 1 everywhere reaches a limit and violates none. Returns that y in the old measure.
    pub(super) fn normalize(&mut self) -> f64 {
        let of_row = |row: &Row| row.acceleration[0].abs().max(row.jerk[0].abs().powf(2.0 / 3.0));
        let of_point = |(point, rows): (&Point, &[Row])| rows.iter().map(of_row).fold(point.slowness, f64::max);
        let y = 1.0 / self.all().map(of_point).fold(0.0, f64::max);
        for point in &mut self.points {
            point.slowness *= y;
        }
        for row in &mut self.rows {
            row.acceleration = row.acceleration.map(|a| a * y);
            row.jerk = row.jerk.map(|b| b * y * y.sqrt());
        }
        y
    }
}

/// Inverses of the limits on velocity, acceleration and jerk of each joint; zero without limit. A joint with a limit of zero does not move.
fn inverses(limits: &ConstantLimits, step: f64) -> Vec<[f64; 3]> {
    let inverse = |limit: f64| if limit > 0.0 { 1.0 / limit } else { 0.0 };
    let of_joint = |j: usize| {
        let [velocity, acceleration, jerk] = [limits.velocity[j], limits.acceleration[j], limits.jerk[j]];
        let steepest = if jerk.is_finite() { jerk.min(2.0 * acceleration / step) } else { jerk };
        [velocity, acceleration, steepest].map(inverse)
    };
    (0..limits.dof()).map(of_joint).collect()
}
