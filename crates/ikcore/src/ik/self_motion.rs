//! Along the self-motion of a solution: the joints move, the tip stays.
//!
//! Projected gradient descent: a step goes down the gradient of the goals, is brought back to the task and the box by the
//! nearest point that solves the linearised task, and then by Gauss-Newton; its length follows Barzilai and Borwein (1988),
//! which on the one-dimensional self-motion of a 7-joint arm is the secant method.

use crate::math::box_step::{box_step, box_step_near, least_damping};
use crate::objective::{Bounds, LeastSquares, Linearization, Point};
use crate::problem::Problem;
use crate::robot::Robot;
use crate::task::Goals;

/// Longest wish of a joint in one step (rad, m): beyond, the linearised task says little.
const LONGEST: f64 = 0.3;
/// A step that moves no joint by as much (rad, m) ends the descent.
const SHORTEST: f64 = 1e-7;
/// Descents end by themselves; this many steps bound what a flat goal may cost.
const MOST_STEPS: usize = 100;
/// Gauss-Newton steps back to the task before a step counts as too long.
const MOST_CORRECTIONS: usize = 5;
/// Factor on a step that was too long.
const SHORTEN: f64 = 0.3;

/// A problem, the goals beside it, and what has been spent on them.
pub(super) struct SelfMotion<'a, 'p> {
    pub robot: &'a Robot,
    pub problem: &'a mut Problem<'p>,
    pub goals: &'a mut Goals,
    pub bounds: &'a Bounds,
    /// Evaluations of the forward kinematics.
    pub evaluations: usize,
    pub max_evaluations: usize,
}

/// A point that solves the task, and the goals there.
struct Place {
    q: Point,
    cost: f64,
    gradient: Point,
}

impl SelfMotion<'_, '_> {
    /// Moves `q`, which solves the task, to where the goals are best near it; their cost there.
    pub fn descend(&mut self, q: &mut Point) -> f64 {
        let mut here = self.place(q.clone());
        let mut rate = descent_rate(&here.gradient, LONGEST);
        // The last step and the projected gradient that it followed: what the next rate is estimated from.
        let mut last: Option<(Point, Point)> = None;
        let mut linearization = Linearization::default();
        for _ in 0..MOST_STEPS {
            if self.evaluations + MOST_CORRECTIONS + 2 > self.max_evaluations || rate == 0.0 {
                break;
            }
            self.linearize(&here.q, &mut linearization);
            let mut projected = self.projected(&here, &linearization, rate);
            if let Some((step, before)) = last.take() {
                let bend = dot(&step, &difference(&projected, &before));
                let secant = if bend > 0.0 { dot(&step, &step) / bend } else { 4.0 * rate };
                rate = secant.min(descent_rate(&here.gradient, LONGEST));
                projected = self.projected(&here, &linearization, rate);
            }
            let Some(there) = self.shorter_until_better(&here, &linearization, &mut rate) else { break };
            last = Some((difference(&there.q, &here.q), projected));
            here = there;
        }
        *q = here.q;
        here.cost
    }

    /// The step at `rate`, or at the longest shorter one that lowers the cost and solves the task.
    fn shorter_until_better(&mut self, here: &Place, at: &Linearization, rate: &mut f64) -> Option<Place> {
        loop {
            let wished = self.wish(here, *rate);
            let mut q = here.q.clone();
            self.near(at, &here.q, &wished, &mut q);
            if difference(&q, &here.q).iter().all(|step| step.abs() < SHORTEST)
                || self.evaluations + MOST_CORRECTIONS > self.max_evaluations
            {
                return None;
            }
            if self.correct(&mut q) {
                let there = self.place(q);
                if there.cost < here.cost {
                    return Some(there);
                }
            }
            *rate *= SHORTEN;
        }
    }

    /// Brings `q` back to the task; whether that succeeded.
    fn correct(&mut self, q: &mut Point) -> bool {
        let mut linearization = Linearization::default();
        for _ in 0..MOST_CORRECTIONS {
            if self.linearize(q, &mut linearization) {
                return true;
            }
            let from = q.clone();
            let Linearization { columns, residual } = &linearization;
            let damping = least_damping(&columns[..from.len()]);
            box_step(columns, residual, damping, &from, self.bounds.lower(), self.bounds.upper(), q);
        }
        false
    }

    /// What is left of the gradient once the task and the box are respected: the step at `rate`, over the rate.
    fn projected(&self, here: &Place, at: &Linearization, rate: f64) -> Point {
        let mut out = here.q.clone();
        self.near(at, &here.q, &self.wish(here, rate), &mut out);
        difference(&here.q, &out).into_iter().map(|step| step / rate).collect()
    }

    fn wish(&self, here: &Place, rate: f64) -> Point {
        let mut wished: Point = here.q.iter().zip(&here.gradient).map(|(q, slope)| q - rate * slope).collect();
        self.bounds.clip(&mut wished);
        wished
    }

    fn near(&self, at: &Linearization, q: &[f64], wished: &[f64], out: &mut [f64]) {
        let Linearization { columns, residual } = at;
        let damping = least_damping(&columns[..q.len()]);
        box_step_near(columns, residual, damping, q, wished, self.bounds.lower(), self.bounds.upper(), out);
    }

    /// Residual and Jacobian at `q`; whether it solves the task.
    fn linearize(&mut self, q: &[f64], out: &mut Linearization) -> bool {
        self.evaluations += 1;
        self.problem.linearize(q, out).solved
    }

    fn place(&mut self, q: Point) -> Place {
        let mut gradient = q.clone();
        let cost = self.goals.cost(self.robot, &q, &mut gradient);
        Place { q, cost, gradient }
    }
}

/// The rate at which no joint moves by more than `longest` (rad, m) down `gradient`; zero where there is no slope.
fn descent_rate(gradient: &[f64], longest: f64) -> f64 {
    let steepest = gradient.iter().fold(0.0_f64, |steepest, slope| steepest.max(slope.abs()));
    if steepest > 0.0 { longest / steepest } else { 0.0 }
}

fn difference(a: &[f64], b: &[f64]) -> Point {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
