//! The limits of tips over the segments of a grid, in the plane of x = (ds/dt)^2 and u = d2s/dt2.
//!
//! The tip's velocity is p' sqrt(x) and its acceleration p' u + p'' x, with the derivatives p' and p'' of its place by the path parameter: polynomials
//! over a segment, to rounding, whose Bernstein coefficients bound them at every point.

use super::grid::Segment;
use super::joint_path::JointPath;
use crate::constraint::{JointSpan, TIGHT, TipJet, TipRates, VectorJet};
use crate::error::Result;
use crate::interrupt::checkpoint_at;
use crate::limits::TipField;
use crate::math::bernstein::bernstein;
use crate::math::vector3::{Vector, add_scaled, dot, norm};
use crate::trajectory::polynomial;

/// Largest error of a polynomial, relative to the size of the function that it approximates; a segment is halved until then.
const NEGLIGIBLE: f64 = 1e-7;

/// Maximum number of halvings of a segment.
const DEEPEST: usize = 12;

/// Pairs of sides of the polygon inscribed in the circle that the acceleration stays in: it loses 0.5 % at most.
const SIDES: usize = 16;

/// Halvings by which the largest Bernstein coefficient comes near to the largest value.
const SUBDIVISIONS: usize = 4;

/// Motion of one tip over a part of a segment.
#[derive(Debug)]
struct PathJet {
    /// Index of the limited tip.
    tip: usize,
    /// Middle and half length, in the parameter since the start of the segment.
    middle: f64,
    half: f64,
    jet: TipJet,
}

/// The motion of limited tips over the segments of a grid.
#[derive(Debug)]
pub(super) struct TipSegments<'a> {
    rates: &'a TipRates,
    jets: Vec<PathJet>,
    /// Where the jets of each segment begin, and the number of all.
    begins: Vec<usize>,
}

/// A strip |a u + b x| <= c.
pub(super) type Strip = [f64; 3];

impl<'a> TipSegments<'a> {
    /// Computes the motion along `path` over these segments.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted).
    pub(super) fn new(path: &JointPath, segments: &[Segment], rates: &'a TipRates) -> Result<Self> {
        let mut all = Self { rates, jets: Vec::with_capacity(segments.len()), begins: vec![0] };
        let mut at = JointSpan::new(rates.robot());
        for (i, segment) in segments.iter().enumerate() {
            checkpoint_at(i)?;
            let half = 0.5 * segment.length;
            all.push(&mut at, (path, segment), [half, half], 0);
            all.begins.push(all.jets.len());
        }
        Ok(all)
    }

    fn push(&mut self, at: &mut JointSpan, of: (&JointPath, &Segment), [middle, half]: [f64; 2], depth: usize) {
        let (path, segment) = of;
        let powers = path.powers(segment.piece);
        let polynomials = (0..path.joints().len()).map(|j| polynomial(powers.map(|power| power[j])));
        let robot = self.rates.robot();
        at.set(robot, polynomials, [segment.from + middle, half]);
        let jets: smallvec::SmallVec<[TipJet; 4]> =
            self.rates.tips().iter().map(|tip| at.jet(robot, &tip.elements)).collect();
        let is_exact = |jet: &VectorJet| jet.rest <= NEGLIGIBLE * jet.size;
        if depth == DEEPEST || jets.iter().all(|jet| is_exact(&jet.velocity) && is_exact(&jet.turn)) {
            self.jets.extend(jets.into_iter().enumerate().map(|(tip, jet)| PathJet { tip, middle, half, jet }));
            return;
        }
        let half = 0.5 * half;
        self.push(at, of, [middle - half, half], depth + 1);
        self.push(at, of, [middle + half, half], depth + 1);
    }

    fn of(&self, segment: usize) -> &[PathJet] {
        &self.jets[self.begins[segment]..self.begins[segment + 1]]
    }

    /// Bounds on x at both ends of a segment.
    pub(super) fn at_ends(&self, segment: usize) -> [f64; 2] {
        let jets = self.of(segment);
        let tips = self.rates.tips().len();
        let of_end = |jets: &[PathJet], x: f64| {
            let bound = |jet: &PathJet| {
                let of = |rate: &VectorJet, limit: f64| {
                    let ratio = limit * jet.half / (norm(&rate.end(x)) + rate.rest);
                    if ratio.is_nan() { f64::INFINITY } else { ratio * ratio }
                };
                let [speed, turn] = self.limits(jet.tip);
                of(&jet.jet.velocity, speed).min(of(&jet.jet.turn, turn))
            };
            jets.iter().map(bound).fold(f64::INFINITY, f64::min)
        };
        [of_end(&jets[..tips], -1.0), of_end(&jets[jets.len() - tips..], 1.0)]
    }

