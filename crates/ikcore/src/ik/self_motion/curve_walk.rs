//! Walk in long steps along a one-dimensional self-motion, without joint limits.
//!
//! Predictor and corrector: a step follows the tangent and the curvature of the last step; Gauss-Newton brings it back to the
//! task. Between two points, joints follow the cubics that match the tangents at both.

use super::wrapped_limits::WrappedLimits;
use crate::ik::goal_descent::difference;
use crate::math::MAX_DOF;
use crate::math::box_step::{BoxStep, least_damping};
use crate::math::vector::{distance, dot, norm};
use crate::objective::{LeastSquares, Linearization, Point, TaskBlock};
use crate::problem::Problem;

/// Default length of the longest step (rad, m).
pub(in crate::ik) const LONGEST: f64 = 0.2;
/// Shortest step; below it the curve has a corner, which is a singular posture.
const SHORTEST: f64 = 0.01;
/// Cosine of the largest turn of the tangent in a step; a sharper step is halved.
const SHARPEST: f64 = 0.94;
/// Cosine of the turn of the tangent above which the next step doubles.
const STRAIGHT: f64 = 0.985;
/// Largest distance of a predicted step from the curve, as a fraction of its length; a worse step is halved.
const ASTRAY: f64 = 0.3;
/// Distance of a step from the curve (rad, m) above which it is corrected again; the remaining error is its square.
const ASIDE: f64 = 0.01;
/// Largest number of Gauss-Newton corrections of a step.
const MOST_CORRECTIONS: usize = 2;

/// Point of a curve, and the unit tangent there.
#[derive(Debug, Clone)]
pub(in crate::ik) struct CurvePoint {
    pub q: Point,
    pub along: Point,
}

impl CurvePoint {
    /// Whether a step of this `length` has led to or past `begin`, in its direction.
    pub fn has_closed_at(&self, begin: &Self, length: f64, limits: &WrappedLimits<'_>) -> bool {
        let since = limits.apart(&self.q, &begin.q);
        let is_past = dot(&since, &begin.along) >= 0.0 && dot(&self.along, &begin.along) > 0.0;
        is_past && norm(&since) < 1.1 * length
    }
}

/// Outcome of one predictor-corrector step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::ik) enum StepKind {
    /// Smooth piece of the curve.
    Smooth,
    /// Step past a corner, possibly onto another curve; the piece between is unknown.
    Corner,
}

/// Walk along a curve.
pub(in crate::ik) struct Walk<'w, 'p> {
    problem: &'w mut Problem<'p>,
    here: CurvePoint,
    /// Change of the tangent per length.
    bend: Point,
    length: f64,
    longest: f64,
    /// Linearization of the task where it was last evaluated.
    at: Linearization,
    /// Evaluations of the forward kinematics made, and their largest number.
    evaluations: usize,
    max_evaluations: usize,
}

impl<'w, 'p> Walk<'w, 'p> {
    /// Starts at the solution `q` of the only curve through it. `None` if the task leaves no freedom or more than one degree of
    /// it, without evaluations, and for several tips.
    pub fn enter(problem: &'w mut Problem<'p>, q: &[f64], max_evaluations: usize, longest: f64) -> Option<Self> {
        if max_evaluations == 0 {
            return None;
        }
        let mut at = Linearization::default();
        problem.linearize(q, &mut at);
        if !at.more.is_empty() {
            return None;
        }
        let mut along = Point::new();
        let (mut freedom, mut most_free) = (0.0, 0.0);
        for j in 0..q.len() {
            let mut unit = Point::from_elem(0.0, q.len());
            unit[j] = 1.0;
            let free = tangent(&at, q, &unit);
            // The trace of the null-space projection is the dimension of the null space.
            freedom += free[j];
            let length = norm(&free);
            if length > most_free {
                (most_free, along) = (length, free);
            }
        }
        let is_curve = (freedom - 1.0_f64).abs() < 0.5;
        let here = CurvePoint { q: q.into(), along: normalized(along) };
        let bend = Point::from_elem(0.0, q.len());
        is_curve.then(|| Self { problem, here, bend, length: longest, longest, at, evaluations: 1, max_evaluations })
    }

