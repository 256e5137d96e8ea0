//! Coupled stops, which hold pairs of tips: all joints brake in proportion and are projected onto the relative poses of the
//! pairs.

use super::command_and_stop::write_before;
use super::constrained_step::{ConstrainedStep, StepRequest, Towards};
use super::step_context::StepContext;
use crate::math::vector::{dot, write_between};
use crate::motion::{Braking, JointState};
use crate::objective::Point;
use crate::obstacle::JointMotion;

/// Longest coupled stop, as a multiple of the fastest.
const SLOWER: f64 = 3.0;
/// Number of ticks on top of it.
const MORE_TICKS: usize = 8;

/// Displacement per tick (rad, m) that counts as rest if the next tick can end it.
const REST: f64 = 1e-8;

/// The configurations of a stop, tick by tick.
#[derive(Debug, Clone, Default)]
pub(super) struct CoupledStop {
    /// Configurations before and after the command, and at the ends of the ticks of the stop.
    configurations: Vec<Point>,
    /// State at the command's beginning.
    state: JointState,
    /// Largest accelerations (rad, m per tick^2).
    acceleration: Point,
    /// Number of configurations of the stop passed so far.
    passed: usize,
    /// Whether the arm follows a spline between ticks.
    limited: bool,
}

impl CoupledStop {
    /// Discards the stop.
    pub fn clear(&mut self) {
        self.configurations.clear();
        self.passed = 0;
    }

    /// Next configuration of a stopping arm.
    pub fn next(&self) -> Option<&Point> {
        self.configurations.get(self.passed + 2).or(self.configurations.last())
    }

    /// Advances to the next configuration.
    pub fn pass(&mut self) {
        self.passed += 1;
    }

    /// Configuration at rest.
    pub fn rest(&self) -> Option<&Point> {
        self.configurations.last()
    }

    /// Ticks until the arm is at rest, from the end of the command or from the last configuration passed.
    pub fn ticks_to_stop(&self) -> f64 {
        self.configurations.len().saturating_sub(2 + self.passed) as f64
    }

    /// Change of the step of joint `j` by the command.
    fn first_change(&self, j: usize) -> f64 {
        let [from, command, ..] = &self.configurations[..] else { return 0.0 };
        command[j] - from[j] - self.state.step[j]
    }

    /// Finds the stop after `command`. Returns whether it holds the pairs within all limits.
    pub fn find(&mut self, context: &StepContext<'_>, command: &[f64], rows: &mut ConstrainedStep) -> bool {
        self.clear();
        self.configurations.extend([Point::from_slice(context.q), Point::from_slice(command)]);
        self.limited = context.limited.is_some();
        let Some(limited) = context.limited else { return true };
        self.state.clone_from(limited.state());
        self.acceleration = limited.braking().iter().map(|braking| braking.acceleration).collect();
        let mut state = limited.state().clone();
        state.advance(command.iter().zip(context.q).map(|(to, from)| to - from));
        let mut tick_box = context.tick_box.clone();
        let mut q = Point::from_slice(command);
        let most = MORE_TICKS + (SLOWER * state.ticks_to_stop(limited.braking())) as usize;
        for tick in 1..=most {
            if is_at_rest(&state, limited.braking()) {
                return true;
            }
            let from = context.time + tick as f64 * context.dt;
            let StepContext { limits, limit_at, dt, .. } = *context;
            if !(limits.narrow(&q, [from, from + dt], dt, limit_at, &mut tick_box)
                && limited.narrow_ahead(&q, &state, from, limits, &mut tick_box))
            {
                return false;
            }
            let mut next = braked(context, &state, &q);
            tick_box.bounds.clip(&mut next);
            if !rows.hold(&StepRequest { ends: tick_box.bounds.ends(), ..context.request(Towards::Start) }, &mut next) {
                return false;
            }
            state.advance(next.iter().zip(&q).map(|(to, from)| to - from));
            self.configurations.push(next.clone());
            q = next;
        }
        false
    }
}

/// Whether all joints are nearly at rest, can stop within the next tick, and stand in the one after it.
fn is_at_rest(state: &JointState, braking: &[Braking]) -> bool {
    let mut joints = state.step.iter().zip(&state.change).zip(braking);
    joints.all(|((step, change), most)| {
        // The change of the last tick is the step that ends in it; in the next tick it is gone.
        step.abs() < REST.min(most.jerk) && step.abs() <= most.acceleration && (step + change).abs() <= most.jerk
    })
}

/// Next configuration of a stop: all joints decelerate by the same fraction, the largest that all of them allow.
fn braked(context: &StepContext<'_>, state: &JointState, q: &Point) -> Point {
    let mut step = Point::from_elem(0.0, q.len());
    let Some(limited) = context.limited else { return q.clone() };
    state.brake(limited.braking(), &mut step);
    // Ratio of speeds after and before the tick, over joints fast enough to count.
    let squared = dot(&state.step, &state.step);
    let fraction = step.iter().zip(&state.step).filter(|(_, now)| now.powi(2) > 1e-6 * squared);
    let fraction = fraction.map(|(next, now)| next / now).fold(0.0, f64::max);
    if fraction < 1.0 {
        step.iter_mut().zip(&state.step).for_each(|(step, now)| *step = fraction * now);
    }
    q.iter().zip(&step).map(|(q, step)| q + step).collect()
}

impl JointMotion for CoupledStop {
    fn write(&self, tick: f64, q: &mut [f64]) {
        let Some(first) = self.configurations.first() else { return };
        if tick < 0.0 && self.limited {
            return write_before(first, &self.state, tick, q);
        }
        let last = self.configurations.len() - 1;
        let before = (tick.max(0.0).floor() as usize).min(last);
        let (from, to) = (&self.configurations[before], &self.configurations[(before + 1).min(last)]);
        write_between(from, to, tick.fract(), q);
    }

    fn write_off_line(&self, from: f64, to: f64, off_line: &mut [f64]) {
        if to - from <= 1.0 {
            return;
        }
        for (j, (off_line, acceleration)) in off_line.iter_mut().zip(&self.acceleration).enumerate() {
            let bend = if from < 0.0 { acceleration.max(self.first_change(j).abs()) } else { *acceleration };
            *off_line = bend * (to - from).powi(2) / 8.0;
        }
    }

    fn middle(&self, from: f64, to: f64) -> Option<f64> {
        super::command_and_stop::middle(from, to, self.limited)
    }

    fn is_spline(&self) -> bool {
        self.limited
    }
}
