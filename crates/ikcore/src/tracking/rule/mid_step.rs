//! The model-based rule: Gauss-Newton in the box, with the Jacobian of the middle of the tick.
//!
//! A step by the Jacobian of the tick's beginning leaves an error of second order. The Jacobian of its middle,
//! extrapolated from the last two ticks as (3 J_k - J_{k-1}) / 2, leaves one of third order, so that a single evaluation a
//! tick reaches micrometres. Joint velocities are not extrapolated: on a redundant arm that would keep null-space motion
//! alive. Where a step does not lower the error, the box or a singularity is in the way: Levenberg-Marquardt, which only
//! ever lowers it, takes over for the tick.

use super::{Found, Tick};
use crate::math::{
    Frame, MAX_DOF,
    box_step::{box_step, box_step_near, least_damping},
};
use crate::objective::{Differentiable, Linearization, Point};
use crate::problem::Problem;
use crate::robot::{Columns, Robot};
use crate::solver::{Evaluator, Halt, LevenbergMarquardt, Stop, run};

/// Steps by the model in one tick; they converge quadratically, so that more would not help.
const MOST_STEPS: usize = 10;

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

pub fn advance(memory: &mut Memory, q: &[f64], mut tick: Tick<'_>) -> Found {
    let mut x = Point::from_slice(q);
    tick.tick_box.clip(&mut x);
    let mut found = Found::at(x);
    if !memory.begin_known || *found.q != *q {
        // The first tick, or one that has to begin elsewhere because q is outside its limits.
        memory.begin.update(tick.robot, &found.q);
        memory.before_known = false;
        found.evaluations += 1;
    }
    found.arrive(&memory.begin.tip, tick.target, tick.criterion);
    let mut moved = memory.towards_goals(&mut found, &mut tick) || memory.gauss_newton(&mut found, &tick);
    if !found.is_solved() {
        moved = true;
        memory.levenberg_marquardt(&mut found, tick);
    }
    memory.hand_on(moved);
    found
}

impl Memory {
    /// The arm did not go where it was sent.
    pub fn forget(&mut self) {
        (self.begin_known, self.before_known) = (false, false);
    }

    /// A step on which the freedom that the target leaves goes down the gradient of the goals, for the length of the tick,
    /// and steps by the model from there. Whether that ended in the band; if not, nothing was done.
    fn towards_goals(&mut self, found: &mut Found, tick: &mut Tick<'_>) -> bool {
        if tick.goals.is_empty() {
            return false;
        }
        let mut trial = found.clone();
        let mut wished = found.q.clone();
        tick.goals.cost(tick.robot, &found.q, &mut wished);
        for (wished, q) in wished.iter_mut().zip(&found.q) {
            *wished = q - tick.dt * *wished;
        }
        tick.tick_box.clip(&mut wished);
        self.step(&mut trial, tick, self.before_known, false, Some(&wished));
        std::mem::swap(&mut self.here, &mut self.trial);
        trial.arrive(&self.here.tip, tick.target, tick.criterion);
        while !trial.is_solved() && trial.iterations < MOST_STEPS && self.lowers(&mut trial, tick, false, true) {}
        found.evaluations = trial.evaluations;
        if trial.is_solved() {
            *found = trial;
        }
        found.is_solved() && found.iterations > 0
    }

    /// Steps by the model while they lower the error; whether one did.
    fn gauss_newton(&mut self, found: &mut Found, tick: &Tick<'_>) -> bool {
        let mut moved = false;
        let mut extrapolate = self.before_known;
        // One step at least: an arm that waited until it is out of its band would move in jerks.
        while found.iterations == 0 || (found.iterations < MOST_STEPS && !found.is_solved()) {
            if self.lowers(found, tick, extrapolate, moved) {
                moved = true;
            } else if !extrapolate {
                break;
            }
            extrapolate = false;
        }
        moved
    }

    /// One step from where `found` is: at `here` once the arm `moved`, before that at `begin`. It is kept if it lowers the
    /// error; whether it did.
    fn lowers(&mut self, found: &mut Found, tick: &Tick<'_>, extrapolate: bool, moved: bool) -> bool {
        let from = Point::from_slice(&found.q);
        self.step(found, tick, extrapolate, moved, None);
        if tick.target.assess_tip(&self.trial.tip, tick.criterion).score.value < found.value() {
            std::mem::swap(&mut self.here, &mut self.trial);
            found.arrive(&self.here.tip, tick.target, tick.criterion);
            return true;
        }
        found.q = from;
        false
    }

    /// Moves `found.q` to where the linearised target is met, as near as can be to `wished`, and leaves its kinematics in
    /// `trial`.
    fn step(&mut self, found: &mut Found, tick: &Tick<'_>, extrapolate: bool, moved: bool, wished: Option<&[f64]>) {
        let n = found.q.len();
        let current = if moved { &self.here } else { &self.begin };
        let Linearization { columns, .. } = &mut *self.linearization;
        columns[..n].copy_from_slice(&current.columns[..n]);
        if extrapolate {
            towards_middle(&mut columns[..n], &self.before.columns);
        }
        tick.target.complete(&current.tip, n, tick.criterion, &mut self.linearization);
        let Linearization { columns, residual } = &*self.linearization;
        let (lower, upper) = (tick.tick_box.lower(), tick.tick_box.upper());
        let damping = least_damping(&columns[..n]);
        let from = Point::from_slice(&found.q);
        match wished {
            None => box_step(columns, residual, damping, &from, lower, upper, &mut found.q),
            Some(wished) => box_step_near(columns, residual, damping, &from, wished, lower, upper, &mut found.q),
        }
        self.trial.update(tick.robot, &found.q);
        found.evaluations += 1;
        found.iterations += 1;
    }

    /// What the model's steps could not do, as far as it can be done.
    fn levenberg_marquardt(&mut self, found: &mut Found, tick: Tick<'_>) {
        let mut problem = Problem::new(tick.robot, tick.target, *tick.criterion);
        let objective: &mut dyn Differentiable = &mut problem;
        let mut evaluator = Evaluator::new(objective, tick.tick_box, Stop::default(), tick.rng, tick.monitor);
        let outcome = run(&LevenbergMarquardt::default(), &mut evaluator, &found.q);
        let evaluations = evaluator.evaluations();
        found.q.copy_from_slice(&evaluator.best().x);
        self.here.update(tick.robot, &found.q);
        found.arrive(&self.here.tip, tick.target, tick.criterion);
        found.evaluations += evaluations + 1;
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