    /// Returns the factor by which x, linear over a segment of this length between these values at its ends, exceeds the limits.
    pub(super) fn excess(&self, segment: usize, length: f64, [left, right]: [f64; 2]) -> f64 {
        let at = |s: f64| left + (right - left) * s / length;
        let factor = |jet: &PathJet| {
            let (x, slope) = (at(jet.middle), 0.5 * (at(jet.middle + jet.half) - at(jet.middle - jet.half)));
            let fastest = (x + slope.abs()).max(0.0).sqrt();
            let of = |rate: &VectorJet, limit: f64| {
                if limit == f64::INFINITY {
                    return 0.0;
                }
                let speed = (largest(rate, [x, slope]).sqrt() + rate.rest * fastest) / jet.half;
                (speed / limit).powi(2)
            };
            let [speed, turn] = self.limits(jet.tip);
            of(&jet.jet.velocity, speed).max(of(&jet.jet.turn, turn))
        };
        self.of(segment).iter().map(factor).fold(0.0, f64::max)
    }

    /// Limits of speed and turn speed of a tip, with room for a certificate.
    fn limits(&self, tip: usize) -> [f64; 2] {
        [TipField::Speed, TipField::TurnSpeed].map(|field| self.rates.tips()[tip].limit(field) * (1.0 - TIGHT))
    }

    /// Calls `keep` with strips inside the acceleration limits over a segment, where x grows by 2 u from its start on.
    pub(super) fn strips(&self, segment: usize, mut keep: impl FnMut(Strip)) {
        for PathJet { tip, middle, half, jet } in self.of(segment) {
            let limit = self.rates.tips()[*tip].limit(TipField::Acceleration);
            if limit == f64::INFINITY {
                continue;
            }
            let change = jet.velocity.derivative();
            let of_x = change.control_points([1.0 / (half * half), 0.0]);
            let of_u = change.control_points([2.0 * middle / (half * half), 2.0 / half]);
            let velocity = jet.velocity.control_points([1.0 / half, 0.0]);
            for ((a, b), velocity) in of_u.iter().zip(&of_x).zip(&velocity) {
                inscribed([add_scaled(velocity, a, 1.0), *b], limit * (1.0 - TIGHT), &mut keep);
            }
        }
    }
}

/// Calls `keep` with strips whose polygon is inside of |a u + b x| <= `limit`.
fn inscribed([a, b]: [Vector; 2], limit: f64, keep: &mut impl FnMut(Strip)) {
    // In the plane of both vectors: (a, 0) and (b0, b1).
    let size = norm(&a);
    if size == 0.0 {
        return keep([0.0, norm(&b), limit]);
    }
    let along = dot(&a, &b) / size;
    let across = norm(&add_scaled(&b, &a, -along / size));
    let step = std::f64::consts::PI / SIDES as f64;
    let inner = limit * (0.5 * step).cos();
    for side in 0..SIDES {
        let (sin, cos) = (step * side as f64).sin_cos();
        keep([cos * size, cos * along + sin * across, inner]);
    }
}

/// The largest value over \[-1, 1\] of the square of a rate times `x` + `slope` s, or a little more.
fn largest(rate: &VectorJet, [x, slope]: [f64; 2]) -> f64 {
    let (square, rounding) = rate.square();
    let mut product = [0.0; SQUARE + 1];
    for (k, c) in square.iter().enumerate() {
        product[k] += c * x;
        product[k + 1] += c * slope;
    }
    let rounding = rounding * (x.abs() + slope.abs());
    highest(bernstein(&product), SUBDIVISIONS) + rounding
}

const SQUARE: usize = crate::constraint::SQUARE;

/// The largest Bernstein coefficient after halving a polynomial where it may be largest.
fn highest(mut coefficients: [f64; SQUARE + 1], subdivisions: usize) -> f64 {
    let ends = coefficients[0].max(coefficients[SQUARE]);
    let bound = coefficients.into_iter().fold(0.0, f64::max);
    if subdivisions == 0 || bound <= ends * (1.0 + TIGHT) {
        return bound;
    }
    let mut first = coefficients;
    for level in 1..=SQUARE {
        for i in 0..=SQUARE - level {
            coefficients[i] = 0.5 * (coefficients[i] + coefficients[i + 1]);
        }
        first[level] = coefficients[0];
    }
    highest(first, subdivisions - 1).max(highest(coefficients, subdivisions - 1))
}
