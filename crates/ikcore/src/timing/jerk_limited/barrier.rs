//! The fastest rate of the clock within its constraints, by Newton's method with a logarithmic barrier.
//!
//! Each step needs a positive definite matrix with a few diagonals. The limit of the jerk is a linear form below the convex 1 / sqrt(y);
//! the part of the second derivative that its curvature would take away is left out. All iterates keep all limits.

use super::constraints::{Constraints, JointRow, PointRows, RatePoint, TipRow};
use super::rate_spline::RateSpline;
use crate::error::Result;
use crate::interrupt::checkpoint;
use crate::math::banded::{self, Band, SIDE_DIAGONALS};

/// Barriers: the gap that they leave to the fastest motion, as a fraction of its duration.
const GAPS: [f64; 5] = [0.5, 0.1, 1.5e-2, 1e-3, 2e-5];
/// Those of a search that begins near the fastest rate. Smaller ones gain nothing: a rate that touches its limits at the points exceeds them
/// by more between them, and the motion is slowed by as much.
const LATER_GAPS: [f64; 2] = [1.5e-2, 1e-3];
/// Factor by which such a start is slowed down until it keeps the constraints, and how often at most.
const SLOWED: f64 = 0.97;
const SLOWINGS: i32 = 30;
/// Newton steps for each barrier at most.
const STEPS: usize = 100;
/// A step that would lower the function by less than this fraction of the gap ends the search.
const SETTLED: f64 = 0.1;
/// Part of the decrease that a step promises that it must bring.
const SUFFICIENT: f64 = 0.1;
/// Part of the room of a limit that a step may take.
const MOST_OF_ROOM: f64 = 0.95;
/// Shortest part of a step.
const SHORTEST: f64 = 1e-6;
/// Part of the constant rate that reaches a limit, at the start.
const START: f64 = 0.9;

/// Changes `rate` to the fastest one within the constraints, from a constant one.
///
/// # Errors
/// [`crate::Error::Interrupted`].
pub(super) fn fastest_rate(rate: &mut RateSpline, constraints: &mut Constraints) -> Result<()> {
    let unit = constraints.normalize();
    let start = vec![START; rate.coefficients.len()];
    improve(rate, unit, start, constraints, &GAPS)?;
    constraints.restore(unit);
    Ok(())
}

/// Changes `rate` to the fastest one within the constraints, from itself, slowed down until it keeps them.
///
/// # Errors
/// [`crate::Error::Interrupted`].
pub(super) fn faster_rate(rate: &mut RateSpline, constraints: &mut Constraints) -> Result<()> {
    let unit = constraints.normalize();
    let slowed =
        |part: f64| rate.coefficients.iter().map(|coefficient| part * coefficient / unit).collect::<Vec<f64>>();
    let starts = (1..=SLOWINGS).map(|i| slowed(SLOWED.powi(i)));
    let within = |start: &Vec<f64>| Search::new(constraints, start.clone()).value(start, 0.0).is_some();
    match starts.into_iter().find(within) {
        Some(start) => improve(rate, unit, start, constraints, &LATER_GAPS)?,
        None => improve(rate, unit, vec![START; rate.coefficients.len()], constraints, &GAPS)?,
    }
    constraints.restore(unit);
    Ok(())
}

