//! Possible durations of a motion of one joint between two states, and the motion for one of them.

use super::entry::entry;
use super::extremal::Extremal;
use super::first_passing::first_passing;
use super::joint_profile::JointProfile;
use super::motion_state::{MotionState, Rates};
use super::phases::{Phases, ROUNDING};

/// Transfer of a joint from one state to another within its limits. A joint that violates the limits first returns to them as
/// quickly as possible.
#[derive(Debug, Clone)]
pub struct Transfer {
    entry: JointProfile,
    from: MotionState,
    to: MotionState,
    rates: Rates,
    displacement: f64,
    up: Extremal,
    down: Extremal,
}

impl Transfer {
    /// Prepares the transfer; the final state must satisfy the limits and be reachable within them.
    pub fn new(from: MotionState, to: MotionState, rates: &Rates) -> Self {
        let (entry, inside) = entry(from, rates);
        Self {
            entry,
            from: inside,
            to,
            rates: *rates,
            displacement: to.q - inside.q,
            up: Extremal::new(inside, to, *rates),
            down: Extremal::new(inside.mirrored(), to.mirrored(), *rates),
        }
    }

    /// Returns the fastest motion to the velocity and acceleration of `to`, whatever its final position.
    pub fn to_velocity(from: MotionState, to: MotionState, rates: &Rates) -> Option<JointProfile> {
        let transfer = Self::new(from, to, rates);
        let [shortest, _] = *transfer.up.possible().first()?;
        let stop = JointProfile::of(&transfer.up.phases(shortest), transfer.from.q, shortest);
        let profile = transfer.entry.then(&stop);
        Some(if profile.segments.is_empty() { JointProfile::still(transfer.from) } else { profile })
    }

    /// Returns the shortest possible duration of at least `least` (s); infinite if there is none.
    pub fn duration(&self, least: f64) -> f64 {
        let least = (least - self.entry.duration).max(0.0);
        self.entry.duration + self.inside_duration(least)
    }

    /// Returns the motion for a possible duration (s).
    pub fn motion(&self, duration: f64) -> JointProfile {
        let t = duration - self.entry.duration;
        if t <= 0.0 {
            return self.entry.clone();
        }
        let (up, down) = (self.up.phases(t), self.down.phases(t).mirrored());
        let (highest, lowest, rounding) = (up.displacement(), down.displacement(), self.rounding(t));
        let fraction = (self.displacement - lowest) / (highest - lowest);
        let profile = |phases: &Phases| JointProfile::of(phases, self.from.q, t);
        let inside = match () {
            () if !(self.displacement < highest - rounding) => profile(&up),
            () if !(self.displacement > lowest + rounding) => profile(&down),
            () => profile(&up).mean(fraction, &profile(&down)),
        };
        self.entry.clone().then(&inside.ending_at(self.to.q, ROUNDING * self.fastest(t)))
    }

    /// Returns the rounding error of the final position after `t` (s), from the positions and the path length.
    fn rounding(&self, t: f64) -> f64 {
        ROUNDING * (self.displacement.abs() + self.from.q.abs() + t * self.fastest(t))
    }

    /// Bounds the speed of all motions of the duration `t` (s).
    fn fastest(&self, t: f64) -> f64 {
        let Self { from, to, rates: Rates { velocity, acceleration, jerk }, .. } = self;
        let largest = (from.a.abs() + to.a.abs() + t * jerk).min(*acceleration);
        (from.v.abs() + to.v.abs() + t * largest).min(*velocity)
    }

    /// Returns the shortest possible duration of at least `least` (s), starting within the limits.
    fn inside_duration(&self, least: f64) -> f64 {
        if least == 0.0 && self.from == self.to {
            return 0.0;
        }
        let intervals = self.up.possible();
        intervals
            .into_iter()
            .filter(|[_, end]| *end > least)
            .find_map(|[start, end]| self.first_in([start.max(least), end]))
            .unwrap_or(f64::INFINITY)
    }

    /// Returns the shortest duration in an interval throughout which motions exist.
    fn first_in(&self, [start, end]: [f64; 2]) -> Option<f64> {
        let (up, down) = (self.up.displacement(start), self.down.displacement(start));
        let (short, past, rounding) = (self.displacement - up, -self.displacement - down, self.rounding(start));
        if short > rounding {
            return first_passing(&self.up, self.displacement, [start, end], -short);
        }
        if past > rounding {
            return first_passing(&self.down, -self.displacement, [start, end], -past);
        }
        Some(start)
    }
}
