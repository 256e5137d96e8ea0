//! The fastest rate of the clock within its constraints, by Newton's method with a logarithmic barrier.
//!
//! Each step needs a positive definite matrix with a few diagonals. The limit of the jerk is a linear form below the convex 1 / sqrt(y);
//! the part of the second derivative that its curvature would take away is left out. All iterates keep all limits.

use super::constraints::{Constraints, Point, Row};
use super::rate_spline::RateSpline;
use crate::error::Result;
use crate::interrupt::checkpoint;
use crate::math::banded::{self, Band, SIDE_DIAGONALS};

/// Barriers: the gap that they leave to the fastest motion, as a fraction of its duration.
const GAPS: [f64; 5] = [0.5, 0.1, 1.5e-2, 1e-3, 2e-5];
/// Newton steps for each barrier at most.
const STEPS: usize = 100;
/// A step that would lower the function by less than this fraction of the gap ends the search.
const SETTLED: f64 = 1e-3;
/// Part of the decrease that a step promises that it must bring.
const SUFFICIENT: f64 = 0.1;
/// Shortest part of a step.
const SHORTEST: f64 = 1e-6;
/// Part of the constant rate that reaches a limit, at the start.
const START: f64 = 0.9;

/// Changes `rate` to the fastest one within the constraints.
///
/// # Errors
/// [`crate::Error::Interrupted`].
pub(super) fn fastest_rate(rate: &mut RateSpline, mut constraints: Constraints) -> Result<()> {
    let unit = constraints.normalize();
    let mut search = Search::new(&constraints, rate.coefficients.len());
    for gap in GAPS {
        search.center(gap)?;
    }
    for (coefficient, found) in rate.coefficients.iter_mut().zip(&search.at) {
        *coefficient = unit * found;
    }
    Ok(())
}

struct Search<'a> {
    constraints: &'a Constraints,
    at: Vec<f64>,
    tried: Vec<f64>,
    gradient: Vec<f64>,
    band: Band,
}

impl<'a> Search<'a> {
    fn new(constraints: &'a Constraints, n: usize) -> Self {
        let band = vec![[0.0; SIDE_DIAGONALS + 1]; n];
        Self { constraints, at: vec![START; n], tried: vec![0.0; n], gradient: vec![0.0; n], band }
    }

    /// Minimises the duration and the barrier that leaves this gap.
    fn center(&mut self, gap: f64) -> Result<()> {
        let duration = |point: &Point| point.share / combined(point, &self.at)[0].sqrt();
        let gap = gap * self.constraints.points.iter().map(duration).sum::<f64>();
        let barrier = gap / self.constraints.count() as f64;
        for _ in 0..STEPS {
            checkpoint()?;
            let Some(value) = self.expand(barrier) else { return Ok(()) };
            let slope = self.gradient.clone();
            banded::solve(&mut self.band, &mut self.gradient);
            let promised: f64 = self.gradient.iter().zip(&slope).map(|(step, slope)| step * slope).sum();
            if !(promised > SETTLED * gap) || !self.descend(barrier, value, promised) {
                return Ok(());
            }
        }
        Ok(())
    }

    /// Takes the longest part of a step that lowers the function enough; false if none does.
    fn descend(&mut self, barrier: f64, value: f64, promised: f64) -> bool {
        let mut part = 1.0;
        while part >= SHORTEST {
            for ((tried, at), step) in self.tried.iter_mut().zip(&self.at).zip(&self.gradient) {
                *tried = at - part * step;
            }
            if self.value(&self.tried, barrier).is_some_and(|lower| lower <= value - SUFFICIENT * part * promised) {
                std::mem::swap(&mut self.at, &mut self.tried);
                return true;
            }
            part *= 0.5;
        }
        false
    }

    /// The duration with the barrier; `None` outside of the constraints.
    fn value(&self, coefficients: &[f64], barrier: f64) -> Option<f64> {
        let (mut duration, mut logarithms) = (0.0, 0.0);
        for (point, rows) in self.constraints.all() {
            let y = combined(point, coefficients);
            let room = 1.0 - point.slowness * y[0];
            if !(y[0] > 0.0 && room > 0.0) {
                return None;
            }
            let slow = 1.0 / y[0].sqrt();
            duration += point.share * slow;
            logarithms += room.ln();
            for row in rows {
                let [a, b] = row.used(&y);
                let [of_acceleration, of_jerk] = [1.0 - a * a, slow * slow - b * b];
                if !(of_acceleration > 0.0 && of_jerk > 0.0) {
                    return None;
                }
                logarithms += (of_acceleration * of_jerk).ln();
            }
        }
        Some(duration - barrier * logarithms)
    }

