//! The model-based rule: Gauss-Newton in the box, with the Jacobian of the middle of the tick.
//!
//! A step by the Jacobian of the tick's beginning leaves an error of second order. The Jacobian of its middle,
//! extrapolated from the last two ticks as (3 J_k - J_{k-1}) / 2, leaves one of third order, so that a single evaluation a
//! tick reaches micrometres. Joint velocities are not extrapolated: on a redundant arm that would keep null-space motion
//! alive. Where a step does not lower the error, the box or a singularity is in the way: Levenberg-Marquardt, which only
//! ever lowers it, takes over for the tick.

use super::{Found, Tick};
use crate::math::{Frame, MAX_DOF, box_step::box_step};
use crate::objective::{Differentiable, Linearization, Point};
use crate::problem::Problem;
use crate::robot::{Columns, Robot};
use crate::solver::{Evaluator, Halt, LevenbergMarquardt, Stop, run};

/// Steps by the model in one tick; they converge quadratically, so that more would not help.
const MOST_STEPS: usize = 10;

/// Damping over the squared size of the Jacobian: enough to keep a singular system solvable.
const DAMPING: f64 = 1e-10;

/// What the rule remembers from tick to tick. Boxed, so that handing a Jacobian on is handing on a pointer.
#[derive(Debug, Default)]
pub struct Memory {
    /// At the accepted configuration, once there was a tick.
    begin: Box<Kinematics>,
    begin_known: bool,
    /// At the one before, if the arm has moved since.
    before: Box<Kinematics>,
    before_known: bool,
    here: Box<Kinematics>,
    trial: Box<Kinematics>,
    linearization: Box<Linearization>,
}

/// Tip and geometric Jacobian at a configuration.
#[derive(Debug)]
struct Kinematics {
    tip: Frame,
    columns: Columns,
}

impl Default for Kinematics {
    fn default() -> Self {
        Self { tip: Frame::IDENTITY, columns: [[0.0; 6]; MAX_DOF] }
    }
}

impl Kinematics {
    fn update(&mut self, robot: &Robot, q: &[f64]) {
        self.tip = robot.tip_and_jacobian(q, &mut self.columns);
    }
}

pub fn advance(memory: &mut Memory, q: &[f64], tick: Tick<'_>) -> Found {
    let mut x = Point::from_slice(q);
    tick.tick_box.clip(&mut x);
    let mut found = Found::at(x);
    if !memory.begin_known || *found.q != *q {
        // The first tick, or one that has to begin elsewhere because q is outside its limits.
        memory.begin.update(tick.robot, &found.q);
        memory.before_known = false;
        found.evaluations += 1;
    }
    found.arrive(&memory.begin.tip, tick.target);
    let mut moved = memory.gauss_newton(&mut found, &tick);
    if !found.error.within(&tick.tolerance) {
        moved = true;
        memory.levenberg_marquardt(&mut found, tick);
    }
    memory.hand_on(moved);
    found
}

impl Memory {
    /// Steps by the model while they lower the error; whether one did.
    fn gauss_newton(&mut self, found: &mut Found, tick: &Tick<'_>) -> bool {
        let (n, mut moved) = (found.q.len(), false);
        let mut extrapolate = self.before_known;
        // One step at least: an arm that waited until it is out of its band would move in jerks.
        while found.iterations == 0 || (found.iterations < MOST_STEPS && !found.error.within(&tick.tolerance)) {
            let current = if moved { &self.here } else { &self.begin };
            let Linearization { columns, .. } = &mut *self.linearization;
            columns[..n].copy_from_slice(&current.columns[..n]);
            if extrapolate {
                towards_middle(&mut columns[..n], &self.before.columns);
            }
            tick.target.complete(&current.tip, n, &mut self.linearization);
            let Linearization { columns, residual } = &*self.linearization;
            let (lower, upper) = (tick.tick_box.lower(), tick.tick_box.upper());
            let mut x = found.q.clone();
            box_step(columns, residual, DAMPING * size(&columns[..n]), &found.q, lower, upper, &mut x);
            self.trial.update(tick.robot, &x);
            found.evaluations += 1;
            found.iterations += 1;
            if tick.target.error_of(&self.trial.tip).sum() < found.error.sum() {
                std::mem::swap(&mut self.here, &mut self.trial);
                found.q = x;
                found.arrive(&self.here.tip, tick.target);
                moved = true;
            } else if !extrapolate {
                break;
            }
            extrapolate = false;
        }
        moved
    }

    /// What the model's steps could not do, as far as it can be done.
    fn levenberg_marquardt(&mut self, found: &mut Found, tick: Tick<'_>) {
        let Tick { robot, target, tolerance, tick_box, rng, monitor, .. } = tick;
        let mut problem = Problem::new(robot, target, tolerance);
        let objective: &mut dyn Differentiable = &mut problem;
        let mut evaluator = Evaluator::new(objective, tick_box, Stop::default(), rng, monitor);
        let outcome = run(&LevenbergMarquardt::default(), &mut evaluator, &found.q);
        found.q.copy_from_slice(&evaluator.best().x);
        self.here.update(robot, &found.q);
        found.arrive(&self.here.tip, target);
        found.evaluations += evaluator.evaluations() + 1;
        found.iterations += outcome.iterations;
        found.interrupted = outcome.halt == Halt::Interrupted;
    }

    /// What is known at the end of a tick is known at the beginning of the next.
    fn hand_on(&mut self, moved: bool) {
        if moved {
            std::mem::swap(&mut self.before, &mut self.begin);
            std::mem::swap(&mut self.begin, &mut self.here);
        }
        (self.begin_known, self.before_known) = (true, moved);
    }
}

/// From J_k to (3 J_k - J_{k-1}) / 2.
fn towards_middle(columns: &mut [[f64; 6]], before: &Columns) {
    for (column, old) in columns.iter_mut().zip(before) {
        for k in 0..6 {
            column[k] += 0.5 * (column[k] - old[k]);
        }
    }
}

/// The sum of squares of all entries.
fn size(columns: &[[f64; 6]]) -> f64 {
    columns.as_flattened().iter().map(|entry| entry * entry).sum()
}
