//! Return to the limits for a joint that violates them, or cannot avoid violating them.

use super::joint_profile::JointProfile;
use super::motion_state::{MotionState, Rates};

/// Returns the motion that brings a joint inside its limits with the largest jerk (or acceleration), and the state at its
/// end. The motion is empty for a joint that is inside and can stay there.
pub(super) fn entry(from: MotionState, rates: &Rates) -> (JointProfile, MotionState) {
    let mut motion = JointProfile::empty();
    let mut state = from;
    let mut go = |state: &mut MotionState, jerk: f64, duration: f64| {
        motion.push(*state, jerk, duration);
        *state = state.after(jerk, duration.max(0.0));
    };
    let Rates { velocity, acceleration, jerk } = *rates;
    if acceleration.is_infinite() && jerk.is_infinite() {
        return (motion, state);
    }
    if jerk.is_infinite() {
        state.a = -acceleration.copysign(state.v);
        let excess = state.v.abs() - velocity;
        if excess > 0.0 {
            go(&mut state, 0.0, excess / acceleration);
            state.v = velocity.copysign(state.v);
        }
        return (motion, state);
    }
    let excess = state.a.abs() - acceleration;
    if excess > 0.0 {
        let sign = state.a.signum();
        go(&mut state, -jerk * sign, excess / jerk);
        state.a = sign * acceleration;
    }
    for _ in 0..ROUNDS {
        let Some(sign) = [1.0, -1.0].into_iter().find(|sign| leaves(&state, *sign, rates)) else { break };
        slow_down(&mut state, sign, rates, &mut go);
    }
    (motion, state)
}

/// Whether a joint exceeds its velocity limit in this direction (1 or -1), or cannot avoid it.
fn leaves(state: &MotionState, sign: f64, rates: &Rates) -> bool {
    let to_come = if state.a * sign > 0.0 { 0.5 * state.a * state.a / rates.jerk } else { 0.0 };
    state.v * sign + to_come > rates.velocity * (1.0 + SPEED_ROUNDING)
}

/// Reduces the velocity in this direction to its limit, with a deceleration that can end before the opposite limit.
fn slow_down(state: &mut MotionState, sign: f64, rates: &Rates, go: &mut impl FnMut(&mut MotionState, f64, f64)) {
    let Rates { velocity, acceleration, jerk } = *rates;
    let last = acceleration.min((4.0 * jerk * velocity).sqrt());
    let excess = state.v * sign + 0.5 * state.a * state.a / jerk - velocity;
    let direct = (2.0 * jerk * excess).sqrt();
    let deepest = if direct <= last { direct } else { (jerk * excess + 0.5 * last * last).sqrt() };
    let deceleration = deepest.min(acceleration).max(-state.a * sign);
    go(state, -jerk * sign, (state.a * sign + deceleration) / jerk);
    state.a = -sign * deceleration;
    let release = (deceleration - last).max(0.0) / jerk;
    let hold = (state.v * sign - velocity) / deceleration - 0.5 * release * (1.0 + last / deceleration);
    go(state, 0.0, hold.max(0.0));
    go(state, jerk * sign, release);
    state.v = sign * (state.v * sign).min(velocity);
}

/// Tolerance for rounding of a velocity, relative to its limit.
const SPEED_ROUNDING: f64 = 1e-12;

/// Largest number of direction changes: the second only corrects what the first could not avoid.
const ROUNDS: usize = 4;