    /// Starts at the solution `q` like [`enter`](Self::enter), where several curves may cross, on the one in this direction. `None`
    /// if the task does not allow the direction.
    pub fn enter_along(
        problem: &'w mut Problem<'p>,
        q: &[f64],
        direction: &[f64],
        max_evaluations: usize,
        longest: f64,
    ) -> Option<Self> {
        let mut at = Linearization::default();
        problem.linearize(q, &mut at);
        if !at.more.is_empty() {
            return None;
        }
        let along = tangent(&at, q, direction);
        let is_allowed = norm(&along) > 0.5 * norm(direction);
        let here = CurvePoint { q: q.into(), along: normalized(along) };
        let bend = Point::from_elem(0.0, q.len());
        is_allowed.then(|| Self { problem, here, bend, length: longest, longest, at, evaluations: 1, max_evaluations })
    }

    /// Current point.
    pub fn here(&self) -> &CurvePoint {
        &self.here
    }

    /// Evaluations of the forward kinematics made.
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// Restarts at `point` in the opposite direction.
    pub fn turn_back_at(&mut self, point: &CurvePoint) {
        let along = point.along.iter().map(|slope| -slope).collect();
        self.here = CurvePoint { q: point.q.clone(), along };
        self.bend.fill(0.0);
        self.length = self.longest;
    }

    /// Takes the next step. Returns the point before it, and the kind of step; `None` if no evaluations are left.
    pub fn step(&mut self) -> Option<(CurvePoint, StepKind)> {
        while self.evaluations + MOST_CORRECTIONS <= self.max_evaluations {
            let (there, aside) = self.try_step();
            let cosine = dot(&self.here.along, &there.along);
            let is_smooth = cosine > SHARPEST && aside < ASTRAY * self.length;
            if !is_smooth && self.length > SHORTEST {
                self.length *= 0.5;
                continue;
            }
            let from = std::mem::replace(&mut self.here, there);
            if !is_smooth {
                self.bend.fill(0.0);
                return Some((from, StepKind::Corner));
            }
            let turn = difference(&self.here.along, &from.along);
            self.bend = turn.into_iter().map(|turn| turn / self.length).collect();
            if cosine > STRAIGHT {
                self.length = (2.0 * self.length).min(self.longest);
            }
            return Some((from, StepKind::Smooth));
        }
        None
    }

    /// Computes a step of the current length, and its distance from the curve before the correction.
    fn try_step(&mut self) -> (CurvePoint, f64) {
        let (h, CurvePoint { q: from, along }) = (self.length, &self.here);
        let predicted: Point = (0..from.len()).map(|j| from[j] + h * (along[j] + 0.5 * h * self.bend[j])).collect();
        let mut q = Point::from_slice(&predicted);
        for _ in 0..MOST_CORRECTIONS {
            self.evaluations += 1;
            self.problem.linearize(&q, &mut self.at);
            let before = Point::from_slice(&q);
            back_to_task(&self.at, &before, &mut q);
            if distance(&q, &before) < ASIDE {
                break;
            }
        }
        let along = normalized(tangent(&self.at, &q, along));
        let aside = distance(&q, &predicted);
        (CurvePoint { q, along }, aside)
    }
}

const NOWHERE: [f64; MAX_DOF] = [f64::NEG_INFINITY; MAX_DOF];
const ANYWHERE: [f64; MAX_DOF] = [f64::INFINITY; MAX_DOF];

/// Projects `direction` onto the null space of the linearised task.
fn tangent(at: &Linearization, q: &[f64], direction: &[f64]) -> Point {
    let preferred: Point = q.iter().zip(direction).map(|(q, along)| q + along).collect();
    let mut out = Point::from_slice(&preferred);
    BoxStep { residual: &[0.0; 6], ..unbounded(at, q) }.write_near(&preferred, &mut out);
    difference(&out, q)
}

/// Takes a Gauss-Newton step.
fn back_to_task(at: &Linearization, from: &[f64], q: &mut [f64]) {
    unbounded(at, from).write(q);
}

/// Gauss-Newton step from `x` without limits.
fn unbounded<'a>(at: &'a Linearization, x: &'a [f64]) -> BoxStep<'a> {
    let (n, TaskBlock { columns, residual, .. }) = (x.len(), &at.first);
    let lambda = least_damping(&columns[..n]);
    BoxStep { columns, residual, lambda, x, lower: &NOWHERE[..n], upper: &ANYWHERE[..n] }
}

fn normalized(vector: Point) -> Point {
    let length = norm(&vector);
    vector.into_iter().map(|entry| entry / length).collect()
}
