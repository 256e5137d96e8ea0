//! The fastest rate of the clock within its constraints, by Newton's method with a logarithmic barrier.
//!
//! Each step needs a positive definite matrix with a few diagonals. The limit of the jerk is a linear form below the convex 1 / sqrt(y);
//! the part of the second derivative that its curvature would take away is left out. All iterates keep all limits.

use super::constraints::{Constraints, PointRows, RatePoint, TipRow};
use super::four_points::{GroupedPoints, Logarithms};
use super::rate_spline::RateSpline;
use crate::error::Result;
use crate::interrupt::checkpoint;
use crate::math::banded::{self, Band, SIDE_DIAGONALS};

/// Barriers: the gap that they leave to the fastest motion, as a fraction of its duration.
const GAPS: [f64; 4] = [0.5, 0.1, 2e-2, 2e-3];
/// Those of a search that begins near the fastest rate. Smaller ones gain nothing: a rate that touches its limits at the points exceeds them
/// by more between them, and the motion is slowed by as much.
const LATER_GAPS: [f64; 2] = [1.5e-2, 1e-3];
/// Factor by which such a start is slowed down, again and again, until it keeps the constraints.
const SLOWED: f64 = 0.97;
/// Maximum number of these factors.
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
    let found = Search::new(constraints, start.len()).minimize(start, &GAPS)?;
    rate.coefficients = found.into_iter().map(|coefficient| unit * coefficient).collect();
    constraints.restore(unit);
    Ok(())
}

/// Changes `rate` to the fastest one within the constraints, from itself, slowed down until it keeps them.
///
/// # Errors
/// [`crate::Error::Interrupted`].
pub(super) fn faster_rate(rate: &mut RateSpline, constraints: &mut Constraints) -> Result<()> {
    let unit = constraints.normalize();
    let search = Search::new(constraints, rate.coefficients.len());
    let slowed = |part: f64| -> Vec<f64> { rate.coefficients.iter().map(|c| part * c / unit).collect() };
    let mut starts = (1..=SLOWINGS).map(|i| slowed(SLOWED.powi(i)));
    let found = match starts.find(|start| search.value(start, 0.0).is_some()) {
        Some(start) => search.minimize(start, &LATER_GAPS)?,
        None => search.minimize(vec![START; rate.coefficients.len()], &GAPS)?,
    };
    rate.coefficients = found.into_iter().map(|coefficient| unit * coefficient).collect();
    constraints.restore(unit);
    Ok(())
}

struct Search<'a> {
    constraints: &'a Constraints,
    /// Their points, with the limits of speeds and of joints.
    points: GroupedPoints,
    at: Vec<f64>,
    tried: Vec<f64>,
    gradient: Vec<f64>,
    band: Band,
}

impl<'a> Search<'a> {
    /// A search for this number of coefficients.
    fn new(constraints: &'a Constraints, n: usize) -> Self {
        let points = GroupedPoints::new(constraints);
        let [at, tried, gradient] = [(); 3].map(|()| vec![0.0; n]);
        Self { constraints, points, at, tried, gradient, band: vec![[0.0; SIDE_DIAGONALS + 1]; n] }
    }

    /// Minimises the duration with one barrier after the other, from `start`, which is within the constraints.
    fn minimize(mut self, start: Vec<f64>, gaps: &[f64]) -> Result<Vec<f64>> {
        self.at = start;
        for gap in gaps {
            self.center(*gap)?;
        }
        Ok(self.at)
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
        let mut taken = self.points.taken(&self.at, &self.gradient, MOST_OF_ROOM);
        for PointRows { point, torques, .. } in self.constraints.of_whole() {
            let (y, step) = (combined(point, &self.at), combined(point, &self.gradient));
            for (room, slope) in torques.iter().flat_map(|row| row.rooms(&y)) {
                taken = taken.max(dot(&slope, &step) / room);
            }
        }
        MOST_OF_ROOM / taken
    }

    /// The duration with the barrier; `None` outside of the constraints.
    fn value(&self, coefficients: &[f64], barrier: f64) -> Option<f64> {
        let value = self.points.value(coefficients, barrier)?;
        let mut logarithms = Logarithms::default();
        for PointRows { point, tips, torques } in self.constraints.of_whole() {
            let y = combined(point, coefficients);
            let of_tip = |tip: &TipRow| {
                let used = tip.used(&y);
                1.0 - dot(&used, &used)
            };
            let of_torques = torques.iter().flat_map(|row| row.rooms(&y)).map(|(room, _)| room);
            for room in tips.iter().map(of_tip).chain(of_torques) {
                if !(room > 0.0) {
                    return None;
                }
                logarithms.add(room);
            }
        }
        Some(value - barrier * logarithms.sum())
    }

    /// Writes the gradient and the second derivatives of the duration with the barrier.
    fn expand(&mut self, barrier: f64) {
        self.gradient.fill(0.0);
        self.band.fill([0.0; SIDE_DIAGONALS + 1]);
        self.points.expand(&self.at, barrier, &mut self.gradient, &mut self.band);
        for rows in self.constraints.of_whole() {
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

/// Derivatives of the barriers of tips and torques by y, y' and y'' at one point.
struct Local {
    gradient: [f64; 3],
    /// (0, 0), (1, 0), (2, 0), (1, 1), (2, 1), (2, 2).
    curvature: [f64; 6],
}

impl Local {
    fn of(PointRows { tips, torques, .. }: PointRows<'_>, y: &[f64; 3], barrier: f64) -> Self {
        let mut local = Self { gradient: [0.0; 3], curvature: [0.0; 6] };
        tips.iter().for_each(|tip| local.add_tip(barrier, tip, y));
        for (room, slope) in torques.iter().flat_map(|row| row.rooms(y)) {
            local.add(barrier, 1.0 / room, slope);
        }
        local
    }

    /// Adds - `barrier` log(room) for a room with this inverse and derivative.
    fn add(&mut self, barrier: f64, inverse: f64, [x, y, z]: [f64; 3]) {
        let [first, second] = [-barrier * inverse, barrier * inverse * inverse];
        let products = [x * x, x * y, x * z, y * y, y * z, z * z];
        self.gradient.iter_mut().zip([x, y, z]).for_each(|(sum, slope)| *sum += first * slope);
        self.curvature.iter_mut().zip(products).for_each(|(sum, product)| *sum += second * product);
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