    /// Writes the gradient and the second derivatives of the duration with the barrier; returns its value.
    fn expand(&mut self, barrier: f64) -> Option<f64> {
        let value = self.value(&self.at, barrier)?;
        self.gradient.fill(0.0);
        self.band.fill([0.0; SIDE_DIAGONALS + 1]);
        for (point, rows) in self.constraints.all() {
            let local = Local::of(point, rows, &combined(point, &self.at), barrier);
            for i in 0..3 {
                let weights = |coefficient: usize| [0, 1, 2].map(|order| point.weights[order][coefficient]);
                let of_i = weights(i);
                self.gradient[point.interval + i] += dot(&local.gradient, &of_i);
                let turned = local.times(&of_i);
                for k in i..3 {
                    self.band[point.interval + i][k - i] += dot(&turned, &weights(k));
                }
            }
        }
        Some(value)
    }
}

/// Derivatives of the function by y, y' and y'' at one point.
struct Local {
    gradient: [f64; 3],
    /// (0, 0), (1, 0), (2, 0), (1, 1), (2, 1), (2, 2).
    curvature: [f64; 6],
}

impl Local {
    fn of(point: &Point, rows: &[Row], y: &[f64; 3], barrier: f64) -> Self {
        let slow = 1.0 / y[0].sqrt();
        // The derivative of 1 / sqrt(y).
        let slower = -0.5 * slow / y[0];
        let mut local = Self { gradient: [0.0; 3], curvature: [0.0; 6] };
        local.gradient[0] = point.share * slower;
        local.curvature[0] = -1.5 * point.share * slower / y[0];
        local.add(barrier, 1.0 / (1.0 - point.slowness * y[0]), [-point.slowness, 0.0, 0.0]);
        for row in rows {
            let [a, b] = row.used(y);
            let [a0, a1] = row.acceleration;
            let [b0, b1, b2] = row.jerk;
            let [above, below] = [1.0 / (1.0 - a), 1.0 / (1.0 + a)];
            local.add_pair(barrier, [above - below, above * above + below * below], [a0, a1, 0.0]);
            local.add(barrier, 1.0 / (slow - b), [slower - b0, -b1, -b2]);
            local.add(barrier, 1.0 / (slow + b), [slower + b0, b1, b2]);
        }
        local
    }

    /// Adds - `barrier` log(room) for a room with this inverse and derivative.
    fn add(&mut self, barrier: f64, inverse: f64, slope: [f64; 3]) {
        self.add_pair(barrier, [-inverse, inverse * inverse], slope);
    }

    fn add_pair(&mut self, barrier: f64, [first, second]: [f64; 2], [x, y, z]: [f64; 3]) {
        let [first, second] = [barrier * first, barrier * second];
        let products = [x * x, x * y, x * z, y * y, y * z, z * z];
        self.gradient.iter_mut().zip([x, y, z]).for_each(|(sum, slope)| *sum += first * slope);
        self.curvature.iter_mut().zip(products).for_each(|(sum, product)| *sum += second * product);
    }

    fn times(&self, v: &[f64; 3]) -> [f64; 3] {
        let [xx, xy, xz, yy, yz, zz] = self.curvature;
        [dot(&[xx, xy, xz], v), dot(&[xy, yy, yz], v), dot(&[xz, yz, zz], v)]
    }
}

impl Row {
    /// The linear forms of the acceleration and of the jerk.
    #[inline]
    fn used(&self, y: &[f64; 3]) -> [f64; 2] {
        let [a0, a1] = self.acceleration;
        [a0 * y[0] + a1 * y[1], dot(&self.jerk, y)]
    }
}

/// y, y' and y'' at a point.
#[inline]
fn combined(point: &Point, coefficients: &[f64]) -> [f64; 3] {
    let of = &coefficients[point.interval..point.interval + 3];
    point.weights.map(|weights| weights[0] * of[0] + weights[1] * of[1] + weights[2] * of[2])
}

#[inline]
fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