fn improve(rate: &mut RateSpline, unit: f64, start: Vec<f64>, constraints: &Constraints, gaps: &[f64]) -> Result<()> {
    let mut search = Search::new(constraints, start);
    for gap in gaps {
        search.center(*gap)?;
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
    fn new(constraints: &'a Constraints, at: Vec<f64>) -> Self {
        let n = at.len();
        let band = vec![[0.0; SIDE_DIAGONALS + 1]; n];
        Self { constraints, at, tried: vec![0.0; n], gradient: vec![0.0; n], band }
    }

    /// Minimises the duration and the barrier that leaves this gap.
    fn center(&mut self, gap: f64) -> Result<()> {
        let duration = |point: &RatePoint| point.share / combined(point, &self.at)[0].sqrt();
        let gap = gap * self.constraints.points.iter().map(duration).sum::<f64>();
        let barrier = gap / self.constraints.count() as f64;
        let Some(mut value) = self.value(&self.at, barrier) else { return Ok(()) };
        for _ in 0..STEPS {
            checkpoint()?;
            self.expand(barrier);
            let slope = self.gradient.clone();
            banded::solve(&mut self.band, &mut self.gradient);
            let promised: f64 = self.gradient.iter().zip(&slope).map(|(step, slope)| step * slope).sum();
            if !(promised > SETTLED * gap) {
                return Ok(());
            }
            let Some(lower) = self.descend(barrier, value, promised) else { return Ok(()) };
            value = lower;
        }
        Ok(())
    }

    /// Takes the longest part of a step that lowers the function enough, and returns its value there; `None` if none does.
    fn descend(&mut self, barrier: f64, value: f64, promised: f64) -> Option<f64> {
        let mut part = self.longest();
        while part >= SHORTEST {
            for ((tried, at), step) in self.tried.iter_mut().zip(&self.at).zip(&self.gradient) {
                *tried = at - part * step;
            }
            let lower = self.value(&self.tried, barrier);
            if lower.is_some_and(|lower| lower <= value - SUFFICIENT * part * promised) {
                std::mem::swap(&mut self.at, &mut self.tried);
                return lower;
            }
            part *= 0.5;
        }
        None
    }

    /// Largest fraction of the step that stays strictly feasible, with the jerk limits linearised.
    fn longest(&self) -> f64 {
        // Largest part of a room that the whole step would take.
        let mut taken = MOST_OF_ROOM;
        for PointRows { point, joints, torques, .. } in self.constraints.all() {
            let (y, step) = (combined(point, &self.at), combined(point, &self.gradient));
            let slow = 1.0 / y[0].sqrt();
            let slower = 0.5 * step[0] * slow / y[0];
            let of_speed = -point.slowness * step[0] / (1.0 - point.slowness * y[0]);
            taken = taken.max(of_speed).max(step[0] / y[0]);
            for row in joints {
                let ([a, b], [da, db]) = (row.used(&y), row.used(&step));
                let of_acceleration = if da < 0.0 { -da / (1.0 - a) } else { da / (1.0 + a) };
                taken = taken.max(of_acceleration).max(-(slower + db) / (slow - b)).max((db - slower) / (slow + b));
            }
            for (room, slope) in torques.iter().flat_map(|row| row.rooms(&y)) {
                taken = taken.max(dot(&slope, &step) / room);
            }
        }
        MOST_OF_ROOM / taken
    }

    /// The duration with the barrier; `None` outside of the constraints.
    fn value(&self, coefficients: &[f64], barrier: f64) -> Option<f64> {
        let (mut duration, mut logarithms) = (0.0, Logarithms::default());
        for PointRows { point, joints, tips, torques } in self.constraints.all() {
            let y = combined(point, coefficients);
            let room = 1.0 - point.slowness * y[0];
            if !(y[0] > 0.0 && room > 0.0) {
                return None;
            }
            let slow = 1.0 / y[0].sqrt();
            duration += point.share * slow;
            logarithms.add(room);
            for tip in tips {
                let used = tip.used(&y);
                let room = 1.0 - dot(&used, &used);
                if !(room > 0.0) {
                    return None;
                }
                logarithms.add(room);
            }
            for (room, _) in torques.iter().flat_map(|row| row.rooms(&y)) {
                if !(room > 0.0) {
                    return None;
                }
                logarithms.add(room);
            }
            for row in joints {
                let [a, b] = row.used(&y);
                let [of_acceleration, of_jerk] = [1.0 - a * a, slow * slow - b * b];
                if !(of_acceleration > 0.0 && of_jerk > 0.0) {
                    return None;
                }
                logarithms.add(of_acceleration * of_jerk);
            }
        }
        Some(duration - barrier * logarithms.sum())
    }

    /// Writes the gradient and the second derivatives of the duration with the barrier.
    fn expand(&mut self, barrier: f64) {
        self.gradient.fill(0.0);
        self.band.fill([0.0; SIDE_DIAGONALS + 1]);
        for rows in self.constraints.all() {
            let (point, y) = (rows.point, combined(rows.point, &self.at));
            let local = Local::of(rows, &y, barrier);
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
    }
}

/// A sum of logarithms, of products: few logarithms of many factors.
struct Logarithms {
    sum: f64,
    product: f64,
}

impl Default for Logarithms {
    fn default() -> Self {
        Self { sum: 0.0, product: 1.0 }
    }
}

impl Logarithms {
    #[inline]
    fn add(&mut self, factor: f64) {
        self.product *= factor;
        if !(1e-100..1e100).contains(&self.product) {
            self.sum += self.product.ln();
            self.product = 1.0;
        }
    }

    fn sum(&self) -> f64 {
        self.sum + self.product.ln()
    }
}

/// Derivatives of the function by y, y' and y'' at one point.
struct Local {
    gradient: [f64; 3],
    /// (0, 0), (1, 0), (2, 0), (1, 1), (2, 1), (2, 2).
    curvature: [f64; 6],
}

impl Local {
    fn of(PointRows { point, joints, tips, torques }: PointRows<'_>, y: &[f64; 3], barrier: f64) -> Self {
        let slow = 1.0 / y[0].sqrt();
        // The derivative of 1 / sqrt(y).
        let slower = -0.5 * slow / y[0];
        let mut local = Self { gradient: [0.0; 3], curvature: [0.0; 6] };
        local.gradient[0] = point.share * slower;
        local.curvature[0] = -1.5 * point.share * slower / y[0];
        local.add(barrier, 1.0 / (1.0 - point.slowness * y[0]), [-point.slowness, 0.0, 0.0]);
        local.add_joints(barrier, joints, y, [slow, slower]);
        tips.iter().for_each(|tip| local.add_tip(barrier, tip, y));
        for (room, slope) in torques.iter().flat_map(|row| row.rooms(y)) {
            local.add(barrier, 1.0 / room, slope);
        }
        local
    }

    /// Adds the limits of joints; `slow` is 1 / sqrt(y) and `slower` its derivative.
    fn add_joints(&mut self, barrier: f64, joints: &[JointRow], y: &[f64; 3], [slow, slower]: [f64; 2]) {
        let (mut of_slow, mut of_slower, mut across) = (0.0, 0.0, [0.0; 3]);
        for row in joints {
            let [a, b] = row.used(y);
            let [a0, a1] = row.acceleration;
            // The rooms 1 - a and 1 + a: difference of their inverses, sum of the squares of these.
            let rooms = 2.0 / (1.0 - a * a);
            let difference = a * rooms;
            self.add_pair(barrier, [difference, difference * difference + rooms], [a0, a1, 0.0]);
            // The rooms slow - b and slow + b: also the sum of their inverses, and the difference of the squares of these.
            let rooms = 2.0 / (slow * slow - b * b);
            let [sum, difference] = [slow * rooms, b * rooms];
            let squares = 0.5 * (sum * sum + difference * difference);
            self.add_pair(barrier, [difference, squares], row.jerk);
            of_slow += sum;
            of_slower += squares;
            let crossed = sum * difference;
            across.iter_mut().zip(row.jerk).for_each(|(across, b)| *across += crossed * b);
        }
        let slower = barrier * slower;
        self.gradient[0] -= of_slow * slower;
        self.curvature[0] += of_slower * slower * (slower / barrier) - 2.0 * slower * across[0];
        self.curvature[1] -= slower * across[1];
        self.curvature[2] -= slower * across[2];
    }

    /// Adds - `barrier` log(room) for a room with this inverse and derivative.
    fn add(&mut self, barrier: f64, inverse: f64, slope: [f64; 3]) {
        self.add_pair(barrier, [-inverse, inverse * inverse], slope);
    }

    /// Adds the acceleration limit of a tip.
    fn add_tip(&mut self, barrier: f64, tip: &TipRow, y: &[f64; 3]) {
        let used = tip.used(y);
        let inverse = 1.0 / (1.0 - dot(&used, &used));
        self.add(barrier, inverse, [-2.0 * dot(&used, &tip.of_y), -2.0 * dot(&used, &tip.of_slope), 0.0]);
        let bent = 2.0 * barrier * inverse;
        self.curvature[0] += bent * dot(&tip.of_y, &tip.of_y);
        self.curvature[1] += bent * dot(&tip.of_y, &tip.of_slope);
        self.curvature[3] += bent * dot(&tip.of_slope, &tip.of_slope);
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

/// y, y' and y'' at a point.
#[inline]
fn combined(point: &RatePoint, coefficients: &[f64]) -> [f64; 3] {
    let of = &coefficients[point.interval..point.interval + 3];
    point.weights.map(|weights| weights[0] * of[0] + weights[1] * of[1] + weights[2] * of[2])
}

#[inline]
fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
