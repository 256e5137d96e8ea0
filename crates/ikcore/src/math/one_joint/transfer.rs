//! The possible durations of a motion of one joint between two states, and the motion for one of them.

use super::entry::entry;
use super::extremal::Extremal;
use super::first_passing::first_passing;
use super::joint_profile::JointProfile;
use super::motion_state::{MotionState, Rates};

/// A joint that has to get from one state to another within its limits. Outside its limits it first returns inside them,
/// as quickly as possible.
#[derive(Debug, Clone)]
pub struct Transfer {
    entry: JointProfile,
    from: MotionState,
    to: MotionState,
    displacement: f64,
    up: Extremal,
    down: Extremal,
}

/// Fraction of an interval between critical durations by which its ends are moved inwards until the motion exists there.
const INSETS: [f64; 5] = [0.0, 1e-15, 1e-13, 1e-11, 1e-9];

/// Differences of positions that count as rounding, relative to their size and to the distances travelled.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

impl Transfer {
    /// From one state to another; the final state is inside the limits and can be reached inside them.
    pub fn new(from: MotionState, to: MotionState, rates: &Rates) -> Self {
        let (entry, inside) = entry(from, rates);
        Self {
            entry,
            from: inside,
            to,
            displacement: to.q - inside.q,
            up: Extremal::new(inside, to, *rates),
            down: Extremal::new(inside.mirrored(), to.mirrored(), *rates),
        }
    }

    /// The quickest way for a joint to the velocity and acceleration of `to`, wherever it gets there.
    pub fn to_velocity(from: MotionState, to: MotionState, rates: &Rates) -> Option<JointProfile> {
        let transfer = Self::new(from, to, rates);
        let [shortest, _] = *transfer.up.possible().first()?;
        let found = INSETS.into_iter().find_map(|inset| transfer.up.phases(shortest + inset * shortest.max(1e-9)))?;
        let profile = transfer.entry.then(&JointProfile::of(&found, transfer.from.q));
        Some(if profile.segments.is_empty() { JointProfile::still(transfer.from) } else { profile })
    }

    /// The shortest possible duration of at least `least` (s); infinite if there is none.
    pub fn duration(&self, least: f64) -> f64 {
        let least = (least - self.entry.duration).max(0.0);
        self.entry.duration + self.inside_duration(least)
    }

    /// The motion of a possible duration (s).
    pub fn motion(&self, duration: f64) -> Option<JointProfile> {
        let t = duration - self.entry.duration;
        if t <= 0.0 {
            return Some(self.entry.clone());
        }
        let (up, down) = (self.up.phases(t)?, self.down.phases(t)?.mirrored());
        let (highest, lowest) = (up.displacement(), down.displacement());
        let share = (self.displacement - lowest) / (highest - lowest);
        let rounding = self.rounding(highest).max(self.rounding(lowest));
        let inside = match () {
            () if !(self.displacement < highest - rounding) => JointProfile::of(&up, self.from.q),
            () if !(self.displacement > lowest + rounding) => JointProfile::of(&down, self.from.q),
            () => JointProfile::of(&up, self.from.q).mean(share, &JointProfile::of(&down, self.from.q)),
        };
        let inside = JointProfile { duration: t, ..inside };
        Some(self.entry.clone().then(&inside))
    }

    fn rounding(&self, displacement: f64) -> f64 {
        ROUNDING * (displacement.abs() + self.displacement.abs() + self.from.q.abs())
    }

    /// The shortest possible duration of at least `least` (s), from inside the limits.
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

    /// The shortest duration in an interval for which motions exist throughout.
    fn first_in(&self, [start, end]: [f64; 2]) -> Option<f64> {
        let width = if end.is_finite() { end - start } else { start.max(1e-9) };
        let (start, up, down) = INSETS.into_iter().find_map(|inset| {
            let t = start + inset * width;
            Some((t, self.up.displacement(t)?, self.down.displacement(t)?))
        })?;
        let (short, past) = (self.displacement - up, -self.displacement - down);
        if short > self.rounding(up) {
            return first_passing(&self.up, self.displacement, [start, end], -short);
        }
        if past > self.rounding(down) {
            return first_passing(&self.down, -self.displacement, [start, end], -past);
        }
        Some(start)
    }
}
