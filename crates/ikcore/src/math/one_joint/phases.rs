//! Phases of constant jerk, and their durations.

use smallvec::SmallVec;

use super::motion_state::MotionState;

/// Phase of constant jerk: its duration (s), and acceleration and jerk at its start.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Phase {
    pub duration: f64,
    pub acceleration: f64,
    pub jerk: f64,
}

/// Seven consecutive phases; some may have zero duration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Phases {
    /// Velocity at the start.
    pub velocity: f64,
    pub phases: [Phase; 7],
}

impl Phases {
    /// Returns the displacement over all phases.
    pub(super) fn displacement(&self) -> f64 {
        let mut state = MotionState { q: 0.0, v: self.velocity, a: 0.0 };
        for phase in &self.phases {
            state.a = phase.acceleration;
            state = state.after(phase.jerk, phase.duration);
        }
        state.q
    }

    /// Returns the motion with the axis reversed.
    pub(super) fn mirrored(&self) -> Self {
        let phases = self.phases.map(|phase| Phase {
            duration: phase.duration,
            acceleration: -phase.acceleration,
            jerk: -phase.jerk,
        });
        Self { velocity: -self.velocity, phases }
    }
}

/// Rounding error of a sum, relative to its terms.
pub(super) const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Durations (s).
pub(super) type Durations = SmallVec<[f64; 16]>;

/// Intervals of durations (s).
pub(super) type Possible = SmallVec<[[f64; 2]; 4]>;
