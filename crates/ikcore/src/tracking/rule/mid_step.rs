//! The model-based rule: Gauss-Newton in the box, with the Jacobian of the middle of the tick.
//!
//! A step by the Jacobian of the tick's beginning leaves an error of second order. The Jacobian of its middle,
//! extrapolated from the last two ticks as (3 J_k - J_{k-1}) / 2, leaves one of third order, so that a single evaluation a
//! tick reaches micrometres. Joint velocities are not extrapolated: on a redundant arm that would keep null-space motion
//! alive. Where a step does not lower the error, the box or a singularity is in the way: Levenberg-Marquardt, which only
//! ever lowers it, takes over for the tick.

use super::approach::Way;
use super::{Found, Tick};
use crate::limits::Field;
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
    let value_at_rest = found.value();
    let way = memory.way_with_braking(q, &found.q, &tick);
    let mut moved =
        way.is_none() && (memory.towards_goals(&mut found, &mut tick) || memory.gauss_newton(&mut found, &tick));
    if !found.is_solved() {
        moved = true;
        if !memory.approach(way, q, value_at_rest, &mut found, &tick) {
            memory.levenberg_marquardt(&mut found, tick);
        }
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

    /// The way to a target that the arm has not caught up with, and that it could reach faster than it could stop there.
    fn way_with_braking(&self, q: &[f64], near: &[f64], tick: &Tick<'_>) -> Option<Way> {
        let limited = tick.limits.field(Field::Acceleration).is_some();
        if !limited || tick.motion.begin.assess_tip(&self.begin.tip, tick.criterion).score.solved {
            return None;
        }
        Some(self.way(q, near, tick)).filter(Way::needs_braking)
    }

    fn way(&self, q: &[f64], near: &[f64], tick: &Tick<'_>) -> Way {
        Way::new(q, near, &self.begin.tip, &self.begin.columns, tick)
    }

    /// One tick from `q` towards a target that is far, or before which the arm has to brake; whether it is one, and the tick
    /// brought it nearer.
    fn approach(
        &mut self,
        braking: Option<Way>,
        q: &[f64],
        value_at_rest: f64,
        found: &mut Found,
        tick: &Tick<'_>,
    ) -> bool {
        let must_brake = braking.is_some();
        let mut x = Point::from_slice(q);
        let way = braking.unwrap_or_else(|| {
            let mut near = Point::from_slice(q);
            tick.tick_box.clip(&mut near);
            self.way(q, &near, tick)
        });
        if !must_brake && !way.is_long() {
            return false;
        }
        way.walk(&mut x, tick);
        self.trial.update(tick.robot, &x);
        let mut ahead = Found { q: x, evaluations: found.evaluations + 1, iterations: found.iterations + 1, ..*found };
        ahead.arrive(&self.trial.tip, tick.target, tick.criterion);
        // An arm that has to brake may be carried away from its target.
        if !must_brake && ahead.value() >= value_at_rest {
            return false;
        }
        std::mem::swap(&mut self.here, &mut self.trial);
        *found = ahead;
        true
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
