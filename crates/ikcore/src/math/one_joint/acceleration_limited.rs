//! Extremal motion of one joint without a jerk limit: the largest displacement in a given duration.

use super::motion_state::{MotionState, Rates};
use super::phases::{Durations, Phase, Phases, Possible};

/// Profile of full acceleration, the velocity limit if it is reached, and full deceleration. Without an acceleration limit it
/// keeps the velocity limit throughout.
#[derive(Debug, Clone, Copy)]
pub(super) struct AccelerationLimited {
    from: f64,
    to: f64,
    rates: Rates,
}

impl AccelerationLimited {
    pub(super) fn new(from: MotionState, to: MotionState, rates: Rates) -> Self {
        Self { from: from.v, to: to.v, rates }
    }

    /// Returns the phases for a possible duration `t` (s).
    pub(super) fn phases(&self, t: f64) -> Phases {
        let Self { from, to, rates: Rates { velocity, acceleration, .. } } = *self;
        let mut phases = [Phase::default(); 7];
        if acceleration.is_infinite() {
            phases[0].duration = t;
            return Phases { velocity, phases };
        }
        let spare = (t - (to - from).abs() / acceleration).max(0.0);
        let change_to = |top: f64, v: f64| (top - v) / acceleration;
        let top = from.max(to);
        let (rise, fall) = if top + 0.5 * acceleration * spare > velocity {
            (change_to(velocity, from), change_to(velocity, to))
        } else {
            (change_to(top, from) + 0.5 * spare, change_to(top, to) + 0.5 * spare)
        };
        phases[0] = Phase { duration: rise, acceleration, jerk: 0.0 };
        phases[1] = Phase { duration: (t - rise - fall).max(0.0), acceleration: 0.0, jerk: 0.0 };
        phases[2] = Phase { duration: fall, acceleration: -acceleration, jerk: 0.0 };
        Phases { velocity: from, phases }
    }

    /// Lists intervals of possible durations, as [`JerkLimited::possible`](super::jerk_limited::JerkLimited::possible) does.
    pub(super) fn possible(&self, found: &mut Possible) {
        let change = (self.to - self.from).abs() / self.rates.acceleration;
        found.push([change, f64::INFINITY]);
    }

    /// Lists critical durations, as [`JerkLimited::critical_durations`](super::jerk_limited::JerkLimited::critical_durations)
    /// does.
    pub(super) fn critical_durations(&self, found: &mut Durations) {
        let Self { from, to, rates: Rates { acceleration, .. } } = *self;
        if acceleration.is_finite() {
            found.push(-(to + from) / acceleration);
        }
    }

    /// Returns the shortest duration (s) in which the motion reaches the velocity limit; infinite without a limit.
    pub(super) fn full_speed_duration(&self) -> f64 {
        let Self { from, to, rates: Rates { velocity, acceleration, .. } } = *self;
        if acceleration.is_infinite() { 0.0 } else { (2.0 * velocity - from - to) / acceleration }
    }

    /// Whether longer motions go farther, as [`JerkLimited::rises_from`](super::jerk_limited::JerkLimited::rises_from).
    pub(super) fn rises_from(&self, t: f64) -> bool {
        let Self { from, to, rates: Rates { acceleration, .. } } = *self;
        from + to + acceleration * t >= 0.0
    }
}
