//! Descent on the goals along the self-motion of a solution: the joints move, the tip stays.
//!
//! The method is projected gradient descent: the gradient of the goals is projected onto the linearised task and the box;
//! Gauss-Newton corrects each step back onto the task; the step length follows Barzilai and Borwein (1988), which on the
//! one-dimensional self-motion of a 7-joint arm is the secant method.

use crate::math::vector::dot;
use crate::objective::{Bounds, LeastSquares, Linearization, Point};
use crate::obstacle::ClearSpace;
use crate::problem::Problem;
use crate::robot::Robot;
use crate::task::Goals;

/// Longest step of a joint (rad, m); beyond it the linearised task is inaccurate.
const LONGEST: f64 = 0.3;
/// Largest joint step (rad, m) at which the descent ends.
const SHORTEST: f64 = 1e-7;
/// Step length for projecting a gradient (rad, m): so short that only joints already at their limits are affected.
const PROBE: f64 = 1e-5;
/// Largest number of steps; bounds the cost of a flat goal, since descents normally end by themselves.
const MOST_STEPS: usize = 100;
/// Gauss-Newton corrections before a step counts as too long.
const MOST_CORRECTIONS: usize = 5;
/// Factor on a step that was too long.
const SHORTEN: f64 = 0.3;

/// Descent on the goals of a problem, with its evaluation count.
pub(super) struct GoalDescent<'a, 'p> {
    pub robot: &'a Robot,
    pub problem: &'a mut Problem<'p>,
    pub goals: &'a mut Goals,
    pub bounds: &'a Bounds,
    /// Space in which the goals measure clearances. A descent that begins clear stays clear.
    pub space: Option<&'a ClearSpace<'p>>,
    /// Evaluations of the forward kinematics.
    pub evaluations: usize,
    pub max_evaluations: usize,
}

/// Point that solves the task, with cost and gradient of the goals.
struct TaskPoint {
    q: Point,
    cost: f64,
    /// Gradient, or direction of steepest ascent by the weights of the joints.
    gradient: Point,
}

impl GoalDescent<'_, '_> {
    /// Moves `q`, at or near a solution, to the nearest optimum of the goals. Returns false if there is no solution nearby.
    pub fn descend(&mut self, q: &mut Point) -> bool {
        let begin = self.place(q.clone());
        let within = self.space.filter(|space| space.holds(&begin.q));
        let was_solved = self.problem.assess(q).score.solved;
        if self.max_evaluations < MOST_CORRECTIONS || !self.correct(q) {
            *q = begin.q;
            return was_solved;
        }
        let exact = self.place(q.clone());
        let end = self.follow_slope(exact, within);
        // The exact correction can undo a gain made within the tolerance, if the arm cannot move.
        let keeps = |q: &[f64]| within.is_none_or(|space| space.holds(q));
        *q = if (end.cost < begin.cost || !was_solved) && keeps(&end.q) { end.q } else { begin.q };
        true
    }

    /// Descends from `here` until the slope vanishes, inside `within`.
    fn follow_slope(&mut self, mut here: TaskPoint, within: Option<&ClearSpace<'_>>) -> TaskPoint {
        let mut linearization = Linearization::default();
        let mut rate = f64::INFINITY;
        // Last step and its slope, for estimating the next rate.
        let mut last: Option<(Point, Point)> = None;
        for _ in 0..MOST_STEPS {
            if self.evaluations + MOST_CORRECTIONS + 1 > self.max_evaluations {
                break;
            }
            self.linearize(&here.q, &mut linearization);
            let slope = self.projected(&here, &linearization);
            if let Some((step, before)) = last.take() {
                let bend = self.dot(&step, &difference(&slope, &before));
                rate = if bend > 0.0 { self.dot(&step, &step) / bend } else { f64::INFINITY };
            }
            rate = rate.min(LONGEST / largest(&slope));
            let Some(there) = self.shorter_until_better(&here, &linearization, &slope, &mut rate, within) else {
                break;
            };
            last = Some((difference(&there.q, &here.q), slope));
            here = there;
        }
        here
    }

    /// Returns the step down `slope` at `rate`, or at the largest smaller rate that lowers the cost and solves the task; `None`
    /// if no step is worthwhile.
    fn shorter_until_better(
        &mut self,
        here: &TaskPoint,
        at: &Linearization,
        slope: &[f64],
        rate: &mut f64,
        within: Option<&ClearSpace<'_>>,
    ) -> Option<TaskPoint> {
        while *rate * largest(slope) > SHORTEST && self.evaluations + MOST_CORRECTIONS <= self.max_evaluations {
            let mut q = self.near(at, here, slope, *rate);
            if self.correct(&mut q) {
                let there = self.place(q);
                if there.cost < here.cost && within.is_none_or(|space| space.holds(&there.q)) {
                    return Some(there);
                }
            }
            *rate *= SHORTEN;
        }
        None
    }

    /// Corrects `q` back onto the task. Returns whether that succeeded. It takes one step more than the tolerance requires: a
    /// gain from using up the tolerance could not be repeated in the next step.
    fn correct(&mut self, q: &mut Point) -> bool {
        let (mut was_solved, bounds) = (false, self.bounds);
        Linearization::default().project(q, bounds, MOST_CORRECTIONS, |q, at| {
            let is_solved = self.linearize(q, at);
            let ends = is_solved && was_solved;
            was_solved = is_solved;
            (!ends).then(|| at.least_damping(q.len()))
        })
    }

    /// Gradient projected onto the task and the box.
    fn projected(&self, here: &TaskPoint, at: &Linearization) -> Point {
        let rate = PROBE / largest(&here.gradient);
        let out = self.near(at, here, &here.gradient, rate);
        // Task errors within the tolerance are not part of the slope.
        let still = self.near(at, here, &here.gradient, 0.0);
        difference(&still, &out).into_iter().map(|step| step / rate).collect()
    }

    /// Point of the linearised task nearest to a step of `rate` down `slope`.
    fn near(&self, at: &Linearization, here: &TaskPoint, slope: &[f64], rate: f64) -> Point {
        let mut preferred: Point = here.q.iter().zip(slope).map(|(q, slope)| q - rate * slope).collect();
        self.bounds.clip(&mut preferred);
        let mut out = preferred.clone();
        at.write_step_near(&preferred, at.least_damping(here.q.len()), &here.q, self.bounds, &mut out);
        out
    }

    /// Computes residual and Jacobian at `q`. Returns whether `q` solves the task.
    fn linearize(&mut self, q: &[f64], out: &mut Linearization) -> bool {
        self.evaluations += 1;
        self.problem.linearize(q, out).solved
    }

    fn place(&mut self, q: Point) -> TaskPoint {
        let mut gradient = q.clone();
        let cost = self.goals.cost(self.robot, self.space, &q, &mut gradient);
        self.bounds.steepest(&mut gradient);
        TaskPoint { q, cost, gradient }
    }

    /// Inner product of two motions, by the weights of the joints.
    fn dot(&self, a: &[f64], b: &[f64]) -> f64 {
        self.bounds.weights().map_or_else(|| dot(a, b), |weights| weights.dot(a, b))
    }
}

/// Largest magnitude of an entry; never zero, so that it can be a divisor.
fn largest(slope: &[f64]) -> f64 {
    slope.iter().fold(f64::MIN_POSITIVE, |largest, slope| largest.max(slope.abs()))
}

/// Difference a - b.
pub(super) fn difference(a: &[f64], b: &[f64]) -> Point {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}
